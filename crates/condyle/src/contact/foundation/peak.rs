//! The highest pressure, which lies between the nodes.

use crate::{
    contact::{
        model::TouchedNode,
        pressed::{Quadratic, highest_of_regions},
        pressure_law::PressureLaw,
    },
    geometry::{FacesAround, FemoralSurface, MOST_GAP_SLOPE, Share},
    number::{F64x4, LANES, Number, vector::vector_from_lanes},
    spatial::Pose4,
};

/// Nodes whose pressures differ by no more than this part press equally: which of them leads is a
/// matter of round-off, and of which way round the knee is told.
const EQUAL: f64 = 1e-9;

/// Around any node inside a surface there are as many, and they determine a quadratic; at its rim
/// there are fewer, and farther ones must help.
const LEAST_NODES: usize = 7;

/// A quadratic that misses the mean under the top by more than this part of the highest mean follows something
/// that is none, such as a step of the thickness at the rim; what it says between the nodes is made up.
const MOST_MISSED: f64 = 0.3;

/// Looks for the highest pressure.
///
/// The law's measure of overclosure (see [`PressureLaw::measure`]) is smooth where the pressure is
/// not: at the edge of contact and at the corners of a table. So it is this that is fitted, with a
/// quadratic over the node that presses most and those around it, whether they touch or not, and
/// the peak is the law's pressure at its maximum within the share. It is never below the highest
/// mean over a share, and is that where the quadratic does not follow the
/// measure.
///
/// Its error falls with the third power of the edge, under a body that is smooth and symmetric about the
/// peak with the fourth.
pub(super) struct PeakSearch<'a> {
    pub law: &'a PressureLaw,
    pub femur: &'a FemoralSurface,
    pub shares: &'a [Share],
    pub thickness_mm: &'a [f64],
    pub faces: &'a FacesAround,
    pub pose: Pose4,
}

/// The overclosure of a share whether it touches or not.
struct PatchNode {
    node: u32,
    gap_mm: f64,
    /// In the law's measure.
    mean: f64,
}

impl PeakSearch<'_> {
    /// Highest pressure at or around the nodes that touch, MPa; any region may have it.
    pub fn highest_mpa(&self, touched: &[TouchedNode]) -> f64 {
        let highest = highest_of_regions(touched);
        let leads = highest.map(|highest| highest * (1.0 - EQUAL));
        let leads = |node: &&TouchedNode| node.pressure_mpa >= leads[usize::from(node.region)];
        let tops = touched.iter().filter(leads);
        tops.map(|top| self.highest_around(top.node))
            .fold(highest.into_iter().fold(0.0, f64::max), f64::max)
    }

    /// Highest pressure within the share of a node, MPa.
    fn highest_around(&self, node: u32) -> f64 {
        let patch = self.sampled(&self.faces.patch(node, LEAST_NODES));
        let share = |at: &PatchNode| &self.shares[at.node as usize];
        let top = &patch[0];
        let is_surface = |at: &&PatchNode| {
            let distance2_mm2 = (share(at).centre - share(top).centre).norm_squared();
            // What changes faster from point to point than a gap can has no surface behind it.
            let change = (at.gap_mm - top.gap_mm) / MOST_GAP_SLOPE;
            change * change <= distance2_mm2
        };
        let means = patch.iter().filter(is_surface);
        let highest = means.clone().map(|at| at.mean).fold(top.mean, f64::max);
        let fit = Quadratic::fit(share(top), means.map(|at| (share(at), at.mean)));
        let follows =
            |fit: &Quadratic| (fit.mean() - top.mean).abs() <= MOST_MISSED * highest.abs();
        fit.filter(follows)
            .map_or(0.0, |fit| self.law.pressure(fit.highest().max(0.0), 1.0).0)
    }

    fn sampled(&self, nodes: &[u32]) -> Vec<PatchNode> {
        let mut patch = Vec::with_capacity(nodes.len() + LANES);
        for nodes in nodes.chunks(LANES) {
            let gaps_mm = self.gaps_mm(nodes);
            let at = |(lane, &node): (usize, &u32)| {
                let gap_mm = gaps_mm.lane(lane);
                let per_thickness = 1.0 / self.thickness_mm[node as usize];
                PatchNode {
                    node,
                    gap_mm,
                    mean: self.law.measure(-gap_mm, per_thickness),
                }
            };
            patch.extend(nodes.iter().enumerate().map(at));
        }
        patch
    }

    /// Mean gaps over the shares of up to four nodes, mm.
    fn gaps_mm(&self, nodes: &[u32]) -> F64x4 {
        let share = |lane: usize| &self.shares[nodes[lane.min(nodes.len() - 1)] as usize];
        let centres = vector_from_lanes(|lane| &share(lane).centre);
        let place = self.pose.to_femur(&centres);
        let spread_mm2 = F64x4::from_lanes(|lane| share(lane).spread_mm2);
        self.femur.sample(&place, spread_mm2).gap_mm
    }
}
