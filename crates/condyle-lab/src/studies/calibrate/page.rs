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
    let stance = |off: &OffInStance| {
        let OffInStance {
            mean_percent,
            most_percent,
            of_highest_percent,
        } = off;
        format!(
            "{mean_percent:.1} % (most {most_percent:.1} %, of the highest {of_highest_percent:+.1} %)"
        )
    };
    type Said<'a> = (&'a str, Box<dyn Fn(&Left) -> String + 'a>);
    let said: Vec<Said<'_>> = vec![
        (
            "peak pressure in stance, first cycle",
            Box::new(|left| stance(&left.first_cycle.peak_pressure)),
        ),
        (
            "the same, last cycle",
            Box::new(|left| stance(&left.last_cycle.peak_pressure)),
        ),
        (
            "contact area in stance, first cycle",
            Box::new(|left| stance(&left.first_cycle.contact_area)),
        ),
        (
            "the same, last cycle",
            Box::new(|left| stance(&left.last_cycle.contact_area)),
        ),
        (
            "AP, first cycle",
            Box::new(|left| format!("{:.3} mm", left.first_cycle.ap_mm)),
        ),
        (
            "IE, first cycle",
            Box::new(|left| format!("{:.3} degrees", left.first_cycle.ie_deg)),
        ),
        (
            "mass lost",
            Box::new(|left| {
                format!(
                    "{:+.2} % ({:.2} mg, {:.2} on the deformable insert)",
                    left.mass_loss_percent, left.mass_loss_mg, left.deformable_mass_loss_mg
                )
            }),
        ),
        (
            "deepest wear",
            Box::new(|left| {
                format!(
                    "{:+.2} % ({:.4} mm, {:.4} on the deformable insert)",
                    left.max_depth_percent, left.max_depth_mm, left.deformable_max_depth_mm
                )
            }),
        ),
        (
            "time",
            Box::new(|left| {
                format!(
                    "{:.2} s ({:.2} s on the deformable insert)",
                    left.wall_s, left.deformable_wall_s
                )
            }),
        ),
    ];
    let mut rows = vec![["", "law before", "table"].map(str::to_owned).to_vec()];
    rows.extend(
        said.iter()
            .map(|(what, of)| vec![(*what).to_owned(), of(before), of(after)]),
    );
    aligned(&rows)
}
