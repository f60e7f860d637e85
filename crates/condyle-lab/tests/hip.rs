//! Hips and pins compared with closed forms and with integrals over the sphere that share no code with the solver.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

use condyle::{
    Mat3, Vec3,
    contact::{
        Bodies, ContactLaw, ContactMemory, Foundation, PressureLaw, confined_modulus, shell_modulus,
    },
    evolve::March,
    geometry::{Counterface, CupShape, Meshing},
    spatial::{Pose, RelativeMotion},
};
use condyle_case::case::Case;

const CUP_MM: f64 = 14.0;

/// A ball in a conforming foundation: pressure K e (cos t - cos a) at the angle t from the load.
#[derive(Clone, Copy)]
struct BallInCup {
    radius_mm: f64,
    clearance_mm: f64,
    stiffness_mpa_per_mm: f64,
    half_angle: f64,
}

impl BallInCup {
    fn under(load_n: f64, radius_mm: f64, clearance_mm: f64, stiffness_mpa_per_mm: f64) -> Self {
        let at = |half_angle: f64| Self {
            radius_mm,
            clearance_mm,
            stiffness_mpa_per_mm,
            half_angle,
        };
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        for _ in 0..100 {
            let middle = f64::midpoint(low, high);
            if at(middle).force_n() < load_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(low)
    }

    /// Approach beyond the first touch and clearance together, mm.
    fn eccentricity_mm(&self) -> f64 {
        self.clearance_mm / self.half_angle.cos()
    }

    fn peak_mpa(&self) -> f64 {
        self.stiffness_mpa_per_mm * self.eccentricity_mm() * (1.0 - self.half_angle.cos())
    }

    fn force_n(&self) -> f64 {
        let cosine = self.half_angle.cos();
        let part = (1.0 - cosine.powi(3)) / 3.0 - cosine * (1.0 - cosine * cosine) / 2.0;
        TAU * self.radius_mm.powi(2) * self.stiffness_mpa_per_mm * self.eccentricity_mm() * part
    }

    fn area_mm2(&self) -> f64 {
        TAU * self.radius_mm.powi(2) * (1.0 - self.half_angle.cos())
    }

    /// Integral of pressure times the speed of slip for a rotation of the head, N mm/s: |w x r| p over the contact.
    fn work_rate(&self, rotation: &Vec3) -> f64 {
        const RINGS: usize = 60;
        const SECTORS: usize = 60;
        let mut sum = 0.0;
        for ring in 0..RINGS {
            let t = self.half_angle * (ring as f64 + 0.5) / RINGS as f64;
            let pressure = t.cos() - self.half_angle.cos();
            for sector in 0..SECTORS {
                let (sine, cosine) = (TAU * (sector as f64 + 0.5) / SECTORS as f64).sin_cos();
                let place = Vec3::new(t.sin() * cosine, -t.cos(), t.sin() * sine) * self.radius_mm;
                // The head rotates about its own centre, which has sunk towards the cup.
                let arm = place + Vec3::y() * self.eccentricity_mm();
                sum += pressure * rotation.cross(&arm).norm() * t.sin();
            }
        }
        let cell = self.half_angle / RINGS as f64 * TAU / SECTORS as f64 * self.radius_mm.powi(2);
        sum * cell * self.stiffness_mpa_per_mm * self.eccentricity_mm()
    }
}

/// The same contact with the exact gap between two spheres, by quadrature: the closed form neglects e^2/(2 R), 0.3 % of the
/// peak at the smallest clearance.
fn exact_under(load_n: f64, clearance_mm: f64, stiffness_mpa_per_mm: f64) -> BallInCup {
    const RINGS: usize = 2000;
    let overclosure_mm = |e: f64, t: f64| {
        CUP_MM - clearance_mm - (CUP_MM * CUP_MM - 2.0 * CUP_MM * e * t.cos() + e * e).sqrt()
    };
    let force_n = |e: f64| {
        let ring = |n: usize| {
            let t = FRAC_PI_2 * (n as f64 + 0.5) / RINGS as f64;
            overclosure_mm(e, t).max(0.0) * t.sin() * t.cos()
        };
        let sum: f64 = (0..RINGS).map(ring).sum();
        sum * FRAC_PI_2 / RINGS as f64 * TAU * CUP_MM * CUP_MM * stiffness_mpa_per_mm
    };
    let (mut low, mut high) = (clearance_mm, 1.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if force_n(middle) < load_n {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (mut inside, mut outside) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = f64::midpoint(inside, outside);
        if overclosure_mm(low, middle) > 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    BallInCup {
        radius_mm: CUP_MM,
        // That of a closed form with the same approach and half-angle.
        clearance_mm: low * inside.cos(),
        stiffness_mpa_per_mm,
        half_angle: inside,
    }
}

#[test]
fn verify_contact_of_a_ball_in_a_cup() {
    let (e_mpa, v, thickness_mm) = (1000.0, 0.4, 8.0);
    let stiffness = confined_modulus(e_mpa, v) / thickness_mm;
    let shape = CupShape {
        radius_mm: CUP_MM,
        thickness_mm,
        opening_deg: 90.0,
        inclination_deg: 15.0,
        anteversion_deg: 0.0,
    };
    let insert = shape
        .insert(Meshing {
            edge_mm: 0.35,
            layers: 2,
        })
        .unwrap();
    let surface = insert.surface();
    for (clearance_mm, load_n) in [
        (0.02, 3000.0),
        (0.1, 3000.0),
        (0.4, 3000.0),
        (0.1, 300.0),
        (0.05, 1000.0),
    ] {
        let exact = exact_under(load_n, clearance_mm, stiffness);
        let closed = BallInCup::under(load_n, CUP_MM, clearance_mm, stiffness);
        assert!((closed.eccentricity_mm() / exact.eccentricity_mm() - 1.0).abs() < 0.004);
        let femur =
            Counterface::sphere(CUP_MM - clearance_mm).prepared_for(surface.mean_spread_mm2());
        let law = Foundation::new(
            PressureLaw::Linear {
                modulus_mpa: confined_modulus(e_mpa, v),
            },
            0.0,
            1.0,
        );
        let bodies = Bodies {
            counterface: &femur,
            insert: &insert,
            surface: &surface,
        };
        let mut contact = law.contact(bodies, ContactMemory::default());
        let at = |down_mm: f64| {
            RelativeMotion::at_rest(Pose::new(Mat3::identity(), -Vec3::y() * down_mm))
        };
        let (mut low, mut high) = (clearance_mm, 1.0);
        for _ in 0..50 {
            let middle = f64::midpoint(low, high);
            let pressed_n = -contact.respond(&at(middle)).wrench.force.y;
            if pressed_n < load_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        contact.respond(&at(low));
        let result = contact.evaluate(&at(low));
        let area_mm2: f64 = result.touched.iter().map(|node| node.covered_mm2).sum();
        for (name, found, exact) in [
            ("approach", low, exact.eccentricity_mm()),
            (
                "peak",
                result.peak_pressure_mpa,
                stiffness * (exact.eccentricity_mm() - clearance_mm),
            ),
            ("area", area_mm2, exact.area_mm2()),
        ] {
            assert!(
                (found / exact - 1.0).abs() < 0.003,
                "{clearance_mm} {load_n} {name}: {found} {exact}"
            );
        }
    }
}

#[test]
fn verify_the_published_row_of_a_ball_in_a_cup() {
    let exact = BallInCup::under(3000.0, 14.0, 0.1, 267.857);
    assert!((exact.half_angle.to_degrees() - 50.44).abs() < 0.01);
    assert!((exact.peak_mpa() - 15.268).abs() < 0.002);
}

#[test]
fn verify_a_shell_is_softer_than_a_flat_layer() {
    let part = |v: f64| shell_modulus(1000.0, v, 14.1, 8.0) / confined_modulus(1000.0, v);
    assert!((part(0.4) - 0.975).abs() < 0.001, "{}", part(0.4));
    assert!((part(0.46) - 0.765).abs() < 0.001, "{}", part(0.46));
    // A shell that is thin for its radius is a flat layer.
    let thin = shell_modulus(1000.0, 0.4, 1e5, 8.0) / confined_modulus(1000.0, 0.4);
    assert!((thin - 1.0).abs() < 1e-3, "{thin}");
}

/// A frictionless hip by Archard's law on a machine.
fn hip(machine: &str) -> String {
    format!(
        "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n\
         [insert]\nshape = \"cup\"\nedge_mm = 0.8\nlayers = 2\ninclination_deg = 10.0\n\
         [contact]\nfriction = 0.0\n\
         [wear]\nlaw = \"archard\"\n\
         [machine]\n{machine}\n\
         [march]\ncycles = 1\nupdates = 1\n"
    )
}

/// Returns the volume that a case wears in its first cycle over its wear factor, N mm, and the built modulus.
fn work_of_first_cycle(text: &str) -> f64 {
    let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
    let mut march = March::start(case.build(1).unwrap().test).unwrap();
    march.run().unwrap();
    march.state().updates[0].volume_loss_mm3 / case.wear.constant("wear_factor_mm3_per_nm").unwrap()
        * 1e3
}

fn default_stiffness() -> f64 {
    let material = Case::parse("", "case.toml", Path::new(""))
        .unwrap()
        .material;
    shell_modulus(
        material.youngs_modulus_mpa,
        material.poissons_ratio,
        14.1,
        8.0,
    ) / 8.0
}

#[test]
fn verify_archard_wear_of_a_head_that_rotates_across_and_about_the_load() {
    let contact = BallInCup::under(3000.0, 14.1, 0.1, default_stiffness());
    for (axis, unit) in [("[1, 0, 0]", Vec3::x()), ("[0, 1, 0]", Vec3::y())] {
        let machine = format!(
            "tests = \"hip\"\n\
             [[machine.joints]]\nname = \"penetration\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n\
             [machine.joints.load]\nknots_n = [[0, 3000]]\n\
             [[machine.joints]]\nname = \"turn\"\nkind = \"rotation\"\naxis = {axis}\ndrive = \"prescribed\"\n\
             [machine.joints.motion]\nknots_deg = [[0, 20], [50, -20]]\n"
        );
        let found = work_of_first_cycle(&hip(&machine));
        let exact = contact.work_rate(&unit) * 80f64.to_radians();
        assert!(
            (found / exact - 1.0).abs() < 0.005,
            "{axis}: {found} {exact}"
        );
    }
}

#[test]
fn verify_closed_volume_factors_of_the_integral() {
    let at = |degrees: f64| BallInCup {
        radius_mm: 14.0,
        clearance_mm: 1e-9,
        stiffness_mpa_per_mm: 100.0,
        half_angle: degrees.to_radians(),
    };
    // Without clearance the centres coincide, as in the closed forms.
    let factor =
        |contact: BallInCup, axis: Vec3| contact.work_rate(&axis) / (contact.force_n() * 14.0);
    assert!((factor(at(50.0), Vec3::x()) - 1.0693).abs() < 5e-4);
    assert!((factor(at(50.0), Vec3::y()) - 0.4916).abs() < 5e-4);
    assert!((factor(at(89.999), Vec3::x()) - 4.0 / PI).abs() < 1e-3);
}

/// The half-cosine waveform of knots, and its slope by the phase; both in the unit of the knots.
fn half_cosine(knots: &[(f64, f64)], phase: f64) -> f64 {
    let count = knots.len();
    for (n, &(from, low)) in knots.iter().enumerate() {
        let (to, high) = knots[(n + 1) % count];
        let span = (to - from - 1e-12).rem_euclid(100.0) + 1e-12;
        let along = (100.0 * phase - from).rem_euclid(100.0) / span;
        if along < 1.0 {
            return low + (high - low) * (1.0 - (PI * along).cos()) / 2.0;
        }
    }
    unreachable!("knots cover the cycle")
}

fn rotation_about(axis: Vec3, degrees: f64) -> Mat3 {
    nalgebra::Rotation3::from_scaled_axis(axis * degrees.to_radians()).into_inner()
}

/// Orientation of the head on the machine of ISO 14242-1, independent of the machine file.
fn iso_head(phase: f64) -> Mat3 {
    rotation_about(Vec3::z(), half_cosine(&[(0.0, 25.0), (50.0, -18.0)], phase))
        * rotation_about(
            -Vec3::x(),
            half_cosine(&[(0.0, 3.0), (21.0, 7.0), (50.0, -4.0)], phase),
        )
        * rotation_about(-Vec3::y(), half_cosine(&[(0.0, -10.0), (50.0, 2.0)], phase))
}

const ISO_LOAD: [(f64, f64); 5] = [
    (0.0, 300.0),
    (12.0, 3000.0),
    (32.0, 1500.0),
    (50.0, 3000.0),
    (62.0, 300.0),
];

/// Returns the rotation vector from one orientation to the next, in the cup's frame.
fn turned(from: &Mat3, to: &Mat3) -> Vec3 {
    nalgebra::Rotation3::from_matrix_unchecked(to * from.transpose()).scaled_axis()
}

fn over_iso_cycle(steps: usize, integrand: impl Fn(f64, Vec3) -> f64) -> f64 {
    over_cycle(iso_head, steps, integrand)
}

/// Integrates over the cycle of a head: `integrand` of the load, N, and the rotation, rad, of each step.
fn over_cycle(
    head: impl Fn(f64) -> Mat3,
    steps: usize,
    integrand: impl Fn(f64, Vec3) -> f64,
) -> f64 {
    let at = |step: usize| step as f64 / steps as f64;
    let step = |n: usize| {
        let load_n = half_cosine(&ISO_LOAD, (at(n) + at(n + 1)) / 2.0 % 1.0);
        integrand(load_n, turned(&head(at(n)), &head(at(n + 1) % 1.0)))
    };
    (0..steps).map(step).sum()
}

#[test]
fn verify_track_of_the_loads_pole() {
    let pole = -Vec3::y() * 14.0;
    let track = over_iso_cycle(4000, |_, turn| turn.cross(&pole).norm());
    assert!((track - 21.6195).abs() < 0.001, "{track}");
    let work = over_iso_cycle(4000, |load, turn| load * turn.cross(&pole).norm());
    assert!((work - 27_635.1).abs() < 2.0, "{work}");
}

#[test]
fn verify_archard_wear_of_an_iso_cycle_against_an_integral() {
    let stiffness = default_stiffness();
    let exact = over_iso_cycle(400, |load_n, turn| {
        BallInCup::under(load_n, 14.1, 0.1, stiffness).work_rate(&turn)
    });
    let found = work_of_first_cycle(&hip("preset = \"iso-14242-1-like\""));
    assert!((found / exact - 1.0).abs() < 0.005, "{found} {exact}");
}

/// Returns the tilt of 23 degrees in the direction of the block, without a turn about the pole; independent of the machine
/// file.
fn orbital_head(phase: f64) -> Mat3 {
    let turn = rotation_about(Vec3::y(), 360.0 * phase);
    turn * rotation_about(Vec3::x(), 23.0) * turn.transpose()
}

#[test]
fn verify_track_of_the_pole_on_an_orbital_bearing() {
    let pole = -Vec3::y() * 14.0;
    let track = over_cycle(orbital_head, 4000, |_, turn| turn.cross(&pole).norm());
    let exact = TAU * 14.0 * 23f64.to_radians().sin();
    assert!((track - exact).abs() < 1e-3, "{track}");
    assert!((track - 34.37).abs() < 0.005, "{track}");
}

#[test]
fn verify_archard_wear_of_an_orbital_cycle_against_an_integral() {
    let stiffness = default_stiffness();
    let exact = over_cycle(orbital_head, 400, |load_n, turn| {
        BallInCup::under(load_n, 14.1, 0.1, stiffness).work_rate(&turn)
    });
    let found = work_of_first_cycle(&hip("preset = \"iso-14242-3-like\""));
    assert!((found / exact - 1.0).abs() < 0.005, "{found} {exact}");
}
