//! What the checks look at.

use std::collections::BTreeMap;

use condyle::{
    Vec3,
    evolve::March,
    geometry::{ArticulatingSurface, Insert},
};
use condyle_io::results::Summary;

/// A march that is done, its surface, and what it came to.
pub(super) struct Finished<'a> {
    pub march: &'a March,
    pub summary: &'a Summary,
    pub surface: ArticulatingSurface,
    /// Ends of the edges at which the articulating surface ends.
    rim: Vec<[Vec3; 2]>,
}

impl<'a> Finished<'a> {
    pub fn new(march: &'a March, summary: &'a Summary) -> Self {
        let surface = march.insert().surface();
        Self {
            rim: rim_of(march.insert(), &surface),
            march,
            summary,
            surface,
        }
    }

    /// Distance of a surface node from the rim, mm.
    pub fn distance_to_rim_mm(&self, node: usize) -> f64 {
        let place = self.surface.positions[node];
        let distances = self.rim.iter().map(|edge| distance_mm(&place, edge));
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// Edges that one face alone has.
fn rim_of(insert: &Insert, surface: &ArticulatingSurface) -> Vec<[Vec3; 2]> {
    let mut faces_at = BTreeMap::<[u32; 2], usize>::new();
    for face in insert.surface_faces() {
        for side in 0..4 {
            let (a, b) = (face[side], face[(side + 1) % 4]);
            *faces_at.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let at_end = faces_at.into_iter().filter(|(_, faces)| *faces == 1);
    at_end
        .map(|(edge, _)| edge.map(|node| surface.positions[node as usize]))
        .collect()
}

/// Distance of a place from a straight line between two others, mm.
fn distance_mm(place: &Vec3, [from, to]: &[Vec3; 2]) -> f64 {
    let along = to - from;
    let part = (place - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
    (place - (from + along * part.clamp(0.0, 1.0))).norm()
}
