//! Which knee it is.

use condyle_io::results::{KNEE, LATERAL, MEDIAL};

/// A right or a left knee; lateral is at +z in the one, at -z in the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// A right knee: +z is lateral.
    #[default]
    Right,
    /// A left knee: +z is medial.
    Left,
}

impl Side {
    /// Names of the regions at -z and at +z.
    pub(crate) fn regions(self) -> [&'static str; 2] {
        let [medial, lateral] = [MEDIAL, LATERAL].map(|region| KNEE.regions[region].label);
        match self {
            Self::Right => [medial, lateral],
            Self::Left => [lateral, medial],
        }
    }
}
