//! The compliance of a surface under loads on its nodes, computed tile by tile when it is first needed.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};

use condyle_fem::{ElasticSolid, HalfSolved};

use super::cholesky::{Eight, ROWS, zero};
use crate::{
    Vec3,
    contact::law::KnownCompliance,
    geometry::bounds,
    number::{F64x4, LANES, Number},
};

/// The source of a compliance: displacements of a surface's nodes by unit loads on them, along the same directions.
///
/// It is symmetric and positive definite. It is computed for two tiles of nodes at a time and on demand, since most nodes
/// are never in contact; the result does not depend on what was computed before.
pub(crate) trait SurfaceCompliance: Send + Sync {
    /// Returns all nodes of the surface, in tiles of neighbours.
    fn tiles(&self) -> &[Vec<u32>];

    /// Returns the displacements of the nodes of one tile by unit loads on another, mm/N: row-major, a row for each of `one`.
    fn between(&self, one: usize, other: usize) -> Vec<f64>;
}

/// The compliance of a surface, with the part that was needed so far.
pub(crate) struct Compliance {
    tile_of: Vec<u32>,
    near: RwLock<NearMatrix>,
    source: Arc<dyn SurfaceCompliance>,
}

impl Compliance {
    /// Prepares the compliance of a surface and computes nothing yet.
    pub fn new(source: Arc<dyn SurfaceCompliance>) -> Self {
        let nodes = source.tiles().iter().map(Vec::len).sum();
        let mut tile_of = vec![0; nodes];
        for (number, tile) in source.tiles().iter().enumerate() {
            for &node in tile {
                tile_of[node as usize] = number as u32;
            }
        }
        Self {
            near: RwLock::new(NearMatrix::new(source.tiles())),
            tile_of,
            source,
        }
    }

    pub fn node_count(&self) -> usize {
        self.tile_of.len()
    }

    /// Returns the number of nodes whose compliance is computed.
    pub fn known_count(&self) -> usize {
        self.read().rows.len()
    }

    /// Returns the number of pairs of tiles whose compliance is computed.
    pub fn known_pairs(&self) -> usize {
        self.read().pairs().count()
    }

    /// Adds the compliance computed so far to `known`.
    pub fn add_to(&self, mut known: KnownCompliance) -> KnownCompliance {
        let near = self.read();
        for [one, other] in near.pairs() {
            let tiles = [one, other].map(|tile| &self.source.tiles()[tile][..]);
            known.add(one, other, near.between(tiles));
        }
        known
    }

    pub fn tile_of(&self, node: u32) -> u32 {
        self.tile_of[node as usize]
    }

    /// Returns the compliance of some nodes and of others, computing what is missing.
    pub fn near(&self, nodes: impl Iterator<Item = u32>) -> RwLockReadGuard<'_, NearMatrix> {
        let near = self.read();
        let unknown = nodes.filter(|&node| !near.knows(node));
        let mut tiles: Vec<usize> = unknown.map(|node| self.tile_of(node) as usize).collect();
        if tiles.is_empty() {
            return near;
        }
        drop(near);
        // Sorted, so that each is added once, and in an order that does not depend on that of the nodes.
        tiles.sort_unstable();
        tiles.dedup();
        let mut near = self.near.write().unwrap_or_else(PoisonError::into_inner);
        let all = self.source.tiles();
        // Between the two locks another thread may have added some of them.
        tiles.retain(|&tile| !near.knows(all[tile][0]));
        // Room for all is reserved at once: rows that grow step by step take twice the memory.
        let new_rows = tiles
            .iter()
            .map(|&tile| all[tile].len().next_multiple_of(ROWS));
        near.room = (near.rows.len() + new_rows.sum::<usize>()) / ROWS;
        let room = near.room;
        for row in &mut near.rows {
            row.reserve_exact(room - row.len());
        }
        for tile in tiles {
            near.add(tile, all, |one, other| self.source.between(one, other));
        }
        drop(near);
        self.read()
    }

    fn read(&self) -> RwLockReadGuard<'_, NearMatrix> {
        self.near.read().unwrap_or_else(PoisonError::into_inner)
    }
}

const UNKNOWN: u32 = u32::MAX;

/// The compliance between the nodes of some tiles of a surface.
///
/// A row holds the displacements of its node by loads on all nodes, those of eight nodes, a panel, side by side. A tile is
/// padded to whole panels by nodes that do not move.
pub(crate) struct NearMatrix {
    /// Tiles in the order in which they were added, and the first row of each.
    tiles: Vec<(usize, usize)>,
    row_of: Vec<u32>,
    /// Places of all nodes, tile by tile; they do not depend on the order in which tiles were added, so that sums over nodes
    /// in this order are always the same.
    places: Vec<u32>,
    rows: Vec<Vec<Eight>>,
    /// Panels that a row has room for.
    room: usize,
    /// The place of every node's tile among those that were added, and the largest displacements between any two of these.
    slots: Vec<u32>,
    pub reaches: Vec<Vec<Reach>>,
}

