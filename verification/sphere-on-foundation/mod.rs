//! A ball on a flat elastic layer.

use std::f64::consts::PI;

use condyle::{
    Vec3,
    contact::{Bodies, PressureLaw, PressureTable},
    geometry::{Counterface, GenericInsertShape, Insert, Meshing, SmoothField},
};

use crate::{
    Case, Row,
    ball::ball_mesh,
    foundation_rows::{Accepted, refined, ripple_row, rows as rows_of},
    law::{ExactLaw, THICKNESS_MM, exact_laws, modulus_mpa},
    pressed::{Exact, Pressed, block, contact_of, press, still, without_friction},
};

pub(crate) const CASE: Case = Case {
    name: "sphere-on-foundation",
    readme: include_str!("README.md"),
    rows,
};

const RADIUS_MM: f64 = 24.0;
const LOAD_N: f64 = 2000.0;
const DEFAULT_EDGE_MM: f64 = 1.05;
/// Edges of the femur's triangles.
const TRIANGLE_MM: f64 = 1.0;
/// Places of the ball over the mesh.
const PLACES: u32 = 128;

const ACCEPTED: Accepted = Accepted {
    force: 0.005,
    peak: 0.01,
    area: 0.03,
    ripple: 0.002,
};

fn rows() -> Vec<Row> {
    let layer = layer(DEFAULT_EDGE_MM);
    let (shape, mesh) = (Counterface::sphere(RADIUS_MM), mesh_over(&layer));
    let mut rows = Vec::new();
    for law in exact_laws() {
        for (femur, body) in [(&shape, "shape"), (&mesh, "mesh")] {
            let what = format!("{}, {body}", law.name);
            let pressed = slide(&law.law, femur, &layer);
            rows.extend(rows_of(&pressed, &exact(&law), &ACCEPTED, &what));
        }
    }
    let dish = dish();
    for (femur, body) in [(shape, "shape"), (mesh_over(&dish), "mesh")] {
        let what = format!("ripple of the force in the default dish, linear, {body}");
        let forces_n = forces_in_dish(&femur, &dish);
        rows.push(ripple_row(&what, forces_n.into_iter(), ACCEPTED.ripple));
    }
    rows.push(finer());
    rows
}

/// The ball of triangles, made ready for an insert.
fn mesh_over(insert: &Insert) -> Counterface {
    let field = SmoothField::new(&ball_mesh(RADIUS_MM, TRIANGLE_MM), 1);
    Counterface::Mesh(field).prepared_for(insert.surface().mean_spread_mm2())
}

fn finer() -> Row {
    let [linear, ..] = exact_laws();
    let femur = Counterface::sphere(RADIUS_MM);
    let three = [1.0, 0.5, 0.25].map(|part| {
        let layer = layer(part * DEFAULT_EDGE_MM);
        slide(&linear.law, &femur, &layer)
    });
    refined(
        &three,
        LOAD_N,
        1e-4,
        "force, linear, shape, at a quarter of the edge",
        2.0,
    )
}

fn exact(law: &ExactLaw) -> Exact {
    let d = overclosure_mm();
    let h = RADIUS_MM - d;
    Exact {
        force_n: 2.0 * PI * h * (law.integral)(d),
        area_mm2: PI * (RADIUS_MM * RADIUS_MM - h * h),
        peak_mpa: (law.pressure_mpa)(d),
    }
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

fn layer(edge_mm: f64) -> Insert {
    block(24.0 * DEFAULT_EDGE_MM, THICKNESS_MM, edge_mm)
}

/// The ball at places along a line that meets no symmetry of the mesh.
fn slide(law: &PressureLaw, femur: &Counterface, layer: &Insert) -> Vec<Pressed> {
    let law = without_friction(law);
    let bodies = Bodies {
        counterface: femur,
        insert: layer,
        surface: &layer.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    let height = RADIUS_MM - overclosure_mm();
    let place = |i: u32| {
        let along = 4.0 * DEFAULT_EDGE_MM * f64::from(i) / f64::from(PLACES);
        Vec3::new(along - 2.0, height, 0.618 * along - 1.3)
    };
    (0..PLACES)
        .map(|i| press(contact.as_mut(), &still(place(i))))
        .collect()
}

fn dish() -> Insert {
    GenericInsertShape::default()
        .insert(Meshing::default())
        .expect("the default insert is one")
}

/// How far the ball is pressed into the dish, mm: to about the same load.
const APPROACH_MM: f64 = 0.13;

/// Sizes of the force on the ball as it goes round the axis of the dish.
///
/// The dish is a surface of revolution about the line along z at the height of its sagittal radius.
/// A table of two points is a linear law whatever the thickness, so the force has one size.
fn forces_in_dish(femur: &Counterface, dish: &Insert) -> Vec<f64> {
    let stiff = PressureTable::new(vec![(0.0, 0.0), (1.0, modulus_mpa() / THICKNESS_MM)]);
    let law = without_friction(&PressureLaw::Tabulated(stiff.expect("a table that rises")));
    let bodies = Bodies {
        counterface: femur,
        insert: dish,
        surface: &dish.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    let shape = GenericInsertShape::default();
    let axis = Vec3::new(0.0, shape.sagittal_radius_mm, shape.spacing_mm / 2.0);
    let reach = shape.sagittal_radius_mm - RADIUS_MM + APPROACH_MM;
    let force_n = |i: u32| {
        let turn = 0.1 * (f64::from(i) / f64::from(PLACES) - 0.4);
        let place = axis + Vec3::new(turn.sin(), -turn.cos(), 0.0) * reach;
        press(contact.as_mut(), &still(place)).force_n.norm()
    };
    (0..PLACES).map(force_n).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_sphere_on_foundation() {
        super::CASE.assert_holds();
    }
}
