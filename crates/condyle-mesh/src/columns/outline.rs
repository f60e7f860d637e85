//! The outline of an insert seen from above: closed lines around where columns may stand.

use nalgebra::Vector2;

use super::footprint::Footprint;

/// A place (x, z) in the transverse plane, mm.
pub type Place = Vector2<f64>;

/// Halvings of the distance between two samples that find the outline between them to a millionth of a
/// millimetre: further than that a triangle counts as covering a place beside its edge.
const HALVINGS: usize = 20;
/// Points of an outline closer than this are one, mm.
const ONE_POINT_MM: f64 = 1e-3;
/// An outline that turns by more than this over an edge has a corner there.
const CORNER_DEG: f64 = 50.0;
/// An outline turns from one side of a corner to the other within this many edges either way.
const CORNER_REACH: f64 = 1.5;
/// What is narrower than this many edges either way is noise of the facets, and evened out.
const EVENED_REACH: f64 = 1.0;

/// A closed line, anticlockwise seen from above around what is inside: clockwise around a hole.
pub struct Loop {
    points: Vec<Place>,
    /// Length along the line from the first point to each, and at last back to the first, mm.
    along_mm: Vec<f64>,
}

/// The sine of the angle between two directions, times their lengths; positive where the second is
/// to the left of the first seen from above.
pub fn turn(a: &Place, b: &Place) -> f64 {
    a[1] * b[0] - a[0] * b[1]
}

/// The closed lines around the footprint, by marching squares over its samples.
pub fn outline(footprint: &Footprint<'_>, edge_mm: f64) -> Vec<Loop> {
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
        loops.extend(Loop::through(points).and_then(|line| line.evened_out(edge_mm)));
    }
    loops
}

const NONE: u32 = u32::MAX;

/// For every edge between samples that the outline crosses, the edge that it crosses next.
///
/// Edge 2 n goes from sample n along x, edge 2 n + 1 along z.
fn next_crossings(footprint: &Footprint<'_>) -> Vec<u32> {
    let samples = &footprint.samples;
    let mut next = vec![NONE; 2 * samples.point_count()];
    for i in 0..samples.cells.0 {
        for k in 0..samples.cells.1 {
            let corners = samples.corners(i, k);
            let is_in = corners.map(|corner| footprint.holds_sample(corner));
            // Anticlockwise: along z, along x, back along z, back along x.
            let edges = [
                2 * corners[0] + 1,
                2 * corners[1],
                2 * corners[3] + 1,
                2 * corners[0],
            ];
            for side in 0..4 {
                if is_in[side] && !is_in[(side + 1) % 4] {
                    let enters = |&other: &usize| !is_in[other] && is_in[(other + 1) % 4];
                    let other = [3, 2, 1].map(|back| (side + back) % 4);
                    if let Some(other) = other.iter().find(|other| enters(other)) {
                        next[edges[side]] = edges[*other] as u32;
                    }
                }
            }
        }
    }
    next
}

