//! Gmsh meshes, versions 2.2 and 4.1 as text: hexahedra, and quads and nodes of physical groups.

use std::{collections::HashMap, path::Path};

use super::{
    error::{FileLine, MeshFileError},
    hex_draft::{DraftHex, HexDraft, HexFile},
    text,
};

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let content = text::decode(bytes);
    let mut lines = Lines::new(path, &content);
    let mut groups = Groups::default();
    let mut draft = HexDraft::new(path);
    let mut version = None;
    while let Some((line, row)) = lines.next() {
        match (row, version) {
            ("$MeshFormat", _) => {
                version = Some(read_version(&mut lines)?);
                lines.skip_to_end_of("$MeshFormat");
            }
            ("$PhysicalNames", _) => groups.read_names(&mut lines)?,
            ("$Entities", Some(Version::V4)) => groups.read_entities(&mut lines)?,
            ("$Nodes", Some(Version::V2)) => nodes_v2(&mut lines, &mut draft)?,
            ("$Nodes", Some(Version::V4)) => nodes_v4(&mut lines, &mut draft)?,
            ("$Elements", Some(Version::V2)) => elements_v2(&mut lines, &groups, &mut draft)?,
            ("$Elements", Some(Version::V4)) => elements_v4(&mut lines, &groups, &mut draft)?,
            (_, None) => {
                let what = "does not start with $MeshFormat; is this a Gmsh file?";
                return Err(FileLine::line(path, line).error(what));
            }
            (section, _) => lines.skip_to_end_of(section),
        }
    }
    draft.finish()
}

#[derive(Clone, Copy)]
enum Version {
    V2,
    V4,
}

fn read_version(lines: &mut Lines) -> Result<Version, MeshFileError> {
    let (line, row) = lines.expect_row()?;
    let words: Vec<&str> = row.split_ascii_whitespace().collect();
    match words[..] {
        ["2.2", "0", ..] => Ok(Version::V2),
        ["4.1", "0", ..] => Ok(Version::V4),
        [version, kind, ..] => {
            let kind = if kind == "0" { "text" } else { "binary" };
            let what = format!(
                "is Gmsh version {version} as {kind}; save it as version 4.1 or 2.2, ASCII"
            );
            Err(lines.at(line).error(what))
        }
        _ => Err(lines
            .at(line)
            .error("the format line needs version, type and size")),
    }
}

/// Lines that are not empty, with their numbers.
pub(super) struct Lines<'t> {
    pub path: &'t Path,
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
}

impl<'t> Lines<'t> {
    pub(super) fn new(path: &'t Path, content: &'t str) -> Self {
        let lines = content.lines().enumerate();
        Self { path, lines }
    }

    pub(super) fn next(&mut self) -> Option<(usize, &'t str)> {
        let mut filled = self
            .lines
            .by_ref()
            .map(|(index, row)| (index + 1, row.trim()));
        filled.find(|(_, row)| !row.is_empty())
    }

    pub(super) fn expect_row(&mut self) -> Result<(usize, &'t str), MeshFileError> {
        let end =
            || FileLine::file(self.path).error("ends in the middle of a section; was it cut off?");
        self.next().ok_or_else(end)
    }

    pub(super) fn at(&self, line: usize) -> FileLine {
        FileLine::line(self.path, line)
    }

    /// The next row as whole numbers, at least `least` of them.
    pub(super) fn integers(&mut self, least: usize) -> Result<(usize, Vec<i64>), MeshFileError> {
        let (line, row) = self.expect_row()?;
        let words = row.split_ascii_whitespace();
        let numbers: Result<Vec<i64>, _> = words
            .map(|word| text::number(self.path, line, word))
            .collect();
        let numbers = numbers?;
        if numbers.len() < least {
            let what = format!("this row has {} numbers; it needs {least}", numbers.len());
            return Err(self.at(line).error(what));
        }
        Ok((line, numbers))
    }

    pub(super) fn skip_to_end_of(&mut self, section: &str) {
        let end = section.replacen('$', "$End", 1);
        while self.next().is_some_and(|(_, row)| row != end) {}
    }
}

