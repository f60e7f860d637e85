//! Every problem that stands in the case file itself.

use condyle::geometry::{Insert, Meshing, flat_insert};

use super::{assert_shows, parsed, refusal};
use crate::cache::KeepNothing;
use crate::case::{Case, SharedBodies};
use crate::config::{Problem, RenderStyle};
use condyle::contact::FrictionModel;

#[test]
fn syntax_errors_are_all_shown() {
    let shown = refusal("title = \n[femur\n[insert]\nedge_mm = 1.0 2\n");
    assert_shows(
        &shown,
        &[
            "this is not TOML: ",
            ",-[case.toml:1:9]",
            "help: a line is `key = value`",
            "this is not TOML: unclosed table, expected `]`",
            ",-[case.toml:2:7]",
            " 2 | [femur",
            "   :       ^",
            ",-[case.toml:4:11]",
        ],
    );
}

#[test]
fn unknown_key_offers_the_nearest() {
    let shown = refusal("[insert]\nlayer = 3\n");
    assert_shows(
        &shown,
        &[
            "x [insert] has no key `layer`",
            ",-[case.toml:2:1]",
            " 2 | layer = 3",
            "   : ^^^^^",
            "help: did you mean `layers`?",
        ],
    );
}

#[test]
fn unknown_key_like_no_other_lists_the_keys() {
    let shown = refusal("[material]\ncolour = \"white\"\n");
    assert_shows(
        &shown,
        &[
            "x [material] has no key `colour`",
            "help: remove it; the keys here are youngs_modulus_mpa, poissons_ratio,",
        ],
    );
}

#[test]
fn unknown_table_is_an_unknown_key() {
    assert_shows(
        &refusal("[machines]\n"),
        &["no key `machines`", "did you mean `machine`?"],
    );
}

#[test]
fn key_in_another_unit_names_the_key_and_converts() {
    let cases = [
        (
            "[insert]\nedge_m = 0.001\n",
            "`edge_mm`, in mm",
            "write `edge_mm = 1`",
        ),
        (
            "[insert]\nedge_cm = 0.1\n",
            "`edge_mm`, in mm",
            "write `edge_mm = 1`",
        ),
        (
            "[material]\nyoungs_modulus_gpa = 0.463\n",
            "`youngs_modulus_mpa`, in MPa",
            "write `youngs_modulus_mpa = 463`",
        ),
        (
            "[machine]\nvv_axis_medial_in = \"x\"\n",
            "`vv_axis_medial_mm`, in mm",
            "write `vv_axis_medial_mm`, with the value in mm",
        ),
        (
            "[machine.freedoms.ap]\ninertia_kg_m2 = 3.0\n",
            "`inertia_kg`, in kg",
            "write `inertia_kg`, with the value in kg",
        ),
    ];
    for (text, meant, advice) in cases {
        let shown = refusal(text);
        let expected = [
            "another unit",
            "the key is ",
            meant,
            "[case.toml:2:1]",
            "^^^^",
            advice,
        ];
        assert_shows(&shown, &expected);
    }
}

#[test]
fn key_of_a_mesh_on_a_generic_femur_contradicts() {
    let shown = refusal("[femur]\nshape = \"generic\"\nlength_unit = \"m\"\n");
    assert_shows(
        &shown,
        &[
            "`length_unit` belongs to shape = \"mesh\", but this case has shape = \"generic\"",
            " 3 | length_unit = \"m\"",
            "   : ^^^^^^^^^^^",
            "help: remove it, or write `shape = \"mesh\"`",
        ],
    );
}

#[test]
fn keys_of_a_pressure_law_belong_to_the_foundation() {
    let shown =
        refusal("[contact]\nmodel = \"deformable\"\n[contact.foundation]\nlaw = \"softening\"\n");
    assert_shows(
        &shown,
        &[
            "`[contact.foundation]` belongs to model = \"foundation\", but this case has model = \"deformable\"",
            " 3 | [contact.foundation]",
            "help: remove it, or write `model = \"foundation\"`",
        ],
    );
    let shown = refusal("[contact]\nmodel = \"elastic\"\n");
    assert_shows(&shown, &["elastic"]);
    assert!(
        shown.contains("foundation") && shown.contains("deformable"),
        "{shown}"
    );
    let shown = refusal("[contact]\nmodel = \"deformable\"\nfrictoin = 0.1\n");
    assert_shows(&shown, &["no key `frictoin`", "did you mean `friction`?"]);
}

