//! `condyle compare`.

use std::path::PathBuf;
use std::process::ExitCode;

use condyle_lab::measured::{
    CompareError, Comparison, Errors, GravimetricComparison, Interval, KinematicsComparison,
    NodeDepths, Rate, SurfaceComparison, SurfaceErrors, compare as study,
};
use condyle_results::COMPARED;

use crate::{
    arguments::Compare,
    exit,
    output::{self, Lines},
    report::note_unfinished,
};

pub fn compare(arguments: &Compare) -> ExitCode {
    let comparison = match study(&arguments.results, &arguments.measured) {
        Ok(comparison) => comparison,
        Err(error) => return fail(&error),
    };
    note_unfinished(&arguments.results);
    let out = arguments.out.clone();
    let out = out.unwrap_or_else(|| default_folder(arguments));
    let mut written = match comparison.write(&out) {
        Ok(written) => written,
        Err(error) => return fail(&error),
    };
    if out == default_folder(arguments) {
        match condyle_report::write_readable_report(&arguments.results) {
            Ok((page, _)) => written.push(page),
            Err(error) => return exit::fail(error, exit::BAD_INPUT),
        }
    }
    if arguments.json {
        return output::print_beside(&comparison.json(), &out);
    }
    let mut lines = Lines::default();
    add_tables(&comparison, &mut lines);
    let files = written.iter().map(|path| path.display().to_string());
    lines.line(format_args!(
        "wrote {}",
        files.collect::<Vec<_>>().join(", ")
    ));
    output::print_beside(lines.text(), &out)
}

fn default_folder(arguments: &Compare) -> PathBuf {
    arguments.results.join(COMPARED.folder)
}

/// Prints why no comparison could be made, and gives the exit code.
pub fn fail(error: &CompareError) -> ExitCode {
    match error {
        CompareError::Measured(in_file) => exit::fail_case(in_file),
        other => exit::fail(other, exit::BAD_INPUT),
    }
}

fn add_tables(comparison: &Comparison, lines: &mut Lines) {
    if let Some(kinematics) = &comparison.kinematics {
        add_kinematics(kinematics, lines);
    }
    if let Some(gravimetric) = &comparison.gravimetric {
        add_gravimetric(gravimetric, lines);
    }
    if let Some(surface) = &comparison.surface {
        add_surface(surface, lines);
    }
}

fn add_kinematics(kinematics: &KinematicsComparison, lines: &mut Lines) {
    let aligned = match kinematics.align {
        "mean" => "; the mean difference is taken out of the errors",
        _ => "",
    };
    lines.line(format_args!(
        "Kinematics, {} cycle: predicted minus measured{aligned}",
        kinematics.cycle
    ));
    lines.line(format_args!(
        "{:<28}{:>10}{:>10}{:>10}{:>8}{:>10}",
        "", "mean abs", "rms", "largest", "at %", "mean"
    ));
    for column in &kinematics.columns {
        let mean = format!("{:>10.3}", column.mean_difference);
        lines.line(format_args!(
            "{:<28}{}{mean}",
            column.column,
            errors(&column.errors)
        ));
        for phase in &column.phases {
            let (start, end) = (phase.start_percent, phase.end_percent);
            let name = format!("  {} {start}-{end} %", phase.phase);
            let text = phase.errors.as_ref().map(errors);
            lines.line(format_args!(
                "{name:<28}{}",
                text.unwrap_or_else(|| "      not measured".to_owned())
            ));
        }
        if column.compared < column.instants {
            let (compared, all) = (column.compared, column.instants);
            lines.line(format_args!("  measured at {compared} of {all} instants"));
        }
    }
    lines.line("");
}

fn errors(errors: &Errors) -> String {
    let Errors {
        mean_absolute,
        rms,
        largest,
        largest_at_percent,
    } = errors;
    format!("{mean_absolute:>10.3}{rms:>10.3}{largest:>10.3}{largest_at_percent:>8.1}")
}

