//! The insert as worn so far, with its results at the nodes, in the knee of the case.

use condyle::{Vec3, evolve::March};
use condyle_fem::HexMesh;

use super::side::Side;
use super::side::{mesh_on_side, point_on_side};

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
        let mut scalars = scalars(march, count);
        scalars.extend(under_surface(march, &mesh));
        Self {
            scalars,
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

/// What the last update found in the inside of a deformable insert; nothing of a foundation.
fn under_surface(march: &March, mesh: &HexMesh) -> Vec<(&'static str, Vec<f64>)> {
    let Some(under) = &march.state().under_surface else {
        return Vec::new();
    };
    let around = |values: &[f64]| mean_around(mesh, values);
    let mut arrays = vec![
        ("von_mises_mpa", around(&under.von_mises_mpa)),
        ("max_shear_mpa", around(&under.max_shear_mpa)),
    ];
    if let Some(plastic) = &under.plastic {
        let surface = march.insert().surface_nodes();
        let set_mm = spread(surface, &plastic.permanent_set_mm, 0.0, mesh.nodes.len());
        let regimes = plastic.regime.iter();
        let regimes: Vec<f64> = regimes.map(|regime| f64::from(regime.number())).collect();
        arrays.extend([
            ("permanent_set_mm", set_mm),
            ("plastic_strain", most_around(mesh, &plastic.plastic_strain)),
            ("plastic_regime", most_around(mesh, &regimes)),
        ]);
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

/// Values of elements as values at nodes: the mean of those around each.
fn mean_around(mesh: &HexMesh, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); mesh.nodes.len()];
    for (hex, value) in mesh.hexes.iter().zip(values) {
        for &node in hex {
            let (sum, count) = &mut sums[node as usize];
            *sum += value;
            *count += 1.0;
        }
    }
    let mean = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
    sums.into_iter().map(mean).collect()
}

/// Values of elements as values at nodes: the largest of those around each.
fn most_around(mesh: &HexMesh, values: &[f64]) -> Vec<f64> {
    let mut most = vec![0.0; mesh.nodes.len()];
    for (hex, &value) in mesh.hexes.iter().zip(values) {
        for &node in hex {
            most[node as usize] = value.max(most[node as usize]);
        }
    }
    most
}
