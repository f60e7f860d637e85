//! A results folder, read.

mod case;
mod surface;
mod table;

pub use surface::{Extreme, Region, SurfaceFields};
pub use table::Table;

pub(crate) use self::case::CaseFacts;
pub(crate) use surface::{ARTICULATING, Articulating};

use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use condyle_mesh::formats::{VtuFile, read_vtu_points};
use condyle_results::{
    ActivitySummary, COMPARED, COMPARED_KINEMATICS, COMPARED_WEAR, Directions, MotionColumn, Side,
    Summary, TestedJoint, check_file,
};

use crate::error::ReportError;

/// The content of a results folder; a part that is not there is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// `summary.json`.
    pub summary: Option<Summary>,
    /// `wear.csv`, a row for each update.
    pub wear: Option<Table>,
    /// `kinematics.csv`, a row for each increment of the first and of the last cycle.
    pub kinematics: Option<Table>,
    /// `slip_paths.csv`, a row for each increment and place.
    pub slip_paths: Option<Table>,
    /// Each of several activities with its motions and loads; empty where the case has one.
    pub activities: Vec<(ActivitySummary, Option<Table>)>,
    /// The articulating surface at the last update.
    pub surface: Option<SurfaceFields>,
    /// The text of `case.toml`.
    pub case: Option<String>,
    /// The side of the knee.
    pub side: Side,
    /// Measured motions and loads, where `condyle compare` has added them to the run: `percent`, and columns as those of
    /// `kinematics`.
    pub measured_kinematics: Option<Table>,
    /// Mass loss of specimens, mg, by `cycles`: a column for each specimen.
    pub measured_wear: Option<Table>,
    /// The files that could not be read, with reasons; only of [`Results::read_readable`].
    pub left_out: Vec<String>,
}

/// Decides whether reading ends or continues if a part cannot be read.
type OnDamage<'a> = &'a mut dyn FnMut(ReportError) -> Result<(), ReportError>;

impl Results {
    /// Reads a results folder; parts that are not there become `None`.
    ///
    /// # Errors
    /// The folder is missing or holds no result at all, or a file in it is damaged.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let results = Self::read_parts(folder, &mut Err)?;
        if results.has_any() {
            return Ok(results);
        }
        Err(ReportError::no_results(folder))
    }

    /// Reads the readable part of a results folder: damaged parts become `None` too, and [`Results::left_out`] has the
    /// reasons.
    ///
    /// # Errors
    /// The folder is missing or holds no result that can be read.
    pub fn read_readable(folder: &Path) -> Result<Self, ReportError> {
        let mut left_out = Vec::new();
        let mut note = |error: ReportError| {
            left_out.push(without_folder(&error.to_string(), folder));
            Ok(())
        };
        let results = Self::read_parts(folder, &mut note)?;
        if results.has_any() {
            return Ok(Self {
                left_out,
                ..results
            });
        }
        if left_out.is_empty() {
            return Err(ReportError::no_results(folder));
        }
        let (folder, reasons) = (folder.display(), left_out.join(" "));
        Err(ReportError::Unusable(format!(
            "Nothing in the folder {folder} can be read. {reasons}"
        )))
    }

    fn read_parts(folder: &Path, on_damage: OnDamage<'_>) -> Result<Self, ReportError> {
        if !folder.is_dir() {
            let folder = folder.display();
            return Err(ReportError::Unusable(format!(
                "There is no folder {folder}. Give the folder that `condyle run --out` wrote."
            )));
        }
        let case = part(case(&folder.join("case.toml")), on_damage)?;
        let summary = part(summary(&folder.join("summary.json")), on_damage)?;
        let joint = summary.as_ref().map(|summary| summary.joint);
        let joint = joint.unwrap_or_default();
        let is_cup = joint == TestedJoint::Hip;
        let side = case.as_deref().map_or_else(Side::default, case::side);
        let mut activities = Vec::new();
        for activity in summary
            .iter()
            .flat_map(|summary| summary.activities.clone())
        {
            // A summary from elsewhere may name any path: only a file of this folder is read.
            let name = Path::new(&activity.kinematics_file).file_name();
            let path = name.map(|name| folder.join(name));
            let table = path.map(|path| part(table(&path), on_damage)).transpose()?;
            activities.push((activity, table.flatten()));
        }
        let last = part(meshes(folder).map(|mut meshes| meshes.pop()), on_damage)?;
        let mut table = |name: &str| part(table(&folder.join(name)), on_damage);
        let compared = |name| format!("{}/{name}.csv", COMPARED.folder);
        Ok(Self {
            side: side.in_frame_of(joint),
            case,
            summary,
            activities,
            wear: table("wear.csv")?,
            kinematics: table("kinematics.csv")?,
            slip_paths: table("slip_paths.csv")?,
            measured_kinematics: table(&compared(COMPARED_KINEMATICS))?,
            measured_wear: table(&compared(COMPARED_WEAR))?,
            surface: part(
                last.map(|(_, path)| surface_of(&path)).transpose(),
                on_damage,
            )?
            .map(|surface| SurfaceFields { is_cup, ..surface }),
            left_out: Vec::new(),
        })
    }

    /// Returns the names of the directions of the bearing.
    pub fn directions(&self) -> Directions {
        let summary = self.summary.as_ref();
        Directions {
            joint: summary.map(|summary| summary.joint).unwrap_or_default(),
            side: self.side,
        }
    }

    /// Returns the joints of the machine as columns; none in results of an older version.
    pub fn motions(&self) -> &[MotionColumn] {
        let summary = self.summary.as_ref();
        summary.map_or(&[], |summary| &summary.motions)
    }

    fn has_any(&self) -> bool {
        let has_table = self.wear.is_some() || self.kinematics.is_some();
        self.summary.is_some() || has_table || self.surface.is_some()
    }
}

