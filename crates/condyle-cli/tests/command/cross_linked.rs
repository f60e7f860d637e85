//! An insert of cross-linked polyethylene, from the command to what is told of it.

use std::fs;

use serde_json::Value;

use super::bench::{Bench, SMALL};

#[test]
fn verify_a_cross_linked_insert_wears_less_by_every_law_and_everything_says_so() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("conventional");
    let linked = ["--set", "material.cross_linking=high"];
    let said = bench.say(&[&["run", "case.toml", "-o", "linked"][..], &linked].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let told = "cross-linked polyethylene: the wear of every law times 0.2";
    assert!(said.out.contains(told), "{}", said.out);
    let read =
        |run: &str, file: &str| fs::read_to_string(bench.path(&format!("{run}/{file}"))).unwrap();
    let summary =
        |run: &str| -> Value { serde_json::from_str(&read(run, "summary.json")).unwrap() };
    let [conventional, own] = ["conventional", "linked"].map(summary);
    assert_eq!(own["wear_over_conventional"], 0.2);
    assert_eq!(conventional.get("wear_over_conventional"), None);
    // The factor widens the interval, and measured rates are those of conventional inserts.
    let has_source = |summary: &Value| {
        let mut sources = summary["prediction"]["sources"].as_array().unwrap().iter();
        sources.any(|one| one["source"] == "cross-linking")
    };
    assert!(has_source(&own) && !has_source(&conventional));
    let measured = [&own, &conventional].map(|run| run["prediction"].get("measured").is_some());
    assert_eq!(measured, [false, true]);
    let masses = |summary: &Value| -> Vec<f64> {
        let laws = summary["wear_laws"].as_array().unwrap().iter();
        laws.map(|law| law["mass_loss_mg"].as_f64().unwrap())
            .collect()
    };
    // Less worn, the scar is smaller and pressed harder, so the ratio is only near.
    for (conventional, own) in masses(&conventional).into_iter().zip(masses(&own)) {
        let ratio = own / conventional;
        assert!((0.1..0.3).contains(&ratio), "{own} {conventional}");
    }
    let sentence = "that of conventional polyethylene times 0.2";
    assert!(read("linked", "report.html").contains(sentence));
    assert!(!read("conventional", "report.html").contains(sentence));
    assert!(read("linked", "case.toml").contains("cross_linking = \"high\""));
}
