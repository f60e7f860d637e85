//! Measured kinematics: predicted plus a difference that is known.

use std::f64::consts::{SQRT_2, TAU};
use std::fmt::Write;

use crate::bench::Bench;
use crate::measured::{assert_refused, close, compared, measured_bench};

const OFFSET: f64 = 0.3;
const SINE: f64 = 0.5;

/// AP as the run has it in a cycle, plus an offset and a sine over the cycle.
fn shifted(bench: &Bench, cycle: usize, keep: impl Fn(f64) -> bool) -> String {
    let run = bench.table("out", "kinematics.csv");
    let instants = 50;
    let mut text = String::from("percent,ap_mm\n");
    let rows = run["percent"].iter().zip(&run["ap_mm"]);
    for (percent, value) in rows.skip(cycle * instants).take(instants) {
        if keep(*percent) {
            writeln!(text, "{percent},{}", value + difference(*percent)).unwrap();
        }
    }
    text
}

fn difference(percent: f64) -> f64 {
    OFFSET + SINE * (percent / 100.0 * TAU).sin()
}

#[test]
fn verify_errors_of_an_offset_and_a_sine() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |_| true));
    let json = compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n");
    let ap = &json["kinematics"]["columns"][0];
    let percents = || (1..=50).map(|instant| 2.0 * f64::from(instant));
    let absolute: f64 = percents().map(|percent| difference(percent).abs()).sum();
    assert_eq!(ap["column"], "ap_mm");
    close(&ap["mean_difference"], -OFFSET, 1e-12);
    close(&ap["errors"]["mean_absolute"], absolute / 50.0, 1e-12);
    close(
        &ap["errors"]["rms"],
        (OFFSET * OFFSET + SINE * SINE / 2.0).sqrt(),
        1e-12,
    );
    close(&ap["errors"]["largest"], -difference(24.0), 1e-12);
    let at = ap["errors"]["largest_at_percent"].as_f64().unwrap();
    assert!(at == 24.0 || at == 26.0, "{at}");
    assert_eq!((&ap["compared"], &ap["instants"]), (&50.into(), &50.into()));
}

#[test]
fn verify_errors_by_phase_are_those_of_its_instants() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |_| true));
    let phases = "[kinematics.phases_percent]\n\"first third\" = [0, 33]\nswing = [60, 100]\n";
    let json = compared(
        &bench,
        &format!("[kinematics]\nfile = \"motion.csv\"\n{phases}"),
    );
    let phases = &json["kinematics"]["columns"][0]["phases"];
    // 0 to 32 %, where the end of the cycle stands for its start.
    let instants = || (0..=16).map(|instant| difference(2.0 * f64::from(instant)));
    assert_eq!(phases[0]["phase"], "first third");
    let absolute = instants().map(f64::abs).sum::<f64>() / 17.0;
    close(&phases[0]["errors"]["mean_absolute"], absolute, 1e-12);
    let square = instants().map(|d| d * d).sum::<f64>() / 17.0;
    close(&phases[0]["errors"]["rms"], square.sqrt(), 1e-12);
    assert_eq!(phases[1]["start_percent"], 60.0);
    let bare = compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n");
    let names: Vec<&str> = (0..5)
        .map(|i| {
            bare["kinematics"]["columns"][0]["phases"][i]["phase"]
                .as_str()
                .unwrap()
        })
        .collect();
    assert_eq!(
        names,
        [
            "loading response",
            "mid stance",
            "terminal stance",
            "pre-swing",
            "swing"
        ]
    );
}

#[test]
fn verify_alignment_takes_the_offset_out_and_says_so() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 1, |_| true));
    let measured = "[kinematics]\nfile = \"motion.csv\"\ncycle = \"last\"\nalign = \"mean\"\n";
    let json = compared(&bench, measured);
    let ap = &json["kinematics"]["columns"][0];
    assert_eq!(json["kinematics"]["align"], "mean");
    close(&ap["mean_difference"], -OFFSET, 1e-12);
    close(&ap["errors"]["rms"], SINE / SQRT_2, 1e-12);
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(said.out.contains("last cycle"), "{}", said.out);
    assert!(
        said.out.contains("the mean difference is subtracted"),
        "{}",
        said.out
    );
}

