//! Thick cylinders and spheres of hexahedra, held by their planes of symmetry.

use std::collections::BTreeMap;

use condyle_fem::{Elastic, ElasticSolid, HexMesh, Vec3};

/// Inner and outer radius, mm.
pub const INNER_MM: f64 = 10.0;
pub const OUTER_MM: f64 = 20.0;

/// Distances below this are none, mm.
const NEAR_MM: f64 = 1e-9;

/// Grid of nodes by three counts, and the hexahedra between them.
pub fn grid(n: [usize; 3], place: impl Fn([f64; 3]) -> Vec3) -> HexMesh {
    let id = |i: usize, j: usize, k: usize| (i + (n[0] + 1) * (j + (n[1] + 1) * k)) as u32;
    let part = |i: usize, axis: usize| i as f64 / n[axis] as f64;
    let (mut nodes, mut hexes) = (Vec::new(), Vec::new());
    for k in 0..=n[2] {
        for j in 0..=n[1] {
            nodes.extend((0..=n[0]).map(|i| place([part(i, 0), part(j, 1), part(k, 2)])));
        }
    }
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let quad = |k| {
                    [
                        id(i, j, k),
                        id(i + 1, j, k),
                        id(i + 1, j + 1, k),
                        id(i, j + 1, k),
                    ]
                };
                let ([a, b, c, d], [e, f, g, h]) = (quad(k), quad(k + 1));
                hexes.push([a, b, c, d, e, f, g, h]);
            }
        }
    }
    HexMesh {
        nodes,
        hexes: hexes.into(),
    }
}

/// A quarter of a long cylinder, `elements` through the wall, one along the axis z.
pub fn cylinder(elements: usize) -> HexMesh {
    grid([elements, 2 * elements, 1], |[r, turn, z]| {
        let (radius, angle) = (radius_mm(r), std::f64::consts::FRAC_PI_2 * turn);
        Vec3::new(radius * angle.cos(), radius * angle.sin(), 2.0 * z)
    })
}

/// An eighth of a sphere, `elements` through the wall: three patches of a cube, laid on the sphere.
pub fn sphere(elements: usize) -> HexMesh {
    let mut sphere = Merged::default();
    for axis in 0..3 {
        sphere.add(&grid([elements; 3], |[r, u, v]| {
            let side = |part: f64| (std::f64::consts::FRAC_PI_4 * part).tan();
            let mut ray = Vec3::repeat(1.0);
            (ray[(axis + 1) % 3], ray[(axis + 2) % 3]) = (side(u), side(v));
            ray.normalize() * radius_mm(r)
        }));
    }
    HexMesh {
        nodes: sphere.nodes,
        hexes: sphere.hexes.into(),
    }
}

fn radius_mm(part: f64) -> f64 {
    INNER_MM + (OUTER_MM - INNER_MM) * part
}

/// Meshes that share the nodes at the same place.
#[derive(Default)]
struct Merged {
    nodes: Vec<Vec3>,
    hexes: Vec<[u32; 8]>,
    known: BTreeMap<[i64; 3], u32>,
}

impl Merged {
    fn add(&mut self, mesh: &HexMesh) {
        let numbers: Vec<u32> = mesh.nodes.iter().map(|node| self.number(node)).collect();
        let hexes = mesh.hexes.iter();
        self.hexes
            .extend(hexes.map(|hex| hex.map(|node| numbers[node as usize])));
    }

    fn number(&mut self, node: &Vec3) -> u32 {
        let key = [0, 1, 2].map(|axis| (node[axis] / 1e-6).round() as i64);
        *self.known.entry(key).or_insert_with(|| {
            self.nodes.push(*node);
            self.nodes.len() as u32 - 1
        })
    }
}

/// A solid that cannot leave the planes through the origin; nor, if it is `plane`, move along z.
pub fn symmetric(mesh: &HexMesh, elastic: Elastic, plane: bool) -> ElasticSolid {
    let on_plane = |node: &Vec3, axis: usize| node[axis].abs() < NEAR_MM || (plane && axis == 2);
    let nodes = (0u32..).zip(&mesh.nodes);
    let supports = nodes.map(|(n, node)| (n, [0, 1, 2].map(|axis| on_plane(node, axis))));
    ElasticSolid::with_supports(mesh, elastic, supports).expect("a solid that is held")
}

/// Forces of a pressure of 1 MPa on the inside; `distance` is that of a place from axis or centre.
pub fn inner_pressure(mesh: &HexMesh, distance: impl Fn(&Vec3) -> f64) -> Vec<(u32, Vec3)> {
    let mut quads = mesh.boundary_quads();
    let inside = |place: Vec3| (distance(&place) - INNER_MM).abs() < NEAR_MM;
    quads.retain(|quad| mesh.positions(quad).all(inside));
    mesh.traction_forces(&quads, |_, normal| -normal)
}

/// Mean outward motion of the nodes at a radius, mm.
pub fn radial_mm(
    mesh: &HexMesh,
    displacements: &[Vec3],
    radius_mm: f64,
    out: impl Fn(&Vec3) -> Vec3,
) -> f64 {
    let there = |node: &Vec3| (out(node).norm() - radius_mm).abs() < NEAR_MM;
    let nodes = mesh.nodes.iter().zip(displacements);
    let motions: Vec<f64> = nodes
        .filter(|(node, _)| there(node))
        .map(|(node, u)| out(node).normalize().dot(u))
        .collect();
    motions.iter().sum::<f64>() / motions.len() as f64
}

/// The part of a place across the axis of a cylinder.
pub fn across(place: &Vec3) -> Vec3 {
    Vec3::new(place.x, place.y, 0.0)
}
