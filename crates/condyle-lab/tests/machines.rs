//! Machines by joints compared with closed forms: pins on paths, springs and ligaments in balance, a cylinder in a trough.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use condyle::{contact::confined_modulus, evolve::March, machine::CycleRow};
use condyle_case::case::Case;

/// Runs the only update of a case.
fn finished(text: &str) -> (Case, March) {
    let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
    let mut march = March::start(case.build(1).unwrap().test).unwrap();
    march.run().unwrap();
    (case, march)
}

fn rows(march: &March) -> &[CycleRow] {
    &march.state().activities[0]
        .first_and_last
        .as_ref()
        .unwrap()
        .0
        .rows
}

const ONE_UPDATE: &str = "[march]\ncycles = 1\nupdates = 1\n";

/// Returns the work of a pin under 70 N over a path by the waveforms of x and z, N mm.
fn work_of_pin(x: &str, z: &str) -> f64 {
    let joint = |name: &str, axis: &str, knots: &str| {
        format!(
            "[[machine.joints]]\nname = \"{name}\"\nkind = \"translation\"\naxis = {axis}\ndrive = \"prescribed\"\n\
             zeroed = false\nsettling = \"held\"\n[machine.joints.motion]\n{knots}\n"
        )
    };
    let text = format!(
        "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\nedge_mm = 0.8\nlayers = 2\n\
         [wear]\nlaw = \"archard\"\n[time]\nincrements = 4800\nforce_tolerance_n = 1e-6\n{ONE_UPDATE}[machine]\ntests = \"specimen\"\n{}{}\
         [[machine.joints]]\nname = \"press\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n\
         [machine.joints.load]\nknots_n = [[0, 70]]\n",
        joint("x", "[1, 0, 0]", x),
        joint("z", "[0, 0, 1]", z)
    );
    let (case, march) = finished(&text);
    let factor = case.wear.constant("wear_factor_mm3_per_nm").unwrap();
    march.state().updates[0].volume_loss_mm3 / factor * 1e3
}

#[test]
fn verify_a_pin_wears_by_load_times_path_on_every_path() {
    let still = "knots_mm = [[0, 0]]";
    let circle = (
        "knots_mm = [[0, 5], [50, -5]]",
        "knots_mm = [[25, 5], [75, -5]]",
    );
    let line = ("knots_mm = [[0, 5], [50, -5]]", still);
    // Sides of 6 and 4 mm; each side takes a quarter of the cycle.
    let rectangle = (
        "knots_mm = [[0, 0], [25, 6], [50, 6], [75, 0], [100, 0]]",
        "knots_mm = [[0, 0], [25, 0], [50, 4], [75, 4], [100, 0]]",
    );
    // The perimeter of an ellipse by the midpoint rule, which converges exponentially.
    let (count, half_mm) = (1000, (5.0f64, 2.0f64));
    let ellipse_mm: f64 = (0..count)
        .map(|n| {
            let (sine, cosine) = (TAU * (f64::from(n) + 0.5) / f64::from(count)).sin_cos();
            (half_mm.0 * sine).hypot(half_mm.1 * cosine) * TAU / f64::from(count)
        })
        .sum();
    let ellipse = (
        "knots_mm = [[0, 5], [50, -5]]",
        "knots_mm = [[25, 2], [75, -2]]",
    );
    for (path, length_mm) in [
        (circle, TAU * 5.0),
        (ellipse, ellipse_mm),
        (rectangle, 20.0),
        (line, 20.0),
    ] {
        let found = work_of_pin(path.0, path.1);
        let exact = 70.0 * length_mm;
        assert!(
            (found / exact - 1.0).abs() < 1e-6,
            "{path:?}: {found} {exact}"
        );
    }
}

/// Returns the place of a ball on a flat without friction, pushed aside by 100 N against a spring and a ligament, mm, and the tension of
/// the ligament, N.
fn ball_pushed_aside(spring: &str, ligament: &str) -> (f64, Vec<f64>) {
    let text = format!(
        "[femur]\nshape = \"sphere\"\nradius_mm = 24.0\n[insert]\nshape = \"flat\"\nedge_mm = 2.0\nlayers = 2\n\
         [contact]\nfriction = 0.0\n{ONE_UPDATE}[machine]\ntests = \"specimen\"\n\
         [[machine.joints]]\nname = \"aside\"\nkind = \"translation\"\naxis = [1, 0, 0]\ndrive = \"loaded\"\n\
         settling = \"held\"\n{spring}[machine.joints.load]\nknots_n = [[0, 100]]\n\
         [[machine.joints]]\nname = \"press\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n\
         [machine.joints.load]\nknots_n = [[0, 1000]]\n{ligament}"
    );
    let (_, march) = finished(&text);
    let positions = rows(&march).last().unwrap().positions;
    (positions[0], march.ligament_tensions_n(0, &positions))
}

