//! Nodes, elements, sets and surfaces.

use std::collections::HashMap;
use std::io::{self, Write};

use crate::Vec3;
use condyle_fem::{HEX_FACES, HexMesh};

use super::writer::{InpWriter, real};

/// Type of the triangles of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidTriangle {
    /// Rigid element, Abaqus/Standard and Explicit.
    R3d3,
    /// Shell element, for a body made rigid by `*RIGID BODY` with a section of its own.
    S3,
}

impl<W: Write> InpWriter<W> {
    /// `*NODE`, labelled from `first`, all in the set `nset`.
    pub fn nodes(&mut self, first: u32, nodes: &[Vec3], nset: &str) -> io::Result<()> {
        self.keyword(&format!("*NODE, NSET={nset}"))?;
        for (label, node) in (first..).zip(nodes) {
            let [x, y, z] = [node.x, node.y, node.z].map(real);
            writeln!(self.out, "{label}, {x}, {y}, {z}")?;
        }
        Ok(())
    }

    /// `*ELEMENT` of a hexahedral type such as C3D8 or C3D8R, labelled from `first`; node 0 of the
    /// mesh has the label `first_node`.
    pub fn hexahedra(
        &mut self,
        kind: &str,
        first: u32,
        hexes: &[[u32; 8]],
        first_node: u32,
        elset: &str,
    ) -> io::Result<()> {
        self.elements(kind, first, hexes, first_node, elset)
    }

    /// `*ELEMENT` of rigid or shell triangles, labelled from `first`; vertex 0 has the label
    /// `first_node`.
    pub fn triangles(
        &mut self,
        kind: RigidTriangle,
        first: u32,
        triangles: &[[u32; 3]],
        first_node: u32,
        elset: &str,
    ) -> io::Result<()> {
        let kind = match kind {
            RigidTriangle::R3d3 => "R3D3",
            RigidTriangle::S3 => "S3",
        };
        self.elements(kind, first, triangles, first_node, elset)
    }

    /// `*ELEMENT` of wedges (C3D6), labelled from `first`; vertex 0 has the label `first_node`.
    pub fn wedges(
        &mut self,
        first: u32,
        wedges: &[[u32; 6]],
        first_node: u32,
        elset: &str,
    ) -> io::Result<()> {
        self.elements("C3D6", first, wedges, first_node, elset)
    }

    fn elements<const N: usize>(
        &mut self,
        kind: &str,
        first: u32,
        elements: &[[u32; N]],
        first_node: u32,
        elset: &str,
    ) -> io::Result<()> {
        self.keyword(&format!("*ELEMENT, TYPE={kind}, ELSET={elset}"))?;
        for (label, nodes) in (first..).zip(elements) {
            let words = nodes.map(|node| (node + first_node).to_string());
            writeln!(self.out, "{label}, {}", words.join(", "))?;
        }
        Ok(())
    }

    /// `*NSET` by labels.
    pub fn node_set(
        &mut self,
        name: &str,
        labels: impl IntoIterator<Item = u32>,
    ) -> io::Result<()> {
        self.keyword(&format!("*NSET, NSET={name}"))?;
        self.labels(labels)
    }

    /// `*ELSET` by labels.
    pub fn element_set(
        &mut self,
        name: &str,
        labels: impl IntoIterator<Item = u32>,
    ) -> io::Result<()> {
        self.keyword(&format!("*ELSET, ELSET={name}"))?;
        self.labels(labels)
    }

    /// `*SURFACE` of element faces, each a label and a face from 1 to 6: see [`element_faces`].
    pub fn surface_of_faces(&mut self, name: &str, faces: &[(u32, u8)]) -> io::Result<()> {
        self.keyword(&format!("*SURFACE, NAME={name}, TYPE=ELEMENT"))?;
        faces
            .iter()
            .try_for_each(|(label, face)| writeln!(self.out, "{label}, S{face}"))
    }

    /// `*SURFACE` of the outer side (SPOS) of an element set of triangles.
    pub fn surface_of_set(&mut self, name: &str, elset: &str) -> io::Result<()> {
        self.keyword(&format!("*SURFACE, NAME={name}, TYPE=ELEMENT"))?;
        writeln!(self.out, "{elset}, SPOS")
    }

    /// `*RIGID BODY` of an element set, moved by its reference node.
    pub fn rigid_body(&mut self, elset: &str, reference_node: u32) -> io::Result<()> {
        self.keyword(&format!(
            "*RIGID BODY, ELSET={elset}, REF NODE={reference_node}"
        ))
    }

    /// `*MATERIAL`, linear elastic: Young's modulus, MPa; Poisson's ratio; density, tonne/mm^3.
    pub fn elastic_material(
        &mut self,
        name: &str,
        young_mpa: f64,
        poisson: f64,
        density: f64,
    ) -> io::Result<()> {
        self.keyword(&format!("*MATERIAL, NAME={name}"))?;
        self.keyword("*ELASTIC")?;
        self.reals(&[young_mpa, poisson])?;
        self.keyword("*DENSITY")?;
        self.reals(&[density])
    }

