//! A flat plate that presses a block evenly.

use condyle::{
    Vec3,
    contact::Foundation,
    geometry::{Counterface, SmoothField, TriangleMesh},
};

use crate::law::{THICKNESS_MM, exact_laws};

/// Edges of the triangles, mm.
const EDGE_MM: f64 = 2.0;

/// The underside of a plate at y = 0 of the femoral frame, at least `half_mm` to every side.
pub(crate) fn plate(half_mm: f64) -> Counterface {
    let half_count = (half_mm / EDGE_MM).ceil() as i32;
    let side = -half_count..=half_count;
    let place = |i: i32, k: i32| Vec3::new(f64::from(i) * EDGE_MM, 0.0, f64::from(k) * EDGE_MM);
    let across = 2 * half_count as u32;
    let corner = |i: u32, k: u32| i * (across + 1) + k;
    let cells = (0..across).flat_map(|i| (0..across).map(move |k| (i, k)));
    let triangles = cells.flat_map(|(i, k)| {
        let [a, b] = [corner(i, k), corner(i + 1, k)];
        let [c, d] = [corner(i + 1, k + 1), corner(i, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    let mesh = TriangleMesh {
        vertices: side
            .clone()
            .flat_map(|i| side.clone().map(move |k| place(i, k)))
            .collect(),
        triangles: triangles.collect(),
    };
    Counterface::Mesh(SmoothField::new(&mesh, 1))
}

/// A linear foundation with friction, and the stiffness of its layer, MPa/mm.
pub(crate) fn rubbing(friction: f64, slip_tolerance_mm_per_s: f64) -> (Foundation, f64) {
    let [linear, ..] = exact_laws();
    let law = Foundation::new(linear.law, friction, slip_tolerance_mm_per_s);
    (law, crate::law::modulus_mpa() / THICKNESS_MM)
}
