//! Problems in and with the files that a case names.

use std::path::Path;

use condyle::machine::{Interpolation, knee};

use super::assert_shows;
use crate::case::{Case, PressureLawChoice};

/// A folder with `wave.csv` of this text, and a case that takes its flexion from it.
fn with_csv(csv: &str, extra: &str) -> Result<Case, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wave.csv"), csv).unwrap();
    let text = format!("[machine.flexion]\nfile = \"wave.csv\"\n{extra}");
    let path = folder.path().join("case.toml");
    std::fs::write(&path, text).unwrap();
    Case::read(&path).map_err(|error| error.to_string())
}

fn refused(csv: &str, extra: &str) -> String {
    with_csv(csv, extra).expect_err("something is wrong with it")
}

/// Samples of a column every 10 %.
fn samples(value: impl Fn(f64) -> f64) -> String {
    let row = |i: i32| {
        let percent = f64::from(i) * 10.0;
        format!("{percent},{}\n", value(percent))
    };
    (0..=10).map(row).collect()
}

#[test]
fn case_file_that_is_not_there_is_named() {
    let error = Case::read(Path::new("nowhere/case.toml")).unwrap_err();
    assert_shows(
        &error.to_string(),
        &["the file nowhere/case.toml cannot be read: "],
    );
    assert_eq!(error.problems()[0].line_and_column(), None);
}

#[test]
fn missing_file_shows_where_it_was_searched() {
    let text = "[femur]\nshape = \"mesh\"\nfile = \"shapes/femur.stl\"\n";
    let error = Case::parse(text, "case.toml", Path::new("cases")).unwrap_err();
    assert_shows(
        &error.to_string(),
        &[
            "`file`: there is no file cases/shapes/femur.stl",
            " 3 | file = \"shapes/femur.stl\"",
            "   :        ^^^^^^^^^^^^^^^^^^",
            "help: correct the path; it is relative to the folder of the file that names it",
        ],
    );
}

#[test]
fn missing_data_name_their_source() {
    let fetch = |file: &str| {
        let text = format!("[femur]\nshape = \"mesh\"\nfile = \"{file}\"\n");
        Case::parse(&text, "case.toml", Path::new(""))
            .unwrap_err()
            .to_string()
    };
    let advice = "fetch meshes and gait of subject DM of the Grand Challenge";
    assert_shows(
        &fetch("data/dm-knee/none.stl"),
        &["there is no file", "help: ", advice],
    );
    assert_shows(
        &fetch("data/mine/none.stl"),
        &["the comment at the top of the case names their"],
    );
}

#[test]
fn file_that_is_not_text_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wave.csv"), [0xff, 0xfe, 0x00]).unwrap();
    let text = "[machine.flexion]\nfile = \"wave.csv\"\n";
    let error = Case::parse(text, "case.toml", folder.path()).unwrap_err();
    assert_shows(&error.to_string(), &["cannot be read: ", "[case.toml:2:8]"]);
}

#[test]
fn csv_with_semicolons_and_decimal_commas_is_read() {
    let samples = samples(|percent| 0.5 * percent.min(100.0 - percent) + 0.25);
    let with_points = format!("percent,knee_deg\n{samples}");
    let with_commas = with_points.replace(',', ";").replace('.', ",");
    let [one, other] = [with_points, with_commas].map(|csv| {
        let test = with_csv(&csv, "").unwrap().build(1).unwrap().test;
        format!("{:?}", test.activities)
    });
    assert_eq!(one, other);
    // What is wrong is shown at its place as it is written.
    let shown = refused("percent;knee_deg\n0,0;100,5\n50,0;many\n99,5;800,2\n", "");
    assert_shows(
        &shown,
        &[
            "`many` in column `knee_deg`",
            "wave.csv:3:6]",
            " 3 | 50,0;many",
        ],
    );
}

#[test]
fn csv_in_another_unit_is_refused_at_its_header() {
    let shown = refused(&format!("percent,knee_rad\n{}", samples(|_| 0.0)), "");
    assert_shows(
        &shown,
        &[
            "column `knee_rad` has another unit than degrees, which is needed here",
            "wave.csv:1:9]",
            " 1 | percent,knee_rad",
            "   :         ^^^^^^^^",
            "help: let its name end with `_deg`, and give the values in degrees",
        ],
    );
}

#[test]
fn units_in_brackets_have_many_spellings() {
    for unit in ["Nm", "N m", "N\u{b7}m", "N*m"] {
        let folder = tempfile::tempdir().unwrap();
        let csv = format!("Gait cycle (%), torque [{unit}]\n{}", samples(|_| 0.0));
        std::fs::write(folder.path().join("wave.csv"), csv).unwrap();
        let text = "[machine.ie_torque]\nfile = \"wave.csv\"\n";
        let read = Case::parse(text, "case.toml", folder.path());
        assert!(read.is_ok(), "{unit}: {}", read.unwrap_err());
    }
}

