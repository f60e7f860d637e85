//! The highest pressure of a foundation, which lies between the nodes.

use crate::{
    contact::{
        contact_patch::{MIN_NODES, Quadratic, highest_mpa},
        law::Bodies,
        model::TouchedNode,
        pressure_law::PressureLaw,
    },
    geometry::{FacesAround, MAX_GAP_SLOPE, Share},
    number::{F64x4, LANES, Number, vector_from_lanes},
    spatial::Pose4,
};

/// A fit is rejected if it misses the mean under the top by more than this part of the highest mean: it then follows a step,
/// such as that of the thickness at the rim, and its values between the nodes are meaningless.
const MAX_MISSED: f64 = 0.3;

/// A fit over the edge of contact is replaced if it misses a mean around the top by more than this part of its rise
/// there: it then curves differently from the surface.
const MISSED_OF_RISE: f64 = 0.1;

/// Smallest number of nodes at an edge, where the nodes on one side must determine a quadratic.
const NODES_ONE_SIDED: usize = 2 * MIN_NODES;

/// The search for the highest pressure.
///
/// The law's measure of overclosure (see [`PressureLaw::measure`]) is smooth where the pressure is not: at the edge of
/// contact and at the corners of a table. So a quadratic is fitted to the measure, over the node with the highest pressure
/// and those around it, in contact or not; the peak is the law's pressure at its maximum within the share. It is never
/// below the highest mean over a share, and equal to that if the fit is rejected.
///
/// Its error falls with the third power of the edge length, under a body that is smooth and symmetric about the peak with
/// the fourth.
pub(crate) struct PeakSearch<'a> {
    pub law: &'a PressureLaw,
    pub bodies: Bodies<'a>,
    pub pose: Pose4,
}

/// The overclosure of a share, in contact or not.
struct PatchNode {
    node: u32,
    gap_mm: f64,
    mean: f64,
}

impl PeakSearch<'_> {
    fn faces(&self) -> &FacesAround {
        self.bodies.insert.faces_around()
    }

    pub fn highest_mpa(&self, touched: &[TouchedNode]) -> f64 {
        let pressure_mpa = |measure: f64| self.law.pressure(measure.max(0.0), 1.0).0;
        highest_mpa(touched, |node, so_far_mpa| {
            let patch = self.sampled(&self.faces().patch(node, MIN_NODES));
            let Some(fit) = self.fit(&patch) else {
                return 0.0;
            };
            let highest_mpa = pressure_mpa(fit.highest());
            // The limited maximum is never higher, so that its costly second fit can be skipped.
            if highest_mpa <= so_far_mpa {
                0.0
            } else if patch.iter().all(|at| at.mean > 0.0) {
                highest_mpa
            } else {
                pressure_mpa(self.limited(&fit, patch))
            }
        })
    }

    /// Returns the maximum of a quadratic over a patch that contains the edge of contact; never more than that of the fit.
    ///
    /// At an edge of the counterface the surface falls away, which bends the fit more than the surface inside is bent. The fit then
    /// misses nodes in contact farther inside, and is replaced by one over these alone.
    fn limited(&self, fit: &Quadratic, patch: Vec<PatchNode>) -> f64 {
        let top = patch[0].node;
        // A larger patch begins with the smaller one.
        let farther = self
            .faces()
            .patch(top, NODES_ONE_SIDED)
            .split_off(patch.len());
        let mut in_contact = patch;
        in_contact.extend(self.sampled(&farther));
        in_contact.retain(|at| at.node == top || at.mean > 0.0);
        let missed = fit.worst_miss(
            &self.bodies.surface.shares[top as usize],
            self.means(&in_contact),
        );
        let (highest, mean) = (fit.highest(), in_contact[0].mean);
        if missed <= MISSED_OF_RISE * (highest - mean) {
            return highest;
        }
        let of_contact = self.fit(&in_contact).map_or(mean, |fit| fit.highest());
        highest.min(of_contact.max(mean))
    }

    /// Fits a quadratic over a patch; none if it misses the mean of the first node.
    fn fit(&self, patch: &[PatchNode]) -> Option<Quadratic> {
        let top = &patch[0];
        let means = self.means(patch);
        let highest = means.clone().map(|(_, mean)| mean).fold(top.mean, f64::max);
        let fit = Quadratic::fit(&self.bodies.surface.shares[top.node as usize], means);
        let follows = |fit: &Quadratic| (fit.mean() - top.mean).abs() <= MAX_MISSED * highest.abs();
        fit.filter(follows)
    }

    /// Returns shares and means of the nodes of a patch that are on one surface with the first.
    fn means<'a>(
        &'a self,
        patch: &'a [PatchNode],
    ) -> impl Iterator<Item = (&'a Share, f64)> + Clone {
        let share = |at: &PatchNode| &self.bodies.surface.shares[at.node as usize];
        let top = &patch[0];
        let is_surface = move |at: &&PatchNode| {
            let distance2_mm2 = (share(at).centre - share(top).centre).norm_squared();
            // No gap changes faster along a surface: such a node lies under another part of the counterface, or under none.
            let change = (at.gap_mm - top.gap_mm) / MAX_GAP_SLOPE;
            change * change <= distance2_mm2
        };
        let on_surface = patch.iter().filter(is_surface);
        on_surface.map(move |at| (share(at), at.mean))
    }

    fn sampled(&self, nodes: &[u32]) -> Vec<PatchNode> {
        let mut patch = Vec::with_capacity(nodes.len() + LANES);
        for nodes in nodes.chunks(LANES) {
            let gaps_mm = self.gaps_mm(nodes);
            let at = |(lane, &node): (usize, &u32)| {
                let gap_mm = gaps_mm.lane(lane);
                let per_thickness = 1.0 / self.bodies.insert.thickness_mm()[node as usize];
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

    /// Samples the mean gaps over the shares of up to four nodes, mm.
    fn gaps_mm(&self, nodes: &[u32]) -> F64x4 {
        let share =
            |lane: usize| &self.bodies.surface.shares[nodes[lane.min(nodes.len() - 1)] as usize];
        let centres = vector_from_lanes(|lane| &share(lane).centre);
        let place = self.pose.to_counterface(&centres);
        let spread_mm2 = F64x4::from_lanes(|lane| share(lane).spread_mm2);
        self.bodies.counterface.sample(&place, spread_mm2).gap_mm
    }
}
