//! Why a triangle mesh is not a shell.

use super::defect::Defect;

/// Why a triangle mesh is not a shell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RepairError {
    /// There is no triangle with an area.
    #[error("the mesh has no triangle with an area; check the export")]
    Empty,
    /// Defects where bodies can touch.
    #[error(
        "the surface is not sound where bodies can touch: {}; repair the mesh there",
        listed(defects)
    )]
    Defects {
        /// All of them, by kind.
        defects: Vec<Defect>,
    },
}

/// All kinds, with twenty places between them.
fn listed(defects: &[Defect]) -> String {
    let mut left = Defect::MAX_PLACES;
    let mut said = Vec::new();
    for (index, defect) in defects.iter().enumerate() {
        let to_come = defects.len() - index - 1;
        // Every kind shows one place at least.
        let most = left.saturating_sub(to_come).max(1);
        said.push(defect.listed(most));
        left = left.saturating_sub(defect.places_mm.len().min(most));
    }
    said.join("; ")
}
