//! Parts of a file that are not the body: the tray below an insert, and specks beside it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{edges::Piece, weld::drop_unused};
use crate::{Vec3, height_map::height_over, triangle_mesh::TriangleMesh};

/// Distance between the lines of sight from above, mm ...
const LINES_EVERY_MM: f64 = 0.5;
/// ... and lines along one side of the file, at most.
const MAX_LINES: f64 = 400.0;
/// Triangles that a line of sight may meet on average: the parts of a knee cover one another a few times. A file in
/// which it meets more is left whole.
const MAX_LAYERS: usize = 32;
/// A part that is seen from above on less than this share of its own shadow lies below another.
const HIDDEN_SHARE: f64 = 0.5;
/// A part below with a smaller share of the body's shadow that reaches into it is a peg of it, and no tray.
const PEG_SHARE: f64 = 0.25;
/// A part whose shadow is smaller than this share of the largest one is a speck: an insert of two parts, or one with
/// a post by itself, has larger ones.
const SPECK_SHARE: f64 = 0.02;

/// Which parts of a file are the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parts {
    /// All.
    All,
    /// Those that are seen from above (+y), which carry the articulating surface.
    SeenFromAbove,
}

/// A part of a file that is not of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// How many triangles it has.
    pub triangles: usize,
    /// Its middle, mm.
    pub at_mm: Vec3,
    /// Its extents along the axes, mm.
    pub size_mm: Vec3,
    /// Why it is left out.
    pub why: WhyLeftOut,
}

/// Why a part is not of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum WhyLeftOut {
    /// It is closed and lies below another part.
    Below,
    /// It is small, and neither above nor below the rest.
    Speck,
}

/// Takes out what is not of the body; gives what that was.
pub(super) fn take_out_parts(mesh: &mut TriangleMesh, pieces: &[Piece]) -> Vec<LeftOut> {
    if pieces.len() < 2 {
        return Vec::new();
    }
    let parts: Vec<Part<'_>> = pieces.iter().map(|piece| Part::new(mesh, piece)).collect();
    let Some((seen, body)) = Seen::new(mesh, &parts).and_then(Seen::with_largest) else {
        return Vec::new();
    };
    let why = |n: usize| (n != body).then(|| seen.why(&parts, n, body)).flatten();
    let (mut left_out, mut kept) = (Vec::new(), Vec::new());
    for (n, part) in parts.iter().enumerate() {
        match why(n) {
            Some(why) => left_out.push(part.left_out(why)),
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

/// Triangles that hang together, in their box.
struct Part<'a> {
    piece: &'a Piece,
    low: Vec3,
    high: Vec3,
}

impl<'a> Part<'a> {
    fn new(mesh: &TriangleMesh, piece: &'a Piece) -> Self {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&n| mesh.corners(n as usize));
        let (low, high) = corners.fold(none, |(low, high), at| (low.inf(&at), high.sup(&at)));
        Self { piece, low, high }
    }

    fn encloses(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] <= other.low[axis] && self.high[axis] >= other.high[axis])
    }

    fn left_out(&self, why: WhyLeftOut) -> LeftOut {
        LeftOut {
            triangles: self.piece.triangles.len(),
            at_mm: (self.low + self.high) / 2.0,
            size_mm: self.high - self.low,
            why,
        }
    }
}

/// Vertical lines on a square grid, and the highest point of every part that they meet.
struct LinesOfSight {
    step_mm: f64,
    met: BTreeMap<[i64; 2], BTreeMap<usize, f64>>,
    /// How many more may be tried.
    left: usize,
}

impl LinesOfSight {
    fn over(mesh: &TriangleMesh) -> Self {
        let (low, high) = mesh.bounds();
        let size = high - low;
        let step_mm = LINES_EVERY_MM.max(size.x.max(size.z) / MAX_LINES);
        let lines = (size.x / step_mm + 1.0) * (size.z / step_mm + 1.0);
        Self {
            step_mm,
            met: BTreeMap::new(),
            left: MAX_LAYERS * (lines as usize + mesh.triangles.len()),
        }
    }

