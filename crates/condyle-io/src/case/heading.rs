//! What stands above the first table of a case.

use crate::config::{choice, settings};

choice! {
    /// Which knee.
    Side {
        /// A right knee.
        Right = "right",
        /// A left knee, mirrored on the way in and out.
        Left = "left",
    }
}

impl Side {
    /// The other knee.
    pub fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }
}

settings! {
    /// What stands above the first table of a case.
    Heading {
        /// One line that says what the case is.
        title: String = "Untitled".to_owned();
        /// Which knee; a left one is mirrored on the way in and out.
        side: Side = Side::Right;
    }
}
