//! Entries of `summary.json` that are not numbers.

use super::{CYCLES, PEAK_PRESSURE_MPA, Scalar, UPDATES, WALL_S, WEAR_OVER_CONVENTIONAL};

/// The JSON type of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// A text.
    Text,
    /// A list of texts.
    Texts,
    /// An object.
    Object,
    /// An object or null.
    ObjectOrNull,
    /// A list of objects.
    Objects,
}

/// An entry of `summary.json` that is not a number.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its key.
    pub key: &'static str,
    /// Its JSON type.
    pub kind: PartKind,
    /// True if every run has it.
    pub is_always_there: bool,
    /// A description.
    pub about: &'static str,
    /// The number that it stands before in the file; none at the end.
    pub before: Option<&'static Scalar>,
}

/// Declares [`PARTS`]: key and type, whether every run has it, the number that it stands before, and a description.
macro_rules! parts {
    ($($key:ident: $kind:ident, $is_always_there:literal, before $before:expr, $about:literal;)+) => {
        /// All parts, in the order of the file.
        pub static PARTS: &[Part] = &[$(Part {
            key: stringify!($key),
            kind: PartKind::$kind,
            is_always_there: $is_always_there,
            about: $about,
            before: $before,
        }),+];
    };
}

parts! {
    plausibility: Objects, true, before Some(&CYCLES),
        "Findings that make the numbers doubtful, the worst first, each with `message` and `advice`.";
    notes: Objects, true, before Some(&CYCLES),
        "Remarks on the physics that do not make the numbers doubtful, each with `message` and its effect in `advice`.";
    prediction: Object, false, before Some(&CYCLES),
        "Predicted results of laboratories: medians and 90 % intervals of mass and depth, and the sources of their width.";
    error: ObjectOrNull, true, before Some(&WEAR_OVER_CONVENTIONAL),
        "Estimated discretisation errors by their parts; null if the case does not ask for them.";
    wear_laws: Objects, true, before Some(&WEAR_OVER_CONVENTIONAL),
        "Wear by every law for the same histories, that of the run first; only this law moves the surface.";
    activities: Objects, false, before Some(&PEAK_PRESSURE_MPA),
        "Motion, loads and wear of each activity.";
    creep: Object, false, before Some(&PEAK_PRESSURE_MPA),
        "Creep, and its separation from wear.";
    joint: Text, true, before Some(&UPDATES), "The joint whose replacement the machine tests, such as `hip`.";
    motions: Objects, true, before Some(&UPDATES),
        "The joints of the machine: `column` of `kinematics.csv`, `title`, and the `positive` direction.";
    neutral_pose: Object, true, before Some(&UPDATES),
        "Pose of the settled femur in the insert frame: there AP, ML and IS read zero.";
    warnings: Texts, true, before Some(&WALL_S), "Corrections of the input, and doubts about it.";
    version: Text, true, before None, "Version of condyle.";
    inputs_blake3: Text, true, before None, "Hash of case and meshes.";
}