fn add_gravimetric(gravimetric: &GravimetricComparison, lines: &mut Lines) {
    lines.line(format_args!(
        "Wear by weighing, {}",
        soak(gravimetric.soak_controls)
    ));
    lines.line(format_args!(
        "{:<28}{:>12}  {:>19}{:>10}",
        "",
        "mg/10^6",
        format!("{} % interval", gravimetric.confidence_percent),
        "R2"
    ));
    let all = gravimetric.specimens.iter();
    all.chain([
        &gravimetric.all,
        &gravimetric.mean_of_specimens,
        &gravimetric.predicted,
    ])
    .for_each(|rate| add_rate(rate, lines));
    lines.line(format_args!(
        "predicted is {:+.1} % of the measured rate, the line through all weighings",
        gravimetric.predicted_above_measured_percent
    ));
    let range = &gravimetric.range_of_specimens_mg_per_million_cycles;
    lines.line(format_args!(
        "the prediction is {} the range of the specimens, {}",
        inside(gravimetric.inside_range_of_specimens),
        interval(range)
    ));
    lines.line(format_args!(
        "  {} the interval of the line through all weighings",
        inside(gravimetric.inside_interval_of_weighings)
    ));
    if let Some(is_inside) = gravimetric.inside_interval_of_specimens {
        lines.line(format_args!(
            "  {} the interval of the mean of the specimens",
            inside(is_inside)
        ));
    }
    let after = gravimetric.weighings.iter();
    let missed = after.filter(|weighing| weighing.in_line && weighing.predicted_loss_mg.is_none());
    match missed.count() {
        0 => {}
        count => lines.line(format_args!(
            "note: the run ends before {count} of the weighings, which the prediction's line leaves out"
        )),
    }
    lines.line("");
}

fn soak(controls: usize) -> String {
    match controls {
        0 => "not corrected: there is no soak control".to_owned(),
        1 => "corrected by one soak control".to_owned(),
        count => format!("corrected by the mean of {count} soak controls"),
    }
}

fn add_rate(rate: &Rate, lines: &mut Lines) {
    let ends = rate.interval_mg_per_million_cycles;
    let ends = ends.as_ref().map_or_else(|| "-".to_owned(), interval);
    let r_squared = rate
        .r_squared
        .map_or_else(String::new, |r| format!("{r:.4}"));
    let (name, value) = (&rate.name, rate.mg_per_million_cycles);
    lines.line(format_args!(
        "{name:<28}{value:>12.3}  {ends:>19}{r_squared:>10}"
    ));
}

fn interval(interval: &Interval) -> String {
    format!("{:.3} to {:.3}", interval.low, interval.high)
}

fn inside(is_inside: bool) -> &'static str {
    if is_inside { "inside" } else { "OUTSIDE" }
}

fn add_surface(surface: &SurfaceComparison, lines: &mut Lines) {
    let registration = &surface.registration;
    lines.line("Worn surface: scanned minus predicted depth, mm");
    lines.line(format_args!(
        "  laid on with a turn of {:.3} deg and a shift of {:.3} mm; {} points fitted, {:.4} mm rms left, uncertain by {:.4} mm",
        registration.angle_deg,
        registration.shift_mm,
        registration.points,
        registration.residual_rms_mm,
        registration.weakest_standard_error_mm,
    ));
    lines.line(format_args!(
        "{:<28}{:>10}{:>10}{:>10}{:>12}",
        "", "mean", "mean abs", "rms", "area mm2"
    ));
    add_errors("everywhere", &surface.everywhere, lines);
    if let Some(scars) = &surface.in_scars {
        add_errors("in the scars", scars, lines);
    }
    add_place("worst difference", &surface.worst, lines);
    add_place("deepest predicted", &surface.deepest_predicted, lines);
    add_place("deepest scanned", &surface.deepest_scanned, lines);
    lines.line(format_args!(
        "volume over the area scanned: {:.2} mm3 scanned, {:.2} mm3 predicted",
        surface.scanned_volume_mm3, surface.predicted_volume_mm3
    ));
    for note in &surface.notes {
        lines.line(format_args!("note: {note}"));
    }
    lines.line("");
}

fn add_errors(name: &str, errors: &SurfaceErrors, lines: &mut Lines) {
    let SurfaceErrors {
        mean_mm,
        mean_absolute_mm,
        rms_mm,
        area_mm2,
    } = errors;
    lines.line(format_args!(
        "{name:<28}{mean_mm:>10.4}{mean_absolute_mm:>10.4}{rms_mm:>10.4}{area_mm2:>12.0}"
    ));
}

fn add_place(name: &str, place: &NodeDepths, lines: &mut Lines) {
    let NodeDepths {
        x_mm,
        z_mm,
        predicted_mm,
        scanned_mm,
        difference_mm,
        ..
    } = place;
    lines.line(format_args!(
        "{name:<28}{difference_mm:>+10.4} at x {x_mm:.1}, z {z_mm:.1} (scanned {scanned_mm:.4}, predicted {predicted_mm:.4})"
    ));
}
