//! The files of a results folder: every file, key and column, and what the numbers must satisfy.

use condyle_results::catalogue;
use std::fs;

use condyle_mesh::formats::{read_pvd, read_vtu_points};
use serde_json::Value;

use crate::bench::{Bench, SMALL};

const KEYS: &[&str] = &[
    "cycles",
    "mass_loss_mg",
    "volume_loss_mm3",
    "volume_loss_mesh_mm3",
    "max_depth_mm",
    "peak_pressure_mpa",
    "peak_contact_area_mm2",
    "ap_range_mm",
    "ie_range_deg",
    "medial_load_share",
    "updates",
    "increments",
    "newton_iterations",
    "contact_evaluations",
    "newton_iterations_per_cycle",
    "contact_evaluations_per_cycle",
    "worst_quality",
    "wall_s",
];
const WEAR: &str =
    "cycles,mass_loss_mg,volume_loss_mm3,max_depth_mm,peak_pressure_mpa,peak_contact_area_mm2";
const KINEMATICS: &str = "cycles,percent,flexion_deg,axial_force_n,ap_mm,ie_deg,ml_mm,vv_deg,is_mm,\
    contact_area_mm2,peak_pressure_mpa,medial_force_n,lateral_force_n";
const POINT_DATA: &[&str] = &[
    "wear_depth_mm",
    "depth_per_cycle_mm",
    "peak_pressure_mpa",
    "sliding_distance_mm",
    "cross_shear",
    "thickness_mm",
    "articulating",
];

fn done() -> Bench {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    bench
}

