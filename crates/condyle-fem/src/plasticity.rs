//! Plasticity of von Mises, with isotropic and kinematic hardening.
//!
//! Stress beyond the yield surface returns to it along the radius (Wilkins; Simo and Hughes 1998, section 3.3),
//! which is the implicit step, exact for proportional straining, and has the exact derivative that Newton's
//! method needs.

use serde::{Deserialize, Serialize};

use crate::{
    elastic::{Elastic, Strain},
    hardening::Hardening,
    stress::Stress,
};

/// What a place of the material remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlasticPoint {
    /// Plastic strain, without change of volume.
    pub strain: Strain,
    /// Centre of the yield surface, a deviator.
    pub backstress: Stress,
    /// Accumulated equivalent plastic strain, which never falls.
    pub accumulated: f64,
}

/// An elastic-plastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticPlastic {
    /// Its elastic part.
    pub elastic: Elastic,
    /// Its yield stress.
    pub hardening: Hardening,
}

/// What the material does under a strain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Response {
    pub(crate) stress: Stress,
    /// What it remembers then.
    pub(crate) point: PlasticPoint,
    /// How much softer it is than elastic, if it yields.
    pub(crate) softening: Option<Softening>,
}

/// The elastic tangent less the consistent one: $a\thinspace I_\text{dev} + b\thinspace n \otimes n$.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Softening {
    /// Stress over strain, of any deviator.
    pub(crate) deviatoric: f64,
    /// The same, along the flow.
    pub(crate) along_flow: f64,
    /// Direction of the flow, a deviator of length 1.
    pub(crate) flow: Stress,
}

impl ElasticPlastic {
    /// Part of the yield stress that an elastic strain after what the material remembers uses up.
    pub(crate) fn use_of_yield(&self, strain: &Strain, before: &PlasticPoint) -> f64 {
        let trial = self.elastic.stress(&strain.less(&before.strain));
        let relative = trial.deviator().plus(-1.0, &before.backstress);
        relative.von_mises() / self.hardening.yield_stress(before.accumulated)
    }

    /// The response to a strain after what the material remembers.
    ///
    /// With the trial stress $s$ and $\xi = s - \beta$, $q = \sqrt{3/2} |\xi|$, the step $\Delta p$ solves
    /// $q - (3 G + H_k) \Delta p = \sigma_y(p + \Delta p)$.
    pub(crate) fn respond(&self, strain: &Strain, before: &PlasticPoint) -> Response {
        let trial = self.elastic.stress(&strain.less(&before.strain));
        let relative = trial.deviator().plus(-1.0, &before.backstress);
        let q = 1.5f64.sqrt() * relative.norm();
        let (shear3, kinematic) = (
            3.0 * self.elastic.shear_modulus(),
            self.hardening.kinematic_modulus(),
        );
        let step = self
            .hardening
            .step(q, before.accumulated, shear3 + kinematic);
        let Some((step, slope)) = step else {
            return Response {
                stress: trial,
                point: *before,
                softening: None,
            };
        };
        let flow = Stress::default().plus(1.0 / relative.norm(), &relative);
        let length = 1.5f64.sqrt() * step;
        let removed = shear3 * step / q;
        let shear2 = 2.0 / 3.0 * shear3;
        Response {
            stress: trial.plus(-shear2 * length, &flow),
            point: PlasticPoint {
                strain: before.strain.plus(length, &flow),
                backstress: before
                    .backstress
                    .plus(2.0 / 3.0 * kinematic * length, &flow),
                accumulated: before.accumulated + step,
            },
            softening: Some(Softening {
                deviatoric: shear2 * removed,
                along_flow: shear2 * (shear3 / (shear3 + kinematic + slope) - removed),
                flow,
            }),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn material(kinematic: f64) -> ElasticPlastic {
        let points = vec![(0.0, 14.0), (0.02, 20.0), (0.1, 28.0)];
        ElasticPlastic {
            elastic: Elastic::new(571.6, 0.45).unwrap(),
            hardening: Hardening::new(points, kinematic).unwrap(),
        }
    }

    /// The stress that yielding takes away under a small strain.
    fn lost(softening: &Softening, strain: &Strain) -> Stress {
        let deviator = Stress(strain.0).deviator();
        let along = softening.along_flow * softening.flow.dot(&deviator);
        let flow = Stress::default().plus(along, &softening.flow);
        flow.plus(softening.deviatoric, &deviator)
    }

    #[test]
    fn the_consistent_tangent_is_the_derivative_of_the_stress() {
        let material = material(60.0);
        let mut before = PlasticPoint::default();
        for (k, size) in [0.05, 0.09, 0.12, 0.2].into_iter().enumerate() {
            let strain = |i: usize| size * ((3 * i + k) as f64).sin();
            let strain = Strain(std::array::from_fn(strain));
            let response = material.respond(&strain, &before);
            let softening = response.softening.expect("it yields");
            for i in 0..6 {
                let stress = |h: f64| {
                    let mut strain = strain;
                    strain.0[i] += h;
                    material.respond(&strain, &before).stress
                };
                let mut unit = Strain::default();
                unit.0[i] = 1.0;
                let elastic = material.elastic.stress(&unit);
                let tangent = elastic.plus(-1.0, &lost(&softening, &unit));
                let (up, down) = (stress(1e-6), stress(-1e-6));
                for j in 0..6 {
                    let slope = (up.0[j] - down.0[j]) / 2e-6;
                    assert!((slope - tangent.0[j]).abs() < 1e-4, "{slope} {tangent:?}");
                }
            }
            before = response.point;
        }
    }

    #[test]
    fn stress_stays_on_the_yield_surface_and_flow_keeps_the_volume() {
        let material = material(60.0);
        let mut point = PlasticPoint::default();
        for k in 0..20 {
            let strain = Strain(std::array::from_fn(|i| {
                0.1 * ((5 * i + 7 * k) as f64).cos()
            }));
            let response = material.respond(&strain, &point);
            point = response.point;
            let relative = response.stress.deviator().plus(-1.0, &point.backstress);
            let limit = material.hardening.yield_stress(point.accumulated);
            assert!(relative.von_mises() <= limit * (1.0 + 1e-12));
            assert!(point.strain.trace().abs() < 1e-14);
        }
        assert!(point.accumulated > 1.0);
    }
}
