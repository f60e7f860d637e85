//! `condyle converge`.

use condyle_results::catalogue;
use std::{
    collections::BTreeSet,
    fs,
    ops::ControlFlow,
    process::ExitCode,
    sync::{Mutex, atomic::Ordering},
    thread,
};

use condyle_case::cache::Cache;
use condyle_lab::RunEvent;
use condyle_study::{
    ConvergeError, ConvergeHappening, ConvergeOptions, ConvergePlan, Converged, Convergence,
    Extrapolation, QUANTITIES, Quantity, converge as study,
};

use crate::{arguments::Converge, exit, output, run::stop_on_interrupt, standard_error::tell};

/// Width of a column of the table.
const COLUMN: usize = 15;

pub fn converge(arguments: &Converge) -> ExitCode {
    let plan = match ConvergePlan::new(&arguments.case, &arguments.over) {
        Ok(plan) => plan,
        Err(error) => return fail(&error),
    };
    let options = ConvergeOptions {
        out: arguments.out.clone(),
        threads: threads(arguments.threads),
        resume: arguments.resume,
        cache: Cache::of_user(),
    };
    let stop = stop_on_interrupt();
    let told = Mutex::new(BTreeSet::new());
    let outcome = study(&plan, &options, &|on_event| {
        show(on_event, &told);
        if stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    match outcome {
        Ok(Converged::Done(convergence)) => print(&convergence, arguments),
        Ok(Converged::Interrupted) => {
            tell(
                "interrupted: what was computed is kept; go on with the same command and --resume",
            );
            ExitCode::from(exit::INTERRUPTED)
        }
        Err(error) => fail(&error),
    }
}

/// As many threads as are asked for, or as the machine has cores.
pub fn threads(asked_for: Option<u16>) -> usize {
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    asked_for.map_or_else(cores, usize::from)
}

fn fail(error: &ConvergeError) -> ExitCode {
    match error {
        ConvergeError::Case(in_case) => exit::fail_case(in_case),
        ConvergeError::Run { number, source } => {
            tell(format_args!("in the run with {number}:"));
            exit::fail_run(source)
        }
        other => exit::fail(other, exit::BAD_INPUT),
    }
}

/// A line a run, and every warning once.
fn show(on_event: &ConvergeHappening<'_>, told: &Mutex<BTreeSet<String>>) {
    match on_event {
        ConvergeHappening::Ran(run, summary) => tell(format_args!(
            "{} = {}: {:.3} mg worn, {:.4} mm deep",
            run.number.key(),
            run.number.text(),
            summary[&catalogue::MASS_LOSS_MG],
            summary[&catalogue::MAX_DEPTH_MM]
        )),
        ConvergeHappening::In(_, RunEvent::Warning(warning)) => {
            let mut told = told.lock().expect("no thread panics with it");
            if told.insert(warning.clone()) {
                tell(format_args!("warning: {warning}"));
            }
        }
        ConvergeHappening::In(..) => {}
    }
}

fn print(convergence: &Convergence, arguments: &Converge) -> ExitCode {
    let out = &arguments.out;
    if arguments.json {
        let path = out.join("converge.json");
        return match fs::read_to_string(&path) {
            Ok(text) => output::print_beside(&text, out),
            Err(error) => exit::fail(format!("{}: {error}", path.display()), exit::BAD_INPUT),
        };
    }
    let picture = out.join("converge.svg");
    let text = format!(
        "{}results in {}; open {}\n",
        table(convergence),
        out.display(),
        picture.display()
    );
    output::print_beside(&text, out)
}

fn table(convergence: &Convergence) -> String {
    let key = convergence.key.rsplit('.').next().unwrap_or_default();
    let texts: Vec<&str> = convergence
        .points
        .iter()
        .map(|point| point.text.as_str())
        .collect();
    let finest = texts.last().copied().unwrap_or_default();
    let below = ["order", "extrapolated", "finest from it, %"];
    let first = texts.iter().chain(&below).chain([&key]);
    let width = first.map(|text| text.len()).max().unwrap_or_default();
    let columns: Vec<Column> = QUANTITIES
        .iter()
        .map(|quantity| Column::of(convergence, quantity))
        .collect();
    let line = |first: &str, cell: &dyn Fn(&Column) -> String, last: &str| {
        let cells: String = columns
            .iter()
            .map(|column| format!("{:>COLUMN$}", cell(column)))
            .collect();
        format!("{first:<width$}{cells}{last:>COLUMN$}")
            .trim_end()
            .to_owned()
            + "\n"
    };
    let mut text = line(key, &|column| column.title.to_owned(), "cycles solved");
    text += &line("", &|column| column.unit.to_owned(), "");
    for (row, value) in texts.iter().enumerate() {
        let solved = format!(
            "{:.1}",
            convergence.points[row].summary[&catalogue::CYCLES_SOLVED]
        );
        text += &line(value, &|column| significant(column.values[row]), &solved);
    }
    text += &format!("\ndifference from {key} = {finest}, %\n");
    for (row, value) in texts.iter().enumerate() {
        text += &line(value, &|column| percent(column.differences[row]), "");
    }
    text += "\nas the steps go to zero\n";
    for (row, name) in below.into_iter().enumerate() {
        text += &line(name, &|column| column.tendency[row].clone(), "");
    }
    text + "\n"
}

/// A column of the table.
struct Column {
    title: &'static str,
    unit: &'static str,
    values: Vec<f64>,
    differences: Vec<f64>,
    tendency: [String; 3],
}

impl Column {
    fn of(convergence: &Convergence, quantity: &Quantity) -> Self {
        Self {
            title: quantity.title,
            unit: quantity.unit,
            values: convergence.values(quantity),
            differences: convergence.differences_percent(quantity),
            tendency: tendency(convergence.extrapolation(quantity)),
        }
    }
}

fn tendency(extrapolation: Extrapolation) -> [String; 3] {
    let none = |word: &str| [word.to_owned(), String::new(), String::new()];
    match extrapolation {
        Extrapolation::Converging {
            order,
            extrapolated,
            finest_error_percent,
        } => [
            format!("{order:.2}"),
            significant(extrapolated),
            percent(finest_error_percent),
        ],
        Extrapolation::Slow { order } => {
            [format!("{order:.2}"), "too slow".to_owned(), String::new()]
        }
        Extrapolation::Unchanged => none("unchanged"),
        Extrapolation::Oscillating => none("oscillates"),
        Extrapolation::Diverging => none("diverges"),
        Extrapolation::NoConstantRatio => none("-"),
    }
}

fn percent(value: f64) -> String {
    format!("{value:+.3}")
}

/// Five significant digits.
fn significant(value: f64) -> String {
    const DIGITS: i32 = 5;
    let magnitude = match value {
        0.0 => 0,
        _ => value.abs().log10().floor() as i32,
    };
    let decimals = (DIGITS - 1 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}
