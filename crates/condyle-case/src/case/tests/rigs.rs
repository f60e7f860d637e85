//! Machines by joints: what is refused, and where.

use std::path::Path;

use condyle::Vec3;

use crate::case::{Case, Preset, template};

const HIP: &str = r#"
[femur]
shape = "sphere"
radius_mm = 14.0
[insert]
shape = "cup"
[machine]
tests = "hip"
[[machine.joints]]
name = "press"
kind = "translation"
axis = [0, -1, 0]
drive = "loaded"
[machine.joints.load]
knots_n = [[0, 3000]]
[[machine.joints]]
name = "flexion"
kind = "rotation"
axis = [0, 0, 1]
drive = "prescribed"
[machine.joints.motion]
knots_deg = [[0, 20], [50, -20]]
"#;

/// Returns the key and the message of the first problem.
fn refusal(text: &str) -> (String, String) {
    let problems = Case::parse(text, "case.toml", Path::new("")).expect_err("it is refused");
    let first = &problems.problems()[0];
    (
        first.key().unwrap_or_default().to_owned(),
        first.to_string(),
    )
}

#[test]
fn a_machine_by_joints_is_written_and_read_back() {
    let case = Case::parse(HIP, "case.toml", Path::new("")).unwrap();
    let again = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
    assert_eq!(case, again);
    for &preset in Preset::ALL {
        let case = Case::parse(&template(preset), "case.toml", Path::new("")).unwrap();
        let is_by_joints = case.machine.rig.is_some();
        assert_ne!(is_by_joints, preset.machine().is_knee_simulator());
    }
}

#[test]
fn round_off_of_an_axis_is_no_tilt() {
    let exact = Case::parse(HIP, "case.toml", Path::new("")).unwrap();
    let rounded = HIP.replace("axis = [0, -1, 0]", "axis = [1e-9, -1, -3e-8]");
    let rounded = Case::parse(&rounded, "case.toml", Path::new("")).unwrap();
    assert_eq!(rounded, exact);
}

#[test]
fn verify_rotations_of_the_presets_have_the_signs_of_their_names() {
    let (anterior, lateral, up) = (Vec3::x(), Vec3::z(), Vec3::y());
    // A positive rotation moves the first direction of the counterface towards the second. The stem of a head points up, and
    // the shank stands below the ankle.
    let motions = [
        (Preset::Iso142421Like, "flexion", up, anterior),
        (Preset::Iso142421Like, "abduction", up, lateral),
        (Preset::Iso142421Like, "rotation", anterior, -lateral),
        (Preset::Iso142424Like, "flexion", up, anterior),
        (Preset::Iso142424Like, "abduction", up, lateral),
        (Preset::Iso142424Like, "rotation", anterior, -lateral),
        (Preset::Iso181921LumbarLike, "flexion", up, anterior),
        (Preset::Iso181921LumbarLike, "bending", up, -lateral),
        (Preset::Iso181921LumbarLike, "rotation", anterior, -lateral),
        (Preset::Iso181921CervicalLike, "flexion", up, anterior),
        (Preset::Iso181921CervicalLike, "bending", up, -lateral),
        (
            Preset::Iso181921CervicalLike,
            "rotation",
            anterior,
            -lateral,
        ),
        (Preset::Iso22622Like, "flexion", anterior, -up),
        (Preset::Iso22622Like, "rotation", anterior, -lateral),
        (Preset::Iso22622DisplacementLike, "flexion", anterior, -up),
        (
            Preset::Iso22622DisplacementLike,
            "rotation",
            anterior,
            -lateral,
        ),
    ];
    for (preset, name, from, towards) in motions {
        let mut joints = preset.machine().joints.iter();
        let joint = joints.find(|joint| joint.keys.name == name).expect(name);
        let moved = Vec3::from(joint.keys.axis).cross(&from);
        assert_eq!(moved, towards, "{} {name}", preset.word());
    }
    // In stance a hip is adducted, and an ankle dorsiflexed before the toe lifts.
    for (preset, name, knot) in [
        (Preset::Iso142421Like, "abduction", "[21, -7]"),
        (Preset::Iso142424Like, "abduction", "[21, -7]"),
        (Preset::Iso22622Like, "flexion", "[45, 15]"),
        (Preset::Iso22622DisplacementLike, "flexion", "[45, 15]"),
    ] {
        let joints = preset.text().split("[[joints]]");
        let joint = joints.filter(|joint| joint.contains(&format!("name = \"{name}\"")));
        assert!(
            joint.last().expect(name).contains(knot),
            "{} {name}",
            preset.word()
        );
    }
}

