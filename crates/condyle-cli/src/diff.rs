//! `condyle diff`.

use std::path::Path;

use condyle_report::runs::{Differences, Run};

use crate::{
    arguments::Diff,
    output::{self, Done, Lines},
    report::note_unfinished,
};

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
