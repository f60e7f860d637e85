//! Defects of a triangle mesh: kinds, counts and places. Those matter where another body can touch.

use std::cell::OnceCell;

use serde::{Deserialize, Serialize};

use super::touching::{TouchMap, Touching};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// A kind of defect of a triangle mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum DefectKind {
    /// Vertices of open edges that rounding keeps apart.
    Unwelded,
    /// Vertices on the edge of a triangle that has no corner there.
    Joint,
    /// Triangles with an edge shorter than rounding.
    Sliver,
    /// Triangles of the same three corners.
    Doubled,
    /// Edges of three or more triangles.
    NonManifoldEdge,
    /// Edges across which the surface returns reversed, as on a Moebius strip.
    OneSided,
    /// Pairs of triangles that pass through one another.
    Crossing,
    /// Open pieces and inner walls next to a closed body.
    Fragment,
    /// Loops of open edges in a surface.
    Hole,
    /// The search for crossings was abandoned, since too many triangles lie on one another.
    Tangle,
}

impl DefectKind {
    /// Returns its noun for one and for several, the rest of its name, and its treatment away from where bodies can
    /// touch.
    fn words(self) -> (&'static str, &'static str, &'static str, &'static str) {
        match self {
            Self::Unwelded => ("vertex", "vertices", " apart by rounding", "welded"),
            Self::Joint => ("vertex", "vertices", " inside an edge", "joined"),
            Self::Sliver => ("sliver", "slivers", "", "removed"),
            Self::Doubled => ("doubled face", "doubled faces", "", "made single"),
            Self::NonManifoldEdge => ("edge", "edges", " of three or more triangles", "left"),
            Self::OneSided => ("edge", "edges", " of a one-sided surface", "left"),
            Self::Crossing => ("pair", "pairs", " of triangles that cross", "left"),
            Self::Fragment => (
                "open or inner piece",
                "open or inner pieces",
                "",
                "left out",
            ),
            Self::Hole => ("hole", "holes", "", "closed"),
            Self::Tangle => ("tangle", "tangles", " of triangles", "left"),
        }
    }
}

/// All defects of one kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Defect {
    /// Kind of the defects.
    pub kind: DefectKind,
    /// Number of defects.
    pub count: usize,
    /// Places of the first [`Defect::MAX_PLACES`], mm in the frame of the mesh.
    pub places_mm: Vec<Vec3>,
}

impl Defect {
    /// Largest number of stored places; a longer list is of no use.
    pub const MAX_PLACES: usize = 20;

    /// Describes kind, count and the first `max` places: "2 holes at (1.00, 2.00, 3.00), ... mm".
    pub fn listed(&self, max: usize) -> String {
        self.described("", max)
    }

    /// Describes the same with the treatment: "2 holes (closed) at ...".
    pub fn listed_with_repair(&self, max: usize) -> String {
        let (.., treatment) = self.kind.words();
        self.described(&format!(" ({treatment})"), max)
    }

    fn described(&self, treatment: &str, max: usize) -> String {
        let (one, several, rest, _) = self.kind.words();
        let noun = if self.count == 1 { one } else { several };
        let places = &self.places_mm[..self.places_mm.len().min(max)];
        let shown = places.iter().map(|at| {
            // Adding zero turns -0 into 0.
            let [x, y, z] = [at.x, at.y, at.z].map(|one| (one * 100.0).round() / 100.0 + 0.0);
            format!("({x:.2}, {y:.2}, {z:.2})")
        });
        let shown = shown.collect::<Vec<_>>().join(", ");
        let more = match self.count - places.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("{} {noun}{rest}{treatment} at {shown} mm{more}", self.count)
    }
}

pub(super) fn add(defects: &mut Vec<Defect>, kind: DefectKind, at_mm: Vec3) {
    let index = defects.iter().position(|defect| defect.kind == kind);
    let index = index.unwrap_or_else(|| {
        defects.push(Defect {
            kind,
            count: 0,
            places_mm: Vec::new(),
        });
        defects.len() - 1
    });
    let defect = &mut defects[index];
    defect.count += 1;
    if defect.places_mm.len() < Defect::MAX_PLACES {
        defect.places_mm.push(at_mm);
    }
}

/// Reason why a triangle mesh is not the surface of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RepairError {
    /// No triangle has an area.
    #[error("all triangles of the mesh have zero area; check the export")]
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

/// Lists all kinds, with twenty places in total.
fn listed(defects: &[Defect]) -> String {
    let mut left = Defect::MAX_PLACES;
    let mut parts = Vec::new();
    for (index, defect) in defects.iter().enumerate() {
        let to_come = defects.len() - index - 1;
        // Every kind shows one place at least.
        let max = left.saturating_sub(to_come).max(1);
        parts.push(defect.listed(max));
        left = left.saturating_sub(defect.places_mm.len().min(max));
    }
    parts.join("; ")
}

pub(super) struct Judge {
    touching: Touching,
    /// Computed at the first defect.
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

    /// Counts a defect that reaches these places; returns whether it matters.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_defect_is_listed_with_its_count_and_first_places() {
        let mut defects = Vec::new();
        add(&mut defects, DefectKind::Hole, Vec3::new(1.0, -0.001, 2.5));
        assert_eq!(defects[0].listed(3), "1 hole at (1.00, 0.00, 2.50) mm");
        for _ in 0..30 {
            add(&mut defects, DefectKind::Hole, Vec3::zeros());
        }
        let reported = defects[0].listed_with_repair(1);
        assert_eq!(
            reported,
            "31 holes (closed) at (1.00, 0.00, 2.50) mm and 30 more"
        );
        assert_eq!(defects[0].places_mm.len(), Defect::MAX_PLACES);
    }
}
