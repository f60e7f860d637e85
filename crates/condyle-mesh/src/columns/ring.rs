//! The cells of the grid that lie well inside the outline, the ring of quads between them and the outline, and the shape of
//! its quads.

use std::f64::consts::FRAC_PI_4;

use super::{
    footprint::Footprint,
    grid::{ColumnGrid, Place, Plan, neighbours},
    outline::{Loop, turn},
};

/// Number of rings of nodes next to the outline that are moved; all others stay on the grid.
const MOVED_RINGS: usize = 3;
/// Number of rounds of smoothing; after about ten there is no visible motion.
const ROUNDS: usize = 40;

/// A plan whose rim lies on the outline, while it is smoothed.
pub(super) struct Ring<'a> {
    places: Vec<Place>,
    outlines: Vec<&'a Loop>,
    quads: Vec<[u32; 4]>,
    rims: Vec<Rim<'a>>,
}

/// A line around the cells, and the places on the outline that belong to it.
struct Rim<'a> {
    outline: &'a Loop,
    outer: Vec<u32>,
    inner: Vec<u32>,
    /// Length along the outline to each outer place, mm; it grows, and so beyond one time round.
    along_mm: Vec<f64>,
    /// Outer places that are held in a corner of the outline.
    is_held: Vec<bool>,
}

impl<'a> Ring<'a> {
    /// Returns the cells of a grid, and one quad between each of their outer sides and the outline around them.
    pub(super) fn new(grid: &ColumnGrid, pieces: &[(Core, &'a Loop)]) -> Self {
        let mut ring = Self {
            places: Vec::new(),
            outlines: Vec::new(),
            quads: Vec::new(),
            rims: Vec::new(),
        };
        for (core, outline) in pieces {
            let mut number = vec![u32::MAX; grid.point_count()];
            for &point in core.cells.iter().flatten() {
                if number[point] == u32::MAX {
                    number[point] = ring.add(grid.place_of_mm(point), outline);
                }
            }
            let cells = core.cells.iter();
            let quads = cells.map(|cell| cell.map(|point| number[point]));
            ring.quads.extend(quads);
            for line in &core.loops {
                let inner = line.iter().map(|&point| number[point]).collect();
                let mut rim = Rim::new(outline, inner, &ring.places);
                rim.hold_corners(grid.step_mm.min());
                let along = rim.along_mm.iter();
                let outer = along.map(|&along| ring.add(outline.at(along), outline));
                rim.outer = outer.collect();
                for n in 0..rim.inner.len() {
                    let after = (n + 1) % rim.inner.len();
                    let (a, b) = (rim.inner[n], rim.inner[after]);
                    ring.quads.push([b, a, rim.outer[n], rim.outer[after]]);
                }
                ring.rims.push(rim);
            }
        }
        ring
    }

    fn add(&mut self, place: Place, outline: &'a Loop) -> u32 {
        self.places.push(place);
        self.outlines.push(outline);
        self.places.len() as u32 - 1
    }

    /// Moves every place near the rim to the mean of its neighbours, and those on the outline along it; then
    /// those of a badly shaped quad until it is well shaped.
    pub(super) fn smooth(&mut self, edge_mm: f64) {
        let around = self.neighbours();
        let moved = self.near_the_rim(&around);
        let start = self.places.clone();
        for _ in 0..ROUNDS {
            for rim in &mut self.rims {
                rim.slide(&mut self.places);
            }
            for &place in &moved {
                let others = around[place].iter();
                let sum: Place = others.map(|&other| self.places[other as usize]).sum();
                self.places[place] = sum / around[place].len() as f64;
            }
        }
        let mut freedoms = vec![Freedom::Held; self.places.len()];
        for &place in &moved {
            let outline = self.outlines[place];
            // Where the outline is concave, the mean of the neighbours may lie outside.
            if !outline.goes_round(&self.places[place]) {
                self.places[place] = start[place];
            }
            freedoms[place] = Freedom::Within(outline);
        }
        for rim in &self.rims {
            for (n, &place) in rim.outer.iter().enumerate() {
                // A corner of the outline that sticks out keeps its place.
                let sticks_out = rim.outline.turned_at(rim.along_mm[n], edge_mm) > 0.0;
                if !(rim.is_held[n] && sticks_out) {
                    freedoms[place as usize] = Freedom::Along(rim.outline);
                }
            }
        }
        shape(&mut self.places, &self.quads, &freedoms, edge_mm);
    }

    pub(super) fn plan(&self) -> Plan {
        Plan {
            places_mm: self.places.clone(),
            quads: self.quads.clone(),
        }
    }

    /// Returns the places on the outline, each with the one inside that belongs to it.
    pub(super) fn spokes(&self) -> impl Iterator<Item = (u32, u32)> {
        let pairs = self.rims.iter().map(|rim| rim.outer.iter().zip(&rim.inner));
        pairs.flatten().map(|(&outer, &inner)| (outer, inner))
    }

    /// Returns for each place those that a side of a quad joins it with.
    fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.places.len()];
        for quad in &self.quads {
            for side in 0..4 {
                let (a, b) = (quad[side], quad[(side + 1) % 4]);
                for (from, to) in [(a, b), (b, a)] {
                    if !around[from as usize].contains(&to) {
                        around[from as usize].push(to);
                    }
                }
            }
        }
        around
    }

