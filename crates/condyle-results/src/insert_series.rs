//! `insert_*.vtu` and `insert.pvd`: the insert at each update, for ParaView.

use condyle::evolve::{March, UpdateRecord};

use condyle_mesh::formats::{MeshFileError, PointArray, PointValues, pvd_text, vtu_bytes};

use super::{insert_fields::InsertFields, side::Side};

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
    let fields = InsertFields::of(march, side);
    let scalars = fields.scalars.iter().map(|(name, values)| PointArray {
        name,
        values: PointValues::Float64(values),
    });
    let vectors = fields.vectors.iter().map(|(name, values)| PointArray {
        name,
        values: PointValues::Vectors(values),
    });
    let mut points: Vec<_> = scalars.chain(vectors).collect();
    points.push(PointArray {
        name: "articulating",
        values: PointValues::UInt8(&fields.articulating),
    });
    vtu_bytes(&fields.mesh, &points)
}

/// `insert.pvd`: the series of all files so far, with the cycles as time.
pub fn insert_pvd(updates: &[UpdateRecord]) -> String {
    let names: Vec<String> = (0..=updates.len()).map(insert_file_name).collect();
    let cycles = std::iter::once(0.0).chain(updates.iter().map(|update| update.cycles));
    pvd_text(cycles.zip(names.iter().map(String::as_str)))
}
