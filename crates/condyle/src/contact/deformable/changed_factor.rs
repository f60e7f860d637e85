//! The factor of the compliance of the nodes in contact, kept while few of them change.

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, product, set, subtract, zero},
    compliance::NearMatrix,
};
use crate::number::{F64x4, Number};

/// Number of changes that are stored side by side.
const SIDES: usize = ROWS;
/// Number of nodes per change below which the matrix is factored again: factoring takes n^3/6 products, and each
/// change at least n^2/2.
const NODES_A_CHANGE: usize = 4;
/// Bounds on the number of changes beyond which the matrix is factored again.
const MAX_CHANGES: [usize; 2] = [32, 320];
/// The row number that marks a node without a row.
const NONE: u32 = u32::MAX;

/// The loads on the nodes in contact, from their overclosures.
///
/// The compliance C = L L' of the nodes B that were in contact some time ago is factored. Since then nodes E have come into
/// contact, and nodes R have left it. With W = [C_BE, I_R] and Z = L\W the changes x, which are the loads on E and the
/// overclosures that keep the loads on R at zero, satisfy
///
/// $$ \left( \begin{bmatrix} C_{EE} & 0 \cr 0 & 0 \end{bmatrix} - Z^T Z \right) x =
///    \begin{bmatrix} d_E \cr 0 \end{bmatrix} - Z^T y, \qquad y = L^{-1} d_B, \qquad N_B = L^{-T} (y - Z x). $$
///
/// The small matrix is quasi-definite, so that its L D L' exists in any order of the changes: there is no pivoting, and
/// rows are appended as nodes change.
pub(crate) struct ChangedFactor {
    /// B, and the row of every surface node in it.
    nodes: Vec<u32>,
    row_of: Vec<u32>,
    factor: Cholesky,
    /// Nodes with columns of Z, each at most once; eight of them share a block of Z.
    kept: Vec<Option<u32>>,
    blocks: Vec<Vec<Eight>>,
    /// Z' Z of the kept columns, up to the diagonal.
    products: Vec<Vec<f64>>,
    /// The kept columns that count now, and the rows of the factor of their matrix.
    changes: Vec<usize>,
    small: Vec<Vec<f64>>,
    /// y, and whether it is that of the present overclosures.
    forward: Vec<Eight>,
    is_forward_known: bool,
    is_in_contact: Vec<bool>,
    sides: Vec<Eight>,
    side: Vec<f64>,
}

