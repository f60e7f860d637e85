//! The articulating surface with its fields.

use condyle_fem::Vec3;

/// A surface of quads with values at its nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceFields {
    /// Node positions in the insert frame, mm.
    pub nodes: Vec<Vec3>,
    /// Nodes of each quad, from 0, anticlockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
    /// Name and a value a node of each field; the name carries the unit.
    pub fields: Vec<(String, Vec<f64>)>,
}

impl SurfaceFields {
    /// The field called `name`, a value a node.
    pub fn field(&self, name: &str) -> Option<&[f64]> {
        let (_, values) = self.fields.iter().find(|(known, _)| known == name)?;
        Some(values)
    }

    /// Positions of the corners of quad `quad`, mm.
    pub fn corners(&self, quad: [u32; 4]) -> [Vec3; 4] {
        quad.map(|node| self.nodes[node as usize])
    }

    /// Smallest and largest (x, z) of the surface, mm.
    pub(crate) fn bounds(&self) -> [(f64, f64); 2] {
        let span = |axis: usize| {
            let values = self.nodes.iter().map(move |node| node[axis]);
            (
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            )
        };
        [span(0), span(2)]
    }
}
