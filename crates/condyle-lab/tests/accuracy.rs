//! The default case: how exact it is, what it says of that, and a march that finds its own intervals.

use condyle_results::catalogue;
use std::path::{Path, PathBuf};

use condyle_case::{
    cache::Cache,
    case::{Case, Update},
};
use condyle_lab::{Outcome, RunOptions, run_case};
use condyle_results::{ErrorEstimate, ErrorParts, Summary};

fn case(name: &str) -> Case {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    Case::read(&cases.join(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The test of the paper with the AP force in the direction of the other cases, for which the book states the errors.
fn default_case() -> Case {
    let mut case = case("knight-2007.toml");
    case.machine.settings.ap_force_sign.0 = 1.0;
    case
}

fn auto_case() -> Case {
    case("stanmore-force-auto.toml")
}

fn run(case: &Case) -> Summary {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let out: PathBuf = folder.path().join("out");
    let (resume, threads) = (false, 1);
    let options = RunOptions {
        out,
        resume,
        force: false,
        threads,
        cache: Cache::off(),
        report: true,
    };
    let outcome = run_case(case, &options, &mut |_| std::ops::ControlFlow::Continue(()));
    match outcome.unwrap_or_else(|error| panic!("{error}")) {
        Outcome::Done(summary) => *summary,
        other => panic!("{other:?}"),
    }
}

/// Mass loss and maximum depth of a case changed, without an estimate.
fn losses(mut case: Case, change: impl FnOnce(&mut Case)) -> [f64; 2] {
    case.accuracy.estimate = false;
    change(&mut case);
    let summary = run(&case);
    assert_eq!(summary.error, None);
    [
        summary[&catalogue::MASS_LOSS_MG],
        summary[&catalogue::MAX_DEPTH_MM],
    ]
}

fn updated(case: &mut Case, updates: u64) {
    match &mut case.march.update {
        Update::Fixed(fixed) => fixed.updates = updates,
        Update::Auto(_) => panic!("this case finds its updates itself"),
    }
}

/// Mass loss, maximum depth, peak pressure, contact area, AP and IE range of a case changed.
fn numbers(change: impl FnOnce(&mut Case)) -> [f64; 6] {
    let mut case = default_case();
    case.accuracy.estimate = false;
    change(&mut case);
    let summary = run(&case);
    [
        summary[&catalogue::MASS_LOSS_MG],
        summary[&catalogue::MAX_DEPTH_MM],
        summary[&catalogue::PEAK_PRESSURE_MPA],
        summary[&catalogue::PEAK_CONTACT_AREA_MM2],
        summary[&catalogue::AP_RANGE_MM],
        summary[&catalogue::IE_RANGE_DEG],
    ]
}

/// The numbers of the default case that have an error.
struct Stated {
    error: ErrorEstimate,
    numbers: [f64; 6],
}

impl Stated {
    fn by_default_case() -> Self {
        let summary = run(&default_case());
        let error = summary.error.clone();
        let error = error.expect("a case asks for it unless it says otherwise");
        assert!(error.not_estimated.is_empty() && error.wall_s > 0.0);
        assert_eq!(summary[&catalogue::PEAK_PRESSURE_CYCLE], 0.0);
        assert_eq!(
            summary[&catalogue::PEAK_CONTACT_AREA_CYCLE],
            summary[&catalogue::CYCLES]
        );
        let numbers = [
            summary[&catalogue::MASS_LOSS_MG],
            summary[&catalogue::MAX_DEPTH_MM],
            summary[&catalogue::PEAK_PRESSURE_MPA],
            summary[&catalogue::PEAK_CONTACT_AREA_MM2],
            summary[&catalogue::AP_RANGE_MM],
            summary[&catalogue::IE_RANGE_DEG],
        ];
        Self { error, numbers }
    }

    /// Holds a part of every error to what is true of it: `factor` times the change that a refinement makes.
    #[track_caller]
    fn assert_near(
        &self,
        what: &str,
        part: fn(&ErrorParts) -> Option<f64>,
        factor: f64,
        refine: impl FnOnce(&mut Case),
    ) {
        let refined = numbers(refine);
        let error = &self.error;
        let of = [
            (
                "mass",
                error.of(&catalogue::MASS_LOSS_MG).percent,
                NOISE_PERCENT,
            ),
            (
                "depth",
                error.of(&catalogue::MAX_DEPTH_MM).percent,
                NOISE_PERCENT,
            ),
            (
                "peak pressure",
                error.of(&catalogue::PEAK_PRESSURE_MPA).percent,
                NOISE_PERCENT,
            ),
            (
                "area",
                error.of(&catalogue::PEAK_CONTACT_AREA_MM2).percent,
                AREA_NOISE_PERCENT,
            ),
            (
                "AP range",
                error.of(&catalogue::AP_RANGE_MM).percent,
                NOISE_PERCENT,
            ),
            (
                "IE range",
                error.of(&catalogue::IE_RANGE_DEG).percent,
                NOISE_PERCENT,
            ),
        ];
        for ((number, parts, noise), i) in of.into_iter().zip(0..) {
            let truth = 100.0 * factor * (refined[i] / self.numbers[i] - 1.0);
            let what = format!("{number} by {what}");
            assert_within_a_factor_of_two(&what, part(parts), truth, noise);
        }
    }
}

/// Errors of less than this tell nothing: cycles repeat themselves no better, %.
const NOISE_PERCENT: f64 = 0.1;
/// The area of a worn scar is uneven by so much from one update to the next, %.
const AREA_NOISE_PERCENT: f64 = 0.5;

#[track_caller]
fn assert_within_a_factor_of_two(what: &str, found: Option<f64>, truth: f64, noise: f64) {
    let found = found.unwrap_or_else(|| panic!("{what} is not estimated"));
    let (large, small) = (found.abs().max(truth.abs()), found.abs().min(truth.abs()));
    let is_near = large <= 2.0 * small + noise && (found * truth >= 0.0 || large <= noise);
    assert!(is_near, "{what}: estimated {found:.3} %, true {truth:.3} %");
}

#[test]
fn verify_the_estimated_errors_of_the_default_case() {
    let stated = Stated::by_default_case();
    stated.assert_near(
        "increments",
        |parts| parts.increments,
        1.0,
        |case| {
            case.time.increments = 800;
        },
    );
    // Depth is of first order in the updates: a seventh of the error is left with 80 instead of 10.
    stated.assert_near(
        "updates",
        |parts| parts.updates,
        8.0 / 7.0,
        |case| {
            updated(case, 80);
        },
    );
    stated.assert_near(
        "slip tolerance",
        |parts| parts.slip_tolerance,
        2.0,
        |case| {
            case.contact.settings.slip_tolerance_mm_per_s /= 2.0;
        },
    );
    stated.assert_near(
        "mesh",
        |parts| parts.mesh,
        4.0 / 3.0,
        |case| match &mut case.insert.shape {
            condyle_case::case::InsertShape::Generic(insert) => insert.edge_mm /= 2.0,
            other => panic!("{other:?}"),
        },
    );
}

/// With the mean pressure on whole shares in place of their loaded part, the coarser mesh has 15 % more mass.
#[test]
fn verify_the_mass_by_the_default_law_on_coarser_meshes() {
    let [coarse, fine] = [2.4, 1.2].map(|edge_mm| {
        let [mass_mg, _] = losses(case("stanmore-force.toml"), |case| {
            updated(case, 2);
            case.time.increments = 100;
            match &mut case.insert.shape {
                condyle_case::case::InsertShape::Generic(insert) => insert.edge_mm = edge_mm,
                other => panic!("{other:?}"),
            }
        });
        mass_mg
    });
    assert!((coarse / fine - 1.0).abs() < 0.04, "{coarse} {fine}");
}

#[test]
fn verify_the_estimated_errors_of_updates_where_the_insert_creeps() {
    let keys = "[creep]\nlaw = \"lee-pienkowski\"\n";
    let creep = Case::parse(keys, "creep", Path::new("")).unwrap().creep;
    let creeping = || {
        let mut case = default_case();
        case.creep = creep.clone();
        case
    };
    let summary = run(&creeping());
    // Twice the updates leave a third of the error: with 80 instead of 10 a twenty-seventh of it is left.
    let truth = losses(creeping(), |case| updated(case, 80));
    assert_errors_of_updates(&summary, truth, 27.0 / 26.0);
}

#[test]
fn verify_the_estimated_errors_of_updates_in_a_cup() {
    for (name, law) in [("hip-iso.toml", "kang"), ("hip-orbital.toml", "power-law")] {
        let hip = || {
            let mut case = case(name);
            let keys = format!("[wear]\nlaw = \"{law}\"\n");
            case.wear = Case::parse(&keys, "wear", Path::new("")).unwrap().wear;
            updated(&mut case, 10);
            case
        };
        let truth = losses(hip(), |case| updated(case, 40));
        assert_errors_of_updates(&run(&hip()), truth, 1.0);
    }
}

/// Compares the estimated errors by the updates with the change to `finer` (mass and depth), which is
/// 1 / `part` of the error.
fn assert_errors_of_updates(summary: &Summary, finer: [f64; 2], part: f64) {
    let error = summary.error.as_ref().expect("the case requests it");
    for (scalar, finer) in [&catalogue::MASS_LOSS_MG, &catalogue::MAX_DEPTH_MM]
        .iter()
        .zip(finer)
    {
        let truth = 100.0 * part * (finer / summary[*scalar] - 1.0);
        let stated = error.of(scalar).percent.updates;
        assert_within_a_factor_of_two(scalar.key, stated, truth, NOISE_PERCENT);
    }
}

#[test]
fn the_default_case_states_one_percent_of_mass_and_two_of_depth() {
    let summary = run(&default_case());
    let error = summary
        .error
        .clone()
        .expect("a case asks for it unless it says otherwise");
    assert!(
        error.of(&catalogue::MASS_LOSS_MG).percent.total < 1.0,
        "{error:?}"
    );
    assert!(
        error.of(&catalogue::MAX_DEPTH_MM).percent.total < 2.0,
        "{error:?}"
    );
    let mass_mg = error.of(&catalogue::MASS_LOSS_MG).percent.total / 100.0
        * summary[&catalogue::MASS_LOSS_MG];
    assert!((error.of(&catalogue::MASS_LOSS_MG).in_unit.total / mass_mg - 1.0).abs() < 1e-9);
}

/// A shipped case; none if its meshes are not there.
fn case_with_data(name: &str) -> Option<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if name.starts_with("dm") && !root.join("../shared/data/dm-knee").is_dir() {
        eprintln!("skipped: {name}: the data of subject DM are not there");
        return None;
    }
    Some(case(name))
}

/// Holds a case with `update = "auto"` and the default tolerance to the same case with 40 updates,
/// and what it states of the error of its depth to what that tends to.
fn assert_as_deep_as_forty_updates(name: &str, most_cycles: f64, stated: fn(f64, f64) -> bool) {
    let Some(case) = case_with_data(name) else {
        return;
    };
    let [twenty, forty] =
        [20, 40].map(|updates| losses(case.clone(), |case| updated(case, updates)));
    let mut case = case;
    case.march.update = auto_case().march.update;
    let few = run(&case);
    assert!(
        // The final cycle, on the worn surface, takes 1.4 until it repeats.
        few[&catalogue::CYCLES_SOLVED] <= most_cycles + 1.4,
        "{}",
        few[&catalogue::CYCLES_SOLVED]
    );
    let depth = few[&catalogue::MAX_DEPTH_MM] / forty[1] - 1.0;
    assert!(depth.abs() < 0.01, "depth {depth}");
    let mass = few[&catalogue::MASS_LOSS_MG] / forty[0] - 1.0;
    assert!(mass.abs() < 0.005, "mass {mass}");
    let error = few
        .error
        .clone()
        .expect("a case asks for it unless it says otherwise");
    let found = error
        .of(&catalogue::MAX_DEPTH_MM)
        .percent
        .updates
        .expect("it has updates");
    let exact_mm = 2.0 * forty[1] - twenty[1];
    let truth = 100.0 * (exact_mm / few[&catalogue::MAX_DEPTH_MM] - 1.0);
    assert!(stated(found, truth), "stated {found} %, true {truth} %");
}

fn about_as_large(found: f64, truth: f64) -> bool {
    let (large, small) = (found.abs().max(truth.abs()), found.abs().min(truth.abs()));
    large <= 2.5 * small + NOISE_PERCENT
}

#[test]
fn own_intervals_are_as_deep_as_forty_updates_under_force() {
    // Six intervals are so long that the bottom is uneven; that the deepest node is right is luck.
    let no_less = |found: f64, truth: f64| found.abs() + NOISE_PERCENT >= truth.abs();
    assert_as_deep_as_forty_updates("knight-2007.toml", 8.0, no_less);
}

#[test]
fn own_intervals_are_as_deep_as_forty_updates_under_displacement() {
    assert_as_deep_as_forty_updates("stanmore-displacement.toml", 7.0, about_as_large);
}

#[test]
fn own_intervals_are_as_deep_as_forty_updates_of_a_real_knee_under_force() {
    assert_as_deep_as_forty_updates("dm-knee.toml", 11.0, about_as_large);
}

#[test]
fn own_intervals_are_as_deep_as_forty_updates_of_a_real_knee_under_displacement() {
    assert_as_deep_as_forty_updates("dm-knee-displacement.toml", 7.0, about_as_large);
}

#[test]
fn a_tighter_tolerance_takes_more_intervals_and_is_held() {
    let [forty, eighty] =
        [40, 80].map(|updates| losses(default_case(), |case| updated(case, updates)));
    let exact_mm = 2.0 * eighty[1] - forty[1];
    let mut updates = 0.0;
    for tolerance in [0.03, 0.01, 0.003, 0.001] {
        let mut case = auto_case();
        case.accuracy.estimate = false;
        match &mut case.march.update {
            Update::Auto(by_depth) => by_depth.depth_tolerance_fraction = tolerance,
            Update::Fixed(_) => panic!("this case finds its updates itself"),
        }
        let summary = run(&case);
        let off = summary[&catalogue::MAX_DEPTH_MM] / exact_mm - 1.0;
        assert!(
            summary[&catalogue::UPDATES] > updates,
            "{tolerance}: {updates} before"
        );
        assert!(off.abs() < tolerance, "{tolerance}: {off}");
        updates = summary[&catalogue::UPDATES];
    }
}

#[test]
fn what_cannot_be_estimated_says_why() {
    let mut case = default_case();
    updated(&mut case, 1);
    case.time.increments = 40;
    let error = run(&case).error.expect("the other parts can");
    assert_eq!(error.of(&catalogue::MASS_LOSS_MG).percent.updates, None);
    assert!(error.not_estimated["updates"].contains("a single update cannot be compared"));
    assert!(
        error
            .of(&catalogue::MASS_LOSS_MG)
            .percent
            .increments
            .is_some()
    );
}

#[test]
fn a_finer_run_is_within_one_and_a_half_times_the_stated_error_of_the_area() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/reproducers/second/contact-area-error");
    if !folder.exists() {
        println!("skipped: {} is not there", folder.display());
        return;
    }
    for number in [78, 110, 120] {
        let [own, finer] = ["case", "finer"].map(|word| {
            let file = folder.join(format!("{word}-{number}.toml"));
            run(&Case::read(&file).unwrap_or_else(|error| panic!("{error}")))
        });
        let area = |summary: &Summary| summary[&catalogue::PEAK_CONTACT_AREA_MM2];
        let seen = 100.0 * (area(&finer) / area(&own) - 1.0).abs();
        let error = own.error.as_ref().expect("is asked for");
        let stated = error.of(&catalogue::PEAK_CONTACT_AREA_MM2).percent.total;
        assert!(
            seen < 1.5 * stated,
            "{number}: {stated} % stated, {seen} % seen"
        );
    }
}
