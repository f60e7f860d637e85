//! Parts of a file that are not the body: the tray below an insert, and specks next to it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{edges::Piece, weld::drop_unused};
use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, height_over},
};

/// Distance between the lines of sight from above, mm ...
const LINES_EVERY_MM: f64 = 0.5;
/// ... and maximum number of lines along one side of the file.
const MAX_LINES: f64 = 400.0;
/// Triangles that a line of sight may meet on average: the parts of a knee cover one another a few times. A file in
/// which it meets more is left whole.
const MAX_LAYERS: usize = 32;
/// Visible share of a part's own projection, seen from above, below which the part lies under another one.
const HIDDEN_SHARE: f64 = 0.5;
/// A part below with a smaller share of the body's shadow that reaches into the body is a peg of the body and not a
/// tray.
const PEG_SHARE: f64 = 0.25;
/// Share of the largest projection below which a part is a speck: the parts of an insert of two parts, or of one with
/// a separate post, are larger.
const SPECK_SHARE: f64 = 0.02;

/// The parts of a file that are the body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Parts {
    /// All.
    #[default]
    All,
    /// The parts that are visible from above (+y), which carry the articulating surface.
    SeenFromAbove,
}

/// A part of a file that does not belong to the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Number of triangles.
    pub triangles: usize,
    /// Middle of its box, mm.
    pub at_mm: Vec3,
    /// Extents along the axes, mm.
    pub size_mm: Vec3,
    /// Reason for leaving it out.
    pub why: WhyLeftOut,
}

/// Reason why a part does not belong to the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhyLeftOut {
    /// It is closed and lies below another part.
    Below,
    /// It is small, and neither above nor below the rest.
    Speck,
}

pub(super) fn take_out_parts(mesh: &mut TriangleMesh, pieces: &[Piece]) -> Vec<LeftOut> {
    if pieces.len() < 2 {
        return Vec::new();
    }
    let Some(parts) = seen_parts(mesh, pieces) else {
        return Vec::new();
    };
    let Some(body) = parts.iter().max_by_key(|part| part.first) else {
        return Vec::new();
    };
    let (mut left_out, mut kept) = (Vec::new(), Vec::new());
    for part in &parts {
        match part.why_left_out(body) {
            Some(why) => left_out.push(LeftOut {
                triangles: part.piece.triangles.len(),
                at_mm: (part.low + part.high) / 2.0,
                size_mm: part.high - part.low,
                why,
            }),
            None => kept.extend(part.piece.triangles.iter().copied()),
        }
    }
    if !left_out.is_empty() {
        kept.sort_unstable();
        let triangles = kept.iter().map(|&n| mesh.triangles[n as usize]);
        mesh.triangles = triangles.collect();
        drop_unused(mesh);
    }
    left_out
}

/// Connected triangles, in their box, seen from above by vertical lines on a square grid.
struct Part<'a> {
    piece: &'a Piece,
    low: Vec3,
    high: Vec3,
    /// Number of lines that meet it: the size of its projection.
    shadow: usize,
    /// Number of lines that meet it before any other part.
    first: usize,
    /// Number of lines that meet it and another part.
    shared: usize,
}

/// Returns the pieces as seen from above; none if they cover one another too often to be examined.
fn seen_parts<'a>(mesh: &TriangleMesh, pieces: &'a [Piece]) -> Option<Vec<Part<'a>>> {
    let (low, high) = mesh.bounds();
    let size = high - low;
    let step_mm = LINES_EVERY_MM.max(size.x.max(size.z) / MAX_LINES);
    let lines = (size.x / step_mm + 1.0) * (size.z / step_mm + 1.0);
    let mut tries_left = MAX_LAYERS * (lines as usize + mesh.triangles.len());
    // The highest point of every part on each line.
    let mut met: BTreeMap<[i64; 2], BTreeMap<usize, f64>> = BTreeMap::new();
    for (number, piece) in pieces.iter().enumerate() {
        for &triangle in &piece.triangles {
            let corners = mesh.corners(triangle as usize);
            let [a, b, c] = corners;
            let (low, high) = (a.inf(&b).inf(&c) / step_mm, a.sup(&b).sup(&c) / step_mm);
            let between = |from: f64, to: f64| from.ceil() as i64..=to.floor() as i64;
            for i in between(low.x, high.x) {
                for k in between(low.z, high.z) {
                    tries_left = tries_left.checked_sub(1)?;
                    let place = (i as f64 * step_mm, k as f64 * step_mm);
                    if let Some(height) = height_over(&corners, place) {
                        let parts = met.entry([i, k]).or_default();
                        let highest = parts.entry(number).or_insert(height);
                        *highest = highest.max(height);
                    }
                }
            }
        }
    }
    let parts = pieces.iter().map(|piece| {
        let (low, high) = piece.bounds(mesh);
        Part {
            piece,
            low,
            high,
            shadow: 0,
            first: 0,
            shared: 0,
        }
    });
    let mut parts: Vec<Part> = parts.collect();
    for heights in met.values() {
        if let Some((&highest, _)) = heights.iter().max_by(|a, b| a.1.total_cmp(b.1)) {
            parts[highest].first += 1;
        }
        for &part in heights.keys() {
            parts[part].shadow += 1;
            parts[part].shared += usize::from(heights.len() > 1);
        }
    }
    Some(parts)
}