    /// Returns the places not on the outline and at most [`MOVED_RINGS`] sides away from it.
    fn near_the_rim(&self, around: &[Vec<u32>]) -> Vec<usize> {
        let mut rings = vec![usize::MAX; self.places.len()];
        let mut last: Vec<u32> = self.spokes().map(|(outer, _)| outer).collect();
        for ring in 0..=MOVED_RINGS {
            last.retain(|&place| {
                let is_new = rings[place as usize] == usize::MAX;
                if is_new {
                    rings[place as usize] = ring;
                }
                is_new
            });
            let next = last.iter().flat_map(|&place| &around[place as usize]);
            last = next.copied().collect();
        }
        let is_moved = |place: &usize| (1..=MOVED_RINGS).contains(&rings[*place]);
        (0..self.places.len()).filter(is_moved).collect()
    }
}

impl<'a> Rim<'a> {
    /// Assigns each place of a line to the nearest one of the outline.
    fn new(outline: &'a Loop, inner: Vec<u32>, places: &[Place]) -> Self {
        let mut along_mm: Vec<f64> = Vec::with_capacity(inner.len());
        for &place in &inner {
            let nearest = outline.nearest(&places[place as usize]).0;
            let last = along_mm.last();
            let unrolled = last.map_or(nearest, |last| last + outline.signed_way(*last, nearest));
            along_mm.push(unrolled);
        }
        Self {
            outline,
            outer: Vec::new(),
            is_held: vec![false; inner.len()],
            inner,
            along_mm,
        }
    }

    /// Puts the nearest place into each corner of the outline.
    fn hold_corners(&mut self, edge_mm: f64) {
        for corner in self.outline.corners(edge_mm) {
            let way = |n: &usize| self.outline.signed_way(self.along_mm[*n], corner);
            let free = (0..self.along_mm.len()).filter(|&n| !self.is_held[n]);
            let nearest = free.min_by(|a, b| way(a).abs().total_cmp(&way(b).abs()));
            if let Some(n) = nearest {
                self.along_mm[n] += way(&n);
                self.is_held[n] = true;
            }
        }
    }

