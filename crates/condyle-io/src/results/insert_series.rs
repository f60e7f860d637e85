//! `insert_*.vtu` and `insert.pvd`: the insert at each update, for ParaView.

use condyle::Vec3;
use condyle::evolve::{March, UpdateRecord};
use condyle_fem::HexMesh;

use super::sides::{mesh_on_side, point_on_side};
use crate::{
    case::Side,
    mesh::{MeshFileError, PointArray, PointValues, pvd_text, vtu_bytes},
};

/// Name of the file that holds the insert after `update` updates.
pub fn insert_file_name(update: usize) -> String {
    format!("insert_{update:04}.vtu")
}

/// `insert_*.vtu`: the insert as worn so far, with the results of its last update at the nodes, in
/// the knee of that side.
///
/// # Errors
/// None but those of [`vtu_bytes`].
pub fn insert_vtu(march: &March, side: Side) -> Result<Vec<u8>, MeshFileError> {
    let insert = march.insert();
    let mesh = mesh_on_side(insert.mesh(), side);
    let (surface, count) = (insert.surface_nodes(), mesh.nodes.len());
    let scalars = |values: &[f64]| spread(surface, values, 0.0, count);
    let fields = march.fields();
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
    let under = march.state().under_surface.as_ref();
    let plastic = under.and_then(|under| under.plastic.as_ref());
    if let Some(under) = under {
        let around = |values: &[f64]| mean_around(&mesh, values);
        arrays.push(("von_mises_mpa", around(&under.von_mises_mpa)));
        arrays.push(("max_shear_mpa", around(&under.max_shear_mpa)));
    }
    if let Some(plastic) = plastic {
        arrays.push(("permanent_set_mm", scalars(&plastic.permanent_set_mm)));
        arrays.push((
            "plastic_strain",
            most_around(&mesh, &plastic.plastic_strain),
        ));
        let regimes = plastic.regime.iter();
        let regimes: Vec<f64> = regimes.map(|regime| f64::from(regime.number())).collect();
        arrays.push(("plastic_regime", most_around(&mesh, &regimes)));
    }
    let on_side = |vector: &[f64; 3]| point_on_side(&Vec3::from(*vector), side).into();
    let directions: Vec<[f64; 3]> = fields.principal_direction.iter().map(on_side).collect();
    let directions = spread(surface, &directions, [0.0; 3], count);
    let articulating = spread(surface, &vec![1; surface.len()], 0, count);
    let float = |(name, values)| PointArray {
        name,
        values: PointValues::Float64(values),
    };
    let mut points: Vec<_> = arrays
        .iter()
        .map(|(name, values)| float((name, values)))
        .collect();
    points.push(PointArray {
        name: "principal_direction",
        values: PointValues::Vectors(&directions),
    });
    points.push(PointArray {
        name: "articulating",
        values: PointValues::UInt8(&articulating),
    });
    vtu_bytes(&mesh, &points)
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

/// Values at the `surface` nodes as values at all nodes, elsewhere `none`.
fn spread<T: Copy>(surface: &[u32], values: &[T], none: T, nodes: usize) -> Vec<T> {
    let mut all = vec![none; nodes];
    for (&node, &value) in surface.iter().zip(values) {
        all[node as usize] = value;
    }
    all
}

/// `insert.pvd`: the series of all files so far, with the cycles as time.
pub fn insert_pvd(updates: &[UpdateRecord]) -> String {
    let names: Vec<String> = (0..=updates.len()).map(insert_file_name).collect();
    let cycles = std::iter::once(0.0).chain(updates.iter().map(|update| update.cycles));
    pvd_text(cycles.zip(names.iter().map(String::as_str)))
}
