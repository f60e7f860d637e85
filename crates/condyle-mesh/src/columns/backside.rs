//! Steps in the backside, eased so that hexahedra can stand on them.

use super::grid::{Column, Plan};

/// A corner of the backside is too steep if the scaled Jacobian of a hexahedron there is less: the sine of the
/// corner seen from above, over how many times longer its sides are than seen from above.
const MIN_JACOBIAN: f64 = 0.31;
/// What is no longer than this, as an area over that seen from above, squared, is flat: a corner that is sharp seen
/// from above is not eased further.
const FLAT: f64 = 1.01;
/// Share of a step that is moved from its upper to its lower end in a round.
const MOVED: f64 = 0.1;
/// Rounds at most: a step of six edges is eased in a hundred.
const ROUNDS: usize = 400;

/// Lets material flow from the upper to the lower end of what is too steep in the backside, such as
/// the wall of a recess for a clip, until it is not; as much as flows in one place is missing in another.
pub fn ease_steps(plan: &Plan, columns: &mut [Column]) {
    for _ in 0..ROUNDS {
        let mut was_steep = false;
        for quad in &plan.quads {
            for corner in 0..4 {
                let ends = [quad[(corner + 1) % 4], quad[(corner + 3) % 4]];
                was_steep |= ease(plan, columns, quad[corner], ends);
            }
        }
        if !was_steep {
            return;
        }
    }
}

/// Eases the two sides of a corner if they are too steep, and says whether they are.
fn ease(plan: &Plan, columns: &mut [Column], corner: u32, ends: [u32; 2]) -> bool {
    let corner = corner as usize;
    let ends = ends.map(|end| end as usize);
    let rises = ends.map(|end| columns[end].0 - columns[corner].0);
    let longer = |end: usize, rise: f64| 1.0 + rise * rise / length2(plan, corner, end);
    let area2 = longer(ends[0], rises[0]) * longer(ends[1], rises[1]);
    let is_steep = area2 > FLAT && sine2(plan, corner, ends) < MIN_JACOBIAN * MIN_JACOBIAN * area2;
    if is_steep {
        for (end, rise) in ends.into_iter().zip(rises) {
            columns[corner].0 += MOVED * rise;
            columns[end].0 -= MOVED * rise;
        }
    }
    is_steep
}

/// Squared sine of a corner seen from above.
fn sine2(plan: &Plan, corner: usize, [a, b]: [usize; 2]) -> f64 {
    let along = |end: usize| {
        let ((x, z), (from_x, from_z)) = (plan.places_mm[end], plan.places_mm[corner]);
        (x - from_x, z - from_z)
    };
    let ((ax, az), (bx, bz)) = (along(a), along(b));
    let twice_area = az * bx - ax * bz;
    twice_area * twice_area / (length2(plan, corner, a) * length2(plan, corner, b))
}

fn length2(plan: &Plan, a: usize, b: usize) -> f64 {
    let ((ax, az), (bx, bz)) = (plan.places_mm[a], plan.places_mm[b]);
    (bx - ax).powi(2) + (bz - az).powi(2)
}