    /// Moves every outer place half-way to the middle of its neighbours, and half to the inner one.
    fn slide(&mut self, places: &mut [Place]) {
        let (count, length_mm) = (self.along_mm.len(), self.outline.length_mm());
        for n in (0..count).filter(|&n| !self.is_held[n]) {
            // Lengths grow along the rim, so its ends are one time round apart.
            let (before_round, after_round) = (
                if n == 0 { length_mm } else { 0.0 },
                if n + 1 == count { length_mm } else { 0.0 },
            );
            let before_mm = self.along_mm[(n + count - 1) % count] - before_round;
            let after_mm = self.along_mm[(n + 1) % count] + after_round;
            let middle = (before_mm + after_mm) / 2.0;
            let inner = self.outline.nearest(&places[self.inner[n] as usize]).0;
            let inner = self.along_mm[n] + self.outline.signed_way(self.along_mm[n], inner);
            self.along_mm[n] = (middle + inner) / 2.0;
            places[self.outer[n] as usize] = self.outline.at(self.along_mm[n]);
        }
    }
}

/// Distance of the corners of a cell well inside from the outline, in edges: as much
/// as the narrowest quad between them needs.
const MIN_RING: f64 = 0.5;

/// Cells of a grid that are connected by their sides, and the closed lines around them.
#[derive(Clone)]
pub(super) struct Core {
    pub(super) cells: Vec<[usize; 4]>,
    /// Grid points along each line around the cells, anticlockwise seen from above; clockwise
    /// around a hole.
    pub(super) loops: Vec<Vec<usize>>,
}

impl Core {
    /// Returns the connected pieces of the cells of a grid that lie well inside a footprint.
    pub(super) fn pieces(grid: &ColumnGrid, footprint: &Footprint<'_>) -> Vec<Self> {
        let is_well_inside = |number: usize| {
            let place = grid.place_of_mm(number);
            let ring = grid.step_mm * MIN_RING;
            let mut around = eight_directions().map(|way| place + way.component_mul(&ring));
            footprint.holds_near(place) && around.all(|other| footprint.holds_near(other))
        };
        let is_deep: Vec<bool> = (0..grid.point_count()).map(is_well_inside).collect();
        let cells = grid.all_cells().map(|(i, k)| grid.corners(i, k));
        let mut is_in: Vec<bool> = cells
            .map(|corners| corners.iter().all(|&corner| is_deep[corner]))
            .collect();
        part_pinched(grid, &mut is_in);
        let (nx, nz) = grid.cells;
        let mut pieces = Vec::new();
        // Each piece is the first cell left with all that are connected with it by their sides, in the grid's order.
        while let Some(first) = is_in.iter().position(|is_in| *is_in) {
            let mut open = vec![first];
            let mut piece = Vec::new();
            while let Some(cell) = open.pop() {
                if std::mem::replace(&mut is_in[cell], false) {
                    piece.push(cell);
                    open.extend(neighbours(cell, nx, nz).filter(|&other| is_in[other]));
                }
            }
            piece.sort_unstable();
            let corners = piece.iter().map(|cell| grid.corners(cell / nz, cell % nz));
            let cells: Vec<[usize; 4]> = corners.collect();
            let loops = loops(grid.point_count(), &cells);
            pieces.push(Self { cells, loops });
        }
        pieces
    }
}

/// Leaves out cells that meet another at a corner alone, until none does: around such a corner
/// two lines would cross.
fn part_pinched(grid: &ColumnGrid, is_in: &mut [bool]) {
    let (nx, nz) = grid.cells;
    let mut is_done = false;
    while !is_done {
        is_done = true;
        for i in 0..nx.saturating_sub(1) {
            for k in 0..nz.saturating_sub(1) {
                let around = [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)];
                let around = around.map(|(i, k)| i * nz + k);
                let [a, b, c, d] = around.map(|cell| is_in[cell]);
                if a == c && b == d && a != b {
                    is_in[around[usize::from(b)]] = false;
                    is_done = false;
                }
            }
        }
    }
}

