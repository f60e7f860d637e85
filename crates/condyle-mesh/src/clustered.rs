//! A triangle mesh made coarser, for pictures.

use std::collections::BTreeMap;

use crate::{Vec3, triangle_mesh::TriangleMesh};

impl TriangleMesh {
    /// The mesh with all vertices of a cubic cell put together in their mean; triangles that fall in less
    /// than three cells are left out.
    ///
    /// A surface moves by less than a cell, and a flat one not at all. For pictures: nothing is computed
    /// from it.
    pub fn clustered(&self, cell_mm: f64) -> Self {
        let cell = |vertex: &Vec3| {
            let place = vertex / cell_mm;
            [place.x, place.y, place.z].map(|along| along.floor() as i64)
        };
        let mut numbers = BTreeMap::new();
        let mut sums: Vec<(Vec3, f64)> = Vec::new();
        let mut number_of = Vec::with_capacity(self.vertices.len());
        for vertex in &self.vertices {
            let number = *numbers.entry(cell(vertex)).or_insert(sums.len());
            if number == sums.len() {
                sums.push((Vec3::zeros(), 0.0));
            }
            sums[number].0 += vertex;
            sums[number].1 += 1.0;
            number_of.push(number as u32);
        }
        let moved = self
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| number_of[corner as usize]));
        Self {
            vertices: sums.iter().map(|(sum, count)| sum / *count).collect(),
            triangles: moved
                .filter(|[a, b, c]| a != b && b != c && c != a)
                .collect(),
        }
    }
}
