//! A triangle mesh checked as the surface of a body, and repaired.

use serde::{Deserialize, Serialize};

use super::{
    clip::clip_below,
    crossing::crossings,
    defect::{Defect, DefectKind, Judge, RepairError, add},
    edges::{EdgeUse, Oriented, Piece, by_edge, edge_uses, orient},
    holes::{close_holes, join},
    parts::{LeftOut, Parts, take_out_parts},
    touching::Touching,
    weld::{collapse_slivers, drop_unused, make_single, remove_degenerate, weld},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// A triangle mesh that has passed every check of [`checked_mesh`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckedMesh {
    /// The mesh: no degenerate triangles, neighbours turned alike, facing outwards if closed.
    pub mesh: TriangleMesh,
    /// True if no edge has only one triangle.
    pub closed: bool,
    /// True if the mesh was inside-out and has been reversed. The outside of an open surface is unknown: then this is
    /// false, and the caller decides.
    pub turned_round: bool,
    /// Number of triangles turned to agree with the majority of their neighbours.
    pub made_consistent: usize,
    /// Number of triangles without area that were removed.
    pub removed_degenerate: usize,
    /// Number of pairs of neighbouring triangles that cross a little: a flaw to warn of, left as it is.
    pub wrinkles: usize,
    /// Defects that were repaired, and those left because nothing touches there.
    pub defects: Vec<Defect>,
    /// Parts of the file that do not belong to the body.
    pub left_out: Vec<LeftOut>,
}

/// Settings of the check of a triangle mesh as the surface of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Checks {
    /// The part of the surface on which defects matter.
    pub touching: Touching,
    /// The parts of the file that are the body.
    pub parts: Parts,
    /// Height along y below which the mesh is cut away and closed flat, mm; all of it if none.
    pub clip_below_mm: Option<f64>,
}

/// Runs [`Checks::check`] with every defect that is not repaired as an error.
///
/// # Errors
/// As [`Checks::check`].
pub fn checked_mesh(mesh: TriangleMesh) -> Result<CheckedMesh, RepairError> {
    Checks::default().check(mesh)
}

impl Checks {
    /// Checks a triangle mesh as the surface of a body and repairs what can be repaired for certain.
    ///
    /// Wherever they are, vertices of open edges are welded within 5e-5 of the diagonal of the mesh, triangles
    /// are split at vertices that lie on their open edges, slivers thinner than 1e-5 of the diagonal collapse
    /// where the surface keeps its shape, doubled faces become single, triangles without area are removed, triangles
    /// are turned so that neighbours agree, with the majority, and a closed surface that is inside-out is turned.
    ///
    /// Parts that do not belong to the body are removed first; their defects do not matter.
    ///
    /// Away from where another body can touch, open pieces and inner walls next to a closed body are left out and
    /// holes are closed, flat from edge to edge; edges of three or more triangles and crossings are left.
    ///
    /// Two triangles cross if only a shift of more than a thousandth of their edges parts them. Neighbours that
    /// cross by less than 1/500 of the diagonal are a wrinkle, which is only counted.
    ///
    /// # Errors
    /// [`RepairError`]: no triangles, or defects where another body can touch.
    pub fn check(&self, mesh: TriangleMesh) -> Result<CheckedMesh, RepairError> {
        refuse_tangles(&mesh)?;
        let mut mesh = mesh;
        let (defects, removed_degenerate) = clean(&mut mesh);
        if let Some(height_mm) = self.clip_below_mm {
            mesh = clip_below(&mesh, height_mm);
            drop_unused(&mut mesh);
        }
        if mesh.triangles.is_empty() {
            return Err(RepairError::Empty);
        }
        let mut uses = edge_uses(&mesh);
        let mut oriented = orient(&mut mesh, &uses);
        let left_out = match self.parts {
            Parts::All => Vec::new(),
            Parts::SeenFromAbove => take_out_parts(&mut mesh, &oriented.pieces),
        };
        if !left_out.is_empty() {
            // The triangles have other numbers, and a hollow may have lost the body around it.
            uses = edge_uses(&mesh);
            let again = orient(&mut mesh, &uses);
            oriented = Oriented {
                turned_round: oriented.turned_round || again.turned_round,
                made_consistent: oriented.made_consistent,
                ..again
            };
        }
        let mut judge = Judge::new(self.touching, defects);
        judge_edges(&mesh, &uses, &oriented.one_sided, &mut judge);
        let pieces = without_fragments(&mut mesh, oriented.pieces, &mut judge);
        close_holes(&mut mesh, &pieces, &mut judge);
        let crossings = crossings(&mesh);
        for &(_, at_mm) in &crossings.found {
            judge.judge(&mesh, DefectKind::Crossing, at_mm, &[at_mm]);
        }
        if let Some(at_mm) = crossings.gave_up_at_mm {
            judge.refuse(DefectKind::Tangle, at_mm);
        }
        if !judge.that_matter.is_empty() {
            let defects = judge.that_matter;
            return Err(RepairError::Defects { defects });
        }
        // Pieces that were closed before are still.
        let was_closed = pieces.iter().all(|piece| !piece.is_open);
        Ok(CheckedMesh {
            closed: was_closed || by_edge(&edge_uses(&mesh)).all(|edge| edge.len() > 1),
            mesh,
            turned_round: oriented.turned_round,
            made_consistent: oriented.made_consistent,
            removed_degenerate,
            wrinkles: crossings.wrinkles,
            defects: judge.others,
            left_out,
        })
    }
}