/// Returns the closed lines around some cells of a grid, each point once.
fn loops(point_count: usize, cells: &[[usize; 4]]) -> Vec<Vec<usize>> {
    let sides = |cell: &[usize; 4]| [0, 1, 2, 3].map(|n| (cell[n], cell[(n + 1) % 4]));
    let mut after: Vec<Vec<usize>> = vec![Vec::new(); point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        after[from].push(to);
    }
    let mut next = vec![usize::MAX; point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        // A side that no other cell runs the other way is outside.
        if !after[to].contains(&from) {
            next[from] = to;
        }
    }
    let mut loops = Vec::new();
    for first in 0..point_count {
        let (mut line, mut at) = (Vec::new(), first);
        while next[at] != usize::MAX {
            line.push(at);
            at = std::mem::replace(&mut next[at], usize::MAX);
        }
        if !line.is_empty() {
            loops.push(line);
        }
    }
    loops
}

/// Quads whose corners all have a larger sine than this are left as they are.
const WELL_SHAPED: f64 = 0.6;
/// Lengths of the trial moves of a place, in edges.
const STEPS: [f64; 4] = [0.3, 0.1, 0.03, 0.01];
/// Maximum number of rounds; a badly shaped quad takes about ten.
const MAX_SHAPINGS: usize = 40;

#[derive(Clone, Copy)]
enum Freedom<'a> {
    Held,
    Along(&'a Loop),
    Within(&'a Loop),
}

impl Freedom<'_> {
    fn trials(self, place: &Place, length_mm: f64) -> Vec<Place> {
        match self {
            Self::Held => Vec::new(),
            Self::Along(outline) => {
                let here = outline.nearest(place).0;
                let ends = [here - length_mm, here + length_mm];
                ends.map(|along| outline.at(along)).to_vec()
            }
            Self::Within(outline) => {
                let around = eight_directions().map(|way| place + way * length_mm);
                around.filter(|tried| outline.goes_round(tried)).collect()
            }
        }
    }
}

fn eight_directions() -> impl Iterator<Item = Place> + Clone {
    (0..8).map(|eighth| {
        let (sine, cosine) = (f64::from(eighth) * FRAC_PI_4).sin_cos();
        Place::new(cosine, sine)
    })
}

/// Moves places so that the worst corner next to each is as good as possible, until no corner is bad.
fn shape(places: &mut [Place], quads: &[[u32; 4]], freedoms: &[Freedom<'_>], edge_mm: f64) {
    let mut quads_of = vec![Vec::new(); places.len()];
    for quad in quads {
        for &place in quad {
            quads_of[place as usize].push(*quad);
        }
    }
    for _ in 0..MAX_SHAPINGS {
        let mut has_moved = false;
        for place in 0..places.len() {
            let around = &quads_of[place];
            let worst = min_sine(places, around);
            if worst >= WELL_SHAPED {
                continue;
            }
            let start = places[place];
            let mut best = (worst, start);
            for step in STEPS {
                for tried in freedoms[place].trials(&start, step * edge_mm) {
                    places[place] = tried;
                    let sine = min_sine(places, around);
                    if sine > best.0 {
                        best = (sine, tried);
                    }
                }
            }
            places[place] = best.1;
            has_moved |= best.1 != start;
        }
        if !has_moved {
            return;
        }
    }
}

/// Returns the smallest sine of a corner of some quads; negative if one is inverted.
fn min_sine(places: &[Place], quads: &[[u32; 4]]) -> f64 {
    let corners = quads
        .iter()
        .flat_map(|quad| (0..4).map(move |corner| (quad, corner)));
    let sines = corners.map(|(quad, corner)| {
        let [here, after, before] =
            [0, 1, 3].map(|step| places[quad[(corner + step) % 4] as usize]);
        let (along, back) = (after - here, before - here);
        // Two places at one point have no angle; 0/0 becomes 0, a corner that is bad.
        turn(&along, &back) / (along.norm() * back.norm()).max(f64::MIN_POSITIVE)
    });
    sines.fold(f64::INFINITY, f64::min)
}
