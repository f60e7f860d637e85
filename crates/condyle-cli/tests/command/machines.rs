//! Machines by joints at the command: their list, their files, their reports.

use std::fs;

use condyle_mesh::{TriangleMesh, formats::write_stl};

use crate::bench::{Bench, SMALL};

const ORBITAL: &str = "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n\
                       [insert]\nshape = \"cup\"\nedge_mm = 2.5\nlayers = 2\n\
                       [machine]\npreset = \"iso-14242-3-like\"\n\
                       [march]\nupdates = 24\n[time]\nincrements = 50\n[accuracy]\nestimate = false\n";

#[test]
fn the_report_of_a_hip_has_a_curve_of_every_joint() {
    let bench = Bench::with_case(ORBITAL);
    bench.run_into("out");
    let report = fs::read_to_string(bench.path("out/report.html")).unwrap();
    for joint in [
        "lateral_mm",
        "anterior_mm",
        "penetration_mm",
        "orbit_deg",
        "tilt_deg",
        "counter_deg",
    ] {
        assert!(report.contains(&format!("id=\"k-{joint}")), "{joint}");
    }
    assert!(!report.contains("insert anterior"));
}

#[test]
fn machines_are_listed_shown_and_checked() {
    let bench = Bench::new();
    let listed = bench.say(&["machine", "list"]).out;
    let presets: Vec<&str> = listed
        .lines()
        .filter_map(|line| line.split(' ').next())
        .collect();
    assert!(presets.contains(&"stanmore-force") && presets.contains(&"iso-22622-like"));
    for preset in presets {
        let shown = bench.say(&["machine", "show", preset]).out;
        bench.write("rig.toml", &shown);
        let checked = bench.say(&["machine", "check", "rig.toml"]).out;
        assert!(
            checked.contains("the machine is good"),
            "{preset}: {checked}"
        );
    }
}

/// Returns the lines of a file of results without those of computing time and inputs.
fn computed(bench: &Bench, file: &str) -> Vec<String> {
    let bytes = fs::read(bench.path(file)).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().map(str::to_owned);
    lines
        .filter(|line| !line.contains("wall_s") && !line.contains("inputs_blake3"))
        .collect()
}

#[test]
fn a_shown_knee_simulator_has_the_results_of_its_preset() {
    for preset in ["stanmore-force", "stanmore-displacement"] {
        let bench = Bench::new();
        bench.write("rig.toml", &bench.say(&["machine", "show", preset]).out);
        for (out, machine) in [
            ("by-file", "file = \"rig.toml\"".to_owned()),
            ("by-word", format!("preset = {preset:?}")),
        ] {
            bench.write("case.toml", &format!("{SMALL}[machine]\n{machine}\n"));
            bench.run_into(out);
        }
        let files = [
            "wear.csv",
            "kinematics.csv",
            "insert_0001.vtu",
            "summary.json",
        ];
        for file in files {
            let [by_file, by_word] =
                ["by-file", "by-word"].map(|out| computed(&bench, &format!("{out}/{file}")));
            assert_eq!(by_file, by_word, "{preset}: {file}");
        }
        let summary = computed(&bench, "by-file/summary.json").concat();
        assert!(summary.contains("\"ap_range_mm\"") && summary.contains("medial"));
    }
}

#[test]
fn factors_of_file_machine_and_activity_are_multiplied_once() {
    let bench = Bench::new();
    let shown = bench.say(&["machine", "show", "pin-on-disc"]).out;
    let scaled = shown.replacen("tests =", "load_scale = 3\ntests =", 1);
    bench.write("pin.toml", &scaled);
    let short = "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\n[march]\ncycles = 1\nupdates = 1\n\
                 [time]\nincrements = 50\n[accuracy]\nestimate = false\n[machine]\nfile = \"pin.toml\"\nload_scale = 2\n\
                 [[activity]]\nname = \"inherited\"\nshare = 0.5\n\
                 [[activity]]\nname = \"own\"\nshare = 0.5\nfile = \"pin.toml\"\nload_scale = 0.5\n";
    bench.write("case.toml", short);
    bench.run_into("out");
    let activities = bench.summary("out").activities;
    for (activity, factor) in activities.iter().zip([6.0, 3.0]) {
        let peak_n = activity.peak_axial_force_n;
        assert!((peak_n / (70.0 * factor) - 1.0).abs() < 1e-3, "{peak_n}");
    }
}