impl ChangedFactor {
    pub fn new(node_count: usize) -> Self {
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
            is_in_contact: vec![false; node_count],
            sides: Vec::new(),
            side: Vec::new(),
        }
    }

    pub fn take_other_overclosures(&mut self) {
        self.is_forward_known = false;
    }

    pub fn set_contact(&mut self, nodes: &[u32], compliance: &NearMatrix) {
        for &node in nodes {
            self.is_in_contact[node as usize] = true;
        }
        let left = self.nodes.iter();
        let left = left.filter(|&&node| !self.is_in_contact[node as usize]);
        let new = nodes.iter();
        let new = new.filter(|&&node| self.row_of[node as usize] == NONE);
        let changed: Vec<u32> = left.chain(new).copied().collect();
        for &node in nodes {
            self.is_in_contact[node as usize] = false;
        }
        let is_new = |node: &&u32| !self.kept.contains(&Some(**node));
        let new: Vec<u32> = changed.iter().filter(is_new).copied().collect();
        let kept = self.kept.len() + new.len().next_multiple_of(SIDES);
        // The factor is kept while changes are few, and the kept columns of Z, some of which no longer count, not too many.
        let [fewest, most] = MAX_CHANGES;
        let most = (nodes.len() / NODES_A_CHANGE).clamp(fewest, most);
        if changed.len() > most.min(nodes.len() / 2) || kept > 2 * most {
            self.factor_again(nodes, compliance);
            return;
        }
        let first = self.blocks.len();
        for new in new.chunks(SIDES) {
            self.add_columns(new, compliance);
        }
        self.factor.forward_groups(&mut self.blocks[first..]);
        (first..self.blocks.len()).for_each(|block| self.add_products(block));
        let place = |node: &u32| self.kept.iter().position(|kept| *kept == Some(*node));
        let mut changes: Vec<usize> = changed.iter().filter_map(place).collect();
        changes.sort_unstable();
        self.change(changes, compliance);
    }

    fn factor_again(&mut self, nodes: &[u32], compliance: &NearMatrix) {
        for &node in &self.nodes {
            self.row_of[node as usize] = NONE;
        }
        self.nodes.clear();
        self.nodes.extend_from_slice(nodes);
        // Rows of a panel are kept together, so that successive entries are next to each other in memory.
        self.nodes
            .sort_unstable_by_key(|&node| compliance.place(node));
        for (row, &node) in self.nodes.iter().enumerate() {
            self.row_of[node as usize] = row as u32;
        }
        let rows = self.nodes.iter().map(|&node| compliance.row(node));
        let rows: Vec<u32> = rows.collect();
        // The factor reads column after column of some rows; the matrix is symmetric, and these numbers are side by side.
        let entry = |row: usize, column: usize| compliance.at(rows[column], rows[row]);
        self.factor.factor(nodes.len(), entry);
        self.kept.clear();
        self.blocks.clear();
        self.products.clear();
        self.changes.clear();
        self.small.clear();
        self.is_forward_known = false;
    }

    /// Adds a block of W with the columns of up to eight nodes.
    fn add_columns(&mut self, new: &[u32], compliance: &NearMatrix) {
        let mut block = vec![zero(); self.factor.rows()];
        for (side, &node) in new.iter().enumerate() {
            let row = self.row_of[node as usize];
            if row == NONE {
                let column = compliance.row(node);
                for (numbers, &other) in block.iter_mut().zip(&self.nodes) {
                    set(numbers, side, compliance.at(compliance.row(other), column));
                }
            } else {
                set(&mut block[row as usize], side, 1.0);
            }
        }
        self.blocks.push(block);
        let sides = (0..SIDES).map(|side| new.get(side).copied());
        self.kept.extend(sides);
    }

    /// Adds the products of a block of Z with itself and the blocks before.
    fn add_products(&mut self, last: usize) {
        let first = self.products.len();
        for row in first..first + SIDES {
            self.products.push(vec![0.0; row + 1]);
        }
        for other in 0..=last {
            let mut sums = [zero(); SIDES];
            for (own, other) in self.blocks[last].iter().zip(&self.blocks[other]) {
                for (side, sum) in sums.iter_mut().enumerate() {
                    subtract(sum, own, -get(other, side));
                }
            }
            for (own, row) in self.products[first..].iter_mut().enumerate() {
                let columns = row.iter_mut().skip(SIDES * other);
                for (product, sum) in columns.zip(&sums) {
                    *product = get(sum, own);
                }
            }
        }
    }

    /// Factors the matrix of other changes to L D L', with D in place of the unit diagonal of L. The rows that it has in common
    /// with the matrix before stay.
    fn change(&mut self, changes: Vec<usize>, compliance: &NearMatrix) {
        // Consecutive trial sets differ in few changes: rows of L before the first difference stay valid.
        let pairs = self.changes.iter().zip(&changes);
        let same = pairs.take_while(|(before, now)| before == now).count();
        self.changes = changes;
        self.small.truncate(same);
        for i in same..self.changes.len() {
            // First of L D, then of L.
            let mut row: Vec<f64> = Vec::with_capacity(i + 1);
            for j in 0..i {
                let taken = product(&row, &self.small[j][..j]);
                row.push(self.of_changes(i, j, compliance) - taken);
            }
            let mut pivot = self.of_changes(i, i, compliance);
            for (j, number) in row.iter_mut().enumerate() {
                let scaled = *number / self.small[j][j];
                pivot -= *number * scaled;
                *number = scaled;
            }
            row.push(pivot);
            self.small.push(row);
        }
    }

    /// Returns an entry of the matrix of the changes, up to the diagonal.
    fn of_changes(&self, i: usize, j: usize, compliance: &NearMatrix) -> f64 {
        let (i, j) = (self.changes[i], self.changes[j]);
        let own = match (self.begun(i), self.begun(j)) {
            (Some(one), Some(other)) => compliance.at(compliance.row(one), compliance.row(other)),
            _ => 0.0,
        };
        own - self.products[i][j]
    }

    /// Returns the node of a kept column, if it has come into contact.
    fn begun(&self, kept: usize) -> Option<u32> {
        self.kept[kept].filter(|&node| self.row_of[node as usize] == NONE)
    }

    /// Computes the loads on the nodes in contact, in their order, from the overclosures of all surface nodes.
    ///
    /// The search for the contact set needs only loads; this path is several times faster than that with derivatives.
    pub fn loads(&mut self, nodes: &[u32], overclosures: &[Eight], loads: &mut Vec<f64>) {
        self.find_forward(overclosures);
        let changes = self.changes_of_loads(overclosures);
        self.side.clear();
        self.side
            .extend(self.forward.iter().map(|side| get(side, 0)));
        for (block, columns) in self.blocks.iter().enumerate() {
            let mut of_block = zero();
            for (&kept, &change) in self.changes.iter().zip(&changes) {
                if kept / SIDES == block {
                    set(&mut of_block, kept % SIDES, change);
                }
            }
            for (sum, columns) in self.side.iter_mut().zip(columns) {
                let [a, b] = [0, 1].map(|half| columns[half] * of_block[half]);
                *sum -= (a + b).sum();
            }
        }
        self.factor.backward_one(&mut self.side);
        loads.clear();
        for &node in nodes {
            let row = self.row_of[node as usize];
            loads.push(if row == NONE {
                self.place_of(node).map_or(0.0, |place| changes[place])
            } else {
                self.side[row as usize]
            });
        }
    }

    fn changes_of_loads(&self, overclosures: &[Eight]) -> Vec<f64> {
        let mut products = Vec::with_capacity(self.kept.len());
        for block in &self.blocks {
            let mut sum = zero();
            for (y, columns) in self.forward.iter().zip(block) {
                subtract(&mut sum, columns, -get(y, 0));
            }
            products.extend((0..SIDES).map(|side| get(&sum, side)));
        }
        let mut x: Vec<f64> = Vec::with_capacity(self.changes.len());
        for (&kept, row) in self.changes.iter().zip(&self.small) {
            let begun = self.begun(kept);
            let own = begun.map_or(0.0, |node| get(&overclosures[node as usize], 0));
            let known: f64 = x
                .iter()
                .zip(row)
                .map(|(known, factor)| known * factor)
                .sum();
            x.push(own - products[kept] - known);
        }
        for i in (0..x.len()).rev() {
            let row = &self.small[i];
            let after: f64 = (i + 1..x.len()).map(|j| x[j] * self.small[j][i]).sum();
            x[i] = x[i] / row[i] - after;
        }
        x
    }

    fn place_of(&self, node: u32) -> Option<usize> {
        self.changes
            .iter()
            .position(|&kept| self.kept[kept] == Some(node))
    }

    /// Computes the same with the derivatives by six motions.
    pub fn loads_by_motion(
        &mut self,
        nodes: &[u32],
        overclosures: &[Eight],
        loads: &mut Vec<Eight>,
    ) {
        self.find_forward(overclosures);
        let changes = self.changes_by_motion(overclosures);
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
            loads.push(if row == NONE {
                self.place_of(node).map_or(zero(), |place| changes[place])
            } else {
                self.sides[row as usize]
            });
        }
    }

    /// Computes y, unless it is known. The overclosures of nodes that have left the contact do not matter.
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

    fn changes_by_motion(&self, overclosures: &[Eight]) -> Vec<Eight> {
        let mut x: Vec<Eight> = Vec::with_capacity(self.changes.len());
        for (&kept, row) in self.changes.iter().zip(&self.small) {
            let begun = self.begun(kept);
            let mut sum = begun.map_or(zero(), |node| overclosures[node as usize]);
            for (y, column) in self.forward.iter().zip(&self.blocks[kept / SIDES]) {
                subtract(&mut sum, y, get(column, kept % SIDES));
            }
            for (known, &factor) in x.iter().zip(row) {
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
