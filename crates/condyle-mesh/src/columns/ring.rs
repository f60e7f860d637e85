//! The ring of quads between the cells of a grid and the outline, evened out.

use super::grid::{ColumnGrid, Plan};
use super::{
    core::Core,
    outline::{Loop, Place},
    shaped::{Freedom, shape},
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
