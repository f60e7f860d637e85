//! `condyle report`, `condyle plot` and `condyle diff`.

use std::{
    fs,
    path::{Path, PathBuf},
};

use condyle_report::{
    Picture, Results, pictures,
    runs::{Differences, Run, write_runs},
};
use condyle_results::PLOTTED;

use crate::{
    arguments::{Diff, PictureFormat, Plot, Report},
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

/// Curves listed; the others differ less.
const MAX_CURVES: usize = 8;

pub fn diff(arguments: &Diff) -> Done {
    let read = |folder: &Path| {
        note_unfinished(folder);
        Run::read(folder)
    };
    let (first, second) = (read(&arguments.first)?, read(&arguments.second)?);
    let differences = Differences::of(&first, &second);
    if arguments.json {
        return output::print(&output::json(&differences));
    }
    let mut lines = Lines::default();
    let [first, second] = &differences.runs;
    lines.line(format!("A  {first}\nB  {second}"));
    for note in &differences.notes {
        lines.line(format!("note: {note}"));
    }
    add_settings(&differences, &mut lines);
    add_numbers(&differences, &mut lines);
    add_curves(&differences, &mut lines);
    add_maps(&differences, &mut lines);
    if differences.is_none() {
        lines.line("nothing differs in the results that both have");
    }
    output::print(lines.text())
}

fn add_settings(differences: &Differences, lines: &mut Lines) {
    if differences.settings.is_empty() {
        return;
    }
    lines.line("settings that differ, A and B");
    for one in &differences.settings {
        let [first, second] =
            [&one.first, &one.second].map(|value| value.as_deref().unwrap_or("-"));
        lines.line(format!("  {:<38}  {first}  {second}", one.key));
    }
}

fn add_numbers(differences: &Differences, lines: &mut Lines) {
    if differences.numbers.is_empty() {
        return;
    }
    lines.line("numbers, by size over errors                       A           B       B - A         %    errors  that is");
    for one in &differences.numbers {
        let percent = or_dash(one.difference_percent, |percent| format!("{percent:+.2}"));
        let errors = or_dash(one.errors(), |errors| digits(errors, 2));
        let difference = digits(one.difference, 4);
        let [first, second] = [one.first, one.second].map(|value| digits(value, 5));
        lines.line(format!(
            "  {:<38}{first:>12}{second:>12}{difference:>12}{percent:>10}{errors:>10}  {}",
            one.key,
            one.verdict()
        ));
    }
}

fn add_curves(differences: &Differences, lines: &mut Lines) {
    if differences.curves.is_empty() {
        return;
    }
    lines.line(
        "curves, by size over range                       rms  % of range     largest      at %",
    );
    for one in differences.curves.iter().take(MAX_CURVES) {
        let name = format!("{}, {} cycle", one.column, one.cycle);
        let of_range = or_dash(one.rms_percent_of_range, |percent| format!("{percent:.2}"));
        let [rms, largest] = [one.rms, one.largest].map(|value| digits(value, 4));
        lines.line(format!(
            "  {name:<38}{rms:>12}{of_range:>12}{largest:>12}{:>10.1}",
            one.largest_at_percent
        ));
    }
    let left = differences.curves.len().saturating_sub(MAX_CURVES);
    if left > 0 {
        lines.line(format!("  and {left} more that differ less"));
    }
}

fn add_maps(differences: &Differences, lines: &mut Lines) {
    if differences.maps.is_empty() {
        return;
    }
    lines.line(
        "maps, by size over largest value             largest           %   mean size  at x, z, mm",
    );
    for one in &differences.maps {
        let percent = or_dash(one.largest_percent, |percent| format!("{percent:+.2}"));
        let [largest, mean] = [one.largest, one.mean_absolute].map(|value| digits(value, 4));
        lines.line(format!(
            "  {:<38}{largest:>12}{percent:>12}{mean:>12}  {:.1}, {:.1}",
            one.field, one.x_mm, one.z_mm
        ));
    }
}

fn or_dash(value: Option<f64>, in_words: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), in_words)
}

/// Returns a number with `count` significant digits, with a power of ten only where it avoids many zeros.
fn digits(value: f64, count: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor() as i32;
    // Up to seven digits before or four zeros after the point are easier to compare than powers of ten.
    if !(-4..7).contains(&magnitude) {
        return format!("{value:.*e}", (count - 1) as usize);
    }
    format!("{value:.*}", (count - 1 - magnitude).max(0) as usize)
}
