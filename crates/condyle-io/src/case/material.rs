//! Polyethylene of the insert.

use condyle_fem::Elastic;

use super::cross_linking::CrossLinking;
use crate::config::{Key, Log, Section, Settings, Variants, Writer, settings, within};

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
