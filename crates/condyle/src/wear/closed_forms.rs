//! Every law on paths whose cross-shear has a closed form, however they lie: one table for all laws.

use std::f64::consts::TAU;

use super::paths::{Step, assert_near, circle, depth_mm, rectangle, straight, turned};
use super::{WEAR_LAWS, WearLawKind};

/// A path under one pressure, its cross-shear ratio and its length.
struct Known {
    path: Vec<Step>,
    cross_shear: f64,
    slid_mm: f64,
}

/// Straight, round, square, long and figure-of-eight.
fn known(pressure_mpa: f64) -> [Known; 5] {
    let of = |path: Vec<Step>, cross_shear, slid_mm| Known {
        path,
        cross_shear,
        slid_mm,
    };
    let (eight_cross_shear, eight_mm) = eight_by_quadrature();
    [
        of(straight(pressure_mpa, [20.0, 0.0]), 0.0, 20.0),
        of(circle(pressure_mpa, 20.0), 0.5, 20.0),
        of(rectangle(pressure_mpa, [5.0, 5.0]), 0.5, 20.0),
        of(rectangle(pressure_mpa, [9.0, 1.0]), 0.1, 20.0),
        of(eight(pressure_mpa), eight_cross_shear, eight_mm),
    ]
}

/// Gerono's figure of eight, x = 3 sin t, z = 3 sin t cos t, in many chords.
fn eight(pressure_mpa: f64) -> Vec<Step> {
    const CHORDS: usize = 40_000;
    let place = |chord: usize| {
        let t = TAU * chord as f64 / CHORDS as f64;
        [3.0 * t.sin(), 3.0 * t.sin() * t.cos()]
    };
    let step = |chord| {
        let ([x0, z0], [x1, z1]) = (place(chord), place(chord + 1));
        (pressure_mpa, [x1 - x0, z1 - z0])
    };
    (0..CHORDS).map(step).collect()
}

/// Its cross-shear ratio and length, by Simpson's rule on the velocity 3 (cos t, cos 2t): the two axes are those of
/// its symmetry.
fn eight_by_quadrature() -> (f64, f64) {
    const PARTS: usize = 4000;
    let (mut along, mut across) = (0.0, 0.0);
    for part in 0..PARTS {
        let t = TAU * part as f64 / PARTS as f64;
        // Simpson's weights on a closed path; the velocity is never 0.
        let weight = [2.0, 4.0][part % 2] / 3.0 * TAU / PARTS as f64;
        let (x, z) = (3.0 * t.cos(), 3.0 * (2.0 * t).cos());
        along += weight * x * x / x.hypot(z);
        across += weight * z * z / x.hypot(z);
    }
    (along.min(across) / (along + across), along + across)
}

/// What a law with the defaults of its constants wears, mm; none of a law whose closed form is with its own tests.
fn exact_mm(law: &WearLawKind, pressure_mpa: f64, known: &Known) -> Option<f64> {
    let (cs, slid_mm) = (known.cross_shear, known.slid_mm);
    // N m on each square millimetre.
    let work = pressure_mpa * slid_mm / 1000.0;
    Some(match law.word {
        "archard" => 2.64e-7 * work,
        "kang" => (-13.1 - 0.29 * pressure_mpa.min(10.0)).exp() * cs.max(0.01).powf(0.19) * work,
        "contact-area" if cs < 0.04 => (32.0 * cs + 0.3) * 1e-9 * slid_mm,
        "contact-area" => (1.9 * cs + 1.6) * 1e-9 * slid_mm,
        "unified" => 2.0 * 1.63e-6 * cs * work,
        "directional" => 2.0 * 1.63e-6 / 7.4 * (1.0 - cs + 6.4 * cs) * work,
        _ => return None,
    })
}

#[test]
fn verify_every_law_on_every_path_however_it_lies() {
    for law in WEAR_LAWS {
        let own = law.with_defaults().law;
        for pressure_mpa in [0.5, 5.0, 25.0] {
            for (number, known) in known(pressure_mpa).iter().enumerate() {
                for degrees in [0.0, 33.0, 120.0, -77.7] {
                    let found = depth_mm(own.as_ref(), &turned(&known.path, degrees));
                    let Some(exact) = exact_mm(law, pressure_mpa, known) else {
                        continue;
                    };
                    let error = (found - exact).abs();
                    let word = law.word;
                    assert!(
                        error <= 1e-6 * exact + 1e-22,
                        "{word} on path {number}: {found:e} for {exact:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn verify_a_law_scaled_wears_so_many_times_as_much() {
    for law in WEAR_LAWS {
        for known in &known(3.0)[1..] {
            let once = depth_mm(law.with_defaults().law.as_ref(), &known.path);
            for times in [0.2, 1.0, 3.5] {
                let scaled = law.law(&(law.scaled)(&law.defaults(), times));
                assert_near(depth_mm(scaled.as_ref(), &known.path), times * once);
            }
        }
    }
}