#[test]
fn a_deformable_insert_is_written_without_a_law() {
    let case = parsed("[contact]\nmodel = \"deformable\"\nfriction = 0.1\n");
    let case = case.expect("it is a good case");
    let written = case.to_toml();
    assert!(written.contains("model = \"deformable\""), "{written}");
    assert!(!written.contains("[contact.foundation]"), "{written}");
    assert!(written.contains("[contact.deformable]"), "{written}");
}

#[test]
fn a_wrong_yield_stress_is_reported_at_its_place() {
    let of = |keys: &str| {
        refusal(&format!(
            "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nplasticity = \"j2\"\n{keys}\n"
        ))
    };
    let shown = of("hardening = [[0.0, 14.0], [0.1, 13.0]]");
    assert_shows(
        &shown,
        &[
            "`hardening`: the hardening curve falls at point 2, from 14 to 13",
            " 5 | hardening",
        ],
    );
    let shown = of("hardening = [[0.01, 14.0], [0.1, 20.0]]");
    assert_shows(
        &shown,
        &["must start at plastic strain 0 with the yield stress"],
    );
    let shown = of("hardening = [[0.0, 15.0], [0.1, 20.0]]");
    assert_shows(
        &shown,
        &["`hardening` starts at 15 MPa, and yield_stress_mpa is 14"],
    );
    let shown = of("yield_stress_mpa = 0.0");
    assert_shows(&shown, &["yield_stress_mpa", " 5 | yield_stress_mpa = 0.0"]);
    let shown = refusal(
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nyield_stress_mpa = 12.0\n",
    );
    assert_shows(
        &shown,
        &["`yield_stress_mpa` belongs to plasticity = \"j2\""],
    );
    let shown = refusal("[contact.deformable]\nplasticity = \"j2\"\n");
    let belongs = "`[contact.deformable]` belongs to model = \"deformable\"";
    assert_shows(&shown, &[belongs, " 1 | [contact.deformable]"]);
}

#[test]
fn a_case_with_plasticity_is_written_and_read_again() {
    let keys =
        "plasticity = \"j2\"\nyield_stress_mpa = 12.0\nhardening = [[0.0, 12.0], [0.1, 20.0]]";
    let text = format!("[contact]\nmodel = \"deformable\"\n[contact.deformable]\n{keys}\n");
    let case = parsed(&text).expect("it is a good case");
    let again = parsed(&case.to_toml()).expect("what is written is a good case");
    assert_eq!(again.contact, case.contact);
}

#[test]
fn friction_that_sticks_is_that_of_a_deformable_insert_and_of_solved_increments() {
    let shown = refusal("[contact.deformable]\nfriction_model = \"stick-slip\"\n");
    assert_shows(
        &shown,
        &["`[contact.deformable]` belongs to model = \"deformable\""],
    );
    let sticking = "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nfriction_model = \"stick-slip\"\n";
    let case = parsed(sticking).expect("it is a good case");
    let again = parsed(&case.to_toml()).expect("what is written is a good case");
    assert_eq!(again.contact, case.contact);
    let model = again.contact.deformable().expect("it is deformable");
    assert_eq!(model.friction_model, FrictionModel::StickSlip);
    let explicit = format!("{sticking}[time]\nintegrator = \"explicit\"\n");
    let case = parsed(&explicit).expect("its keys are good");
    let refused = case
        .contact_law(&flat(), &KeepNothing, &SharedBodies::default())
        .expect_err("it is refused");
    assert_shows(
        &refused.to_string(),
        &[
            "friction_model = \"stick-slip\"",
            "take [time] integrator = \"implicit\"",
        ],
    );
}

