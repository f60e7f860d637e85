//! The cells of the grid that lie well inside the outline, and the ring of quads between them and the outline.

use super::{
    footprint::Footprint,
    grid::{ColumnGrid, Plan},
    outline::{Freedom, Loop, Place, shape},
};

/// Places this many rings inside the outline are moved, those further in stay on the grid.
const MOVED_RINGS: usize = 3;
/// Rounds of evening out; after some ten nothing moves that could be seen.
const ROUNDS: usize = 40;

/// A plan whose rim lies on the outline, while it is evened out.
pub struct Ring<'a> {
    places: Vec<Place>,
    /// The outline around each place.
    outlines: Vec<&'a Loop>,
    quads: Vec<[u32; 4]>,
    rims: Vec<Rim<'a>>,
}

/// A line around the cells, and the places on the outline that belong to it.
struct Rim<'a> {
    outline: &'a Loop,
    /// Places on the outline, in the order of the line.
    outer: Vec<u32>,
    /// Places of the line.
    inner: Vec<u32>,
    /// Where along the outline each outer place is, mm; it grows, and so beyond one time round.
    along_mm: Vec<f64>,
    /// Outer places that are held in a corner of the outline.
    is_held: Vec<bool>,
}

impl<'a> Ring<'a> {
    /// Cells of a grid and one quad between each of their outer sides and the outline around them.
    pub fn new(grid: &ColumnGrid, pieces: &[(Core, &'a Loop)]) -> Self {
        let mut ring = Self {
            places: Vec::new(),
            outlines: Vec::new(),
            quads: Vec::new(),
            rims: Vec::new(),
        };
        for (core, outline) in pieces {
            ring.add_piece(grid, core, outline);
        }
        ring
    }

    fn add_piece(&mut self, grid: &ColumnGrid, core: &Core, outline: &'a Loop) {
        let mut number = vec![u32::MAX; grid.point_count()];
        for &point in core.cells.iter().flatten() {
            if number[point] == u32::MAX {
                number[point] = self.add(grid.place_of_mm(point), outline);
            }
        }
        let cells = core.cells.iter();
        self.quads
            .extend(cells.map(|cell| cell.map(|point| number[point])));
        for line in &core.loops {
            let inner = line.iter().map(|&point| number[point]).collect();
            self.add_rim(inner, outline, grid.step_mm.0.min(grid.step_mm.1));
        }
    }

    fn add(&mut self, place_mm: (f64, f64), outline: &'a Loop) -> u32 {
        self.places.push(Place::new(place_mm.0, place_mm.1));
        self.outlines.push(outline);
        self.places.len() as u32 - 1
    }

    fn add_rim(&mut self, inner: Vec<u32>, outline: &'a Loop, edge_mm: f64) {
        let mut rim = Rim::new(outline, inner, &self.places);
        rim.hold_corners(edge_mm);
        for n in 0..rim.inner.len() {
            let place = outline.at(rim.along_mm[n]);
            rim.outer.push(self.add((place[0], place[1]), outline));
        }
        for n in 0..rim.inner.len() {
            let after = (n + 1) % rim.inner.len();
            let (a, b) = (rim.inner[n], rim.inner[after]);
            self.quads.push([b, a, rim.outer[n], rim.outer[after]]);
        }
        self.rims.push(rim);
    }

    /// Moves every place near the rim between those around it, and those on the outline along it; then
    /// those beside a badly shaped quad until it is not.
    pub fn even_out(&mut self, edge_mm: f64) {
        let around = self.neighbours();
        let moved = self.near_the_rim(&around);
        let start = self.places.clone();
        for _ in 0..ROUNDS {
            for rim in &mut self.rims {
                rim.slide(&mut self.places);
            }
            for &place in &moved {
                let around = &around[place];
                let sum: Place = around
                    .iter()
                    .map(|&other| self.places[other as usize])
                    .sum();
                self.places[place] = sum / around.len() as f64;
            }
        }
        // Where the outline goes in, the middle of those around may lie outside.
        for &place in &moved {
            if !self.outlines[place].goes_round(&self.places[place]) {
                self.places[place] = start[place];
            }
        }
        let freedoms = self.freedoms(&moved, edge_mm);
        shape(&mut self.places, &self.quads, &freedoms, edge_mm);
    }

    /// Where every place may be moved: a corner of the outline that sticks out keeps its place.
    fn freedoms(&self, moved: &[usize], edge_mm: f64) -> Vec<Freedom<'a>> {
        let mut freedoms = vec![Freedom::Held; self.places.len()];
        for &place in moved {
            freedoms[place] = Freedom::Within(self.outlines[place]);
        }
        for rim in &self.rims {
            for (n, &place) in rim.outer.iter().enumerate() {
                if !(rim.is_held[n] && rim.outline.sticks_out_at(rim.along_mm[n], edge_mm)) {
                    freedoms[place as usize] = Freedom::Along(rim.outline);
                }
            }
        }
        freedoms
    }

    /// The plan as it is now.
    pub fn plan(&self) -> Plan {
        Plan {
            places_mm: self
                .places
                .iter()
                .map(|place| (place[0], place[1]))
                .collect(),
            quads: self.quads.clone(),
        }
    }

    /// Places on the outline, each with the one inside that belongs to it.
    pub fn spokes(&self) -> impl Iterator<Item = (u32, u32)> {
        let of_rim = |rim: &'_ Rim<'a>| -> Vec<(u32, u32)> {
            rim.outer
                .iter()
                .copied()
                .zip(rim.inner.iter().copied())
                .collect()
        };
        self.rims.iter().flat_map(of_rim)
    }

    /// The places that a side of a quad joins each with.
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

    /// Places not on the outline and at most [`MOVED_RINGS`] sides away from it.
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
            last = last
                .iter()
                .flat_map(|&place| around[place as usize].clone())
                .collect();
        }
        let is_moved = |place: &usize| (1..=MOVED_RINGS).contains(&rings[*place]);
        (0..self.places.len()).filter(is_moved).collect()
    }
}

