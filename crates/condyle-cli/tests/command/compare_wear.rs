//! Weighed wear: exact lines, a known uptake of the soak controls.

use std::fmt::Write;

use crate::bench::Bench;
use crate::measured::{assert_refused, close, compared, measured_bench};

const TABLE: &str = "[gravimetric]\nfile = \"masses.csv\"\n";

/// What a soak control gains, mg: fast at first.
fn uptake(millions: f64) -> f64 {
    1.7 * millions.sqrt()
}

/// Specimens that lose `rates` mg per million cycles and gain what the soak control gains.
fn masses(rates: &[f64]) -> String {
    let names: Vec<String> = (1..=rates.len())
        .map(|number| format!("k{number}_mg"))
        .collect();
    let mut text = format!("cycles,{},soak_mg\n", names.join(","));
    for stop in 0..=10 {
        let millions = 0.5 * f64::from(stop);
        let worn = |rate: &f64| format!("{}", 21_000.0 - rate * millions + uptake(millions));
        let worn: Vec<String> = rates.iter().map(worn).collect();
        let soak = 21_500.0 + uptake(millions);
        writeln!(text, "{},{},{soak}", millions * 1e6, worn.join(",")).unwrap();
    }
    text
}

/// Rate of the prediction over the updates of the run, by hand.
fn predicted_rate(bench: &Bench) -> f64 {
    let run = bench.table("out", "wear.csv");
    let at = |millions: f64| {
        let (mut x0, mut y0) = (0.0, 0.0);
        for (cycles, mass) in run["cycles"].iter().zip(&run["mass_loss_mg"]) {
            let x = cycles / 1e6;
            if millions <= x {
                return y0 + (millions - x0) / (x - x0) * (mass - y0);
            }
            (x0, y0) = (x, *mass);
        }
        y0
    };
    let stops: Vec<f64> = (1..=10).map(|stop| 0.5 * f64::from(stop)).collect();
    let mean = stops.iter().sum::<f64>() / 10.0;
    let over = |of: &dyn Fn(f64) -> f64| stops.iter().map(|x| (x - mean) * of(*x)).sum::<f64>();
    over(&at) / over(&|x| x)
}

#[test]
fn verify_exact_lines_and_a_known_uptake() {
    let bench = measured_bench();
    bench.write("masses.csv", &masses(&[12.0, 15.0, 21.0]));
    let json = &compared(&bench, TABLE)["gravimetric"];
    for (index, rate) in [12.0, 15.0, 21.0].into_iter().enumerate() {
        let specimen = &json["specimens"][index];
        close(&specimen["mg_per_million_cycles"], rate, 1e-8);
        close(&specimen["intercept_mg"], 0.0, 1e-8);
        close(&specimen["r_squared"], 1.0, 1e-12);
        close(
            &specimen["interval_mg_per_million_cycles"]["low"],
            rate,
            1e-6,
        );
    }
    close(&json["weighings"][10]["soak_gain_mg"], uptake(5.0), 1e-9);
    close(&json["weighings"][10]["loss_mg"][1], 75.0, 1e-9);
    close(&json["all"]["mg_per_million_cycles"], 16.0, 1e-8);
    close(
        &json["mean_of_specimens"]["mg_per_million_cycles"],
        16.0,
        1e-8,
    );
    // Standard deviation of 12, 15 and 21 is the root of 21; t of two degrees of freedom.
    let half = 4.302_652_73 * (21.0f64 / 3.0).sqrt();
    let interval = &json["mean_of_specimens"]["interval_mg_per_million_cycles"];
    close(&interval["high"], 16.0 + half, 1e-6);
    close(
        &json["range_of_specimens_mg_per_million_cycles"]["low"],
        12.0,
        1e-8,
    );
    close(
        &json["range_of_specimens_mg_per_million_cycles"]["high"],
        21.0,
        1e-8,
    );
    assert_eq!(json["soak_controls"], 1);
}

#[test]
fn verify_the_prediction_has_the_same_regression_at_the_same_cycles() {
    let bench = measured_bench();
    let rate = predicted_rate(&bench);
    bench.write("masses.csv", &masses(&[0.9 * rate, 1.1 * rate]));
    let json = &compared(&bench, TABLE)["gravimetric"];
    close(&json["predicted"]["mg_per_million_cycles"], rate, 1e-9);
    close(&json["predicted_above_measured_percent"], 0.0, 1e-6);
    assert_eq!(json["inside_range_of_specimens"], true);
    assert_eq!(json["inside_interval_of_weighings"], true);
    assert_eq!(json["inside_interval_of_specimens"], true);
    bench.write(
        "masses.csv",
        &masses(&[0.5 * rate, 0.6 * rate, 0.55 * rate]),
    );
    let json = &compared(&bench, TABLE)["gravimetric"];
    assert_eq!(json["inside_range_of_specimens"], false);
    assert_eq!(json["inside_interval_of_weighings"], false);
    close(
        &json["predicted_above_measured_percent"],
        100.0 / 0.55 - 100.0,
        1e-6,
    );
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(
        said.out.contains("OUTSIDE the range of the specimens"),
        "{}",
        said.out
    );
}

#[test]
fn one_specimen_without_soak_control_is_compared_and_said_to_be_so() {
    let bench = measured_bench();
    let alone = "cycles,k_mg\n0,900\n1e6,890\n2e6,879\n3e6,871\n";
    bench.write("masses.csv", alone);
    let json = &compared(&bench, TABLE)["gravimetric"];
    assert!(json["inside_interval_of_specimens"].is_null());
    assert!(json["mean_of_specimens"]["interval_mg_per_million_cycles"].is_null());
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(
        said.out.contains("not corrected: there is no soak control"),
        "{}",
        said.out
    );
    let svg = std::fs::read_to_string(bench.path("out/compare/compare_wear.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Mass loss"));
}

