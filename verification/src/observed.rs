//! A foundation's contact that is observed at the end of every increment.

use condyle::{
    contact::{
        Bodies, ContactModel, ContactResult, Foundation, PressureLaw, Response, Tangent,
        TouchedNode,
    },
    spatial::{RelativeMotion, Twist, Wrench},
};

use crate::pressed::contact_of;

/// The contact at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// The femur's twist relative to the insert, rad/s and mm/s.
    pub twist: Twist,
    /// Wrench on the insert, N mm and N.
    pub wrench: Wrench,
    /// Energy stored in a linear foundation, N mm; 0 in others.
    pub stored_nmm: f64,
    /// Power of friction, N mm/s.
    pub friction_nmm_per_s: f64,
    /// Sum over the nodes of normal force times sliding speed, N mm/s.
    pub rubbed_nmm_per_s: f64,
}

/// A contact that records an [`Instant`] at the end of every increment.
pub(crate) struct Observed<'a> {
    inner: Box<dyn ContactModel + 'a>,
    law: &'a Foundation,
    bodies: Bodies<'a>,
    pub instants: Vec<Instant>,
}

impl<'a> Observed<'a> {
    pub(crate) fn new(law: &'a Foundation, bodies: Bodies<'a>) -> Self {
        Self {
            inner: contact_of(law, bodies),
            law,
            bodies,
            instants: Vec::new(),
        }
    }

    /// Energy in a node's share of a linear foundation: A K W^2/(2 h), with p = K W/h.
    fn stored_nmm(&self, node: &TouchedNode) -> f64 {
        let PressureLaw::Linear { modulus_mpa } = self.law.pressure else {
            return 0.0;
        };
        let thickness_mm = self.bodies.insert.thickness_mm()[node.node as usize];
        let area_mm2 = self.bodies.surface.shares[node.node as usize].area_mm2;
        area_mm2 * node.pressure_mpa.powi(2) * thickness_mm / (2.0 * modulus_mpa)
    }

    /// mu s N v with s = v/sqrt(v^2 + v0^2), from the femur's motion and normal at the share.
    fn friction_nmm_per_s(&self, node: &TouchedNode, motion: &RelativeMotion) -> f64 {
        let share = &self.bodies.surface.shares[node.node as usize];
        let in_femur = motion.pose.to_counterface(&share.centre);
        let sample = self.bodies.counterface.sample(&in_femur, share.spread_mm2);
        let normal = motion.pose.rotation * sample.normal;
        let velocity = motion.twist.angular.cross(&share.centre) + motion.twist.linear;
        let speed = (velocity - normal * normal.dot(&velocity)).norm();
        let part = speed / speed.hypot(self.law.settings.slip_tolerance_mm_per_s);
        self.law.settings.friction * part * node.pressure_mpa * share.area_mm2 * speed
    }

    /// Normal force times sliding speed of one node.
    ///
    /// A node's force is its normal force N and the friction mu s N across it, s = v/sqrt(v^2 + v0^2).
    fn rubbed_nmm_per_s(&self, node: &TouchedNode) -> f64 {
        let speed = node.sliding_mm_per_s[0].hypot(node.sliding_mm_per_s[1]);
        let part = speed / speed.hypot(self.law.settings.slip_tolerance_mm_per_s);
        node.force_n.norm() / 1f64.hypot(self.law.settings.friction * part) * speed
    }
}

impl ContactModel for Observed<'_> {
    fn node_count(&self) -> usize {
        self.inner.node_count()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.inner.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
        self.inner.respond(motion)
    }

    fn tangent(&self) -> Tangent {
        self.inner.tangent()
    }

    fn accept(&mut self, motion: &RelativeMotion) {
        self.inner.accept(motion);
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let wrench = self.inner.respond(motion).wrench;
        let result = self.inner.evaluate(motion);
        let sum = |of: &dyn Fn(&TouchedNode) -> f64| result.touched.iter().map(of).sum();
        self.instants.push(Instant {
            twist: motion.twist,
            wrench,
            stored_nmm: sum(&|node| self.stored_nmm(node)),
            friction_nmm_per_s: sum(&|node| self.friction_nmm_per_s(node, motion)),
            rubbed_nmm_per_s: sum(&|node| self.rubbed_nmm_per_s(node)),
        });
        result
    }
}
