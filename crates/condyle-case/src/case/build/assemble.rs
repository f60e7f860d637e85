//! A whole case built into a wear test.

use std::sync::Arc;

use condyle::contact::{
    ContactLaw, Deformable, Foundation, FrictionModel, PressureLaw, confined_modulus,
};
use condyle::evolve::{Activity, Schedule, Updates, WearTest};
use condyle::geometry::Insert;
use condyle::machine::{Integration, TimeSettings};

use super::super::contact::{
    ContactModelChoice, DeformableContact, PlasticityChoice, PressureLawChoice,
};
use super::super::contents::{Case, CaseNote};
use super::super::schedule::{IntegratorWord, Update};
use super::error::{BuildError, BuildWarning};
use super::femur::{BuiltFemur, Preparing};
use super::machine::start_flexion_rad;
use super::shared::SharedBodies;
use crate::cache::{Keep, KeepNothing};

/// Smallest flat part of a backside that can rest on a flat tray.
const MIN_FLAT_PART: f64 = 0.5;

const STICK_SLIP_EXPLICIT: &str = "[contact.deformable] friction_model = \"stick-slip\" goes from one solved increment to the \
     next, and [time] integrator = \"explicit\" solves none; take integrator = \"implicit\", or friction_model = \"regularised\"";
const RESTING_EXPLICIT: &str = "[contact.deformable] backside = \"resting\" goes from one solved increment to the next, and \
     [time] integrator = \"explicit\" solves none; take integrator = \"implicit\", or backside = \"bonded\"";

/// A wear test ready to run, and the remarks of its construction.
pub struct Built {
    /// The test, always of a right knee: a left one is mirrored, and its results must be mirrored back.
    pub test: WearTest,
    /// Repairs and other remarks, to be shown to the user.
    pub warnings: Vec<BuildWarning>,
}

impl Case {
    /// Reads the meshes and makes bodies, machine and laws; `threads` share the work on a mesh.
    ///
    /// # Errors
    /// A mesh that cannot be read or does not form a shell, an open insert without a thickness, a surface that is not
    /// in its file, or an insert that cannot be meshed.
    pub fn build(&self, threads: usize) -> Result<Built, BuildError> {
        self.build_kept(threads, &KeepNothing)
    }

    /// As [`Case::build`], to the same bytes, with the preparation of a mesh femur kept for the
    /// next time, and the compliance of a deformable insert found that was kept ([`Case::keep_compliance`]).
    ///
    /// # Errors
    /// As [`Case::build`].
    pub fn build_kept(&self, threads: usize, keep: &dyn Keep) -> Result<Built, BuildError> {
        self.build_sharing(threads, keep, &SharedBodies::default())
    }