#[test]
fn machines_that_cannot_work_are_refused_at_their_place() {
    let second = "[[machine.joints]]\nname = \"aside\"\nkind = \"translation\"\naxis = [0, 2e-1, 0]\ndrive = \"loaded\"\n";
    for (change, to, key, message) in [
        (
            "drive = \"loaded\"",
            "drive = \"locked\"",
            "machine.joints.load",
            "is locked, and has a waveform of load",
        ),
        (
            "axis = [0, -1, 0]",
            "axis = [1, 0, 0]",
            "machine.joints",
            "one joint that presses",
        ),
        (
            "axis = [0, -1, 0]",
            "axis = [0, 1, 0]",
            "machine.joints",
            "never presses the bodies together",
        ),
        (
            "knots_n = [[0, 3000]]",
            "knots_n = [[0, 0], [50, -3000]]",
            "machine.joints",
            "never presses the bodies together",
        ),
        (
            "axis = [0, 0, 1]",
            "axis = [0, 0, 0]",
            "machine.joints.axis",
            "has no direction",
        ),
        (
            "name = \"flexion\"",
            "name = \"press\"",
            "machine.joints.name",
            "two joints are called \"press\"",
        ),
        (
            "kind = \"rotation\"",
            "kind = \"rotation\"\nlocked_at_mm = 1.0",
            "machine.joints.locked_at_mm",
            "does not fit the",
        ),
        (
            "[machine.joints.motion]\nknots_deg = [[0, 20], [50, -20]]",
            "turns_per_cycle = 0.5",
            "machine.joints.turns_per_cycle",
            "does not repeat",
        ),
        (
            "[machine.joints.motion]\nknots_deg = [[0, 20], [50, -20]]",
            second,
            "machine.joints",
            "needs one of [joints.motion]",
        ),
        (
            "tests = \"hip\"",
            "tests = \"hip\"\norder = [\"press\"]",
            "machine.order",
            "must name every joint once",
        ),
        (
            "drive = \"prescribed\"",
            "drive = \"prescribed\"\nspring_nm_per_deg = [1, 1]",
            "machine.joints.spring_nm_per_deg",
            "its spring has no effect",
        ),
        (
            "axis = [0, -1, 0]",
            "axis = [0, -1, 0]\nspring_nm_per_deg = [1, 1]",
            "machine.joints.spring_nm_per_deg",
            "does not fit the",
        ),
        (
            "drive = \"prescribed\"",
            "drive = \"prescribed\"\nzeroed = true",
            "machine.joints.zeroed",
            "has settled: only translations can",
        ),
        (
            "kind = \"rotation\"\naxis = [0, 0, 1]",
            "kind = \"translation\"\naxis = [0, 0, 1]\nzeroed = true\nlocked_at_mm = 5\ndrive = \"locked\"\n\
             [[machine.joints]]\nname = \"turn\"\nkind = \"rotation\"\naxis = [0, 0, 1]",
            "machine.joints.zeroed",
            "its drive holds it; settling",
        ),
        (
            "drive = \"prescribed\"",
            "drive = \"prescribed\"\nlocked_at_deg = 5",
            "machine.joints.locked_at_deg",
            "has no effect on the joint \"flexion\"",
        ),
        (
            "drive = \"prescribed\"",
            "drive = \"prescribed\"\nfree_play_deg = 5",
            "machine.joints.free_play_deg",
            "has no effect on the joint \"flexion\"",
        ),
        (
            "drive = \"prescribed\"",
            "drive = \"prescribed\"\npoint_from = \"origin\"",
            "machine.joints.point_from",
            "has no effect on the joint \"flexion\"",
        ),
        (
            "tests = \"hip\"",
            "tests = \"hip\"\nap_force_sign = -1",
            "machine.ap_force_sign",
            "needs a knee simulator",
        ),
        (
            "radius_mm = 14.0",
            "radius_mm = 14.2",
            "insert.shape",
            "is not larger than its sphere",
        ),
        (
            "shape = \"sphere\"",
            "shape = \"cylinder\"",
            "insert.shape",
            "needs a sphere or a mesh",
        ),
    ] {
        let changed = HIP.replace(change, to);
        assert_ne!(changed, HIP);
        let (at, found) = refusal(&changed);
        assert!(found.contains(message), "{to}: {found}");
        assert!(at.starts_with(key) || key.starts_with(&at), "{to}: {at}");
    }
    let lifted = HIP.replace("axis = [0, -1, 0]", "axis = [0, 1, 0]\nmoves = \"bearing\"");
    assert!(Case::parse(&lifted, "case.toml", Path::new("")).is_ok());
    let parallel = format!("{HIP}{second}");
    assert!(refusal(&parallel).1.contains("move along the same line"));
}

