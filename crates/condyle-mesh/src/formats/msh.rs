//! Gmsh meshes, versions 2.2 and 4.1 as text: hexahedra, and quads of physical groups.

use std::{collections::HashMap, path::Path};

use super::{
    error::MeshFileError,
    hex_draft::{HexDraft, HexFile, not_hexahedron},
    text::{At, Rows, decode},
};

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    let content = decode(bytes);
    let mut file = Reader {
        rows: Rows::new(path, &content),
        group_names: HashMap::new(),
        groups_of_entity: HashMap::new(),
        draft: HexDraft::new(path),
    };
    let mut version = None;
    while let Some((at, section)) = file.rows.next() {
        match (section, version) {
            ("$MeshFormat", _) => version = Some(file.version()?),
            ("$PhysicalNames", _) => file.physical_names()?,
            (_, None) => {
                let problem = "does not start with $MeshFormat; is this a Gmsh file?";
                return Err(at.error(problem));
            }
            ("$Entities", Some(Version::V4)) => file.entities()?,
            ("$Nodes", Some(Version::V2)) => file.nodes_v2()?,
            ("$Nodes", Some(Version::V4)) => file.nodes_v4()?,
            ("$Elements", Some(Version::V2)) => file.elements_v2()?,
            ("$Elements", Some(Version::V4)) => file.elements_v4()?,
            _ => {}
        }
        let end = section.replacen('$', "$End", 1);
        while file.rows.next().is_some_and(|(_, row)| row != end) {}
    }
    file.draft.finish()
}

/// Gmsh's numbers of other kinds of elements.
const KINDS: [(i64, &str); 9] = [
    (2, "3-node triangle"),
    (4, "4-node tetrahedron"),
    (6, "6-node prism"),
    (7, "5-node pyramid"),
    (9, "6-node triangle"),
    (11, "10-node tetrahedron"),
    (12, "27-node hexahedron"),
    (16, "8-node quadrangle"),
    (17, "20-node hexahedron"),
];

#[derive(Clone, Copy)]
enum Version {
    V2,
    V4,
}

type Key = (i64, i64);

struct Reader<'t> {
    rows: Rows<'t>,
    group_names: HashMap<Key, String>,
    /// In version 4, elements belong to entities, and these to groups.
    groups_of_entity: HashMap<Key, Vec<i64>>,
    draft: HexDraft<'t>,
}

impl<'t> Reader<'t> {
    fn version(&mut self) -> Result<Version, MeshFileError> {
        let (at, row) = self.rows.required()?;
        let words: Vec<&str> = row.split_ascii_whitespace().collect();
        match words[..] {
            ["2.2", "0", ..] => Ok(Version::V2),
            ["4.1", "0", ..] => Ok(Version::V4),
            [version, kind, ..] => {
                let kind = if kind == "0" { "text" } else { "binary" };
                Err(at.error(format!(
                    "is Gmsh version {version} as {kind}; save it as version 4.1 or 2.2, ASCII"
                )))
            }
            _ => Err(at.error("the format line needs version, type and size")),
        }
    }

    /// Reads the next row as whole numbers, at least `min` of them.
    fn integers(&mut self, min: usize) -> Result<(At<'t>, Vec<i64>), MeshFileError> {
        let (at, row) = self.rows.required()?;
        let numbers = at.numbers(row.split_ascii_whitespace())?;
        if numbers.len() < min {
            let count = numbers.len();
            return Err(at.error(format!("this row has {count} numbers; it needs {min}")));
        }
        Ok((at, numbers))
    }

    /// Reads the head of a block of version 4: four numbers.
    fn head(&mut self) -> Result<[i64; 4], MeshFileError> {
        let (_, head) = self.integers(4)?;
        Ok([head[0], head[1], head[2], head[3]])
    }

    fn physical_names(&mut self) -> Result<(), MeshFileError> {
        for _ in 0..self.integers(1)?.1[0] {
            let (at, row) = self.rows.required()?;
            let mut words = row.splitn(3, char::is_whitespace);
            let mut number = || at.number(words.next().unwrap_or_default());
            let key = (number()?, number()?);
            let name = words.next().unwrap_or_default().trim().trim_matches('"');
            self.group_names.insert(key, name.to_string());
        }
        Ok(())
    }

    fn entities(&mut self) -> Result<(), MeshFileError> {
        for (dimension, count) in (0..).zip(self.integers(4)?.1) {
            for _ in 0..count {
                // A tag, a point or the two corners of a box, then the number of groups and the groups.
                let (at, row) = self.rows.required()?;
                let mut words = row.split_ascii_whitespace();
                let tag = at.number(words.next().unwrap_or_default())?;
                let mut words = words.skip(if dimension == 0 { 3 } else { 6 });
                let count = at.number(words.next().unwrap_or_default())?;
                let groups = at.numbers(words.take(count))?;
                self.groups_of_entity.insert((dimension, tag), groups);
            }
        }
        Ok(())
    }

