//! `condyle report`, `condyle plot` and `condyle diff`.

use std::path::{Path, PathBuf};

use condyle_report::{
    Picture, Results, pictures,
    runs::{CurveDifference, Differences, MapDifference, NumberDifference, Run, runs_html},
};
use condyle_results::{PLOTTED, SettingDifference};

use crate::{
    arguments::{Diff, PictureFormat, Plot, Report},
    output::{self, Done, Failure, Lines, note},
};

pub fn report(arguments: &Report) -> Done {
    match arguments.results.as_slice() {
        [folder] if arguments.out.is_none() => {
            let (page, left_out) = condyle_report::write_readable_report(folder)?;
            let left_out = left_out.iter();
            output::warn(left_out.map(|why| format!("omitted from the page: {why}")));
            note_unfinished(folder);
            let mut written = vec![page];
            if arguments.pictures {
                written.extend(condyle_report::write_pictures(folder)?);
            }
            let mut lines = Lines::default();
            for path in written {
                lines.line(format!("wrote {}", path.display()));
            }
            output::print(lines.text())
        }
        [_] => Err(Failure::bad_input(
            "--out is for the page of several runs; the report of one is in its folder",
        )),
        _ if arguments.pictures => Err(Failure::bad_input(
            "--pictures is for one results folder; condyle plot writes the pictures of each",
        )),
        folders => {
            let runs = folders.iter().map(|folder| Run::read(folder));
            let runs: Vec<Run> = runs.collect::<Result<_, _>>()?;
            for run in &runs {
                let left_out = run.results.left_out.iter();
                output::warn(left_out.map(|why| format!("left out of {}: {why}", run.name)));
            }
            let page = arguments.out.as_deref().unwrap_or(Path::new("runs.html"));
            output::write_file(page, runs_html(runs).as_bytes(), arguments.force)?;
            folders.iter().for_each(|folder| note_unfinished(folder));
            output::print(&format!("wrote {}\n", page.display()))
        }
    }
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
            "this condyle was built without support for PNG; build it with: cargo install --path crates/condyle-cli \
             --features png, or choose SVG",
        ));
    }
    let results = Results::read_readable(&arguments.results)?;
    let left_out = results.left_out.iter();
    output::warn(left_out.map(|why| format!("not drawn: {why}")));
    note_unfinished(&arguments.results);
    let default = arguments.results.join(PLOTTED.folder);
    let folder = arguments.out.as_ref().unwrap_or(&default);
    let mut lines = Lines::default();
    for (path, bytes) in files(arguments, &pictures(&results)) {
        let path = folder.join(path);
        output::write_into(&path, &bytes, arguments.force || *folder == default)?;
        lines.line(format!("wrote {}", path.display()));
    }
    if lines.text().is_empty() {
        let folder = arguments.results.display();
        return Err(Failure::bad_input(format_args!(
            "{folder} contains nothing to draw"
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
    lines.notes(&differences.notes);
    add(
        "settings that differ, A and B",
        differences.settings.iter().map(setting_row),
        &mut lines,
    );
    add(
        "numbers, by size over errors                       A           B       B - A         %    errors  that is",
        differences.numbers.iter().map(number_row),
        &mut lines,
    );
    add(
        "curves, by size over range                       rms  % of range     largest      at %",
        differences.curves.iter().take(MAX_CURVES).map(curve_row),
        &mut lines,
    );
    // The curves are ranked, so that those omitted differ least.
    let left = differences.curves.len().saturating_sub(MAX_CURVES);
    if left > 0 {
        lines.line(format!("  and {left} more that differ less"));
    }
    add(
        "maps, by size over largest value             largest           %   mean size  at x, z, mm",
        differences.maps.iter().map(map_row),
        &mut lines,
    );
    if differences.is_none() {
        lines.line("nothing differs in the results that both have");
    }
    output::print(lines.text())
}

fn add(heading: &str, rows: impl Iterator<Item = String>, lines: &mut Lines) {
    let mut rows = rows.peekable();
    if rows.peek().is_some() {
        lines.line(heading);
        rows.for_each(|row| lines.line(row));
    }
}

fn setting_row(one: &SettingDifference) -> String {
    let [first, second] = one.shown().map(|value| value.unwrap_or("-".to_owned()));
    format!("  {:<38}  {first}  {second}", one.key)
}

fn number_row(one: &NumberDifference) -> String {
    let percent = or_dash(one.difference_percent, |percent| format!("{percent:+.2}"));
    let errors = or_dash(one.errors(), |errors| digits(errors, 2));
    let (difference, verdict) = (digits(one.difference, 4), one.verdict());
    let [first, second] = [one.first, one.second].map(|value| digits(value, 5));
    format!(
        "  {:<38}{first:>12}{second:>12}{difference:>12}{percent:>10}{errors:>10}  {verdict}",
        one.key
    )
}

fn curve_row(one: &CurveDifference) -> String {
    let name = format!("{}, {} cycle", one.column, one.cycle);
    let of_range = or_dash(one.rms_percent_of_range, |percent| format!("{percent:.2}"));
    let ([rms, largest], at) = (
        [one.rms, one.largest].map(|value| digits(value, 4)),
        one.largest_at_percent,
    );
    format!("  {name:<38}{rms:>12}{of_range:>12}{largest:>12}{at:>10.1}")
}

fn map_row(one: &MapDifference) -> String {
    let percent = or_dash(one.largest_percent, |percent| format!("{percent:+.2}"));
    let [largest, mean] = [one.largest, one.mean_absolute].map(|value| digits(value, 4));
    let (field, x, z) = (one.field, one.x_mm, one.z_mm);
    format!("  {field:<38}{largest:>12}{percent:>12}{mean:>12}  {x:.1}, {z:.1}")
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
