//! The first and the last cycle for ParaView: at every increment the insert with its pressure, and the
//! femur in its pose.

use std::fmt::Write;

use condyle::{
    Vec3,
    evolve::{March, SolvedCycle},
    geometry::TriangleMesh,
    spatial::Pose,
};

use condyle_mesh::formats::{
    Grid, MeshFileError, PointArray, PointValues, compact_vtu_bytes, pvd_text,
};

use super::side::{Side, face_on_side, point_on_side};

/// The two cycles whose motions are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptCycle {
    /// On the unworn insert.
    First,
    /// On the insert after the last update.
    Last,
}

impl KeptCycle {
    /// Both of them.
    pub const BOTH: [Self; 2] = [Self::First, Self::Last];

    /// Name of its folder, and of its `.pvd` file without the ending.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "cycle_first",
            Self::Last => "cycle_last",
        }
    }

    /// Returns the kept cycles that a march has just solved: after one update the first, at the end
    /// the last.
    pub fn solved_by(march: &March) -> impl Iterator<Item = Self> {
        let is_first = march.state().updates.len() == 1 && !march.is_done();
        let first = is_first.then_some(Self::First);
        first
            .into_iter()
            .chain(march.is_done().then_some(Self::Last))
    }
}

/// The bodies of a frame, in the order of their parts in the `.pvd` file.
pub const BODIES: [&str; 2] = ["insert", "femur"];

/// Name of the file of a body at increment number `increment`, from 0, in the cycle's folder.
pub fn frame_name(body: &str, increment: usize) -> String {
    format!("{body}_{:04}.vtu", increment + 1)
}

/// Returns the articulating surface that a cycle loaded, with the pressure at the end of an increment: `pressure_mpa`
/// at the nodes, each the mean over the node's share of the surface.
pub fn insert_frame(
    march: &March,
    cycle: &SolvedCycle<'_>,
    increment: usize,
    side: Side,
) -> Result<Vec<u8>, MeshFileError> {
    let pressure: Vec<f32> = cycle
        .pressures_mpa(increment)
        .iter()
        .map(|&pressure_mpa| pressure_mpa as f32)
        .collect();
    let positions = cycle.surface.positions.iter();
    let nodes: Vec<Vec3> = positions.map(|place| point_on_side(place, side)).collect();
    let faces = march.insert().surface_faces().iter();
    let quads: Vec<[u32; 4]> = faces.map(|&face| face_on_side(face, side)).collect();
    let array = PointArray {
        name: "pressure_mpa",
        values: PointValues::Float32(&pressure),
    };
    compact_vtu_bytes(&Grid::quads(&nodes, &quads), &[array])
}

/// Returns the femur in the insert frame at a pose; `femur.vtu` is at the neutral one.
pub fn femur_vtu(femur: &TriangleMesh, pose: &Pose, side: Side) -> Result<Vec<u8>, MeshFileError> {
    let placed = femur_on_side(femur, pose, side);
    compact_vtu_bytes(&Grid::triangles(&placed.vertices, &placed.triangles), &[])
}

/// Returns the femur in the insert frame at a pose, in a knee of the given side.
pub fn femur_on_side(femur: &TriangleMesh, pose: &Pose, side: Side) -> TriangleMesh {
    let place = |vertex: &Vec3| point_on_side(&pose.to_insert(vertex), side);
    let triangle = |&corners| face_on_side(corners, side);
    TriangleMesh {
        vertices: femur.vertices.iter().map(place).collect(),
        triangles: femur.triangles.iter().map(triangle).collect(),
    }
}

/// Returns the `.pvd` file of a cycle: both bodies at every increment, the time in % of the cycle.
pub fn cycle_pvd(cycle: KeptCycle, percents: &[f64]) -> String {
    let frames = percents.iter().enumerate();
    let files: Vec<(f64, Vec<String>)> = frames
        .map(|(increment, &percent)| {
            let path = |body| format!("{}/{}", cycle.name(), frame_name(body, increment));
            (percent, BODIES.map(path).to_vec())
        })
        .collect();
    pvd_text(files.iter().flat_map(|(percent, parts)| {
        let parts = parts.iter().enumerate();
        parts.map(|(part, file)| (*percent, part, file.as_str()))
    }))
}

/// Name of the file with the pressures of a cycle.
pub fn cycle_pressure_file(cycle: KeptCycle) -> String {
    format!("{}_pressure.csv", cycle.name())
}

/// Returns the pressures of the cycle that a march solved last: one row per increment and loaded node.
///
/// `node` is the number of a point of `insert_*.vtu`, from 0; `pressure_mpa` is the mean over the node's share of the
/// surface, in 32 bits, at the end of the increment. None before the first update of a march.
pub fn cycle_pressure_csv(march: &March) -> Option<String> {
    let cycle = march.last_cycle()?;
    let nodes = march.insert().surface_nodes();
    let mut text = String::from("percent,node,pressure_mpa\n");
    for (increment, row) in cycle.rows.iter().enumerate() {
        let (percent, pressures) = (row.percent.to_string(), cycle.pressures_mpa(increment));
        let pressed = nodes.iter().zip(pressures).filter(|(_, mpa)| *mpa > 0.0);
        for (node, mpa) in pressed {
            // Single precision halves a file whose values need few digits.
            writeln!(text, "{percent},{node},{}", mpa as f32).expect("a string takes all");
        }
    }
    Some(text)
}