/// The largest displacement of a node by a newton on another node, of the same or another tile, mm/N.
#[derive(Clone, Copy, Default)]
pub(crate) struct Reach {
    pub outwards: f64,
    pub inwards: f64,
}

impl NearMatrix {
    fn new(tiles: &[Vec<u32>]) -> Self {
        let nodes = || tiles.iter().flatten();
        let mut places = vec![0; nodes().count()];
        for (place, &node) in nodes().enumerate() {
            places[node as usize] = place as u32;
        }
        Self {
            tiles: Vec::new(),
            row_of: vec![UNKNOWN; places.len()],
            slots: vec![UNKNOWN; places.len()],
            places,
            rows: Vec::new(),
            room: 0,
            reaches: Vec::new(),
        }
    }

    fn knows(&self, node: u32) -> bool {
        self.row_of[node as usize] != UNKNOWN
    }

    /// Returns the row, which is also the column, of a node whose compliance is computed.
    #[inline(always)]
    pub fn row(&self, node: u32) -> u32 {
        self.row_of[node as usize]
    }

    /// Returns the number in a row and a column; the matrix is symmetric.
    #[inline(always)]
    pub fn at(&self, row: u32, column: u32) -> f64 {
        let numbers = &self.rows[column as usize][row as usize / ROWS];
        let row = row as usize % ROWS;
        numbers[row / LANES].lane(row % LANES)
    }

    /// Returns the place of a node in the order of tiles: those with rows in one panel stand together.
    pub fn place(&self, node: u32) -> u32 {
        self.places[node as usize]
    }

    /// Returns the place of a node's tile among those that were added.
    pub fn slot(&self, node: u32) -> usize {
        self.slots[node as usize] as usize
    }

    /// Returns the pairs of the tiles that were added, the lower number first.
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let all = || self.tiles.iter().map(|&(tile, _)| tile);
        let pairs = all().flat_map(move |one| all().map(move |other| [one, other]));
        pairs.filter(|[one, other]| one <= other)
    }

    /// Returns the compliance between two added tiles, mm/N: row-major.
    fn between(&self, tiles: [&[u32]; 2]) -> Vec<f64> {
        let [rows, columns] = tiles;
        let rows = rows.iter().map(|&node| self.row(node));
        let of_row = |row| {
            columns
                .iter()
                .map(move |&node| self.at(self.row(node), row))
        };
        rows.flat_map(of_row).collect()
    }

    /// Returns the displacement of a row's node by loads, given as panels, each with its number.
    pub fn moved(&self, row: u32, loads: &[(usize, Eight)]) -> f64 {
        // Four independent sums, so that no addition waits for the one before.
        let mut sums = [F64x4::splat(0.0); 4];
        let row = &self.rows[row as usize];
        for two in loads.chunks(2) {
            for ((panel, loads), sums) in two.iter().zip(sums.chunks_exact_mut(2)) {
                let numbers = &row[*panel];
                sums[0] = numbers[0].mul_add(loads[0], sums[0]);
                sums[1] = numbers[1].mul_add(loads[1], sums[1]);
            }
        }
        let [a, b, c, d] = sums;
        ((a + b) + (c + d)).sum()
    }

    /// Adds to `line` the numbers of some panels of a mixture of two rows.
    pub fn mix(
        &self,
        rows: [u32; 2],
        parts: [f64; 2],
        panels: &[(usize, Eight)],
        line: &mut Vec<f64>,
    ) {
        let [one, other] = rows.map(|row| &self.rows[row as usize]);
        let [of_one, of_other] = parts.map(F64x4::splat);
        for (panel, _) in panels {
            for (one, other) in one[*panel].iter().zip(&other[*panel]) {
                let mixed = one.mul_add(of_one, *other * of_other);
                line.extend_from_slice(&mixed.to_array());
            }
        }
    }

    /// Adds tile number `new` of `tiles`, with the compliance `between` it and those added before.
    fn add(
        &mut self,
        new: usize,
        tiles: &[Vec<u32>],
        mut between: impl FnMut(usize, usize) -> Vec<f64>,
    ) {
        let first = self.rows.len();
        // Whole panels: rows beyond the last node are zero and never read.
        let rows = first + tiles[new].len().next_multiple_of(ROWS);
        for (row, &node) in (first..).zip(&tiles[new]) {
            self.row_of[node as usize] = row as u32;
            self.slots[node as usize] = self.tiles.len() as u32;
        }
        self.tiles.push((new, first));
        let reaches = vec![Reach::default(); self.tiles.len()];
        self.reaches.push(reaches);
        let room = self.room;
        self.rows.resize_with(rows, || Vec::with_capacity(room));
        for row in &mut self.rows {
            row.resize(rows / ROWS, zero());
        }
        for place in 0..self.tiles.len() {
            let (other, other_first) = self.tiles[place];
            // Computed once and stored twice: the matrix is exactly symmetric.
            let numbers = between(new, other);
            let columns = tiles[other].len();
            let mut reach = Reach::default();
            for (i, row) in numbers.chunks_exact(columns).enumerate() {
                for (j, &number) in row.iter().enumerate() {
                    self.set(first + i, other_first + j, number);
                    self.set(other_first + j, first + i, number);
                    reach.outwards = reach.outwards.max(-number);
                    // Bounds are needed of nodes that carry no load themselves, so the large diagonal does not count.
                    if (new, i) != (other, j) {
                        reach.inwards = reach.inwards.max(number);
                    }
                }
            }
            let last = self.reaches.len() - 1;
            self.reaches[last][place] = reach;
            if place < last {
                self.reaches[place].push(reach);
            }
        }
    }

    fn set(&mut self, row: usize, column: usize, number: f64) {
        let half = &mut self.rows[row][column / ROWS][column % ROWS / LANES];
        let mut lanes = half.to_array();
        lanes[column % LANES] = number;
        *half = F64x4::new(lanes);
    }
}

