//! The highest pressure, at nodes and between them.

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactLaw, ContactMemory, Foundation, PressureLaw, PressureTable},
    geometry::{
        Counterface, Cylinder, GenericFemur, GenericFemurShape, GenericInsertShape, Insert,
        Meshing, SmoothField, TriangleMesh, flat_insert,
    },
    spatial::{Pose, RelativeMotion},
};
use nalgebra::Rotation3;

const MODULUS_MPA: f64 = 2142.0;
const THICKNESS_MM: f64 = 9.0;
const RADIUS_MM: f64 = 24.0;
/// Overclosure of a ball of this radius at about 2000 N.
const OVERCLOSURE_MM: f64 = 0.34;

/// A linear, a logarithmic, a softening and a tabulated law.
fn laws() -> [PressureLaw; 4] {
    let table = PressureTable::new(vec![(0.0, 0.0), (0.1, 22.0), (0.25, 58.0), (1.0, 260.0)]);
    [
        PressureLaw::Linear {
            modulus_mpa: MODULUS_MPA,
        },
        PressureLaw::Logarithmic {
            modulus_mpa: MODULUS_MPA,
        },
        PressureLaw::Softening {
            modulus_mpa: MODULUS_MPA,
            softening_stress_mpa: 18.4,
        },
        PressureLaw::Tabulated(table.unwrap()),
    ]
}

fn layer(edge_mm: f64) -> Insert {
    let meshing = Meshing { edge_mm, layers: 1 };
    flat_insert((24.0 * edge_mm, 24.0 * edge_mm), THICKNESS_MM, meshing).unwrap()
}

/// Highest mean over a node's share, and highest pressure, with the counterface turned about the vertical.
fn mean_and_peak(
    law: &PressureLaw,
    counterface: &Counterface,
    insert: &Insert,
    place: Vec3,
    turn_rad: f64,
) -> [f64; 2] {
    let law = Foundation::new(law.clone(), 0.07, 1.0);
    let surface = &insert.surface();
    let bodies = Bodies {
        counterface,
        insert,
        surface,
    };
    let mut contact = law.contact(bodies, ContactMemory::default());
    let turn = Mat3::from(Rotation3::new(Vec3::y() * turn_rad));
    let motion = RelativeMotion::at_rest(Pose::new(turn, place));
    contact.respond(&motion);
    let evaluated = contact.evaluate(&motion);
    let means = evaluated.touched.iter().map(|node| node.pressure_mpa);
    [means.fold(0.0, f64::max), evaluated.peak_pressure_mpa]
}

/// Peak pressure under a ball `deep_mm` deep, offset by [x, z] from a node.
fn under_ball(law: &PressureLaw, insert: &Insert, deep_mm: f64, [x, z]: [f64; 2]) -> f64 {
    let place = Vec3::new(x, RADIUS_MM - deep_mm, z);
    mean_and_peak(law, &Counterface::sphere(RADIUS_MM), insert, place, 0.0)[1]
}

fn assert_near(peak: f64, exact: f64, part: f64, what: &str) {
    assert!((peak / exact - 1.0).abs() < part, "{what}: {peak} {exact}");
}

/// Offsets of up to half an edge.
fn offsets(edge_mm: f64) -> impl Iterator<Item = [f64; 2]> {
    let parts = [0.0, 0.1, 0.25, 0.4, 0.5];
    let pairs = parts.into_iter().flat_map(move |x| parts.map(|z| [x, z]));
    pairs.map(move |offset| offset.map(|part| part * edge_mm))
}

#[test]
fn verify_peak_under_a_ball_between_nodes() {
    for edge_mm in [1.0, 1.05] {
        let insert = layer(edge_mm);
        for law in laws() {
            let exact = law.pressure(OVERCLOSURE_MM, THICKNESS_MM).0;
            for offset in offsets(edge_mm) {
                let peak = under_ball(&law, &insert, OVERCLOSURE_MM, offset);
                assert_near(peak, exact, 1e-3, &format!("{law:?}, {offset:?}"));
            }
        }
    }
}

#[test]
fn verify_peak_under_a_ball_that_hardly_touches() {
    let insert = layer(1.05);
    for law in laws() {
        // From some dozen shares, none of them pressing all over, to a part of one.
        for deep_mm in [0.06, 0.02, 0.005] {
            let exact = law.pressure(deep_mm, THICKNESS_MM).0;
            for offset in offsets(1.05) {
                let peak = under_ball(&law, &insert, deep_mm, offset);
                assert_near(peak, exact, 0.01, &format!("{deep_mm} mm, {offset:?}"));
            }
        }
    }
}

#[test]
fn verify_peak_under_a_cylinder_at_any_angle() {
    let insert = layer(1.05);
    let radius_mm = 20.0;
    let counterface = Counterface::Cylinder(Cylinder { radius_mm });
    for law in laws() {
        let exact = law.pressure(0.2, THICKNESS_MM).0;
        for turn_deg in [0.0_f64, 7.0, 26.6, 45.0, 90.0] {
            for part in [0.0, 0.2, 0.5] {
                let place = Vec3::new(1.05 * part, radius_mm - 0.2, 1.05 * part);
                let turn = turn_deg.to_radians();
                let [mean, peak] = mean_and_peak(&law, &counterface, &insert, place, turn);
                assert!(mean <= peak);
                assert_near(peak, exact, 1e-3, &format!("{turn_deg} deg, {part}"));
            }
        }
    }
}