/// Number of triangles per vertex beyond which a mesh is not a surface, not even one with doubled faces: a surface
/// has two.
const MAX_TRIANGLES_PER_VERTEX: usize = 16;
/// Number of triangles up to which any mesh is checked in negligible time.
const FEW_TRIANGLES: usize = 1000;

/// Rejects a mesh with many more triangles than vertices before any other step, since its check would not end.
fn refuse_tangles(mesh: &TriangleMesh) -> Result<(), RepairError> {
    let max = FEW_TRIANGLES + MAX_TRIANGLES_PER_VERTEX * mesh.vertices.len();
    if mesh.triangles.len() <= max {
        return Ok(());
    }
    let (low, high) = mesh.bounds();
    let mut defects = Vec::new();
    add(&mut defects, DefectKind::Tangle, (low + high) / 2.0);
    Err(RepairError::Defects { defects })
}

/// Gap between vertices over the diagonal of the mesh that is welded: 0.005 mm for an implant, some of the
/// roundings of a text file in metres, and an eighth of the shortest edge of the real meshes at hand.
const WELDED: f64 = 5e-5;
/// Thickness over the diagonal of the mesh below which a triangle is a sliver: 0.001 mm for an implant.
const THIN: f64 = 1e-5;

/// Welds open edges, removes triangles without area, slivers and doubled faces, and joins vertices to the
/// edges that they lie on. Returns the defects repaired and the number of triangles without area.
fn clean(mesh: &mut TriangleMesh) -> (Vec<Defect>, usize) {
    let (low, high) = mesh.bounds();
    let diagonal = (high - low).norm();
    let mut defects = Vec::new();
    let mut note = |kind, places: &[Vec3]| {
        for &at in places {
            add(&mut defects, kind, at);
        }
    };
    let uses = edge_uses(mesh);
    let is_open = by_edge(&uses).any(|edge| edge.len() == 1);
    if is_open {
        note(DefectKind::Unwelded, &weld(mesh, &uses, WELDED * diagonal));
    }
    let removed_degenerate = remove_degenerate(mesh);
    note(DefectKind::Sliver, &collapse_slivers(mesh, THIN * diagonal));
    note(DefectKind::Doubled, &make_single(mesh));
    if is_open {
        note(DefectKind::Joint, &join(mesh, WELDED * diagonal));
    }
    if !defects.is_empty() {
        drop_unused(mesh);
    }
    (defects, removed_degenerate)
}