/// Returns a part; none if it cannot be read and reading continues.
fn part<T>(
    read: Result<Option<T>, ReportError>,
    on_damage: OnDamage<'_>,
) -> Result<Option<T>, ReportError> {
    read.or_else(|error| on_damage(error).map(|()| None))
}

/// Returns a message whose paths lack the folder: the same run gives the same page in every folder.
pub(crate) fn without_folder(message: &str, folder: &Path) -> String {
    message.replace(&format!("{}{MAIN_SEPARATOR}", folder.display()), "")
}

/// Returns the articulating surface before the first cycle; none if it has no mesh.
///
/// # Errors
/// The folder cannot be read, or the mesh is damaged.
pub fn unworn_surface(folder: &Path) -> Result<Option<SurfaceFields>, ReportError> {
    let first = meshes(folder)?.into_iter().find(|(update, _)| *update == 0);
    first.map(|(_, path)| surface_of(&path)).transpose()
}

fn surface_of(path: &Path) -> Result<SurfaceFields, ReportError> {
    let file = read_mesh(path)?;
    SurfaceFields::of_mesh(&file.mesh, &file.point_data, path)
}

/// Reads a mesh after a check that it is the one that the run wrote.
pub(crate) fn read_mesh(path: &Path) -> Result<VtuFile, ReportError> {
    check_file(path)?;
    Ok(read_vtu_points(path)?)
}

/// Returns the meshes `insert_NNNN.vtu` of a run with their numbers of updates, in rising order.
pub(crate) fn meshes(folder: &Path) -> Result<Vec<(u32, PathBuf)>, ReportError> {
    let failed = |source| ReportError::Inaccessible {
        path: folder.to_owned(),
        action: "read",
        source,
    };
    let update_of = |path: &Path| {
        let name = path.file_name()?.to_str()?;
        let number = name.strip_prefix("insert_")?.strip_suffix(".vtu")?;
        number.parse().ok()
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        found.extend(update_of(&path).map(|update| (update, path)));
    }
    found.sort_unstable();
    Ok(found)
}

fn case(path: &Path) -> Result<Option<String>, ReportError> {
    let Some(text) = text(path)? else {
        return Ok(None);
    };
    if let Err(error) = text.parse::<toml::Table>() {
        let problem = format!("is not a case: {}", error.message());
        return Err(ReportError::content(path, problem));
    }
    // An empty case is a case with every default.
    if !text.is_empty() {
        check_end(&text, path)?;
    }
    Ok(Some(text))
}

fn summary(path: &Path) -> Result<Option<Summary>, ReportError> {
    let Some(text) = text(path)? else {
        return Ok(None);
    };
    let failed = |error| {
        let problem = format!("is not a summary in JSON: {error}. Run the case again");
        ReportError::content(path, problem)
    };
    serde_json::from_str(&text).map(Some).map_err(failed)
}

/// Returns the table of a file; none if there is no such file.
pub(crate) fn table(path: &Path) -> Result<Option<Table>, ReportError> {
    let Some(text) = text(path)? else {
        return Ok(None);
    };
    check_end(&text, path)?;
    Table::parse(&text, path).map(Some)
}

/// Rejects a text whose last line has no end: a run ends every line of its files, so the file was truncated.
fn check_end(text: &str, path: &Path) -> Result<(), ReportError> {
    if text.ends_with('\n') {
        return Ok(());
    }
    let problem = "is cut short: its last line does not end";
    Err(ReportError::content(path, problem))
}

fn text(path: &Path) -> Result<Option<String>, ReportError> {
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(source) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(ReportError::Inaccessible {
            path: path.to_owned(),
            action: "read",
            source,
        }),
    }
}
