//! The factor of the compliance of nodes that press, kept while few of them change.

use super::{
    cholesky::{Cholesky, Eight, subtract, zero},
    compliance::KnownColumns,
};
use crate::number::{F64x4, LANES, Number};

/// How many changes go side by side.
const SIDES: usize = 2 * LANES;
/// With more changes than this the matrix is factored anew: that takes n^3/6 products, each change n^2/2 and more.
const MOST_CHANGES: usize = 32;
/// So many columns of changes are kept, those of nodes that have changed back among them.
const MOST_KEPT: usize = 64;
/// A node that is in no row.
const NONE: u32 = u32::MAX;

/// Loads on the nodes that press, from their overclosures.
///
/// The compliance C = L L' of the nodes B that pressed some time ago is factored. Since then nodes E have begun to
/// press, and R have ceased. With W = [C_BE, I_R] and Z = L\W the changes x, loads on E and what holds R, satisfy
///
/// $$ \left( \begin{bmatrix} C_{EE} & 0 \cr 0 & 0 \end{bmatrix} - Z^T Z \right) x =
///    \begin{bmatrix} d_E \cr 0 \end{bmatrix} - Z^T y, \qquad y = L^{-1} d_B, \qquad N_B = L^{-T} (y - Z x). $$
///
/// The small matrix is quasi-definite: L D L' of it exists in any order.
pub(super) struct ChangedFactor {
    /// B, and the row of every surface node in it.
    nodes: Vec<u32>,
    row_of: Vec<u32>,
    factor: Cholesky,
    /// Nodes of which there are columns of Z, none twice, each eight of which share a block of Z.
    kept: Vec<Option<u32>>,
    blocks: Vec<Vec<Eight>>,
    /// Z' Z of the kept columns.
    products: Vec<[f64; MOST_KEPT]>,
    /// Which of the kept columns count now, and the factor of their matrix.
    changes: Vec<usize>,
    small: Vec<[f64; MOST_CHANGES]>,
    /// y, if it is that of the present overclosures.
    forward: Vec<Eight>,
    is_forward_known: bool,
    is_pressing: Vec<bool>,
    sides: Vec<Eight>,
}

impl ChangedFactor {
    /// No node presses, of a surface with so many.
    pub fn of_nothing(node_count: usize) -> Self {
        Self {
            nodes: Vec::new(),
            row_of: vec![NONE; node_count],
            factor: Cholesky::default(),
            kept: Vec::new(),
            blocks: Vec::new(),
            products: Vec::new(),
            changes: Vec::new(),
            small: Vec::new(),
            forward: Vec::new(),
            is_forward_known: false,
            is_pressing: vec![false; node_count],
            sides: Vec::new(),
        }
    }

    /// The next loads are from other overclosures.
    pub fn take_other_overclosures(&mut self) {
        self.is_forward_known = false;
    }

    /// Lets nodes press, and no others.
    pub fn press(&mut self, nodes: &[u32], columns: &KnownColumns) {
        let changed = self.changed(nodes);
        let is_new = |node: &&u32| !self.kept.contains(&Some(**node));
        let new: Vec<u32> = changed.iter().filter(is_new).copied().collect();
        let kept = self.kept.len() + new.len().next_multiple_of(SIDES);
        if changed.len() > MOST_CHANGES.min(nodes.len() / 2) || kept > MOST_KEPT {
            self.factor_anew(nodes, columns);
            return;
        }
        for new in new.chunks(SIDES) {
            self.keep(new, columns);
        }
        let place = |node: &u32| self.kept.iter().position(|kept| *kept == Some(*node));
        self.changes = changed.iter().filter_map(place).collect();
        self.factor_changes(columns);
    }

    /// The nodes that have ceased to press since the matrix was factored, and those that have begun.
    fn changed(&mut self, nodes: &[u32]) -> Vec<u32> {
        nodes
            .iter()
            .for_each(|&node| self.is_pressing[node as usize] = true);
        let ceased = self
            .nodes
            .iter()
            .filter(|&&node| !self.is_pressing[node as usize]);
        let begun = nodes
            .iter()
            .filter(|&&node| self.row_of[node as usize] == NONE);
        let changed = ceased.chain(begun).copied().collect();
        nodes
            .iter()
            .for_each(|&node| self.is_pressing[node as usize] = false);
        changed
    }

    fn factor_anew(&mut self, nodes: &[u32], columns: &KnownColumns) {
        self.nodes
            .iter()
            .for_each(|&node| self.row_of[node as usize] = NONE);
        self.nodes.clear();
        self.nodes.extend_from_slice(nodes);
        for (row, &node) in nodes.iter().enumerate() {
            self.row_of[node as usize] = row as u32;
        }
        let entry = |row: usize, column: usize| columns.of(nodes[column])[nodes[row] as usize];
        self.factor.factor(nodes.len(), entry);
        self.kept.clear();
        self.blocks.clear();
        self.products.clear();
        self.changes.clear();
        self.small.clear();
        self.is_forward_known = false;
    }