#[test]
fn contact_above_a_void_of_the_insert_is_doubtful() {
    let bench = Bench::new();
    let block = |low: [f64; 3], high: [f64; 3]| TriangleMesh::block(low.into(), high.into());
    let solid = block([-12.0, 0.0, -12.0], [12.0, 8.0, 12.0]);
    let mut void = block([-5.0, 2.0, -5.0], [5.0, 3.0, 5.0]);
    for triangle in &mut void.triangles {
        triangle.swap(0, 1);
    }
    for (name, body) in [("solid", solid.clone()), ("hollow", solid.joined(&void))] {
        let mut stl = Vec::new();
        write_stl(&mut stl, &body).unwrap();
        fs::write(bench.path("insert.stl"), stl).unwrap();
        let case = format!(
            "[femur]\nshape = \"sphere\"\nradius_mm = 20\n[insert]\nshape = \"mesh\"\nfile = \"insert.stl\"\nlength_unit = \"mm\"\n\
             axes = [\"anterior\", \"superior\", \"right\"]\nedge_mm = 1.0\nlayers = 2\n[march]\ncycles = 1\nupdates = 1\n[time]\nincrements = 20\n[accuracy]\nestimate = false\n[machine]\ntests = \"specimen\"\n\
             [[machine.joints]]\nname = \"press\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n{LOAD}"
        );
        bench.write("case.toml", &case);
        bench.run_into(name);
        let doubts = bench.summary(name).plausibility;
        let is_hollow = doubts.iter().any(|doubt| doubt.check == "hollow_insert");
        assert_eq!(is_hollow, name == "hollow", "{doubts:?}");
    }
}

#[test]
fn a_machine_that_cannot_press_is_refused_with_its_line() {
    let bench = Bench::new();
    let shown = bench.say(&["machine", "show", "iso-14242-1-like"]).out;
    bench.write(
        "rig.toml",
        &shown.replace(
            "axis = [0, -1, 0]\ndrive = \"loaded\"",
            "axis = [1, 0, 0]\ndrive = \"loaded\"",
        ),
    );
    let said = bench.say(&["machine", "check", "rig.toml"]);
    said.assert_refused(2, &["one joint that presses", "rig.toml:"]);
}

#[test]
fn the_range_of_a_spline_is_that_of_the_curve() {
    let bench = Bench::new();
    let step = |percent: u32| format!("[{percent}, {}]", if percent < 50 { 20 } else { 0 });
    let step: Vec<String> = (0..20).map(|place| step(5 * place)).collect();
    let step = step.join(", ");
    let shown = bench.say(&["machine", "show", "pin-on-disc"]).out;
    let turn = format!(
        "\n[[joints]]\nname = \"spin\"\nkind = \"rotation\"\naxis = [0, 1, 0]\ndrive = \"prescribed\"\n\
         [joints.motion]\ninterpolation = \"spline\"\nknots_deg = [{step}]\n"
    );
    bench.write("rig.toml", &format!("{shown}{turn}"));
    let checked = bench.say(&["machine", "check", "rig.toml"]).out;
    // By 10.78 % of the step: `verify_the_overshoot_of_a_spline_at_a_step`.
    assert!(checked.contains(" -2.15"), "{checked}");
    assert!(checked.contains(" to 22.15"), "{checked}");
}

/// A ball in a wide cup under 500 N, on a machine that tilts it before it moves aside and down.
const TILTED: &str = "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\nstart_mm = [4, 0]\n\
                      [insert]\nshape = \"cup\"\nradius_mm = 18\nopening_deg = 60\ninclination_deg = 0\nedge_mm = 2\nlayers = 1\n\
                      [contact]\nfriction = 0\n[march]\ncycles = 1000\nupdates = 1\n[time]\nincrements = 20\n\
                      [accuracy]\nestimate = false\n[machine]\ntests = \"specimen\"\n\
                      [[machine.joints]]\nname = \"tilt\"\nkind = \"rotation\"\naxis = [0, 0, 1]\ndrive = \"locked\"\n\
                      locked_at_deg = 30\n\
                      [[machine.joints]]\nname = \"anterior\"\nkind = \"translation\"\naxis = [1, 0, 0]\ndrive = \"loaded\"\n\
                      [[machine.joints]]\nname = \"penetration\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\"\n";
const LOAD: &str = "[machine.joints.load]\nknots_n = [[0, 500]]\n";

