//! A contact that notes what its nodes carry and how far they slide.

use std::cell::RefCell;

use condyle::contact::{
    ContactModel, Foundation, FoundationSettings, RelativeMotion, Tangent, TouchedNode, Vec6,
};

/// A foundation that notes the sum over its nodes of normal force times sliding speed whenever it
/// is asked what it touches, N mm/s.
pub(crate) struct Recorder<'a> {
    inner: Foundation<'a>,
    settings: &'a FoundationSettings,
    /// One number for each time.
    rubbed: &'a RefCell<Vec<f64>>,
}

impl<'a> Recorder<'a> {
    pub(crate) fn new(
        inner: Foundation<'a>,
        settings: &'a FoundationSettings,
        rubbed: &'a RefCell<Vec<f64>>,
    ) -> Self {
        Self {
            inner,
            settings,
            rubbed,
        }
    }

    /// Normal force times sliding speed of one node.
    ///
    /// A node's force is its normal force N and the friction mu s N across it, s = v/sqrt(v^2 + v0^2).
    fn rubs(&self, node: &TouchedNode) -> f64 {
        let speed = node.sliding_mm_per_s[0].hypot(node.sliding_mm_per_s[1]);
        let part = speed / speed.hypot(self.settings.slip_tolerance_mm_per_s);
        node.force_n.norm() / 1f64.hypot(self.settings.friction * part) * speed
    }
}

impl ContactModel for Recorder<'_> {
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
        let touched = self.inner.touched(motion);
        let sum = touched.iter().map(|node| self.rubs(node)).sum();
        self.rubbed.borrow_mut().push(sum);
        touched
    }

    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64 {
        self.inner.peak_pressure_mpa(motion, touched)
    }
}
