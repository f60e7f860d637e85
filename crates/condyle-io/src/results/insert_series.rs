//! `insert_*.vtu` and `insert.pvd`: the insert at each update, for ParaView.

use condyle::evolve::{March, UpdateRecord};

use super::sides::mesh_on_side;
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
    let spread = |values: &[f64]| {
        let mut all = vec![0.0; mesh.nodes.len()];
        for (&node, &value) in insert.surface_nodes().iter().zip(values) {
            all[node as usize] = value;
        }
        all
    };
    let fields = march.fields();
    let arrays = [
        ("wear_depth_mm", spread(&fields.wear_depth_mm)),
        ("depth_per_cycle_mm", spread(&fields.depth_per_cycle_mm)),
        ("peak_pressure_mpa", spread(&fields.peak_pressure_mpa)),
        ("sliding_distance_mm", spread(&fields.sliding_distance_mm)),
        ("thickness_mm", spread(&fields.thickness_mm)),
    ];
    let mut articulating = vec![0; mesh.nodes.len()];
    insert
        .surface_nodes()
        .iter()
        .for_each(|&node| articulating[node as usize] = 1);
    let float = |(name, values)| PointArray {
        name,
        values: PointValues::Float64(values),
    };
    let mut points: Vec<_> = arrays
        .iter()
        .map(|(name, values)| float((name, values)))
        .collect();
    points.push(PointArray {
        name: "articulating",
        values: PointValues::UInt8(&articulating),
    });
    vtu_bytes(&mesh, &points)
}

/// `insert.pvd`: the series of all files so far, with the cycles as time.
pub fn insert_pvd(updates: &[UpdateRecord]) -> String {
    let names: Vec<String> = (0..=updates.len()).map(insert_file_name).collect();
    let cycles = std::iter::once(0.0).chain(updates.iter().map(|update| update.cycles));
    pvd_text(cycles.zip(names.iter().map(String::as_str)))
}
