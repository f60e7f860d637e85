//! Orders of convergence, and what is typical or worst of many values.

/// Order found from errors at two sizes of the step: log(e1/e2) / log(h1/h2).
pub(crate) fn order_of_errors([coarse, fine]: [f64; 2], ratio: f64) -> f64 {
    (coarse / fine).ln() / ratio.ln()
}

/// The value that lies furthest from the exact one.
pub(crate) fn worst(exact: f64, values: impl Iterator<Item = f64>) -> f64 {
    let further = |a: f64, b: f64| {
        if (b - exact).abs() > (a - exact).abs() {
            b
        } else {
            a
        }
    };
    values.fold(exact, further)
}

/// Root of the mean square.
pub(crate) fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v * v, count + 1.0));
    f64::sqrt(sum / count)
}

/// Order found from values at three sizes of the step, each half of the one before: log2 of the
/// ratio of their differences.
pub(crate) fn order_of_differences([coarse, middle, fine]: [f64; 3]) -> f64 {
    ((middle - coarse) / (fine - middle)).log2()
}