pub(super) fn nodes_v2(lines: &mut Lines, draft: &mut HexDraft) -> Result<(), MeshFileError> {
    let (_, count) = lines.integers(1)?;
    for _ in 0..count[0] {
        let (line, row) = lines.expect_row()?;
        let mut words = row.split_ascii_whitespace();
        let label = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let position = text::coordinates(lines.path, line, &mut words)?;
        draft.node(Some(line), label, position)?;
    }
    lines.skip_to_end_of("$Nodes");
    Ok(())
}

pub(super) fn nodes_v4(lines: &mut Lines, draft: &mut HexDraft) -> Result<(), MeshFileError> {
    let (_, head) = lines.integers(4)?;
    for _ in 0..head[0] {
        let (_, block) = lines.integers(4)?;
        let mut labels = Vec::new();
        for _ in 0..block[3] {
            labels.push(lines.integers(1)?.1[0]);
        }
        for label in labels {
            let (line, row) = lines.expect_row()?;
            let mut words = row.split_ascii_whitespace();
            let position = text::coordinates(lines.path, line, &mut words)?;
            draft.node(Some(line), label.cast_unsigned(), position)?;
        }
    }
    lines.skip_to_end_of("$Nodes");
    Ok(())
}

/// Physical groups: names by dimension and number, and in version 4 the groups of each entity.
#[derive(Default)]
pub(super) struct Groups {
    names: HashMap<(i64, i64), String>,
    pub of_entity: HashMap<(i64, i64), Vec<i64>>,
}

impl Groups {
    pub(super) fn read_names(&mut self, lines: &mut Lines) -> Result<(), MeshFileError> {
        let (_, count) = lines.integers(1)?;
        for _ in 0..count[0] {
            let (line, row) = lines.expect_row()?;
            let mut words = row.splitn(3, char::is_whitespace);
            let mut number = || text::number(lines.path, line, words.next().unwrap_or_default());
            let key = (number()?, number()?);
            let name = words.next().unwrap_or_default().trim().trim_matches('"');
            self.names.insert(key, name.to_string());
        }
        lines.skip_to_end_of("$PhysicalNames");
        Ok(())
    }

    pub(super) fn read_entities(&mut self, lines: &mut Lines) -> Result<(), MeshFileError> {
        let (_, counts) = lines.integers(4)?;
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                self.read_entity(lines, dimension)?;
            }
        }
        lines.skip_to_end_of("$Entities");
        Ok(())
    }

    /// Tag, a point or the two corners of a box, then the number of groups and the groups.
    fn read_entity(&mut self, lines: &mut Lines, dimension: i64) -> Result<(), MeshFileError> {
        let (line, row) = lines.expect_row()?;
        let mut words = row.split_ascii_whitespace();
        let tag = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let extent = if dimension == 0 { 3 } else { 6 };
        let mut words = words.skip(extent);
        let count: usize = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let groups: Result<_, _> = words
            .take(count)
            .map(|word| text::number(lines.path, line, word))
            .collect();
        self.of_entity.insert((dimension, tag), groups?);
        Ok(())
    }

    /// Name of a group; its number where it has none. A negative number means turned round.
    pub(super) fn name(&self, dimension: i64, group: i64) -> String {
        let group = group.saturating_abs();
        let name = self.names.get(&(dimension, group));
        name.cloned().unwrap_or_else(|| group.to_string())
    }
}

pub(super) fn elements_v2(
    lines: &mut Lines,
    groups: &Groups,
    draft: &mut HexDraft,
) -> Result<(), MeshFileError> {
    let (_, count) = lines.integers(1)?;
    for _ in 0..count[0] {
        let (line, numbers) = lines.integers(3)?;
        let tags = usize::try_from(numbers[2]).unwrap_or(0);
        // Without a group, the first tag is missing or 0.
        let group = numbers[3..]
            .iter()
            .take(tags.min(1))
            .copied()
            .filter(|&group| group != 0);
        let element = Element {
            line,
            label: numbers[0].cast_unsigned(),
            kind: numbers[1],
            groups: &group.collect::<Vec<_>>(),
            nodes: numbers.get(3 + tags..).unwrap_or_default(),
        };
        element.add_to(draft, groups, lines)?;
    }
    lines.skip_to_end_of("$Elements");
    Ok(())
}

