//! Cases with several activities, and creep.

use condyle::machine::knee;
use std::path::Path;

use super::{assert_shows, parsed, refusal};
use crate::case::{Assignment, Case, CaseReader, Creep};
use condyle_mesh::files::MemoryFiles;

/// The waveforms that an activity of force control needs, all by the same name.
fn inputs(word: &str) -> String {
    let table = |name| format!("[activity.{name}]\nwaveform = \"{word}\"\n");
    ["axial_force", "flexion", "ap_force", "ie_torque"]
        .map(table)
        .concat()
}

fn activity(keys: &str, word: &str) -> String {
    format!("[[activity]]\n{keys}\n{}", inputs(word))
}

/// Two activities with these keys in addition to their names.
fn two(first: &str, second: &str) -> String {
    let first = activity(&format!("name = \"walking\"\n{first}"), "iso-like");
    first + &activity(&format!("name = \"stairs\"\n{second}"), "stairs-like")
}

fn good(text: &str) -> Case {
    parsed(text).unwrap_or_else(|error| panic!("{error}\nin\n{text}"))
}

#[test]
fn each_activity_has_its_own_inputs_and_a_share() {
    let case = good(&two("share = 0.85", "share = 0.15\nfrequency_hz = 0.8"));
    let built = case.build(1).expect("it can be built").test;
    let [walking, stairs] = built.activities.as_slice() else {
        panic!("there are two");
    };
    assert_eq!((walking.name.as_str(), walking.share), ("walking", 0.85));
    assert_eq!((stairs.name.as_str(), stairs.share), ("stairs", 0.15));
    let frequency = |activity: &condyle::evolve::Activity| activity.machine.frequency_hz;
    assert_eq!((frequency(walking), frequency(stairs)), (1.1, 0.8));
    assert_ne!(
        walking.machine.joint(knee::IS).drive,
        stairs.machine.joint(knee::IS).drive
    );
}

#[test]
fn a_sequence_is_shares_too() {
    let case = good(&two("cycles_in_sequence = 17", "cycles_in_sequence = 3"));
    let built = case.build(1).expect("it can be built").test;
    let shares: Vec<f64> = built.activities.iter().map(|one| one.share).collect();
    assert_eq!(shares, [0.85, 0.15]);
}

#[test]
fn thirds_with_a_few_digits_are_whole() {
    let third = |name: &str| activity(&format!("name = \"{name}\"\nshare = 0.3333"), "iso-like");
    let case = good(&["a", "b", "c"].map(third).concat());
    let built = case.build(1).expect("it can be built").test;
    let sum: f64 = built.activities.iter().map(|one| one.share).sum();
    assert!((sum - 1.0).abs() < 1e-12);
}

#[test]
fn activities_and_creep_round_trip() {
    let creep = "[creep]\nlaw = \"lee-pienkowski\"\nrecovering_fraction = 0.4\n";
    let case = good(&(two("share = 0.85", "share = 0.15\nap_force_sign = -1") + creep));
    let text = case.to_toml();
    let again = Case::parse(&text, "written.toml", Path::new("")).expect("it reads back");
    assert!(again == case && again.to_toml() == text, "{text}");
    assert!(matches!(case.creep, Creep::LeePienkowski(_)));
}

#[test]
fn keys_of_an_activity_are_set_by_its_name() {
    let text = two("share = 0.85", "share = 0.15");
    let files = MemoryFiles::default().with("/case.toml", text);
    let change = Assignment::parse("activity.stairs.frequency_hz=0.7").expect("a key and a value");
    let reader = CaseReader::new(files);
    let case = reader
        .read_changed(Path::new("/case.toml"), &[change])
        .expect("it is a case");
    assert_eq!(case.number_at("activity.stairs.frequency_hz"), Some(0.7));
    assert_eq!(case.number_at("activity.walking.share"), Some(0.85));
    let load = &knee::AXIAL_FORCE;
    let has_load = |one: &crate::case::Activity| one.waveforms.get(load).is_some();
    assert!(case.activities.iter().all(has_load));
}

