//! Orders of convergence and limits, found from refinement.

/// Order found from errors at two sizes of the step: log(e1/e2) / log(h1/h2).
pub(crate) fn order_of_errors([coarse, fine]: [f64; 2], ratio: f64) -> f64 {
    (coarse / fine).ln() / ratio.ln()
}
