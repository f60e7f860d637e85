//! Contact: pressure over overclosure, friction, and who touches whom.

use std::io::{self, Write};

use super::writer::{InpWriter, real};

/// A row of a pressure-overclosure law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureOverclosure {
    /// Contact pressure, MPa.
    pub pressure_mpa: f64,
    /// Overclosure at that pressure, mm.
    pub overclosure_mm: f64,
}

impl<W: Write> InpWriter<W> {
    /// `*SURFACE INTERACTION` with a tabulated pressure-overclosure law and Coulomb friction.
    ///
    /// Both columns of the law must rise, and the first pressure be 0. With `elastic_slip_mm` the
    /// friction sticks elastically over that length (Abaqus/Standard).
    pub fn surface_interaction(
        &mut self,
        name: &str,
        law: &[PressureOverclosure],
        friction: f64,
        elastic_slip_mm: Option<f64>,
    ) -> io::Result<()> {
        self.softened(name, law)?;
        let slip = elastic_slip_mm.map(|slip| format!(", ELASTIC SLIP={}", real(slip)));
        self.keyword(&format!("*FRICTION{}", slip.unwrap_or_default()))?;
        self.reals(&[friction])
    }

    /// `*SURFACE INTERACTION` with a tabulated pressure-overclosure law alone; both columns must rise, and the first
    /// pressure be 0.
    pub fn softened(&mut self, name: &str, law: &[PressureOverclosure]) -> io::Result<()> {
        self.keyword(&format!("*SURFACE INTERACTION, NAME={name}"))?;
        self.keyword("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR")?;
        law.iter()
            .try_for_each(|row| self.reals(&[row.pressure_mpa, row.overclosure_mm]))
    }

    /// `*CONTACT PAIR`, the nodes of `secondary` against the surface `main`.
    pub fn nodes_on_surface(
        &mut self,
        interaction: &str,
        secondary: &str,
        main: &str,
    ) -> io::Result<()> {
        self.pair(interaction, "TYPE=NODE TO SURFACE", [secondary, main])
    }

    /// `*CONTACT PAIR`, surface to surface: the deformable or finer surface is the secondary one.
    pub fn contact_pair(
        &mut self,
        interaction: &str,
        secondary: &str,
        main: &str,
    ) -> io::Result<()> {
        self.pair(interaction, "TYPE=SURFACE TO SURFACE", [secondary, main])
    }

    /// `*CONTACT PAIR` for Abaqus/Explicit, where it stands within the step.
    pub fn explicit_contact_pair(
        &mut self,
        interaction: &str,
        one: &str,
        other: &str,
    ) -> io::Result<()> {
        self.pair(interaction, "MECHANICAL CONSTRAINT=PENALTY", [one, other])
    }

    fn pair(&mut self, interaction: &str, how: &str, [one, other]: [&str; 2]) -> io::Result<()> {
        self.keyword(&format!("*CONTACT PAIR, INTERACTION={interaction}, {how}"))?;
        writeln!(self.out, "{one}, {other}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::inp_writer::writer::tests::written;

    const LAW: [PressureOverclosure; 2] = [
        PressureOverclosure {
            pressure_mpa: 0.0,
            overclosure_mm: 0.0,
        },
        PressureOverclosure {
            pressure_mpa: 35.7,
            overclosure_mm: 0.1,
        },
    ];

    #[test]
    fn interaction_and_pair_are_written() {
        let text = written(|inp| {
            inp.surface_interaction("bearing", &LAW, 0.07, Some(0.005))?;
            inp.contact_pair("bearing", "insert-top", "femur-surface")
        });
        let expected = "*SURFACE INTERACTION, NAME=bearing\n\
            *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0.0, 0.0\n35.7, 0.1\n\
            *FRICTION, ELASTIC SLIP=0.005\n0.07\n\
            *CONTACT PAIR, INTERACTION=bearing, TYPE=SURFACE TO SURFACE\n\
            insert-top, femur-surface\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn explicit_pairs_use_a_penalty() {
        let text = written(|inp| {
            inp.surface_interaction("bearing", &LAW, 0.07, None)?;
            inp.explicit_contact_pair("bearing", "femur-surface", "insert-top")
        });
        assert!(text.contains("*FRICTION\n0.07\n"), "{text}");
        assert!(
            text.ends_with("MECHANICAL CONSTRAINT=PENALTY\nfemur-surface, insert-top\n"),
            "{text}"
        );
    }
}
