//! Which defects matter, because another body can touch there.

use std::cell::OnceCell;

use super::{
    defect::{Defect, DefectKind, add},
    touching::{TouchMap, Touching},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Defects that were found, those that matter apart.
pub(super) struct Judge {
    touching: Touching,
    /// Looked at when there is a defect.
    map: OnceCell<TouchMap>,
    pub(super) that_matter: Vec<Defect>,
    pub(super) others: Vec<Defect>,
}

impl Judge {
    pub(super) fn new(touching: Touching, repaired: Vec<Defect>) -> Self {
        Self {
            touching,
            map: OnceCell::new(),
            that_matter: Vec::new(),
            others: repaired,
        }
    }

    /// Counts a defect that reaches these places; says whether it matters.
    pub(super) fn judge(
        &mut self,
        mesh: &TriangleMesh,
        kind: DefectKind,
        at_mm: Vec3,
        reaches: &[Vec3],
    ) -> bool {
        let map = self.map.get_or_init(|| TouchMap::new(mesh, self.touching));
        let matters = reaches.iter().any(|place| map.contains(place));
        let defects = if matters {
            &mut self.that_matter
        } else {
            &mut self.others
        };
        add(defects, kind, at_mm);
        matters
    }

    /// Counts a defect that matters wherever it is.
    pub(super) fn refuse(&mut self, kind: DefectKind, at_mm: Vec3) {
        add(&mut self.that_matter, kind, at_mm);
    }
}
