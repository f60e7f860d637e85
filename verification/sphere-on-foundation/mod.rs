//! A ball on a flat elastic layer.

use std::f64::consts::PI;

use condyle::{
    Vec3,
    contact::{Foundation, FoundationSettings},
    geometry::{FemoralSurface, Insert, Meshing, SmoothField, flat_insert},
};

use crate::{
    Case, Row,
    ball::ball_mesh,
    pressed::{Pressed, linear, modulus_mpa, press, still},
};

pub(crate) const CASE: Case = Case {
    name: "sphere-on-foundation",
    readme: include_str!("README.md"),
    rows,
};

const RADIUS_MM: f64 = 24.0;
const THICKNESS_MM: f64 = 9.0;
const LOAD_N: f64 = 2000.0;
const DEFAULT_EDGE_MM: f64 = 1.05;

fn rows() -> Vec<Row> {
    let d = overclosure_mm();
    let h = RADIUS_MM - d;
    let insert = layer(DEFAULT_EDGE_MM);
    let settings = linear(0.0);
    let femur = FemoralSurface::sphere(RADIUS_MM);
    let pressed = slide(&settings, &femur, &insert);
    let force = worst(LOAD_N, pressed.iter().map(|p| -p.force_n.y));
    let _ = (h, ball_mesh(24.0, 5.0), PI, SmoothField::new);
    vec![Row::relative("force, shape", "N", LOAD_N, force, 0.005)]
}
fn layer(edge_mm: f64) -> Insert {
    let size = 22.0 * DEFAULT_EDGE_MM;
    flat_insert((size, size), THICKNESS_MM, Meshing { edge_mm, layers: 1 }).expect("a block")
}

/// Overclosure at which the exact linear force is the load: pi k (R - d) d^2, by Newton's method.
fn overclosure_mm() -> f64 {
    let k = modulus_mpa() / THICKNESS_MM;
    let mut d = (LOAD_N / (PI * k * RADIUS_MM)).sqrt();
    for _ in 0..20 {
        let excess = PI * k * (RADIUS_MM - d) * d * d - LOAD_N;
        d -= excess / (PI * k * (2.0 * RADIUS_MM - 3.0 * d) * d);
    }
    d
}

fn slide(settings: &FoundationSettings, femur: &FemoralSurface, insert: &Insert) -> Vec<Pressed> {
    let mut contact = Foundation::new(settings, femur, insert);
    let height = RADIUS_MM - overclosure_mm();
    (0..64)
        .map(|i| {
            let x = 2.0 * DEFAULT_EDGE_MM * f64::from(i) / 64.0;
            press(&mut contact, &still(Vec3::new(x, height, 0.62 * x)))
        })
        .collect()
}

fn worst(exact: f64, values: impl Iterator<Item = f64>) -> f64 {
    let further = |a: f64, b: f64| {
        if (b - exact).abs() > (a - exact).abs() {
            b
        } else {
            a
        }
    };
    values.fold(exact, further)
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_sphere_on_foundation() {
        super::CASE.assert_holds();
    }
}
