//! What a contact does with the work that is done on it.

use std::cell::RefCell;

use condyle::{
    contact::{ContactModel, Foundation, PressureLaw, RelativeMotion, Tangent, TouchedNode, Vec6},
    evolve::WearTest,
};

/// The contact at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// The femur's twist relative to the insert, rad/s and mm/s.
    pub twist: Vec6,
    /// Wrench on the insert, N mm and N.
    pub wrench: Vec6,
    /// Energy stored in the foundation, N mm.
    pub stored_nmm: f64,
    /// Work of friction for each second, N mm/s.
    pub friction_nmm_per_s: f64,
}

/// A foundation that is looked at whenever it is asked what it touches: at the end of an increment.
pub(crate) struct Witness<'a> {
    inner: Foundation<'a>,
    test: &'a WearTest,
    seen: &'a RefCell<Vec<Instant>>,
}

impl<'a> Witness<'a> {
    pub(crate) fn new(test: &'a WearTest, seen: &'a RefCell<Vec<Instant>>) -> Self {
        Self {
            inner: Foundation::new(&test.contact, &test.femur, &test.insert),
            test,
            seen,
        }
    }

    /// Work that a node's share of a linear foundation stores: A K W^2/(2 h), with p = K W/h.
    fn stored_nmm(&self, node: &TouchedNode) -> f64 {
        let PressureLaw::Linear { modulus_mpa } = self.test.contact.law else {
            panic!("the energy of a linear foundation is asked");
        };
        let thickness_mm = self.test.insert.thickness_mm()[node.node as usize];
        let area_mm2 = self.inner.surface().shares[node.node as usize].area_mm2;
        area_mm2 * node.pressure_mpa.powi(2) * thickness_mm / (2.0 * modulus_mpa)
    }

    /// mu s N v with s = v/sqrt(v^2 + v0^2), from the femur's motion and normal at the share.
    fn friction_nmm_per_s(&self, node: &TouchedNode, motion: &RelativeMotion) -> f64 {
        let share = &self.inner.surface().shares[node.node as usize];
        let in_femur = motion.pose.to_femur(&share.centre);
        let sample = self.test.femur.sample(&in_femur, share.spread_mm2);
        let normal = motion.pose.rotation * sample.normal;
        let angular = motion.twist.fixed_rows::<3>(0);
        let velocity = angular.cross(&share.centre) + motion.twist.fixed_rows::<3>(3);
        let speed = (velocity - normal * normal.dot(&velocity)).norm();
        let settings = &self.test.contact;
        let part = speed / speed.hypot(settings.slip_tolerance_mm_per_s);
        settings.friction * part * node.pressure_mpa * share.area_mm2 * speed
    }
}

impl ContactModel for Witness<'_> {
    fn respond(&mut self, motion: &RelativeMotion) -> Vec6 {
        self.inner.respond(motion)
    }

    fn tangent(&self) -> Tangent {
        self.inner.tangent()
    }

    fn mean_slip(&self) -> [condyle::Vec3; 2] {
        self.inner.mean_slip()
    }

    fn node_count(&self) -> usize {
        self.inner.node_count()
    }

    fn touched(&mut self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        let wrench = self.inner.respond(motion);
        let touched = self.inner.touched(motion);
        self.seen.borrow_mut().push(Instant {
            twist: motion.twist,
            wrench,
            stored_nmm: touched.iter().map(|node| self.stored_nmm(node)).sum(),
            friction_nmm_per_s: touched
                .iter()
                .map(|node| self.friction_nmm_per_s(node, motion))
                .sum(),
        });
        touched
    }

    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64 {
        self.inner.peak_pressure_mpa(motion, touched)
    }
}