#[test]
fn a_backside_that_rests_is_that_of_a_deformable_insert_alone_and_of_solved_increments() {
    let deformable = "[contact]\nmodel = \"deformable\"\n[contact.deformable]\n";
    let shown = refusal(&format!("{deformable}backside_friction = 0.1\n"));
    assert_shows(
        &shown,
        &["`backside_friction` belongs to backside = \"resting\""],
    );
    let resting = format!("{deformable}backside = \"resting\"\n");
    let shown = refusal(&format!("{resting}backside_friction = -0.1\n"));
    assert_shows(
        &shown,
        &["`backside_friction` is -0.1", "it can be 0 to 1000"],
    );
    let shown = refusal(&format!("{deformable}backside = \"glued\"\n"));
    assert_shows(&shown, &["\"bonded\"", "\"resting\""]);
    let case = parsed(&format!("{resting}backside_friction = 0.15\n")).expect("it is a good case");
    let again = parsed(&case.to_toml()).expect("what is written is a good case");
    assert_eq!(again.contact, case.contact);
    for (beside, word) in [
        (
            "plasticity = \"j2\"",
            "cannot be combined with plasticity = \"j2\"",
        ),
        (
            "friction_model = \"stick-slip\"",
            "cannot be combined with friction_model",
        ),
        (
            "[time]\nintegrator = \"explicit\"",
            "take [time] integrator = \"implicit\"",
        ),
    ] {
        let case = parsed(&format!("{resting}{beside}\n")).expect("its keys are good");
        let refused = case
            .contact_law(&flat(), &KeepNothing, &SharedBodies::default())
            .expect_err("it is refused");
        assert_shows(&refused.to_string(), &["backside = \"resting\"", word]);
    }
}

#[test]
fn a_backside_that_is_not_flat_cannot_rest() {
    let resting =
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nbackside = \"resting\"\n";
    let case = parsed(resting).expect("it is a good case");
    let mut mesh = flat().mesh().clone();
    for node in &mut mesh.nodes {
        node.y += 0.1 * node.x * node.x;
    }
    let quads = mesh.boundary_quads();
    let facing = |sign: f64| {
        let is_facing = |quad: &&[u32; 4]| {
            let [a, b, c, d] = quad.map(|node| mesh.nodes[node as usize]);
            let normal = (c - a).cross(&(d - b)).normalize();
            sign * normal.y > 0.6
        };
        quads.iter().filter(is_facing).copied().collect::<Vec<_>>()
    };
    let bent = Insert::new(mesh.clone(), &facing(1.0), &facing(-1.0)).expect("it is an insert");
    let refused = case
        .contact_law(&bent, &KeepNothing, &SharedBodies::default())
        .expect_err("it is refused");
    let words = [
        "needs a flat backside",
        "lies in a plane",
        "backside = \"bonded\"",
    ];
    assert_shows(&refused.to_string(), &words);
}

/// A flat insert.
fn flat() -> Insert {
    let meshing = Meshing {
        edge_mm: 5.0,
        layers: 1,
    };
    flat_insert((10.0, 10.0), 5.0, meshing).unwrap()
}

#[test]
fn table_of_another_law_contradicts() {
    let shown =
        refusal("[contact.foundation]\nlaw = \"linear\"\ntable = [[0.0, 0.0], [0.1, 5.0]]\n");
    assert_shows(
        &shown,
        &[
            "`table` belongs to law = \"tabulated\"",
            "has law = \"linear\"",
        ],
    );
}

#[test]
fn wrong_type_names_the_type_that_is_required() {
    let cases = [
        (
            "title = 3\n",
            "`title` must be text in quotes, this is an integer",
            "1:9",
        ),
        (
            "[insert]\nedge_mm = \"1\"\n",
            "must be a number, this is text in quotes",
            "2:11",
        ),
        (
            "[insert]\nlayers = 2.5\n",
            "must be a whole number, this is a number",
            "2:10",
        ),
        (
            "side = true\n",
            "must be \"right\" or \"left\", this is true or false",
            "1:8",
        ),
        (
            "femur = 1\n",
            "`femur` must be a table, [femur], this is an integer",
            "1:9",
        ),
        (
            "[machine]\nap_force_sign = 2\n",
            "must be 1 or -1, this is an integer",
            "2:17",
        ),
        (
            "[femur]\nstart_mm = [1.0]\n",
            "must be a list of two numbers, this is a list",
            "2:12",
        ),
        (
            "[femur]\nstart_mm = 2.0\n",
            "must be a list of two numbers, this is a number",
            "2:12",
        ),
        (
            "[machine.flexion]\nfile = 1979-05-27\n",
            "`file` must be a path in quotes, this is a date",
            "2:8",
        ),
        (
            "[machine.flexion]\nwaveform = \"none\"\nremove_drift = 1\n",
            "`remove_drift` must be true or false, this is an integer",
            "3:16",
        ),
        (
            "[machine.flexion]\nknots_deg = 3.0\n",
            "`knots_deg` must be a list of pairs, such as [[0.0, 1.0], [50.0, 2.0]], this is a",
            "2:13",
        ),
        (
            "[machine.flexion]\nknots_deg = [[0.0, 1.0], [50.0, 2.0, 3.0]]\n",
            "`knots_deg` must be made of pairs of numbers, this is a list",
            "2:26",
        ),
    ];
    for (text, message, place) in cases {
        assert_shows(
            &refusal(text),
            &[message, &format!("[case.toml:{place}]"), "^"],
        );
    }
}

