//! Values of a case changed on the command line.

use condyle_results::catalogue;
use std::fs;

use crate::bench::{Bench, SMALL, assert_same_bytes};

#[test]
fn a_changed_case_runs_as_if_it_were_written_so() {
    let bench = Bench::with_case(SMALL);
    let changed = [
        "--set",
        "updates=2",
        "--set",
        "contact.foundation.law = logarithmic",
    ];
    let said = bench.say(&[&["run", "case.toml", "-o", "set"][..], &changed].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(bench.summary("set")[&catalogue::UPDATES], 2.0);
    let written = SMALL.replace("updates = 3", "updates = 2");
    bench.write(
        "case.toml",
        &format!("{written}[contact.foundation]\nlaw = \"logarithmic\"\n"),
    );
    bench.run_into("written");
    assert_same_bytes(&bench.path("set"), &bench.path("written"));
    let case = fs::read_to_string(bench.path("set/case.toml")).unwrap();
    assert!(case.contains("updates = 2") && case.contains("law = \"logarithmic\""));
}

#[test]
fn a_changed_case_is_checked_and_stays_as_it_is() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["check", "case.toml", "--print", "--set", "friction=0.05"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("friction = 0.05"), "{}", said.out);
    let said = bench.say(&["check", "case.toml", "--set", "title=a = b"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(fs::read_to_string(bench.path("case.toml")).unwrap(), SMALL);
}

#[test]
fn characters_that_steer_a_terminal_are_refused_on_the_command_line_too() {
    let bench = Bench::with_case(SMALL);
    for title in ["title=a\u{1b}[31mb", "title=\"a\u{202e}b\""] {
        let said = bench.say(&["check", "case.toml", "--set", title]);
        said.assert_refused(2, &["this text contains the control character"]);
    }
}

#[test]
fn a_new_case_takes_the_other_model_of_contact() {
    let bench = Bench::new();
    assert_eq!(bench.say(&["new", "case.toml"]).code, Some(0));
    let said = bench.say(&["check", "case.toml", "--set", "contact.model=deformable"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
}

#[test]
fn another_law_takes_the_place_of_the_files_with_all_its_constants() {
    let archard = format!("{SMALL}[wear]\nwear_factor_mm3_per_nm = 3e-7\n");
    let bench = Bench::with_case(&archard);
    let law = ["--set", "wear.law=kang"];
    let said = bench.say(&[&["run", "case.toml", "-o", "set"][..], &law].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let told = "wear_factor_mm3_per_nm = 3e-7: ignored, since it does not apply to wear.law = \"kang\", which is set";
    assert!(said.err.contains(told), "{}", said.err);
    bench.write("case.toml", &format!("{SMALL}[wear]\nlaw = \"kang\"\n"));
    let said = bench.run_into("written");
    assert!(!said.err.contains("left out"), "{}", said.err);
    for file in ["wear.csv", "kinematics.csv", "case.toml"] {
        let read = |run: &str| fs::read(bench.path(&format!("{run}/{file}"))).unwrap();
        assert!(read("set") == read("written"), "{file}");
    }
    bench.write("case.toml", &archard);
    let own = [
        "--print",
        "--set",
        "decay_per_mpa=0.2",
        "--set",
        "wear.law=kang",
    ];
    let said = bench.say(&[&["check", "case.toml"][..], &own].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("decay_per_mpa = 0.2"), "{}", said.out);
    let both = [
        "--set",
        "wear.law=kang",
        "--set",
        "wear.wear_factor_mm3_per_nm=1e-7",
    ];
    let said = bench.say(&[&["check", "case.toml"][..], &both].concat());
    said.assert_refused(
        2,
        &["`wear_factor_mm3_per_nm` belongs to law = \"archard\""],
    );
}

#[test]
fn a_change_that_cannot_be_made_is_refused() {
    let bench = Bench::with_case(SMALL);
    for (change, words) in [
        ("updates", "`updates` is not of the form key=value"),
        ("=3", "`=3` is not of the form key=value"),
        ("updates=", "`updates=` is not of the form key=value"),
        ("updatse=3", "did you mean `updates`?"),
        ("mu=0.1", "did you mean `friction`?"),
        ("xyz=3", "give its dotted path, such as `march.updates`"),
        (
            "spacing_mm=45",
            "write `femur.spacing_mm` or `insert.spacing_mm`",
        ),
        ("march.updatse=3", "[march] has no key `updatse`"),
        ("march.updates=0", "case.toml with march.updates = 0"),
        (
            "friction=rough",
            "`friction` must be a number, this is text in quotes",
        ),
    ] {
        for command in ["check", "run"] {
            let said = bench.say(&[command, "case.toml", "--set", change]);
            said.assert_refused(2, &[words]);
        }
    }
    assert!(!bench.path("results").exists());
}

#[test]
fn a_run_of_a_changed_case_is_gone_on_with_by_the_same_changes() {
    let bench = Bench::with_case(SMALL);
    let begin = ["run", "case.toml", "-o", "out", "--set", "updates=2"];
    let first = bench.say(&begin);
    let resume = [&begin[..], &["--resume"]].concat();
    let again = bench.say(&resume);
    assert_eq!((again.code, &again.out), (Some(0), &first.out));
    let other = bench.say(&["run", "case.toml", "-o", "out", "--resume"]);
    other.assert_refused(2, &["is of another case", "march.updates was 2 and is 3"]);
    let more = [
        &resume[..],
        &["--set", "friction=0.05", "--set", "wear.law=kang"],
    ]
    .concat();
    let other = bench.say(&more);
    other.assert_refused(2, &["contact.friction was 0.07 and is 0.05"]);
}

#[test]
fn another_model_of_contact_takes_the_place_of_the_foundation_in_a_new_case() {
    let bench = Bench::new();
    assert_eq!(bench.say(&["new", "d.toml"]).code, Some(0));
    let said = bench.say(&[
        "check",
        "d.toml",
        "--set",
        "contact.model=deformable",
        "--set",
        "insert.edge_mm=3",
    ]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.err.contains("contact.foundation"), "{}", said.err);
}
