//! Minimisation of a smooth function in a box.

use nalgebra::{DMatrix, DVector};

/// Share of the decrease along the slope that a step must reach (Nocedal and Wright 2006, section 3.1).
const SUFFICIENT_DECREASE: f64 = 1e-4;
/// A step that is halved this often is shorter than the rounding of the point.
const MAX_HALVINGS: usize = 40;
/// Steps of a descent: emulators need fewer, and a curved valley is left where it is followed for longer.
const MAX_STEPS: usize = 60;
/// The descent ends at a relative decrease below this.
const MIN_DECREASE: f64 = 1e-10;

/// A function with its gradient; none where it has no value.
pub(crate) type Smooth<'a> = dyn Fn(&DVector<f64>) -> Option<(f64, DVector<f64>)> + 'a;

/// Returns a local minimum of `function` between `low` and `high`, and its value there, by the projected BFGS method
/// (Nocedal and Wright 2006, chapters 6 and 16); none if the function has no value at `start`.
pub(crate) fn minimum(
    function: &Smooth<'_>,
    start: DVector<f64>,
    [low, high]: [&DVector<f64>; 2],
) -> Option<(DVector<f64>, f64)> {
    let axes = start.len();
    let inside = |point: DVector<f64>| point.sup(low).inf(high);
    let mut point = inside(start);
    let (mut value, mut slope) = function(&point)?;
    let mut inverse = DMatrix::identity(axes, axes) / slope.norm().max(1.0);
    for _ in 0..MAX_STEPS {
        let is_held = |axis: usize| {
            (point[axis] <= low[axis] && slope[axis] > 0.0)
                || (point[axis] >= high[axis] && slope[axis] < 0.0)
        };
        let free = DVector::from_fn(axes, |axis, _| f64::from(!is_held(axis)));
        let free_slope = slope.component_mul(&free);
        let mut direction = -(&inverse * &free_slope).component_mul(&free);
        if direction.dot(&free_slope) >= 0.0 {
            inverse = DMatrix::identity(axes, axes) / slope.norm().max(1.0);
            direction = -(&inverse * &free_slope);
        }
        let step = |halvings: usize| {
            let next = inside(&point + &direction * 0.5_f64.powi(halvings as i32));
            let found = function(&next)?;
            let expected = SUFFICIENT_DECREASE * slope.dot(&(&next - &point));
            (found.0 < value + expected).then_some((next, found))
        };
        let Some((next, (next_value, next_slope))) = (0..MAX_HALVINGS).find_map(step) else {
            break;
        };
        let decrease = value - next_value;
        update(&mut inverse, &(&next - &point), &(&next_slope - &slope));
        (point, value, slope) = (next, next_value, next_slope);
        if decrease < MIN_DECREASE * (1.0 + value.abs()) {
            break;
        }
    }
    Some((point, value))
}

/// Updates the inverse Hessian by the formula of Broyden, Fletcher, Goldfarb and Shanno, if it stays positive definite.
fn update(inverse: &mut DMatrix<f64>, step: &DVector<f64>, change: &DVector<f64>) {
    let curvature = step.dot(change);
    if curvature <= 1e-12 * step.norm() * change.norm() {
        return;
    }
    let turned = &*inverse * change;
    let scale = (1.0 + change.dot(&turned) / curvature) / curvature;
    *inverse += scale * step * step.transpose()
        - (&turned * step.transpose() + step * turned.transpose()) / curvature;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_unit_square(function: &Smooth<'_>) -> (DVector<f64>, f64) {
        let ends = [0.0, 1.0].map(|end| DVector::from_element(2, end));
        let start = DVector::from_vec(vec![0.2, 0.9]);
        minimum(function, start, [&ends[0], &ends[1]]).unwrap()
    }

    #[test]
    fn verify_the_bottom_of_a_curved_valley() {
        // Rosenbrock's function with its minimum at (0.5, 0.25).
        let valley = |x: &DVector<f64>| {
            let (u, v) = (x[0] - 0.5, x[1] - x[0] * x[0]);
            let slope = vec![2.0 * u - 400.0 * x[0] * v, 200.0 * v];
            Some((u * u + 100.0 * v * v, DVector::from_vec(slope)))
        };
        let (point, value) = in_unit_square(&valley);
        assert!(
            (point[0] - 0.5).abs() < 1e-4 && (point[1] - 0.25).abs() < 1e-4,
            "{point}"
        );
        assert!(value < 1e-8);
    }

    #[test]
    fn verify_a_minimum_on_an_edge_is_on_it() {
        let bowl = |x: &DVector<f64>| {
            let (u, v) = (x[0] - 1.5, x[1] - 0.3);
            let slope = vec![2.0 * u + v, u + 8.0 * v];
            Some((u * u + u * v + 4.0 * v * v, DVector::from_vec(slope)))
        };
        let (point, _) = in_unit_square(&bowl);
        // On x = 1 the derivative along y, -0.5 + 8 (y - 0.3), is zero.
        assert_eq!(point[0], 1.0);
        assert!((point[1] - 0.3625).abs() < 1e-6, "{point}");
    }
}
