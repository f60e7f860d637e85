//! What is put right in a triangle mesh wherever it is, because that moves nothing that can be felt.

use super::{
    defect::{Defect, DefectKind, add},
    degenerate::without_degenerate,
    doubled::make_single,
    edges::{by_edge, edge_uses},
    joints::join,
    slivers::collapse_slivers,
    weld::{drop_unused, weld},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Gap between vertices over the diagonal of the mesh that is welded: 0.005 mm for an implant, some of the
/// roundings of a text file in metres, and an eighth of the shortest edge of the real meshes at hand.
const WELDED: f64 = 5e-5;
/// Thickness over the diagonal of the mesh below which a triangle is a sliver: 0.001 mm for an implant.
const THIN: f64 = 1e-5;

/// A mesh that was mended, and what was done.
pub(super) struct Mended {
    pub(super) mesh: TriangleMesh,
    pub(super) defects: Vec<Defect>,
    pub(super) removed_degenerate: usize,
}

/// Welds open edges, takes out triangles without area, slivers and doubled faces, and joins vertices to the
/// edges that they lie on.
pub(super) fn mended(mesh: TriangleMesh) -> Mended {
    let (low, high) = mesh.bounds();
    let diagonal = (high - low).norm();
    let mut defects = Vec::new();
    let mut note =
        |kind, places: Vec<Vec3>| places.iter().for_each(|&at| add(&mut defects, kind, at));
    let mut mesh = mesh;
    let uses = edge_uses(&mesh);
    let is_open = by_edge(&uses).any(|edge| edge.len() == 1);
    if is_open {
        note(
            DefectKind::Unwelded,
            weld(&mut mesh, &uses, WELDED * diagonal),
        );
    }
    let cleaned = without_degenerate(mesh);
    mesh = cleaned.mesh;
    note(
        DefectKind::Sliver,
        collapse_slivers(&mut mesh, THIN * diagonal),
    );
    note(DefectKind::Doubled, make_single(&mut mesh));
    if is_open {
        note(DefectKind::Joint, join(&mut mesh, WELDED * diagonal));
    }
    if !defects.is_empty() {
        drop_unused(&mut mesh);
    }
    Mended {
        mesh,
        defects,
        removed_degenerate: cleaned.removed,
    }
}