#[test]
fn csv_without_header_percent_or_second_column_is_refused() {
    let shown = refused("0,1\n100,1\n", "");
    assert_shows(
        &shown,
        &["wave.csv has no header", "such as `percent,flexion_deg`"],
    );
    let shown = refused("time_s,a_deg\n0,1\n100,1\n", "");
    assert_shows(
        &shown,
        &["the first column must be the percent", "`time_s`", "^^^^^^"],
    );
    assert_shows(
        &refused("percent\n0\n50\n", ""),
        &["wave.csv has one column"],
    );
    assert_shows(
        &refused("percent,a_deg\n", ""),
        &["the waveform has no points"],
    );
}

#[test]
fn csv_column_must_be_there_and_be_chosen() {
    let csv = "percent,a_deg,b_deg\n0,1,2\n";
    let shown = refused(csv, "");
    assert_shows(
        &shown,
        &[
            "the case names none of them",
            "`column = `, one of a_deg, b_deg",
        ],
    );
    let shown = refused(csv, "column = \"c_deg\"\n");
    assert_shows(
        &shown,
        &[
            "there is no column `c_deg` in wave.csv",
            "case.toml:3:10]",
            "it has a_deg, b_deg",
        ],
    );
}

#[test]
fn csv_with_a_nan_a_word_or_a_short_row_is_refused_at_each() {
    let shown = refused("percent,a_deg\n0,1\n10,nan\n20,-\n30\n", "");
    assert_shows(
        &shown,
        &[
            "`nan` in column `a_deg` is not a finite number",
            " 3 | 10,nan",
            "   :    ^^^",
            "`-` in column `a_deg`",
            "wave.csv:4:4]",
            "`` in column `a_deg`",
            "wave.csv:5:3]",
        ],
    );
}

#[test]
fn csv_with_a_gap_or_a_step_is_refused_at_its_row() {
    let shown = refused(
        "percent,a_deg\n0,1\n10,2\n60,2\n70,1\n80,1\n90,1\n100,1\n",
        "",
    );
    assert_shows(
        &shown,
        &[
            "[machine.flexion]: the waveform has a gap from 10 % to 60 %",
            " 3 | 10,2",
            "   : ^^^^",
        ],
    );
    let drifting = format!("percent,a_deg\n{}", samples(|percent| percent / 50.0));
    let shown = refused(&drifting, "");
    assert_shows(
        &shown,
        &[
            "jumps at the end of the cycle",
            "12 | 100,2",
            "append the movement back to its start",
        ],
    );
    let shown = refused(&drifting, "remove_drift = true\n");
    let why = "its end is 2.000 from its start, more than 20 % of";
    assert_shows(&shown, &[why, "append the movement back to its start"]);
    let slight =
        |percent: f64| 10.0 * (0.02 * std::f64::consts::PI * percent).sin() + percent / 50.0;
    let drifting = format!("percent,a_deg\n{}", samples(slight));
    assert_shows(&refused(&drifting, ""), &["`remove_drift = true`"]);
    assert!(with_csv(&drifting, "remove_drift = true\n").is_ok());
    let open = "percent,a_deg\n0,1\n10,2\n20,2\n30,1\n";
    let extra = "interpolation = \"half-cosine\"\nremove_drift = true\n";
    assert_shows(&refused(open, extra), &["its points end before the cycle"]);
}

#[test]
fn files_of_other_cycles_columns_and_ranges_are_refused() {
    let part = "percent,a_deg\n0,1\n0.5,2\n1,1\n";
    let half_cosine = "interpolation = \"half-cosine\"\n";
    assert_shows(
        &refused(part, half_cosine),
        &["end at 1 % of the cycle", "from 0 to 100"],
    );
    let twice = "percent,a_deg,a_deg\n0,1,2\n50,2,3\n";
    assert_shows(
        &refused(twice, "column = \"a_deg\"\n"),
        &["`a_deg` is in its file twice"],
    );
    // A few harmonics of a narrow load swing far below zero.
    let folder = tempfile::tempdir().unwrap();
    let narrow = |percent: f64| if percent == 50.0 { 2000.0 } else { 0.0 };
    let csv = format!("percent,load_n\n{}", samples(narrow));
    std::fs::write(folder.path().join("wave.csv"), csv).unwrap();
    let text = "[machine.axial_force]\nfile = \"wave.csv\"\nlow_pass_harmonics = 3\n";
    let error = Case::parse(text, "case.toml", folder.path()).unwrap_err();
    assert_shows(
        &error.to_string(),
        &["outside its range", "the low pass, leaves the range"],
    );
}

#[test]
fn many_points_in_the_case_are_samples() {
    let interpolation = |count: u32| {
        let point = |n| format!("[{}, {}]", f64::from(n) / f64::from(count) * 100.0, n % 2);
        let points: Vec<String> = (0..count).map(point).collect();
        let text = format!("[machine.flexion]\nknots_deg = [{}]\n", points.join(", "));
        let case = Case::parse(&text, "case.toml", Path::new("")).unwrap();
        let flexion = case.machine.waveforms.get(&knee::FLEXION_MOTION).unwrap();
        flexion.interpolation()
    };
    assert_eq!(interpolation(20), Interpolation::HalfCosine);
    assert_eq!(interpolation(21), Interpolation::Spline);
}

