//! Constants of wear laws from weighings: found again where they are known.

use std::fmt::Write;

use serde_json::Value;

use crate::bench::{Bench, SMALL};
use crate::measured::close;

const TABLE: &str = "[gravimetric]\nfile = \"masses.csv\"\n";
const KNOWN: f64 = 4.1e-7;
const ASSUMED: f64 = 2.64e-7;

/// A small case, run, with increments enough for what it wears to follow the wear factor smoothly.
fn with_factor(factor: f64) -> Bench {
    let case = SMALL.replace("increments = 50", "increments = 100");
    let bench = Bench::with_case(&format!(
        "{case}[wear]\nwear_factor_mm3_per_nm = {factor:e}\n"
    ));
    bench.run_into("out");
    bench
}

/// Masses of two specimens around what a run with the known factor loses.
fn masses_of(bench: &Bench, spread_mg: f64) -> String {
    let run = bench.table("out", "wear.csv");
    let mut text = String::from("cycles,k1_mg,k2_mg\n0,21000,21000\n");
    for (cycles, mass) in run["cycles"].iter().zip(&run["mass_loss_mg"]) {
        let apart = spread_mg * cycles / 1e6;
        let (one, other) = (21_000.0 - mass - apart, 21_000.0 - mass + apart);
        writeln!(text, "{cycles},{one},{other}").unwrap();
    }
    text
}

