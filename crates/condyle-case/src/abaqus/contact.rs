//! Contact between the bodies: pressure over overclosure, friction.

use std::io::{self, Write};

use condyle::contact::PressureLaw;
use condyle::evolve::WearTest;

use super::model::Model;
use super::names;
use super::placing::Placing;
use condyle_mesh::formats::{InpWriter, PressureOverclosure};

/// Nodes as near to the settled femur as this come to press under the peak of the load, mm.
const NEAR_MM: f64 = 0.15;
/// Share of the thickness at which the table of a law ends; Abaqus goes on as a straight line, and
/// so does condyle's logarithmic law.
const TABLE_ENDS_AT: f64 = 0.9;
/// Rows of the table of a curved law.
const ROWS: usize = 60;

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let contact = model.case.foundation();
    inp.comment(&format!(
        "\nCONTACT. Overclosure > 0 is overlap, mm; pressure >= 0, MPa; friction {}.",
        contact.friction
    ))?;
    if model.options.deformable {
        inp.comment("Hard: the softness is in the elements.")?;
        inp.keyword(&format!("*SURFACE INTERACTION, NAME={}", names::BEARING))?;
        inp.keyword("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD")?;
        inp.keyword(&friction_keyword(model))?;
        inp.reals(&[contact.friction])?;
    } else {
        let thickness_mm = median_thickness_mm(model.test, &model.placing);
        inp.comment(&law_comment(&contact.pressure, thickness_mm))?;
        let law = law_table(&contact.pressure, thickness_mm);
        let slip = elastic_slip_mm(model);
        inp.surface_interaction(names::BEARING, &law, contact.friction, slip)?;
    }
    if model.options.explicit {
        return Ok(());
    }
    inp.comment(
        "Secondary: the insert, where pressure is evaluated, as in condyle. Main: the femur. The bodies\n\
         overlap at the start by what carries the axial force there; Abaqus turns that into pressure in\n\
         the first increment.",
    )?;
    inp.contact_pair(names::BEARING, names::ARTICULATING, names::FEMUR_SURFACE)
}

fn friction_keyword(model: &Model<'_>) -> String {
    let slip = elastic_slip_mm(model).map(|slip| format!(", ELASTIC SLIP={slip:?}"));
    format!("*FRICTION{}", slip.unwrap_or_default())
}

/// The slip of one increment at the speed where condyle's friction is 71 % of its full value.
fn elastic_slip_mm(model: &Model<'_>) -> Option<f64> {
    let slip = model.case.foundation().slip_tolerance_mm_per_s * model.increment_s();
    let rounded = (slip * 1e9).round() / 1e9;
    (!model.options.explicit).then_some(rounded.max(1e-9))
}

/// Median thickness of the insert where the settled femur is near; of all of it where it is not.
fn median_thickness_mm(test: &WearTest, placing: &Placing) -> f64 {
    let all = test.insert.thickness_mm();
    let gaps = placing.gaps_mm(test);
    let near = all.iter().zip(&gaps).filter(|(_, gap)| **gap < NEAR_MM);
    let mut under: Vec<f64> = near.map(|(thickness, _)| *thickness).collect();
    if under.is_empty() {
        under = all.to_vec();
    }
    under.sort_by(f64::total_cmp);
    under[under.len() / 2]
}

fn law_comment(law: &PressureLaw, thickness_mm: f64) -> String {
    let local = format!(
        "with the median thickness under the settled femur, h = {thickness_mm:.4} mm.\n\
         condyle uses the local thickness of each node: expect a few per cent where the insert is thicker."
    );
    match law {
        PressureLaw::Linear { modulus_mpa } => {
            format!("p = K d / h, K = {modulus_mpa:.3} MPa, {local}")
        }
        PressureLaw::Logarithmic { modulus_mpa } => {
            format!("p = -K ln(1 - d / h), K = {modulus_mpa:.3} MPa, {local}")
        }
        PressureLaw::Softening {
            modulus_mpa,
            softening_stress_mpa,
        } => format!(
            "d / h = (p / K) (1 + (p / s)^2), K = {modulus_mpa:.3} MPa, s = {softening_stress_mpa:.3} MPa, {local}"
        ),
        PressureLaw::Tabulated(_) => "The table of the case, whatever the thickness.".to_owned(),
        PressureLaw::TabulatedStrain(_) => format!("The table of the case over thickness, {local}"),
    }
}

