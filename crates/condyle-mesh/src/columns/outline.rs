//! The outline of an insert seen from above: closed lines around where columns may stand.

use super::{footprint::Footprint, grid::Place};

/// Halvings of the distance between two samples that find the outline between them to a millionth of a
/// millimetre; closer than that, a triangle counts as covering a place next to its edge.
const HALVINGS: usize = 20;
/// Points of an outline closer than this are one, mm.
const ONE_POINT_MM: f64 = 1e-3;
/// An outline that turns by more than this over an edge has a corner there.
const CORNER_DEG: f64 = 50.0;
/// An outline turns from one side of a corner to the other within this many edges either way.
const CORNER_REACH: f64 = 1.5;
/// Features narrower than this many edges either way are noise of the facets, and smoothed.
const SMOOTHING_REACH: f64 = 1.0;

/// A closed line, anticlockwise seen from above around its inside: clockwise around a hole.
pub(super) struct Loop {
    points: Vec<Place>,
    /// Length along the line from the first point to each, and at last back to the first, mm.
    along_mm: Vec<f64>,
}

/// Returns the sine of the angle between two directions, times their lengths; positive if the second is
/// to the left of the first seen from above.
pub(super) fn turn(a: &Place, b: &Place) -> f64 {
    a[1] * b[0] - a[0] * b[1]
}

/// Returns the closed lines around the footprint, by marching squares over its samples.
pub(super) fn outline(footprint: &Footprint<'_>, edge_mm: f64) -> Vec<Loop> {
    // Edges without a next crossing start nothing; closed lines end where they began.
    let next = next_crossings(footprint);
    let mut is_done = vec![false; next.len()];
    let mut loops = Vec::new();
    for first in 0..next.len() {
        let mut points = Vec::new();
        let mut at = first;
        while next[at] != NONE && !is_done[at] {
            is_done[at] = true;
            points.push(crossing(footprint, at));
            at = next[at] as usize;
        }
        loops.extend(Loop::through(points).and_then(|line| line.smoothed(edge_mm)));
    }
    loops
}

const NONE: u32 = u32::MAX;

/// Returns for every edge between samples that the outline crosses the edge that it crosses next.
///
/// Edge 2 n goes from sample n along x, edge 2 n + 1 along z.
fn next_crossings(footprint: &Footprint<'_>) -> Vec<u32> {
    let samples = &footprint.samples;
    let mut next = vec![NONE; 2 * samples.point_count()];
    for (i, k) in samples.all_cells() {
        let corners = samples.corners(i, k);
        let is_in = corners.map(|corner| footprint.holds[corner]);
        // Anticlockwise: along z, along x, back along z, back along x.
        let edges = [
            2 * corners[0] + 1,
            2 * corners[1],
            2 * corners[3] + 1,
            2 * corners[0],
        ];
        for side in (0..4).filter(|&side| is_in[side] && !is_in[(side + 1) % 4]) {
            let enters = |&other: &usize| !is_in[other] && is_in[(other + 1) % 4];
            let mut others = [3, 2, 1].map(|back| (side + back) % 4).into_iter();
            if let Some(other) = others.find(enters) {
                next[edges[side]] = edges[other] as u32;
            }
        }
    }
    next
}