/// Unit loads on nodes of a solid, each along a given direction, and the compliance between them.
///
/// The loads of a tile are half-solved when they are first needed, and kept. A load of one tile moves that of another by
/// the product of their half-solutions.
pub(crate) struct UnitLoads {
    solid: Arc<ElasticSolid>,
    /// The mesh node of every load, and its direction.
    forces: Vec<(u32, Vec3)>,
    tiles: Vec<Vec<u32>>,
    solved: Mutex<Vec<Option<Arc<HalfSolved>>>>,
    /// Cached results of an earlier run that this run has not used yet.
    known: Mutex<KnownCompliance>,
}

impl UnitLoads {
    /// Prepares loads on a solid; `tiles` groups the numbers of loads that lie together.
    pub fn new(solid: Arc<ElasticSolid>, forces: Vec<(u32, Vec3)>, tiles: Vec<Vec<u32>>) -> Self {
        Self {
            solid,
            forces,
            solved: Mutex::new(vec![None; tiles.len()]),
            tiles,
            known: Mutex::default(),
        }
    }

    pub fn known(&self) -> MutexGuard<'_, KnownCompliance> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn force(&self, load: u32) -> (u32, Vec3) {
        self.forces[load as usize]
    }

    pub fn forces_of(&self, tile: usize) -> Vec<(u32, Vec3)> {
        self.tiles[tile]
            .iter()
            .map(|&load| self.force(load))
            .collect()
    }

    pub fn solved(&self, tile: usize) -> Arc<HalfSolved> {
        let mut solved = self.solved.lock().unwrap_or_else(PoisonError::into_inner);
        let own = solved[tile]
            .get_or_insert_with(|| Arc::new(self.solid.half_solved(&self.forces_of(tile))));
        Arc::clone(own)
    }
}

impl SurfaceCompliance for UnitLoads {
    fn tiles(&self) -> &[Vec<u32>] {
        &self.tiles
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        let nodes = [one, other].map(|tile| self.tiles[tile].len());
        let known = self.known().take(one, other, nodes);
        known.unwrap_or_else(|| self.solved(one).moved_along(&self.solved(other)))
    }
}

/// Returns the numbers of a node's loads along the surface: anterior and lateral.
pub(crate) fn along_surface(node: u32) -> [u32; 2] {
    [2 * node, 2 * node + 1]
}

/// Divides nodes into tiles of at most `most` nodes, halving the largest extent until they are small enough.
pub(crate) fn tiles(positions: &[Vec3], most: usize) -> Vec<Vec<u32>> {
    let mut open = vec![(0..positions.len() as u32).collect::<Vec<u32>>()];
    let mut tiles = Vec::new();
    while let Some(mut nodes) = open.pop() {
        if nodes.len() <= most {
            tiles.push(nodes);
        } else {
            let at = |node: &u32| positions[*node as usize];
            let (low, high) = bounds(nodes.iter().map(|node| &positions[*node as usize]));
            let axis = (high - low).imax();
            // Ties are broken by number, so that tiles are the same on any machine.
            nodes.sort_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
            let second = nodes.split_off(nodes.len() / 2);
            open.extend([second, nodes]);
        }
    }
    tiles
}
