//! Polyethylene of the insert.

use condyle_fem::Elastic;

use crate::keyed::{settings, within};

settings! {
    /// Polyethylene of the insert.
    Material {
        /// Young's modulus.
        youngs_modulus_mpa: f64 = 463.0, in within(1.0, 100_000.0);
        /// Poisson's ratio.
        poissons_ratio: f64 = 0.46, in within(0.0, 0.499);
        /// Density.
        density_mg_per_mm3: f64 = 0.93, in within(0.01, 30.0);
    }
}

impl Material {
    /// Its elasticity, MPa.
    pub(crate) fn elastic(&self) -> Elastic {
        Elastic {
            youngs_modulus: self.youngs_modulus_mpa,
            poissons_ratio: self.poissons_ratio,
        }
    }
}