/// Returns the last place inside on an edge between a sample inside and one outside.
fn crossing(footprint: &Footprint<'_>, edge: usize) -> Place {
    let samples = &footprint.samples;
    let is_along_x = edge.is_multiple_of(2);
    let step = if is_along_x { samples.cells.1 + 1 } else { 1 };
    let (mut inside, mut outside) = (edge / 2, edge / 2 + step);
    if !footprint.holds[inside] {
        std::mem::swap(&mut inside, &mut outside);
    }
    let [mut inside, mut outside] = [inside, outside].map(|n| samples.place_of_mm(n));
    // Where details were removed, the shell itself does not change between the samples.
    if !footprint.holds(inside) || footprint.holds(outside) {
        return (inside + outside) / 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = (inside + outside) / 2.0;
        if footprint.holds_exactly(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

impl Loop {
    /// Returns the closed line through some points, if they are three or more.
    pub(super) fn through(mut points: Vec<Place>) -> Option<Self> {
        let is_one = |a: &Place, b: &Place| (a - b).norm() < ONE_POINT_MM;
        points.dedup_by(|a, b| is_one(a, b));
        // The line closes: its last point may be its first one again.
        while points.len() > 1 && is_one(&points[0], &points[points.len() - 1]) {
            points.pop();
        }
        if points.len() < 3 {
            return None;
        }
        let mut along_mm = vec![0.0];
        for (n, point) in points.iter().enumerate() {
            let step = (points[(n + 1) % points.len()] - point).norm();
            along_mm.push(along_mm[n] + step);
        }
        Some(Self { points, along_mm })
    }

    fn smoothed(&self, edge_mm: f64) -> Option<Self> {
        let corners = self.corners(edge_mm);
        let mean = |n: usize| {
            let here = self.along_mm[n];
            let to_corners = corners
                .iter()
                .map(|&corner| self.signed_way(here, corner).abs());
            let reach = to_corners.fold(SMOOTHING_REACH * edge_mm, f64::min);
            self.mean_around(n, reach)
        };
        Self::through((0..self.points.len()).map(mean).collect())
    }

    /// Returns the mean of the line within some reach of a point, weighted by 1 - (way / reach)^2.
    fn mean_around(&self, n: usize, reach: f64) -> Place {
        let count = self.points.len();
        let (mut sum, mut whole) = (self.points[n] * 0.0, 0.0);
        for steps in [1, count - 1] {
            let mut at = n;
            let mut way = 0.0;
            while way < reach && way < self.length_mm() / 2.0 {
                let next = (at + steps) % count;
                let step = (self.points[next] - self.points[at]).norm();
                let weight = |way: f64| (1.0 - (way / reach).powi(2)).max(0.0) * step;
                sum += self.points[at] * weight(way) + self.points[next] * weight(way + step);
                whole += weight(way) + weight(way + step);
                (at, way) = (next, way + step);
            }
        }
        if whole > 0.0 {
            sum / whole
        } else {
            self.points[n]
        }
    }

    pub(super) fn places_mm(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(|point| (*point).into()).collect()
    }

    pub(super) fn length_mm(&self) -> f64 {
        self.along_mm[self.points.len()]
    }

    pub(super) fn area_mm2(&self) -> f64 {
        let ends = (0..self.points.len()).map(|n| self.segment(n));
        ends.map(|(a, b)| turn(&a, &b) / 2.0).sum()
    }

    pub(super) fn middle(&self) -> Place {
        self.points.iter().sum::<Place>() / self.points.len() as f64
    }

    /// Returns whether it goes round a place, by the parity of its crossings with a ray along x.
    pub(super) fn goes_round(&self, place: &Place) -> bool {
        let crosses = |n: &usize| {
            let (a, b) = self.segment(*n);
            let share = (place[1] - a[1]) / (b[1] - a[1]);
            (a[1] > place[1]) != (b[1] > place[1]) && place[0] < a[0] + share * (b[0] - a[0])
        };
        (0..self.points.len()).filter(crosses).count() % 2 == 1
    }

    /// Returns the place at a length along the closed line, mm; the length may exceed one turn.
    pub(super) fn at(&self, along_mm: f64) -> Place {
        let along_mm = along_mm.rem_euclid(self.length_mm());
        let after = self.along_mm.partition_point(|&length| length <= along_mm);
        let n = (after - 1).min(self.points.len() - 1);
        let (a, b) = self.segment(n);
        let whole = self.along_mm[n + 1] - self.along_mm[n];
        a + (b - a) * ((along_mm - self.along_mm[n]) / whole)
    }

    /// Returns the length along the line to its nearest place to another, and the distance, mm.
    pub(super) fn nearest(&self, place: &Place) -> (f64, f64) {
        let mut nearest = (0.0, f64::INFINITY);
        for n in 0..self.points.len() {
            let (a, b) = self.segment(n);
            let share = (place - a).dot(&(b - a)) / (b - a).norm_squared();
            let share = share.clamp(0.0, 1.0);
            let distance = (a + (b - a) * share - place).norm();
            if distance < nearest.1 {
                let whole = self.along_mm[n + 1] - self.along_mm[n];
                nearest = (self.along_mm[n] + share * whole, distance);
            }
        }
        nearest
    }

    /// Returns the lengths along the line to its corners, no two closer than `edge_mm`, the sharpest first.
    pub(super) fn corners(&self, edge_mm: f64) -> Vec<f64> {
        let candidates = self.along_mm[..self.points.len()].iter();
        let turned = candidates.map(|&along| (self.turned_at(along, edge_mm).abs(), along));
        let mut sharp: Vec<(f64, f64)> = turned
            .filter(|(angle, _)| *angle > CORNER_DEG.to_radians())
            .collect();
        sharp.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut corners: Vec<f64> = Vec::new();
        for (_, along) in sharp {
            let is_apart = |other: &f64| self.signed_way(along, *other).abs() > edge_mm;
            if corners.iter().all(is_apart) {
                corners.push(along);
            }
        }
        corners
    }

    /// Returns the angle by which the line turns within the reach of a corner, rad; negative to the right.
    pub(super) fn turned_at(&self, along_mm: f64, edge_mm: f64) -> f64 {
        let reach = CORNER_REACH * edge_mm;
        let [before, here, after] = [-reach, 0.0, reach].map(|way| self.at(along_mm + way));
        let (before, after) = (here - before, after - here);
        turn(&before, &after).atan2(before.dot(&after))
    }

    /// Returns the shorter way along the line from one length to another, mm; negative backwards.
    pub(super) fn signed_way(&self, from: f64, to: f64) -> f64 {
        let length = self.length_mm();
        // The remainder lies within half of the line either way.
        (to - from + length / 2.0).rem_euclid(length) - length / 2.0
    }

    fn segment(&self, n: usize) -> (Place, Place) {
        (self.points[n], self.points[(n + 1) % self.points.len()])
    }
}
