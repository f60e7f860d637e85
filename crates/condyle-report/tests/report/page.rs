//! The page as a whole, from a made-up folder.

use crate::fixture;

use condyle_report::{Results, Side, report_html, write_report};

#[test]
fn the_page_stands_alone_and_is_small() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    fixture::write(folder);
    let page = write_report(folder).expect("the folder is whole");
    let html = std::fs::read_to_string(page).expect("the page is there");
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    for request in ["<link", "src=", "url(", "@import"] {
        assert!(!html.contains(request), "the page holds {request}");
    }
    let still = report_html(&Results::read(folder).expect("the folder is whole"));
    for request in ["<script", "<link", "src=", "url(", "@import"] {
        assert!(!still.contains(request), "the still page holds {request}");
    }
}

#[test]
fn the_same_folder_gives_the_same_page_wherever_it_is() {
    let [one, two] = [(); 2].map(|()| {
        let folder = tempfile::tempdir().expect("a folder can be made");
        fixture::write(folder.path());
        let page = write_report(folder.path()).expect("the folder is whole");
        std::fs::read(page).expect("the page is there")
    });
    assert_eq!(one, two);
}

#[test]
fn wall_time_does_not_reach_the_page() {
    let mut results = fixture::results();
    let page = report_html(&results);
    let slower = fixture::SUMMARY.replace("\"wall_s\": 0.83", "\"wall_s\": 7.5");
    results.summary = Some(serde_json::from_str(&slower).expect("is JSON"));
    assert_eq!(page, report_html(&results));
}

#[test]
fn the_folder_gives_what_it_was_written_from() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    let read = Results::read(folder.path()).expect("the folder is whole");
    let (read, made) = (read.surface.expect("has a mesh"), fixture::surface());
    assert_eq!(read.field("wear_depth_mm"), made.field("wear_depth_mm"));
    assert_eq!(
        (read.nodes, read.quads.len()),
        (made.nodes, made.quads.len())
    );
}

#[test]
fn every_number_of_the_summary_is_on_the_page() {
    let html = report_html(&fixture::results());
    for shown in [
        "25.20", "27.10", "27.09", "0.2012", "21.38", "312.7", "4.831", "7.214", "58.7",
    ] {
        assert!(html.contains(shown), "{shown} is missing");
    }
    assert!(
        html.contains("peak_memory_mb"),
        "a number the report does not know is shown by its name"
    );
    assert!(html.contains("differ by 0.05\u{a0}%"));
}

#[test]
fn a_number_that_the_report_does_not_know_has_a_title_and_a_unit() {
    let mut results = fixture::results();
    let text = fixture::SUMMARY.replace(
        "\"peak_memory_mb\": 61.5",
        "\"peak_memory_mb\": 61.5, \"scar\": {\"width_mm\": 12.25, \"ends_mm\": [1.5, -2]}",
    );
    results.summary = Some(serde_json::from_str(&text).expect("is JSON"));
    let html = report_html(&results);
    for row in [
        "Peak memory</th><td class=\"n\">61.50</td><td class=\"u\">MB</td>",
        "Scar: Width</th><td class=\"n\">12.25</td><td class=\"u\">mm</td>",
        "Scar: Ends</th><td class=\"n\">1.500, \u{2212}2</td><td class=\"u\">mm</td>",
    ] {
        assert!(html.contains(row), "{row}");
    }
}

/// The cells of a row of the table that compares both sides: medial, lateral, both.
fn sides(html: &str, name: &str) -> [f64; 3] {
    let start = html.find(name).unwrap_or_else(|| panic!("no row {name}"));
    let mut cells = html[start..].split("<td class=\"n\">").skip(1);
    [(); 3].map(|()| {
        let cell = cells.next().and_then(|cell| cell.split('<').next());
        cell.and_then(|cell| cell.parse().ok()).expect("a number")
    })
}

#[test]
fn the_volume_of_both_sides_is_the_one_stated() {
    let html = report_html(&fixture::results());
    let [medial, lateral, both] = sides(&html, "Volume loss from depth, divided");
    assert_eq!(both, 27.1);
    assert!((medial + lateral - both).abs() < 0.11, "{medial} {lateral}");
}

#[test]
fn the_thinnest_polyethylene_is_shown_under_the_scar_and_anywhere() {
    let mut results = fixture::results();
    let surface = results.surface.as_mut().expect("has a mesh");
    let rim = surface.nodes.len() - 1;
    let thickness = surface
        .fields
        .iter_mut()
        .find(|(name, _)| name == "thickness_mm");
    thickness.expect("has it").1[rim] = 0.5;
    let html = report_html(&results);
    let [_, _, under_scar] = sides(&html, "Thinnest polyethylene left, under the scar");
    let [_, lateral, anywhere] = sides(&html, "Thinnest polyethylene left, anywhere");
    assert!(under_scar > 8.9 && under_scar < 9.5, "{under_scar}");
    assert_eq!((lateral, anywhere), (0.5, 0.5));
}

#[test]
fn warnings_of_the_run_stand_before_its_numbers() {
    let mut results = fixture::results();
    let text = fixture::SUMMARY.replacen(
        '{',
        r#"{"warnings": ["tibia.stl: inside out, and turned"], "plausibility": [{"check": "a",
            "value": 1.0, "limit": 0.5, "unit": "mm", "message": "it slides by 1 mm2", "advice": "Stop it."}], "#,
        1,
    );
    results.summary = Some(serde_json::from_str(&text).expect("is JSON"));
    let html = report_html(&results);
    let top = html.split("class=\"tiles\"").next().expect("has a top");
    for reported in [
        "<strong>It slides by 1 mm\u{b2}.</strong> Stop it.",
        "tibia.stl: inside out, and turned.",
        "The error from mesh could not be estimated",
    ] {
        assert!(top.contains(reported), "{reported}");
    }
}

