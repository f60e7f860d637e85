//! How the femur is raised until nothing touches.

/// Raises by short ways until no gap is smaller than `clearance_mm`; `raise_by` raises by a way, mm, and gives the
/// smallest gap then, mm.
///
/// A gap grows no faster than the femur rises, so the steps come from below.
pub(super) fn lift(clearance_mm: f64, mut raise_by: impl FnMut(f64) -> f64) {
    const MAX_STEPS: usize = 100;
    const SHORTEST_STEP_MM: f64 = 1e-4;
    let mut way_mm = 0.0;
    for _ in 0..MAX_STEPS {
        let nearest_mm = raise_by(way_mm);
        if nearest_mm >= clearance_mm {
            return;
        }
        way_mm = (clearance_mm - nearest_mm).max(SHORTEST_STEP_MM);
    }
}
