//! The part of a node's share that is in contact, and the peak pressure, both from the pressures at the nodes.

use std::collections::BTreeMap;

use crate::{
    Vec3,
    contact::{
        contact_patch::{MIN_NODES, Quadratic, highest_mpa},
        model::TouchedNode,
    },
    geometry::{ArticulatingSurface, FacesAround, Share},
};

/// The reach of the contact beyond a node, in steps between nodes, by the ratio of its pressure to that of the
/// next node inside, and what is taken off. With these the radius of a ball's contact errs by 3 % at most on hexahedra
/// of half of that radius, and by 1 % on those of a fifth.
const STEPS_BY_RATIO: f64 = 2.3;
const STEPS_LESS: f64 = 0.77;

/// The nodes that press, and the surface around them.
pub(crate) struct EdgeOfContact<'a> {
    pub surface: &'a ArticulatingSurface,
    pub faces: &'a FacesAround,
    /// Square of the pressure at every node, MPa2; 0 where it does not press.
    pub pressure2: &'a [f64],
}

/// Squares of the pressures at nodes, MPa2.
pub(crate) fn squares(touched: &[TouchedNode]) -> BTreeMap<u32, f64> {
    let square = |node: &TouchedNode| (node.node, node.pressure_mpa * node.pressure_mpa);
    touched.iter().map(square).collect()
}

/// The same at every node of a surface, 0 where it does not press.
pub(crate) fn squares_everywhere(node_count: usize, touched: &[TouchedNode]) -> Vec<f64> {
    let mut pressure2 = vec![0.0; node_count];
    for node in touched {
        pressure2[node.node as usize] = node.pressure_mpa * node.pressure_mpa;
    }
    pressure2
}

impl EdgeOfContact<'_> {
    /// Part of a pressing node's share that presses; more than all of it where the contact reaches past.
    ///
    /// Smooth bodies press with p = c sqrt(s) at a distance s from the edge of contact. So the ratio of a node's
    /// pressure to that of the next one inside tells how far beyond the node the edge is: nearly [`STEPS_BY_RATIO`]
    /// times the ratio, less [`STEPS_LESS`], in steps between nodes. The node stands for half a step more than that.
    pub fn part(&self, node: u32) -> f64 {
        let outside = || {
            let beside = self.beside(node);
            beside.filter(|&other| self.pressure2[other as usize] == 0.0)
        };
        // Most nodes press with all around them.
        let at_edge = outside().next().and_then(|_| self.slope(node));
        let Some(slope) = at_edge else {
            return 1.0;
        };
        let own = self.pressure2[node as usize];
        let at = |node: u32| self.surface.positions[node as usize];
        let fall = outside().map(|other| -slope.dot(&(at(other) - at(node))));
        fall.reduce(f64::max).map_or(1.0, |fall| {
            let ratio = (own / (own + fall.max(0.0))).sqrt();
            (0.5 + STEPS_BY_RATIO * ratio - STEPS_LESS).clamp(0.0, 1.5)
        })
    }

    /// Nodes along the edges from a node; some twice.
    fn beside(&self, node: u32) -> impl Iterator<Item = u32> {
        let faces = self.faces.of(node as usize).iter();
        faces.flat_map(|&[next, _, before]| [next, before])
    }

    /// Slope of the square of the pressure at a node, the least-squares fit to those that press around it;
    /// none where they do not tell it.
    fn slope(&self, node: u32) -> Option<Vec3> {
        let at = node as usize;
        let (own, place) = (self.pressure2[at], self.surface.positions[at]);
        let along = self.surface.directions(node as usize);
        let (mut matrix, mut right) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
        for other in self.faces.of(node as usize).iter().flatten() {
            let other_own = self.pressure2[*other as usize];
            if other_own > 0.0 {
                let way = self.surface.positions[*other as usize] - place;
                let flat = nalgebra::Vector2::new(along[0].dot(&way), along[1].dot(&way));
                let weight = 1.0 / flat.norm_squared();
                matrix += flat * flat.transpose() * weight;
                right += flat * ((other_own - own) * weight);
            }
        }
        let slope = matrix.cholesky()?.solve(&right);
        Some(along[0] * slope.x + along[1] * slope.y)
    }
}

/// A quadratic that misses the square of the pressure under the top by more than this part does not follow it.
const MAX_MISSED: f64 = 0.1;

/// Looks for the highest pressure.
///
/// Under smooth bodies the square of the pressure is smooth up to the edge of contact (in Hertz's contact a
/// quadratic), so it is this that is fitted, over the node that presses most and those around it, if all of them
/// press; at the edge of a worn scar, where they do not, there is nothing smooth to fit. The peak is not below the
/// highest mean over a share, and is that where the fit does not follow.
pub(crate) struct PeakSearch<'a> {
    pub shares: &'a [Share],
    pub faces: &'a FacesAround,
    /// Square of the pressure at every node that presses, MPa2.
    pub pressure2: &'a BTreeMap<u32, f64>,
}

impl PeakSearch<'_> {
    /// Highest pressure at or around the nodes that touch, MPa; any region may have it.
    pub fn highest_mpa(&self, touched: &[TouchedNode]) -> f64 {
        highest_mpa(touched, |node, _| self.highest_around(node))
    }

    /// Highest pressure within the share of a node, MPa.
    fn highest_around(&self, node: u32) -> f64 {
        let patch = self.faces.patch(node, MIN_NODES);
        let Some(own) = self.pressure2.get(&node) else {
            return 0.0;
        };
        if !patch.iter().all(|node| self.pressure2.contains_key(node)) {
            return 0.0;
        }
        let pressing = |node: &u32| (&self.shares[*node as usize], self.pressure2[node]);
        let fit = Quadratic::fit(&self.shares[node as usize], patch.iter().map(pressing));
        let follows = |fit: &Quadratic| (fit.mean() - own).abs() <= MAX_MISSED * own;
        fit.filter(follows)
            .map_or(0.0, |fit| fit.highest().max(0.0).sqrt())
    }
}
