//! A whole case built into a wear test.

use std::sync::Arc;

use condyle::Vec3;
use condyle::contact::{
    ContactLaw, Deformable, Foundation, FrictionModel, PressureLaw, confined_modulus,
    shell_modulus, softening_modulus,
};
use condyle::evolve::{Activity, Schedule, Updates, WearTest};
use condyle::geometry::Insert;
use condyle::machine::{Drive, Integration, TestedJoint, TimeSettings, knee::FLEXION};
use condyle_fem::ElasticPlastic;

use super::error::{BuildError, BuildWarning};
use super::machine::start_flexion_rad;
use super::shared::SharedBodies;
use crate::cache::{Keep, KeepNothing};
use crate::case::contact::{DeformableContact, PlasticityChoice, PressureLawChoice};
use crate::case::contents::Case;
use crate::case::femur::FemurShape;
use crate::case::insert::InsertShape;
use crate::case::run_options::{IntegratorWord, Update};

/// Largest flexion of the generic femur, degrees: from about 137 on, its surface behind the posterior arc, which no real femur has,
/// reaches the posterior lip of an insert.
const MAX_FLEXION_OF_GENERIC_DEG: f64 = 135.0;
/// Smallest flat part of a backside that can rest on a flat tray.
const MIN_FLAT_PART: f64 = 0.5;

/// A wear test ready to run, and the remarks of its construction.
pub struct Built {
    /// The test, always of a right knee: a left one is mirrored, and its results must be mirrored back.
    pub test: WearTest,
    /// Repairs and other remarks, to be shown to the user.
    pub warnings: Vec<BuildWarning>,
    /// The place that the machine's axes pass through, in words, where it depends on a ball or socket of a mesh.
    pub axes: Option<String>,
}

impl Case {
    /// Reads the meshes and makes bodies, machine and laws; `threads` share the work on a mesh.
    ///
    /// # Errors
    /// A mesh that cannot be read or does not form a shell, an open insert without a thickness, a surface that is not
    /// in its file, or an insert that cannot be meshed.
    pub fn build(&self, threads: usize) -> Result<Built, BuildError> {
        self.build_sharing(threads, &KeepNothing, &SharedBodies::default())
    }

