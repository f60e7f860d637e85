//! A whole case made into a wear test.

use std::sync::Arc;

use condyle::contact::{ContactLaw, Deformable, Foundation, PressureLaw, confined_modulus};
use condyle::evolve::{Activity, Schedule, Updates, WearTest};
use condyle::geometry::Insert;
use condyle::machine::{Integration, TimeSettings};

use super::super::contact::{ContactModelWord, FrictionModelWord, PressureLawChoice};
use super::super::contents::Case;
use super::super::contents::LeftOutConstant;
use super::super::deformable::PlasticityChoice;
use super::super::schedule::IntegratorWord;
use super::super::schedule::Update;
use super::error::{BuildError, BuildWarning};
use super::femur::{BuiltFemur, Preparing};
use super::machine::start_flexion_rad;
use super::shared::SharedBodies;
use crate::cache::{Keep, KeepNothing};

/// Less of a backside than this lies in a plane: it does not rest on a flat tray.
const MIN_FLAT_PART: f64 = 0.5;

/// A wear test ready to run, and what was put right on the way to it.
pub struct Built {
    /// The test, of a right knee: a left one is mirrored, and its results are to be mirrored back.
    pub test: WearTest,
    /// What was put right, for the user to know.
    pub warnings: Vec<BuildWarning>,
}

impl Case {
    /// Reads the meshes and makes bodies, machine and laws; `threads` share the work on a mesh.
    ///
    /// # Errors
    /// A mesh that cannot be read or is no shell, an open insert without a thickness, a surface
    /// that is not in its file, or an insert that cannot be meshed.
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
            let (placement, side) = (&self.femur_placement, self.heading.side);
            self.femur
                .build(placement, side, flexion_rad, preparing, warnings)
        })?;
        let warnings = [self.constants_left_out(), of_insert, of_femur].concat();
        let test = self.assembled(insert, &femur, activities, (keep, bodies))?;
        Ok(Built { test, warnings })
    }

    /// A wear test of bodies and activities.
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
            comparison_laws: self.wear.beside().into_iter().map(as_linked).collect(),
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

    /// Constants of the file that its wear law, chosen from outside, does not have.
    fn constants_left_out(&self) -> Vec<BuildWarning> {
        let left_out = self.origin.left_out.iter().cloned();
        let warning =
            |LeftOutConstant { written, law }| BuildWarning::ConstantLeftOut { written, law };
        left_out.map(warning).collect()
    }

    /// The law of contact of this case with its insert.
    ///
    /// # Errors
    /// An insert that is no elastic solid, where it is to be one.
    pub fn contact_law(&self, insert: &Insert) -> Result<Arc<dyn ContactLaw>, BuildError> {
        self.contact_law_sharing(insert, &KeepNothing, &SharedBodies::default())
    }

    fn contact_law_sharing(
        &self,
        insert: &Insert,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Arc<dyn ContactLaw>, BuildError> {
        Ok(match self.contact.model {
            ContactModelWord::Foundation => Arc::new(self.foundation()),
            ContactModelWord::Deformable => Arc::new(self.deformable(insert, keep, bodies)?),
        })
    }

    /// The insert of this case as an elastic body.
    fn deformable(
        &self,
        insert: &Insert,
        keep: &dyn Keep,
        bodies: &SharedBodies,
    ) -> Result<Deformable, BuildError> {
        if self.contact.friction_model == FrictionModelWord::StickSlip
            && self.time.integrator == IntegratorWord::Explicit
        {
            return Err(BuildError::StickSlipExplicit);
        }
        self.check_backside(insert)?;
        let elastic = self.material.elastic();
        let friction = &self.contact.friction;
        let (coefficient, slip) = (friction.friction, friction.slip_tolerance_mm_per_s);
        let backside = self.contact.backside.backside();
        let mut law = bodies.elastic(self, elastic, || {
            Deformable::new(elastic, coefficient, slip, backside, insert)
        })?;
        (law.friction, law.slip_tolerance_mm_per_s) = (coefficient, slip);
        law.search = self.contact.finding.search.search();
        law.sample_reuse_mm = self.contact.finding.sample_reuse_mm;
        law.friction_model = self.contact.friction_model.model();
        let law = self.contact.plasticity.with_material(law, elastic);
        let law = law.with_backside(backside, insert)?;
        self.tell_compliance(&law, insert, keep)?;
        Ok(law)
    }

    /// Refuses what a backside that rests does not go with.
    fn check_backside(&self, insert: &Insert) -> Result<(), BuildError> {
        let contact = &self.contact;
        let beside = |beside| Err(BuildError::RestingBeside { beside });
        if !contact.backside.is_resting() {
            Ok(())
        } else if self.time.integrator == IntegratorWord::Explicit {
            Err(BuildError::RestingExplicit)
        } else if contact.plasticity != PlasticityChoice::None {
            beside("plasticity = \"j2\"")
        } else if contact.friction_model == FrictionModelWord::StickSlip {
            beside("friction_model = \"stick-slip\"")
        } else {
            let part = Deformable::flat_part_of_backside(insert);
            if part < MIN_FLAT_PART {
                let percent = 100.0 * part;
                return Err(BuildError::BacksideNotFlat { percent });
            }
            Ok(())
        }
    }

    /// The elastic foundation of this case.
    pub fn foundation(&self) -> Foundation {
        let material = &self.material;
        let modulus_mpa = confined_modulus(material.youngs_modulus_mpa, material.poissons_ratio);
        let friction = &self.contact.friction;
        let pressure = match &self.contact.law {
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
            friction: friction.friction,
            slip_tolerance_mm_per_s: friction.slip_tolerance_mm_per_s,
            search: self.contact.finding.search.search(),
            sample_reuse_mm: self.contact.finding.sample_reuse_mm,
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
