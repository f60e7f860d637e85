//! The whole of a Gmsh mesh, section by section.

use std::path::Path;

use super::super::error::{FileLine, MeshFileError};
use super::super::hex_draft::HexDraft;
use super::super::hex_file::HexFile;
use super::super::text;
use super::elements::{elements_v2, elements_v4};
use super::groups::Groups;
use super::lines::Lines;
use super::nodes::{nodes_v2, nodes_v4};

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
