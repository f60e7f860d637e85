//! A case: its tables, from which it is read, written and described.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use condyle::machine::TestedJoint;
use condyle::wear::WEAR_LAWS;
use serde_json::json;

use super::activity::Activity;
use super::build::BuildWarning;
use super::contact::Contact;
use super::femur::{Femur, FemurShape};
use super::frame::{Heading, Side, check_axes};
use super::insert::{Insert, InsertShape};
use super::machine::Machine;
use super::material::{Creep, Material};
use super::renamed::renamed;
use super::rig::Rig;
use super::run_options::{Accuracy, Limits, March, Output, Time};
use super::wear::{Wear, WearLaws};
use crate::config::*;

// A new table is a type with `Settings` in its own file, and one entry here.
settings! {
    /// A wear test as its file describes it, checked, with every default filled in.
    Case [check] {
        /// Title and side.
        [flat] heading: Heading;
        /// The femoral component.
        [table] femur: Femur;
        /// The tibial insert.
        [table] insert: Insert;
        /// Polyethylene of the insert.
        [table] material: Material;
        /// Model of contact, pressure law and friction.
        [table] contact: Contact;
        /// The simulator.
        [table] machine: Machine;
        /// An activity of the simulator, with its own inputs.
        [table "activity"] activities: Vec<Activity>;
        /// The wear law.
        [table] wear: Wear;
        /// Creep of the polyethylene of the insert.
        [table] creep: Creep;
        /// The march over the life of the insert.
        [table] march: March;
        /// Steps and tolerances in time.
        [table] time: Time;
        /// Estimates of the accuracy of a run.
        [table] accuracy: Accuracy;
        /// Limits on the use of the computer.
        [table] limits: Limits;
        /// Additional output of a run.
        [table] output: Output;
        /// The text that the case was read from.
        [flat] origin: Origin;
    }
}

impl Case {
    pub(super) fn items_with(wear_laws: WearLaws) -> Vec<Item> {
        let mut items = Self::items();
        for item in &mut items {
            if item.name() == Some(Wear::TABLE) {
                *item = Wear::item_of(wear_laws);
            }
        }
        items
    }

    fn check(&self, root: &Section<'_>, log: &mut Log<'_>) {
        let side = self.side_in_frame();
        let of_femur = match &self.femur.shape {
            FemurShape::Mesh(mesh) => Some(&mesh.frame),
            _ => None,
        };
        for (table, frame) in [("femur", of_femur), ("insert", self.insert.frame())] {
            if let Some(frame) = frame {
                let place = root.part(table).value_span("axes");
                check_axes(&frame.axes, side, place, log);
            }
        }
        self.check_round_bearing(&root.part("insert"), log);
        let rig = self.machine.rig.as_ref();
        if rig.is_some_and(|rig| rig.keys.motion_scale != 1.0) && !self.has_motion_curve() {
            let message = "`motion_scale` has no effect: no joint moves along a waveform";
            let fault = Fault::new(
                message,
                "remove it; whole turns and locked angles are not scaled",
            );
            log.problem(root.part("machine").key_span("motion_scale"), fault);
        }
        if self.tested_joint() == TestedJoint::Disc && self.heading.side == Side::Left {
            let fault = Fault::new("a disc has no side", "remove `side`");
            log.problem(root.value_span("side"), fault);
        }
    }

    /// Returns the joint whose replacement the machine tests.
    pub fn tested_joint(&self) -> TestedJoint {
        let tested = |rig: &Rig| rig.keys.tests;
        self.machine.rig.as_ref().map_or(TestedJoint::Knee, tested)
    }

    /// Returns the side of the body in the frame of the machine, which decides whether shapes are mirrored.
    pub fn side_in_frame(&self) -> Side {
        self.heading.side.in_frame_of(self.tested_joint())
    }

    /// Returns true if a joint of a machine by joints, or of its activities, moves along a waveform, which `motion_scale` multiplies.
    pub fn has_motion_curve(&self) -> bool {
        let of_activities = self.activities.iter().map(|activity| &activity.rig);
        let mut rigs = of_activities.chain([&self.machine.rig]).flatten();
        rigs.any(Rig::has_motion_curve)
    }

