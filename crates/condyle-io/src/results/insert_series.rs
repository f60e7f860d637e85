//! `insert_*.vtu` and `insert.pvd`: the insert at each update, for ParaView.

use condyle::{
    Vec3,
    evolve::{March, UpdateRecord},
};
use condyle_fem::HexMesh;

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
    let mesh = on_side(insert.mesh(), side);
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

/// The mesh as it lies in the knee of that side: a left one is mirrored back.
fn on_side(mesh: &HexMesh, side: Side) -> HexMesh {
    match side {
        Side::Right => mesh.clone(),
        Side::Left => HexMesh {
            nodes: mesh
                .nodes
                .iter()
                .map(|node| Vec3::new(node.x, node.y, -node.z))
                .collect(),
            hexes: mesh
                .hexes
                .iter()
                .map(|&[a, b, c, d, e, f, g, h]| [a, d, c, b, e, h, g, f])
                .collect(),
        },
    }
}

#[cfg(test)]
mod tests {
    use condyle::geometry::{GenericInsertShape, Meshing};

    use super::*;

    #[test]
    fn a_left_insert_is_the_mirror_image_and_not_inside_out() {
        let insert = GenericInsertShape::default()
            .insert(Meshing {
                edge_mm: 6.0,
                layers: 1,
            })
            .unwrap();
        let left = on_side(insert.mesh(), Side::Left);
        assert!((left.volume() - insert.mesh().volume()).abs() < 1e-9);
        assert!((left.worst_quality() - insert.mesh().worst_quality()).abs() < 1e-12);
        assert_eq!(left.nodes[0].z, -insert.mesh().nodes[0].z);
    }
}
