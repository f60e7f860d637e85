//! The plan of a round body: a disc in quads without a pole.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, TAU};

use super::grid::{Place, Plan, TooManyNodes};

/// Radius of the core's corners in a disc of radius 1. Smaller cores make thin cells in the middle, larger ones flat cells
/// at the corners; with this value the worst scaled Jacobian of a hemisphere is largest.
const CORE_CORNER: f64 = 0.58;

/// Returns the unit disc in quads of edge about `edge`: a square core with bulging sides, and rings of quads around it.
///
/// A grid of polar coordinates would have a pole, where its cells are slivers; here three quads meet at four corners of
/// the core instead, and the worst angle is about 135 degrees.
///
/// # Errors
/// More nodes than fit into `layers` layers of a mesh.
pub fn disc_plan(edge: f64, layers: usize) -> Result<Plan, TooManyNodes> {
    let cells = |length: f64| (length / edge).round().max(1.0);
    let core_mid = f64::midpoint(CORE_CORNER, CORE_CORNER * FRAC_1_SQRT_2);
    // Even, so that a node lies in the middle.
    let (across, rings) = (2.0 * cells(core_mid), cells(1.0 - core_mid));
    TooManyNodes::check((across + 1.0).powi(2) + 4.0 * across * rings, layers)?;
    let (across, rings) = (across as usize, rings as usize);
    let part = |cell: usize| 2.0 * cell as f64 / across as f64 - 1.0;
    let mut places_mm: Vec<Place> = Vec::new();
    for i in 0..=across {
        places_mm.extend((0..=across).map(|k| core_place(part(i), part(k))));
    }
    let core = |i: usize, k: usize| (i * (across + 1) + k) as u32;
    // The rim of the core, once around, from the corner at 5/8 of a turn.
    let mut around: Vec<u32> = (0..across).map(|k| core(0, k)).collect();
    around.extend((0..across).map(|i| core(i, across)));
    around.extend((0..across).map(|k| core(across, across - k)));
    around.extend((0..across).map(|i| core(across - i, 0)));
    let mut quads = Vec::new();
    for i in 0..across {
        let cell = |k| {
            [
                core(i, k),
                core(i, k + 1),
                core(i + 1, k + 1),
                core(i + 1, k),
            ]
        };
        quads.extend((0..across).map(cell));
    }
    let mut inner = around.clone();
    for ring in 1..=rings {
        let out = ring as f64 / rings as f64;
        let outer: Vec<u32> = (0..around.len())
            .map(|step| {
                let [x, z] = places_mm[around[step] as usize].into();
                // From z towards x, the direction of `around`.
                let angle = TAU * (0.625 + step as f64 / around.len() as f64);
                let (rim_x, rim_z) = angle.sin_cos();
                places_mm.push(Place::new(x + out * (rim_x - x), z + out * (rim_z - z)));
                places_mm.len() as u32 - 1
            })
            .collect();
        for step in 0..inner.len() {
            let next = (step + 1) % inner.len();
            quads.push([inner[step], outer[step], outer[next], inner[next]]);
        }
        inner = outer;
    }
    Ok(Plan { places_mm, quads })
}

/// Returns the place of a point of the square from -1 to 1 in the core: half that in a square, half that on arcs, the
/// sooner on arcs the farther out.
fn core_place(s: f64, t: f64) -> Place {
    let radius = s.abs().max(t.abs());
    if radius == 0.0 {
        return Place::new(0.0, 0.0);
    }
    let (along, across) = if s.abs() >= t.abs() { (s, t) } else { (t, s) };
    let (sine, cosine) = (FRAC_PI_4 * across / along).sin_cos();
    let arc = along * CORE_CORNER;
    let square = CORE_CORNER * FRAC_1_SQRT_2;
    let of_arc = radius / 2.0;
    let mixed = |on_arc: f64, on_square: f64| on_square + of_arc * (on_arc - on_square);
    let (far, near) = (
        mixed(arc * cosine, square * along),
        mixed(arc * sine, square * across),
    );
    if s.abs() >= t.abs() {
        Place::new(far, near)
    } else {
        Place::new(near, far)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::columns::Meshing;

    #[test]
    fn verify_area_and_quality_of_the_disc() {
        let plan = disc_plan(0.05, 1).unwrap();
        let count = plan.places_mm.len();
        let disc = plan.hexahedra(
            &vec![(0.0, 0.05); count],
            Meshing {
                edge_mm: 0.05,
                layers: 1,
            },
        );
        // The polygon of the rim has this area.
        let sides = 4.0 * (plan.quads.len() as f64 / 4.0).sqrt();
        assert!(
            disc.mesh.worst_quality() > 0.6,
            "{}",
            disc.mesh.worst_quality()
        );
        let area = disc.mesh.volume() / 0.05;
        assert!(
            area < PI && area > PI * (1.0 - 7.0 / (sides * sides)),
            "{area}"
        );
        assert!(disc.mesh.qualities().all(|quality| quality > 0.0));
    }
}
