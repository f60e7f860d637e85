//! A cylinder across a flat elastic layer.

use condyle::{
    Vec3,
    contact::{Bodies, PressureLaw},
    geometry::{Counterface, Cylinder},
};

use crate::{
    Case, Row,
    foundation_rows::{Accepted, refined, rows as rows_of},
    law::{ExactLaw, THICKNESS_MM, exact_laws, kinks_mm, modulus_mpa},
    pressed::{Exact, Pressed, block, contact_of, press, still, without_friction},
    quadrature::integral,
};

pub(crate) const CASE: Case = Case {
    name: "cylinder-on-foundation",
    readme: include_str!("README.md"),
    rows,
};

const RADIUS_MM: f64 = 20.0;
const OVERCLOSURE_MM: f64 = 0.2;
const EDGE_MM: f64 = 1.05;
const WIDTH_MM: f64 = 24.0 * EDGE_MM;
/// Places of the cylinder over the mesh.
const PLACES: u32 = 64;

const ACCEPTED: Accepted = Accepted {
    force: 0.005,
    peak: 0.01,
    area: 0.03,
    ripple: 0.002,
};

fn rows() -> Vec<Row> {
    let laws = exact_laws();
    let mut rows: Vec<Row> = laws
        .iter()
        .flat_map(|law| rows_of(&slide(&law.law, EDGE_MM), &exact(law), &ACCEPTED, law.name))
        .collect();
    rows.push(closed_form(&laws[0]));
    let three = [0.5, 0.25, 0.125].map(|part| slide(&laws[0].law, part * EDGE_MM));
    let exact_n = exact(&laws[0]).force_n;
    rows.push(refined(
        &three,
        exact_n,
        1e-4,
        "force, linear, at an eighth of the edge",
        3.0,
    ));
    rows
}

/// The integral of the linear law against its closed form.
fn closed_form(linear: &ExactLaw) -> Row {
    let (h, a, k) = (depth_mm(), half_width_mm(), modulus_mpa() / THICKNESS_MM);
    let closed = 2.0 * k * h * WIDTH_MM * (RADIUS_MM * (a / h).asinh() - a);
    let force_n = exact(linear).force_n;
    Row::relative(
        "force, linear, the integral itself",
        "N",
        closed,
        force_n,
        1e-10,
    )
}

/// Height of the axis over the layer.
fn depth_mm() -> f64 {
    RADIUS_MM - OVERCLOSURE_MM
}

fn half_width_mm() -> f64 {
    half_width_at_mm(0.0)
}

/// How far from the middle the overclosure is `x`.
fn half_width_at_mm(x: f64) -> f64 {
    ((RADIUS_MM - x).powi(2) - depth_mm().powi(2))
        .max(0.0)
        .sqrt()
}

fn exact(law: &ExactLaw) -> Exact {
    let h = depth_mm();
    let lift = |x: f64| {
        let s = h.hypot(x);
        (law.pressure_mpa)((RADIUS_MM - s).max(0.0)) * h / s
    };
    let ends: Vec<f64> = kinks_mm()
        .map(|x| half_width_at_mm(x.min(OVERCLOSURE_MM)))
        .collect();
    let pieces = ends.windows(2).map(|ends| integral(ends[1], ends[0], lift));
    Exact {
        force_n: 2.0 * WIDTH_MM * pieces.sum::<f64>(),
        area_mm2: 2.0 * half_width_mm() * WIDTH_MM,
        peak_mpa: (law.pressure_mpa)(OVERCLOSURE_MM),
    }
}

/// The cylinder at places over two edges of the mesh.
fn slide(law: &PressureLaw, edge_mm: f64) -> Vec<Pressed> {
    let femur = Counterface::Cylinder(Cylinder {
        radius_mm: RADIUS_MM,
    });
    let (law, layer) = (
        without_friction(law),
        block(WIDTH_MM, THICKNESS_MM, edge_mm),
    );
    let bodies = Bodies {
        counterface: &femur,
        insert: &layer,
        surface: &layer.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    let place = |i: u32| {
        let x = 2.0 * EDGE_MM * f64::from(i) / f64::from(PLACES);
        still(Vec3::new(x - 1.0, depth_mm(), 0.0))
    };
    (0..PLACES)
        .map(|i| press(contact.as_mut(), &place(i)))
        .collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_cylinder_on_foundation() {
        super::CASE.assert_holds();
    }
}
