//! The insert as worn so far, with its results at the nodes, in the knee of the case.

use condyle::{Vec3, evolve::March};
use condyle_fem::HexMesh;

use super::sides::{mesh_on_side, point_on_side};
use crate::case::Side;

/// The insert as worn so far, with the results of its last update at the nodes; what is not on the articulating
/// surface has none, which is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct InsertFields {
    /// The hexahedra, and where their nodes are now, mm.
    pub mesh: HexMesh,
    /// Name with its unit, and a value a node.
    pub scalars: Vec<(&'static str, Vec<f64>)>,
    /// Name with its unit, and a vector of the insert frame a node.
    pub vectors: Vec<(&'static str, Vec<[f64; 3]>)>,
    /// 1 at the nodes of the articulating surface.
    pub articulating: Vec<u8>,
}

impl InsertFields {
    /// Those of a march, in the knee of that side.
    pub fn of(march: &March, side: Side) -> Self {
        let surface = march.insert().surface_nodes();
        let mesh = mesh_on_side(march.insert().mesh(), side);
        let count = mesh.nodes.len();
        Self {
            scalars: scalars(march, count),
            vectors: vec![("principal_direction", directions(march, side, count))],
            articulating: spread(surface, &vec![1; surface.len()], 0, count),
            mesh,
        }
    }
}

fn scalars(march: &March, count: usize) -> Vec<(&'static str, Vec<f64>)> {
    let (surface, fields) = (march.insert().surface_nodes(), march.fields());
    let scalars = |values: &[f64]| spread(surface, values, 0.0, count);
    let mut arrays = vec![
        ("wear_depth_mm", scalars(&fields.wear_depth_mm)),
        ("depth_per_cycle_mm", scalars(&fields.depth_per_cycle_mm)),
        ("peak_pressure_mpa", scalars(&fields.peak_pressure_mpa)),
        ("sliding_distance_mm", scalars(&fields.sliding_distance_mm)),
        ("cross_shear", scalars(&fields.cross_shear)),
        ("thickness_mm", scalars(&fields.thickness_mm)),
    ];
    if let Some(law) = &march.test().creep {
        let (depths, left_mm) = (&march.state().depths, march.state().creep.left_mm(law));
        let none = vec![0.0; surface.len()];
        let or_none = |values: Option<&[f64]>| scalars(values.unwrap_or(&none));
        arrays.push(("creep_depth_mm", or_none(depths.creep_mm())));
        let left_mm = Some(left_mm.as_slice()).filter(|left| !left.is_empty());
        arrays.push(("creep_left_unloaded_mm", or_none(left_mm)));
    }
    arrays
}

fn directions(march: &March, side: Side, count: usize) -> Vec<[f64; 3]> {
    let directions = march.fields().principal_direction.iter();
    let on_side = |vector: &[f64; 3]| point_on_side(&Vec3::from(*vector), side).into();
    let directions: Vec<[f64; 3]> = directions.map(on_side).collect();
    spread(march.insert().surface_nodes(), &directions, [0.0; 3], count)
}

/// Values at the `surface` nodes as values at all nodes, elsewhere `none`.
fn spread<T: Copy>(surface: &[u32], values: &[T], none: T, nodes: usize) -> Vec<T> {
    let mut all = vec![none; nodes];
    for (&node, &value) in surface.iter().zip(values) {
        all[node as usize] = value;
    }
    all
}
