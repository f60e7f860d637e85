//! A results folder, read.

mod case;
mod measure;
mod read;
mod summary;
mod surface;
mod surface_of_mesh;
mod table;

use condyle_io::results::{KNEE, LATERAL, MEDIAL};

pub(crate) use case::title;
pub use measure::{Extreme, Region};
pub use summary::Summary;
pub use surface::SurfaceFields;
pub use table::Table;

/// What a results folder holds; a part that is not there is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// `summary.json`.
    pub summary: Option<Summary>,
    /// `wear.csv`, a row an update.
    pub wear: Option<Table>,
    /// `kinematics.csv`, a row an increment of the first and of the last cycle.
    pub kinematics: Option<Table>,
    /// The articulating surface at the last update.
    pub surface: Option<SurfaceFields>,
    /// `case.toml`, its text.
    pub case: Option<String>,
    /// Which knee it is.
    pub side: Side,
}

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
