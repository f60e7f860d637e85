//! Entries of `summary.json` that are no numbers.

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

/// An entry of `summary.json` that is no number.
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

const fn part(
    key: &'static str,
    kind: PartKind,
    before: Option<&'static Scalar>,
    about: &'static str,
) -> Part {
    Part {
        key,
        kind,
        is_always_there: true,
        about,
        before,
    }
}

const fn sometimes(part: Part) -> Part {
    Part {
        is_always_there: false,
        ..part
    }
}

/// All parts, in the order of the file.
pub static PARTS: [Part; 9] = [
    part(
        "plausibility",
        PartKind::Objects,
        Some(&CYCLES),
        "Reasons to doubt the numbers, the worst first, each with `message` and `advice`.",
    ),
    part(
        "error",
        PartKind::ObjectOrNull,
        Some(&WEAR_OVER_CONVENTIONAL),
        "Estimated discretisation errors by their parts; null if the case does not ask for them.",
    ),
    part(
        "wear_laws",
        PartKind::Objects,
        Some(&WEAR_OVER_CONVENTIONAL),
        "Wear by every law for the same histories, that of the run first; only that one moved the surface.",
    ),
    sometimes(part(
        "activities",
        PartKind::Objects,
        Some(&PEAK_PRESSURE_MPA),
        "Motion, loads and wear of each of several activities.",
    )),
    sometimes(part(
        "creep",
        PartKind::Object,
        Some(&PEAK_PRESSURE_MPA),
        "Creep of an insert that creeps, and its separation from wear.",
    )),
    part(
        "neutral_pose",
        PartKind::Object,
        Some(&UPDATES),
        "Pose of the settled femur in the insert frame: there AP, ML and IS read zero.",
    ),
    part(
        "warnings",
        PartKind::Texts,
        Some(&WALL_S),
        "Corrections and doubts of the input.",
    ),
    part("version", PartKind::Text, None, "Version of condyle."),
    part(
        "inputs_blake3",
        PartKind::Text,
        None,
        "Hash of case and meshes.",
    ),
];
