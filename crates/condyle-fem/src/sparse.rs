//! Sparse Cholesky factorisation of stiffness, by nested dissection of the mesh.

mod dissection;
mod tiles;

pub(crate) use dissection::Dissection;

use std::ops::Range;

use wide::f64x4;

use crate::element::NodalStiffness;
use dissection::Group;
use tiles::{Front, Layout, TILE, Triangle};

/// Ratio of a pivot to the assembled stiffness of its freedom below which the pivot counts as zero: rounding leaves
/// about 1e-15 if a rigid motion is free, and the most slender solids more than 1e-9.
const MIN_PIVOT: f64 = 1e-11;

/// The multifrontal Cholesky factor of a stiffness.
///
/// Every group of nodes has a dense front: the stiffness of its elements and the remainders of its children are
/// summed there, its own freedoms are eliminated, and the remainder goes to the group above (Duff and Reid 1983; Liu
/// 1992). One thread and one order give the same numbers on every run.
pub(crate) struct Factor {
    pub(crate) dissection: Dissection,
    pub(crate) fronts: Vec<Front>,
}

struct Assembly<'a, S> {
    hexes: &'a [[u32; 8]],
    held: &'a [[bool; 3]],
    stiffness: S,
    dissection: &'a Dissection,
    /// First row in the front of the group that is being assembled, by place.
    rows: Vec<usize>,
    /// Stiffness of every freedom as it was assembled.
    diagonal: Vec<f64>,
    /// Memory of finished fronts, for reuse.
    spare: Vec<Vec<f64x4>>,
}

impl Factor {
    /// Factors the sum of the stiffnesses of all elements.
    ///
    /// `held`: directions in which each node cannot move; if a node is not held in all directions, they become
    /// uncoupled freedoms.
    ///
    /// # Errors
    /// A node that can move without force.
    pub(crate) fn new(
        hexes: &[[u32; 8]],
        held: &[[bool; 3]],
        dissection: Dissection,
        stiffness: impl FnMut(usize) -> NodalStiffness,
    ) -> Result<Self, u32> {
        let free = dissection.order.len();
        let mut assembly = Assembly {
            hexes,
            held,
            stiffness,
            dissection: &dissection,
            rows: vec![0; free],
            diagonal: vec![0.0; 3 * free],
            spare: Vec::new(),
        };
        let mut left: Vec<Option<Triangle>> = Vec::new();
        let mut fronts = Vec::new();
        for group in &dissection.groups {
            let layout = Layout::new(group.own.len(), group.boundary.len());
            let mut triangle = assembly.front(group, &layout, &mut left);
            let own = 3 * group.own.start as usize..3 * group.own.end as usize;
            let least = assembly.diagonal[own]
                .iter()
                .map(|stiffness| MIN_PIVOT * stiffness);
            let mut least: Vec<f64> = least.collect();
            // Freedoms that pad a tile have a pivot of one.
            least.resize(layout.columns, 0.0);
            let pivots = triangle.eliminate(layout.columns, &least);
            pivots.map_err(|column| dissection.order[group.own.start as usize + column / 3])?;
            fronts.push(Front::from_triangle(&triangle, layout.columns, layout.rows));
            left.push(Some(triangle));
        }
        Ok(Self { dissection, fronts })
    }

    pub(crate) fn freedoms(&self) -> usize {
        3 * self.dissection.order.len()
    }

    pub(crate) fn len(&self) -> usize {
        self.fronts.iter().map(Front::len).sum()
    }
}