    /// `*SOLID SECTION`: the material of an element set.
    pub fn solid_section(&mut self, elset: &str, material: &str) -> io::Result<()> {
        self.keyword(&format!(
            "*SOLID SECTION, ELSET={elset}, MATERIAL={material}"
        ))
    }

    /// A point mass, tonne, and its moments of inertia about x, y and z, tonne mm^2, at a node;
    /// takes the two element labels from `first`.
    pub fn mass_and_inertia(
        &mut self,
        name: &str,
        first: u32,
        node: u32,
        mass: f64,
        inertia: [f64; 3],
    ) -> io::Result<()> {
        self.keyword(&format!("*ELEMENT, TYPE=MASS, ELSET={name}-mass"))?;
        writeln!(self.out, "{first}, {node}")?;
        self.keyword(&format!("*MASS, ELSET={name}-mass"))?;
        self.reals(&[mass])?;
        self.keyword(&format!("*ELEMENT, TYPE=ROTARYI, ELSET={name}-inertia"))?;
        writeln!(self.out, "{}, {node}", first + 1)?;
        self.keyword(&format!("*ROTARY INERTIA, ELSET={name}-inertia"))?;
        let [x, y, z] = inertia;
        self.reals(&[x, y, z, 0.0, 0.0, 0.0])
    }
}

/// The element label and face number, 1 to 6, of quads on the boundary of a mesh whose first
/// hexahedron has the label `first`; a quad that is no face of the boundary is left out.
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

fn sorted(mut quad: [u32; 4]) -> [u32; 4] {
    quad.sort_unstable();
    quad
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::formats::inp;
    use crate::formats::inp_writer::writer::tests::written;
    use crate::formats::tests::two_cubes;

    #[test]
    fn a_mesh_with_sets_and_surface_is_read_back() {
        let mesh = two_cubes();
        let top = [[6, 7, 10, 9], [7, 8, 11, 10]];
        let text = written(|inp| {
            inp.heading("insert")?;
            inp.nodes(1, &mesh.nodes, "insert-nodes")?;
            inp.hexahedra("C3D8", 101, &mesh.hexes, 1, "insert")?;
            inp.node_set("backside", 1..=6)?;
            inp.element_set("last", [102])?;
            inp.surface_of_faces("articulating", &element_faces(&mesh, &top, 101))
        });
        let file = inp::parse(Path::new("a.inp"), text.as_bytes()).unwrap();
        assert_eq!(file.mesh, mesh);
        assert_eq!(file.surface("articulating").unwrap().quads, top);
        assert_eq!(file.node_set("backside").unwrap().nodes, [0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn long_sets_are_broken_into_lines_of_sixteen() {
        let text = written(|inp| inp.node_set("all", 1..=20));
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[1].matches(',').count(), 16);
        assert_eq!(rows[2], "17, 18, 19, 20,");
    }

    #[test]
    fn a_rigid_body_of_triangles_is_written() {
        let text = written(|inp| {
            inp.triangles(RigidTriangle::R3d3, 7, &[[0, 2, 1]], 50, "femur")?;
            inp.triangles(RigidTriangle::S3, 8, &[[0, 1, 3]], 50, "shell")?;
            inp.surface_of_set("femur-surface", "femur")?;
            inp.rigid_body("femur", 99)
        });
        let expected = "*ELEMENT, TYPE=R3D3, ELSET=femur\n7, 50, 52, 51\n\
            *ELEMENT, TYPE=S3, ELSET=shell\n8, 50, 51, 53\n\
            *SURFACE, NAME=femur-surface, TYPE=ELEMENT\nfemur, SPOS\n\
            *RIGID BODY, ELSET=femur, REF NODE=99\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn material_section_and_mass_are_written() {
        let text = written(|inp| {
            inp.elastic_material("uhmwpe", 463.0, 0.46, 9.3e-10)?;
            inp.solid_section("insert", "uhmwpe")?;
            inp.mass_and_inertia("tray", 900, 5, 0.002, [1.5, 2.5, 3.5])
        });
        let expected = "*MATERIAL, NAME=uhmwpe\n*ELASTIC\n463.0, 0.46\n*DENSITY\n9.3e-10\n\
            *SOLID SECTION, ELSET=insert, MATERIAL=uhmwpe\n\
            *ELEMENT, TYPE=MASS, ELSET=tray-mass\n900, 5\n*MASS, ELSET=tray-mass\n0.002\n\
            *ELEMENT, TYPE=ROTARYI, ELSET=tray-inertia\n901, 5\n\
            *ROTARY INERTIA, ELSET=tray-inertia\n1.5, 2.5, 3.5, 0.0, 0.0, 0.0\n";
        assert_eq!(text, expected);
    }
}
