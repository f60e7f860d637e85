//! Why a march ended early.

use condyle_fem::HexMesh;
use thiserror::Error;

use super::PlacementError;
use crate::{
    Vec3,
    machine::{CycleError, Machine, MachineState},
};

/// Why a march ended early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MarchError {
    /// The bodies make no knee.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    /// A cycle was not solved.
    #[error("update {update}, after {cycles:.0} cycles: {source}")]
    Cycle {
        /// Which update, from 1.
        update: usize,
        /// Cycles done before it.
        cycles: f64,
        /// Why.
        source: CycleError,
    },
    /// The femur fell off the insert.
    #[error(
        "update {update}: the femur touches the insert nowhere in the whole cycle, and ends it at {joint} {at_mm:.1} mm; \
         check loads, springs, axes and start_mm"
    )]
    LostContact {
        /// Which update, from 1.
        update: usize,
        /// The joint along which the femur leaves, as messages call it.
        joint: &'static str,
        /// Where that is at the end of the cycle.
        at_mm: f64,
    },
    /// The insert wore through.
    #[error(
        "update {update}: the insert is worn through at ({x:.1}, {z:.1}) mm; use fewer cycles or a thicker insert"
    )]
    WornThrough {
        /// Which update, from 1.
        update: usize,
        /// Place along x.
        x: f64,
        /// Place along z.
        z: f64,
    },
    /// Elements turned inside out below the worn surface.
    #[error(
        "update {update}: {count} elements below the worn surface are inside out, the worst at ({x:.1}, {y:.1}, {z:.1}) \
         mm; use more updates, fewer layers or a larger edge_mm"
    )]
    InvertedElements {
        /// Which update, from 1.
        update: usize,
        /// How many.
        count: usize,
        /// Place of the worst along x.
        x: f64,
        /// Place of the worst along y.
        y: f64,
        /// Place of the worst along z.
        z: f64,
    },
}

impl MarchError {
    /// That of a mesh with elements inside out.
    pub(super) fn inverted_elements(update: usize, mesh: &HexMesh) -> Self {
        let qualities = || mesh.qualities().enumerate();
        let worst = qualities().min_by(|a, b| a.1.total_cmp(&b.1));
        let corners = worst.map_or([Vec3::zeros(); 8], |(hex, _)| mesh.corners(hex));
        let middle = corners.iter().sum::<Vec3>() / 8.0;
        Self::InvertedElements {
            update,
            count: qualities().filter(|(_, quality)| *quality <= 0.0).count(),
            x: middle.x,
            y: middle.y,
            z: middle.z,
        }
    }

    /// That of a femur that has left the insert; along the first joint in files that settling zeroes.
    pub(super) fn lost_contact(update: usize, machine: &Machine, end: &MachineState) -> Self {
        let mechanism = machine.mechanism;
        let mut in_files = mechanism.in_files.into_iter();
        let leaving = in_files.find(|&index| mechanism.joint(index).is_zeroed);
        Self::LostContact {
            update,
            joint: leaving.map_or("", |index| mechanism.joint(index).symbol),
            at_mm: leaving.map_or(0.0, |index| index.of(&end.now.positions)),
        }
    }
}
