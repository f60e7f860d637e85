//! The axes of the machine.

/// Where the machine's axes lie in the insert frame, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineAxes {
    /// (x, y) of the flexion axis, which lies along z.
    pub flexion_mm: (f64, f64),
    /// (y, z) of the varus-valgus axis, which lies along x.
    pub vv_mm: (f64, f64),
    /// (x, z) of the axis of IE rotation, which lies along y.
    pub ie_mm: (f64, f64),
    /// x at which AP reads zero under the flexion axis.
    pub ap_zero_mm: f64,
}
