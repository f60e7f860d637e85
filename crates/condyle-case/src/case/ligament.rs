//! Ligaments between the bodies.

use condyle::Vec3;
use condyle::machine;
use condyle_results::point_on_side;

use super::frame::Side;
use crate::config::*;

settings! {
    /// A ligament: a straight line that carries tension only, with a toe region. It does not act while the machine settles.
    Ligament [check] {
        /// Its name in messages and results: small letters, digits and hyphens.
        name: String;
        /// Attachment to the bearing, [x, y, z] in the insert frame; z points to the right on both sides, and for a hip or ankle to the left.
        on_bearing_mm: [f64; 3], in within(-300.0, 300.0);
        /// Attachment to the counterface, [x, y, z] in its own frame, with the same z.
        on_counterface_mm: [f64; 3], in within(-300.0, 300.0);
        /// Tension per strain beyond the toe region.
        stiffness_n: f64, in within(0.0, 1e6);
        /// Half of the strain at the end of the toe region.
        toe_strain: f64 = 0.03, in within(1e-4, 0.3);
        /// Length without force.
        slack_length_mm: Option<f64> = None, in within(0.1, 500.0);
        /// In place of `slack_length_mm`: strain with all joints of the machine at zero, though the cycle may start at another flexion; negative if slack there.
        strain_at_zero: Option<f64> = None, in within(-0.5, 0.3);
    }
}

/// Names whose columns `kinematics.csv` has without ligaments.
const NAMES_OF_LOADS: [&str; 3] = ["axial-force", "medial-force", "lateral-force"];

impl Ligament {
    fn check(&self, section: &Section<'_>, log: &mut Log<'_>) {
        let name = &self.name;
        if !is_name(name) || NAMES_OF_LOADS.contains(&name.as_str()) {
            let message = format!("a ligament cannot be called \"{name}\"");
            let advice =
                "use small letters, digits and hyphens, and no name of a load of the joint";
            log.problem(section.value_span("name"), Fault::new(message, advice));
        }
        if self.slack_length_mm.is_some() == self.strain_at_zero.is_some() {
            let message = format!(
                "the ligament \"{}\" needs one of `slack_length_mm` and `strain_at_zero`",
                self.name
            );
            log.problem(section.span(), Fault::new(message, ""));
        }
    }

    /// Returns the ligament of a right joint.
    pub(super) fn build(&self, side: Side) -> machine::Ligament {
        let on_the_right = |place: [f64; 3]| point_on_side(&Vec3::from(place), side);
        machine::Ligament {
            name: self.name.clone(),
            on_bearing_mm: on_the_right(self.on_bearing_mm),
            on_counterface_mm: on_the_right(self.on_counterface_mm),
            stiffness_n: self.stiffness_n,
            toe_strain: self.toe_strain,
            slack: match (self.slack_length_mm, self.strain_at_zero) {
                (Some(length_mm), _) => machine::SlackLength::Mm(length_mm),
                (None, strain) => machine::SlackLength::StrainAtZero(strain.unwrap_or_default()),
            },
        }
    }
}