#[test]
fn verify_a_ball_stays_where_it_settled_on_a_machine_that_tilts_first() {
    let bench = Bench::with_case(&format!("{TILTED}{LOAD}"));
    let checked = bench.say(&["check", "case.toml"]).out;
    // The load line is tilted: the contact carries 500 N cos 30 along y.
    assert!(checked.contains(", 433 N"), "{checked}");
    bench.run_into("out");
    let rows = bench.table("out", "kinematics.csv");
    for column in ["anterior_mm", "penetration_mm"] {
        for reading in &rows[column] {
            assert!(reading.abs() < 1e-3, "{column}: {reading}");
        }
    }
    let doubts = bench.summary("out").plausibility;
    assert!(
        doubts.iter().all(|one| one.check != "load_not_reached"),
        "{doubts:?}"
    );
}

#[test]
fn verify_a_spring_along_the_load_carries_its_part() {
    let sprung = format!("{TILTED}spring_n_per_mm = [300, 300]\nspring_rest_mm = -0.6\n{LOAD}");
    let bench = Bench::with_case(&sprung.replace("locked_at_deg = 30", "locked_at_deg = 0"));
    bench.run_into("out");
    let rows = bench.table("out", "kinematics.csv");
    let (moved_mm, force_n) = (rows["penetration_mm"][0], rows["axial_force_n"][0]);
    assert!(
        (force_n + 300.0 * (moved_mm + 0.6) - 500.0).abs() < 1.0,
        "{moved_mm} {force_n}"
    );
    let doubts = bench.summary("out").plausibility;
    assert!(
        doubts.iter().all(|one| one.check != "load_not_reached"),
        "{doubts:?}"
    );
}

#[test]
fn a_load_that_only_a_spring_restrains_does_not_settle_and_the_reason_is_stated() {
    let spun = "[[machine.joints]]\nname = \"spin\"\nkind = \"rotation\"\naxis = [0, 1, 0]\ndrive = \"loaded\"\n\
                spring_nm_per_deg = [1, 1]\n[machine.joints.load]\nknots_nm = [[0, 5], [50, -5]]\n";
    let bench = Bench::with_case(&format!("{TILTED}{LOAD}{spun}"));
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    assert!(
        said.err
            .contains("springs do not act while the machine settles"),
        "{}",
        said.err
    );
    let held = spun.replace("drive = ", "settling = \"held\"\ndrive = ");
    bench.write("case.toml", &format!("{TILTED}{LOAD}{held}"));
    bench.run_into("held");
}

#[test]
fn a_specimen_that_rides_on_its_rim_is_doubtful_and_the_end_of_a_pin_is_not() {
    let at_rim = |bench: &Bench, text: &str| {
        bench.write("case.toml", text);
        bench.run_into("out");
        let doubts = bench.summary("out").plausibility;
        fs::remove_dir_all(bench.path("out")).unwrap();
        let at_rim = doubts.iter().map(|one| one.check.as_str());
        at_rim.filter(|check| check.ends_with("at_rim")).count()
    };
    let bench = Bench::new();
    let moved = "kind = \"translation\"\naxis = [1, 0, 0]\ndrive = \"prescribed\"\n[machine.joints.motion]\nknots_mm = [[0, 0], [50, 6]]\n";
    let free = "kind = \"translation\"\naxis = [1, 0, 0]\ndrive = \"loaded\"\n";
    let rides = TILTED
        .replace(free, moved)
        .replace("opening_deg = 60", "opening_deg = 30");
    let rides = rides.replace("_deg = 30\n[[", "_deg = 0\n[[");
    let rides = format!("{}{LOAD}", rides.replace("start_mm = [4, 0]\n", ""));
    assert_eq!(at_rim(&bench, &rides), 2);
    let pin = "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\n[machine]\npreset = \"pin-on-disc\"\n\
               [march]\nupdates = 1\n[time]\nincrements = 20\n[accuracy]\nestimate = false\n";
    assert_eq!(at_rim(&bench, pin), 0);
}

#[test]
fn uncertainty_and_sensitivity_of_a_hip_report_the_results_that_it_has() {
    let bench = Bench::with_case(&ORBITAL.replace("updates = 24", "updates = 2"));
    let said = bench.say(&["uncertainty", "case.toml", "--runs", "3", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let found: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(found["runs"], 3);
    let numbers = found["numbers"].as_object().unwrap();
    assert_eq!(
        numbers.keys().collect::<Vec<_>>(),
        ["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa"]
    );
    let said = bench.say(&["sensitivity", "case.toml"]);
    assert!(
        said.code == Some(0) && !said.out.contains("NaN"),
        "{}",
        said.out
    );
}