impl<S: FnMut(usize) -> NodalStiffness> Assembly<'_, S> {
    fn front(&mut self, group: &Group, layout: &Layout, left: &mut [Option<Triangle>]) -> Triangle {
        // There are thousands of fronts of different sizes, so their memory is reused.
        let memory = self.spare.pop().unwrap_or_default();
        let mut triangle = Triangle::zeros(layout.rows, memory);
        for (i, place) in group.own.clone().enumerate() {
            self.rows[place as usize] = 3 * i;
        }
        for (i, &place) in group.boundary.iter().enumerate() {
            self.rows[place as usize] = layout.columns + 3 * i;
        }
        // A unit pivot keeps the row of an uncoupled freedom out of all others: of a held one, and of one that pads a tile.
        let nodes = group.own.clone().map(|p| self.dissection.order[p as usize]);
        let held = nodes.flat_map(|node| self.held[node as usize]).enumerate();
        let held = held.filter(|(_, is_held)| *is_held).map(|(row, _)| row);
        for row in held.chain(3 * group.own.len()..layout.columns) {
            *triangle.at_mut(row, row) = 1.0;
        }
        for &element in &group.elements {
            self.add_element(element as usize, &mut triangle);
        }
        for &child in &group.children {
            let Some(remainder) = left[child].take() else {
                continue;
            };
            let child = &self.dissection.groups[child];
            let rows = child.boundary.iter().flat_map(|&place| {
                let row = self.rows[place as usize];
                [row, row + 1, row + 2]
            });
            let rows: Vec<usize> = rows.collect();
            // The rows of the boundary in the front of the child come after those that it eliminated.
            let first = Layout::new(child.own.len(), 0).columns;
            for (i, &row) in rows.iter().enumerate() {
                let into = triangle.row_mut(row / TILE);
                let from = &remainder.row((first + i) / TILE)[first..];
                let (lane, from_lane) = (row % TILE, (first + i) % TILE);
                for (&column, from) in rows[..=i].iter().zip(from) {
                    into[column].as_mut_array()[lane] += from.as_array()[from_lane];
                }
            }
            self.spare.push(remainder.into_memory());
        }
        triangle
    }

    fn add_element(&mut self, element: usize, triangle: &mut Triangle) {
        let stiffness = (self.stiffness)(element);
        // Of every freedom of the element its row in the front, and where its own stiffness is counted.
        let mut freedoms = Vec::with_capacity(24);
        for (corner, &node) in self.hexes[element].iter().enumerate() {
            let Some(place) = self.dissection.place(node) else {
                continue;
            };
            let place = place as usize;
            // The pivots are compared with the stiffness as assembled, before elimination reduces them.
            for i in (0..3).filter(|&i| !self.held[node as usize][i]) {
                freedoms.push((self.rows[place] + i, 3 * corner + i));
                self.diagonal[3 * place + i] += stiffness[(3 * corner + i, 3 * corner + i)];
            }
        }
        for &(row, i) in &freedoms {
            let own = triangle.row_mut(row / TILE);
            for &(column, j) in freedoms.iter().filter(|(column, _)| *column <= row) {
                own[column].as_mut_array()[row % TILE] += stiffness[(i, j)];
            }
        }
    }
}

/// `4 W` columns of forces or displacements, a row for every freedom in the order of elimination.
pub(crate) struct Rhs<const W: usize> {
    pub(crate) rows: Vec<[f64x4; W]>,
}

impl<const W: usize> Rhs<W> {
    pub(crate) const COLUMNS: usize = 4 * W;

    pub(crate) fn new(freedoms: usize) -> Self {
        Self {
            rows: vec![[f64x4::ZERO; W]; freedoms],
        }
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column / 4].as_array()[column % 4]
    }

    pub(crate) fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.rows[row][column / 4].as_mut_array()[column % 4]
    }
}

type Rows<const W: usize> = [[f64x4; W]; TILE];

impl Factor {
    /// Solves forces half way, for some right-hand sides.
    ///
    /// `loaded`: for every right-hand side, the groups with forces and all groups above those.
    pub(crate) fn forward_some<const W: usize>(&self, xs: &mut [Rhs<W>], loaded: &[Vec<bool>]) {
        let mut front = Vec::new();
        for group in 0..self.fronts.len() {
            let loaded = loaded.iter().map(|loaded| loaded[group]);
            for (x, _) in xs
                .iter_mut()
                .zip(loaded)
                .filter(|(_, is_loaded)| *is_loaded)
            {
                self.forward(group, x, &mut front);
            }
        }
    }

    /// Replaces forces that are solved half way by displacements, for some right-hand sides.
    pub(crate) fn backward_all<const W: usize>(&self, xs: &mut [Rhs<W>]) {
        // All right-hand sides go through a front while it is in the cache.
        let mut front = Vec::new();
        for group in (0..self.fronts.len()).rev() {
            for x in xs.iter_mut() {
                self.backward(group, x, &mut front);
            }
        }
    }

    /// Solves half way for right-hand sides that affect only these groups, which include all groups above them,
    /// ascending; returns their rows one after the other, and resets them to zero.
    pub(crate) fn solve_half<const W: usize>(
        &self,
        groups: &[usize],
        x: &mut Rhs<W>,
    ) -> Vec<[f64x4; W]> {
        let (mut front, mut half) = (Vec::new(), Vec::new());
        for &group in groups {
            self.forward(group, x, &mut front);
            let own = &mut x.rows[self.own_freedoms(group)];
            half.extend_from_slice(own);
            own.fill([f64x4::ZERO; W]);
        }
        half
    }

    pub(crate) fn own_freedoms(&self, group: usize) -> Range<usize> {
        let own = &self.dissection.groups[group].own;
        3 * own.start as usize..3 * own.end as usize
    }

    /// Returns the groups of some places, and all groups above them.
    pub(crate) fn paths(&self, places: impl Iterator<Item = u32>) -> Vec<bool> {
        let mut on_path = vec![false; self.fronts.len()];
        for place in places {
            let mut next = Some(self.dissection.group_of(place));
            while let Some(group) = next.filter(|&group| !on_path[group]) {
                on_path[group] = true;
                next = self.dissection.parents[group];
            }
        }
        on_path
    }

