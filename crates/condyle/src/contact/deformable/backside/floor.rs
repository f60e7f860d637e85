//! The flat part of a backside, which rests on the tray.

use std::collections::BTreeMap;

use condyle_fem::HexMesh;

use crate::Vec3;

/// A face of the backside that leans from straight down by more than this cosine tells, 15 degrees, is a wall.
const MIN_COSINE: f64 = 0.966;
/// Flat faces farther than this off the middle height of all are recesses or pegs, mm.
const MAX_OFF_MM: f64 = 0.25;

/// The flat part of a backside.
pub(in super::super) struct Floor {
    /// Its normal, into the insert.
    pub normal: Vec3,
    /// Its mesh nodes, ascending.
    pub nodes: Vec<u32>,
    /// Of each its share of the floor, mm2.
    pub share_mm2: Vec<f64>,
    /// How much of the backside, as the tray sees it, is floor.
    pub part: f64,
}

/// A face of the backside.
struct Face {
    quad: [u32; 4],
    inward: Vec3,
    middle: Vec3,
}

impl Floor {
    /// That of a backside with those nodes, ascending.
    pub fn of(mesh: &HexMesh, backside: &[u32]) -> Self {
        let is_own = |node: &u32| backside.binary_search(node).is_ok();
        let mut quads = mesh.boundary_quads();
        quads.retain(|quad| quad.iter().all(is_own));
        let faces: Vec<Face> = quads.iter().map(|quad| Face::of(mesh, *quad)).collect();
        let level = level_faces(&faces);
        let inward: Vec3 = level.iter().map(|face| face.inward).sum();
        let normal = inward.try_normalize(0.0).unwrap_or_else(Vec3::y);
        let flat = at_middle_height(level, &normal);
        let mut shares = BTreeMap::<u32, f64>::new();
        for (node, share) in mesh.traction_forces(&flat, |_, outward| -outward) {
            *shares.entry(node).or_default() += share.dot(&normal);
        }
        let whole_mm2: f64 = faces.iter().map(|face| face.inward.dot(&normal)).sum();
        let (nodes, share_mm2): (Vec<u32>, Vec<f64>) = shares.into_iter().unzip();
        Self {
            part: share_mm2.iter().sum::<f64>() / whole_mm2,
            nodes,
            share_mm2,
            normal,
        }
    }
}

impl Face {
    fn of(mesh: &HexMesh, quad: [u32; 4]) -> Self {
        let [a, b, c, d] = quad.map(|node| mesh.nodes[node as usize]);
        Self {
            quad,
            inward: -(c - a).cross(&(d - b)) / 2.0,
            middle: (a + b + c + d) / 4.0,
        }
    }
}

/// The faces that hardly lean.
fn level_faces(faces: &[Face]) -> Vec<&Face> {
    let is_level = |face: &&Face| face.inward.y > MIN_COSINE * face.inward.norm();
    faces.iter().filter(is_level).collect()
}

/// Those near the height that halves their area.
fn at_middle_height(mut level: Vec<&Face>, normal: &Vec3) -> Vec<[u32; 4]> {
    let height_mm = |face: &Face| face.middle.dot(normal);
    level.sort_by(|a, b| height_mm(a).total_cmp(&height_mm(b)));
    let half_mm2 = level.iter().map(|face| face.inward.norm()).sum::<f64>() / 2.0;
    let mut below_mm2 = 0.0;
    let middle = level.iter().find(|face| {
        below_mm2 += face.inward.norm();
        below_mm2 >= half_mm2
    });
    let middle_mm = middle.map_or(0.0, |face| height_mm(face));
    let flat = level.iter();
    let flat = flat.filter(|face| (height_mm(face) - middle_mm).abs() <= MAX_OFF_MM);
    flat.map(|face| face.quad).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Meshing, flat_insert};

    #[test]
    fn a_recess_and_a_slope_are_no_floor() {
        let meshing = Meshing {
            edge_mm: 1.0,
            layers: 2,
        };
        let insert = flat_insert((20.0, 10.0), 5.0, meshing).unwrap();
        let (mut mesh, backside) = (insert.mesh().clone(), insert.backside_nodes());
        let whole = Floor::of(&mesh, backside);
        assert!((whole.normal - Vec3::y()).norm() < 1e-12 && (whole.part - 1.0).abs() < 1e-12);
        for &node in backside {
            let place = &mut mesh.nodes[node as usize];
            if place.x > 5.5 {
                place.y += place.x - 5.5;
            } else if place.x < -4.5 {
                place.y += 0.5;
            }
        }
        let floor = Floor::of(&mesh, backside);
        // From -4 mm, a step inside of the recess, to 5 mm.
        assert!((floor.share_mm2.iter().sum::<f64>() - 90.0).abs() < 1e-9);
        assert!((floor.part - 0.45).abs() < 0.01, "{}", floor.part);
    }
}