#[test]
fn what_was_not_measured_is_not_compared() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |percent| percent < 60.0));
    let json = compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n");
    let ap = &json["kinematics"]["columns"][0];
    assert_eq!(ap["compared"], 29);
    assert!(ap["phases"][4]["errors"].is_null());
    let said = bench.say(&["compare", "out", "measured.toml"]);
    assert!(said.out.contains("not measured"), "{}", said.out);
    assert!(
        said.out.contains("measured at 29 of 50 instants"),
        "{}",
        said.out
    );
}

#[test]
fn verify_missing_points_are_bridged_by_straight_lines() {
    let bench = measured_bench();
    // Every second of the instants, and an empty cell.
    let text = shifted(&bench, 0, |percent| percent % 4.0 == 0.0);
    let emptied = |line: &str| match line.starts_with("40,") {
        true => "40,\n".to_owned(),
        false => format!("{line}\n"),
    };
    bench.write("motion.csv", &text.lines().map(emptied).collect::<String>());
    let json = compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n");
    let ap = &json["kinematics"]["columns"][0];
    assert_eq!(ap["compared"], 50);
    close(
        &ap["errors"]["rms"],
        (OFFSET * OFFSET + SINE * SINE / 2.0).sqrt(),
        0.05,
    );
}

#[test]
fn a_picture_and_a_table_come_with_it() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |_| true));
    compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n");
    let svg = std::fs::read_to_string(bench.path("out/compare/compare_kinematics.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("measured") && !svg.contains("NaN"));
    let said = bench.say(&["compare", "out", "measured.toml", "--out", "elsewhere"]);
    assert!(said.out.contains("swing 60-100 %"), "{}", said.out);
    assert!(bench.path("elsewhere/compare.json").is_file());
}

#[test]
fn bad_motions_are_refused_with_their_place() {
    let bench = measured_bench();
    let toml = "[kinematics]\nfile = \"motion.csv\"\n";
    let refuses = |csv: &str, expected: &[&str]| {
        bench.write("motion.csv", csv);
        assert_refused(&bench, toml, expected);
    };
    refuses(
        "percent,ap_cm\n0,1\n50,2\n",
        &[
            "no column `ap_cm`",
            "motion.csv:1:9",
            "^^^",
            "did you mean `ap_mm`",
        ],
    );
    refuses(
        "percent,speed\n0,1\n50,2\n",
        &["no column `speed`", "remove it, or name it one of"],
    );
    refuses(
        "time,ap_mm\n0,1\n50,2\n",
        &[
            "must be `percent`, this one is `time`",
            "put `percent` first",
        ],
    );
    refuses(
        "percent,ap_mm,ap_mm\n0,1,2\n5,1,2\n",
        &["the column `ap_mm` is in its file twice", "its own name"],
    );
    refuses(
        "percent,ap_mm\n0,1\n0,2\n",
        &["`percent` is 0, after 0", "motion.csv:3:1", "sort the rows"],
    );
    refuses(
        "percent,ap_mm\n0,1\n101,2\n",
        &[
            "`percent` is 101: it must be 0 to 100",
            "correct the number",
        ],
    );
    refuses(
        "percent,ap_mm\n0,1\n0.5,2\n1,1\n",
        &[
            "the points end at 1 % of the cycle",
            "motion.csv:1:1",
            "percent from 0 to 100",
        ],
    );
    refuses(
        "percent,ap_mm\n0,one\n",
        &[
            "`one` in column `ap_mm`",
            "motion.csv:2:3",
            "write a number there",
        ],
    );
    refuses(
        "percent,ap_mm\n0,1\n5,two\n",
        &["`two` in column `ap_mm`", "motion.csv:3:3"],
    );
    refuses(
        "percent,ap_mm\n0,1\n5,\n",
        &["`ap_mm` has 1 numbers where 2 are needed", "add rows"],
    );
    refuses(
        "percent,ap_mm\n1,1\n51,2\n",
        &[
            "error: the measured points of `ap_mm`",
            "largest_gap_percent",
        ],
    );
}

#[test]
fn a_bad_table_of_kinematics_is_refused_with_its_place() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |_| true));
    let refuses = |rest: &str, expected: &[&str]| {
        assert_refused(
            &bench,
            &format!("[kinematics]\nfile = \"motion.csv\"\n{rest}"),
            expected,
        );
    };
    refuses(
        "cicle = \"last\"\n",
        &[
            "[kinematics] has no key `cicle`",
            "measured.toml:3:1",
            "`cycle`",
        ],
    );
    refuses(
        "cycle = \"second\"\n",
        &["`cycle` cannot be \"second\"", "\"first\" or \"last\""],
    );
    refuses(
        "largest_gap_percent = 0\n",
        &["outside its range", "0.1 to 100"],
    );
    refuses(
        "[kinematics.phases_percent]\nswing = [60, 50]\n",
        &[
            "the phase `swing` is [60.0, 50.0]",
            "measured.toml:4:9",
            "mid stance",
        ],
    );
    assert_refused(&bench, "[kinematics]\n", &["[kinematics] needs `file`"]);
    assert_refused(
        &bench,
        "[kinematics]\nfile = \"no.csv\"\n",
        &["there is no file", "no.csv", "correct the path"],
    );
    assert_refused(
        &bench,
        "",
        &["names no measured data", "add one of [kinematics]"],
    );
    assert_refused(&bench, "[wear]\n", &["has no key `wear`"]);
    assert_refused(&bench, "[kinematics\n", &["this is not TOML"]);
}