    fn forward<const W: usize>(&self, group: usize, x: &mut Rhs<W>, front: &mut Vec<[f64x4; W]>) {
        let own = self.own_freedoms(group);
        let (group, factor) = (&self.dissection.groups[group], &self.fronts[group]);
        front.clear();
        front.extend_from_slice(&x.rows[own.clone()]);
        front.resize(factor.columns, [f64x4::ZERO; W]);
        for t in 0..factor.columns / TILE {
            let row = factor.row(t);
            let (before, here) = front.split_at_mut(TILE * t);
            for (x, sum) in here.iter_mut().zip(down(&row[..TILE * t], before)) {
                for (x, sum) in x.iter_mut().zip(sum) {
                    *x -= sum;
                }
            }
            solve_tile(&row[TILE * t..], here);
        }
        x.rows[own.clone()].copy_from_slice(&front[..own.len()]);
        let mut freedoms = freedoms(&group.boundary);
        for t in factor.columns / TILE..factor.rows() {
            let sums = down(factor.row(t), front);
            for (sum, freedom) in sums.iter().zip(&mut freedoms) {
                for (x, sum) in x.rows[freedom].iter_mut().zip(sum) {
                    *x -= *sum;
                }
            }
        }
    }

    fn backward<const W: usize>(&self, group: usize, x: &mut Rhs<W>, front: &mut Vec<[f64x4; W]>) {
        let own = self.own_freedoms(group);
        let (group, factor) = (&self.dissection.groups[group], &self.fronts[group]);
        front.clear();
        front.extend_from_slice(&x.rows[own.clone()]);
        front.resize(factor.columns, [f64x4::ZERO; W]);
        let mut freedoms = freedoms(&group.boundary);
        for t in factor.columns / TILE..factor.rows() {
            let x = std::array::from_fn(|_| {
                let freedom = freedoms.next();
                freedom.map_or([f64x4::ZERO; W], |freedom| x.rows[freedom])
            });
            subtract_up(front, factor.row(t), &x);
        }
        for t in (0..factor.columns / TILE).rev() {
            let row = factor.row(t);
            let (before, here) = front.split_at_mut(TILE * t);
            solve_tile_transposed(&row[TILE * t..], here);
            subtract_up(before, &row[..TILE * t], &std::array::from_fn(|r| here[r]));
        }
        x.rows[own.clone()].copy_from_slice(&front[..own.len()]);
    }
}

fn freedoms(places: &[u32]) -> impl Iterator<Item = usize> {
    places
        .iter()
        .flat_map(|&place| (0..3).map(move |i| 3 * place as usize + i))
}

/// Product of a row of tiles with the rows of right-hand sides.
#[inline(always)]
fn down<const W: usize>(row: &[f64x4], x: &[[f64x4; W]]) -> Rows<W> {
    let mut sums = [[f64x4::ZERO; W]; TILE];
    for (column, x) in row.iter().zip(x) {
        for (sum, &number) in sums.iter_mut().zip(column.as_array()) {
            let number = f64x4::splat(number);
            for (sum, x) in sum.iter_mut().zip(x) {
                *sum = x.mul_add(number, *sum);
            }
        }
    }
    sums
}

/// Subtracts from rows of right-hand sides the product of a transposed row of tiles with four others.
#[inline(always)]
fn subtract_up<const W: usize>(from: &mut [[f64x4; W]], row: &[f64x4], x: &Rows<W>) {
    for (from, column) in from.iter_mut().zip(row) {
        let mut left = *from;
        for (x, &number) in x.iter().zip(column.as_array()) {
            let number = f64x4::splat(number);
            for (left, x) in left.iter_mut().zip(x) {
                *left = number.mul_neg_add(*x, *left);
            }
        }
        *from = left;
    }
}

/// Solves with a tile on the diagonal, which holds the inverses of its pivots.
#[inline(always)]
fn solve_tile<const W: usize>(tile: &[f64x4], x: &mut [[f64x4; W]]) {
    for j in 0..TILE {
        let column = tile[j].as_array();
        let solved = x[j].map(|x| x * f64x4::splat(column[j]));
        x[j] = solved;
        for i in j + 1..TILE {
            subtract_product(&mut x[i], column[i], &solved);
        }
    }
}

/// The same with the transposed tile.
#[inline(always)]
fn solve_tile_transposed<const W: usize>(tile: &[f64x4], x: &mut [[f64x4; W]]) {
    for j in (0..TILE).rev() {
        let column = tile[j].as_array();
        for i in j + 1..TILE {
            let solved = x[i];
            subtract_product(&mut x[j], column[i], &solved);
        }
        x[j] = x[j].map(|x| x * f64x4::splat(column[j]));
    }
}

#[inline(always)]
fn subtract_product<const W: usize>(from: &mut [f64x4; W], number: f64, x: &[f64x4; W]) {
    for (from, x) in from.iter_mut().zip(x) {
        *from -= f64x4::splat(number) * *x;
    }
}