#[test]
fn verify_scale_offset_and_low_pass_of_samples() {
    let wave = |percent: f64| (percent / 100.0 * std::f64::consts::TAU).sin();
    let csv = format!("# percent,a_deg  remark\n{}", samples(wave));
    let extra = "scale = -10.0\noffset = 3.0\nlow_pass_harmonics = 2\ninterpolation = \"spline\"\n";
    let csv = csv.replace("100,-0.00000000000000024492935982947064", "100,0");
    let case = with_csv(&csv, extra).unwrap();
    let flexion = case.machine.waveforms.get(&knee::FLEXION_MOTION).unwrap();
    for percent in [0.0, 15.0, 40.0, 77.0] {
        let error = flexion.at(percent / 100.0).0 - (3.0 - 10.0 * wave(percent));
        assert!(error.abs() < 0.02, "{percent} %: {error}");
    }
}

#[test]
fn verify_a_strain_table_is_read_back_from_its_file_and_its_case() {
    let inline = "[contact.foundation]\nlaw = \"tabulated-strain\"\nstrain_table = [[0.0, 0.0], [0.005, 5.0]]\npeak_error_percent = 4.5\n";
    let case = Case::parse(inline, "case.toml", Path::new("")).unwrap();
    assert_eq!(
        case.contact
            .law()
            .and_then(PressureLawChoice::peak_error_percent),
        Some(4.5)
    );
    let written = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
    assert_eq!(written.contact, case.contact);
    let Some(PressureLawChoice::TabulatedStrain(table)) = case.contact.law() else {
        panic!("it is a table of strain");
    };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("curve.csv"), table.to_csv()).unwrap();
    let text = "[contact.foundation]\nlaw = \"tabulated-strain\"\nstrain_table_file = \"curve.csv\"\npeak_error_percent = 4.5\n";
    let from_file = Case::parse(text, "case.toml", folder.path()).unwrap();
    assert_eq!(from_file.contact, case.contact);
    let insert = case.build(1).unwrap().test.insert;
    let foundation = case.foundation(&insert);
    let pressure = foundation.pressure.pressure(0.02, 8.0).0;
    assert!((pressure - 2.5).abs() < 1e-12, "{pressure}");
}

#[test]
fn verify_a_cup_is_as_much_softer_than_a_layer_under_the_softening_law_as_under_the_linear_one() {
    let stiffness = |law: &str, insert: &str| {
        let text = format!("[insert]\n{insert}\n[contact.foundation]\nlaw = \"{law}\"\n");
        let machine = "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[machine]\npreset = \"iso-14242-1-like\"\n";
        let case = Case::parse(&(text + machine), "case.toml", Path::new("")).unwrap();
        let insert = case.build(1).unwrap().test.insert;
        case.foundation(&insert).pressure.pressure(1e-6, 8.0).0
    };
    let cup = "shape = \"cup\"\nradius_mm = 14.1";
    let ratios =
        ["linear", "softening"].map(|law| stiffness(law, cup) / stiffness(law, "shape = \"pin\""));
    assert!((ratios[0] / ratios[1] - 1.0).abs() < 1e-6, "{ratios:?}");
    assert!((ratios[0] - 0.765).abs() < 5e-3, "{ratios:?}");
}

#[test]
fn pressure_table_may_come_from_a_file() {
    let read = |csv: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("curve.csv"), csv).unwrap();
        let text = "[contact.foundation]\nlaw = \"tabulated\"\ntable_file = \"curve.csv\"\n";
        let case = Case::parse(text, "case.toml", folder.path());
        case.map_err(|error| error.to_string())
    };
    let case = read("overclosure_mm,pressure_mpa\n0,0\n0.05,5\n").unwrap();
    let inline = "[contact.foundation]\nlaw = \"tabulated\"\ntable = [[0.0, 0.0], [0.05, 5.0]]\n";
    let same = Case::parse(inline, "case.toml", Path::new("")).unwrap();
    assert_eq!(case, same);
    let shown = read("overclosure_m,pressure_mpa\n0,0\n1,1\n").unwrap_err();
    assert_shows(
        &shown,
        &["column `overclosure_m` has another unit than mm", "^^^^^^"],
    );
    let shown = read("overclosure_mm,pressure_mpa\n0,0\n1,x\n").unwrap_err();
    assert_shows(&shown, &["`x` in column `pressure_mpa`", "curve.csv:3:3]"]);
    let shown = read("overclosure_mm,pressure_mpa\n0,0\n1,1\n2,1\n").unwrap_err();
    assert_shows(
        &shown,
        &[
            "`table_file`: point 2 of the pressure table",
            "curve.csv:4:1]",
        ],
    );
}
