//! `condyle compare`.

use condyle_lab::measured::{
    Errors, GravimetricComparison, Interval, KinematicsComparison, NodeDepths, SurfaceComparison,
    SurfaceErrors, compare as compare_measured,
};
use condyle_results::COMPARED;

use crate::{
    arguments::Compare,
    output::{self, Done, Lines},
    report::note_unfinished,
};

pub fn compare(arguments: &Compare) -> Done {
    let results = &arguments.results;
    let comparison = compare_measured(results, &arguments.measured)?;
    note_unfinished(results);
    let default = results.join(COMPARED.folder);
    let out = arguments.out.as_ref().unwrap_or(&default);
    let mut written = Vec::new();
    for (name, ending, text) in comparison.files() {
        let path = out.join(format!("{name}.{ending}"));
        output::write_into(&path, text.as_bytes(), arguments.force || *out == default)?;
        written.push(path);
    }
    if *out == default {
        // The report shows the comparison that it finds in this folder.
        written.push(condyle_report::write_readable_report(results)?.0);
    }
    if arguments.json {
        return output::print_with_folder(&comparison.json(), out);
    }
    let mut lines = Lines::default();
    if let Some(kinematics) = &comparison.kinematics {
        add_kinematics(kinematics, &mut lines);
    }
    if let Some(gravimetric) = &comparison.gravimetric {
        add_gravimetric(gravimetric, &mut lines);
    }
    if let Some(surface) = &comparison.surface {
        add_surface(surface, &mut lines);
    }
    lines.notes(&comparison.remarks);
    let files = written.iter().map(|path| path.display().to_string());
    lines.line(format!("wrote {}", files.collect::<Vec<_>>().join(", ")));
    output::print_with_folder(lines.text(), out)
}

fn add_kinematics(kinematics: &KinematicsComparison, lines: &mut Lines) {
    let aligned = match kinematics.align {
        "mean" => "; the mean difference is subtracted from the errors",
        _ => "",
    };
    lines.line(format!(
        "Kinematics, {} cycle: predicted minus measured{aligned}",
        kinematics.cycle
    ));
    lines.line("                              mean abs       rms   largest    at %      mean");
    for column in &kinematics.columns {
        let mean = format!("{:>10.3}", column.mean_difference);
        lines.line(format!(
            "{:<28}{}{mean}",
            column.column,
            errors(&column.errors)
        ));
        for phase in &column.phases {
            let (start, end) = (phase.start_percent, phase.end_percent);
            let name = format!("  {} {start}-{end} %", phase.phase);
            let text = phase.errors.as_ref().map(errors);
            lines.line(format!(
                "{name:<28}{}",
                text.unwrap_or_else(|| "      not measured".to_owned())
            ));
        }
        if column.compared < column.instants {
            let (compared, all) = (column.compared, column.instants);
            lines.line(format!("  measured at {compared} of {all} instants"));
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
    lines.line(format!(
        "Wear by weighing, {}",
        soak(gravimetric.soak_controls)
    ));
    let interval_head = format!("{} % interval", gravimetric.confidence_percent);
    lines.line(format!(
        "{:>40}  {interval_head:>19}{:>10}",
        "mg/10^6", "R2"
    ));
    let means = [
        &gravimetric.all,
        &gravimetric.mean_of_specimens,
        &gravimetric.predicted,
    ];
    for rate in gravimetric.specimens.iter().chain(means) {
        let ends = rate.interval_mg_per_million_cycles;
        let ends = ends.as_ref().map_or_else(|| "-".to_owned(), interval);
        let r_squared = rate.r_squared.map(|r| format!("{r:.4}"));
        let (name, value, r2) = (
            &rate.name,
            rate.mg_per_million_cycles,
            r_squared.unwrap_or_default(),
        );
        lines.line(format!("{name:<28}{value:>12.3}  {ends:>19}{r2:>10}"));
    }
    lines.line(format!(
        "predicted is {:.1} % of the measured rate, the line through all weighings",
        100.0 + gravimetric.predicted_above_measured_percent
    ));
    let range = &gravimetric.range_of_specimens_mg_per_million_cycles;
    lines.line(format!(
        "the prediction is {} the range of the specimens, {}",
        inside(gravimetric.inside_range_of_specimens),
        interval(range)
    ));
    lines.line(format!(
        "  {} the interval of the line through all weighings",
        inside(gravimetric.inside_interval_of_weighings)
    ));
    if let Some(is_inside) = gravimetric.inside_interval_of_specimens {
        lines.line(format!(
            "  {} the interval of the mean of the specimens",
            inside(is_inside)
        ));
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

fn interval(interval: &Interval) -> String {
    format!("{:.3} to {:.3}", interval.low, interval.high)
}

fn inside(is_inside: bool) -> &'static str {
    if is_inside { "inside" } else { "OUTSIDE" }
}

fn add_surface(surface: &SurfaceComparison, lines: &mut Lines) {
    let registration = &surface.registration;
    lines.line("Worn surface: scanned minus predicted depth, mm");
    lines.line(match registration.steps {
        0 => "  not registered: the scan lies as given".to_owned(),
        _ => format!("  registered by a rotation of {:.3} deg and a shift of {:.3} mm; {} points fitted, {:.4} mm rms remaining, standard error {:.4} mm",
            registration.angle_deg,
            registration.shift_mm,
            registration.points,
            registration.residual_rms_mm,
            registration.weakest_standard_error_mm),
    });
    lines.line("                                  mean  mean abs       rms    area mm2");
    add_errors("everywhere", &surface.everywhere, lines);
    if let Some(scars) = &surface.in_scars {
        add_errors("in the scars", scars, lines);
    }
    add_place("worst difference", &surface.worst, lines);
    add_place("deepest predicted", &surface.deepest_predicted, lines);
    add_place("deepest scanned", &surface.deepest_scanned, lines);
    let error_mm3 = surface.scanned_volume_standard_error_mm3;
    let error = error_mm3.map_or_else(String::new, |error_mm3| format!(" +/- {error_mm3:.2}"));
    lines.line(format!(
        "volume over the area scanned: {:.2}{error} mm3 scanned, {:.2} mm3 predicted",
        surface.scanned_volume_mm3, surface.predicted_volume_mm3
    ));
    if error_mm3.is_some() {
        lines.line("  +/-: standard error of the position times the area");
    }
    lines.line(format!(
        "  {} of {} points lie off those around them and are left out",
        surface.outliers, surface.scan_points
    ));
    lines.notes(&surface.notes);
    lines.line("");
}

fn add_errors(name: &str, errors: &SurfaceErrors, lines: &mut Lines) {
    let SurfaceErrors {
        mean_mm,
        mean_absolute_mm,
        rms_mm,
        area_mm2,
    } = errors;
    lines.line(format!(
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
    lines.line(format!("{name:<28}{difference_mm:>+10.4} at x {x_mm:.1}, z {z_mm:.1} (scanned {scanned_mm:.4}, predicted {predicted_mm:.4})"));
}
