//! Joints that turn and joints that shift.

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// It turns: rad and N mm in the solver, degrees in files.
    Rotation,
    /// It shifts: mm and N everywhere.
    Translation,
}

impl JointKind {
    /// The unit of positions in files, as names end in it.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Rotation => "deg",
            Self::Translation => "mm",
        }
    }

    /// How much of the solver's unit (rad, mm) the unit of files has.
    pub const fn file_unit_in_solver(self) -> f64 {
        match self {
            Self::Rotation => 1f64.to_radians(),
            Self::Translation => 1.0,
        }
    }

    /// A position of the solver (rad, mm) in the unit of files.
    pub const fn in_files(self, position: f64) -> f64 {
        match self {
            Self::Rotation => position.to_degrees(),
            Self::Translation => position,
        }
    }
}
