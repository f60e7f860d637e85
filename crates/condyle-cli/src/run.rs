//! `condyle run`.

use std::path::Path;

use condyle_case::cache::Cache;
use condyle_lab::{Outcome, RunOptions};
use condyle_results::{
    ErrorEstimate, ErrorParts, Part, Summary,
    catalogue::{self, MASS_LOSS_MG, Prominence, Scalar, WEAR_OVER_CONVENTIONAL},
    with_digits,
};

use crate::{
    arguments::Run,
    output::{self, Done, Failure, Lines, note},
    progress::{self, RunProgress},
    run_tables,
};

pub fn run(arguments: &Run) -> Done {
    let default = || Path::new("results").join(arguments.case.file_stem().unwrap_or_default());
    let options = RunOptions {
        out: arguments.out.clone().unwrap_or_else(default),
        resume: arguments.resume,
        force: arguments.force,
        threads: usize::from(arguments.threads),
        cache: Cache::of_user(),
        report: true,
    };
    let (case, set) = (&arguments.case, &arguments.changes.set);
    let outcome = {
        let mut progress = RunProgress::new();
        condyle_lab::run(case, set, &options, &mut |event| progress.show(&event))?
    };
    match outcome {
        Outcome::Done(summary) => print_summary(&summary, &options.out, arguments.json),
        Outcome::DoneBefore(summary) => {
            note("this run is done already: nothing was computed");
            print_summary(&summary, &options.out, arguments.json)
        }
        Outcome::Interrupted(reached) => Err(Failure::interrupted(format_args!(
            "interrupted: {}, and kept; resume with: {}",
            progress::in_words(&reached),
            resuming_command(arguments, &options.out)
        ))),
    }
}

fn resuming_command(arguments: &Run, out: &Path) -> String {
    let quoted = |text: String| format!("'{}'", text.replace('\'', r"'\''"));
    let path = |path: &Path| {
        let text = path.display().to_string();
        let is_plain = |one: char| one.is_alphanumeric() || "/._-".contains(one);
        if text.chars().all(is_plain) {
            text
        } else {
            quoted(text)
        }
    };
    let changes = arguments.changes.set.iter();
    let changes = changes.map(|change| format!(" --set {}", quoted(change.to_string())));
    let (case, out, changes) = (
        path(&arguments.case),
        path(out),
        changes.collect::<String>(),
    );
    format!("condyle run {case} --out {out} --resume{changes}")
}

fn print_summary(summary: &Summary, out: &Path, json: bool) -> Done {
    if json {
        return output::print_with_folder(&output::json(summary), out);
    }
    let mut lines = Lines::default();
    // Reasons to doubt the run come before its numbers.
    for doubt in &summary.plausibility {
        lines.line(format!("doubtful: {}", doubt.message));
        lines.line(format!("          {}", doubt.advice));
    }
    if let Some(prediction) = &summary.prediction {
        run_tables::add_prediction(prediction, summary, &mut lines);
    }
    let wear_over_conventional = summary.get(&WEAR_OVER_CONVENTIONAL);
    run_tables::add_laws(&summary.wear_laws, wear_over_conventional, &mut lines);
    run_tables::add_activities(&summary.activities, &mut lines);
    if let Some(axes) = &summary.axes {
        lines.line(axes);
    }
    let rows = rows(summary);
    let labels = rows.iter().map(|(label, _)| label.len());
    let width = labels.max().unwrap_or_default().max(26) + 2;
    for (label, value) in rows {
        lines.line(format!("{label:<width$}{value}"));
    }
    for note in &summary.notes {
        lines.line(format!("note: {}", note.message));
        lines.line(format!("      {}", note.advice));
    }
    for (part, why) in summary.error.iter().flat_map(|error| &error.not_estimated) {
        let part = part.replace('_', " ");
        lines.line(format!(
            "warning: the error from {part} could not be estimated: {why}"
        ));
    }
    let series = ["insert.pvd", "cycle_first.pvd", "cycle_last.pvd"].map(|name| out.join(name));
    let series = series.iter().filter(|file| file.exists());
    let series = series.map(|file| file.display().to_string());
    lines.line(format!(
        "results in {}; open {}, and in ParaView {}",
        out.display(),
        out.join("report.html").display(),
        series.collect::<Vec<_>>().join(", ")
    ));
    output::print_with_folder(lines.text(), out)
}

type SummaryLine = (&'static str, String);

/// Returns the numbers of the catalogue, then the parts of the error.
fn rows(summary: &Summary) -> Vec<SummaryLine> {
    let mut rows: Vec<SummaryLine> = Vec::new();
    for scalar in catalogue::scalars().filter(|scalar| scalar.prominence >= Prominence::Printed) {
        let Some(words) = in_words(summary, scalar) else {
            continue;
        };
        if !scalar.is_continued || rows.is_empty() {
            rows.push((scalar.label, words));
            continue;
        }
        // "contact evaluations a cycle" continues the line of "contact evaluations", as "... a cycle".
        let of_label = rows
            .iter()
            .rposition(|(label, _)| scalar.label.starts_with(label));
        let row = of_label.unwrap_or(rows.len() - 1);
        let (label, line) = &mut rows[row];
        let rest = scalar.label.strip_prefix(*label).unwrap_or(scalar.label);
        *line += &format!(", {words} {}", rest.trim_start());
    }
    if let (Some(error), Some((_, time))) = (&summary.error, rows.last_mut()) {
        *time += &format!(", error estimate {:.3} s", error.wall_s);
    }
    rows.extend(summary.error.iter().map(row_of_error));
    rows
}

/// Returns the value of a number with its unit, its estimated discretisation error and the cycle that has it.
fn in_words(summary: &Summary, scalar: &Scalar) -> Option<String> {
    let with_unit = |value: f64| {
        let text = format!("{} {}", scalar.text(value), scalar.shown_unit());
        text.trim_end().to_owned()
    };
    let mut words = with_unit(summary.get(scalar)?);
    if let Some(error) = summary.error.as_ref().and_then(|errors| errors.get(scalar)) {
        let percent = with_digits(error.percent.total, 2);
        let off = with_unit(error.in_unit.total);
        let parts = error.percent.parts().into_iter();
        let missing: Vec<String> = parts
            .filter(|(_, percent)| percent.is_none())
            .map(|(part, _)| part.name().replace('_', " "))
            .collect();
        words += &match missing.is_empty() {
            true => format!(", discretisation error +/- {off} ({percent} %)"),
            false => format!(
                ", discretisation error more than {off} ({percent} %), which excludes {}",
                missing.join(" and ")
            ),
        };
    }
    let cycles_before = scalar.cycle_key.and_then(catalogue::scalar);
    match cycles_before.and_then(|scalar| summary.get(scalar)) {
        Some(0.0) => words += ", in the first cycle",
        Some(cycles) => words += &format!(", after {cycles:.0} cycles"),
        None => {}
    }
    Some(words)
}

/// Returns the parts of the error of the mass, with the sign of the change that finer values would make.
fn row_of_error(error: &ErrorEstimate) -> SummaryLine {
    let mass = error.of(&MASS_LOSS_MG).percent;
    ("error of mass, by parts", in_parts(mass))
}

fn in_parts(error: &ErrorParts) -> String {
    let part = |(part, percent): (Part, Option<f64>)| {
        let name = part.name().replace('_', " ");
        match percent {
            Some(percent) if percent < 0.0 => format!("{name} {} %", with_digits(percent, 2)),
            Some(percent) => format!("{name} +{} %", with_digits(percent, 2)),
            None => format!("{name} unknown"),
        }
    };
    error.parts().map(part).join(", ")
}
