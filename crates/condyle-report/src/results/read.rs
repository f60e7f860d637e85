//! Reading a results folder.

use std::path::{Path, PathBuf};

use condyle_io::{
    mesh::read_vtu_points,
    results::{ActivitySummary, check_file},
};

use super::{
    case::side, contents::Results, side::Side, summary::Summary, surface::SurfaceFields,
    table::Table,
};
use crate::error::ReportError;

impl Results {
    /// Reads what a results folder holds; parts that are not there become `None`.
    ///
    /// # Errors
    /// The folder is missing or holds no result at all, or a file in it is damaged.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        if !folder.is_dir() {
            return Err(ReportError::NoFolder {
                folder: folder.to_owned(),
            });
        }
        let case = text(&folder.join("case.toml"))?;
        let summary = summary(folder.join("summary.json"))?;
        let results = Self {
            activities: activities(folder, summary.as_ref())?,
            summary,
            wear: table(&folder.join("wear.csv"))?,
            kinematics: table(&folder.join("kinematics.csv"))?,
            slip_paths: table(&folder.join("slip_paths.csv"))?,
            surface: surface(folder)?,
            side: case.as_deref().map_or_else(Side::default, side),
            case,
        };
        results.or_none_at_all(folder)
    }

    fn or_none_at_all(self, folder: &Path) -> Result<Self, ReportError> {
        let any = self.summary.is_some()
            || self.wear.is_some()
            || self.kinematics.is_some()
            || self.surface.is_some();
        if any {
            return Ok(self);
        }
        Err(ReportError::NoResults {
            folder: folder.to_owned(),
        })
    }
}

/// Each of several activities, and its table.
fn activities(
    folder: &Path,
    summary: Option<&Summary>,
) -> Result<Vec<(ActivitySummary, Option<Table>)>, ReportError> {
    let listed = summary.map_or_else(Vec::new, Summary::activities);
    let with_table = |activity: ActivitySummary| {
        // A summary that somebody wrote may name any file: only one of the folder itself is read.
        let name = Path::new(&activity.kinematics_file).file_name();
        let table = name.map(|name| table(&folder.join(name))).transpose()?;
        Ok((activity, table.flatten()))
    };
    listed.into_iter().map(with_table).collect()
}

fn surface(folder: &Path) -> Result<Option<SurfaceFields>, ReportError> {
    let Some((_, path)) = meshes(folder)?.pop() else {
        return Ok(None);
    };
    check_file(&path)?;
    let file = read_vtu_points(&path)?;
    SurfaceFields::of_mesh(&file.mesh, &file.point_data, &path).map(Some)
}

/// The meshes that a run wrote: `insert_NNNN.vtu`, and the number of updates of each, which rises.
pub(crate) fn meshes(folder: &Path) -> Result<Vec<(u32, PathBuf)>, ReportError> {
    let failed = |source| ReportError::Read {
        path: folder.to_owned(),
        source,
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        found.extend(update_of(&path).map(|update| (update, path)));
    }
    found.sort_unstable();
    Ok(found)
}

fn update_of(path: &Path) -> Option<u32> {
    let name = path.file_name()?.to_str()?;
    name.strip_prefix("insert_")?
        .strip_suffix(".vtu")?
        .parse()
        .ok()
}

fn summary(path: PathBuf) -> Result<Option<Summary>, ReportError> {
    let Some(text) = text(&path)? else {
        return Ok(None);
    };
    match Summary::parse(&text) {
        Ok(summary) => Ok(Some(summary)),
        Err(source) => Err(ReportError::Json { path, source }),
    }
}

/// The table of a file; none where there is no such file.
pub(crate) fn table(path: &Path) -> Result<Option<Table>, ReportError> {
    text(path)?
        .map(|text| Table::parse(&text, path))
        .transpose()
}

fn text(path: &Path) -> Result<Option<String>, ReportError> {
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(source) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Read {
            path: path.to_owned(),
            source,
        }),
    }
}