fn law_table(law: &PressureLaw, thickness_mm: f64) -> Vec<PressureOverclosure> {
    let rows = match law {
        PressureLaw::Linear { .. } => 1,
        PressureLaw::Logarithmic { .. } => ROWS,
        PressureLaw::Softening {
            modulus_mpa,
            softening_stress_mpa,
        } => return softening_table(law, *modulus_mpa, *softening_stress_mpa, thickness_mm),
        PressureLaw::Tabulated(table) => {
            return table.points().iter().map(|&(d, p)| row(p, d)).collect();
        }
        PressureLaw::TabulatedStrain(table) => {
            let points = table.points().iter();
            return points
                .map(|&(strain, p)| row(p, strain * thickness_mm))
                .collect();
        }
    };
    let step = TABLE_ENDS_AT * thickness_mm / rows as f64;
    (0..=rows)
        .map(|i| i as f64 * step)
        .map(|overclosure| row(law.pressure(overclosure, thickness_mm).0, overclosure))
        .collect()
}

/// Rows evenly over the pressure: over the overclosure, the first would pass by all that bends.
fn softening_table(
    law: &PressureLaw,
    modulus_mpa: f64,
    softening_stress_mpa: f64,
    thickness_mm: f64,
) -> Vec<PressureOverclosure> {
    let most = law.pressure(TABLE_ENDS_AT * thickness_mm, thickness_mm).0;
    let rows = 2 * ROWS;
    let pressures = (0..=rows).map(|i| most * i as f64 / rows as f64);
    pressures
        .map(|pressure| {
            let strain = pressure / modulus_mpa * (1.0 + (pressure / softening_stress_mpa).powi(2));
            row(pressure, strain * thickness_mm)
        })
        .collect()
}

fn row(pressure_mpa: f64, overclosure_mm: f64) -> PressureOverclosure {
    PressureOverclosure {
        pressure_mpa,
        overclosure_mm,
    }
}

#[cfg(test)]
mod tests {
    use condyle::contact::PressureTable;

    use super::*;

    #[test]
    fn verify_a_linear_law_is_a_line_of_slope_k_over_h() {
        let law = PressureLaw::Linear {
            modulus_mpa: 2000.0,
        };
        let table = law_table(&law, 8.0);
        assert_eq!(table[0], row(0.0, 0.0));
        assert!((table[1].pressure_mpa / table[1].overclosure_mm - 250.0).abs() < 1e-9);
    }

    #[test]
    fn verify_a_logarithmic_law_between_its_rows() {
        let law = PressureLaw::Logarithmic {
            modulus_mpa: 2000.0,
        };
        let table = law_table(&law, 8.0);
        for pair in table.windows(2).take(ROWS / 2) {
            let middle = f64::midpoint(pair[0].overclosure_mm, pair[1].overclosure_mm);
            let line = f64::midpoint(pair[0].pressure_mpa, pair[1].pressure_mpa);
            let exact = -2000.0 * (1.0 - middle / 8.0).ln();
            assert!((line / exact - 1.0).abs() < 5e-3, "{middle} {line} {exact}");
        }
    }

    #[test]
    fn verify_a_softening_law_between_its_rows() {
        let (modulus_mpa, softening_stress_mpa) = (2850.0, 18.4);
        let law = PressureLaw::Softening {
            modulus_mpa,
            softening_stress_mpa,
        };
        let table = law_table(&law, 8.0);
        for pair in table.windows(2) {
            let middle = f64::midpoint(pair[0].overclosure_mm, pair[1].overclosure_mm);
            let line = f64::midpoint(pair[0].pressure_mpa, pair[1].pressure_mpa);
            let exact = law.pressure(middle, 8.0).0;
            assert!((line / exact - 1.0).abs() < 5e-3, "{middle} {line} {exact}");
        }
    }

    #[test]
    fn a_tabulated_law_is_written_as_it_is() {
        let points = vec![(0.0, 0.0), (0.1, 5.0), (0.3, 40.0)];
        let law = PressureLaw::Tabulated(PressureTable::new(points).unwrap());
        assert_eq!(law_table(&law, 8.0)[2], row(40.0, 0.3));
    }
}
