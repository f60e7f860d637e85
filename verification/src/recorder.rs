//! A contact that notes what its nodes carry and how far they slide.

use std::cell::RefCell;

use condyle::{
    contact::{ContactModel, ContactResult, Foundation, Response, TouchedNode},
    spatial::RelativeMotion,
};

/// A foundation's contact that notes the sum over its nodes of normal force times sliding speed
/// wherever an increment ends, N mm/s.
pub(crate) struct Recorder<'a> {
    inner: Box<dyn ContactModel + 'a>,
    law: &'a Foundation,
    /// One number for each time.
    rubbed: &'a RefCell<Vec<f64>>,
}

impl<'a> Recorder<'a> {
    pub(crate) fn new(
        inner: Box<dyn ContactModel + 'a>,
        law: &'a Foundation,
        rubbed: &'a RefCell<Vec<f64>>,
    ) -> Self {
        Self { inner, law, rubbed }
    }

    /// Normal force times sliding speed of one node.
    ///
    /// A node's force is its normal force N and the friction mu s N across it, s = v/sqrt(v^2 + v0^2).
    fn rubs(&self, node: &TouchedNode) -> f64 {
        let speed = node.sliding_mm_per_s[0].hypot(node.sliding_mm_per_s[1]);
        let part = speed / speed.hypot(self.law.slip_tolerance_mm_per_s);
        node.force_n.norm() / 1f64.hypot(self.law.friction * part) * speed
    }
}

impl ContactModel for Recorder<'_> {
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
        let landing = self.inner.evaluate(motion);
        let sum = landing.touched.iter().map(|node| self.rubs(node)).sum();
        self.rubbed.borrow_mut().push(sum);
        landing
    }
}