pub(super) fn elements_v4(
    lines: &mut Lines,
    groups: &Groups,
    draft: &mut HexDraft,
) -> Result<(), MeshFileError> {
    let (_, head) = lines.integers(4)?;
    for _ in 0..head[0] {
        let (_, block) = lines.integers(4)?;
        let [dimension, entity, kind, count] = [block[0], block[1], block[2], block[3]];
        let of_entity = groups.of_entity.get(&(dimension, entity));
        for _ in 0..count {
            let (line, numbers) = lines.integers(1)?;
            let element = Element {
                line,
                label: numbers[0].cast_unsigned(),
                kind,
                groups: of_entity.map_or(&[], Vec::as_slice),
                nodes: &numbers[1..],
            };
            element.add_to(draft, groups, lines)?;
        }
    }
    lines.skip_to_end_of("$Elements");
    Ok(())
}

struct Element<'e> {
    line: usize,
    label: u64,
    kind: i64,
    groups: &'e [i64],
    nodes: &'e [i64],
}

impl Element<'_> {
    fn add_to(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        lines: &Lines,
    ) -> Result<(), MeshFileError> {
        match self.kind {
            5 => draft.hex(DraftHex {
                label: self.label,
                line: Some(self.line),
                nodes: self.corners(lines)?,
            }),
            3 => self.add_quad(draft, groups, lines),
            1 => self.add_nodes(draft, groups, 1),
            15 => self.add_nodes(draft, groups, 0),
            other => Err(MeshFileError::NotHexahedron {
                at: lines.at(self.line),
                element: self.label,
                kind: kind_in_words(other),
            }),
        }
    }

    fn corners<const N: usize>(&self, lines: &Lines) -> Result<[u64; N], MeshFileError> {
        let corners = <[i64; N]>::try_from(self.nodes).map_err(|_| {
            let found = self.nodes.len();
            let what = format!("element {} has {found} nodes; its type has {N}", self.label);
            lines.at(self.line).error(what)
        })?;
        Ok(corners.map(i64::cast_unsigned))
    }

    fn add_quad(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        lines: &Lines,
    ) -> Result<(), MeshFileError> {
        let corners = self.corners(lines)?;
        for &group in self.groups {
            draft.quad(&groups.name(2, group), Some(self.line), corners);
        }
        Ok(())
    }

    fn add_nodes(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        dimension: i64,
    ) -> Result<(), MeshFileError> {
        for &group in self.groups {
            let nodes = self.nodes.iter().map(|node| node.cast_unsigned());
            draft.set_nodes(&groups.name(dimension, group), nodes);
        }
        Ok(())
    }
}