/// The last place inside on an edge between a sample inside and one outside.
fn crossing(footprint: &Footprint<'_>, edge: usize) -> Place {
    let samples = &footprint.samples;
    let from = edge / 2;
    let to = if edge.is_multiple_of(2) {
        from + samples.cells.1 + 1
    } else {
        from + 1
    };
    let place = |number| samples.place_of_mm(number).into();
    let (mut inside, mut outside): ([f64; 2], [f64; 2]) = if footprint.holds_sample(from) {
        (place(from), place(to))
    } else {
        (place(to), place(from))
    };
    if !footprint.holds(inside.into()) || footprint.holds(outside.into()) {
        return (Place::from(inside) + Place::from(outside)) / 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = [0, 1].map(|axis| (inside[axis] + outside[axis]) / 2.0);
        if footprint.holds_exactly(middle.into()) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside.into()
}

impl Loop {
    /// The closed line through some points, if they are three or more.
    pub fn through(mut points: Vec<Place>) -> Option<Self> {
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

    /// The same line with every point in the mean of those around, which stops at corners.
    fn evened_out(&self, edge_mm: f64) -> Option<Self> {
        let corners = self.corners(edge_mm);
        let mean = |n: usize| {
            let here = self.along_mm[n];
            let to_corner = |corner: &f64| self.signed_way(here, *corner).abs();
            let reach = corners
                .iter()
                .map(to_corner)
                .fold(EVENED_REACH * edge_mm, f64::min);
            self.mean_around(n, reach)
        };
        Self::through((0..self.points.len()).map(mean).collect())
    }

    /// The mean of the line within some reach of a point, weighted by 1 - (way / reach)^2.
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

    /// Its points, (x, z), mm.
    pub fn places_mm(&self) -> Vec<[f64; 2]> {
        self.points.iter().map(|point| (*point).into()).collect()
    }

    /// Its length, mm.
    pub fn length_mm(&self) -> f64 {
        self.along_mm[self.points.len()]
    }

    /// The area inside, mm2; less than 0 of a hole.
    pub fn area_mm2(&self) -> f64 {
        let ends = (0..self.points.len()).map(|n| self.segment(n));
        ends.map(|(a, b)| turn(&a, &b) / 2.0).sum()
    }

    /// The mean of its points.
    pub fn middle(&self) -> Place {
        self.points.iter().sum::<Place>() / self.points.len() as f64
    }

    /// Whether it goes round a place: how often a line from there along x crosses it tells.
    pub fn goes_round(&self, place: &Place) -> bool {
        let crosses = |n: &usize| {
            let (a, b) = self.segment(*n);
            let share = (place[1] - a[1]) / (b[1] - a[1]);
            (a[1] > place[1]) != (b[1] > place[1]) && place[0] < a[0] + share * (b[0] - a[0])
        };
        (0..self.points.len()).filter(crosses).count() % 2 == 1
    }

    /// The place after some length along the line, mm, counted round and round.
    pub fn at(&self, along_mm: f64) -> Place {
        let along_mm = along_mm.rem_euclid(self.length_mm());
        let after = self.along_mm.partition_point(|&length| length <= along_mm);
        let n = (after - 1).min(self.points.len() - 1);
        let (a, b) = self.segment(n);
        let whole = self.along_mm[n + 1] - self.along_mm[n];
        a + (b - a) * ((along_mm - self.along_mm[n]) / whole)
    }

    /// How far along the line its nearest place to another lies, and how far that is, mm.
    pub fn nearest(&self, place: &Place) -> (f64, f64) {
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

    /// Where along the line it has corners, no two closer than `edge_mm`: the sharpest first.
    pub fn corners(&self, edge_mm: f64) -> Vec<f64> {
        let turned_by = |&along: &f64| self.turned_at(along, edge_mm).abs();
        let candidates = self.along_mm[..self.points.len()].iter();
        let mut sharp: Vec<(f64, f64)> = candidates
            .map(|along| (turned_by(along), *along))
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

    /// Whether the outline sticks out after some length, mm.
    pub fn sticks_out_at(&self, along_mm: f64, edge_mm: f64) -> bool {
        self.turned_at(along_mm, edge_mm) > 0.0
    }

    /// By how much the line turns within the reach of a corner, rad; less than 0 to the right.
    fn turned_at(&self, along_mm: f64, edge_mm: f64) -> f64 {
        let reach = CORNER_REACH * edge_mm;
        let [before, here, after] = [-reach, 0.0, reach].map(|way| self.at(along_mm + way));
        let (before, after) = (here - before, after - here);
        turn(&before, &after).atan2(before.dot(&after))
    }

    /// The shorter way along the line from one length to another, mm: less than 0 backwards.
    pub fn signed_way(&self, from: f64, to: f64) -> f64 {
        let length = self.length_mm();
        (to - from + length / 2.0).rem_euclid(length) - length / 2.0
    }

    fn segment(&self, n: usize) -> (Place, Place) {
        (self.points[n], self.points[(n + 1) % self.points.len()])
    }
}

/// Quads whose corners all have a larger sine than this are left as they are.
const WELL_SHAPED: f64 = 0.6;
/// How far a place is tried to be moved, in edges.
const STEPS: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Rounds at most; a badly shaped quad takes some ten.
const ROUNDS: usize = 40;

/// The least sine of a corner of some quads; less than 0 where one is turned round.
fn least_sine(places: &[Place], quads: &[[u32; 4]]) -> f64 {
    let corners = |quad: &[u32; 4]| {
        let quad = *quad;
        (0..4).map(move |corner| (quad, corner))
    };
    let sines = quads.iter().flat_map(corners).map(|(quad, corner)| {
        let [here, after, before] =
            [0, 1, 3].map(|step| places[quad[(corner + step) % 4] as usize]);
        let (along, back) = (after - here, before - here);
        turn(&along, &back) / (along.norm() * back.norm()).max(f64::MIN_POSITIVE)
    });
    sines.fold(f64::INFINITY, f64::min)
}

/// Where a place may be moved to.
#[derive(Clone, Copy)]
pub enum Freedom<'a> {
    /// Nowhere.
    Held,
    /// Along an outline that it is on.
    Along(&'a Loop),
    /// Anywhere inside an outline.
    Within(&'a Loop),
}

impl Freedom<'_> {
    /// Where a place may be tried that is moved by about a length, mm.
    fn tried(self, place: &Place, length_mm: f64) -> Vec<Place> {
        match self {
            Self::Held => Vec::new(),
            Self::Along(outline) => {
                let here = outline.nearest(place).0;
                let ends = [here - length_mm, here + length_mm];
                ends.map(|along| outline.at(along)).to_vec()
            }
            Self::Within(outline) => (0..8)
                .map(|eighth| {
                    let (sine, cosine) =
                        (f64::from(eighth) * std::f64::consts::FRAC_PI_4).sin_cos();
                    place + Place::new(cosine, sine) * length_mm
                })
                .filter(|tried| outline.goes_round(tried))
                .collect(),
        }
    }
}

/// Moves places one by one to where the worst corner beside them is best, while one is bad.
pub fn shape(places: &mut [Place], quads: &[[u32; 4]], freedoms: &[Freedom<'_>], edge_mm: f64) {
    let beside = quads_beside(places.len(), quads);
    let is_bad = |sine: f64| sine < WELL_SHAPED;
    for _ in 0..ROUNDS {
        let mut has_moved = false;
        for place in 0..places.len() {
            let around: Vec<[u32; 4]> = beside[place].iter().map(|&n| quads[n as usize]).collect();
            if is_bad(least_sine(places, &around)) {
                has_moved |= improve(places, place, &around, freedoms[place], edge_mm);
            }
        }
        if !has_moved {
            return;
        }
    }
}

/// Moves one place to the best of those that are tried, and says whether it is better than where it was.
fn improve(
    places: &mut [Place],
    place: usize,
    around: &[[u32; 4]],
    freedom: Freedom<'_>,
    edge_mm: f64,
) -> bool {
    let start = places[place];
    let mut best = (least_sine(places, around), start);
    for step in STEPS {
        for tried in freedom.tried(&start, step * edge_mm) {
            places[place] = tried;
            let sine = least_sine(places, around);
            if sine > best.0 {
                best = (sine, tried);
            }
        }
    }
    places[place] = best.1;
    best.1 != start
}

fn quads_beside(place_count: usize, quads: &[[u32; 4]]) -> Vec<Vec<u32>> {
    let mut beside = vec![Vec::new(); place_count];
    for (number, quad) in quads.iter().enumerate() {
        for &place in quad {
            beside[place as usize].push(number as u32);
        }
    }
    beside
}
