//! The factor of the compliance of nodes that press, kept while few of them change.

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, product, set, subtract, zero},
    compliance::NearMatrix,
};
use crate::number::{F64x4, Number};

/// The number of changes side by side.
const SIDES: usize = ROWS;
/// With more changes than one to so many nodes the matrix is factored again: that takes n^3/6 products, each change
/// n^2/2 and more.
const NODES_A_CHANGE: usize = 4;
/// Fewest and most changes up to which it is not.
const MAX_CHANGES: [usize; 2] = [32, 320];
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
pub(crate) struct ChangedFactor {
    /// B, and the row of every surface node in it.
    nodes: Vec<u32>,
    row_of: Vec<u32>,
    factor: Cholesky,
    /// Nodes of which there are columns of Z, none twice, each eight of which share a block of Z.
    kept: Vec<Option<u32>>,
    blocks: Vec<Vec<Eight>>,
    /// Z' Z of the kept columns, up to the diagonal.
    products: Vec<Vec<f64>>,
    /// The kept columns that count now, and the rows of the factor of their matrix.
    changes: Vec<usize>,
    small: Vec<Vec<f64>>,
    /// y, if it is that of the present overclosures.
    forward: Vec<Eight>,
    is_forward_known: bool,
    is_pressing: Vec<bool>,
    sides: Vec<Eight>,
    side: Vec<f64>,
}

impl ChangedFactor {
    /// No node presses, of a surface with so many.
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
            is_pressing: vec![false; node_count],
            sides: Vec::new(),
            side: Vec::new(),
        }
    }

    /// The next loads are from other overclosures.
    pub fn take_other_overclosures(&mut self) {
        self.is_forward_known = false;
    }

    /// Lets nodes press, and no others.
    pub fn press(&mut self, nodes: &[u32], compliance: &NearMatrix) {
        let changed = self.changed(nodes);
        let is_new = |node: &&u32| !self.kept.contains(&Some(**node));
        let new: Vec<u32> = changed.iter().filter(is_new).copied().collect();
        let kept = self.kept.len() + new.len().next_multiple_of(SIDES);
        let [fewest, most] = MAX_CHANGES;
        let most = (nodes.len() / NODES_A_CHANGE).clamp(fewest, most);
        if changed.len() > most.min(nodes.len() / 2) || kept > 2 * most {
            self.factor_anew(nodes, compliance);
            return;
        }
        for new in new.chunks(SIDES) {
            self.keep(new, compliance);
        }
        let place = |node: &u32| self.kept.iter().position(|kept| *kept == Some(*node));
        let mut changes: Vec<usize> = changed.iter().filter_map(place).collect();
        changes.sort_unstable();
        self.change(changes, compliance);
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

    fn factor_anew(&mut self, nodes: &[u32], compliance: &NearMatrix) {
        self.nodes
            .iter()
            .for_each(|&node| self.row_of[node as usize] = NONE);
        self.nodes.clear();
        self.nodes.extend_from_slice(nodes);
        // Rows of a panel together: an entry is next to the one before.
        self.nodes
            .sort_unstable_by_key(|&node| compliance.place(node));
        for (row, &node) in self.nodes.iter().enumerate() {
            self.row_of[node as usize] = row as u32;
        }
        let rows = self.nodes.iter().map(|&node| compliance.row(node));
        let rows: Vec<u32> = rows.collect();
        // Column after column of some rows is asked for, and these numbers lie side by side.
        let entry = |row: usize, column: usize| compliance.at(rows[column], rows[row]);
        self.factor.factor(nodes.len(), entry);
        self.kept.clear();
        self.blocks.clear();
        self.products.clear();
        self.changes.clear();
        self.small.clear();
        self.is_forward_known = false;
    }

    /// Keeps the columns of Z of up to eight nodes.
    fn keep(&mut self, new: &[u32], compliance: &NearMatrix) {
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
        self.factor.forward(&mut block);
        self.blocks.push(block);
        let sides = (0..SIDES).map(|side| new.get(side).copied());
        self.kept.extend(sides);
        self.add_products();
    }

    /// Adds the products of the last block with all blocks.
    fn add_products(&mut self) {
        let last = self.blocks.len() - 1;
        let first = self.products.len();
        for row in first..self.kept.len() {
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

    /// Factors the matrix of other changes, L D L', the diagonal of L left to D. What it has in common with that of
    /// the changes before stays.
    fn change(&mut self, changes: Vec<usize>, compliance: &NearMatrix) {
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

    /// An entry of the matrix of the changes, up to the diagonal.
    fn of_changes(&self, i: usize, j: usize, compliance: &NearMatrix) -> f64 {
        let (i, j) = (self.changes[i], self.changes[j]);
        let own = match (self.begun(i), self.begun(j)) {
            (Some(one), Some(other)) => compliance.at(compliance.row(one), compliance.row(other)),
            _ => 0.0,
        };
        own - self.products[i][j]
    }

    /// The node of a kept column, if it has begun to press.
    fn begun(&self, kept: usize) -> Option<u32> {
        self.kept[kept].filter(|&node| self.row_of[node as usize] == NONE)
    }

    /// The loads on the nodes that press, in their order, from the overclosures of all surface nodes.
    pub fn loads(&mut self, nodes: &[u32], overclosures: &[Eight], loads: &mut Vec<f64>) {
        self.find_forward(overclosures);
        let changes = self.changes_of_loads(overclosures);
        self.side.clear();
        self.side
            .extend(self.forward.iter().map(|side| get(side, 0)));
        for (block, columns) in self.blocks.iter().enumerate() {
            let of_block = self.of_block(block, &changes);
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

    /// The changes x of the loads.
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

    /// The changes of the columns of a block, those that do not count none.
    fn of_block(&self, block: usize, changes: &[f64]) -> Eight {
        let mut numbers = zero();
        for (&kept, &change) in self.changes.iter().zip(changes) {
            if kept / SIDES == block {
                set(&mut numbers, kept % SIDES, change);
            }
        }
        numbers
    }

    /// Returns the place of a node among the changes.
    fn place_of(&self, node: u32) -> Option<usize> {
        self.changes
            .iter()
            .position(|&kept| self.kept[kept] == Some(node))
    }

    /// The same with the derivatives by six motions.
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

    /// The changes x, with their derivatives.
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
