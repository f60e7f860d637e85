//! Runs held against each other: `condyle diff`, `condyle report` of several, `condyle plot`.

use condyle_results::catalogue;
use std::fs;

use serde_json::Value;

use crate::bench::{Bench, SMALL, Said};

/// A bench with the run `out`, and `other` with a value changed.
fn two_runs(change: &str) -> Bench {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let said = bench.say(&["run", "case.toml", "--out", "other", "--set", change]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    bench
}

#[track_caller]
fn json(said: &Said) -> Value {
    assert_eq!(said.code, Some(0), "{}", said.err);
    serde_json::from_str(&said.out).expect("it is JSON")
}

#[test]
fn two_runs_differ_by_what_their_summaries_say_ranked_beside_their_errors() {
    let bench = two_runs("contact.friction=0.02");
    let told = json(&bench.say(&["diff", "out", "other", "--json"]));
    let [first, second] = ["out", "other"].map(|out| bench.summary(out));
    let numbers = told["numbers"].as_array().expect("a list");
    let mass = numbers.iter().find(|one| one["key"] == "mass_loss_mg");
    let mass = mass.expect("the mass differs");
    let off = second[&catalogue::MASS_LOSS_MG] - first[&catalogue::MASS_LOSS_MG];
    assert_eq!(mass["difference"], off);
    let [one, two] = [&first, &second].map(|summary| {
        let error = summary.error.as_ref().expect("is estimated");
        error.of(&catalogue::MASS_LOSS_MG).in_unit.total
    });
    let times = mass["times_errors"].as_f64().expect("has errors");
    assert!((times - off.abs() / (one + two)).abs() < 1e-12);
    let ranks: Vec<f64> = numbers
        .iter()
        .map(|one| one["times_errors"].as_f64().unwrap_or(-1.0))
        .collect();
    assert!(ranks.is_sorted_by(|one, next| one >= next), "{ranks:?}");
    let settings = &told["settings"];
    assert_eq!(settings[0]["key"], "contact.friction");
    assert_eq!(
        (settings[0]["second"].as_str(), settings[1].is_null()),
        (Some("0.02"), true)
    );
    assert!(!told["maps"].as_array().expect("a list").is_empty());
    let text = bench.say(&["diff", "out", "other"]).out;
    for words in [
        "mass_loss_mg",
        "times the errors",
        "wear_depth_mm",
        "contact.friction",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn other_cycles_and_other_meshes_of_equal_cases_are_noted() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    bench.run_into("other");
    let replace = |file: &str, from: &str, to: &str| {
        let text = fs::read_to_string(bench.path(file)).unwrap();
        assert!(text.contains(from), "{file}: {from}");
        bench.write(file, &text.replace(from, to));
    };
    let hash = bench.summary("other").inputs_blake3;
    replace("other/summary.json", &hash, &"0".repeat(64));
    replace("other/wear.csv", "\n5000000,", "\n4000000,");
    let notes = json(&bench.say(&["diff", "out", "other", "--json"]))["notes"].to_string();
    for words in [
        "compared after 5000000 and 4000000 cycles",
        "but their meshes differ",
    ] {
        assert!(notes.contains(words), "{words}: {notes}");
    }
}

#[test]
fn a_difference_of_discretisation_says_so_and_equal_runs_differ_in_nothing() {
    let bench = two_runs("time.increments=52");
    let told = json(&bench.say(&["diff", "out", "other", "--json"]));
    let numbers = told["numbers"].as_array().expect("a list");
    let mass = numbers
        .iter()
        .find(|one| one["key"] == "mass_loss_mg")
        .expect("differs");
    assert!(
        mass["times_errors"].as_f64().expect("has errors") < 1.0,
        "{mass}"
    );
    assert!(
        bench
            .say(&["diff", "out", "other"])
            .out
            .contains("smaller than the errors")
    );
    assert!(
        bench
            .say(&["diff", "out", "out"])
            .out
            .contains("nothing differs")
    );
}

#[test]
fn maps_on_other_meshes_are_not_subtracted_and_that_is_said() {
    let bench = two_runs("insert.edge_mm=3");
    let told = json(&bench.say(&["diff", "out", "other", "--json"]));
    assert_eq!(told["maps"].as_array().map(Vec::len), Some(0));
    let notes = told["notes"].as_array().expect("a list").iter();
    let notes: Vec<&str> = notes.filter_map(Value::as_str).collect();
    let ranking = "other wears less than out in";
    assert!(
        notes.iter().any(|note| note.starts_with(ranking)),
        "{notes:?}"
    );
    let note = notes.iter().find(|note| note.contains("Maps of"));
    let note = note.expect("a note on the maps");
    assert!(
        note.contains("cannot be subtracted: the inserts have different meshes"),
        "{note}"
    );
    assert_eq!(bench.say(&["report", "out", "other"]).code, Some(0));
    let page = fs::read_to_string(bench.path("runs.html")).expect("the page is there");
    assert!(page.contains("cannot be subtracted") && page.contains("2 runs side by side"));
    assert!(!page.contains("other \u{2212} out"));
}

#[test]
fn several_runs_stand_on_one_page_on_the_same_axes() {
    let bench = two_runs("contact.friction=0.02");
    let said = bench.say(&["report", "out", "other", "--out", "page.html"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let page = fs::read_to_string(bench.path("page.html")).expect("the page is there");
    for words in [
        "other compared with out: numbers",
        "other \u{2212} out",
        "class=\"run-2\"",
        "contact.friction",
        "other wears ",
        "discretisation errors of both",
        "data-scene=\"scene-1\"",
        "script-src &#39;sha256-",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(!page.contains("src="));
}

#[test]
fn runs_are_called_by_the_titles_of_their_cases_if_these_differ() {
    let bench = two_runs("contact.friction=0.02");
    let page = |titles: [&str; 2]| {
        for (folder, title) in ["out", "other"].into_iter().zip(titles) {
            let path = bench.path(folder).join("case.toml");
            let case = fs::read_to_string(&path).expect("the case is there");
            let rest = case.lines().filter(|line| !line.starts_with("title"));
            let rest = rest.collect::<Vec<_>>().join("\n");
            fs::write(&path, format!("title = \"{title}\"\n{rest}\n")).expect("can be written");
        }
        assert_eq!(
            bench.say(&["report", "out", "other", "--force"]).code,
            Some(0)
        );
        fs::read_to_string(bench.path("runs.html")).expect("the page is there")
    };
    let titled = page(["Rough <1>", "Smooth"]);
    assert!(titled.contains("Changed from Rough &#60;1&#62; to Smooth"));
    assert!(!titled.contains("<1>") && !titled.contains("<td>title</td>"));
    assert!(page(["Same", "Same"]).contains("Changed from out to other"));
}

#[test]
fn folders_that_are_not_there_and_options_that_do_not_fit_are_refused() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let gone = ["There is no folder gone"];
    bench.say(&["diff", "out", "gone"]).assert_refused(2, &gone);
    bench
        .say(&["report", "out", "gone"])
        .assert_refused(2, &gone);
    bench.say(&["plot", "gone"]).assert_refused(2, &gone);
    bench
        .say(&["report", "out", "--out", "page.html"])
        .assert_refused(2, &["--out is for the page of several"]);
    bench
        .say(&["report", "out", "out", "--pictures"])
        .assert_refused(2, &["condyle plot"]);
    // A run that is not finished has no numbers, and its curves and maps are shown.
    fs::remove_file(bench.path("out/summary.json")).expect("can be removed");
    let said = bench.say(&["diff", "out", "out"]);
    assert!(said.out.contains("missing: summary.json"), "{}", said.out);
}

#[test]
fn the_pictures_of_a_report_are_files_without_a_browser() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let said = bench.say(&["plot", "out", "--out", "pictures"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for name in [
        "wear_map",
        "peak_pressure_map",
        "sliding_distance_map",
        "cross_shear_map",
        "slip_paths",
        "wear",
        "kinematics",
    ] {
        let svg = fs::read_to_string(bench.path("pictures").join(format!("{name}.svg")));
        assert!(
            svg.is_ok_and(|svg| svg.starts_with("<svg xmlns=")),
            "{name}"
        );
        let is_png_there = bench.path("pictures").join(format!("{name}.png")).exists();
        assert_eq!(is_png_there, cfg!(feature = "png"), "{name}");
    }
    if !cfg!(feature = "png") {
        let said = bench.say(&["plot", "out", "--format", "png"]);
        said.assert_refused(2, &["built without support for PNG", "--features png"]);
    }
}