    /// As [`Case::build_kept`], to the same bytes, with the bodies that it has in common with others.
    ///
    /// # Errors
    /// As [`Case::build`].
    pub fn build_sharing(
        &self,
        threads: usize,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Built, BuildError> {
        let make = |warnings: &mut _| self.built_insert(&self.insert, warnings);
        let (insert, of_insert) = bodies.insert(self, make)?;
        let activities = self.built_activities(insert.dish_low_point_mm());
        let flexion_rad = start_flexion_rad(&activities[0].machine);
        let (femur, of_femur) = bodies.femur(self, flexion_rad, |warnings| {
            let limits = &self.limits;
            let preparing = Preparing {
                threads,
                keep,
                limits,
            };
            let side = self.heading.side;
            self.femur.build(side, flexion_rad, preparing, warnings)
        })?;
        let notes = self.origin.notes.iter().map(|note| match note.clone() {
            CaseNote::LeftOut { written, chosen } => BuildWarning::LeftOutKey { written, chosen },
            CaseNote::Renamed { old, new } => BuildWarning::RenamedKey { old, new },
        });
        let warnings = [notes.collect(), of_insert, of_femur].concat();
        let test = self.assembled(insert, &femur, activities, (keep, bodies))?;
        Ok(Built { test, warnings })
    }

    fn assembled(
        &self,
        insert: Arc<Insert>,
        femur: &BuiltFemur,
        activities: Vec<Activity>,
        (keep, bodies): (&dyn Keep, &SharedBodies),
    ) -> Result<WearTest, BuildError> {
        let as_linked = |law| self.material.cross_linking.under(law);
        Ok(WearTest {
            contact: self.contact_law_sharing(&insert, keep, bodies)?,
            femur: Arc::clone(&femur.surface),
            flexion_axis_mm: femur.flexion_axis_mm,
            start_mm: femur.start_mm,
            insert,
            activities,
            wear: as_linked(self.wear.law()).law,
            comparison_laws: self
                .wear
                .comparison_laws()
                .into_iter()
                .map(as_linked)
                .collect(),
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
        })
    }

    /// Returns the law of contact of this case with its insert.
    ///
    /// # Errors
    /// A deformable insert that cannot be modelled as an elastic solid.
    pub fn contact_law(&self, insert: &Insert) -> Result<Arc<dyn ContactLaw>, BuildError> {
        self.contact_law_sharing(insert, &KeepNothing, &SharedBodies::default())
    }

    fn contact_law_sharing(
        &self,
        insert: &Insert,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Arc<dyn ContactLaw>, BuildError> {
        Ok(match &self.contact.model {
            ContactModelChoice::Foundation(_) => Arc::new(self.foundation()),
            ContactModelChoice::Deformable(model) => {
                Arc::new(self.deformable(model, insert, keep, bodies)?)
            }
        })
    }

    fn deformable(
        &self,
        model: &DeformableContact,
        insert: &Insert,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Deformable, BuildError> {
        if model.friction_model == FrictionModel::StickSlip
            && self.time.integrator == IntegratorWord::Explicit
        {
            return Err(BuildError::Conflict {
                table: "time",
                keys: &["integrator"],
                message: STICK_SLIP_EXPLICIT.to_owned(),
            });
        }
        self.check_backside(model, insert)?;
        let elastic = self.material.elastic();
        let contact = &self.contact;
        let (coefficient, slip) = (contact.friction, contact.slip_tolerance_mm_per_s);
        let backside = model.backside.backside();
        let mut law = bodies.elastic(self, elastic, || {
            Deformable::new(elastic, coefficient, slip, backside, insert)
        })?;
        (law.friction, law.slip_tolerance_mm_per_s) = (coefficient, slip);
        law.search = contact.search;
        law.sample_reuse_mm = contact.sample_reuse_mm;
        law.friction_model = model.friction_model;
        let law = model.plasticity.with_material(law, elastic);
        let law = law.with_backside(backside, insert)?;
        self.tell_compliance(&law, insert, keep)?;
        Ok(law)
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
            return Err(BuildError::Conflict {
                table: "time",
                keys: &["integrator"],
                message: RESTING_EXPLICIT.to_owned(),
            });
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
                "[contact.deformable] backside = \"resting\" does not go with {other}: what that is computed from belongs to \
                 an insert that is bonded to its tray; take one of them alone"
            ),
            None if part < MIN_FLAT_PART => format!(
                "[contact.deformable] backside = \"resting\" needs a flat backside, and {:.0} % of this insert's lies in a \
                 plane; take backside = \"bonded\", or give an insert with a flat backside",
                100.0 * part
            ),
            None => return Ok(()),
        };
        Err(BuildError::Conflict {
            table: "contact.deformable",
            keys: &["backside"],
            message,
        })
    }

    /// Returns the elastic foundation of this case.
    pub fn foundation(&self) -> Foundation {
        let material = &self.material;
        let modulus_mpa = confined_modulus(material.youngs_modulus_mpa, material.poissons_ratio);
        let contact = &self.contact;
        let pressure = match contact.law().unwrap_or(&PressureLawChoice::Linear) {
            PressureLawChoice::Linear => PressureLaw::Linear { modulus_mpa },
            PressureLawChoice::Logarithmic => PressureLaw::Logarithmic { modulus_mpa },
            PressureLawChoice::Softening(curve) => PressureLaw::Softening {
                modulus_mpa: curve.modulus_mpa(material.poissons_ratio),
                softening_stress_mpa: curve.softening_stress_mpa,
            },
            PressureLawChoice::Tabulated(table) => PressureLaw::Tabulated(table.clone()),
            PressureLawChoice::TabulatedStrain(table) => {
                PressureLaw::TabulatedStrain(table.points.clone())
            }
        };
        Foundation {
            pressure,
            friction: contact.friction,
            slip_tolerance_mm_per_s: contact.slip_tolerance_mm_per_s,
            search: contact.search,
            sample_reuse_mm: contact.sample_reuse_mm,
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