    fn nodes_v2(&mut self) -> Result<(), MeshFileError> {
        for _ in 0..self.integers(1)?.1[0] {
            let (at, row) = self.rows.required()?;
            let mut words = row.split_ascii_whitespace();
            let label = at.number(words.next().unwrap_or_default())?;
            self.draft.node(at, label, at.coordinates(words)?)?;
        }
        Ok(())
    }

    fn nodes_v4(&mut self) -> Result<(), MeshFileError> {
        let [blocks, ..] = self.head()?;
        for _ in 0..blocks {
            let [.., count] = self.head()?;
            let mut labels = Vec::new();
            for _ in 0..count {
                labels.push(self.integers(1)?.1[0]);
            }
            for label in labels {
                let (at, row) = self.rows.required()?;
                let position = at.coordinates(row.split_ascii_whitespace())?;
                self.draft.node(at, label.cast_unsigned(), position)?;
            }
        }
        Ok(())
    }

    fn elements_v2(&mut self) -> Result<(), MeshFileError> {
        for _ in 0..self.integers(1)?.1[0] {
            let (at, numbers) = self.integers(3)?;
            let tags = usize::try_from(numbers[2]).unwrap_or(0);
            // The first tag is the group; without one it is missing or 0.
            let groups = numbers[3..].iter().take(tags.min(1)).copied();
            let groups: Vec<i64> = groups.filter(|&group| group != 0).collect();
            let nodes = numbers.get(3 + tags..).unwrap_or_default();
            self.element(at, [numbers[0], numbers[1]], &groups, nodes)?;
        }
        Ok(())
    }

    fn elements_v4(&mut self) -> Result<(), MeshFileError> {
        let [blocks, ..] = self.head()?;
        for _ in 0..blocks {
            let [dimension, entity, kind, count] = self.head()?;
            let groups = self.groups_of_entity.get(&(dimension, entity)).cloned();
            let groups = groups.unwrap_or_default();
            for _ in 0..count {
                let (at, numbers) = self.integers(1)?;
                self.element(at, [numbers[0], kind], &groups, &numbers[1..])?;
            }
        }
        Ok(())
    }

    fn element(
        &mut self,
        at: At,
        [label, kind]: [i64; 2],
        groups: &[i64],
        nodes: &[i64],
    ) -> Result<(), MeshFileError> {
        let (name, label) = (format_args!("element {label}"), label.cast_unsigned());
        match kind {
            5 => self.draft.hex(at, label, at.corners(name, nodes)?)?,
            3 => {
                let corners = at.corners(name, nodes)?;
                for &group in groups {
                    self.draft.quad(&self.name(group), at, corners);
                }
            }
            // Lines and points have neither volume nor faces.
            1 | 15 => {}
            other => return Err(not_hexahedron(at, label, other, &KINDS)),
        }
        Ok(())
    }

    /// Returns the name of a group of faces, or its number if it has none. A negative number means turned round.
    fn name(&self, group: i64) -> String {
        let group = group.saturating_abs();
        let name = self.group_names.get(&(2, group));
        name.cloned().unwrap_or_else(|| group.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::tests::{message, two_cubes};

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
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let reported = |from, to| message(read(&V2.replace(from, to)));
        assert!(
            reported("2.2 0 8", "2.2 1 8").starts_with("a.msh:2: is Gmsh version 2.2 as binary")
        );
        assert!(reported("2.2 0 8", "4.0 0 8").contains("save it as version 4.1 or 2.2, ASCII"));
        assert!(reported("2.2 0 8", "2.2").contains("the format line needs"));
        assert!(
            reported("$MeshFormat\n2.2 0 8\n", "solid\n").starts_with("a.msh:1: does not start")
        );
        assert!(reported("2 1 0 0", "2 1 0").starts_with("a.msh:13: a point needs"));
        assert!(reported("2 1 0 0", "2 1e999 0 0").starts_with("a.msh:13: node 2 has"));
        let kind = reported("6 5 2 9 1 2 3 6 5 8 9 12 11", "6 4 2 9 1 2 3 6 8");
        assert!(
            kind.starts_with("a.msh:32: element 6 is of type 4 (4-node tetrahedron)"),
            "{kind}"
        );
        assert!(
            reported("8 9 12 11\n$End", "8 9 12\n$End")
                .contains("element 6 has 7 corners; its type")
        );
        assert!(reported("9 12 11\n$End", "9 12 77\n$End").contains("element 6 names vertex 77"));
        let quad = reported("7 10 11 8\n", "2 5 11 8\n");
        assert!(
            quad.starts_with("a.msh:29: a face of surface \"top side\""),
            "{quad}"
        );
        assert!(
            reported("1 2 5 4 7 8 11 10", "7 8 11 10 1 2 5 4").contains("hexahedron 5 is inverted")
        );
        assert!(
            reported("12\n1 0", "40\n1 0").starts_with("a.msh:24: \"$EndNodes\" is not a number")
        );
        let cut = message(read(V2.split("5 5 2").next().unwrap()));
        assert!(cut.contains("ends in the middle of a section"), "{cut}");
        assert!(reported("6\n1 15", "0\n1 15").contains("holds no hexahedra"));
        assert!(reported("1 15 2 4 1 1", "1 15").contains("this row has 2 numbers; it needs 3"));
    }
}
