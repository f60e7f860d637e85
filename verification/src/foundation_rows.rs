//! Rows of a body pressed on a foundation at many places over its mesh.

use crate::{
    Row,
    convergence::{order_of_errors, root_mean_square, worst},
    pressed::{Exact, Pressed, ripple},
};

/// Accepted errors: parts of the exact values, and of the mean force for the ripple.
pub(crate) struct Accepted {
    pub force: f64,
    pub peak: f64,
    pub area: f64,
    pub ripple: f64,
}

/// Worst force, peak pressure and area, and the ripple of the force.
pub(crate) fn rows(pressed: &[Pressed], exact: &Exact, at_most: &Accepted, what: &str) -> [Row; 4] {
    let Exact {
        force_n,
        area_mm2,
        peak_mpa,
    } = *exact;
    let force = worst(force_n, pressed.iter().map(|p| -p.force_n.y));
    let peak = worst(peak_mpa, pressed.iter().map(|p| p.peak_pressure_mpa));
    let area = worst(area_mm2, pressed.iter().map(|p| p.area_mm2));
    let named = |quantity: &str| format!("{quantity}, {what}");
    [
        Row::relative(named("force"), "N", force_n, force, at_most.force),
        Row::relative(named("peak pressure"), "MPa", peak_mpa, peak, at_most.peak),
        Row::relative(named("area"), "mm2", area_mm2, area, at_most.area),
        ripple_row(
            &named("ripple of the force"),
            pressed.iter().map(|p| p.force_n.y),
            at_most.ripple,
        ),
    ]
}

/// Half of the range of a force that should be constant over its mean, in %.
pub(crate) fn ripple_row(what: &str, forces_n: impl Iterator<Item = f64>, at_most: f64) -> Row {
    let forces_n: Vec<f64> = forces_n.collect();
    Row::absolute(
        what,
        "%",
        0.0,
        100.0 * ripple(&forces_n).abs(),
        100.0 * at_most,
    )
}

/// The force on the finest of three meshes, each half as coarse as the one before, and the order
/// at which its error, the root mean square over all places, falls from first to last.
pub(crate) fn refined(
    three: &[Vec<Pressed>; 3],
    exact_n: f64,
    at_most: f64,
    what: &str,
    expected_order: f64,
) -> Row {
    let error = |pressed: &Vec<Pressed>| {
        root_mean_square(pressed.iter().map(|p| -p.force_n.y / exact_n - 1.0))
    };
    let order = order_of_errors([error(&three[0]), error(&three[2])], 4.0);
    let finest = worst(exact_n, three[2].iter().map(|p| -p.force_n.y));
    Row::relative(what, "N", exact_n, finest, at_most).with_order(expected_order, order, 0.3)
}
