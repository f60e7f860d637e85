//! The highest pressure, which lies between the nodes.

use std::collections::BTreeMap;

use crate::{
    contact::{
        model::TouchedNode,
        pressed::{MIN_NODES, Quadratic, highest_mpa},
    },
    geometry::{FacesAround, Share},
};

/// A quadratic that misses the square of the pressure under the top by more than this part does not follow it.
const MAX_MISSED: f64 = 0.1;

/// Looks for the highest pressure.
///
/// Under smooth bodies the square of the pressure is smooth up to the edge of contact (in Hertz's contact a
/// quadratic), so it is this that is fitted, over the node that presses most and those around it, if all of them
/// press; at the edge of a worn scar, where they do not, there is nothing smooth to fit. The peak is not below the
/// highest mean over a share, and is that where the fit does not follow.
pub(super) struct PeakSearch<'a> {
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