#[test]
fn unknown_word_offers_the_nearest_and_lists_all() {
    let shown = refusal("[contact.foundation]\nlaw = \"logaritmic\"\n");
    assert_shows(
        &shown,
        &[
            "`law` cannot be \"logaritmic\"",
            "   :       ^^^^^^^^^^^^",
            "did you mean \"logarithmic\"? It can be \"linear\", \"logarithmic\", \"softening\", \"tabulated\" or",
            "\"tabulated-strain\"",
        ],
    );
    let shown = refusal("side = \"up\"\n");
    assert_shows(
        &shown,
        &["`side` cannot be \"up\"", "it can be \"right\" or \"left\""],
    );
    let shown = refusal("[machine.axial_force]\nwaveform = \"none\"\n");
    assert_shows(
        &shown,
        &[
            "`waveform` cannot be \"none\"",
            "\"iso-like\", \"paper-like\", \"stairs-like\" or \"chair-like\"",
        ],
    );
}

#[test]
fn number_outside_its_range_shows_the_range_with_its_unit() {
    let shown = refusal("[insert]\nthickness_mm = -9.0\n");
    assert_shows(
        &shown,
        &[
            "`thickness_mm` is -9 mm, outside its range",
            " 2 | thickness_mm = -9.0",
            "   :                ^^^^",
            "help: it can be 1 to 50 mm",
        ],
    );
    assert_shows(
        &refusal("[material]\npoissons_ratio = 0.5\n"),
        &["it can be 0 to 0.499"],
    );
    assert_shows(
        &refusal("[insert]\nedge_mm = nan\n"),
        &["`edge_mm` is NaN mm"],
    );
    assert_shows(
        &refusal("[femur]\nstart_mm = [0.0, 1e9]\n"),
        &["[case.toml:2:18]"],
    );
}

#[test]
fn missing_key_names_the_line_to_add() {
    let shown = refusal("[femur]\nshape = \"mesh\"\n");
    assert_shows(
        &shown,
        &[
            "x [femur] needs `file`",
            " 1 | [femur]",
            "   :  ^^^^^",
            "help: add `file = `, a path in quotes",
        ],
    );
}

#[test]
fn axes_that_mirror_or_miss_a_direction_are_refused() {
    let axes = |words: &str| {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        let shape = format!("shape = \"mesh\"\nfile = {file:?}\n");
        refusal(&format!("[femur]\n{shape}axes = {words}\n"))
    };
    assert_shows(
        &axes("[\"anterior\", \"superior\", \"left\"]"),
        &[
            "`axes`: these axes are left-handed, which would mirror the shape",
            " 4 | axes = [\"anterior\", \"superior\", \"left\"]",
            "   :        ^^^^",
            "help: name where x, y and z of the file point",
        ],
    );
    assert_shows(
        &axes("[\"left\", \"right\", \"superior\"]"),
        &["two of the axes are parallel"],
    );
    assert_shows(
        &axes("[\"ventral\", \"superior\", \"left\"]"),
        &["cannot be \"ventral\""],
    );
    assert_shows(
        &axes("[\"superior\"]"),
        &["must be three words of \"anterior\", "],
    );
}