    /// Keeps the columns of Z of up to eight nodes.
    fn keep(&mut self, new: &[u32], columns: &KnownColumns) {
        let mut block = vec![zero(); self.factor.rows()];
        for (side, &node) in new.iter().enumerate() {
            let row = self.row_of[node as usize];
            if row == NONE {
                let column = columns.of(node);
                for (numbers, &other) in block.iter_mut().zip(&self.nodes) {
                    set(numbers, side, column[other as usize]);
                }
            } else {
                set(&mut block[row as usize], side, 1.0);
            }
        }
        self.factor.forward(&mut block);
        self.blocks.push(block);
        let sides = (0..SIDES).map(|side| new.get(side).copied());
        self.kept.extend(sides);
        self.add_products();
    }

    /// Adds the products of the last block with all blocks.
    fn add_products(&mut self) {
        let last = self.blocks.len() - 1;
        self.products.resize(self.kept.len(), [0.0; MOST_KEPT]);
        for other in 0..=last {
            let mut sums = [zero(); SIDES];
            for (own, other) in self.blocks[last].iter().zip(&self.blocks[other]) {
                for (side, sum) in sums.iter_mut().enumerate() {
                    subtract(sum, own, -get(other, side));
                }
            }
            for (side, sum) in sums.iter().enumerate() {
                for own in 0..SIDES {
                    let (i, j) = (SIDES * last + own, SIDES * other + side);
                    self.products[i][j] = get(sum, own);
                    self.products[j][i] = get(sum, own);
                }
            }
        }
    }

    /// Factors the matrix of the changes, L D L', the diagonal of L left to D.
    fn factor_changes(&mut self, columns: &KnownColumns) {
        self.small.clear();
        for i in 0..self.changes.len() {
            let mut row = [0.0; MOST_CHANGES];
            for j in 0..=i {
                let mut sum = self.of_changes(i, j, columns);
                let other = if j == i { &row } else { &self.small[j] };
                for (m, (own, other)) in row.iter().zip(other).enumerate().take(j) {
                    sum -= own * other * self.small[m][m];
                }
                row[j] = if j == i { sum } else { sum / self.small[j][j] };
            }
            self.small.push(row);
        }
    }

    /// An entry of the matrix of the changes.
    fn of_changes(&self, i: usize, j: usize, columns: &KnownColumns) -> f64 {
        let (i, j) = (self.changes[i], self.changes[j]);
        let begun =
            |kept: usize| self.kept[kept].filter(|&node| self.row_of[node as usize] == NONE);
        let own = match (begun(i), begun(j)) {
            (Some(one), Some(other)) => columns.of(one.min(other))[one.max(other) as usize],
            _ => 0.0,
        };
        own - self.products[i][j]
    }

    /// The loads on the nodes that press, in their order, from the overclosures of all surface nodes.
    pub fn solve(&mut self, nodes: &[u32], overclosures: &[Eight], loads: &mut Vec<Eight>) {
        self.find_forward(overclosures);
        let changes = self.solved_changes(overclosures);
        self.sides.clone_from(&self.forward);
        for (&kept, change) in self.changes.iter().zip(&changes) {
            let block = &self.blocks[kept / SIDES];
            for (sum, column) in self.sides.iter_mut().zip(block) {
                subtract(sum, change, get(column, kept % SIDES));
            }
        }
        self.factor.backward(&mut self.sides);
        loads.clear();
        for &node in nodes {
            let row = self.row_of[node as usize];
            let of_change = || {
                self.changes
                    .iter()
                    .position(|&kept| self.kept[kept] == Some(node))
            };
            loads.push(if row == NONE {
                of_change().map_or(zero(), |place| changes[place])
            } else {
                self.sides[row as usize]
            });
        }
    }

    /// Finds y, unless it is known; a node that ceased to press may have any overclosure.
    fn find_forward(&mut self, overclosures: &[Eight]) {
        if !self.is_forward_known {
            self.forward.clear();
            let of_nodes = self.nodes.iter().map(|&node| overclosures[node as usize]);
            self.forward.extend(of_nodes);
            self.forward.resize(self.factor.rows(), zero());
            self.factor.forward(&mut self.forward);
            self.is_forward_known = true;
        }
    }

    /// The changes x.
    fn solved_changes(&self, overclosures: &[Eight]) -> Vec<Eight> {
        let mut x: Vec<Eight> = Vec::with_capacity(self.changes.len());
        for (i, &kept) in self.changes.iter().enumerate() {
            let begun = self.kept[kept].filter(|&node| self.row_of[node as usize] == NONE);
            let mut sum = begun.map_or(zero(), |node| overclosures[node as usize]);
            for (y, column) in self.forward.iter().zip(&self.blocks[kept / SIDES]) {
                subtract(&mut sum, y, get(column, kept % SIDES));
            }
            for (known, &factor) in x.iter().zip(&self.small[i]) {
                subtract(&mut sum, known, factor);
            }
            x.push(sum);
        }
        for i in (0..x.len()).rev() {
            let scale = F64x4::splat(1.0 / self.small[i][i]);
            x[i] = x[i].map(|side| side * scale);
            for j in i + 1..x.len() {
                let known = x[j];
                subtract(&mut x[i], &known, self.small[j][i]);
            }
        }
        x
    }
}

fn get(numbers: &Eight, side: usize) -> f64 {
    numbers[side / LANES].lane(side % LANES)
}

fn set(numbers: &mut Eight, side: usize, value: f64) {
    let half = &mut numbers[side / LANES];
    let mut lanes = half.to_array();
    lanes[side % LANES] = value;
    *half = F64x4::new(lanes);
}