#[test]
fn a_cup_needs_a_machine_for_hips() {
    let (_, message) =
        refusal("[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\n");
    assert!(
        message.contains("a cup needs another machine than the knee simulator"),
        "{message}"
    );
}

const LIGAMENT: &str = "[[machine.ligaments]]\nname = \"pcl\"\non_bearing_mm = [-20, -8, 0]\n\
                        on_counterface_mm = [2, -6, 0]\nstiffness_n = 9000\nslack_length_mm = 30\n";

#[test]
fn ligaments_are_written_and_read_back_on_any_machine() {
    for machine in [
        HIP,
        "",
        "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\n[machine]\npreset = \"iso-14242-1-like\"\n",
    ] {
        let case =
            Case::parse(&format!("{machine}{LIGAMENT}"), "case.toml", Path::new("")).unwrap();
        let again = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
        assert_eq!(case, again);
        let ligaments = case
            .machine
            .rig
            .map_or(case.machine.ligaments, |rig| rig.ligaments);
        assert_eq!(ligaments.len(), 1);
    }
}

#[test]
fn ligaments_need_names_that_differ_and_fit_a_column() {
    for (name, message) in [
        ("mcl, deep", "cannot be called \"mcl, deep\""),
        ("", "cannot be called \"\""),
        ("medial-force", "cannot be called \"medial-force\""),
    ] {
        let (key, said) = refusal(&LIGAMENT.replace("pcl", name));
        assert!(
            key.ends_with("name") && said.contains(message),
            "{key}: {said}"
        );
    }
    for bodies in ["", HIP] {
        let (key, said) = refusal(&format!("{bodies}{LIGAMENT}{LIGAMENT}"));
        assert!(
            key.ends_with("name") && said.contains("are called \"pcl\""),
            "{key}: {said}"
        );
    }
}

#[test]
fn activities_share_the_ligaments_of_the_machine() {
    let text = with_activities("[[0, 3000]]", "[[0, 3500]]");
    let (machine, activities) = text.split_once("[[activity]]").unwrap();
    let of_all = format!("{machine}{LIGAMENT}[[activity]]{activities}");
    assert!(Case::parse(&of_all, "case.toml", Path::new("")).is_ok());
    let own = LIGAMENT
        .replace("machine.", "activity.")
        .replace("pcl", "acl");
    let (_, said) = refusal(&format!("{of_all}{own}"));
    assert!(
        said.contains("its ligaments are (acl, pcl) in place of (pcl)"),
        "{said}"
    );
}

#[test]
fn a_disc_has_no_side() {
    let (key, said) = refusal(&format!(
        "side = \"left\"\n{}",
        HIP.replace("\"hip\"", "\"disc\"")
    ));
    assert!(
        key.ends_with("side") && said.contains("a disc has no side"),
        "{key}: {said}"
    );
}

#[test]
fn ligaments_without_a_length_are_refused() {
    let none = LIGAMENT.replace("slack_length_mm = 30\n", "");
    let both = format!("{LIGAMENT}strain_at_zero = 0.0\n");
    for text in [none, both] {
        assert!(
            refusal(&text)
                .1
                .contains("needs one of `slack_length_mm` and `strain_at_zero`")
        );
    }
}