/// Judges edges of three triangles or more, and those across which the surface returns reversed.
fn judge_edges(mesh: &TriangleMesh, uses: &[EdgeUse], one_sided: &[Vec3], judge: &mut Judge) {
    for edge in by_edge(uses).filter(|edge| edge.len() > 2) {
        let ends = edge[0].ends.map(|end| mesh.vertices[end as usize]);
        let middle = (ends[0] + ends[1]) / 2.0;
        judge.judge(mesh, DefectKind::NonManifoldEdge, middle, &ends);
    }
    for &at_mm in one_sided {
        judge.judge(mesh, DefectKind::OneSided, at_mm, &[at_mm]);
    }
}

/// Leaves out the open pieces next to a closed body, judges them, and returns the remaining pieces.
fn without_fragments(mesh: &mut TriangleMesh, pieces: Vec<Piece>, judge: &mut Judge) -> Vec<Piece> {
    let area = |piece: &Piece| -> f64 {
        let double = |&triangle: &u32| {
            let [a, b, c] = mesh.corners(triangle as usize);
            (b - a).cross(&(c - a)).norm()
        };
        piece.triangles.iter().map(double).sum()
    };
    let areas = pieces.iter().map(|piece| (area(piece), piece));
    let body = areas.max_by(|(one, _), (other, _)| one.total_cmp(other));
    let body_is_open = body.is_some_and(|(_, body)| body.is_open);
    if body_is_open || pieces.iter().all(|piece| !piece.is_open) {
        return pieces;
    }
    let (open, closed): (Vec<Piece>, Vec<Piece>) =
        pieces.into_iter().partition(|piece| piece.is_open);
    for piece in &open {
        let corners = piece.vertices(mesh).map(|v| mesh.vertices[v as usize]);
        let corners: Vec<Vec3> = corners.collect();
        let middle = corners.iter().sum::<Vec3>() / corners.len() as f64;
        judge.judge(mesh, DefectKind::Fragment, middle, &corners);
    }
    let kept = closed.iter().flat_map(|piece| &piece.triangles);
    let kept = kept.map(|&triangle| mesh.triangles[triangle as usize]);
    mesh.triangles = kept.collect();
    drop_unused(mesh);
    closed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Vec3,
        repair::tests::{self as fixtures, joined, unit_block},
    };

    fn inside_out(mut mesh: TriangleMesh) -> TriangleMesh {
        mesh.triangles
            .iter_mut()
            .for_each(|triangle| triangle.swap(1, 2));
        mesh
    }

    #[test]
    fn a_sound_closed_shell_is_left_alone() {
        let shell = checked_mesh(unit_block()).unwrap();
        assert_eq!(shell.mesh, unit_block());
        assert!(shell.closed && !shell.turned_round);
        assert_eq!((shell.made_consistent, shell.removed_degenerate), (0, 0));
    }

    #[test]
    fn an_inside_out_closed_shell_is_turned_round() {
        let shell = checked_mesh(inside_out(unit_block())).unwrap();
        assert!(shell.turned_round);
        assert_eq!(shell.made_consistent, 0);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn one_of_two_bodies_inside_out_is_turned_round() {
        let other = TriangleMesh::block(Vec3::repeat(2.0), Vec3::repeat(3.0));
        let shell = checked_mesh(joined(unit_block(), inside_out(other))).unwrap();
        assert!(shell.turned_round);
        assert!((shell.mesh.signed_volume() - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_hollow_keeps_its_inner_wall_turned_inwards() {
        let hollow = inside_out(TriangleMesh::block(Vec3::repeat(0.25), Vec3::repeat(0.75)));
        let shell = checked_mesh(joined(unit_block(), hollow)).unwrap();
        assert!(!shell.turned_round);
        assert!((shell.mesh.signed_volume() - 0.875).abs() < 1e-14);
    }

    #[test]
    fn an_open_surface_is_not_turned_round() {
        let mut open = inside_out(unit_block());
        open.triangles.pop();
        let shell = checked_mesh(open).unwrap();
        assert!(!shell.closed && !shell.turned_round);
    }

    #[test]
    fn a_few_triangles_turned_wrong_are_made_consistent() {
        let mut mesh = unit_block();
        mesh.triangles[3].swap(0, 1);
        mesh.triangles[8].swap(0, 1);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(shell.made_consistent, 2);
        assert!(!shell.turned_round);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn nothing_and_points_only_are_empty() {
        let reported = checked_mesh(TriangleMesh::default())
            .unwrap_err()
            .to_string();
        assert_eq!(
            reported,
            "all triangles of the mesh have zero area; check the export"
        );
        let mut mesh = unit_block();
        mesh.triangles = vec![[0, 0, 1], [2, 3, 2]];
        assert_eq!(checked_mesh(mesh), Err(RepairError::Empty));
    }

    #[test]
    fn a_third_triangle_on_an_edge_is_an_error() {
        let mut mesh = unit_block();
        mesh.vertices.push(Vec3::new(-1.0, -1.0, 0.5));
        mesh.triangles.push([0, 4, 8]);
        let reported = checked_mesh(mesh).unwrap_err().to_string();
        let expected = "the surface is not sound where bodies can touch: 1 edge of three or more \
            triangles at (0.00, 0.00, 0.50) mm; repair the mesh there";
        assert_eq!(reported, expected);
    }

    #[test]
    fn a_moebius_strip_is_an_error() {
        let mut mesh = TriangleMesh::default();
        for step in 0..6 {
            let around = f64::from(step) / 6.0 * std::f64::consts::TAU;
            let (radial, height) = ((around / 2.0).cos() * 0.3, (around / 2.0).sin() * 0.3);
            for side in [-1.0, 1.0] {
                let radius = 1.0 + side * radial;
                let (sine, cosine) = around.sin_cos();
                mesh.vertices
                    .push(Vec3::new(radius * cosine, radius * sine, side * height));
            }
        }
        for step in 0..6 {
            let [a, b] = [2 * step, 2 * step + 1];
            // After one round the two rims change places.
            let [c, d] = if step == 5 { [1, 0] } else { [a + 2, b + 2] };
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
        let reported = checked_mesh(mesh).unwrap_err().to_string();
        assert!(
            reported.contains("1 edge of a one-sided surface at ("),
            "{reported}"
        );
    }

    #[test]
    fn two_blocks_through_one_another_are_an_error_that_lists_all() {
        let other = TriangleMesh::block(Vec3::new(0.2, 0.3, 0.5), Vec3::new(0.6, 0.7, 1.5));
        let error = checked_mesh(joined(unit_block(), other)).unwrap_err();
        let RepairError::Defects { defects } = &error else {
            panic!("{error}");
        };
        let [
            Defect {
                kind: DefectKind::Crossing,
                count,
                places_mm,
            },
        ] = &defects[..]
        else {
            panic!("{error}");
        };
        assert!(*count >= 4 && places_mm.len() == *count, "{error}");
        assert!(
            places_mm.iter().all(|at| (at.z - 1.0).abs() < 1e-12),
            "{error}"
        );
    }

    /// Returns a closed block of 40 by 10 by 60 mm on y = 0.
    fn fine_block(edge: f64) -> TriangleMesh {
        fixtures::fine_block(Vec3::new(40.0, 10.0, 60.0), edge)
    }

    fn as_insert(mesh: TriangleMesh) -> Result<CheckedMesh, RepairError> {
        let checks = Checks {
            parts: Parts::All,
            touching: Touching::FromAbove,
            clip_below_mm: None,
        };
        checks.check(mesh)
    }

    fn kinds(shell: &CheckedMesh) -> Vec<(DefectKind, usize)> {
        shell
            .defects
            .iter()
            .map(|defect| (defect.kind, defect.count))
            .collect()
    }

    /// Returns the number of the triangle whose middle is nearest to a place.
    fn nearest(mesh: &TriangleMesh, at: Vec3) -> usize {
        let away = |t: &usize| (mesh.corners(*t).iter().sum::<Vec3>() / 3.0 - at).norm();
        let all = 0..mesh.triangles.len();
        all.min_by(|one, other| away(one).total_cmp(&away(other)))
            .unwrap()
    }

    #[test]
    fn a_soup_with_noise_is_welded() {
        let sound = fine_block(5.0);
        let mut soup = TriangleMesh::default();
        for t in 0..sound.triangles.len() {
            let first = soup.vertices.len() as u32;
            for (i, corner) in (0..).zip(sound.corners(t)) {
                let noise = f64::from((first + i) % 7) * 1e-6;
                soup.vertices.push(corner + Vec3::new(noise, -noise, noise));
            }
            soup.triangles.push([first, first + 1, first + 2]);
        }
        let shell = checked_mesh(soup).unwrap();
        assert!(shell.closed);
        assert_eq!(shell.mesh.vertices.len(), sound.vertices.len());
        assert_eq!(kinds(&shell)[0].0, DefectKind::Unwelded);
        assert!((shell.mesh.signed_volume() - 24_000.0).abs() < 0.1);
    }

    #[test]
    fn triangles_of_a_handful_of_vertices_are_no_surface() {
        let mut mesh = unit_block();
        let once = mesh.triangles.clone();
        while mesh.triangles.len() < 100_000 {
            mesh.triangles.extend(once.iter().copied());
        }
        let reported = checked_mesh(mesh).unwrap_err().to_string();
        assert!(
            reported.contains("1 tangle of triangles at (0.50, 0.50, 0.50) mm"),
            "{reported}"
        );
    }

    #[test]
    fn doubled_faces_become_single() {
        let mut mesh = fine_block(5.0);
        let doubled: Vec<[u32; 3]> = mesh.triangles.iter().step_by(7).copied().collect();
        mesh.triangles
            .extend(doubled.iter().map(|&[a, b, c]| [b, a, c]));
        let shell = checked_mesh(mesh).unwrap();
        assert!(shell.closed);
        assert_eq!(kinds(&shell), [(DefectKind::Doubled, doubled.len())]);
    }

    #[test]
    fn a_vertex_on_another_triangles_edge_is_joined_to_it() {
        let mut mesh = fine_block(5.0);
        let t = nearest(&mesh, Vec3::new(0.0, 10.0, 0.0));
        let [a, b, c] = mesh.triangles[t];
        let middle = (mesh.vertices[a as usize] + mesh.vertices[b as usize]) / 2.0;
        let joint = mesh.vertices.len() as u32;
        mesh.vertices.push(middle);
        mesh.triangles[t] = [a, joint, c];
        mesh.triangles.push([joint, b, c]);
        let shell = checked_mesh(mesh).unwrap();
        assert!(shell.closed);
        assert_eq!(kinds(&shell), [(DefectKind::Joint, 1)]);
        assert!((shell.mesh.signed_volume() - 24_000.0).abs() < 1e-9);
    }

    #[test]
    fn a_sliver_collapses_where_the_surface_stays_what_it_is() {
        let sound = fine_block(5.0);
        let mut mesh = sound.clone();
        let t = nearest(&mesh, Vec3::new(0.0, 10.0, 0.0));
        let [a, b, _] = mesh.triangles[t];
        let [from, to] = [a, b].map(|end| mesh.vertices[end as usize]);
        let near = mesh.vertices.len() as u32;
        mesh.vertices.push(from + (to - from) * 1e-5);
        // Both triangles of the edge are cut next to its end.
        for triangle in mesh
            .triangles
            .clone()
            .iter()
            .filter(|t| t.contains(&a) && t.contains(&b))
        {
            let whole = mesh
                .triangles
                .iter()
                .position(|other| other == triangle)
                .unwrap();
            mesh.triangles[whole] = triangle.map(|v| if v == a { near } else { v });
            mesh.triangles
                .push(triangle.map(|v| if v == b { near } else { v }));
        }
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(kinds(&shell), [(DefectKind::Sliver, 2)]);
        assert_eq!(shell.mesh.triangles.len(), sound.triangles.len());
        assert!(shell.closed);
    }

    #[test]
    fn an_inner_wall_that_meets_the_backside_is_left_out_and_one_that_meets_the_top_refused() {
        let with_wall = |top_or_bottom: f64| {
            let mut mesh = fine_block(5.0);
            let rim = |z: f64| Vec3::new(0.0, top_or_bottom, z);
            let number = |mesh: &TriangleMesh, at: Vec3| {
                mesh.vertices
                    .iter()
                    .position(|v| (v - at).norm() < 1e-9)
                    .unwrap() as u32
            };
            let [a, b] = [number(&mesh, rim(-5.0)), number(&mesh, rim(0.0))];
            mesh.vertices.push(Vec3::new(0.0, 5.0, -2.5));
            mesh.triangles.push([a, b, mesh.vertices.len() as u32 - 1]);
            mesh
        };
        let shell = as_insert(with_wall(0.0)).unwrap();
        let expected = [(DefectKind::NonManifoldEdge, 1), (DefectKind::Fragment, 1)];
        assert_eq!(kinds(&shell), expected);
        assert!(shell.closed);
        assert_eq!(shell.mesh.triangles.len(), fine_block(5.0).triangles.len());
        let reported = as_insert(with_wall(10.0)).unwrap_err().to_string();
        assert!(
            reported.contains("1 edge of three or more triangles at (0.00, 10.00, -2.50)"),
            "{reported}"
        );
    }

    #[test]
    fn a_hole_in_the_backside_is_closed_and_one_in_the_top_refused() {
        let with_hole = |height: f64| {
            let mut mesh = fine_block(5.0);
            for _ in 0..10 {
                let t = nearest(&mesh, Vec3::new(3.0, height, 4.0));
                mesh.triangles.remove(t);
            }
            mesh
        };
        let shell = as_insert(with_hole(0.0)).unwrap();
        assert!(shell.closed);
        assert!(
            kinds(&shell)
                .iter()
                .all(|(kind, _)| *kind == DefectKind::Hole)
        );
        assert!((shell.mesh.signed_volume() - 24_000.0).abs() < 1e-9);
        let reported = as_insert(with_hole(10.0)).unwrap_err().to_string();
        assert!(reported.contains("hole"), "{reported}");
    }

    #[test]
    fn a_body_that_crosses_itself_below_is_an_insert_still() {
        let peg = TriangleMesh::block(Vec3::new(-3.0, -8.0, -3.0), Vec3::new(3.0, 4.0, 3.0));
        let shell = as_insert(joined(fine_block(5.0), peg)).unwrap();
        assert_eq!(kinds(&shell)[0].0, DefectKind::Crossing);
        let post = TriangleMesh::block(Vec3::new(-3.0, 4.0, -3.0), Vec3::new(3.0, 18.0, 3.0));
        assert!(as_insert(joined(fine_block(5.0), post)).is_err());
    }

    #[test]
    fn an_insert_fused_with_its_tray_is_cut_at_a_height() {
        let tray = TriangleMesh::block(Vec3::new(-22.0, -6.0, -33.0), Vec3::new(22.0, 1.0, 33.0));
        let checks = Checks {
            parts: Parts::All,
            touching: Touching::FromAbove,
            clip_below_mm: Some(2.0),
        };
        let shell = checks.check(joined(fine_block(5.0), tray)).unwrap();
        assert!(shell.closed);
        assert!((shell.mesh.signed_volume() - 40.0 * 8.0 * 60.0).abs() < 1e-9);
    }
}
