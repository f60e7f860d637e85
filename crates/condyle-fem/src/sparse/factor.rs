//! Multifrontal Cholesky factorisation.
//!
//! Every group of nodes has a dense front: the stiffness of its elements and what its children left is
//! summed there, its own freedoms are eliminated, and the rest goes to the group above (Duff and Reid 1983;
//! Liu 1992). One thread, one order: the same numbers on every run.

use wide::f64x4;

use crate::{
    element::NodalStiffness,
    sparse::{
        dissection::{Dissection, Group},
        front::{Front, Layout},
        tiles::Triangle,
    },
};

/// A pivot below this part of the stiffness that its freedom began with is none: rounding leaves some
/// 1e-15 of it where a rigid motion is free, and the most slender solids above 1e-9.
const MIN_PIVOT: f64 = 1e-11;

/// The factor of a stiffness.
pub(crate) struct Factor {
    pub(crate) dissection: Dissection,
    pub(crate) fronts: Vec<Front>,
}

/// A node that can move without force.
pub(crate) struct Loose {
    pub(crate) node: u32,
}

/// What a group leaves to the one above.
struct Remainder {
    triangle: Triangle,
    /// Rows before those of the boundary.
    columns: usize,
}

/// What is needed on the way.
struct Assembly<'a, S> {
    hexes: &'a [[u32; 8]],
    held: &'a [[bool; 3]],
    stiffness: S,
    dissection: &'a Dissection,
    /// First row in the front of the group that is being assembled, by place.
    rows: Vec<usize>,
    /// Stiffness of every freedom as it was assembled.
    diagonal: Vec<f64>,
    /// Memory of fronts that are done with.
    spare: Vec<Vec<f64x4>>,
}

impl Factor {
    /// Of the sum of the stiffnesses of all elements.
    ///
    /// `held`: directions in which each node cannot move; where it is not held in all, they become freedoms
    /// that nothing touches.
    pub(crate) fn new(
        hexes: &[[u32; 8]],
        held: &[[bool; 3]],
        dissection: Dissection,
        stiffness: impl FnMut(usize) -> NodalStiffness,
    ) -> Result<Self, Loose> {
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
        let mut left: Vec<Option<Remainder>> = Vec::new();
        let mut fronts = Vec::new();
        for group in &dissection.groups {
            let layout = Layout::new(group.own.len(), group.boundary.len());
            let mut triangle = assembly.front(group, &layout, &mut left);
            let least = assembly.least_pivots(group, &layout);
            if let Err(bad) = triangle.eliminate(layout.columns, &least) {
                let place = group.own.start as usize + bad.column / 3;
                let node = dissection.order[place];
                return Err(Loose { node });
            }
            fronts.push(Front::of(&triangle, layout.columns, layout.rows));
            left.push(Some(Remainder {
                triangle,
                columns: layout.columns,
            }));
        }
        Ok(Self { dissection, fronts })
    }

    /// How many freedoms there are.
    pub(crate) fn freedoms(&self) -> usize {
        3 * self.dissection.order.len()
    }

    /// How many numbers the factor holds.
    pub(crate) fn len(&self) -> usize {
        self.fronts.iter().map(Front::len).sum()
    }
}

impl<S: FnMut(usize) -> NodalStiffness> Assembly<'_, S> {
    /// The front of a group before its elimination.
    fn front(
        &mut self,
        group: &Group,
        layout: &Layout,
        left: &mut [Option<Remainder>],
    ) -> Triangle {
        let memory = self.spare.pop().unwrap_or_default();
        let mut triangle = Triangle::zeros(layout.rows, memory);
        for (i, place) in group.own.clone().enumerate() {
            self.rows[place as usize] = 3 * i;
        }
        for (i, &place) in group.boundary.iter().enumerate() {
            self.rows[place as usize] = layout.columns + 3 * i;
        }
        for row in self.untouched(group, layout) {
            *triangle.at_mut(row, row) = 1.0;
        }
        for &element in &group.elements {
            self.add_element(element as usize, &mut triangle);
        }
        for &child in &group.children {
            if let Some(remainder) = left[child].take() {
                let boundary = &self.dissection.groups[child].boundary;
                self.add_remainder(&remainder, boundary, &mut triangle);
                self.spare.push(remainder.triangle.into_memory());
            }
        }
        triangle
    }

    /// Rows of own freedoms that nothing touches: held ones, and those that fill a tile up.
    fn untouched(&self, group: &Group, layout: &Layout) -> Vec<usize> {
        let nodes = group.own.clone().map(|p| self.dissection.order[p as usize]);
        let held = nodes.flat_map(|node| self.held[node as usize]).enumerate();
        let held = held.filter(|(_, is_held)| *is_held).map(|(row, _)| row);
        held.chain(3 * group.own.len()..layout.columns).collect()
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
            for i in (0..3).filter(|&i| !self.held[node as usize][i]) {
                freedoms.push((self.rows[place] + i, 3 * corner + i));
                self.diagonal[3 * place + i] += stiffness[(3 * corner + i, 3 * corner + i)];
            }
        }
        for &(row, i) in &freedoms {
            for &(column, j) in freedoms.iter().filter(|(column, _)| *column <= row) {
                *triangle.at_mut(row, column) += stiffness[(i, j)];
            }
        }
    }

    /// Adds what a child left on its boundary.
    fn add_remainder(&self, remainder: &Remainder, boundary: &[u32], triangle: &mut Triangle) {
        let freedoms = boundary.iter().flat_map(|&place| {
            let row = self.rows[place as usize];
            [row, row + 1, row + 2]
        });
        let rows: Vec<usize> = freedoms.collect();
        for (i, &row) in rows.iter().enumerate() {
            let from = remainder.columns + i;
            for (j, &column) in rows[..=i].iter().enumerate() {
                *triangle.at_mut(row, column) += remainder.triangle.at(from, remainder.columns + j);
            }
        }
    }

    fn least_pivots(&self, group: &Group, layout: &Layout) -> Vec<f64> {
        let freedoms = 3 * group.own.start as usize..3 * group.own.end as usize;
        let own = self.diagonal[freedoms].iter();
        let mut least: Vec<f64> = own.map(|stiffness| MIN_PIVOT * stiffness).collect();
        least.resize(layout.columns, 0.0);
        least
    }
}
