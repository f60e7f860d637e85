//! The part of a node's share that is in contact, and the peak pressure, both from the pressures at the nodes.
//!
//! For smooth bodies the square of the pressure is smooth up to the edge of contact (in Hertz's contact a quadratic),
//! and the pressure itself is not. So both are found from the square.

use crate::{
    Vec3,
    contact::{
        contact_patch::{MIN_NODES, Quadratic, highest_mpa},
        law::Bodies,
        model::TouchedNode,
    },
    geometry::{ArticulatingSurface, FacesAround},
};

/// The reach of the contact beyond a node, in steps between nodes: [`STEPS_BY_RATIO`] times the ratio of its pressure
/// to that of the next node inside, less [`STEPS_LESS`]. The values are fitted: the contact radius of a ball has an
/// error of at most 3 % on hexahedra of half that radius, and 1 % on hexahedra of a fifth of it.
const STEPS_BY_RATIO: f64 = 2.3;
const STEPS_LESS: f64 = 0.77;

/// The nodes in contact around a node determine no slope across their line if the determinant of their directions is at most
/// this part of the square of the trace. Rounding leaves 1e-16 of it; lines that bend by a degree have 1e-4.
const IN_LINE: f64 = 1e-9;

/// A fit is rejected if it misses the square of the pressure at its node by more than this part.
const MAX_MISSED: f64 = 0.1;

pub(crate) struct NodePressures<'a> {
    surface: &'a ArticulatingSurface,
    faces: &'a FacesAround,
    /// Square of the pressure at every node, MPa2; 0 if it is not in contact.
    pressure2: Vec<f64>,
}

impl<'a> NodePressures<'a> {
    pub fn new(bodies: Bodies<'a>, touched: &[TouchedNode]) -> Self {
        let surface = bodies.surface;
        let mut pressure2 = vec![0.0; surface.positions.len()];
        for node in touched {
            pressure2[node.node as usize] = node.pressure_mpa * node.pressure_mpa;
        }
        Self {
            surface,
            faces: bodies.insert.faces_around(),
            pressure2,
        }
    }

    /// Returns the part of a node's share that is in contact; more than 1 if the contact reaches past the share.
    ///
    /// Under smooth bodies p = c sqrt(s) at a distance s from the edge of contact. So the ratio of a node's pressure to that
    /// of the next node inside determines the distance of the edge beyond the node. The share begins half a step before the
    /// node.
    pub fn part(&self, node: u32) -> f64 {
        let outside = || {
            // The nodes along the edges of the faces around, some of them twice.
            let faces = self.faces.of(node as usize).iter();
            let next = faces.flat_map(|&[next, _, before]| [next, before]);
            next.filter(|&other| self.pressure2[other as usize] == 0.0)
        };
        // For most nodes, all nodes around them are in contact, too.
        let at_edge = outside().next().and_then(|_| self.slope(node));
        let Some(slope) = at_edge else {
            return 1.0;
        };
        // Of the neighbours outside, the one down the slope is nearest to the edge; the pressure falls to it as fast as it
        // rises to the next node inside.
        let own = self.pressure2[node as usize];
        let at = |node: u32| self.surface.positions[node as usize];
        let fall = outside().map(|other| -slope.dot(&(at(other) - at(node))));
        fall.reduce(f64::max).map_or(1.0, |fall| {
            let ratio = (own / (own + fall.max(0.0))).sqrt();
            // The share begins half a step before the node; no contact counts farther than a step beyond it.
            (0.5 + STEPS_BY_RATIO * ratio - STEPS_LESS).clamp(self.least_part(node), 1.5)
        })
    }

    /// Returns the least part of a node's share in contact: with it, the pressure there is the highest around the node.
    fn least_part(&self, node: u32) -> f64 {
        let own = self.pressure2[node as usize];
        let around = self.faces.of(node as usize).iter().flatten();
        let highest = around
            .map(|&other| self.pressure2[other as usize])
            .fold(own, f64::max);
        // The square of a pressure near 0 can be 0.
        (own / highest.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Returns the slope of the square of the pressure at a node, a least-squares fit to the nodes in contact around it; none
    /// where these do not determine it.
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
                // With this weight all difference quotients count equally, however far the neighbour is.
                let weight = 1.0 / flat.norm_squared();
                matrix += flat * flat.transpose() * weight;
                right += flat * ((other_own - own) * weight);
            }
        }
        // For nodes in one line the matrix is singular, and rounding would decide between no slope and any.
        if matrix.determinant() <= IN_LINE * matrix.trace().powi(2) {
            return None;
        }
        let slope = matrix.cholesky()?.solve(&right);
        Some(along[0] * slope.x + along[1] * slope.y)
    }

    /// Returns the highest pressure at or around the nodes in contact, MPa; any region may have it.
    ///
    /// A quadratic is fitted to the square of the pressure over the node with the highest pressure and those around it, if all
    /// of these are in contact; at the edge of a worn scar, where they are not, nothing smooth can be fitted. The peak is not
    /// below the highest mean over a share, and equal to that if the fit is rejected.
    pub fn highest_mpa(&self, touched: &[TouchedNode]) -> f64 {
        highest_mpa(touched, |node, _| {
            let patch = self.faces.patch(node, MIN_NODES);
            let pressure2 = |node: &u32| self.pressure2[*node as usize];
            let own = pressure2(&node);
            if own == 0.0 || patch.iter().any(|node| pressure2(node) == 0.0) {
                return 0.0;
            }
            let share = |node: u32| &self.surface.shares[node as usize];
            let means = patch.iter().map(|node| (share(*node), pressure2(node)));
            let fit = Quadratic::fit(share(node), means);
            let follows = |fit: &Quadratic| (fit.mean() - own).abs() <= MAX_MISSED * own;
            fit.filter(follows)
                .map_or(0.0, |fit| fit.highest().max(0.0).sqrt())
        })
    }
}