#[test]
fn a_ligament_too_short_for_its_attachments_is_refused_at_its_place() {
    let short = LIGAMENT.replace("slack_length_mm = 30", "slack_length_mm = 5");
    let case = Case::parse(&short, "case.toml", Path::new("")).unwrap();
    let error = condyle::evolve::March::start(case.build(1).unwrap().test)
        .err()
        .unwrap();
    let problems = case.placement_at_its_key(&error, &[]);
    let first = &problems.problems()[0];
    assert!(
        first
            .to_string()
            .contains("the ligament \"pcl\" is strained by"),
        "{first}"
    );
    assert!(
        first
            .key()
            .unwrap_or_default()
            .starts_with("machine.ligaments"),
        "{:?}",
        first.key()
    );
}

/// Another activity on the machine of [`HIP`]: its machine file with one change.
fn with_activities(change: &str, to: &str) -> String {
    let joints = HIP.split_once("[machine]\n").expect("it has one").1;
    let own = joints.replace("machine.joints", "activity.joints");
    assert!(own.contains(change), "{change}");
    let own = own.replacen(change, to, 1);
    format!(
        "{HIP}[[activity]]\nname = \"walking\"\nshare = 0.75\n[[activity]]\nname = \"stairs\"\nshare = 0.25\n{own}"
    )
}

#[test]
fn activities_of_a_machine_by_joints_have_their_own_drives() {
    let text = with_activities("[[0, 3000]]", "[[0, 3500]]");
    let case = Case::parse(&text, "case.toml", Path::new("")).unwrap();
    let again = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
    assert_eq!(case, again);
    let activities = case.built_activities(Vec3::zeros());
    let load_n = |number: usize| match &activities[number]
        .machine
        .joint(condyle::machine::JointIndex::ALL[0])
        .drive
    {
        condyle::machine::Drive::Loaded(load) => load.at(0.3).0,
        other => panic!("{other:?}"),
    };
    assert_eq!((load_n(0), load_n(1)), (3000.0, 3500.0));
    assert_eq!((activities[0].share, activities[1].share), (0.75, 0.25));
}

