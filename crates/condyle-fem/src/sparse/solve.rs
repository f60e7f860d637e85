//! Forward and backward substitution, several right-hand sides side by side.

use std::ops::Range;

use wide::f64x4;

use crate::sparse::{factor::Factor, rhs::Rhs, tiles::TILE};

/// Four rows of right-hand sides.
type Rows<const W: usize> = [[f64x4; W]; TILE];

impl Factor {
    /// Displacements in place of forces.
    pub(crate) fn solve<const W: usize>(&self, x: &mut Rhs<W>) {
        let mut front = Vec::new();
        for group in 0..self.fronts.len() {
            self.forward(group, x, &mut front);
        }
        for group in (0..self.fronts.len()).rev() {
            self.backward(group, x, &mut front);
        }
    }

    /// Displacements in place of forces, for some right-hand sides, where they are asked for.
    ///
    /// `loaded`: of every right-hand side the groups with forces, and all groups above those.
    /// `wanted`: groups whose displacements are asked for, and all groups above those; other rows are undefined.
    pub(crate) fn solve_some<const W: usize>(
        &self,
        xs: &mut [Rhs<W>],
        loaded: &[Vec<bool>],
        wanted: &[bool],
    ) {
        // All right-hand sides go through a front while it is in the cache.
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
        for group in (0..self.fronts.len()).rev().filter(|&group| wanted[group]) {
            for x in xs.iter_mut() {
                self.backward(group, x, &mut front);
            }
        }
    }

    /// Solves half way for right-hand sides that only these groups feel, with all groups above those, ascending:
    /// the rows of these, one after the other. Leaves zeros behind.
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

    /// Freedoms that a group eliminates.
    pub(crate) fn own_freedoms(&self, group: usize) -> Range<usize> {
        let own = &self.dissection.groups[group].own;
        3 * own.start as usize..3 * own.end as usize
    }

    /// The groups of some places, and all groups above them.
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
            subtract(here, &down(&row[..TILE * t], before));
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

/// Freedoms of places, in their order.
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

#[inline(always)]
fn subtract<const W: usize>(from: &mut [[f64x4; W]], sums: &Rows<W>) {
    for (row, sum) in from.iter_mut().zip(sums) {
        for (x, sum) in row.iter_mut().zip(sum) {
            *x -= *sum;
        }
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
