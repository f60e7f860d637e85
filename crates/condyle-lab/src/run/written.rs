//! A run as it is written into its folder.

use condyle::geometry::TriangleMesh;
use condyle_io::{
    case::{Case, FEMUR_TRIANGLES},
    results::{FRAME_TRIANGLES, FolderLock, ResultsError, ResultsFolder, Summary, femur_of_frames},
};

use super::{error::RunError, options::RunOptions, running::Run};

/// A run as it is written into its folder.
pub(super) struct WrittenRun {
    folder: ResultsFolder,
    /// Held until the run has ended.
    _lock: Option<FolderLock>,
    inputs_blake3: String,
    /// The femur that the frames of the first and last cycle show, where the case asks for them.
    in_frames: Option<TriangleMesh>,
}

impl WrittenRun {
    /// A new run, in a folder that is made if it is not there.
    pub fn new(
        options: &RunOptions,
        lock: Option<FolderLock>,
        inputs_blake3: String,
        run: &Run<'_>,
    ) -> Result<Self, RunError> {
        let in_frames = in_frames(run)?;
        let alone = run.femur_triangles(FEMUR_TRIANGLES)?;
        let (folder, lock) = new_folder(run.case, options, lock)?;
        folder.write_femur(&run.march, &alone, run.case.heading.side)?;
        let written = Self {
            folder,
            _lock: lock,
            inputs_blake3,
            in_frames,
        };
        written.write_update(run)?;
        Ok(written)
    }

    /// A run that goes on in its folder.
    pub fn going_on(
        options: &RunOptions,
        lock: Option<FolderLock>,
        inputs_blake3: String,
        run: &Run<'_>,
    ) -> Result<Self, RunError> {
        Ok(Self {
            folder: ResultsFolder::existing(&options.out),
            _lock: lock,
            inputs_blake3,
            in_frames: in_frames(run)?,
        })
    }

    /// Writes what the run has found so far.
    pub fn write_update(&self, run: &Run<'_>) -> Result<(), RunError> {
        let side = run.case.heading.side;
        if let Some(femur) = &self.in_frames {
            self.folder.write_cycles(&run.march, femur, side)?;
        }
        self.folder.write_pressures(&run.march)?;
        self.folder
            .write_update(&run.march, side, &self.inputs_blake3)?;
        let spent_s = run.spent().as_secs_f64();
        Ok(self.folder.write_time_spent(spent_s)?)
    }

    /// Writes what a run that is done has found.
    pub fn write_end(&self, summary: &Summary) -> Result<(), RunError> {
        self.folder.write_summary(summary)?;
        condyle_report::write_report(self.folder.path())?;
        Ok(self.folder.finish()?)
    }
}

fn in_frames(run: &Run<'_>) -> Result<Option<TriangleMesh>, RunError> {
    if !run.case.output.cycle_frames {
        return Ok(None);
    }
    let femur = run.femur_triangles(FRAME_TRIANGLES)?;
    Ok(Some(femur_of_frames(femur)))
}

/// A folder for a new run, with the case in it, and its lock.
fn new_folder(
    case: &Case,
    options: &RunOptions,
    lock: Option<FolderLock>,
) -> Result<(ResultsFolder, Option<FolderLock>), ResultsError> {
    let folder = ResultsFolder::create(&options.out)?;
    let was_there = lock.is_some();
    let lock = lock.map_or_else(|| ResultsFolder::lock(folder.path()), |lock| Ok(Some(lock)))?;
    // Another run may have come first since the folder was found not to be there.
    if !was_there {
        ResultsFolder::free(folder.path())?;
    }
    if options.force {
        folder.clear()?;
    }
    folder.write_case(&case.to_toml_in(folder.path()))?;
    Ok((folder, lock))
}