impl<'a> Rim<'a> {
    /// Each place of a line belongs to the nearest one of the outline.
    fn new(outline: &'a Loop, inner: Vec<u32>, places: &[Place]) -> Self {
        let mut along_mm: Vec<f64> = Vec::with_capacity(inner.len());
        for &place in &inner {
            let nearest = outline.nearest(&places[place as usize]).0;
            let unrolled = along_mm
                .last()
                .map_or(nearest, |last| last + outline.signed_way(*last, nearest));
            along_mm.push(unrolled);
        }
        Self {
            outline,
            outer: Vec::with_capacity(inner.len()),
            is_held: vec![false; inner.len()],
            inner,
            along_mm,
        }
    }

    /// How far the next place is along the outline, mm.
    fn next_mm(&self, n: usize) -> f64 {
        let count = self.along_mm.len();
        let round = if n + 1 == count {
            self.outline.length_mm()
        } else {
            0.0
        };
        self.along_mm[(n + 1) % count] + round
    }

    fn before_mm(&self, n: usize) -> f64 {
        let count = self.along_mm.len();
        let round = if n == 0 {
            self.outline.length_mm()
        } else {
            0.0
        };
        self.along_mm[(n + count - 1) % count] - round
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
        for n in 0..self.along_mm.len() {
            if !self.is_held[n] {
                let middle = (self.before_mm(n) + self.next_mm(n)) / 2.0;
                let inner = self.outline.nearest(&places[self.inner[n] as usize]).0;
                let inner = self.along_mm[n] + self.outline.signed_way(self.along_mm[n], inner);
                self.along_mm[n] = (middle + inner) / 2.0;
                places[self.outer[n] as usize] = self.outline.at(self.along_mm[n]);
            }
        }
    }
}

/// A cell lies well inside if its corners are this share of an edge away from the outline: as much
/// as the narrowest quad between them needs.
const MIN_RING: f64 = 0.5;

/// Cells of a grid that hang together by their sides, and the closed lines around them.
#[derive(Clone)]
pub struct Core {
    /// Grid points at the corners of each cell.
    pub cells: Vec<[usize; 4]>,
    /// Grid points along each line around the cells, anticlockwise seen from above; clockwise
    /// around a hole.
    pub loops: Vec<Vec<usize>>,
}

