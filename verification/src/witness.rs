//! What a contact does with the work that is done on it.

use std::cell::RefCell;

use condyle::{
    contact::{
        Bodies, ContactModel, ContactResult, Foundation, PressureLaw, Response, TouchedNode,
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
    /// Energy stored in the foundation, N mm.
    pub stored_nmm: f64,
    /// Work of friction for each second, N mm/s.
    pub friction_nmm_per_s: f64,
}

/// A foundation's contact that is looked at wherever an increment ends.
pub(crate) struct Witness<'a> {
    inner: Box<dyn ContactModel + 'a>,
    law: &'a Foundation,
    bodies: Bodies<'a>,
    seen: &'a RefCell<Vec<Instant>>,
}

impl<'a> Witness<'a> {
    pub(crate) fn new(
        law: &'a Foundation,
        bodies: Bodies<'a>,
        seen: &'a RefCell<Vec<Instant>>,
    ) -> Self {
        Self {
            inner: contact_of(law, bodies),
            law,
            bodies,
            seen,
        }
    }

    /// Work that a node's share of a linear foundation stores: A K W^2/(2 h), with p = K W/h.
    fn stored_nmm(&self, node: &TouchedNode) -> f64 {
        let PressureLaw::Linear { modulus_mpa } = self.law.pressure else {
            panic!("the energy of a linear foundation is asked");
        };
        let thickness_mm = self.bodies.insert.thickness_mm()[node.node as usize];
        let area_mm2 = self.bodies.surface.shares[node.node as usize].area_mm2;
        area_mm2 * node.pressure_mpa.powi(2) * thickness_mm / (2.0 * modulus_mpa)
    }

    /// mu s N v with s = v/sqrt(v^2 + v0^2), from the femur's motion and normal at the share.
    fn friction_nmm_per_s(&self, node: &TouchedNode, motion: &RelativeMotion) -> f64 {
        let share = &self.bodies.surface.shares[node.node as usize];
        let in_femur = motion.pose.to_femur(&share.centre);
        let sample = self.bodies.femur.sample(&in_femur, share.spread_mm2);
        let normal = motion.pose.rotation * sample.normal;
        let velocity = motion.twist.angular.cross(&share.centre) + motion.twist.linear;
        let speed = (velocity - normal * normal.dot(&velocity)).norm();
        let part = speed / speed.hypot(self.law.slip_tolerance_mm_per_s);
        self.law.friction * part * node.pressure_mpa * share.area_mm2 * speed
    }
}

impl ContactModel for Witness<'_> {
    fn node_count(&self) -> usize {
        self.inner.node_count()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.inner.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
        self.inner.respond(motion)
    }

    fn accept(&mut self, motion: &RelativeMotion) {
        self.inner.accept(motion);
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let wrench = self.inner.respond(motion).wrench;
        let landing = self.inner.evaluate(motion);
        let touched = || landing.touched.iter();
        self.seen.borrow_mut().push(Instant {
            twist: motion.twist,
            wrench,
            stored_nmm: touched().map(|node| self.stored_nmm(node)).sum(),
            friction_nmm_per_s: touched()
                .map(|node| self.friction_nmm_per_s(node, motion))
                .sum(),
        });
        landing
    }
}