    /// Returns whether the machine tests knees, whose bodies are recognised by their shapes.
    pub(super) fn tests_knee(&self) -> bool {
        self.tested_joint() == TestedJoint::Knee
    }

    /// Reports a cup or trough on a machine for knees, without its counterface, or smaller than that.
    fn check_round_bearing(&self, insert: &Section<'_>, log: &mut Log<'_>) {
        let (bearing, partner, preset, radius_mm) = match &self.insert.shape {
            InsertShape::Cup(cup) => (
                "cup",
                "sphere",
                "iso-14242-1-like",
                Some(cup.shape.radius_mm),
            ),
            // Its radius is known once its file is read.
            InsertShape::CupMesh(_) => ("cup", "sphere", "iso-14242-1-like", None),
            InsertShape::Trough(trough) => (
                "trough",
                "cylinder",
                "iso-22622-like",
                Some(trough.shape.radius_mm),
            ),
            _ => return,
        };
        let mut report = |key: &str, message: String, advice: String| {
            log.problem(insert.value_span(key), Fault::new(message, advice));
        };
        if self.tests_knee() {
            let message =
                format!("a {bearing} needs another machine than the knee simulator of this case");
            report(
                "shape",
                message,
                format!("write [machine] preset = \"{preset}\""),
            );
        }
        let within = match &self.femur.shape {
            FemurShape::Sphere(head) if bearing == "cup" => Some(head.radius_mm),
            FemurShape::Cylinder(cylinder) if bearing == "trough" => Some(cylinder.radius_mm),
            // Its radius is known once its file is read.
            FemurShape::Mesh(_) => return,
            _ => None,
        };
        match (within, radius_mm) {
            (Some(_), None) => {}
            (Some(inner_mm), Some(radius_mm)) if inner_mm < radius_mm => {}
            (Some(inner_mm), Some(radius_mm)) => report(
                "radius_mm",
                format!(
                    "the {bearing} of radius {radius_mm} mm is not larger than its {partner} of {inner_mm} mm"
                ),
                format!(
                    "its radius is that of the {partner} and the radial clearance, 0.02 to 0.4 mm"
                ),
            ),
            (None, _) => report(
                "shape",
                format!("a {bearing} needs a {partner} or a mesh"),
                format!(
                    "write [femur] shape = \"{partner}\" with its radius_mm, or \"mesh\" with its file"
                ),
            ),
        }
    }

    pub(super) fn written(&self, names_waveforms: bool) -> String {
        let mut out = Writer::new(names_waveforms);
        self.write(&mut out);
        out.into_text()
    }

    /// Returns a JSON schema, draft 2020-12, of a case file: every key with its unit, range, default and meaning.
    ///
    /// It accepts every file that [`CaseReader`](super::CaseReader) accepts. The reader checks more: files that must exist,
    /// and values that must fit each other.
    pub fn json_schema() -> String {
        let about = "A virtual wear test of a joint replacement: a case of condyle.";
        let mut schema = table_schema(about, &Self::items_with(WEAR_LAWS));
        schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
        schema["title"] = "Case of condyle".into();
        // Keys under their previous names are still read: editors must not mark them as errors.
        for (old, new) in renamed() {
            let key = old.trim_start_matches("contact.");
            schema["properties"]["contact"]["properties"][key] =
                json!({ "deprecated": true, "description": format!("Called `{new}`.") });
        }
        format!("{schema:#}\n")
    }
}

/// The text of a case file, the places of its keys, and remarks on the reading. All origins compare equal: two cases are
/// the same if their settings are.
#[derive(Clone, Debug)]
pub struct Origin {
    pub(super) source: Source,
    /// Places of values and table names by dotted path: problems of a build point to them.
    pub(super) places: BTreeMap<String, Range<usize>>,
    pub(super) notes: Vec<BuildWarning>,
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Settings for Origin {
    fn items() -> Vec<Item> {
        Vec::new()
    }

    fn read(_: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let places = log.places.iter();
        Some(Self {
            source: Arc::clone(&log.source),
            places: places
                .map(|(place, path)| (path.clone(), place.clone()))
                .collect(),
            notes: Vec::new(),
        })
    }

    fn write(&self, _: &mut Writer) {}
}
