//! Cases written out and read again, the shipped ones and their waveforms.

use std::path::Path;

use condyle::machine::{self, knee, knee::KNEE};

use super::super::waveform::words_of;
use super::{cases, has_dm_data, parsed};
use crate::case::{Case, DriveWord, FemurShape, InsertShape, Preset, Side, template};

fn shipped(name: &str) -> Case {
    Case::read(&cases().join(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// Asserts that a written case reads back equal, from any folder.
fn assert_round_trip(case: &Case) {
    let text = case.to_toml();
    match Case::parse(&text, "written.toml", Path::new("elsewhere")) {
        Ok(again) => {
            assert_eq!(&again, case);
            assert_eq!(again.to_toml(), text);
        }
        Err(error) => panic!("{error}\nin\n{text}"),
    }
}

#[test]
fn generic_cases_round_trip() {
    assert_round_trip(&shipped("stanmore-force.toml"));
    assert_round_trip(&shipped("knight-2007.toml"));
    assert_round_trip(&shipped("stanmore-displacement.toml"));
    assert_round_trip(&shipped("gait-and-stairs.toml"));
    assert_round_trip(&shipped("daily-life.toml"));
    assert_round_trip(&shipped("creep.toml"));
}

#[test]
fn dm_cases_round_trip() {
    if has_dm_data("dm_cases_round_trip") {
        assert_round_trip(&shipped("dm-knee.toml"));
        assert_round_trip(&shipped("dm-knee-displacement.toml"));
    }
}

#[test]
fn every_choice_round_trips() {
    let texts = [
        "title = \"a \\\"b\\\" \\\\ c\"\nside = \"left\"\n",
        "[femur]\nshape = \"sphere\"\nradius_mm = 12.5\nstart_mm = [1.0, -2.0]\n",
        "[femur]\nshape = \"cylinder\"\nradius_mm = 12.5\nstart_mm = [1.0, -2.0]\n",
        "[insert]\nshape = \"flat\"\nlayers = 5\n",
        "[contact.foundation]\nlaw = \"logarithmic\"\n",
        "[contact.foundation]\nlaw = \"tabulated\"\ntable = [[0, 0], [0.05, 5.0], [0.1, 12.0]]\n",
        "[machine]\nap_force_sign = -1\n[machine.springs]\nstiffness_of = \"each\"\n",
        "[machine.freedoms.ap]\ndrive = \"locked\"\nlocked_at_mm = 1.5\n",
        "[machine.freedoms.ap]\ndrive = \"prescribed\"\n[machine.ap_motion]\nwaveform = \"none\"\n",
        "[machine.flexion]\nwaveform = \"iso-like\"\nlow_pass_harmonics = 3\nscale = 0.1\n",
    ];
    for text in texts {
        assert_round_trip(&parsed(text).unwrap());
    }
}

#[test]
fn force_case_is_the_default_and_that_of_the_paper_differs_in_load_direction_and_law() {
    let default = parsed("").unwrap();
    let [force, mut paper] = ["stanmore-force.toml", "knight-2007.toml"].map(|name| {
        let mut case = shipped(name);
        case.heading = default.heading.clone();
        case
    });
    assert_eq!(force, default);
    let peak = |case: &Case| {
        let waveform = case.machine.waveforms.get(&knee::AXIAL_FORCE);
        waveform.map(|waveform| waveform.at(0.13).0)
    };
    assert_eq!((peak(&paper), peak(&default)), (Some(3200.0), Some(2600.3)));
    let words = (paper.wear.kind().word, default.wear.kind().word);
    assert_eq!(words, ("archard", "power-law"));
    paper.machine.waveforms = default.machine.waveforms.clone();
    paper.wear = default.wear.clone();
    assert_eq!(paper.machine.settings.ap_force_sign.0, -1.0);
    paper.machine.settings.ap_force_sign = default.machine.settings.ap_force_sign;
    assert_eq!(paper, default);
}

#[test]
fn every_shipped_waveform_is_read_and_stays_near_its_points() {
    for &channel in KNEE.channels {
        for word in words_of(channel) {
            let drive = match channel.name {
                "ap_motion" | "ie_motion" => "stanmore-displacement",
                _ => "stanmore-force",
            };
            let table = channel.name;
            let text = format!(
                "[machine]\npreset = \"{drive}\"\n[machine.{table}]\nwaveform = \"{word}\"\n"
            );
            let case = parsed(&text).unwrap_or_else(|error| panic!("{error}"));
            let waveform = case.machine.waveforms.get(channel).unwrap();
            let values = waveform.knots().iter().map(|knot| knot.value);
            let (low, high) = (
                values.clone().fold(0.0, f64::min),
                values.fold(0.0, f64::max),
            );
            let slack = 0.05 * (high - low);
            for i in 0..1000 {
                let value = waveform.at(f64::from(i) / 1000.0).0;
                assert!(
                    value > low - slack - 1e-9 && value < high + slack + 1e-9,
                    "{table} {i}"
                );
            }
        }
    }
}

#[test]
fn validate_signs_of_the_measured_gait() {
    if !has_dm_data("validate_signs_of_the_measured_gait") {
        return;
    }
    let case = shipped("dm-knee-displacement.toml");
    let at = |channel: &'static machine::Channel, percent: f64| {
        let waveform = case.machine.waveforms.get(channel).unwrap();
        waveform.at(percent / 100.0).0
    };
    // The rows at 5, 40 and 80 % of the gait file: x' -6.1, -6.9 and 0.9 mm, zrot -7.4, -7.8, -51.6.
    for (percent, flexion, ap) in [(5.0, 7.4, 1.3), (40.0, 7.8, 0.5), (80.0, 51.6, 8.3)] {
        assert!(
            (at(&knee::FLEXION_MOTION, percent) - flexion).abs() < 1.5,
            "{percent}"
        );
        assert!(
            (at(&knee::AP_MOTION, percent) - ap).abs() < 2.0,
            "{percent}"
        );
    }
    assert!((at(&knee::IE_MOTION, 15.0) + 4.06).abs() < 1.0);
    assert!(at(&knee::AP_MOTION, 0.0).abs() < 0.5);
}

#[test]
fn dm_cases_turn_the_meshes_half_round() {
    if !has_dm_data("dm_cases_turn_the_meshes_half_round") {
        return;
    }
    let case = shipped("dm-knee.toml");
    let (FemurShape::Mesh(femur), InsertShape::Mesh(insert)) =
        (&case.femur.shape, &case.insert.shape)
    else {
        panic!("both are meshes");
    };
    for axes in [femur.frame.axes, insert.frame.axes] {
        let rotation = axes.rotation(Side::Right).unwrap();
        assert_eq!(rotation.diagonal().as_slice(), [-1.0, 1.0, -1.0]);
    }
    assert_eq!(femur.frame.length_unit.in_mm(), 1000.0);
}

#[test]
fn templates_are_cases_of_their_preset() {
    for preset in [Preset::StanmoreForce, Preset::StanmoreDisplacement] {
        let case = parsed(&template(preset)).unwrap();
        assert_eq!(case.machine.settings.preset, preset);
        let prescribed = preset == Preset::StanmoreDisplacement;
        assert_eq!(
            case.machine.freedoms.get(knee::AP).drive == DriveWord::Prescribed,
            prescribed
        );
    }
}

#[test]
fn schema_next_to_the_cases_is_up_to_date() {
    let path = cases().join("condyle.schema.json");
    let schema = std::fs::read_to_string(path).unwrap_or_default();
    let advice = "run: condyle schema > cases/condyle.schema.json";
    assert!(schema == Case::json_schema(), "{advice}");
}