fn text(bench: &Bench, name: &str) -> String {
    fs::read_to_string(bench.path("out").join(name))
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn the_summary_states_the_discretisation_error_by_its_parts() {
    let bench = done();
    let summary: Value = serde_json::from_str(&text(&bench, "summary.json")).unwrap();
    for table in [
        "mass_loss_percent",
        "mass_loss_mg",
        "max_depth_percent",
        "max_depth_mm",
        "peak_pressure_percent",
        "peak_pressure_mpa",
        "peak_contact_area_percent",
        "peak_contact_area_mm2",
        "ap_range_percent",
        "ap_range_mm",
        "ie_range_percent",
        "ie_range_deg",
    ] {
        for part in ["increments", "updates", "mesh", "slip_tolerance", "total"] {
            let number = summary["error"][table][part].as_f64();
            assert!(number.is_some_and(f64::is_finite), "{table} {part}");
        }
    }
    let said = bench.say(&["run", "case.toml", "--out", "again"]);
    for words in [
        "discretisation error +/-",
        "error of mass, by parts",
        "slip tolerance",
    ] {
        assert!(said.out.contains(words), "{words}: {}", said.out);
    }
}

#[test]
fn peaks_say_of_which_cycle_they_are() {
    let bench = done();
    let summary = bench.summary("out");
    let table = bench.table("out", "wear.csv");
    // A row has the peaks of the cycle before its wear; the final cycle, on the worn surface, has none.
    let before = [&[0.0], &table["cycles"][..]].concat();
    let cycles_solved = |column: &str, last| {
        let peaks = [&table[column][..], &[summary[last]]].concat();
        before.iter().copied().zip(peaks).collect::<Vec<_>>()
    };
    let pressures = cycles_solved(
        "peak_pressure_mpa",
        &catalogue::LAST_CYCLE_PEAK_PRESSURE_MPA,
    );
    let areas = cycles_solved(
        "peak_contact_area_mm2",
        &catalogue::LAST_CYCLE_CONTACT_AREA_MM2,
    );
    for (cycles, first, peak, cycle) in [
        (
            &pressures,
            &catalogue::FIRST_CYCLE_PEAK_PRESSURE_MPA,
            &catalogue::PEAK_PRESSURE_MPA,
            &catalogue::PEAK_PRESSURE_CYCLE,
        ),
        (
            &areas,
            &catalogue::FIRST_CYCLE_CONTACT_AREA_MM2,
            &catalogue::PEAK_CONTACT_AREA_MM2,
            &catalogue::PEAK_CONTACT_AREA_CYCLE,
        ),
    ] {
        assert_eq!(cycles[0].1, summary[first]);
        let report = fs::read_to_string(bench.path("out/report.html")).unwrap();
        // A chart has all of them, the last one in three digits.
        let (count, last) = (cycles.len(), cycles[cycles.len() - 1].1);
        let decimals = usize::from(last < 100.0);
        let points = format!("{count} points; it ends at {last:.decimals$}");
        assert!(report.contains(&points), "{points}");
        assert!(cycles.contains(&(summary[cycle], summary[peak])));
        assert!(cycles.iter().all(|(_, value)| *value <= summary[peak]));
    }
    let said = bench.say(&["run", "case.toml", "--out", "again"]).out;
    let when = |cycle: f64| match cycle {
        0.0 => ", in the first cycle, ".to_owned(),
        later => format!(", after {later:.0} cycles, "),
    };
    for cycle in [
        summary[&catalogue::PEAK_PRESSURE_CYCLE],
        summary[&catalogue::PEAK_CONTACT_AREA_CYCLE],
    ] {
        assert!(said.contains(&when(cycle)), "{said}");
    }
}

#[test]
fn an_estimate_that_is_not_asked_for_is_not_made() {
    let bench = Bench::with_case(&format!("{SMALL}[accuracy]\nestimate = false\n"));
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(!said.out.contains("discretisation error"), "{}", said.out);
    assert!(
        said.out
            .contains(", without discretisation, whose error is not estimated"),
        "{}",
        said.out
    );
    assert!(text(&bench, "summary.json").contains("\"error\": null"));
    assert!(text(&bench, "report.html").contains("was not estimated"));
}

#[test]
fn the_folder_has_the_files_of_the_contract_and_no_others() {
    let bench = done();
    let mut names: Vec<String> = fs::read_dir(bench.path("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let expected = [
        "case.toml",
        "checkpoint",
        "checksums",
        "cycle_first_pressure.csv",
        "cycle_last_pressure.csv",
        "femur.vtu",
        "femur_pose.csv",
        "insert.pvd",
        "insert_0000.vtu",
        "insert_0001.vtu",
        "insert_0002.vtu",
        "insert_0003.vtu",
        "kinematics.csv",
        "report.html",
        "slip_paths.csv",
        "summary.json",
        "wear.csv",
    ];
    assert_eq!(names, expected);
}

#[test]
fn the_summary_has_every_key_and_its_numbers_agree() {
    let bench = done();
    let summary: Value = serde_json::from_str(&text(&bench, "summary.json")).unwrap();
    let number = |key: &str| {
        let value = summary[key].as_f64();
        value.unwrap_or_else(|| panic!("{key} is {}", summary[key]))
    };
    for key in KEYS {
        assert!(
            number(key).is_finite() && number(key) > 0.0,
            "{key} {}",
            number(key)
        );
    }
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["inputs_blake3"].as_str().map(str::len), Some(64));
    assert_eq!((number("cycles"), number("updates")), (5e6, 3.0));
    assert_eq!(number("increments"), 50.0);
    let (volume, mesh) = (number("volume_loss_mm3"), number("volume_loss_mesh_mm3"));
    assert!((mesh / volume - 1.0).abs() < 0.01, "{volume} {mesh}");
    assert!((number("mass_loss_mg") / volume - 0.93).abs() < 1e-12);
    assert!(number("newton_iterations") >= 150.0);
    assert!(number("contact_evaluations") >= number("newton_iterations"));
    let all = number("contact_evaluations_per_cycle") * number("cycles_solved");
    assert!((all / number("contact_evaluations") - 1.0).abs() < 1e-12);
    assert!((0.0..=1.0).contains(&number("medial_load_share")));
    assert!(number("worst_quality") <= 1.0);
}

#[test]
fn wear_has_a_row_an_update_and_ends_where_the_summary_does() {
    let bench = done();
    assert_eq!(text(&bench, "wear.csv").lines().next(), Some(WEAR));
    let table = bench.table("out", "wear.csv");
    let summary = bench.summary("out");
    for column in table.values() {
        assert_eq!(column.len(), 3);
        assert!(column.iter().all(|value| value.is_finite() && *value > 0.0));
    }
    for growing in ["cycles", "mass_loss_mg", "volume_loss_mm3", "max_depth_mm"] {
        assert!(table[growing].is_sorted_by(|a, b| a < b), "{growing}");
    }
    assert_eq!(
        table["mass_loss_mg"].last(),
        Some(&summary[&catalogue::MASS_LOSS_MG])
    );
    assert_eq!(table["cycles"].last(), Some(&5e6));
}

#[test]
fn kinematics_have_a_row_an_increment_of_the_first_and_the_last_cycle() {
    let bench = done();
    assert_eq!(
        text(&bench, "kinematics.csv").lines().next(),
        Some(KINEMATICS)
    );
    let table = bench.table("out", "kinematics.csv");
    for (name, column) in &table {
        assert_eq!(column.len(), 100, "{name}");
        assert!(column.iter().all(|value| value.is_finite()), "{name}");
    }
    assert_eq!(table["percent"][..50], table["percent"][50..]);
    assert_eq!((table["percent"][0], table["percent"][49]), (2.0, 100.0));
    assert!(table["cycles"][..50].iter().all(|cycles| *cycles == 0.0));
    assert!(table["cycles"][50..].iter().all(|cycles| *cycles == 5e6));
    let sides = table["medial_force_n"]
        .iter()
        .zip(&table["lateral_force_n"]);
    for ((medial, lateral), axial) in sides.zip(&table["axial_force_n"]) {
        assert!((medial + lateral - axial).abs() < 1e-9);
    }
    for name in ["axial_force_n", "peak_pressure_mpa", "contact_area_mm2"] {
        assert!(table[name].iter().all(|value| *value > 0.0), "{name}");
    }
    let first = &table["ap_mm"][..50];
    let range = first.iter().copied().fold(f64::MIN, f64::max)
        - first.iter().copied().fold(f64::MAX, f64::min);
    assert!((range - bench.summary("out")[&catalogue::AP_RANGE_MM]).abs() < 1e-12);
}

#[test]
fn the_insert_series_is_read_back_and_agrees_with_the_summary() {
    let bench = done();
    let (summary, wear) = (bench.summary("out"), bench.table("out", "wear.csv"));
    let series = read_pvd(bench.path("out/insert.pvd")).unwrap();
    let times: Vec<f64> = series.iter().map(|(time, _)| *time).collect();
    assert_eq!(times[0], 0.0);
    assert_eq!(times[1..], wear["cycles"]);
    let inserts: Vec<_> = series
        .iter()
        .map(|(_, path)| read_vtu_points(bench.path("out").join(path)).unwrap())
        .collect();
    let mut worst = f64::INFINITY;
    for insert in &inserts {
        let names: Vec<&str> = insert
            .point_data
            .iter()
            .map(|(name, _)| name.as_str())
            .collect();
        assert_eq!(names, POINT_DATA);
        let articulating = insert.values("articulating").unwrap();
        for (name, values) in &insert.point_data {
            assert_eq!(values.len(), insert.mesh.nodes.len());
            let off = values
                .iter()
                .zip(articulating)
                .filter(|(_, on)| **on == 0.0);
            assert!(
                off.map(|(value, _)| *value).all(|value| value == 0.0),
                "{name}"
            );
            assert!(values.iter().all(|value| value.is_finite()), "{name}");
        }
        let on = articulating.iter().filter(|on| **on == 1.0).count();
        assert_eq!(on as f64, summary[&catalogue::ARTICULATING_NODES]);
        assert_eq!(
            insert.mesh.hexes.len() as f64,
            summary[&catalogue::HEXAHEDRA]
        );
        worst = worst.min(insert.mesh.worst_quality());
    }
    assert!(
        worst > 0.0 && worst <= summary[&catalogue::WORST_QUALITY] + 1e-12,
        "{worst}"
    );
    let lost = inserts[0].mesh.volume() - inserts[3].mesh.volume();
    assert!((lost - summary[&catalogue::VOLUME_LOSS_MESH_MM3]).abs() < 1e-6);
    let deepest = |insert: usize| {
        let depth = inserts[insert].values("wear_depth_mm").unwrap();
        depth.iter().copied().fold(0.0, f64::max)
    };
    assert_eq!(
        (deepest(0), deepest(3)),
        (0.0, summary[&catalogue::MAX_DEPTH_MM])
    );
    assert_eq!(deepest(1), wear["max_depth_mm"][0]);
}

#[test]
fn the_case_as_run_runs_again_to_the_same_numbers() {
    let bench = done();
    let said = bench.say(&["run", "out/case.toml", "--out", "again"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let (first, again) = (bench.summary("out"), bench.summary("again"));
    assert_eq!(first.inputs_blake3, again.inputs_blake3);
    assert_eq!(
        first[&catalogue::MASS_LOSS_MG],
        again[&catalogue::MASS_LOSS_MG]
    );
}

#[test]
fn the_report_asks_for_nothing_outside_itself() {
    let page = text(&done(), "report.html");
    for word in ["src=\"http", "href=\"http", "@import", "<script src"] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.contains("<svg") && page.len() > 20_000);
}
