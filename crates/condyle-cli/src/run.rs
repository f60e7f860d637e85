//! `condyle run`.

use std::{
    ops::ControlFlow,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use condyle_case::cache::Cache;
use condyle_lab::{Outcome, RunOptions};
use condyle_results::{
    BacksideSummary, CreepSummary, ErrorEstimate, ErrorParts, PlasticSummary, Summary,
    UnderSurfaceSummary,
};

use crate::{
    activity_table,
    arguments::Run,
    exit, law_table,
    output::{self, Lines},
    progress::{Progress, in_words},
    standard_error::tell,
};

pub fn run(arguments: &Run) -> ExitCode {
    let options = RunOptions {
        out: arguments
            .out
            .clone()
            .unwrap_or_else(|| default_folder(arguments)),
        resume: arguments.resume,
        force: arguments.force,
        threads: usize::from(arguments.threads),
        cache: Cache::of_user(),
    };
    let stop = stop_on_interrupt();
    let mut progress = Progress::new();
    let outcome = condyle_lab::run_changed(
        &arguments.case,
        &arguments.changes.set,
        &options,
        &mut |on_event| {
            progress.show(&on_event);
            if stop.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        },
    );
    progress.finish();
    match outcome {
        Ok(Outcome::Done(summary)) => print_summary(&summary, &options, arguments.json),
        Ok(Outcome::DoneBefore(summary)) => {
            tell("this run is done already: nothing was computed");
            print_summary(&summary, &options, arguments.json)
        }
        Ok(Outcome::Interrupted(reached)) => {
            tell(format_args!(
                "interrupted: {}, and kept; go on with: {}",
                in_words(&reached),
                command_to_go_on(arguments, &options)
            ));
            ExitCode::from(exit::INTERRUPTED)
        }
        Err(error) => exit::fail_run(&error),
    }
}

/// The command that goes on with a run, as a shell takes it.
fn command_to_go_on(arguments: &Run, options: &RunOptions) -> String {
    let (case, out) = (arguments.case.display(), options.out.display());
    let changes = arguments.changes.set.iter().map(|change| {
        let quoted = change.to_string().replace('\'', r"'\''");
        format!(" --set '{quoted}'")
    });
    let changes: String = changes.collect();
    format!("condyle run {case} --out {out} --resume{changes}")
}

/// `results/` and the case's name, beside where the command runs.
fn default_folder(arguments: &Run) -> PathBuf {
    PathBuf::from("results").join(arguments.case.file_stem().unwrap_or_default())
}

/// A flag that the first Ctrl-C (or SIGTERM) raises; a second ends the program at once.
pub fn stop_on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let set = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(exit::INTERRUPTED));
        }
    });
    if let Err(error) = set {
        tell(format_args!(
            "warning: Ctrl-C will end the run at once: {error}"
        ));
    }
    stop
}

fn print_summary(summary: &Summary, options: &RunOptions, json: bool) -> ExitCode {
    let out = &options.out;
    if json {
        return output::print_beside(&output::json(summary), out);
    }
    let mut lines = Lines::default();
    add_doubts(summary, &mut lines);
    law_table::add(
        &summary.wear_laws,
        summary.wear_over_conventional,
        &mut lines,
    );
    activity_table::add(&summary.activities, &mut lines);
    for (what, value) in rows(summary) {
        lines.line(format_args!("{what:<28}{value}"));
    }
    add_warnings(summary, &mut lines);
    lines.line(format_args!(
        "results in {}; open {}, and in ParaView {}",
        out.display(),
        out.join("report.html").display(),
        for_paraview(out)
    ));
    output::print_beside(lines.text(), out)
}

/// The files of a run that ParaView plays.
fn for_paraview(out: &Path) -> String {
    let series = ["insert.pvd", "cycle_first.pvd", "cycle_last.pvd"];
    let files = series.map(|name| out.join(name)).into_iter();
    let there = files.filter(|file| file.exists());
    let named: Vec<String> = there.map(|file| file.display().to_string()).collect();
    named.join(", ")
}

/// What makes the run doubtful comes before its numbers.
fn add_doubts(summary: &Summary, lines: &mut Lines) {
    for doubt in &summary.plausibility {
        lines.line(format_args!("doubtful: {}", doubt.message));
        lines.line(format_args!("          {}", doubt.advice));
    }
}

fn add_warnings(summary: &Summary, lines: &mut Lines) {
    for (part, why) in not_estimated(summary) {
        lines.line(format_args!(
            "warning: the error from {part} could not be estimated: {why}"
        ));
    }
}

/// Parts of the error that have no estimate, and why.
fn not_estimated(summary: &Summary) -> impl Iterator<Item = (String, &String)> {
    let error = summary.error.iter();
    let parts = error.flat_map(|error| &error.not_estimated);
    parts.map(|(part, why)| (part.replace('_', " "), why))
}