#[test]
fn weighings_after_the_end_of_the_run_are_left_out_of_its_line() {
    let bench = measured_bench();
    bench.write(
        "masses.csv",
        "cycles,k_mg,control_mg\n0,900,900\n2e6,880,901\n4e6,860,902\n6e6,780,903\n",
    );
    let json = &compared(&bench, TABLE)["gravimetric"];
    assert!(json["weighings"][3]["predicted_loss_mg"].is_null());
    // Over the same cycles as the predicted rate, without the faster wear later.
    close(&json["specimens"][0]["mg_per_million_cycles"], 10.0, 1e-9);
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(
        said.out.contains("the run ends before 1 of the weighings")
            && said
                .out
                .contains("control gains mass: if it is a soak control"),
        "{}",
        said.out
    );
    bench.write(
        "masses.csv",
        "cycles,k_mg\n0,900\n4e6,880\n6e6,860\n8e6,840\n",
    );
    assert_refused(
        &bench,
        TABLE,
        &["the run ends before the second weighing", "it reaches 1"],
    );
}

#[test]
fn bad_masses_are_refused_with_their_place() {
    let bench = measured_bench();
    let refuses = |csv: &str, expected: &[&str]| {
        bench.write("masses.csv", csv);
        assert_refused(&bench, TABLE, expected);
    };
    let rows = "0,99,99\n1,98,99\n2,97,99\n3,96,99\n";
    refuses(
        &format!("time,k_mg,soak_mg\n{rows}"),
        &["must be `cycles`, this one is `time`", "masses.csv:1:1"],
    );
    refuses(
        &format!("cycles,k_g,soak_mg\n{rows}"),
        &["`k_g` does not end with the unit of a mass", "`_mg`"],
    );
    refuses(
        &format!("cycles,k_mg,k_mg\n{rows}"),
        &["the column `k_mg` is in its file twice"],
    );
    refuses(
        &format!("cycles,soak1_mg,soak2_mg\n{rows}"),
        &["every column of masses.csv is a soak control"],
    );
    refuses(
        "cycles,k_mg\n0,99\n2,98\n1,97\n3,96\n",
        &["`cycles` is 1, after 2", "masses.csv:4:1"],
    );
    refuses(
        "cycles,k_mg\n-1,99\n2,98\n3,97\n4,96\n",
        &["`cycles` is -1: it must be 0 or more"],
    );
    refuses(
        "cycles,k_mg\n0,99\n1,-8\n2,97\n3,96\n",
        &["`k_mg` is -8: it must be a mass", "masses.csv:3:3"],
    );
    refuses(
        "cycles,k_mg\n0,99\n1,\n2,97\n3,96\n",
        &["`` in column `k_mg` is not a finite number"],
    );
    refuses(
        "cycles,k_mg\n0,99\n1,98\n2,97\n",
        &["2 weighings remain for the line", "fit_from_cycles"],
    );
    refuses(
        "cycles;k_mg\n0;9000\n250.000;8995\n500.000;8990\n750.000;8985\n",
        &[
            "the weighings end at 750 cycles",
            "without thousands separators",
        ],
    );
    refuses(
        "cycles\n0\n1\n",
        &["has one column where two or more are needed"],
    );
}

#[test]
fn a_bad_table_of_weighings_is_refused_with_its_place() {
    let bench = measured_bench();
    bench.write("masses.csv", &masses(&[12.0]));
    let refuses = |rest: &str, expected: &[&str]| {
        assert_refused(&bench, &format!("{TABLE}{rest}"), expected);
    };
    refuses(
        "soak_controls = [\"dry_mg\"]\n",
        &[
            "no column `dry_mg` in masses.csv",
            "measured.toml:3:17",
            "k1_mg, soak_mg",
        ],
    );
    refuses(
        "soak_controls = \"soak_mg\"\n",
        &["`soak_controls` must be a list of names in quotes"],
    );
    refuses(
        "confidence_percent = 100\n",
        &["outside its range", "50 to 99.99"],
    );
    refuses(
        "fit_from_cycles = 4e6\nfit_from = 1\n",
        &["has no key `fit_from`", "the keys here are file"],
    );
    refuses(
        "fit_from_cycles = 4.6e6\n",
        &["1 weighings remain for the line"],
    );
    std::fs::remove_file(bench.path("out/wear.csv")).unwrap();
    refuses("", &["wear.csv: there is no such file", "[gravimetric]"]);
}

#[test]
fn rates_of_another_unit_are_remarked_on() {
    let bench = measured_bench();
    let remarks = |rates: &[f64]| {
        bench.write("masses.csv", &masses(rates));
        compared(&bench, TABLE)["remarks"].to_string()
    };
    let predicted = predicted_rate(&bench);
    let words = "check that the masses are in mg";
    assert!(remarks(&[100.0 * predicted]).contains(words));
    assert!(remarks(&[predicted / 100.0]).contains(words));
    assert!(!remarks(&[5.0 * predicted]).contains(words));
    bench.write("masses.csv", &masses(&[12.0]).replace(",21", ",21000"));
    assert_refused(&bench, TABLE, &["a mass of 50 mg to 1 kg"]);
}
