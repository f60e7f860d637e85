//! Steps in the backside, eased so that hexahedra can stand on them.

use crate::geometry::columns::{Column, Plan};

/// A corner of the backside whose area is this many times its area seen from above is too steep:
/// the scaled Jacobian of a hexahedron there is less than one over it.
const STEEPEST: f64 = 3.2;
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
    let is_steep = area2 > STEEPEST * STEEPEST;
    if is_steep {
        for (end, rise) in ends.into_iter().zip(rises) {
            columns[corner].0 += MOVED * rise;
            columns[end].0 -= MOVED * rise;
        }
    }
    is_steep
}

fn length2(plan: &Plan, a: usize, b: usize) -> f64 {
    let ((ax, az), (bx, bz)) = (plan.places_mm[a], plan.places_mm[b]);
    (bx - ax).powi(2) + (bz - az).powi(2)
}
