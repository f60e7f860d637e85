//! What a calibration left, as a page in Markdown.

use super::{
    super::table::aligned, CalibratedIncrement, CalibratedLaw, HeldOut, Left, OffInStance,
};

impl CalibratedLaw {
    /// The page: what is left of a run, increment by increment, on other cases, and the table.
    pub fn markdown(&self) -> String {
        let mut page = String::from("# Calibrated pressure law\n\n");
        page += &format!(
            "With this table the peak pressure of the rigid model is off by {} % at most in stance, in the first cycle and the last.\n\n",
            self.peak_error_percent
        );
        page += "Off the deformable insert, with the law before and with the table; stance has a fifth of the highest axial force and more:\n\n";
        page += &self.table_of_left();
        if !self.held_out.is_empty() {
            page += "\nCases that the table was not fitted to, with their own law and with the table:\n";
            page += &self.held_out.iter().map(of_held_out).collect::<String>();
        }
        page += "\nUnder the forces of the deformable insert, where it was fitted (unworn):\n\n";
        page += &self.table_of_increments();
        page += "\nThe table:\n\n";
        page += &self.table_of_points();
        page
    }

    /// What is left, as a table.
    pub fn table_of_left(&self) -> String {
        of_left(&self.left_before, &self.left)
    }

    fn table_of_increments(&self) -> String {
        let head = [
            "% of cycle",
            "axial force, N",
            "peak, MPa: deformable",
            "table",
            "area, mm2: deformable",
            "table",
            "force at the same approach, N",
            "deeper by, mm",
        ];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(self.increments.iter().map(of_increment));
        aligned(&rows)
    }

    fn table_of_points(&self) -> String {
        let head = ["overclosure over thickness", "pressure, MPa"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let points = self.table.iter();
        rows.extend(points.map(|(d, p)| vec![format!("{d:.6}"), format!("{p:.3}")]));
        aligned(&rows)
    }
}

fn of_increment(increment: &CalibratedIncrement) -> Vec<String> {
    vec![
        format!("{:.1}", increment.percent),
        format!("{:.0}", increment.axial_force_n),
        format!("{:.2}", increment.deformable_peak_mpa),
        format!("{:.2}", increment.peak_mpa),
        format!("{:.1}", increment.deformable_area_mm2),
        format!("{:.1}", increment.area_mm2),
        format!("{:.0}", increment.force_at_same_approach_n),
        format!("{:+.4}", increment.deeper_mm),
    ]
}

fn of_held_out(held_out: &HeldOut) -> String {
    let case = held_out.case.display();
    let table = of_left(&held_out.left_before, &held_out.left);
    format!("\n`{case}`\n\n{table}")
}

fn of_left(before: &Left, after: &Left) -> String {
    let [mut rows, after] = [before, after].map(|left| {
        let [mut said, of_run] = [of_cycles(left), of_run(left)];
        said.extend(of_run);
        said
    });
    for (row, after) in rows.iter_mut().zip(after) {
        row.extend(after.into_iter().skip(1));
    }
    rows.insert(0, ["", "law before", "table"].map(str::to_owned).to_vec());
    aligned(&rows)
}

/// What is left of the first and the last cycle.
fn of_cycles(left: &Left) -> Vec<Vec<String>> {
    let (first, last) = (&left.first_cycle, &left.last_cycle);
    vec![
        row(
            "peak pressure in stance, first cycle",
            in_stance(first.peak_pressure),
        ),
        row("the same, last cycle", in_stance(last.peak_pressure)),
        row(
            "contact area in stance, first cycle",
            in_stance(first.contact_area),
        ),
        row("the same, last cycle", in_stance(last.contact_area)),
        row("AP, first cycle", format!("{:.3} mm", first.ap_mm)),
        row("IE, first cycle", format!("{:.3} degrees", first.ie_deg)),
    ]
}

/// What is left of the whole run.
fn of_run(left: &Left) -> Vec<Vec<String>> {
    let beside = |percent: f64, found: String, wanted: String| {
        format!("{percent:+.2} % ({found}, {wanted} on the deformable insert)")
    };
    let mass = beside(
        left.mass_loss_percent,
        format!("{:.2} mg", left.mass_loss_mg),
        format!("{:.2}", left.deformable_mass_loss_mg),
    );
    let depth = beside(
        left.max_depth_percent,
        format!("{:.4} mm", left.max_depth_mm),
        format!("{:.4}", left.deformable_max_depth_mm),
    );
    let (wall_s, deformable_s) = (left.wall_s, left.deformable_wall_s);
    let time = format!("{wall_s:.2} s ({deformable_s:.2} s on the deformable insert)");
    vec![
        row("mass lost", mass),
        row("deepest wear", depth),
        row("time", time),
    ]
}

fn row(what: &str, said: String) -> Vec<String> {
    vec![what.to_owned(), said]
}

fn in_stance(off: OffInStance) -> String {
    let OffInStance {
        mean_percent,
        most_percent,
        of_highest_percent,
    } = off;
    format!(
        "{mean_percent:.1} % (most {most_percent:.1} %, of the highest {of_highest_percent:+.1} %)"
    )
}
