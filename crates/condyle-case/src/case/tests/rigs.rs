//! Machines by joints: what is refused, and where.

use std::path::Path;

use crate::case::Case;

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
    for preset in ["iso-14242-1-like", "iso-14242-3-like", "pin-on-disc"] {
        let preset = crate::case::Preset::from_word(preset).unwrap();
        let text = crate::case::template(preset);
        let case = Case::parse(&text, "case.toml", Path::new("")).unwrap();
        assert!(case.machine.rig.is_some());
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
            "needs a sphere",
        ),
    ] {
        let changed = HIP.replace(change, to);
        assert_ne!(changed, HIP);
        let (at, found) = refusal(&changed);
        assert!(found.contains(message), "{to}: {found}");
        assert!(at.starts_with(key) || key.starts_with(&at), "{to}: {at}");
    }
    let parallel = format!("{HIP}{second}");
    assert!(refusal(&parallel).1.contains("move along the same line"));
}

#[test]
fn a_cup_needs_a_machine_for_hips() {
    let (_, message) =
        refusal("[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\n");
    assert!(
        message.contains("a cup needs a machine by joints"),
        "{message}"
    );
}
