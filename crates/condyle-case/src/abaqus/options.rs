//! Which of the ways to write the model.

/// Which of the ways to write the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AbaqusOptions {
    /// An elastic insert under hard contact, rather than a rigid one under the case's pressure law.
    pub deformable: bool,
    /// For Abaqus/Explicit rather than Abaqus/Standard.
    pub explicit: bool,
}