#[test]
fn verify_a_spring_of_a_joint_in_balance() {
    let spring = "spring_n_per_mm = [50, 10]\nfree_play_mm = 1.0\n";
    assert!((ball_pushed_aside(spring, "").0 - 3.0).abs() < 1e-3);
    let at_rest_elsewhere = format!("{spring}spring_rest_mm = 2.0\n");
    assert!((ball_pushed_aside(&at_rest_elsewhere, "").0 - 5.0).abs() < 1e-3);
}

#[test]
fn verify_a_ligament_in_balance() {
    // From the height of the ball's centre: 5000 N (x / 30 mm - 0.01) = 100 N.
    let ligament = "[[machine.ligaments]]\nname = \"line\"\non_bearing_mm = [-30, 24, 0]\non_counterface_mm = [0, 0, 0]\n\
                    stiffness_n = 5000\ntoe_strain = 0.01\nstrain_at_zero = 0.0\n";
    let (found_mm, tensions_n) = ball_pushed_aside("", ligament);
    assert!((found_mm - 0.9).abs() < 2e-3, "{found_mm}");
    // The line is nearly along the load: its length changes in the second order of its slope.
    assert!((tensions_n[0] - 100.0).abs() < 0.1, "{tensions_n:?}");
}

/// Under the load F a cylinder of radius r lies e below the axis of the trough of radius R: at the angle t from the load the
/// overclosure is r - sqrt(R^2 - 2 R e cos t + e^2). The pressure is that overclosure times the confined modulus over the
/// thickness above the flat backside, along the normal; it acts along the normal of the cylinder.
#[test]
fn verify_a_cylinder_in_a_trough() {
    let (radius_mm, clearance_mm, width_mm, load_n) = (25.0, 0.5, 28.0, 2000.0);
    let text = format!(
        "[femur]\nshape = \"cylinder\"\nradius_mm = {}\n\
         [insert]\nshape = \"trough\"\nradius_mm = {radius_mm}\nwidth_mm = {width_mm}\nedge_mm = 0.3\nlayers = 2\n\
         {ONE_UPDATE}[machine]\ntests = \"ankle\"\n\
         [[machine.joints]]\nname = \"press\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n\
         [machine.joints.load]\nknots_n = [[0, {load_n}]]\n",
        radius_mm - clearance_mm
    );
    let (case, march) = finished(&text);
    let (e_mpa, v) = (
        case.material.youngs_modulus_mpa,
        case.material.poissons_ratio,
    );
    let modulus_mpa = confined_modulus(e_mpa, v);
    let thickness_mm = |t: f64| (6.0 + radius_mm * (1.0 - t.cos())) / t.cos();
    let overclosure_mm = |e: f64, t: f64| {
        let square: f64 = radius_mm * radius_mm - 2.0 * radius_mm * e * t.cos() + e * e;
        radius_mm - clearance_mm - square.sqrt()
    };
    let force_n = |e: f64| {
        const PARTS: usize = 2000;
        let part = |n: usize| {
            let t = FRAC_PI_2 * (n as f64 + 0.5) / PARTS as f64;
            let across: f64 = radius_mm * radius_mm - 2.0 * radius_mm * e * t.cos() + e * e;
            let upward = (radius_mm * t.cos() - e) / across.sqrt();
            overclosure_mm(e, t).max(0.0) / thickness_mm(t) * upward
        };
        let sum: f64 = (0..PARTS).map(part).sum();
        2.0 * sum * FRAC_PI_2 / PARTS as f64 * radius_mm * width_mm * modulus_mpa
    };
    let bisected = |mut low: f64, mut high: f64, is_low: &dyn Fn(f64) -> bool| {
        for _ in 0..100 {
            let middle = f64::midpoint(low, high);
            if is_low(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    };
    let e = bisected(clearance_mm, 2.0, &|e| force_n(e) < load_n);
    let half_angle = bisected(0.0, 1.5, &|t| overclosure_mm(e, t) > 0.0);
    let peak_mpa = modulus_mpa / 6.0 * overclosure_mm(e, 0.0);
    let area_mm2 = 2.0 * half_angle * radius_mm * width_mm;
    let row = rows(&march).last().unwrap();
    let (peak, area) = (
        row.peak_pressure_mpa / peak_mpa,
        row.contact_area_mm2 / area_mm2,
    );
    assert!((peak - 1.0).abs() < 0.005, "{peak}");
    assert!((area - 1.0).abs() < 0.01, "{area}");
}

#[test]
fn verify_activities_of_a_machine_wear_by_their_shares() {
    let machine = |path: &str, load_n: f64| {
        format!(
            "tests = \"specimen\"\n[[{path}.joints]]\nname = \"x\"\nkind = \"translation\"\naxis = [1, 0, 0]\n\
             drive = \"prescribed\"\nzeroed = false\nsettling = \"held\"\n[{path}.joints.motion]\n\
             knots_mm = [[0, 5], [50, -5]]\n[[{path}.joints]]\nname = \"press\"\nkind = \"translation\"\n\
             axis = [0, -1, 0]\ndrive = \"loaded\"\n[{path}.joints.load]\nknots_n = [[0, {load_n}]]\n"
        )
    };
    let text = format!(
        "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\nedge_mm = 0.8\nlayers = 2\n[wear]\nlaw = \"archard\"\n\
         {ONE_UPDATE}[machine]\n{}[[activity]]\nname = \"light\"\nshare = 0.75\n[[activity]]\nname = \"heavy\"\nshare = 0.25\n{}",
        machine("machine", 70.0),
        machine("activity", 210.0)
    );
    let (case, march) = finished(&text);
    let factor = case.wear.constant("wear_factor_mm3_per_nm").unwrap();
    // A line of 10 mm there and back; the mean load is 0.75 x 70 N + 0.25 x 210 N.
    let work_nm = 105.0 * 20.0 / 1000.0;
    let found = march.state().updates[0].volume_loss_mm3 / (factor * work_nm);
    assert!((found - 1.0).abs() < 1e-3, "{found}");
}

/// Slides a ball on a deformable flat; `contact` are keys of `[contact]`.
fn ball_slid(contact: &str, cycles: u32, updates: u32) -> March {
    let text = format!(
        "[femur]\nshape = \"sphere\"\nradius_mm = 24.0\n[insert]\nshape = \"flat\"\nedge_mm = 2.0\nlayers = 3\n\
         [contact]\nmodel = \"deformable\"\n{contact}[wear]\nlaw = \"archard\"\n[time]\nincrements = 40\n\
         [march]\ncycles = {cycles}\nupdates = {updates}\n[machine]\ntests = \"specimen\"\n\
         [[machine.joints]]\nname = \"x\"\nkind = \"translation\"\naxis = [1, 0, 0]\ndrive = \"prescribed\"\n\
         settling = \"held\"\n[machine.joints.motion]\nknots_mm = [[0, 3], [50, -3]]\n\
         [[machine.joints]]\nname = \"press\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n\
         [machine.joints.load]\nknots_n = [[0, 500]]\n"
    );
    finished(&text).1
}

#[test]
fn stick_slip_without_friction_is_sliding_without_friction() {
    let volume_mm3 = |model: &str| {
        let march = ball_slid(&format!("friction = 0.0\n{model}"), 500_000, 1);
        march.state().updates[0].volume_loss_mm3
    };
    let stick_slip = "[contact.deformable]\nfriction_model = \"stick-slip\"\n";
    assert_eq!(volume_mm3(stick_slip), volume_mm3(""));
}

/// The final cycle of a test is on the surface on which the next update of a longer test starts: it has the same stress.
#[test]
fn the_stress_of_the_final_cycle_is_that_of_the_worn_surface() {
    let (short, long) = (ball_slid("", 500_000, 1), ball_slid("", 1_000_000, 2));
    let updates = &long.state().updates;
    let [unworn, worn] = [0, 1].map(|update| updates[update].peaks.under_surface.unwrap());
    let end = short.state().final_cycle.unwrap().under_surface.unwrap();
    assert!(
        unworn.max_shear_mpa > 1.03 * worn.max_shear_mpa,
        "{unworn:?} {worn:?}"
    );
    assert!(
        (end.max_shear_mpa / worn.max_shear_mpa - 1.0).abs() < 1e-6,
        "{end:?} {worn:?}"
    );
    let fields = short.state().under_surface.as_ref().unwrap();
    let largest_mpa = fields.max_shear_mpa.iter().copied().fold(0.0, f64::max);
    assert_eq!(largest_mpa, end.max_shear_mpa);
}