#[test]
fn shares_that_do_not_sum_up_are_refused_at_the_last() {
    assert_shows(
        &refusal(&two("share = 0.85", "share = 0.25")),
        &[
            "the shares of the activities add up to 1.1000 instead of 1",
            "share = 0.25",
            "help: correct them, or write `cycles_in_sequence`",
        ],
    );
    assert_shows(
        &refusal(&two("share = 0.85", "")),
        &["\"stairs\" has no share of the cycles"],
    );
    assert_shows(
        &refusal(&two("share = 0.85", "cycles_in_sequence = 3")),
        &["\"walking\" has a `share`, and another has `cycles_in_sequence`"],
    );
    assert_shows(
        &refusal(&two("share = 0.85", "share = 0.15\ncycles_in_sequence = 3")),
        &["\"stairs\" has both a `share` and `cycles_in_sequence`"],
    );
    assert_shows(
        &refusal(&two("share = 1.85", "share = 0.15")),
        &["`share`", "1.85", "1e-6 to 1"],
    );
}

#[test]
fn an_activity_without_load_is_refused() {
    let text = two("share = 0.85", "share = 0.15");
    let (before, load) = text
        .rsplit_once("[activity.axial_force]")
        .expect("is there");
    let without = before.to_owned() + load.trim_start_matches("\nwaveform = \"stairs-like\"");
    assert_shows(
        &refusal(&without),
        &[
            "the activity \"stairs\" has no load",
            "help: write its [activity.axial_force]: nothing is taken from another activity",
        ],
    );
    let idle = before.to_owned()
        + "[activity.axial_force]"
        + &load.replacen(
            "waveform = \"stairs-like\"",
            "knots_n = [[0, 0], [50, 0]]",
            1,
        );
    assert_shows(
        &refusal(&idle),
        &["the activity \"stairs\" has no load: its axial force is never above 0 N"],
    );
}

#[test]
fn double_and_odd_names_are_refused() {
    let named = |first: &str, second: &str| {
        let with = |name: &str| activity(&format!("name = \"{name}\"\nshare = 0.5"), "iso-like");
        refusal(&(with(first) + &with(second)))
    };
    assert_shows(
        &named("gait", "gait"),
        &[
            "two activities are called \"gait\"",
            "give each its own name",
        ],
    );
    assert_shows(
        &named("gait", "../gait"),
        &["an activity cannot be called \"../gait\"", "small letters"],
    );
    assert_shows(&named("", "gait"), &["an activity cannot be called \"\""]);
}

#[test]
fn inputs_of_the_machine_are_refused_if_there_are_activities() {
    let machine = "[machine.flexion]\nwaveform = \"iso-like\"\n";
    assert_shows(
        &refusal(&(machine.to_owned() + &two("share = 0.85", "share = 0.15"))),
        &[
            "[machine.flexion] is given, but the inputs of the machine are those of each [[activity]]",
            "help: move it into the activities, as [activity.flexion]",
        ],
    );
}

#[test]
fn an_activity_that_is_no_list_of_tables_is_refused() {
    assert!(good("activity = []\n").activities.is_empty());
    for text in ["[activity]\nname = \"gait\"\n", "activity = [1]\n"] {
        assert_shows(
            &refusal(text),
            &["`activity`", "tables, each headed [[activity]]"],
        );
    }
    assert_shows(
        &refusal(&activity(
            "name = \"gait\"\nshare = 1.0\nspeed = 3",
            "iso-like",
        )),
        &["[[activity]] has no key `speed`"],
    );
}

#[test]
fn constants_of_creep_out_of_range_are_refused_at_their_place() {
    let law = "[creep]\nlaw = \"lee-pienkowski\"\n";
    assert_shows(
        &refusal(&format!("{law}strain_per_decade_per_mpa = 0.5\n")),
        &[
            "`strain_per_decade_per_mpa`",
            ",-[case.toml:3:",
            "0 to 0.005",
        ],
    );
    assert_shows(
        &refusal(&format!("{law}recovering_fraction = -0.1\n")),
        &["`recovering_fraction`", "0 to 1"],
    );
    assert_shows(
        &refusal("[creep]\nlaw = \"lee\"\n"),
        &["`law` cannot be \"lee\""],
    );
    assert_shows(
        &refusal("[creep]\nrecovering_fraction = 0.5\n"),
        &["`recovering_fraction`"],
    );
}