impl Core {
    /// The cells of a grid that lie well inside a footprint, each piece that hangs together by itself.
    pub fn pieces(grid: &ColumnGrid, footprint: &Footprint<'_>) -> Vec<Self> {
        let numbers = 0..grid.point_count();
        let is_deep: Vec<bool> = numbers
            .map(|number| is_well_inside(grid, footprint, number))
            .collect();
        let (nx, nz) = grid.cells;
        let corners = (0..nx).flat_map(|i| (0..nz).map(move |k| grid.corners(i, k)));
        let is_in = corners
            .map(|corners| corners.iter().all(|&corner| is_deep[corner]))
            .collect();
        let mut kept = Kept { grid, is_in };
        kept.part_pinched();
        let mut pieces = Vec::new();
        while let Some(cells) = kept.take_piece() {
            let loops = loops(grid.point_count(), &cells);
            pieces.push(Self { cells, loops });
        }
        pieces
    }
}

fn is_well_inside(grid: &ColumnGrid, footprint: &Footprint<'_>, number: usize) -> bool {
    let place = grid.place_of_mm(number);
    let ring = Place::new(grid.step_mm.0, grid.step_mm.1) * MIN_RING;
    let around = (0..8).map(|eighth| {
        let (sine, cosine) = (f64::from(eighth) * std::f64::consts::FRAC_PI_4).sin_cos();
        (place.0 + cosine * ring[0], place.1 + sine * ring[1])
    });
    footprint.holds_near(place) && { around }.all(|beside| footprint.holds_near(beside))
}

/// Which cells of a grid are kept.
struct Kept<'a> {
    grid: &'a ColumnGrid,
    is_in: Vec<bool>,
}

impl Kept<'_> {
    fn number(&self, i: usize, k: usize) -> usize {
        i * self.grid.cells.1 + k
    }

    /// Takes the first cell with all that hang together with it by their sides, in the grid's order.
    fn take_piece(&mut self) -> Option<Vec<[usize; 4]>> {
        let nz = self.grid.cells.1;
        let mut open = vec![self.is_in.iter().position(|is_in| *is_in)?];
        let mut piece = Vec::new();
        while let Some(cell) = open.pop() {
            if std::mem::replace(&mut self.is_in[cell], false) {
                piece.push(cell);
                let (i, k) = (cell / nz, cell % nz);
                let before = [(i > 0).then(|| cell - nz), (k > 0).then(|| cell - 1)];
                let after = [
                    (i + 1 < self.grid.cells.0).then_some(cell + nz),
                    (k + 1 < nz).then_some(cell + 1),
                ];
                let beside = before.into_iter().chain(after).flatten();
                open.extend(beside.filter(|&cell| self.is_in[cell]));
            }
        }
        piece.sort_unstable();
        let corners = |cell: &usize| self.grid.corners(cell / nz, cell % nz);
        Some(piece.iter().map(corners).collect())
    }

    /// Leaves out cells that meet another at a corner alone, until none does: around such a corner
    /// two lines would cross.
    fn part_pinched(&mut self) {
        let (nx, nz) = self.grid.cells;
        let mut is_done = false;
        while !is_done {
            is_done = true;
            for i in 0..nx.saturating_sub(1) {
                for k in 0..nz.saturating_sub(1) {
                    let around = [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)]
                        .map(|(i, k)| self.number(i, k));
                    let is_in = around.map(|cell| self.is_in[cell]);
                    if is_in[0] == is_in[2] && is_in[1] == is_in[3] && is_in[0] != is_in[1] {
                        self.is_in[around[usize::from(is_in[1])]] = false;
                        is_done = false;
                    }
                }
            }
        }
    }
}

/// The closed lines around some cells of a grid, each point once.
fn loops(point_count: usize, cells: &[[usize; 4]]) -> Vec<Vec<usize>> {
    let sides = |cell: &[usize; 4]| [0, 1, 2, 3].map(|n| (cell[n], cell[(n + 1) % 4]));
    let mut after: Vec<Vec<usize>> = vec![Vec::new(); point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        after[from].push(to);
    }
    let is_outer = |from: usize, to: usize| !after[to].contains(&from);
    let mut next = vec![usize::MAX; point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        if is_outer(from, to) {
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
