//! Amplitudes, and the step with its procedure, boundary conditions, loads and output.

use std::io::{self, Write};

use super::writer::{InpWriter, real};

/// How much an implicit step damps what its increments do not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Application {
    /// Backward Euler: comes to rest soon.
    QuasiStatic,
    /// Little damping, enough for contact.
    ModerateDissipation,
}

/// How a step is solved in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Procedure {
    /// `*DYNAMIC`, implicit.
    Implicit {
        /// How much the integration damps.
        application: Application,
        /// First increment of time, s.
        first_s: f64,
        /// Smallest increment, s.
        least_s: f64,
        /// Largest increment, s.
        most_s: f64,
    },
    /// `*DYNAMIC, EXPLICIT`, with the stable increment found by the code.
    Explicit,
}

/// The head of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnalysisStep<'a> {
    /// Its name.
    pub name: &'a str,
    /// How long it lasts, s.
    pub period_s: f64,
    /// How it is solved.
    pub procedure: Procedure,
}

impl<W: Write> InpWriter<W> {
    /// `*AMPLITUDE`: (time, s; value) in rising time, four pairs a line.
    pub fn amplitude(&mut self, name: &str, table: &[(f64, f64)]) -> io::Result<()> {
        self.keyword(&format!(
            "*AMPLITUDE, NAME={name}, DEFINITION=TABULAR, TIME=STEP TIME"
        ))?;
        for row in table.chunks(4) {
            let values: Vec<f64> = row
                .iter()
                .flat_map(|&(time, value)| [time, value])
                .collect();
            self.reals(&values)?;
        }
        Ok(())
    }

    /// `*STEP` with its procedure; geometry is nonlinear.
    pub fn begin_step(&mut self, step: &AnalysisStep) -> io::Result<()> {
        let AnalysisStep {
            name,
            period_s,
            procedure,
        } = *step;
        match procedure {
            Procedure::Implicit {
                application,
                first_s,
                least_s,
                most_s,
            } => {
                let application = match application {
                    Application::QuasiStatic => "QUASI-STATIC",
                    Application::ModerateDissipation => "MODERATE DISSIPATION",
                };
                self.keyword(&format!("*STEP, NAME={name}, NLGEOM=YES, INC=100000"))?;
                self.keyword(&format!("*DYNAMIC, APPLICATION={application}"))?;
                self.reals(&[first_s, period_s, least_s, most_s])
            }
            Procedure::Explicit => {
                self.keyword(&format!("*STEP, NAME={name}, NLGEOM=YES"))?;
                self.keyword("*DYNAMIC, EXPLICIT")?;
                writeln!(self.out, ", {}", real(period_s))
            }
        }
    }

    /// `*BOUNDARY`: the freedoms `first` to `last` (1 to 6) of a node or node set held at 0.
    pub fn fixed(&mut self, nodes: &str, first: u8, last: u8) -> io::Result<()> {
        self.keyword("*BOUNDARY")?;
        writeln!(self.out, "{nodes}, {first}, {last}")
    }

    /// `*BOUNDARY`: a freedom of a node or node set led through `scale` times an amplitude, mm or
    /// rad.
    pub fn prescribed(
        &mut self,
        nodes: &str,
        freedom: u8,
        scale: f64,
        amplitude: &str,
    ) -> io::Result<()> {
        self.keyword(&format!(
            "*BOUNDARY, AMPLITUDE={amplitude}, TYPE=DISPLACEMENT"
        ))?;
        writeln!(self.out, "{nodes}, {freedom}, {freedom}, {}", real(scale))
    }

    /// `*CLOAD`: `scale` times an amplitude, N or N mm, on a freedom of a node or node set.
    pub fn load(
        &mut self,
        nodes: &str,
        freedom: u8,
        scale: f64,
        amplitude: &str,
    ) -> io::Result<()> {
        self.keyword(&format!("*CLOAD, AMPLITUDE={amplitude}"))?;
        writeln!(self.out, "{nodes}, {freedom}, {}", real(scale))
    }

    /// `*OUTPUT` at `intervals` equal times: displacements and reactions, contact pressure and
    /// slip.
    pub fn output(&mut self, intervals: usize) -> io::Result<()> {
        self.keyword(&format!("*OUTPUT, FIELD, NUMBER INTERVAL={intervals}"))?;
        self.keyword("*NODE OUTPUT\nU, RF")?;
        self.keyword("*CONTACT OUTPUT\nCSTRESS, CDISP")
    }

    /// `*END STEP`.
    pub fn end_step(&mut self) -> io::Result<()> {
        self.keyword("*END STEP")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::inp_writer::writer::tests::written;

    #[test]
    fn amplitudes_hold_four_pairs_a_line() {
        let table: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i) + 0.5, 0.25)).collect();
        let text = written(|inp| inp.amplitude("axial", &table));
        let expected = "*AMPLITUDE, NAME=axial, DEFINITION=TABULAR, TIME=STEP TIME\n\
            0.5, 0.25, 1.5, 0.25, 2.5, 0.25, 3.5, 0.25\n4.5, 0.25\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn an_implicit_step_is_written() {
        let procedure = Procedure::Implicit {
            application: Application::QuasiStatic,
            first_s: 0.005,
            least_s: 1e-9,
            most_s: 0.01,
        };
        let text = written(|inp| {
            inp.begin_step(&AnalysisStep {
                name: "gait",
                period_s: 0.9,
                procedure,
            })?;
            inp.fixed("backside", 1, 3)?;
            inp.prescribed("99", 6, -1.5, "flexion")?;
            inp.load("femur-node", 2, -0.5, "axial")?;
            inp.output(100)?;
            inp.end_step()
        });
        let expected = "*STEP, NAME=gait, NLGEOM=YES, INC=100000\n\
            *DYNAMIC, APPLICATION=QUASI-STATIC\n0.005, 0.9, 1e-9, 0.01\n\
            *BOUNDARY\nbackside, 1, 3\n\
            *BOUNDARY, AMPLITUDE=flexion, TYPE=DISPLACEMENT\n99, 6, 6, -1.5\n\
            *CLOAD, AMPLITUDE=axial\nfemur-node, 2, -0.5\n\
            *OUTPUT, FIELD, NUMBER INTERVAL=100\n*NODE OUTPUT\nU, RF\n\
            *CONTACT OUTPUT\nCSTRESS, CDISP\n*END STEP\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn an_explicit_step_is_written() {
        let procedure = Procedure::Explicit;
        let text = written(|inp| {
            inp.begin_step(&AnalysisStep {
                name: "gait",
                period_s: 0.9,
                procedure,
            })
        });
        assert_eq!(
            text,
            "*STEP, NAME=gait, NLGEOM=YES\n*DYNAMIC, EXPLICIT\n, 0.9\n"
        );
    }
}
