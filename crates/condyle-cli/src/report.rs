//! `condyle report` and `condyle plot`.

use std::{
    fs,
    path::{Path, PathBuf},
};

use condyle_report::{
    Picture, Results, pictures,
    runs::{Run, write_runs},
};
use condyle_results::PLOTTED;

use crate::{
    arguments::{PictureFormat, Plot, Report},
    output::{self, Done, Failure, Lines, note},
};

pub fn report(arguments: &Report) -> Done {
    match arguments.results.as_slice() {
        [folder] if arguments.out.is_none() => of_one(folder, arguments.pictures),
        [_] => Err(Failure::bad_input(
            "--out is for the page of several runs; the report of one is in its folder",
        )),
        _ if arguments.pictures => Err(Failure::bad_input(
            "--pictures is for one results folder; condyle plot writes the pictures of each",
        )),
        folders => {
            let out = arguments.out.as_deref();
            side_by_side(folders, out.unwrap_or(Path::new("runs.html")))
        }
    }
}

fn side_by_side(folders: &[PathBuf], out: &Path) -> Done {
    let runs = folders.iter().map(|folder| Run::read(folder));
    let runs: Vec<Run> = runs.collect::<Result<_, _>>()?;
    let page = write_runs(out, &runs)?;
    for run in &runs {
        let left_out = run.results.left_out.iter();
        output::warn(left_out.map(|why| format!("left out of {}: {why}", run.name)));
    }
    folders.iter().for_each(|folder| note_unfinished(folder));
    output::print(&format!("wrote {}\n", page.display()))
}

fn of_one(folder: &Path, has_pictures: bool) -> Done {
    let (page, left_out) = condyle_report::write_readable_report(folder)?;
    let left_out = left_out.iter();
    output::warn(left_out.map(|why| format!("left out of the page: {why}")));
    note_unfinished(folder);
    let mut written = vec![page];
    if has_pictures {
        written.extend(condyle_report::write_pictures(folder)?);
    }
    let mut lines = Lines::default();
    for path in written {
        lines.line(format!("wrote {}", path.display()));
    }
    output::print(lines.text())
}

/// Notes that the run of a results folder is not finished, so that its results are not taken for those of the whole
/// test.
pub fn note_unfinished(folder: &Path) {
    if folder.join("checkpoint").exists() && !folder.join("summary.json").exists() {
        note(format_args!(
            "note: the run in {} is not finished (there is no summary.json); its results so far are shown",
            folder.display()
        ));
    }
}

pub fn plot(arguments: &Plot) -> Done {
    if !cfg!(feature = "png") && arguments.format.contains(&PictureFormat::Png) {
        return Err(Failure::bad_input(
            "this condyle was built without PNG; build it with: cargo install --path crates/condyle-cli --features \
             png, or choose SVG",
        ));
    }
    let results = Results::read_readable(&arguments.results)?;
    let left_out = results.left_out.iter();
    output::warn(left_out.map(|why| format!("not drawn: {why}")));
    note_unfinished(&arguments.results);
    let folder = arguments.out.clone();
    let folder = folder.unwrap_or_else(|| arguments.results.join(PLOTTED.folder));
    let mut lines = Lines::default();
    for (path, bytes) in files(arguments, &pictures(&results)) {
        let path = folder.join(path);
        fs::create_dir_all(&folder)
            .and_then(|()| fs::write(&path, bytes))
            .map_err(|error| Failure::unwritten(&path, &error, "choose another folder"))?;
        lines.line(format!("wrote {}", path.display()));
    }
    if lines.text().is_empty() {
        let folder = arguments.results.display();
        return Err(Failure::bad_input(format_args!(
            "{folder} holds nothing to draw"
        )));
    }
    output::print(lines.text())
}

fn files(arguments: &Plot, pictures: &[Picture]) -> Vec<(PathBuf, Vec<u8>)> {
    let is_asked = |format| arguments.format.is_empty() || arguments.format.contains(&format);
    let mut files = Vec::new();
    for picture in pictures {
        let name = Path::new(picture.name);
        if is_asked(PictureFormat::Svg) {
            files.push((name.with_extension("svg"), picture.svg.clone().into_bytes()));
        }
        #[cfg(feature = "png")]
        if is_asked(PictureFormat::Png) {
            let png = condyle_report::png(&picture.svg, f32::from(arguments.dots));
            let png = png.expect("our own pictures are pictures");
            files.push((name.with_extension("png"), png));
        }
    }
    files
}
