//! Abaqus input files, written: keywords, lines, meshes, sets and surfaces.
//!
//! Syntax after the Abaqus Keywords Reference. Labels count from 1; a block of nodes or elements begins at the label that
//! the caller gives, and its items are numbered in order.

use std::collections::HashMap;
use std::io::{self, Write};

use super::hex_draft::sorted;
use crate::Vec3;
use condyle_fem::{HEX_FACES, HexMesh};

/// Writes Abaqus keywords in the order of the calls.
///
/// Every method returns the errors of the underlying writer. Units are the caller's.
#[derive(Debug)]
pub struct InpWriter<W: Write> {
    out: W,
}

impl<W: Write> InpWriter<W> {
    /// Returns a writer to `out`.
    pub fn new(out: W) -> Self {
        Self { out }
    }

    /// Writes `*HEADING` with its text.
    pub fn heading(&mut self, text: &str) -> io::Result<()> {
        self.keyword("*HEADING")?;
        text.lines().try_for_each(|line| self.line(line))
    }

    /// Writes each line of `text` as a comment.
    pub fn comment(&mut self, text: &str) -> io::Result<()> {
        text.lines()
            .try_for_each(|line| writeln!(self.out, "** {line}"))
    }

    /// Writes a keyword line.
    pub fn keyword(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{text}")
    }

    /// Writes a data line, without leading asterisks, which would make it a keyword.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{}", text.trim_start_matches('*'))
    }

    /// Writes a data line of numbers.
    pub fn reals(&mut self, values: &[f64]) -> io::Result<()> {
        let words: Vec<String> = values.iter().map(|&value| real(value)).collect();
        writeln!(self.out, "{}", words.join(", "))
    }

    /// Writes `*NODE`, labelled from `first`, all in the set `nset`.
    pub fn nodes(&mut self, first: u32, nodes: &[Vec3], nset: &str) -> io::Result<()> {
        self.keyword(&format!("*NODE, NSET={nset}"))?;
        for (label, node) in (first..).zip(nodes) {
            let [x, y, z] = [node.x, node.y, node.z].map(real);
            writeln!(self.out, "{label}, {x}, {y}, {z}")?;
        }
        Ok(())
    }

    /// Writes `*ELEMENT` of a type such as C3D8 or C3D6, labelled from `first`, by the labels of their nodes.
    pub fn elements<const N: usize>(
        &mut self,
        kind: &str,
        first: u32,
        elements: &[[u32; N]],
        elset: &str,
    ) -> io::Result<()> {
        self.keyword(&format!("*ELEMENT, TYPE={kind}, ELSET={elset}"))?;
        for (label, nodes) in (first..).zip(elements) {
            let words = nodes.map(|node| node.to_string());
            writeln!(self.out, "{label}, {}", words.join(", "))?;
        }
        Ok(())
    }

    /// Writes `*NSET` by labels, sixteen a line as the format allows.
    pub fn node_set(
        &mut self,
        name: &str,
        labels: impl IntoIterator<Item = u32>,
    ) -> io::Result<()> {
        self.keyword(&format!("*NSET, NSET={name}"))?;
        let words: Vec<String> = labels.into_iter().map(|label| label.to_string()).collect();
        words
            .chunks(16)
            .try_for_each(|row| writeln!(self.out, "{},", row.join(", ")))
    }

    /// Writes `*SURFACE` of element faces, each a label and a face from 1 to 6: see [`element_faces`].
    pub fn surface_of_faces(&mut self, name: &str, faces: &[(u32, u8)]) -> io::Result<()> {
        self.keyword(&format!("*SURFACE, NAME={name}, TYPE=ELEMENT"))?;
        faces
            .iter()
            .try_for_each(|(label, face)| writeln!(self.out, "{label}, S{face}"))
    }
}

/// Formats a number in the shortest form that reads back the same or, if that exceeds the twenty characters of a field,
/// with thirteen digits.
fn real(value: f64) -> String {
    let shortest = format!("{value:?}");
    if shortest.len() <= 20 {
        return shortest;
    }
    format!("{value:.12e}")
}

/// Returns the element label and face number, 1 to 6, of quads on the boundary of a mesh whose first hexahedron has the
/// label `first`; quads that are no face of the mesh are left out.
pub fn element_faces(mesh: &HexMesh, quads: &[[u32; 4]], first: u32) -> Vec<(u32, u8)> {
    let mut faces: HashMap<[u32; 4], (u32, u8)> = HashMap::new();
    for (label, hex) in (first..).zip(mesh.hexes.iter()) {
        for (number, face) in (1..).zip(HEX_FACES) {
            faces.insert(sorted(face.map(|corner| hex[corner])), (label, number));
        }
    }
    quads
        .iter()
        .filter_map(|&quad| faces.get(&sorted(quad)).copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::formats::inp;
    use crate::formats::tests::two_cubes;

    fn written(calls: impl FnOnce(&mut InpWriter<Vec<u8>>) -> io::Result<()>) -> String {
        let mut writer = InpWriter::new(Vec::new());
        calls(&mut writer).unwrap();
        String::from_utf8(writer.out).unwrap()
    }

    #[test]
    fn heading_and_comments_cannot_become_keywords() {
        let text = written(|inp| {
            inp.heading("condyle\n*NODE")?;
            inp.comment("one\ntwo")
        });
        assert_eq!(text, "*HEADING\ncondyle\nNODE\n** one\n** two\n");
    }

    #[test]
    fn numbers_fit_their_field_and_read_back() {
        for value in [
            0.0,
            1.0,
            -0.07,
            33.8,
            1.0 / 3.0,
            -1.0 / 3e7,
            2.64e-7,
            1e300,
            -1.234_567_890_123_456_7e-101,
        ] {
            let text = real(value);
            assert!(text.len() <= 20, "{text}");
            let back: f64 = text.parse().unwrap();
            assert!((back - value).abs() <= 1e-12 * value.abs(), "{text}");
        }
        assert_eq!(
            (real(33.8), real(1.0), real(2.64e-7)),
            ("33.8".into(), "1.0".into(), "2.64e-7".into())
        );
    }

    #[test]
    fn a_mesh_with_sets_and_surface_is_read_back() {
        let mesh = two_cubes();
        let top = [[6, 7, 10, 9], [7, 8, 11, 10]];
        let labels: Vec<[u32; 8]> = mesh.hexes.iter().map(|hex| hex.map(|at| at + 1)).collect();
        let text = written(|inp| {
            inp.heading("insert")?;
            inp.nodes(1, &mesh.nodes, "insert-nodes")?;
            inp.elements("C3D8", 101, &labels, "insert")?;
            inp.node_set("backside", 1..=6)?;
            inp.surface_of_faces("articulating", &element_faces(&mesh, &top, 101))
        });
        assert!(
            text.contains("*NSET, NSET=backside\n1, 2, 3, 4, 5, 6,\n"),
            "{text}"
        );
        let file = inp::parse(Path::new("a.inp"), text.as_bytes()).unwrap();
        assert_eq!(file.mesh, mesh);
        assert_eq!(file.surface("articulating").unwrap().quads, top);
    }

    #[test]
    fn long_sets_are_broken_into_lines_of_sixteen() {
        let text = written(|inp| inp.node_set("all", 1..=20));
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[1].matches(',').count(), 16);
        assert_eq!(rows[2], "17, 18, 19, 20,");
    }
}
