//! A node that may touch.

use super::cholesky::Eight;
use crate::number::Number;
/// A node that may touch.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub node: u32,
    /// How far the rigid femur reaches into the surface at rest, mm; < 0 apart. Then its derivatives by six
    /// motions.
    pub overclosure_mm: Eight,
}

impl Candidate {
    pub fn overclosed_mm(&self) -> f64 {
        self.overclosure_mm[0].lane(0)
    }
}