#[test]
fn waveform_with_a_gap_a_nan_or_a_step_is_refused_at_its_point() {
    let wave = |knots: &str| refusal(&format!("[machine.flexion]\n{knots}\n"));
    assert_shows(
        &wave("knots_deg = [[0.0, 1.0], [50.0, nan]]"),
        &[
            "[machine.flexion]: point 1 of the waveform is not a finite number; correct or",
            " 2 | knots_deg = [[0.0, 1.0], [50.0, nan]]",
            "   :                          ^^^^^^^^^^^",
        ],
    );
    assert_shows(
        &wave("interpolation = \"spline\"\nknots_deg = [[0.0, 1.0], [5.0, 2.0], [90.0, 2.0]]"),
        &[
            "gap from 5 % to 90 % of the cycle; add points",
            "   :                          ^^^^",
        ],
    );
    assert_shows(
        &wave("knots_deg = [[0.0, 1.0], [100.0, 2.0]]"),
        &[
            "jumps at the end of the cycle: 1 at 0 % but 2 at 100 %",
            "help: append the movement back to its start",
        ],
    );
    assert_shows(&wave("knots_deg = []"), &["the waveform has no points"]);
    assert_shows(
        &wave("knots_deg = [[101.0, 2.0]]"),
        &["is at 101 % of the cycle"],
    );
    assert_shows(
        &wave("knots_deg = [[5.0, 1.0], [5.0, 2.0]]"),
        &["is not after the previous point at 5 %"],
    );
}

#[test]
fn waveform_value_beyond_any_machine_is_out_of_range() {
    let shown = refusal("[machine.axial_force]\nknots_n = [[0.0, 100.0], [50.0, -20.0]]\n");
    assert_shows(
        &shown,
        &[
            "`axial_force` is -20 N at 50 %",
            "^^^^^^^^^^^^^",
            "it can be 0 to 20000 N",
        ],
    );
}

#[test]
fn waveform_in_another_unit_names_the_key() {
    let shown = refusal("[machine.flexion]\nknots_rad = [[0.0, 0.0]]\n");
    assert_shows(&shown, &["the key is `knots_deg`, in degrees", "^^^^^^^^^"]);
}

#[test]
fn waveform_given_twice_is_refused_and_the_default_is_scaled() {
    let shown = refusal("[machine.flexion]\nwaveform = \"none\"\nknots_deg = [[0.0, 0.0]]\n");
    assert_shows(
        &shown,
        &[
            "[machine.flexion] has both `waveform` and `knots_deg`",
            "[case.toml:3:1]",
            "help: keep `waveform` or `knots_deg`, not both",
        ],
    );
    let waveforms = ["", "waveform = \"iso-like\"\n"].map(|named| {
        let case = parsed(&format!("[machine.axial_force]\n{named}scale = 0.5\n"));
        case.expect("a case").machine
    });
    assert_eq!(waveforms[0], waveforms[1]);
    assert_ne!(waveforms[0], parsed("").expect("a case").machine);
    // An activity takes nothing from elsewhere.
    let shown = refusal(
        "[[activity]]\nname = \"walking\"\nshare = 1.0\n[activity.axial_force]\nscale = 2.0\n[activity.flexion]\n\
         waveform = \"iso-like\"\n[activity.ap_force]\nwaveform = \"none\"\n[activity.ie_torque]\nwaveform = \"none\"\n",
    );
    assert_shows(&shown, &["needs one of `waveform`, `file`, `knots_n`"]);
    assert_eq!(
        parsed("activity = []\n").expect("a case").machine,
        parsed("").expect("a case").machine
    );
}

#[test]
fn points_of_a_cycle_from_0_to_1_are_refused() {
    let shown = refusal("[machine.flexion]\nknots_deg = [[0.0, 0.0], [0.5, 58.0], [1.0, 0.0]]\n");
    assert_shows(
        &shown,
        &["the points end at 1 % of the cycle", "[case.toml:2:39]"],
    );
}

#[test]
fn column_without_a_file_is_idle() {
    let shown = refusal("[machine.flexion]\nwaveform = \"none\"\ncolumn = \"a_deg\"\n");
    assert_shows(
        &shown,
        &[
            "`column` has no effect here: it needs `file`",
            "^^^^^^",
            "remove `column`",
        ],
    );
}

#[test]
fn prescribed_ap_with_an_ap_load_contradicts() {
    let text = "[machine]\npreset = \"stanmore-displacement\"\n[machine.ap_force]\n\
                waveform = \"iso-like\"\n";
    assert_shows(
        &refusal(text),
        &[
            "[machine.ap_force] is given, but the ap freedom is prescribed; these contradict each other",
            " 3 | [machine.ap_force]",
            "   :          ^^^^^^^^",
            "help: remove [machine.ap_force], or make the freedom `drive = \"loaded\"`",
        ],
    );
}