#[test]
fn the_page_of_an_unfinished_run_states_its_progress() {
    let mut results = fixture::results();
    results.summary = None;
    results.case = Some(String::from("[march]\ncycles = 8_000_000\n"));
    let html = report_html(&results);
    assert!(html.contains("This run is not finished"));
    assert!(html.contains("After 5 million of 8 million cycles"));
}

#[test]
fn a_damaged_file_is_not_called_missing() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    let path = folder.path().join("summary.json");
    std::fs::write(path, "{\"cycles\": 5").expect("can be written");
    let results = Results::read_readable(folder.path()).expect("the rest is whole");
    let html = report_html(&results);
    assert!(html.contains("The file summary.json is damaged"));
    for words in [
        "This run is not finished",
        "there is no summary.json",
        "Missing in the folder",
    ] {
        assert!(!html.contains(words), "{words}");
    }
}

#[test]
fn a_constant_rate_is_stated_and_never_assumed() {
    let html = report_html(&fixture::results());
    assert!(html.contains("Wear per cycle stayed the same, 5.04 mg in a million cycles"));
    assert!(!html.contains("taken as constant"));
}

#[test]
fn the_estimated_error_is_shown_by_its_parts() {
    let page = report_html(&fixture::results());
    for shown in [
        "1.03</td>",
        "0.26</td>",
        "0.23</td>",
        "0.00047</td>",
        "\u{2212}0.97</td>",
        "The error from mesh could not be estimated: an insert read as hexahedra has no coarser mesh.",
    ] {
        assert!(page.contains(shown), "{shown}");
    }
    assert_eq!(page.matches(">unknown<").count(), 4);
    assert!(!page.contains("0.148"), "its time differs from run to run");
}

#[test]
fn a_run_without_an_estimate_states_its_lack() {
    let mut results = fixture::results();
    results.summary =
        Some(serde_json::from_str("{\"cycles\": 1, \"error\": null}").expect("is JSON"));
    assert!(report_html(&results).contains("was not estimated"));
}

#[test]
fn slip_paths_are_drawn_about_their_places() {
    let html = report_html(&fixture::results());
    assert!(html.contains("map-slip-t"));
    assert_eq!(html.matches(r#"<path class="slip""#).count(), 2);
    assert_eq!(html.matches(r#"class="slip-place""#).count(), 2);
    let without = Results {
        slip_paths: None,
        ..fixture::results()
    };
    assert!(!report_html(&without).contains("map-slip-t"));
}

#[test]
fn the_case_is_shown_as_text() {
    let case = Some(String::from("title = \"a <b> & c\""));
    let html = report_html(&Results {
        case,
        ..Results::default()
    });
    assert!(html.contains("a &#60;b&#62; &#38; c") && !html.contains("a <b>"));
}

#[test]
fn the_page_of_an_empty_run_lists_the_missing_files() {
    let html = report_html(&Results::default());
    assert!(html.contains(
        "summary.json, wear.csv, kinematics.csv, slip_paths.csv, insert_*.vtu, case.toml"
    ));
    assert!(!html.contains("<svg"));
}

#[test]
fn an_unworn_insert_is_drawn_bare() {
    let mut results = fixture::results();
    let surface = results.surface.as_mut().expect("has a mesh");
    for (_, values) in &mut surface.fields {
        values.fill(0.0);
    }
    let html = report_html(&results);
    assert!(html.contains("nothing to show") && !html.contains("NaN") && !html.contains(">inf"));
}

#[test]
fn medial_is_left_in_a_right_knee_and_right_in_a_left_one() {
    let mut results = fixture::results();
    let deepest = |results: &Results| {
        let html = report_html(results);
        html.contains("The deepest point is medial")
    };
    assert!(
        deepest(&results),
        "the deep scar of the made-up insert is at -z"
    );
    results.side = Side::Left;
    assert!(!deepest(&results));
}

#[test]
fn other_laws_stand_beside_that_of_the_run() {
    let law = |word: &str, of_run: bool, outside: &str| {
        format!(
            r#"{{"law": "{word}", "moved_the_surface": {of_run}, "approximate": {}, "mass_loss_mg": 79.5,
            "mass_loss_mg_per_million_cycles": 15.9, "volume_loss_mm3": 85.5, "max_depth_mm": 0.385,
            "outside_of_fit_percent": {outside}}}"#,
            !of_run
        )
    };
    let with = |laws: &[String]| {
        let mut results = fixture::results();
        let text = format!("{{\"wear_laws\": [{}]}}", laws.join(", "));
        results.summary = Some(serde_json::from_str(&text).expect("is JSON"));
        report_html(&results)
    };
    let (kang, archard) = (law("kang", true, "12.4"), law("archard", false, "null"));
    let page = with(&[kang.clone(), archard]);
    for words in [
        "Other wear laws",
        "kang (this run)</th>",
        "archard <span class=\"u\">approximate</span>",
        "<td class=\"n\">12</td>",
        "<td class=\"n\">not known</td>",
        "follows the law <code>kang</code>",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!with(&[kang]).contains("Other wear laws"));
}
