//! What a results folder holds.

use condyle_results::{ActivitySummary, Side, Summary};

use super::{surface::SurfaceFields, table::Table};

/// What a results folder holds; a part that is not there is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// `summary.json`.
    pub summary: Option<Summary>,
    /// `wear.csv`, a row an update.
    pub wear: Option<Table>,
    /// `kinematics.csv`, a row an increment of the first and of the last cycle.
    pub kinematics: Option<Table>,
    /// `slip_paths.csv`, a row an increment and place.
    pub slip_paths: Option<Table>,
    /// Each of several activities, and its motions and loads; none where the case has one.
    pub activities: Vec<(ActivitySummary, Option<Table>)>,
    /// The articulating surface at the last update.
    pub surface: Option<SurfaceFields>,
    /// `case.toml`, its text.
    pub case: Option<String>,
    /// Which knee it is.
    pub side: Side,
    /// Motions and loads that were measured, where `condyle compare` has laid them beside the run: `percent`, and columns as
    /// those of `kinematics`.
    pub measured_kinematics: Option<Table>,
    /// Mass that specimens lost, mg, by `cycles`: a column a specimen.
    pub measured_wear: Option<Table>,
    /// What could not be read, and why; only of [`Results::read_what_can_be`].
    pub left_out: Vec<String>,
}
