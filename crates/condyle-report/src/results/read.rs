//! Reading a results folder.

use std::path::{Path, PathBuf};

use condyle_mesh::formats::read_vtu_points;
use condyle_results::{
    ActivitySummary, COMPARED, COMPARED_KINEMATICS, COMPARED_WEAR, Side, Summary, check_file,
};

use super::{case::side, contents::Results, surface::SurfaceFields, table::Table};
use crate::error::ReportError;

/// What is done about a part that cannot be read: the reading ends, or goes on without it.
type OnDamage<'a> = &'a mut dyn FnMut(ReportError) -> Result<(), ReportError>;

impl Results {
    /// Reads what a results folder holds; parts that are not there become `None`.
    ///
    /// # Errors
    /// The folder is missing or holds no result at all, or a file in it is damaged.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let results = Self::read_parts(folder, &mut Err)?;
        results.or_none_at_all(folder)
    }

    /// Reads what can be read of a results folder: parts that are damaged become `None` too, and [`Results::left_out`]
    /// says why.
    ///
    /// # Errors
    /// The folder is missing or holds no result that can be read.
    pub fn read_what_can_be(folder: &Path) -> Result<Self, ReportError> {
        let mut left_out = Vec::new();
        let mut note = |error: ReportError| {
            left_out.push(without_folder(&error.to_string(), folder));
            Ok(())
        };
        let results = Self::read_parts(folder, &mut note)?;
        if left_out.is_empty() {
            return results.or_none_at_all(folder);
        }
        let results = Self {
            left_out,
            ..results
        };
        if results.has_any() {
            return Ok(results);
        }
        Err(ReportError::NothingReadable {
            folder: folder.to_owned(),
            reasons: results.left_out.join(" "),
        })
    }

    fn read_parts(folder: &Path, on_damage: OnDamage<'_>) -> Result<Self, ReportError> {
        if !folder.is_dir() {
            return Err(ReportError::NoFolder {
                folder: folder.to_owned(),
            });
        }
        let case = part(case(folder.join("case.toml")), on_damage)?;
        let summary = part(summary(folder.join("summary.json")), on_damage)?;
        let mut of = |name: &str| part(table(&folder.join(name)), on_damage);
        let (wear, kinematics) = (of("wear.csv")?, of("kinematics.csv")?);
        let slip_paths = of("slip_paths.csv")?;
        let measured_kinematics = of(&compared(COMPARED_KINEMATICS))?;
        let measured_wear = of(&compared(COMPARED_WEAR))?;
        Ok(Self {
            activities: activities(folder, summary.as_ref(), on_damage)?,
            summary,
            wear,
            kinematics,
            slip_paths,
            surface: part(surface(folder), on_damage)?,
            side: case.as_deref().map_or_else(Side::default, side),
            case,
            measured_kinematics,
            measured_wear,
            left_out: Vec::new(),
        })
    }

    fn has_any(&self) -> bool {
        self.summary.is_some()
            || self.wear.is_some()
            || self.kinematics.is_some()
            || self.surface.is_some()
    }

    fn or_none_at_all(self, folder: &Path) -> Result<Self, ReportError> {
        if self.has_any() {
            return Ok(self);
        }
        Err(ReportError::NoResults {
            folder: folder.to_owned(),
        })
    }
}

/// A part; none where it cannot be read and the reading goes on.
fn part<T>(
    read: Result<Option<T>, ReportError>,
    on_damage: OnDamage<'_>,
) -> Result<Option<T>, ReportError> {
    read.or_else(|error| on_damage(error).map(|()| None))
}

/// A message whose files have no folder: the same run gives the same page wherever it is.
pub(crate) fn without_folder(message: &str, folder: &Path) -> String {
    let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
    message.replace(&folder, "")
}

/// Each of several activities, and its table.
fn activities(
    folder: &Path,
    summary: Option<&Summary>,
    on_damage: OnDamage<'_>,
) -> Result<Vec<(ActivitySummary, Option<Table>)>, ReportError> {
    let listed = summary.map_or_else(Vec::new, |summary| summary.activities.clone());
    let with_table = |activity: ActivitySummary| {
        // A summary that somebody wrote may name any file: only one of the folder itself is read.
        let name = Path::new(&activity.kinematics_file).file_name();
        let table = name.map(|name| part(table(&folder.join(name)), on_damage));
        Ok((activity, table.transpose()?.flatten()))
    };
    listed.into_iter().map(with_table).collect()
}

fn surface(folder: &Path) -> Result<Option<SurfaceFields>, ReportError> {
    let last = meshes(folder)?.pop();
    last.map(|(_, path)| surface_of(&path)).transpose()
}

/// The articulating surface before the first cycle; none where there is no mesh of it.
pub(crate) fn unworn_surface(folder: &Path) -> Result<Option<SurfaceFields>, ReportError> {
    let first = meshes(folder)?.into_iter().find(|(update, _)| *update == 0);
    first.map(|(_, path)| surface_of(&path)).transpose()
}

fn surface_of(path: &Path) -> Result<SurfaceFields, ReportError> {
    check_file(path)?;
    let file = read_vtu_points(path)?;
    SurfaceFields::of_mesh(&file.mesh, &file.point_data, path)
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

/// A table of what was measured, by its path in the folder of a run.
fn compared(name: &str) -> String {
    format!("{}/{name}.csv", COMPARED.folder)
}

fn case(path: PathBuf) -> Result<Option<String>, ReportError> {
    let Some(text) = text(&path)? else {
        return Ok(None);
    };
    match text.parse::<toml::Table>() {
        // A run ends every line of it.
        Ok(_) if !text.is_empty() && !text.ends_with('\n') => Err(ReportError::CutShort { path }),
        Ok(_) => Ok(Some(text)),
        Err(error) => Err(ReportError::NotACase {
            path,
            message: error.message().to_owned(),
        }),
    }
}

fn summary(path: PathBuf) -> Result<Option<Summary>, ReportError> {
    let Some(text) = text(&path)? else {
        return Ok(None);
    };
    match serde_json::from_str(&text) {
        Ok(summary) => Ok(Some(summary)),
        Err(source) => Err(ReportError::Json { path, source }),
    }
}

/// The table of a file; none where there is no such file.
pub(crate) fn table(path: &Path) -> Result<Option<Table>, ReportError> {
    let Some(text) = text(path)? else {
        return Ok(None);
    };
    if !text.ends_with('\n') {
        return Err(ReportError::CutShort {
            path: path.to_owned(),
        });
    }
    Table::parse(&text, path).map(Some)
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