#[test]
fn drive_without_a_waveform_is_refused() {
    let shown = refusal("[machine.freedoms.ml]\ndrive = \"prescribed\"\n");
    assert_shows(
        &shown,
        &[
            "the ml freedom cannot be prescribed: a case has no waveform for that",
            "   :         ^^^^^^^^^^^^",
            "help: it can be \"locked\" or \"loaded\"",
        ],
    );
}

#[test]
fn place_to_lock_a_free_freedom_is_idle() {
    let shown = refusal("[machine.freedoms.vv]\nlocked_at_deg = 2.0\n");
    assert_shows(
        &shown,
        &[
            "`locked_at_deg` has no effect here: it needs `drive = \"locked\"`",
            "^^^^^^^^^^^^^",
        ],
    );
}

#[test]
fn pressure_table_must_rise_from_zero_and_be_given_once() {
    let table = |rest: &str| {
        refusal(&format!(
            "[contact.foundation]\nlaw = \"tabulated\"\n{rest}\n"
        ))
    };
    assert_shows(
        &table("table = [[0.0, 0.0], [0.1, 5.0], [0.2, 5.0]]"),
        &[
            "`table`: point 2 of the pressure table does not rise",
            "   :                                  ^^^^^^^^^^",
        ],
    );
    assert_shows(&table("table = [[0.0, 0.0]]"), &["it has 1"]);
    assert_shows(
        &table("table = [[0.1, 0.0], [0.2, 1.0]]"),
        &["this one at 0.1 mm"],
    );
    assert_shows(
        &table(""),
        &["[contact.foundation] needs one of `table` or `table_file`"],
    );
    let both = "table = [[0.0, 0.0], [0.1, 5.0]]\ntable_file = \"x.csv\"";
    assert_shows(
        &table(both),
        &["[contact.foundation] has both `table` and `table_file`"],
    );
}

#[test]
fn strain_table_must_rise_from_zero_and_be_given_once() {
    let table = |rest: &str| {
        refusal(&format!(
            "[contact.foundation]\nlaw = \"tabulated-strain\"\n{rest}\n"
        ))
    };
    assert_shows(
        &table("strain_table = [[0.01, 0.0], [0.02, 1.0]]"),
        &[
            "`strain_table`: a pressure table starts at overclosure over thickness 0",
            "at 0.01 and 0 MPa",
        ],
    );
    assert_shows(
        &table(""),
        &["[contact.foundation] needs one of `strain_table` or `strain_table_file`"],
    );
    assert_shows(&table("table = [[0.0, 0.0], [0.1, 5.0]]"), &["`table`"]);
    let rising = "strain_table = [[0.0, 0.0], [0.02, 1.0]]\npeak_error_percent = -1.0";
    assert_shows(&table(rising), &["peak_error_percent"]);
}

#[test]
fn all_problems_are_reported_at_once_in_the_order_of_the_file() {
    let text = "sides = \"left\"\n[femur]\nspacing_mm = 1e3\n[insert]\nedge_m = 1\n[time]\n\
                increments = \"many\"\n";
    let Err(error) = parsed(text) else {
        panic!("four things are wrong");
    };
    let places: Vec<_> = error
        .problems()
        .iter()
        .map(Problem::line_and_column)
        .collect();
    assert_eq!(
        places,
        [Some((1, 1)), Some((3, 14)), Some((5, 1)), Some((7, 14))]
    );
    assert!(
        error
            .problems()
            .iter()
            .all(|problem| problem.file() == Some("case.toml"))
    );
}

#[test]
fn a_terminal_gets_colour_and_a_log_none() {
    let Err(error) = parsed("side = \"up\"\n") else {
        panic!("no such side");
    };
    assert!(error.render(RenderStyle::Plain).is_ascii());
    assert!(
        error
            .render(RenderStyle::Terminal { width: 80 })
            .contains("\u{1b}[")
    );
}

#[test]
fn an_empty_file_is_the_default_case() {
    let case = parsed("").unwrap();
    assert_eq!(case.march.cycles, 5_000_000);
    assert_eq!(
        parsed(&crate::case::template(case.machine.settings.preset)).unwrap(),
        case
    );
}

#[test]
fn numbers_may_be_written_as_integers_or_with_exponents() {
    let case: Case = parsed("[insert]\nedge_mm = 1\n[march]\ncycles = 1e6\n").unwrap();
    assert_eq!(case.march.cycles, 1_000_000);
}
