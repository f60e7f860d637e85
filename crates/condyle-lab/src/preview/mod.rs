//! What a case comes to before it runs: its bodies, where the femur settles, and what a run will need.

mod bodies;
mod expected;
mod picture;

use std::path::Path;

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_io::{
    cache::Cache,
    case::{Assignment, Case, FEMUR_TRIANGLES},
};
use serde::Serialize;

use crate::at_rest::AtRest;
use crate::run::{Clock, RunError, build, changed, start};

pub use bodies::{FemurFacts, InsertFacts};
pub use expected::Expected;

/// What a case comes to before it runs; units are in the names.
#[derive(Serialize)]
pub struct Preview {
    /// Title of the case.
    pub title: String,
    /// Which knee it is.
    pub side: &'static str,
    /// What was put right or looks doubtful.
    pub warnings: Vec<String>,
    /// The femoral component.
    pub femur: FemurFacts,
    /// The insert.
    pub insert: InsertFacts,
    /// The settled femur on the insert.
    pub at_rest: AtRest,
    /// What a run will need.
    pub expected: Expected,
    /// The case, checked.
    #[serde(skip)]
    pub case: Case,
    #[serde(skip)]
    march: March,
    #[serde(skip)]
    femur_triangles: TriangleMesh,
}

impl Preview {
    /// Goes with the case at `case_path`, some of its values changed, as far as a run goes before its first cycle:
    /// the file, the meshes, and that the femur settles on the insert.
    ///
    /// # Errors
    /// Those of a run that cannot start.
    pub fn of(case_path: &Path, changes: &[Assignment], threads: usize) -> Result<Self, RunError> {
        Self::of_case(changed(case_path, changes)?, threads)
    }

    /// The same of a case that is read already.
    ///
    /// # Errors
    /// As [`Preview::of`].
    pub fn of_case(case: Case, threads: usize) -> Result<Self, RunError> {
        let mut clock = Clock::default();
        let built = clock.time(|| build(&case, threads, &Cache::off()))?;
        let warnings: Vec<String> = built.warnings.iter().map(ToString::to_string).collect();
        let march = clock.time(|| start(&case, built.test, &built.warnings))?;
        let triangles = case.femur_triangles(march.test(), FEMUR_TRIANGLES);
        let triangles = triangles.map_err(|source| RunError::of_build(&case, source))?;
        let at_rest = AtRest::of(&march);
        let (femur, insert) = (
            FemurFacts::of(&case, &triangles, &warnings),
            InsertFacts::of(&case, &march, &warnings),
        );
        Ok(Self {
            title: case.heading.title.clone(),
            side: case.heading.side.word(),
            expected: Expected::of(&case, &march, &at_rest, clock.spent),
            warnings,
            femur,
            insert,
            at_rest,
            case,
            march,
            femur_triangles: triangles,
        })
    }

    /// Both bodies from three sides, as the text of an SVG file.
    pub fn picture_svg(&self) -> String {
        picture::svg(
            &self.case,
            &self.march,
            &self.femur_triangles,
            &self.at_rest,
        )
    }
}
