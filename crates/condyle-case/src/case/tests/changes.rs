//! Values set from outside, and keys under their previous names.

use std::path::Path;

use condyle_mesh::files::MemoryFiles;

use crate::case::{Assignment, Case, CaseReader, ChangeError};
use crate::config::{Choices, Item};
use condyle::wear::WEAR_LAWS;

fn changed(text: &str, changes: &[&str]) -> Result<Case, ChangeError> {
    let files = MemoryFiles::default().with("/case.toml", text);
    let changes: Vec<Assignment> = changes
        .iter()
        .map(|change| Assignment::parse(change).expect("a key and a value"))
        .collect();
    CaseReader::new(files).read_changed(Path::new("/case.toml"), &changes)
}

fn refusal(text: &str, changes: &[&str]) -> String {
    match changed(text, changes) {
        Ok(_) => panic!("{changes:?} is taken"),
        Err(error) => error.to_string(),
    }
}

fn warnings(case: &Case) -> Vec<String> {
    let built = case.build(1).expect("it builds");
    built.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_last_word_is_found_for_any_choice_that_is_set_beside_it() {
    for (set, placed) in [
        (
            ["cross_linking=high", "wear_over_conventional=0.1"],
            [
                "material.cross_linking=high",
                "material.wear_over_conventional=0.1",
            ],
        ),
        (
            ["cross_linking=high", "material.wear_over_conventional=0.1"],
            [
                "material.cross_linking=high",
                "material.wear_over_conventional=0.1",
            ],
        ),
        (
            ["update=auto", "depth_tolerance_fraction=0.1"],
            ["march.update=auto", "march.depth_tolerance_fraction=0.1"],
        ),
    ] {
        assert_eq!(changed("", &set).unwrap(), changed("", &placed).unwrap());
    }
}

#[test]
fn values_replace_those_of_the_file_or_its_defaults() {
    let text = "[march]\nupdates = 2 # few\n";
    let case = changed(
        text,
        &["march.updates=5", "time.increments = 0x40", "side=left"],
    );
    let expected = "side = \"left\"\n[march]\nupdates = 5\n[time]\nincrements = 64\n";
    assert_eq!(case.unwrap(), changed(expected, &[]).unwrap());
    let last = changed(text, &["march.updates=5", "updates=7"]).unwrap();
    assert_eq!(last.number_at("march.updates"), Some(7.0));
    let inline = changed(
        "machine.frequency_hz = 2\n",
        &["machine.springs.free_play_mm=1.5"],
    );
    assert_eq!(inline.unwrap().machine.springs.free_play_mm, 1.5);
}

#[test]
fn a_wrong_value_is_shown_at_its_line_below_the_file() {
    let shown = refusal(
        "[march]\nupdates = 2\n",
        &["march.cycles=100", "contact.friction=9"],
    );
    for part in [
        "`friction` is 9, outside its range",
        "/case.toml with march.cycles = 100, contact.friction = 9:4:20",
        " 4 | contact.friction = 9",
    ] {
        assert!(shown.contains(part), "{shown}\n{part}");
    }
    let Err(ChangeError::Case(problems)) = changed("", &["contact.friction=9"]) else {
        panic!("9 is taken");
    };
    assert_eq!(problems.problems()[0].key(), Some("contact.friction"));
    let shown = refusal("", &["march.nothing=1"]);
    assert!(shown.contains("[march] has no key `nothing`"), "{shown}");
}

#[test]
fn a_file_that_is_not_toml_is_reported_as_it_is() {
    let shown = refusal("[march\n", &["march.updates=5"]);
    assert!(shown.contains("this is not TOML"), "{shown}");
}

#[test]
fn numbers_are_finite() {
    let value = |text| Assignment::number("a.b", text).map(|number| number.as_number());
    assert_eq!(value("1_000"), Ok(Some(1000.0)));
    assert_eq!(value("-1e-3"), Ok(Some(-1e-3)));
    for text in ["", "ten", "inf", "nan", "[1]", "1 2", ".5"] {
        let error = Assignment::number("march.updates", text).expect_err(text);
        let expected = format!("`{text}` is not a valid value of `march.updates`; write a number");
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
}

#[test]
fn updates_that_a_march_determines_cannot_be_set() {
    let case = changed("[march]\nupdate = \"auto\"\n", &[]).unwrap();
    let error = case.path_of_number("updates").unwrap_err();
    assert!(
        error.to_string().contains("determines its updates"),
        "{error}"
    );
    let said = error.to_string();
    assert!(said.contains("update = \"auto\"") && said.contains("depth_tolerance_fraction"));
}

#[test]
fn names_of_numbers_are_found_with_and_without_unit() {
    let case = changed("", &[]).unwrap();
    let path = |written| case.path_of_number(written).map_err(|e| e.to_string());
    assert_eq!(path("updates").as_deref(), Ok("march.updates"));
    assert_eq!(
        path("slip_tolerance").as_deref(),
        Ok("contact.slip_tolerance_mm_per_s")
    );
    assert_eq!(path("edge_mm").as_deref(), Ok("insert.edge_mm"));
    assert_eq!(path("what.ever").as_deref(), Ok("what.ever"));
    assert!(case.is_whole_number("march.updates") && !case.is_whole_number("insert.edge_mm"));
    assert_eq!(
        path("updatse").unwrap_err(),
        "the case has no number called `updatse`; did you mean `updates`?"
    );
    assert!(path("xyz").unwrap_err().contains("such as `march.updates`"));
    let many = path("spacing_mm").unwrap_err();
    assert!(
        many.ends_with("write `femur.spacing_mm` or `insert.spacing_mm`"),
        "{many}"
    );
}

const WEAR: &str = "[wear]\nlaw = \"archard\"\nwear_factor_mm3_per_nm = 2.64e-7 # paper\n[insert]\nedge_mm = 3.0\n";

#[test]
fn a_choice_that_is_set_leaves_out_keys_of_other_choices_and_warns() {
    let case = changed(WEAR, &["wear.law=kang"]).unwrap();
    let expected = "wear.wear_factor_mm3_per_nm = 2.64e-7: ignored, since it does not apply to wear.law = \"kang\", \
                    which is set";
    assert_eq!(warnings(&case), [expected]);
    let soft = "[contact.foundation]\nlaw = \"softening\"\n[insert]\nedge_mm = 3.0\n";
    let case = changed(soft, &["contact.model=deformable"]).unwrap();
    assert!(case.contact.deformable().is_some());
    assert!(warnings(&case)[0].starts_with("[contact.foundation]: ignored"));
}

const HIP: &str = "[machine]\npreset = \"iso-14242-1-like\"\n[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\n";

#[test]
fn a_source_of_a_curve_that_is_set_replaces_the_points_of_a_written_case() {
    let written = changed("", &[]).unwrap().to_toml();
    for curve in ["machine.axial_force", "machine.flexion"] {
        let set = format!("{curve}.waveform=stairs-like");
        let case = changed(&written, &[&set]).unwrap();
        assert_eq!(case.machine, changed("", &[&set]).unwrap().machine);
        assert!(warnings(&case)[0].contains(&format!("ignored, since {curve}.waveform is set")));
    }
    let written = changed(HIP, &[]).unwrap().to_toml();
    let set = ["machine.joints.flexion.motion.knots_deg=[[0, 0], [50, 20]]"];
    assert!(changed(&written, &set).is_ok());
    let set = ["machine.joints.flexion.motion.waveform=iso-like-flexion"];
    assert!(changed(&written, &set).is_ok());
}

#[test]
fn the_last_of_two_values_counts_and_values_for_it_stay() {
    let constant = "[wear]\nlaw = \"archard\"\nwear_factor_mm3_per_nm = 2.0e-7\n";
    let set = ["wear.law=kang", "wear.law=archard"];
    assert_eq!(
        changed(constant, &set).unwrap(),
        changed(constant, &[]).unwrap()
    );
    let factor = "[material]\nwear_over_conventional = 0.3\n";
    let case = changed(factor, &["material.cross_linking=high"]).unwrap();
    assert_eq!(
        case.material.cross_linking.wear_over_conventional(),
        Some(0.3)
    );
    let scaled = "[machine.axial_force]\nfile = \"load.csv\"\nscale = 1000.0\noffset = 3.0\n";
    let set = ["machine.axial_force.waveform=stairs-like"];
    let files = MemoryFiles::default().with("/case.toml", scaled);
    let changes = set.map(|change| Assignment::parse(change).unwrap());
    let case = CaseReader::new(files).read_changed(Path::new("/case.toml"), &changes);
    assert_eq!(case.unwrap().machine, changed("", &set).unwrap().machine);
}

/// Every table of choices, with its dotted path.
fn choices<'i>(items: &'i [Item], above: &str, found: &mut Vec<(String, &'i Choices)>) {
    for item in items {
        match item {
            Item::Choice(choices_here) => {
                found.push((format!("{above}{}", choices_here.by.name), choices_here));
                for offer in &choices_here.offered {
                    choices(&offer.items, above, found);
                }
            }
            Item::Table(table) if !table.is_list => {
                choices(&table.items, &format!("{above}{}.", table.name), found);
            }
            _ => {}
        }
    }
}

#[test]
fn a_choice_that_is_set_means_the_same_where_all_keys_are_written() {
    let items = Case::items_with(WEAR_LAWS);
    let mut all = Vec::new();
    choices(&items, "", &mut all);
    let mut compared = 0;
    for (text, (key, choices)) in ["", HIP]
        .iter()
        .flat_map(|text| all.iter().map(move |one| (*text, one)))
    {
        // A word that needs other keys or another body is no case.
        let cases = choices.offered.iter().filter_map(|offer| {
            let set = format!("{key}={}", offer.word);
            changed(text, &[&set]).ok().map(|case| (set, case))
        });
        let cases: Vec<_> = cases.collect();
        for (before, written) in &cases {
            for (set, short) in &cases {
                let long = changed(&written.to_toml(), &[set]).unwrap();
                assert_eq!(long.to_toml(), short.to_toml(), "{before}, then {set}");
                compared += 1;
            }
        }
    }
    assert!(compared > 150, "{compared}");
}

#[test]
fn another_preset_of_the_machine_leaves_out_the_drives_of_the_file() {
    let displacement = "machine.preset=stanmore-displacement";
    let written = changed("", &[]).unwrap().to_toml();
    let (case, short) = (
        changed(&written, &[displacement]).unwrap(),
        changed("", &[displacement]).unwrap(),
    );
    assert_eq!(case.machine, short.machine);
    let warnings = warnings(&case);
    assert!(
        warnings
            .iter()
            .any(|one| one.starts_with("machine.freedoms.ap.drive = \"loaded\": ignored")),
        "{warnings:?}"
    );
    assert!(
        warnings
            .iter()
            .any(|one| one.starts_with("[machine.ap_force]: ignored")),
        "{warnings:?}"
    );
    assert!(
        warnings.iter().all(|one| !one.contains("ml.drive")),
        "{warnings:?}"
    );
    // What is set besides, and the preset of the file, stay.
    let same = changed(&written, &["machine.preset=stanmore-force"]).unwrap();
    assert_eq!(same.machine, changed(&written, &[]).unwrap().machine);
    let locked = changed(
        &written,
        &[displacement, "machine.freedoms.ml.drive=locked"],
    )
    .unwrap();
    assert_ne!(locked.machine, short.machine);
}

#[test]
fn a_contradiction_of_the_file_or_of_what_is_set_stays_one() {
    let text = WEAR.replace("archard", "kang");
    let shown = refusal(&text, &["march.updates=5"]);
    assert!(
        shown.contains("`wear_factor_mm3_per_nm` belongs to law"),
        "{shown}"
    );
    let set = ["wear.law=kang", "wear.wear_factor_mm3_per_nm=1e-7"];
    let shown = refusal(WEAR, &set);
    assert!(
        shown.contains("`wear_factor_mm3_per_nm` belongs to law"),
        "{shown}"
    );
}

#[test]
fn keys_are_read_under_their_previous_names_with_a_note() {
    let old = "[contact]\nmodel = \"deformable\"\nplasticity = \"j2\"\nyield_stress_mpa = 12.0\n[insert]\nedge_mm = 3.0\n";
    let new = old.replace("plasticity", "[contact.deformable]\nplasticity");
    let case = changed(old, &[]).unwrap();
    assert_eq!(case, changed(&new, &[]).unwrap());
    assert_eq!(
        warnings(&case)[0],
        "`contact.plasticity` is called `contact.deformable.plasticity`; the next version does not read the old name"
    );
    assert_eq!(case.number_at("contact.yield_stress_mpa"), Some(12.0));
    let set = changed(
        "",
        &[
            "contact.model=deformable",
            "contact.plasticity=j2",
            "contact.yield_stress_mpa=12",
        ],
    );
    assert_eq!(set.unwrap().contact, case.contact);
    let shown = refusal(&old.replace("12.0", "0.0"), &[]);
    assert!(shown.contains(" 4 | yield_stress_mpa = 0.0"), "{shown}");
    let shown = refusal("[contact]\nplasticity = \"j2\"\n", &[]);
    assert!(
        shown.contains("`[contact.deformable]` belongs to model = \"deformable\""),
        "{shown}"
    );
}

#[test]
fn a_path_with_very_many_parts_is_an_unknown_key() {
    let path = format!("contact{}friction", ".".repeat(50_000));
    let shown = refusal("", &[&format!("{path}=0.1")]);
    assert!(shown.contains("no key `contact..."), "{shown:.400}");
}