fn kind_in_words(kind: i64) -> String {
    let name = match kind {
        2 => "3-node triangle",
        4 => "4-node tetrahedron",
        6 => "6-node prism",
        7 => "5-node pyramid",
        9 => "6-node triangle",
        11 => "10-node tetrahedron",
        12 => "27-node hexahedron",
        16 => "8-node quadrangle",
        17 => "20-node hexahedron",
        _ => return kind.to_string(),
    };
    format!("{kind} ({name})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::fixtures::{message, two_cubes};

    const V2: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 4 \"corner\"
2 1 \"top side\"
3 9 \"insert\"
$EndPhysicalNames
$Nodes
12
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
7 0 0 1
8 1 0 1
9 2 0 1
10 0 1 1
11 1 1 1
12 2 1 1
$EndNodes
$Elements
6
1 15 2 4 1 1
2 1 2 7 1 1 2
3 3 2 1 6 7 10 11 8
4 3 2 1 6 8 9 12 11
5 5 2 9 1 1 2 5 4 7 8 11 10
6 5 2 9 1 2 3 6 5 8 9 12 11
$EndElements
";

    const V4: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 \"top side\"
$EndPhysicalNames
$Entities
1 0 1 1
1 0 0 0 1 4
6 0 0 1 2 1 1 1 -1 4 1 2 3 4
1 0 0 0 2 1 1 1 9 6 1 2 3 4 5 6
$EndEntities
$Nodes
2 12 1 12
2 6 0 6
7
8
9
10
11
12
0 0 1
1 0 1
2 0 1
0 1 1
1 1 1
2 1 1
3 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
3 5 1 5
0 1 15 1
1 1
2 6 3 2
2 7 10 11 8
3 8 9 12 11
3 1 5 2
4 1 2 5 4 7 8 11 10
5 2 3 6 5 8 9 12 11
$EndElements
$Periodic
0
$EndPeriodic
";

    fn read(content: &str) -> Result<HexFile, MeshFileError> {
        parse(Path::new("a.msh"), content.as_bytes())
    }

    #[test]
    fn version_2_is_read() {
        let file = read(V2).unwrap();
        assert_eq!(file.mesh, two_cubes());
        assert_eq!(
            file.surface("top side").unwrap().quads,
            [[6, 7, 10, 9], [7, 8, 11, 10]]
        );
        assert_eq!(file.node_set("corner").unwrap().nodes, [0]);
        assert_eq!(file.node_set("7").unwrap().nodes, [0, 1]);
    }

    #[test]
    fn version_4_is_read() {
        let file = read(V4).unwrap();
        assert!((file.mesh.volume() - 2.0).abs() < 1e-12);
        assert_eq!(
            file.mesh.nodes[0].as_slice(),
            [0.0, 0.0, 1.0],
            "in the order of the file"
        );
        assert_eq!(
            file.surface("top side").unwrap().quads,
            [[0, 1, 4, 3], [1, 2, 5, 4]]
        );
        assert_eq!(file.node_set("4").unwrap().nodes, [6]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let said = |from, to| message(read(&V2.replace(from, to)));
        assert!(said("2.2 0 8", "2.2 1 8").starts_with("a.msh:2: is Gmsh version 2.2 as binary"));
        assert!(said("2.2 0 8", "4.0 0 8").contains("save it as version 4.1 or 2.2, ASCII"));
        assert!(said("2.2 0 8", "2.2").contains("the format line needs"));
        assert!(said("$MeshFormat\n2.2 0 8\n", "solid\n").starts_with("a.msh:1: does not start"));
        assert!(said("2 1 0 0", "2 1 0").starts_with("a.msh:13: a point needs"));
        assert!(said("2 1 0 0", "2 1e999 0 0").starts_with("a.msh:13: node 2 has"));
        let kind = said("6 5 2 9 1 2 3 6 5 8 9 12 11", "6 4 2 9 1 2 3 6 8");
        assert!(
            kind.starts_with("a.msh:32: element 6 is of type 4 (4-node tetrahedron)"),
            "{kind}"
        );
        assert!(
            said("8 9 12 11\n$End", "8 9 12\n$End").contains("element 6 has 7 nodes; its type")
        );
        assert!(said("9 12 11\n$End", "9 12 77\n$End").contains("element 6 names vertex 77"));
        let quad = said("7 10 11 8\n", "2 5 11 8\n");
        assert!(
            quad.starts_with("a.msh:29: a face of surface \"top side\""),
            "{quad}"
        );
        assert!(
            said("1 2 5 4 7 8 11 10", "7 8 11 10 1 2 5 4").contains("hexahedron 5 is inverted")
        );
        assert!(said("12\n1 0", "40\n1 0").starts_with("a.msh:24: \"$EndNodes\" is not a number"));
        let cut = message(read(V2.split("5 5 2").next().unwrap()));
        assert!(cut.contains("ends in the middle of a section"), "{cut}");
        assert!(said("6\n1 15", "0\n1 15").contains("holds no hexahedra"));
        assert!(said("1 15 2 4 1 1", "1 15").contains("this row has 2 numbers; it needs 3"));
    }
}
