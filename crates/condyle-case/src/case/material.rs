//! Polyethylene of the insert: elasticity, cross-linking, creep.

use condyle::creep::LeePienkowski;
use condyle::parameter::Parameter;
use condyle::wear::{CrossLinked, NamedLaw};
use condyle_fem::Elastic;

use super::table::{Context, Table, WearLaws, WriteWaveform};
use crate::config::{
    Key, Limits, Log, Page, Section, Settings, TableSchema, Variants, Writer, settings, variants,
    within,
};

settings! {
    /// Elasticity and density.
    Bulk {
        /// Young's modulus.
        youngs_modulus_mpa: f64 = 463.0, in within(1.0, 100_000.0);
        /// Poisson's ratio.
        poissons_ratio: f64 = 0.46, in within(0.0, 0.499);
        /// Density.
        density_mg_per_mm3: f64 = 0.93, in within(0.01, 30.0);
    }
}

/// Polyethylene of the insert.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, MPa.
    pub youngs_modulus_mpa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density.
    pub density_mg_per_mm3: f64,
    /// Whether it was cross-linked.
    pub cross_linking: CrossLinking,
}

impl Material {
    /// The keys that `[material]` has however cross-linked, and the one that says that.
    pub(super) fn keys() -> Vec<Key> {
        [Bulk::keys(), vec![CrossLinking::choices().by]].concat()
    }

    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let cross_linking = CrossLinking::read(section, &Bulk::keys(), log);
        let bulk = Bulk::read(section, log)?;
        Some(Self {
            youngs_modulus_mpa: bulk.youngs_modulus_mpa,
            poissons_ratio: bulk.poissons_ratio,
            density_mg_per_mm3: bulk.density_mg_per_mm3,
            cross_linking: cross_linking?,
        })
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let bulk = Bulk {
            youngs_modulus_mpa: self.youngs_modulus_mpa,
            poissons_ratio: self.poissons_ratio,
            density_mg_per_mm3: self.density_mg_per_mm3,
        };
        bulk.write(out);
        self.cross_linking.write(out);
    }

    /// Its elasticity, MPa.
    pub(crate) fn elastic(&self) -> Elastic {
        Elastic {
            youngs_modulus: self.youngs_modulus_mpa,
            poissons_ratio: self.poissons_ratio,
        }
    }
}

const MODERATE: Parameter = CrossLinked::MODERATE;
const HIGH: Parameter = CrossLinked::HIGH;

const fn limits_of(parameter: &Parameter) -> Limits {
    within(parameter.least, parameter.most)
}

settings! {
    /// Moderately cross-linked polyethylene.
    ModeratelyCrossLinked {
        /// What it wears over what conventional polyethylene would wear by the same law; by default the bound of Abdelgaied 2013, whose pins wore less.
        wear_over_conventional: f64 = MODERATE.default, in limits_of(&MODERATE);
    }

    /// Highly cross-linked polyethylene.
    HighlyCrossLinked {
        /// What it wears over what conventional polyethylene would wear by the same law; by default the middle of 0.14 to 0.27, measured on knees by Haider 2012.
        wear_over_conventional: f64 = HIGH.default, in limits_of(&HIGH);
    }
}

variants! {
    /// Whether the polyethylene was cross-linked.
    CrossLinking by
    /// Whether the polyethylene was cross-linked: every law of wear, fitted to conventional polyethylene, is then multiplied by a factor. Elasticity and creep stay as given.
    cross_linking = "none" {
        /// Conventional polyethylene: laws as they were fitted.
        None = "none",
        /// After some 50 kGy.
        Moderate(ModeratelyCrossLinked) = "moderate",
        /// After some 100 kGy.
        High(HighlyCrossLinked) = "high",
    }
}

impl CrossLinking {
    /// What it wears over what conventional polyethylene would wear; none of conventional polyethylene itself.
    pub fn wear_over_conventional(&self) -> Option<f64> {
        match self {
            Self::None => None,
            Self::Moderate(moderate) => Some(moderate.wear_over_conventional),
            Self::High(high) => Some(high.wear_over_conventional),
        }
    }

    /// A law of wear with this polyethylene.
    pub fn under(&self, law: NamedLaw) -> NamedLaw {
        match self.wear_over_conventional() {
            Some(times) => CrossLinked::under(law, times),
            None => law,
        }
    }
}

const A: Parameter = LeePienkowski::STRAIN_AT_10000_MIN;
const B: Parameter = LeePienkowski::STRAIN_PER_DECADE;
const R: Parameter = LeePienkowski::RECOVERING;

settings! {
    /// The constants of creep by the logarithm of time.
    LogarithmicCreep {
        /// Strain by creep after 10,000 min under 1 MPa. The default is approximate.
        strain_at_10000_min_per_mpa: f64 = A.default, in limits_of(&A);
        /// Strain by creep that each tenfold of time adds under 1 MPa. The default is approximate.
        strain_per_decade_per_mpa: f64 = B.default, in limits_of(&B);
        /// Part of the creep that recovers once the load is gone; what is left is what a scan of an unloaded insert sees.
        recovering_fraction: f64 = R.default, in limits_of(&R);
    }
}

variants! {
    /// How the polyethylene of the insert creeps.
    Creep by
    /// Which law of creep.
    law = "none" {
        /// It does not.
        None = "none",
        /// By the logarithm of time, as Lee and Pienkowski measured it.
        LeePienkowski(LogarithmicCreep) = "lee-pienkowski",
    }
}

impl Creep {
    /// The law itself, if the insert creeps.
    pub(super) fn law(&self) -> Option<LeePienkowski> {
        match self {
            Self::None => None,
            Self::LeePienkowski(constants) => Some(LeePienkowski {
                strain_at_10000_min_per_mpa: constants.strain_at_10000_min_per_mpa,
                strain_per_decade_per_mpa: constants.strain_per_decade_per_mpa,
                recovering_fraction: constants.recovering_fraction,
            }),
        }
    }
}

impl Table for Material {
    const NAME: &'static str = "material";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&root.table(Self::NAME, log), log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let table = TableSchema::new("Polyethylene of the insert.")
            .with_keys(&Self::keys())
            .with_choices(&CrossLinking::choices());
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        page.chosen("`[material]`", &Self::keys(), &CrossLinking::choices());
    }
}

impl Table for Creep {
    const NAME: &'static str = "creep";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&root.table(Self::NAME, log), &[], log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let table = TableSchema::new("How the polyethylene of the insert creeps.")
            .with_choices(&Self::choices());
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        let choices = Self::choices();
        page.chosen("`[creep]`", std::slice::from_ref(&choices.by), &choices);
    }
}