    /// Lets the lines through a triangle's box meet it; none if too many were tried.
    fn meet(&mut self, part: usize, corners: &[Vec3; 3]) -> Option<()> {
        let [a, b, c] = corners;
        let (low, high) = (
            a.inf(b).inf(c) / self.step_mm,
            a.sup(b).sup(c) / self.step_mm,
        );
        let between = |from: f64, to: f64| from.ceil() as i64..=to.floor() as i64;
        for i in between(low.x, high.x) {
            for k in between(low.z, high.z) {
                self.left = self.left.checked_sub(1)?;
                let place = (i as f64 * self.step_mm, k as f64 * self.step_mm);
                if let Some(height) = height_over(corners, place) {
                    let met = self.met.entry([i, k]).or_default();
                    let highest = met.entry(part).or_insert(height);
                    *highest = highest.max(height);
                }
            }
        }
        Some(())
    }
}

/// How much of every part is seen from above.
struct Seen {
    /// Lines that meet a part, and those that meet it first.
    shadows: Vec<usize>,
    first: Vec<usize>,
    /// Lines that meet both a part and another one.
    shared: Vec<usize>,
}

impl Seen {
    /// None where the parts cover one another too often to be looked at.
    fn new(mesh: &TriangleMesh, parts: &[Part<'_>]) -> Option<Self> {
        let mut lines = LinesOfSight::over(mesh);
        for (number, part) in parts.iter().enumerate() {
            for &triangle in &part.piece.triangles {
                lines.meet(number, &mesh.corners(triangle as usize))?;
            }
        }
        let mut seen = Self {
            shadows: vec![0; parts.len()],
            first: vec![0; parts.len()],
            shared: vec![0; parts.len()],
        };
        for met in lines.met.values() {
            let highest = met.iter().max_by(|a, b| a.1.total_cmp(b.1));
            if let Some((&part, _)) = highest {
                seen.first[part] += 1;
            }
            for &part in met.keys() {
                seen.shadows[part] += 1;
                seen.shared[part] += usize::from(met.len() > 1);
            }
        }
        Some(seen)
    }

    /// The same and the part that is seen most.
    fn with_largest(self) -> Option<(Self, usize)> {
        let largest = (0..self.first.len()).max_by_key(|&n| self.first[n])?;
        Some((self, largest))
    }

    /// Why a part is none of the body, if it is none.
    fn why(&self, parts: &[Part<'_>], n: usize, body: usize) -> Option<WhyLeftOut> {
        let share = |of: usize, whole: usize| of as f64 / whole.max(1) as f64;
        let (part, whole) = (&parts[n], &parts[body]);
        let is_hidden = share(self.first[n], self.shadows[n]) < HIDDEN_SHARE;
        let reaches_in = part.high.y > whole.low.y;
        let is_peg = reaches_in && share(self.shadows[n], self.first[body]) < PEG_SHARE;
        let is_beside = share(self.shared[n], self.shadows[n]) < HIDDEN_SHARE;
        if share(self.shadows[n], self.first[body]) < SPECK_SHARE && is_beside {
            Some(WhyLeftOut::Speck)
        } else if is_hidden && !part.piece.is_open && !whole.encloses(part) && !is_peg {
            Some(WhyLeftOut::Below)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::{Checks, Touching, fixtures::joined};

    const INSERT_TOP_MM: f64 = 9.0;

    fn insert() -> TriangleMesh {
        TriangleMesh::block(
            Vec3::new(-22.0, 0.0, -35.0),
            Vec3::new(22.0, INSERT_TOP_MM, 35.0),
        )
    }

    /// What is left out of a file, and the body.
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
        let beside = TriangleMesh::block(Vec3::new(25.0, 3.0, 0.0), Vec3::new(27.0, 5.0, 2.0));
        let far = TriangleMesh::block(Vec3::new(0.0, 3.0, 120.0), Vec3::new(4.0, 5.0, 125.0));
        let (why, body) = left_out(joined(joined(insert(), beside), far));
        assert_eq!(why, [WhyLeftOut::Speck; 2]);
        assert_eq!(body.bounds(), insert().bounds());
    }
}
