//! `condyle new` and `condyle export`: commands that write one new file.

use std::{
    io::ErrorKind,
    path::{Path, PathBuf},
    process::Command,
    thread,
};

use condyle_case::{
    abaqus::{ExportError, PressedCase},
    case::{Case, DraftError, Drafted, template},
};
use condyle_lab::{Preview, RunError};
use condyle_results::create_file;

use crate::{
    arguments::{Export, New},
    output::{self, Done, Failure, note},
};

/// The schema file next to a case, which the case names in its first line.
const SCHEMA: &str = "condyle.schema.json";

pub fn new(arguments: &New) -> Done {
    let path = &arguments.case;
    let text = text(arguments, &meshes(arguments)?).map_err(|error| match &error {
        DraftError::Case(problems) => Failure::from(problems),
        DraftError::Exchanged { femur, insert } => {
            let [case, femur, insert] = [path, femur, insert].map(|path| path.display());
            Failure::bad_input(format_args!(
                "{error}: condyle new {case} --femur {insert} --insert {femur}"
            ))
        }
        _ => Failure::bad_input(error),
    })?;
    let text = format!("#:schema {SCHEMA}\n{text}");
    output::write_file(path, text.as_bytes(), arguments.force)?;
    // For editors; a case runs without it.
    let schema = path.with_file_name(SCHEMA);
    match create_file(&schema, Case::json_schema().as_bytes()) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            output::warn([format_args!("{}: {error}", schema.display())]);
        }
        _ => {}
    }
    let picture = match arguments.femur.as_ref().or(arguments.head.as_ref()) {
        Some(_) => settled(path, arguments.force)?
            .map(|picture| format!("look at {}; ", picture.display())),
        // The bodies by dimensions always start.
        None => None,
    };
    let (path, picture) = (path.display(), picture.unwrap_or_default());
    output::print(&format!(
        "wrote {path}; {picture}run it with: condyle run {path}\n"
    ))
}

/// Settles the bodies of a case as a run does, and draws them in place into a file next to it; none if that cannot be written.
fn settled(case: &Path, force: bool) -> Result<Option<PathBuf>, Failure> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let preview = Preview::of(case, &[], threads).map_err(|error| {
        note(format_args!(
            "wrote {}, which does not start:",
            case.display()
        ));
        Failure::from(error)
    })?;
    output::warn(preview.warnings.iter().chain(&preview.doubts));
    let picture = case.with_extension("svg");
    match output::write_file(&picture, preview.picture_svg().as_bytes(), force) {
        Ok(()) => Ok(Some(picture)),
        Err(unwritten) => {
            output::warn([format_args!("no picture: {}", unwritten.0)]);
            Ok(None)
        }
    }
}

fn folder(arguments: &New) -> &Path {
    let folder = arguments.case.parent();
    let folder = folder.filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

/// Returns the meshes of both bodies, counterface first: the given files, or those that STEP files are converted to next to the
/// case; none without files.
fn meshes(arguments: &New) -> Result<Option<[PathBuf; 2]>, Failure> {
    let knee = arguments.femur.as_ref().zip(arguments.insert.as_ref());
    let hip = arguments.head.as_ref().zip(arguments.cup.as_ref());
    let Some((counterface, bearing)) = knee.or(hip) else {
        return Ok(None);
    };
    let mesh = |file| converted(file, arguments);
    Ok(Some([mesh(counterface)?, mesh(bearing)?]))
}

/// Returns a mesh file, or the one that the Python package converts a STEP file to.
fn converted(file: &Path, arguments: &New) -> Result<PathBuf, Failure> {
    let ending = file.extension().unwrap_or_default().to_ascii_lowercase();
    if ending != "step" && ending != "stp" {
        return Ok(file.to_owned());
    }
    let name = file.with_extension("ply");
    let mesh = folder(arguments).join(name.file_name().unwrap_or_default());
    if mesh.exists() && !arguments.force {
        return Err(Failure::bad_input(format_args!(
            "{} exists: give it in place of {}, or replace it with --force",
            mesh.display(),
            file.display()
        )));
    }
    let python = if cfg!(windows) { "python" } else { "python3" };
    let mut command = Command::new(python);
    command.args(["-m", "condyle.cad"]).args([file, &mesh]);
    let failed = |why: &str| {
        Failure::bad_input(format_args!(
            "{}: the Python package is needed to convert a STEP file: {}\nInstall it with: {python} -m pip install 'condyle[cad]'\n\
             Or convert the file with another program, to STL with a chord error of at most 0.03 mm",
            file.display(),
            why.trim_end()
        ))
    };
    let output = command
        .output()
        .map_err(|error| failed(&format!("{python}: {error}")))?;
    if !output.status.success() {
        return Err(failed(&String::from_utf8_lossy(&output.stderr)));
    }
    note(String::from_utf8_lossy(&output.stdout).trim_end());
    Ok(mesh)
}

/// Returns the case to write: of two meshes if they are given, else with the bodies that suit the machine.
fn text(arguments: &New, meshes: &Option<[PathBuf; 2]>) -> Result<String, DraftError> {
    let (preset, folder) = (arguments.preset(), folder(arguments));
    let Some(meshes) = meshes else {
        return Ok(template(preset));
    };
    let meshes = meshes.each_ref().map(PathBuf::as_path);
    let drafted = match arguments.head {
        Some(_) => Drafted::hip(preset, meshes, folder)?,
        None => Drafted::new(preset, arguments.side, meshes, folder)?,
    };
    drafted.remarks.iter().for_each(note);
    Ok(drafted.text)
}

pub fn export(arguments: &Export) -> Done {
    let case = Case::read_changed(&arguments.case, &arguments.changes.set);
    let case = case.map_err(RunError::from)?;
    let mut text = Vec::new();
    let written = PressedCase::new(&case, usize::from(arguments.threads)).and_then(|pressed| {
        pressed.write(arguments.pressed_at, &mut text)?;
        Ok(pressed.warnings)
    });
    output::warn(written.map_err(|error| export_failure(&case, error))?);
    let path = &arguments.out;
    output::write_file(path, &text, arguments.force)?;
    output::print(&format!("wrote {}\n", path.display()))
}

/// Fails as a run of the same case would.
fn export_failure(case: &Case, error: ExportError) -> Failure {
    Failure::from(match error {
        ExportError::Build(source) => RunError::Case(case.at_its_key(&source)),
        ExportError::Placement(source) => RunError::Placement {
            shown: case.placement_at_its_key(&source, &[]),
            source,
        },
        ExportError::Cycle(source) => RunError::March {
            source: *source,
            out: None,
        },
        ExportError::Write { .. } | ExportError::Unsupported { .. } | ExportError::Apart { .. } => {
            return Failure::bad_input(error);
        }
    })
}