impl Part<'_> {
    /// Returns the reason why the part does not belong to a body, if it does not.
    fn why_left_out(&self, body: &Self) -> Option<WhyLeftOut> {
        if std::ptr::eq(self, body) {
            return None;
        }
        let share = |of: usize, whole: usize| of as f64 / whole.max(1) as f64;
        let is_enclosed =
            (0..3).all(|i| body.low[i] <= self.low[i] && body.high[i] >= self.high[i]);
        let is_hidden = share(self.first, self.shadow) < HIDDEN_SHARE;
        let reaches_in = self.high.y > body.low.y;
        let is_peg = reaches_in && share(self.shadow, body.first) < PEG_SHARE;
        let is_aside = share(self.shared, self.shadow) < HIDDEN_SHARE;
        if share(self.shadow, body.first) < SPECK_SHARE && is_aside {
            Some(WhyLeftOut::Speck)
        } else if is_hidden && !self.piece.is_open && !is_enclosed && !is_peg {
            Some(WhyLeftOut::Below)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::{Checks, Touching, tests::joined};

    const INSERT_TOP_MM: f64 = 9.0;

    fn insert() -> TriangleMesh {
        TriangleMesh::block(
            Vec3::new(-22.0, 0.0, -35.0),
            Vec3::new(22.0, INSERT_TOP_MM, 35.0),
        )
    }

    /// The parts that are left out of a file, and the body.
    fn left_out(file: TriangleMesh) -> (Vec<WhyLeftOut>, TriangleMesh) {
        let checks = Checks {
            touching: Touching::FromAbove,
            parts: Parts::SeenFromAbove,
            clip_below_mm: None,
        };
        let shell = checks.check(file).unwrap();
        let why = shell.left_out.iter().map(|part| part.why);
        (why.collect(), shell.mesh)
    }

    #[test]
    fn verify_a_tray_and_a_stem_below_are_left_out_apart_or_grown_into_the_insert() {
        for top_mm in [-0.01, 0.0, 0.5] {
            let tray =
                TriangleMesh::block(Vec3::new(-24.0, -4.0, -37.0), Vec3::new(24.0, top_mm, 37.0));
            let stem = TriangleMesh::block(Vec3::new(-6.0, -44.0, -6.0), Vec3::new(6.0, -3.5, 6.0));
            let (why, body) = left_out(joined(joined(tray, insert()), stem));
            assert_eq!(why, [WhyLeftOut::Below; 2]);
            assert_eq!(body.bounds(), insert().bounds());
        }
    }

    #[test]
    fn two_plateaus_a_hollow_and_a_post_belong_to_the_body() {
        let halves = [-1.0, 1.0].map(|side| {
            let shift = Vec3::new(0.0, 0.0, 40.0 * side);
            insert().mapped(|v| v + shift)
        });
        let [one, other] = halves;
        assert_eq!(left_out(joined(one, other)).0, []);
        let hollow = TriangleMesh::block(Vec3::new(-5.0, 2.0, -5.0), Vec3::new(5.0, 4.0, 5.0));
        assert_eq!(left_out(joined(insert(), hollow)).0, []);
        let post = TriangleMesh::block(Vec3::new(-5.0, 8.0, -5.0), Vec3::new(5.0, 18.0, 5.0));
        let checks = Checks {
            touching: Touching::FromAbove,
            parts: Parts::SeenFromAbove,
            clip_below_mm: None,
        };
        // It crosses the insert where it can be touched, which is an error, and not left out.
        assert!(checks.check(joined(insert(), post)).is_err());
    }

    #[test]
    fn specks_beside_the_body_and_far_from_it_are_left_out() {
        let aside = TriangleMesh::block(Vec3::new(25.0, 3.0, 0.0), Vec3::new(27.0, 5.0, 2.0));
        let far = TriangleMesh::block(Vec3::new(0.0, 3.0, 120.0), Vec3::new(4.0, 5.0, 125.0));
        let (why, body) = left_out(joined(joined(insert(), aside), far));
        assert_eq!(why, [WhyLeftOut::Speck; 2]);
        assert_eq!(body.bounds(), insert().bounds());
    }
}
