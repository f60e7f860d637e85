//! `condyle uncertainty`, through the front door.

use serde_json::Value;

use crate::bench::Bench;

const TINY: &str = r#"[insert]
edge_mm = 3.0
layers = 1
[march]
updates = 2
[time]
increments = 40
[machine.axial_force]
waveform = "paper-like"
[machine.ap_force]
waveform = "iso-like"
[machine.ie_torque]
waveform = "iso-like"
"#;

fn found(text: &str, arguments: &[&str]) -> Value {
    let bench = Bench::with_case(text);
    let said = bench.say(&[&["uncertainty", "case.toml", "--json"], arguments].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    serde_json::from_str(&said.out).unwrap()
}

fn number(value: &Value, path: &str) -> f64 {
    value
        .pointer(path)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{path} in {value}"))
}

#[test]
fn the_same_seed_gives_the_same_numbers_on_any_number_of_threads() {
    let one = found(TINY, &["--runs", "12", "--threads", "1"]);
    assert_eq!(one, found(TINY, &["--runs", "12", "--threads", "3"]));
    assert_ne!(one, found(TINY, &["--runs", "12", "--seed", "2"]));
    assert_eq!(one["runs"], 12);
    assert_eq!(one["inputs"].as_array().unwrap().len(), 14);
    let mass = |key: &str| number(&one, &format!("/numbers/mass_loss_mg/{key}"));
    assert!(mass("low") < mass("mean") && mass("mean") < mass("high"));
    assert!((mass("mean") / mass("value") - 1.0).abs() < 0.1, "{one}");
    assert!(mass("discretisation") > 0.0 && mass("laws/0") < mass("value"));
    assert!(one.pointer("/numbers/ap_range_mm/laws").unwrap().is_null());
}

#[test]
fn verify_the_mass_scatters_with_the_wear_factor_and_the_depth_with_it() {
    // Of displacement control nothing but friction, load, placement and wear factor reaches the mass.
    let text = "[machine]\npreset = \"stanmore-displacement\"\n[machine.axial_force]\nwaveform = \"paper-like\"\n";
    let text = format!(
        "{text}[insert]\nedge_mm = 3.0\n[march]\nupdates = 2\n[time]\nincrements = 40\n[wear]\nlaw = \"archard\"\n"
    );
    let one = found(&text, &["--runs", "60"]);
    let inputs = one["inputs"].as_array().unwrap();
    let of_mass = |name: &str| {
        let input = inputs.iter().find(|input| input["name"] == name).unwrap();
        number(input, "/variance_percent/mass_loss_mg")
    };
    assert!(of_mass("wear factor") > 50.0, "{one}");
    assert!(of_mass("thickness") < 10.0, "{one}");
    // 5.4 % by the wear factor alone, and 2 % by the load.
    let mass = |key: &str| number(&one, &format!("/numbers/mass_loss_mg/{key}"));
    let part = mass("standard_deviation") / mass("mean");
    assert!((0.045..0.075).contains(&part), "{part}");
}

#[test]
fn verify_the_loads_of_hips_and_of_activities_scatter() {
    let names = |text: &str| {
        let one = found(text, &["--runs", "3"]);
        let inputs = one["inputs"].as_array().unwrap();
        let names = inputs
            .iter()
            .map(|input| input["name"].as_str().unwrap().to_owned());
        names.collect::<Vec<_>>()
    };
    let hip = "[femur]\nshape = \"sphere\"\nradius_mm = 14\n[insert]\nshape = \"cup\"\nedge_mm = 3.0\n[machine]\npreset = \"iso-14242-1-like\"\n";
    let of_hip = names(&format!(
        "{hip}[march]\nupdates = 2\n[time]\nincrements = 40\n"
    ));
    for name in ["loads", "motions", "inclination"] {
        assert!(of_hip.iter().any(|own| own == name), "{of_hip:?}");
    }
    let activity = TINY.replace("[machine.", "[activity.");
    let (before, tables) = activity.split_once("[activity.").unwrap();
    let flexion = "[activity.flexion]\nwaveform = \"iso-like\"\n";
    let of_activity = names(&format!(
        "{before}[[activity]]\nname = \"a\"\nshare = 1.0\n[activity.{tables}{flexion}"
    ));
    assert!(
        of_activity.iter().any(|own| own == "loads"),
        "{of_activity:?}"
    );
    assert!(!names(TINY).iter().any(|own| own == "loads"));
}

#[test]
fn the_tables_say_what_the_numbers_hang_on_and_from_where() {
    let said = Bench::with_case(TINY).say(&["uncertainty", "case.toml", "--runs", "5"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("| mass loss, mg "), "{}", said.out);
    assert!(
        said.out
            .contains("5 runs, seed 1: standard deviations are known to 35 %."),
        "{}",
        said.out
    );
    // The two-sided 5 % limit of the correlation of five pairs is 0.878.
    assert!(
        said.out
            .contains("An input without effect has up to 77 % of a variance by chance"),
        "{}",
        said.out
    );
    assert!(said.out.contains("saikko2005"), "{}", said.out);
    assert!(said.err.contains("5 of 5 tests"), "{}", said.err);
}

#[test]
fn runs_that_fail_are_counted_and_said() {
    // Inserts of less than 1 mm are refused, and half of these are.
    let text = TINY
        .replace("[insert]", "[insert]\nthickness_mm = 1.0")
        .replace("updates = 2", "updates = 1\ncycles = 1000");
    let said = Bench::with_case(&text).say(&["uncertainty", "case.toml", "--runs", "6"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("3 runs, seed 1"), "{}", said.out);
    assert!(
        said.out.contains("Not among them: 3 that could not be run"),
        "{}",
        said.out
    );
}

#[test]
fn a_case_that_is_wrong_is_refused_as_ever() {
    let said = Bench::with_case("[contact]\nfriction = 9\n").say(&["uncertainty", "case.toml"]);
    said.assert_refused(2, &["friction"]);
    let said = Bench::with_case(TINY).say(&["uncertainty", "case.toml", "--runs", "1"]);
    said.assert_refused(2, &["--runs"]);
}
