//! A body that lies otherwise than its axes say, in words.

use std::fmt;

use condyle::anatomy::Recognition;
use condyle::geometry::TriangleMesh;

use super::super::axes::Axes;

/// One of the two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// The femoral component.
    Femur,
    /// The tibial insert.
    Insert,
}

impl fmt::Display for Body {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Femur => "femur",
            Self::Insert => "insert",
        })
    }
}

impl Body {
    /// What the body lies like, from triangles in any frame and unit.
    pub(crate) fn recognise(self, mesh: &TriangleMesh) -> Option<Recognition> {
        match self {
            Self::Femur => Recognition::of_femur(mesh),
            Self::Insert => Recognition::of_insert(mesh),
        }
    }

    fn signs(self) -> &'static str {
        match self {
            Self::Femur => {
                "the box open above, the trochlea in front and the notch between the condyles behind"
            }
            Self::Insert => {
                "two dishes above, the flat backside below, the notch or the lower lip behind"
            }
        }
    }
}

/// A body that lies otherwise than its axes say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongAxes {
    /// Which.
    pub body: Body,
    /// How it lies in the case's frame, such as "upside down".
    pub how: &'static str,
    /// The axes that its shape shows.
    pub better: Axes,
}

impl fmt::Display for WrongAxes {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.better.words();
        write!(
            out,
            "write axes = [\"{x}\", \"{y}\", \"{z}\"], which its shape shows ({})",
            self.body.signs()
        )
    }
}