#[test]
fn verify_peak_at_the_rim_of_the_surface() {
    let insert = layer(1.0);
    let [law, ..] = laws();
    for beyond_mm in [-1.0, -0.4, 0.0, 0.3, 1.0] {
        let away_mm = f64::max(beyond_mm, 0.0);
        let height_mm = RADIUS_MM - OVERCLOSURE_MM;
        let deepest_mm = RADIUS_MM - height_mm.hypot(away_mm);
        let exact = law.pressure(deepest_mm, THICKNESS_MM).0;
        for along_mm in [0.0, 0.3, 0.5] {
            let offset = [12.0 + beyond_mm, along_mm];
            let peak = under_ball(&law, &insert, OVERCLOSURE_MM, offset);
            assert_near(peak, exact, 0.01, &format!("{beyond_mm} mm, {along_mm}"));
        }
    }
}

#[test]
fn peak_is_the_same_in_the_mirror_and_whichever_of_equal_nodes_leads() {
    let insert = layer(1.05);
    for law in laws() {
        for [x, z] in [[0.525, 0.525], [0.525, 0.1], [0.0, 0.525]] {
            let one = under_ball(&law, &insert, OVERCLOSURE_MM, [x, z]);
            for place in [[x, -z], [-x, z], [-x, -z], [z, x]] {
                let other = under_ball(&law, &insert, OVERCLOSURE_MM, place);
                assert_near(other, one, 1e-9, &format!("{place:?}"));
            }
        }
    }
}

#[test]
fn peak_of_a_knee_hardly_depends_on_the_mesh_and_is_no_less_than_a_mean() {
    let [law, ..] = laws();
    let counterface = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    let shape = GenericInsertShape::default();
    let peaks = [2.0, 1.0, 0.5].map(|edge_mm| {
        let insert = shape.insert(Meshing { edge_mm, layers: 1 }).unwrap();
        let [mean, peak] = mean_and_peak(
            &law,
            &counterface,
            &insert,
            at_rest(&counterface, &insert),
            0.02,
        );
        assert!(mean <= peak, "{mean} {peak}");
        peak
    });
    assert_near(peaks[0], peaks[2], 0.02, "2 mm");
    assert_near(peaks[1], peaks[2], 0.002, "1 mm");
}

/// The counterface lowered over the middle until it presses by 0.3 mm.
fn at_rest(counterface: &Counterface, insert: &Insert) -> Vec3 {
    let surface = insert.surface();
    let least = |height: f64| {
        let to_counterface = |node: &Vec3| node - Vec3::new(0.0, height, 0.0);
        let gaps = surface
            .positions
            .iter()
            .map(|node| counterface.gap_mm(&to_counterface(node)));
        gaps.fold(f64::INFINITY, f64::min)
    };
    let (mut low, mut high) = (0.0, 60.0);
    for _ in 0..50 {
        let middle = (low + high) / 2.0;
        if least(middle) < -0.3 {
            low = middle;
        } else {
            high = middle;
        }
    }
    Vec3::new(0.0, low, 0.0)
}

/// Half the width of a flat condyle, the radius of its edge, and how much deeper its right side is, mm a mm.
const FLAT_MM: f64 = 8.0;
const EDGE_MM: f64 = 1.5;
const SLOPE: f64 = 0.004;

/// A condyle that is flat across and rounded at its edges, as an open surface that faces down.
fn flat_condyle() -> Counterface {
    const STEP_MM: f64 = 0.25;
    let columns = 76;
    let place = |i: u32, k: u32| {
        let x = f64::from(i) * STEP_MM - 9.5;
        let beyond = (x.abs() - FLAT_MM).max(0.0);
        let rounded = EDGE_MM - (EDGE_MM * EDGE_MM - (beyond * beyond).min(2.2)).sqrt();
        Vec3::new(x, rounded - SLOPE * x, f64::from(k) * 8.0 * STEP_MM - 20.0)
    };
    let mut mesh = TriangleMesh::default();
    for k in 0..=20 {
        mesh.vertices.extend((0..=columns).map(|i| place(i, k)));
    }
    for k in 0..20 {
        for i in 0..columns {
            let [a, b] = [k * (columns + 1) + i, (k + 1) * (columns + 1) + i];
            mesh.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
    }
    Counterface::Mesh(SmoothField::new(&mesh, 1))
}

#[test]
fn a_peak_at_an_edge_of_the_counterface_is_not_made_up() {
    const DEEP_MM: f64 = 0.05;
    let counterface = flat_condyle();
    let insert = layer(1.05);
    let law = &laws()[0];
    let along = (0..=2000).map(|i| f64::from(i) / 100.0 - 10.0);
    let deepest_mm = along.map(|x| -counterface.gap_mm(&Vec3::new(x, DEEP_MM, 0.0)));
    let deepest_mm = deepest_mm.fold(0.0, f64::max);
    let exact = law.pressure(deepest_mm, THICKNESS_MM).0;
    let counterface = counterface.prepared_for(insert.surface().mean_spread_mm2());
    for part in [0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9] {
        let place = Vec3::new(part * 1.05, -DEEP_MM, 0.3);
        let [mean, peak] = mean_and_peak(law, &counterface, &insert, place, 0.0);
        assert!(mean <= peak, "{mean} {peak}");
        let part_of_exact = peak / exact;
        assert!(
            (0.7..1.1).contains(&part_of_exact),
            "{part_of_exact} at {part}"
        );
    }
}