    /// As [`Case::build`], to the same bytes, with the bodies that it has in common with others, the preparation of a mesh
    /// femur kept for the next time, and the kept compliance of a deformable insert ([`Case::keep_compliance`]).
    pub fn build_sharing(
        &self,
        threads: usize,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Built, BuildError> {
        let (insert, of_insert) = bodies
            .inserts
            .found_or_made(self.insert_inputs(), |warnings| {
                self.built_insert(&self.insert, warnings)
            })?;
        let activities = self.built_activities(insert.dish_low_point_mm());
        let flexion_rad = self.checked_start_flexion_rad(&activities)?;
        let (_, side, limits) = self.insert_inputs();
        let joint = activities[0].machine.mechanism.tests;
        let inputs = (self.femur.clone(), side, limits, (joint, flexion_rad));
        let (femur, of_femur) = bodies.femurs.found_or_made(inputs, |warnings| {
            self.built_femur(joint, flexion_rad, threads, keep, warnings)
        })?;
        self.check_head(&insert, femur.ball_radius_mm)?;
        let as_linked = |law| self.material.cross_linking.under(law);
        let comparison_laws = self.wear.comparison_laws().into_iter().map(as_linked);
        let is_round = self.insert.shape.is_round();
        let test = WearTest {
            contact: self.contact_law(&insert, keep, bodies)?,
            counterface: Arc::clone(&femur.surface),
            flexion_axis_mm: femur.flexion_axis_mm,
            // Wherever the file has it, the axis of a mesh starts in the centre of a round bearing.
            start_mm: match &self.femur.shape {
                FemurShape::Mesh(mesh) if is_round && mesh.start_mm.is_none() => (0.0, 0.0),
                _ => femur.start_mm,
            },
            start_height_mm: is_round.then_some(0.0),
            insert: match joint {
                TestedJoint::Knee => insert,
                _ => Arc::new(Insert::clone(&insert).with_one_region(joint.bodies()[1])),
            },
            activities,
            wear: as_linked(self.wear.law()).law,
            comparison_laws: comparison_laws.collect(),
            law_family: true,
            creep: self.creep.law(),
            density_mg_per_mm3: self.material.density_mg_per_mm3,
            time: self.time_settings(),
            schedule: Schedule {
                cycles: self.march.cycles as f64,
                updates: match &self.march.update {
                    Update::Fixed(fixed) => Updates::Fixed(fixed.updates as usize),
                    Update::Auto(auto) => Updates::Auto {
                        tolerance: auto.depth_tolerance_fraction,
                    },
                },
            },
        };
        Ok(Built {
            test,
            warnings: [self.origin.notes.clone(), of_insert, of_femur].concat(),
            axes: femur.axes.clone(),
        })
    }

    /// Returns the law of contact of this case with an insert, or an error for a deformable insert that cannot be modelled
    /// as an elastic solid.
    pub(in crate::case) fn contact_law(
        &self,
        insert: &Insert,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Arc<dyn ContactLaw>, BuildError> {
        let Some(model) = self.contact.deformable() else {
            return Ok(Arc::new(self.foundation(insert)));
        };
        let is_explicit = self.time.integrator == IntegratorWord::Explicit;
        if model.friction_model == FrictionModel::StickSlip && is_explicit {
            let message = "[contact.deformable] friction_model = \"stick-slip\" requires the implicit integrator; take \
                           [time] integrator = \"implicit\", or friction_model = \"regularised\"";
            return Err(BuildError::conflict("time", &["integrator"], message));
        }
        self.check_backside(model, insert)?;
        let (elastic, settings) = (self.material.elastic(), self.contact.settings);
        let (friction, slip) = (settings.friction, settings.slip_tolerance_mm_per_s);
        let backside = model.backside.backside();
        let inputs = (self.insert_inputs(), elastic);
        let (shared, _) = bodies.elastic.found_or_made(inputs, |_| {
            Deformable::new(elastic, friction, slip, backside, insert)
        })?;
        let mut law = Deformable::clone(&shared);
        // The shared law has the compliance, which depends on insert and elasticity alone; all else is that of this case.
        law.settings = settings;
        law.friction_model = model.friction_model;
        let law = match model.plasticity.hardening() {
            Some(hardening) => law.with_material(ElasticPlastic { elastic, hardening }),
            None => law,
        };
        let law = law.with_backside(backside, insert)?;
        self.load_compliance(&law, insert, keep)?;
        Ok(Arc::new(law))
    }

    /// Returns the flexion in which the counterface settles. Rejects flexion in which the back of the insert would reach the end of the
    /// generic femur.
    fn checked_start_flexion_rad(&self, activities: &[Activity]) -> Result<f64, BuildError> {
        let is_generic = matches!(self.femur.shape, FemurShape::Generic(_));
        let flexion = |activity: &Activity| match &activity.machine.joint(FLEXION).drive {
            Drive::Prescribed(waveform) => waveform.range()[1].to_degrees(),
            _ => 0.0,
        };
        let most = activities.iter().map(flexion).fold(0.0, f64::max);
        if !is_generic || !self.tests_knee() || most <= MAX_FLEXION_OF_GENERIC_DEG {
            return Ok(start_flexion_rad(&activities[0].machine));
        }
        let message = format!(
            "[femur] shape = \"generic\" has no articulating surface beyond {MAX_FLEXION_OF_GENERIC_DEG} degrees of flexion, and flexion reaches {most:.0} degrees; \
             take a femur from a file, or less flexion"
        );
        Err(BuildError::conflict("femur", &["shape"], message))
    }

    /// Rejects a head that does not fit into its cup, where one of them is from a file.
    fn check_head(&self, cup: &Insert, head_mm: Option<f64>) -> Result<(), BuildError> {
        let is_cup = matches!(
            self.insert.shape,
            InsertShape::Cup(_) | InsertShape::CupMesh(_)
        );
        let file = self.insert.file().or_else(|| self.femur.file());
        let (true, Some(head_mm), Some(file)) = (is_cup, head_mm, file) else {
            return Ok(());
        };
        let cup_mm = shell_mm(cup).0;
        if head_mm < cup_mm {
            return Ok(());
        }
        let message = format!(
            "the cup of radius {cup_mm:.3} mm is not larger than its head of {head_mm:.3} mm; check length_unit and the files"
        );
        let keys = &["file", "length_unit"];
        Err(BuildError::mesh(file.path(), keys, message))
    }

    /// Rejects settings that cannot be combined with a resting backside.
    fn check_backside(
        &self,
        contact: &DeformableContact,
        insert: &Insert,
    ) -> Result<(), BuildError> {
        if !contact.backside.is_resting() {
            return Ok(());
        }
        if self.time.integrator == IntegratorWord::Explicit {
            let message = "[contact.deformable] backside = \"resting\" requires the implicit integrator; take [time] \
                           integrator = \"implicit\", or backside = \"bonded\"";
            return Err(BuildError::conflict("time", &["integrator"], message));
        }
        let other = if contact.plasticity != PlasticityChoice::None {
            Some("plasticity = \"j2\"")
        } else if contact.friction_model == FrictionModel::StickSlip {
            Some("friction_model = \"stick-slip\"")
        } else {
            None
        };
        let part = Deformable::flat_part_of_backside(insert);
        let message = match other {
            Some(other) => format!(
                "[contact.deformable] backside = \"resting\" cannot be combined with {other}, which is computed with the \
                 compliance of an insert that is bonded to its tray; take one of them alone"
            ),
            None if part < MIN_FLAT_PART => format!(
                "[contact.deformable] backside = \"resting\" needs a flat backside, and {:.0} % of this insert's lies in a \
                 plane; take backside = \"bonded\", or give an insert with a flat backside",
                100.0 * part
            ),
            None => return Ok(()),
        };
        let keys = &["backside"];
        Err(BuildError::conflict("contact.deformable", keys, message))
    }

    /// Returns the elastic foundation of this case under its `insert`.
    pub fn foundation(&self, insert: &Insert) -> Foundation {
        let material = &self.material;
        let (e_mpa, v) = (material.youngs_modulus_mpa, material.poissons_ratio);
        let modulus_mpa = match &self.insert.shape {
            // A curved layer is softer than a flat one of the same thickness.
            InsertShape::Cup(cup) => {
                shell_modulus(e_mpa, v, cup.shape.radius_mm, cup.shape.thickness_mm)
            }
            InsertShape::CupMesh(_) => {
                let (radius_mm, thickness_mm) = shell_mm(insert);
                shell_modulus(e_mpa, v, radius_mm, thickness_mm)
            }
            _ => confined_modulus(e_mpa, v),
        };
        let pressure = match self.contact.law().unwrap_or(&PressureLawChoice::Linear) {
            PressureLawChoice::Linear => PressureLaw::Linear { modulus_mpa },
            PressureLawChoice::Logarithmic => PressureLaw::Logarithmic { modulus_mpa },
            PressureLawChoice::Softening(curve) => PressureLaw::Softening {
                // A shell is as much softer than a flat layer as under the linear law.
                modulus_mpa: modulus_mpa / confined_modulus(e_mpa, v)
                    * softening_modulus(curve.softening_strain, curve.softening_stress_mpa, v),
                softening_stress_mpa: curve.softening_stress_mpa,
            },
            PressureLawChoice::Tabulated(table) => PressureLaw::Tabulated(table.clone()),
            PressureLawChoice::TabulatedStrain(table) => {
                PressureLaw::TabulatedStrain(table.points.clone())
            }
        };
        Foundation {
            pressure,
            settings: self.contact.settings,
        }
    }

    fn time_settings(&self) -> TimeSettings {
        let time = &self.time;
        TimeSettings {
            increments: time.increments as usize,
            increment_error_mm: time.increment_error_mm,
            force_tolerance_n: time.force_tolerance_n,
            repeat_tolerance_mm: time.repeat_tolerance_mm,
            repeat_tolerance_rad: time.repeat_tolerance_deg.to_radians(),
            most_cycles_to_repeat: time.most_cycles_to_repeat as usize,
            integration: match time.integrator {
                IntegratorWord::Implicit => Integration::Implicit,
                IntegratorWord::Explicit => Integration::Explicit {
                    least_step_s: time.explicit_step_s,
                },
            },
            ..TimeSettings::default()
        }
    }
}

/// Returns the median radius and thickness of a cup around the origin: its rim does not count.
fn shell_mm(cup: &Insert) -> (f64, f64) {
    let median = |mut values: Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let radii_mm = cup.surface().positions.iter().map(Vec3::norm).collect();
    (median(radii_mm), median(cup.thickness_mm().to_vec()))
}