#[test]
fn a_pressing_load_slightly_beyond_zero_is_cut_off() {
    let least_n = |knots: &str| {
        let text = HIP.replacen("[[0, 3000]]", knots, 1);
        let case = Case::parse(&text, "case.toml", Path::new("")).unwrap();
        let machine = &case.built_activities(Vec3::zeros())[0].machine;
        match &machine.joint(condyle::machine::JointIndex::ALL[0]).drive {
            condyle::machine::Drive::Loaded(load) => load.range()[0],
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(least_n("[[0, 3000], [50, -5]]"), 0.0);
    assert_eq!(least_n("[[0, 3000], [50, -300]]"), -300.0);
}

#[test]
fn scales_of_machine_and_activity_multiply_every_load_and_motion() {
    let scales = |table: &str| format!("{table}\nload_scale = 1.5\nmotion_scale = 0.5\n");
    let text = with_activities("[[0, 3000]]", "[[0, 3500]]")
        .replace("[machine]\n", &scales("[machine]"))
        .replace("share = 0.25\n", "share = 0.25\nload_scale = 2.0\n");
    let case = Case::parse(&text, "case.toml", Path::new("")).unwrap();
    let again = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
    assert_eq!(case, again);
    let driven = |number: usize, joint: usize| {
        let activity = &case.built_activities(Vec3::zeros())[number];
        let joint = condyle::machine::JointIndex::ALL[joint];
        match &activity.machine.joint(joint).drive {
            condyle::machine::Drive::Loaded(waveform)
            | condyle::machine::Drive::Prescribed(waveform) => waveform.at(0.0).0,
            condyle::machine::Drive::Locked(at) => *at,
        }
    };
    assert_eq!((driven(0, 0), driven(1, 0)), (4500.0, 10_500.0));
    assert_eq!(driven(0, 1), driven(1, 1));
    assert!((driven(0, 1).to_degrees() - 10.0).abs() < 1e-12);
    let knee = "[machine]\nload_scale = 1.5\n[machine.axial_force]\nknots_n = [[0, 1000]]\n";
    let machine = machine_of(knee);
    let press = &machine.joint(condyle::machine::knee::IS).drive;
    let condyle::machine::Drive::Loaded(load) = press else {
        panic!("{press:?}")
    };
    assert_eq!(load.at(0.0).0.abs(), 1500.0);
}

#[test]
fn keys_of_machines_by_joints_are_refused_on_a_knee_simulator() {
    let loads = ["axial_force", "flexion", "ap_force", "ie_torque"];
    let loads = loads.map(|table| format!("[activity.{table}]\nwaveform = \"iso-like\"\n"));
    let loads = loads.concat();
    let spring = "name = \"a\"\nalong = \"ap\"\nabout = \"ie\"\noffset_mm = 9\nstiffness_n_per_mm = [9, 9]\n";
    let activity = |keys: &str| format!("[[activity]]\nname = \"a\"\nshare = 1\n{keys}{loads}");
    for (key, text) in [
        ("order", "[machine]\norder = [\"a\"]\n".to_owned()),
        ("tests", "[machine]\ntests = \"hip\"\n".to_owned()),
        ("motion_scale", "[machine]\nmotion_scale = 2\n".to_owned()),
        (
            "offset_springs",
            format!("[[machine.offset_springs]]\n{spring}"),
        ),
        ("load_scale", activity("load_scale = 2\n")),
        ("file", activity("file = \"stairs.toml\"\n")),
        ("order", activity("order = [\"a\"]\n")),
    ] {
        let (place, said) = refusal(&text);
        assert!(
            place.ends_with(key) && said.contains("a machine by joints"),
            "{place}: {said}"
        );
    }
}

#[test]
fn a_factor_on_motions_is_refused_where_no_joint_moves_along_a_waveform() {
    let orbital = "[machine]\npreset = \"iso-14242-3-like\"\nmotion_scale = 0.5\n";
    let (place, said) = refusal(orbital);
    assert!(
        place.ends_with("motion_scale") && said.contains("no joint moves along a waveform"),
        "{place}: {said}"
    );
}

#[test]
fn a_joint_may_be_loaded_in_one_activity_and_prescribed_in_another() {
    let aside = "[[JOINTS]]\nname = \"aside\"\nkind = \"translation\"\naxis = [1, 0, 0]\n";
    let loaded = aside.replace("JOINTS", "machine.joints") + "drive = \"loaded\"\n";
    let moved = aside.replace("JOINTS", "activity.joints")
        + "drive = \"prescribed\"\n[activity.joints.motion]\nknots_mm = [[0, 0], [50, 1]]\n";
    let text = with_activities("[[0, 3000]]", "[[0, 3500]]") + &moved;
    let text = text.replacen("[[activity]]", &(loaded + "[[activity]]"), 1);
    let case = Case::parse(&text, "case.toml", Path::new(""));
    assert!(case.is_ok(), "{:?}", case.err());
}

#[test]
fn activities_on_other_joints_are_refused_at_their_place() {
    for (change, to, message) in [
        (
            "name = \"flexion\"",
            "name = \"bending\"",
            "the machine has no joint \"bending\" to replace",
        ),
        (
            "axis = [0, 0, 1]",
            "axis = [1, 0, 0]",
            "the joint \"flexion\" has another axis",
        ),
    ] {
        let (key, said) = refusal(&with_activities(change, to));
        assert!(said.contains(message), "{said}");
        assert!(key.ends_with("joints"), "{key}");
    }
    let (_, said) = refusal(&with_activities("tests = \"hip\"", "tests = \"disc\""));
    assert!(said.contains("it tests another joint"), "{said}");
    let knee = format!(
        "{}ap_force_sign = -1\n",
        with_activities("[[0, 3000]]", "[[0, 3500]]")
            .split("tests = \"hip\"\n[[activity.joints]]")
            .next()
            .expect("it has a beginning")
    );
    let (key, said) = refusal(&knee);
    assert!(
        key.ends_with("ap_force_sign") && said.contains("knee simulator"),
        "{key}: {said}"
    );
}

#[test]
fn a_joint_of_a_case_replaces_that_of_its_preset() {
    let with = |name: &str| {
        let joint = format!(
            "name = \"{name}\"\nkind = \"translation\"\naxis = [0, -1, 0]\ndrive = \"loaded\""
        );
        let body = HIP.split_once("[machine]").expect("it has one").0;
        format!(
            "{body}[machine]\npreset = \"iso-14242-3-like\"\n[[machine.joints]]\n{joint}\n[machine.joints.load]\nknots_n = [[0, 100], [50, 2000]]\n"
        )
    };
    let case = Case::parse(&with("penetration"), "case.toml", Path::new("")).unwrap();
    let rig = case.machine.rig.as_ref().unwrap();
    let load = rig.joints[2].waveform.as_ref().unwrap();
    assert_eq!((rig.joints.len(), load.at(0.5).0), (6, 2000.0));
    let (key, said) = refusal(&with("press"));
    assert!(
        key.ends_with("joints") && said.contains("no joint \"press\""),
        "{key}: {said}"
    );
}

/// Returns the machine of a case around a bearing that is lowest at y = 1 mm.
fn machine_of(text: &str) -> condyle::machine::Machine {
    let case = Case::parse(text, "case.toml", Path::new("")).unwrap();
    let mut activities = case.built_activities(Vec3::new(0.5, 1.0, 23.0));
    activities.remove(0).machine
}

#[test]
fn a_knee_simulator_by_its_file_is_that_of_its_preset() {
    for preset in [Preset::StanmoreForce, Preset::StanmoreDisplacement] {
        let by_file = preset
            .text()
            .replace("[[joints]]", "[[machine.joints]]")
            .replace("[joints.", "[machine.joints.")
            .replace("[[offset_springs]]", "[[machine.offset_springs]]");
        let by_file = machine_of(&format!("[machine]\n{by_file}"));
        let by_word = machine_of(&format!("[machine]\npreset = {:?}\n", preset.word()));
        assert_eq!(by_file, by_word);
        assert_eq!(*by_file.mechanism, condyle::machine::knee::KNEE);
    }
}

#[test]
fn a_knee_simulator_with_a_locked_joint_has_the_results_of_knees() {
    for freedom in ["ap", "ie", "ml", "vv", "flexion"] {
        let locked = format!("[machine.freedoms.{freedom}]\ndrive = \"locked\"\n");
        let mechanism = machine_of(&locked).mechanism;
        assert_eq!(*mechanism, condyle::machine::knee::KNEE, "{freedom}");
    }
}

#[test]
fn a_spring_beside_a_joint_that_the_machine_lacks_is_refused_at_its_place() {
    let spring = |along: &str, about: &str| {
        format!(
            "[[machine.offset_springs]]\nname = \"left\"\nalong = \"{along}\"\nabout = \"{about}\"\n\
             offset_mm = 28\nstiffness_n_per_mm = [1, 2]\n"
        )
    };
    let (key, said) = refusal(&format!("{HIP}{}", spring("flexion", "flexion")));
    assert!(
        key.starts_with("machine.offset_springs")
            && said.contains("no joint with kind = \"translation\" has that name"),
        "{key}: {said}"
    );
    let (_, said) = refusal(&format!("{HIP}{}", spring("press", "turn")));
    assert!(
        said.contains("acts about \"turn\", and no joint with kind = \"rotation\""),
        "{said}"
    );
    let case = format!("{HIP}{}", spring("press", "flexion"));
    let case = Case::parse(&case, "case.toml", Path::new("")).unwrap();
    let again = Case::parse(&case.to_toml(), "case.toml", Path::new("")).unwrap();
    assert_eq!(case, again);
}

#[test]
fn a_joint_takes_the_shipped_waveforms_of_its_unit() {
    let with =
        |waveform: &str| HIP.replace("knots_n = [[0, 3000]]", &format!("waveform = {waveform:?}"));
    let case = Case::parse(&with("iso-like-axial-force"), "case.toml", Path::new("")).unwrap();
    let load = case.machine.rig.unwrap().joints[0]
        .waveform
        .clone()
        .unwrap();
    assert_eq!(load.at(0.13).0, 2600.3);
    let (key, said) = refusal(&with("iso-like-ie-torque"));
    assert!(
        key.ends_with("waveform") && said.contains("cannot be \"iso-like-ie-torque\""),
        "{key}: {said}"
    );
}
