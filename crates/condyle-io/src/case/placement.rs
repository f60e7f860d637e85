//! How the components sit on their bones, or in the machine, in the words of a surgeon.
//!
//! The frames stay where the machine is: its axes, its springs, the regions of the surface and AP zero do not move
//! with a component. All signs are those of a right knee, and mirrored with a left one.

use super::femur::Femur;
use super::insert::Insert;
use crate::config::{KeyReason, Log, Section, Settings, choice, names, settings, within};

choice! {
    /// What of an insert is put at the origin of the insert frame, where the machine's axes are.
    InsertOrigin {
        /// The origin of its file.
        File = "file",
        /// Half-way between the lowest places of its dishes.
        Centre = "centre",
    }
}

settings! {
    /// How the insert sits in its holder: turned about the origin of the insert frame, first by the slope, then by the tilt, then by the rotation.
    InsertPlacement {
        /// What of the insert is at the origin of the insert frame, from which the machine's axes and the medial and lateral side count: the file's origin, or half-way between the dishes; of a generic insert they are the same.
        origin: InsertOrigin = InsertOrigin::File;
        /// Posterior slope added to what the shape has, + lowers the posterior edge.
        posterior_slope_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Tilt in the frontal plane, + lowers the medial edge: a component in varus.
        coronal_tilt_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// Turn about the long axis, + internal: the front goes medially.
        axial_rotation_deg: f64 = 0.0, in within(-90.0, 90.0);
    }

    /// How the femoral component sits on its bone: turned about the flexion axis, first by flexion, then by varus, then by rotation, and then shifted; the axis stays.
    FemurPlacement {
        /// Flexion of the component on the bone, + brings its front up and forward, as a flexed bone over a component that lies still.
        flexion_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// Varus of the component on the bone, + lowers its lateral condyle.
        varus_deg: f64 = 0.0, in within(-30.0, 30.0);
        /// External rotation of the component on the bone, + turns its front laterally.
        external_rotation_deg: f64 = 0.0, in within(-45.0, 45.0);
        /// How far anterior of its place by the file it sits.
        anterior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// How far superior of its place by the file it sits.
        superior_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
        /// How far lateral of its place by the file it sits; where ML is free, it finds its own place.
        lateral_offset_mm: f64 = 0.0, in within(-50.0, 50.0);
    }
}

impl InsertPlacement {
    /// Reads the placement of `insert` from its table; a flat block has none.
    pub(super) fn read_checked(
        section: &Section<'_>,
        insert: Option<&Insert>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let placement = Self::read(section, log)?;
        if matches!(insert, Some(Insert::Flat(_))) && placement.is_turned() {
            idle::<Self>(section, "another shape than \"flat\"", log);
        }
        Some(placement)
    }

    /// Whether it turns the insert.
    pub(super) fn is_turned(&self) -> bool {
        [
            self.posterior_slope_deg,
            self.coronal_tilt_deg,
            self.axial_rotation_deg,
        ] != [0.0; 3]
    }
}

impl FemurPlacement {
    /// Reads the placement of `femur` from its table; the shapes for verification have none.
    pub(super) fn read_checked(
        section: &Section<'_>,
        femur: Option<&Femur>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let placement = Self::read(section, log)?;
        let of_verification = matches!(femur, Some(Femur::Sphere(_) | Femur::Cylinder(_)));
        if of_verification && placement.is_moved() {
            idle::<Self>(section, "shape = \"generic\" or \"mesh\"", log);
        }
        Some(placement)
    }

    /// Whether it turns or shifts the femoral component.
    pub(super) fn is_moved(&self) -> bool {
        self.numbers() != [0.0; 6]
    }

    /// Degrees and mm, in the order of the keys.
    pub(super) fn numbers(&self) -> [f64; 6] {
        [
            self.flexion_deg,
            self.varus_deg,
            self.external_rotation_deg,
            self.anterior_offset_mm,
            self.superior_offset_mm,
            self.lateral_offset_mm,
        ]
    }
}

/// Reports every key of `S` that is given where none has a meaning.
fn idle<S: Settings>(section: &Section<'_>, needs: &str, log: &mut Log<'_>) {
    for key in names(&S::keys()).filter(|key| section.value(key).is_some()) {
        let (key, needs) = (key.to_owned(), needs.to_owned());
        log.problem(section.key_span(&key), KeyReason::Idle { key, needs });
    }
}