/// A name and what is said of it.
type SummaryLine = (&'static str, String);

fn rows(summary: &Summary) -> Vec<SummaryLine> {
    let mut rows = vec![("gait cycles", format!("{:.0}", summary.cycles))];
    rows.extend(rows_of_wear(summary));
    rows.extend(summary.creep.iter().flat_map(rows_of_creep));
    rows.extend(rows_of_contact(summary));
    rows.extend(summary.pressure_law_peak_error_percent.map(row_of_law));
    rows.extend(summary.under_surface.iter().flat_map(rows_under_surface));
    rows.extend(rows_of_motion(summary));
    rows.extend(rows_of_work(summary));
    rows.extend(summary.error.iter().flat_map(rows_of_error));
    rows
}

fn rows_of_wear(summary: &Summary) -> [SummaryLine; 3] {
    let Summary {
        volume_loss_mm3,
        volume_loss_mesh_mm3,
        ..
    } = summary;
    let parts = |of: fn(&ErrorEstimate) -> &ErrorParts| summary.error.as_ref().map(of);
    let mass_parts = parts(|error| &error.mass_loss_percent);
    let depth_parts = parts(|error| &error.max_depth_percent);
    let volumes = format!("{volume_loss_mm3:.2} mm3 ({volume_loss_mesh_mm3:.2} from the mesh)");
    [
        (
            "mass loss",
            with_error(summary.mass_loss_mg, 2, "mg", mass_parts),
        ),
        ("volume loss", volumes),
        (
            "deepest wear",
            with_error(summary.max_depth_mm, 4, "mm", depth_parts),
        ),
    ]
}

fn rows_of_creep(creep: &CreepSummary) -> Vec<SummaryLine> {
    let parted = |penetration: f64, wear: f64, creep: f64| {
        format!("{penetration:.4} mm: {wear:.4} by wear, {creep:.4} by creep (approximate)")
    };
    let mut rows = vec![
        (
            "deepest penetration",
            parted(
                creep.max_penetration_mm,
                creep.wear_there_mm,
                creep.creep_there_mm,
            ),
        ),
        (
            "  scanned without load",
            format!("{:.4} mm", creep.max_unloaded_depth_mm),
        ),
        ("volume of creep", format!("{:.2} mm3", creep.volume_mm3)),
    ];
    if let Some(first) = creep.first_million {
        let said = parted(first.penetration_mm, first.wear_mm, first.creep_mm);
        rows.push(("  after a million cycles", said));
    }
    if let Some(line) = creep.line_from_a_million {
        rows.push((
            "  scans from there on",
            format!(
                "{:.4} mm a million cycles, from {:.4} mm, as laboratories part wear from creep",
                line.rise_mm_per_million_cycles, line.at_no_cycles_mm
            ),
        ));
    }
    rows
}

fn rows_of_contact(summary: &Summary) -> [SummaryLine; 3] {
    let error = summary.error.as_ref();
    let pressure = with_error(
        summary.peak_pressure_mpa,
        1,
        "MPa",
        error.map(|error| &error.peak_pressure_percent),
    );
    let area = with_error(
        summary.peak_contact_area_mm2,
        0,
        "mm2",
        error.map(|error| &error.peak_contact_area_percent),
    );
    [
        (
            "peak pressure",
            format!("{pressure}, {}", when(summary.peak_pressure_cycle)),
        ),
        (
            "largest contact area",
            format!("{area}, {}", when(summary.peak_contact_area_cycle)),
        ),
        (
            "  first and last cycle",
            format!(
                "{:.1} and {:.1} MPa, {:.0} and {:.0} mm2",
                summary.first_cycle_peak_pressure_mpa,
                summary.last_cycle_peak_pressure_mpa,
                summary.first_cycle_contact_area_mm2,
                summary.last_cycle_contact_area_mm2
            ),
        ),
    ]
}

fn row_of_law(percent: f64) -> SummaryLine {
    let said = format!("fitted to a deformable insert, whose peak it misses by up to {percent} %");
    ("  pressure law", said)
}

fn rows_under_surface(under: &UnderSurfaceSummary) -> Vec<SummaryLine> {
    let at = |stress: f64, depth: f64| format!("{stress:.1} MPa, {depth:.1} mm below the surface");
    let shear = at(under.peak_max_shear_mpa, under.peak_max_shear_depth_mm);
    let von_mises = at(under.peak_von_mises_mpa, under.peak_von_mises_depth_mm);
    let when = when(under.peak_max_shear_cycle);
    let mut rows = vec![
        ("largest shear stress", format!("{shear}, {when}")),
        ("largest von Mises stress", von_mises),
    ];
    rows.extend(under.plastic.iter().flat_map(rows_of_plasticity));
    rows.extend(under.backside.iter().flat_map(rows_of_backside));
    rows
}

fn rows_of_backside(backside: &BacksideSummary) -> [SummaryLine; 2] {
    let BacksideSummary {
        backside_lift_mm,
        backside_lifted_percent,
        backside_slip_mm,
        backside_lock_force_n,
        backside_lock_moment_nm,
    } = backside;
    [
        (
            "backside",
            format!(
                "lifts by up to {backside_lift_mm:.4} mm, {backside_lifted_percent:.0} % of it at once; slips \
                 {backside_slip_mm:.4} mm a cycle"
            ),
        ),
        (
            "  lock",
            format!(
                "carries up to {backside_lock_force_n:.0} N and {backside_lock_moment_nm:.2} N m"
            ),
        ),
    ]
}

fn rows_of_plasticity(plastic: &PlasticSummary) -> [SummaryLine; 2] {
    let PlasticSummary {
        max_permanent_set_mm,
        first_cycle_permanent_set_mm,
        max_plastic_strain,
        yielded_elements,
        ratcheting_elements,
    } = plastic;
    [
        (
            "permanent set",
            format!(
                "{max_permanent_set_mm:.4} mm, after the first cycle {first_cycle_permanent_set_mm:.4} mm"
            ),
        ),
        (
            "  yielded elements",
            format!(
                "{yielded_elements}, {ratcheting_elements} of them in every cycle still; plastic strain up to {max_plastic_strain:.4}"
            ),
        ),
    ]
}

/// Which cycle, by the cycles before it.
fn when(cycles_before: f64) -> String {
    if cycles_before == 0.0 {
        return "in the first cycle".to_owned();
    }
    format!("after {cycles_before:.0} cycles")
}

fn rows_of_motion(summary: &Summary) -> [SummaryLine; 3] {
    let share = 100.0 * summary.medial_load_share;
    let error = summary.error.as_ref();
    let ap_parts = error.map(|error| &error.ap_range_percent);
    let ie_parts = error.map(|error| &error.ie_range_percent);
    [
        (
            "AP range, first cycle",
            with_error(summary.ap_range_mm, 2, "mm", ap_parts),
        ),
        (
            "IE range, first cycle",
            with_error(summary.ie_range_deg, 2, "deg", ie_parts),
        ),
        ("medial share of the load", format!("{share:.1} %")),
    ]
}

fn rows_of_work(summary: &Summary) -> [SummaryLine; 5] {
    let iterations = per_cycle(
        summary.newton_iterations,
        summary.newton_iterations_per_cycle,
    );
    let evaluations = per_cycle(
        summary.contact_evaluations,
        summary.contact_evaluations_per_cycle,
    );
    [
        (
            "updates, cycles solved",
            format!("{}, {:.1}", summary.updates, summary.cycles_solved),
        ),
        ("Newton iterations", iterations),
        ("contact evaluations", evaluations),
        (
            "hexahedra, worst quality",
            format!("{}, {:.3}", summary.hexahedra, summary.worst_quality),
        ),
        ("time, solver only", format!("{:.3} s", summary.wall_s)),
    ]
}

/// Work in all, and of a cycle solved.
fn per_cycle(all: u64, per_cycle: f64) -> String {
    format!("{all}, {per_cycle:.0} a cycle")
}

/// Where the discretisation error comes from: signed, what finer values would change.
fn rows_of_error(error: &ErrorEstimate) -> [SummaryLine; 3] {
    [
        (
            "error of mass, by parts",
            in_parts(&error.mass_loss_percent),
        ),
        (
            "error of depth, by parts",
            in_parts(&error.max_depth_percent),
        ),
        ("time, error estimate", format!("{:.3} s", error.wall_s)),
    ]
}

fn in_parts(error: &ErrorParts) -> String {
    let part = |(name, percent): (&str, Option<f64>)| match percent {
        Some(percent) => format!("{name} {percent:+.2} %"),
        None => format!("{name} unknown"),
    };
    let parts = [
        ("increments", error.increments),
        ("updates", error.updates),
        ("mesh", error.mesh),
        ("slip tolerance", error.slip_tolerance),
    ];
    parts.map(part).join(", ")
}

/// A number with its unit and its estimated discretisation error.
fn with_error(value: f64, digits: usize, unit: &str, error: Option<&ErrorParts>) -> String {
    let plain = format!("{value:.digits$} {unit}");
    let Some(ErrorParts { total, .. }) = error else {
        return plain;
    };
    let off = value * total / 100.0;
    format!("{plain}, discretisation error +/- {off:.digits$} {unit} ({total:.2} %)")
}