fn calibrated(bench: &Bench) -> Value {
    let said = bench.say(&["calibrate-wear", "out", "measured.toml", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    serde_json::from_str(&said.out).expect("it prints JSON and nothing else")
}

#[test]
fn verify_the_factor_of_another_run_is_found_from_its_masses() {
    let bench = with_factor(ASSUMED);
    bench.write("masses.csv", &masses_of(&with_factor(KNOWN), 0.5));
    bench.write("measured.toml", TABLE);
    let json = calibrated(&bench);
    close(&json["wear_factor_mm3_per_nm"], KNOWN, 1.5e-3 * KNOWN);
    close(&json["run_with_mm3_per_nm"], 2.64e-7, 0.0);
    let ends = &json["wear_factor_interval_mm3_per_nm"];
    let (low, high) = (
        ends["low"].as_f64().unwrap(),
        ends["high"].as_f64().unwrap(),
    );
    assert!(low < KNOWN && KNOWN < high, "{low} {high}");
    let rates = &json["interval_mg_per_million_cycles"];
    let (slow, fast) = (
        rates["low"].as_f64().unwrap(),
        rates["high"].as_f64().unwrap(),
    );
    // Nearly in proportion: the interval of the factor is as wide as that of the rate.
    assert!(
        ((high / low) / (fast / slow) - 1.0).abs() < 0.1,
        "{low} {high} {slow} {fast}"
    );
    assert!(json["trials"].as_array().unwrap().len() >= 4);
}

#[test]
fn verify_the_calibrated_case_wears_at_the_measured_rate() {
    let bench = with_factor(ASSUMED);
    bench.write(
        "masses.csv",
        "cycles,k_mg\n0,900\n1e6,875\n3e6,825\n5e6,775\n",
    );
    bench.write("measured.toml", TABLE);
    let factor = calibrated(&bench)["wear_factor_mm3_per_nm"]
        .as_f64()
        .unwrap();
    let again = with_factor(factor);
    again.write(
        "masses.csv",
        "cycles,k_mg\n0,900\n1e6,875\n3e6,825\n5e6,775\n",
    );
    again.write("measured.toml", TABLE);
    let said = again.say(&["compare", "out", "measured.toml", "--json"]);
    let json: Value = serde_json::from_str(&said.out).unwrap();
    close(
        &json["gravimetric"]["predicted"]["mg_per_million_cycles"],
        25.0,
        0.025,
    );
}

#[test]
fn the_interval_may_count_specimens_instead_of_weighings() {
    let bench = with_factor(ASSUMED);
    bench.write("masses.csv", &masses_of(&with_factor(KNOWN), 0.05));
    bench.write(
        "measured.toml",
        &format!("{TABLE}interval = \"specimens\"\n"),
    );
    let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for words in [
        "mean of the specimens",
        "archard wears",
        "95 % interval",
        "[wear] wear_factor_mm3_per_nm =",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
    assert!(said.err.contains("mg per million cycles"), "{}", said.err);
}

#[test]
fn what_cannot_be_calibrated_is_said() {
    let bench = with_factor(ASSUMED);
    let refuses = |masses: &str, code: i32, expected: &[&str]| {
        bench.write("masses.csv", masses);
        bench.write("measured.toml", TABLE);
        let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
        said.assert_refused(code, expected);
    };
    refuses(
        "cycles,k_mg\n0,900\n1e6,901\n2e6,902\n3e6,903\n",
        2,
        &["the measured wear rate is -1.000", "soak controls"],
    );
    refuses(
        "cycles,k_g\n0,900\n",
        2,
        &["does not end with the unit of a mass"],
    );
    let heavy = "cycles,k_mg\n0,90000\n1e6,81000\n2e6,72000\n3e6,63000\n";
    refuses(heavy, 3, &["with wear_factor_mm3_per_nm = ", "update"]);
    bench.write("measured.toml", "[kinematics]\nfile = \"motion.csv\"\n");
    bench.write("motion.csv", "percent,ap_mm\n0,1\n8,2\n");
    let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
    said.assert_refused(2, &["no [gravimetric] table"]);
    let unworn = with_factor(0.0);
    unworn.write(
        "masses.csv",
        "cycles,k_mg\n0,900\n1e6,890\n2e6,880\n3e6,870\n",
    );
    unworn.write("measured.toml", TABLE);
    let said = unworn.say(&["calibrate-wear", "out", "measured.toml"]);
    said.assert_refused(2, &["the run wears nothing", "give it one above 0"]);
}

/// Weighings of one specimen that loses this much in a million cycles.
fn losing(bench: &Bench, mg_per_million_cycles: f64) {
    let weighed = |millions: f64| 9e4 - mg_per_million_cycles * millions;
    let rows = [0.0, 1.0, 2.0, 5.0].map(|m| format!("{},{}\n", 1e6 * m, weighed(m)));
    bench.write("masses.csv", &format!("cycles,k_mg\n{}", rows.concat()));
    bench.write("measured.toml", TABLE);
}

#[test]
fn a_case_in_the_folder_that_is_none_any_more_is_refused_with_its_place() {
    let bench = with_factor(ASSUMED);
    losing(&bench, 25.0);
    let case = std::fs::read_to_string(bench.path("out/case.toml")).unwrap();
    let refuses = |was: &str, is: &str, expected: &[&str]| {
        assert!(case.contains(was), "{was} is not in {case}");
        bench.write("out/case.toml", &case.replace(was, is));
        let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
        said.assert_refused(2, expected);
    };
    refuses(
        "increments = 100",
        "incremints = 100",
        &["`incremints`", "case.toml"],
    );
    refuses(
        "shape = \"generic\"",
        "shape = \"mesh\"\nfile = \"gone.stl\"",
        &["gone.stl"],
    );
}

#[test]
fn a_table_of_masses_that_the_run_did_not_write_leads_astray_no_further_than_a_run() {
    let bench = with_factor(ASSUMED);
    bench.write("masses.csv", &masses_of(&with_factor(KNOWN), 0.5));
    bench.write("measured.toml", TABLE);
    let run = std::fs::read_to_string(bench.path("out/wear.csv")).unwrap();
    // A table that claims ten times the mass: the first step takes the factor for far too large.
    let claimed = |line: &str| {
        let mut columns: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(mass) = columns[1].parse::<f64>() {
            columns[1] = (10.0 * mass).to_string();
        }
        columns.join(",") + "\n"
    };
    bench.write(
        "out/wear.csv",
        &run.lines().map(claimed).collect::<String>(),
    );
    let json = calibrated(&bench);
    close(&json["wear_factor_mm3_per_nm"], KNOWN, 2e-3 * KNOWN);
}

/// A small case by the law of Kang that wears `times` as much as by its defaults, on a dish of that radius, run into
/// `out`.
fn by_kang(times: f64, coronal_radius_mm: f64) -> Bench {
    let level = -13.1 + times.ln();
    let case = SMALL.replace("increments = 50", "increments = 100");
    let case = case.replace(
        "[insert]\n",
        &format!("[insert]\ncoronal_radius_mm = {coronal_radius_mm}\n"),
    );
    let bench = Bench::with_case(&format!(
        "{case}[wear]\nlaw = \"kang\"\nlog_wear_factor = {level}\n"
    ));
    bench.run_into("out");
    bench
}

/// A bench with a run by Kang's law on two dishes, and the masses of specimens by a law that wears 1.5 times as much.
fn two_tests() -> Bench {
    let bench = by_kang(1.0, 30.0);
    let flatter = by_kang(1.0, 35.0);
    bench.write(
        "flatter.toml",
        &std::fs::read_to_string(flatter.path("case.toml")).unwrap(),
    );
    let said = bench.say(&["run", "flatter.toml", "--out", "flatter"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for (name, radius) in [("masses", 30.0), ("flatter", 35.0)] {
        bench.write(
            &format!("{name}.csv"),
            &masses_of(&by_kang(1.5, radius), 0.3),
        );
    }
    let table =
        |file: &str| format!("[gravimetric]\nfile = \"{file}.csv\"\ninterval = \"specimens\"\n");
    bench.write("measured.toml", &table("masses"));
    bench.write("measured-flatter.toml", &table("flatter"));
    bench
}

const BOTH: [&str; 5] = [
    "calibrate-wear",
    "out",
    "measured.toml",
    "flatter",
    "measured-flatter.toml",
];

#[test]
fn verify_another_law_is_found_by_two_tests_and_carried_into_a_third() {
    let bench = two_tests();
    let third = by_kang(1.5, 32.0);
    let start = by_kang(1.0, 32.0);
    bench.write(
        "third.toml",
        &std::fs::read_to_string(start.path("case.toml")).unwrap(),
    );
    let said = bench.say(&[&BOTH[..], &["--predict", "third.toml", "--json"]].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let json: Value = serde_json::from_str(&said.out).unwrap();
    close(&json["times_as_much"]["value"], 1.5, 2e-3);
    let constant = &json["constants"][0];
    assert_eq!(constant["name"], "log_wear_factor");
    close(&constant["value"], -13.1 + 1.5f64.ln(), 2e-3);
    assert_eq!(json["degrees_of_freedom"], 3);
    let prediction = &json["predictions"][0];
    let truth = *third.table("out", "wear.csv")["mass_loss_mg"]
        .last()
        .unwrap();
    close(&prediction["mass_loss_mg"], truth, 3e-3 * truth);
    // All rates rise alike with the level, so that the mass is as sure as the mean of four specimens: Student's t of
    // three degrees of freedom at 97.5 %, over the root of four.
    let interval = &prediction["interval_mg"];
    let wide = interval["high"].as_f64().unwrap() - interval["low"].as_f64().unwrap();
    let scatter = json["scatter_percent"].as_f64().unwrap() / 100.0;
    let exact = 2.0 * 3.182_446 * scatter / 2.0 * truth;
    assert!((wide / exact - 1.0).abs() < 0.1, "{wide} {exact}");
}

#[test]
fn what_several_tests_cannot_tell_is_said() {
    let bench = two_tests();
    let refuses =
        |arguments: &[&str], expected: &[&str]| bench.say(arguments).assert_refused(2, expected);
    refuses(&BOTH[..4], &["3 paths do not form pairs"]);
    refuses(
        &[&BOTH[..], &["--constant", "wear_factor"]].concat(),
        &["the wear law \"kang\" has no constant `wear_factor`; it has `log_wear_factor`, "],
    );
    refuses(
        &[
            &BOTH[..3],
            &[
                "--constant",
                "log_wear_factor",
                "--constant",
                "decay_per_mpa",
            ],
        ]
        .concat(),
        &["1 measured rate cannot determine 2 constants"],
    );
    bench.write(
        "measured-flatter.toml",
        "[gravimetric]\nfile = \"flatter.csv\"\n",
    );
    refuses(
        &BOTH,
        &[
            "measured-flatter.toml",
            "tests that are fitted together need one kind of interval",
        ],
    );
    let archard = with_factor(ASSUMED);
    let other = archard.path("out");
    refuses(
        &[
            "calibrate-wear",
            "out",
            "measured.toml",
            other.to_str().unwrap(),
            "measured.toml",
        ],
        &["this run has the wear law \"archard\", and the first one has \"kang\""],
    );
}

#[test]
fn one_specimen_gives_no_interval_of_specimens_and_that_is_said() {
    let bench = with_factor(ASSUMED);
    losing(&bench, 25.0);
    bench.write(
        "measured.toml",
        &format!("{TABLE}interval = \"specimens\"\n"),
    );
    let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("without an interval"), "{}", said.out);
    assert!(said.out.contains("no interval: "), "{}", said.out);
    bench.write("masses.csv", "cycles,k_mg\n0,900\n");
    let said = bench.say(&["calibrate-wear", "out", "measured.toml"]);
    said.assert_refused(2, &["weighing"]);
}