#[test]
fn what_a_results_folder_lacks_is_said() {
    let bench = measured_bench();
    bench.write("motion.csv", &shifted(&bench, 0, |_| true));
    let toml = "[kinematics]\nfile = \"motion.csv\"\n";
    bench.write("out/kinematics.csv", "cycles,percent,ie_deg\n0,2,1\n");
    assert_refused(
        &bench,
        toml,
        &["the run has no column `ap_mm`", "or name it one of ie_deg"],
    );
    std::fs::remove_file(bench.path("out/kinematics.csv")).unwrap();
    assert_refused(
        &bench,
        toml,
        &["kinematics.csv: there is no such file", "[kinematics]"],
    );
    bench.write("measured.toml", toml);
    let said = bench.say(&["compare", "nowhere", "measured.toml"]);
    said.assert_refused(2, &["There is no folder nowhere"]);
    let said = bench.say(&["compare", "out", "nowhere.toml"]);
    said.assert_refused(2, &["nowhere.toml", "cannot be read"]);
}

#[test]
fn motions_of_another_unit_or_sign_are_remarked_on() {
    let bench = measured_bench();
    let run = bench.table("out", "kinematics.csv");
    let remarks = |factor: f64| {
        let mut text = String::from("percent,flexion_deg\n");
        for (percent, value) in run["percent"].iter().zip(&run["flexion_deg"]).take(50) {
            writeln!(text, "{percent},{}", factor * value).unwrap();
        }
        bench.write("motion.csv", &text);
        compared(&bench, "[kinematics]\nfile = \"motion.csv\"\n")["remarks"].to_string()
    };
    let (unit, sign) = (
        "check that the measured values have the unit",
        "check its sign",
    );
    assert!(!remarks(1.2).contains(unit) && !remarks(1.2).contains(sign));
    assert!(
        remarks(0.017_453_3).contains(unit),
        "{}",
        remarks(0.017_453_3)
    );
    assert!(remarks(-1.0).contains(sign) && !remarks(-1.0).contains(unit));
}
