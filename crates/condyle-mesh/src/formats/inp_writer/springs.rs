//! Springs and connectors with a table of force over displacement.

use std::io::{self, Write};

use super::writer::InpWriter;

impl<W: Write> InpWriter<W> {
    /// A spring from a node to the ground along one degree of freedom (`SPRING1`), with a table of
    /// (force, N; displacement, mm) in rising displacement.
    pub fn spring_to_ground(
        &mut self,
        name: &str,
        element: u32,
        node: u32,
        freedom: u8,
        table: &[(f64, f64)],
    ) -> io::Result<()> {
        self.keyword(&format!("*ELEMENT, TYPE=SPRING1, ELSET={name}"))?;
        writeln!(self.out, "{element}, {node}")?;
        self.keyword(&format!("*SPRING, ELSET={name}, NONLINEAR"))?;
        writeln!(self.out, "{freedom}")?;
        self.pairs_a_line(table)
    }

    /// A spring between two nodes along one degree of freedom (`SPRING2`), whose table is in the
    /// displacement of the first node past the second.
    pub fn spring_between(
        &mut self,
        name: &str,
        element: u32,
        nodes: [u32; 2],
        freedom: u8,
        table: &[(f64, f64)],
    ) -> io::Result<()> {
        self.keyword(&format!("*ELEMENT, TYPE=SPRING2, ELSET={name}"))?;
        writeln!(self.out, "{element}, {}, {}", nodes[0], nodes[1])?;
        self.keyword(&format!("*SPRING, ELSET={name}, NONLINEAR"))?;
        writeln!(self.out, "{freedom}, {freedom}")?;
        self.pairs_a_line(table)
    }

    /// A connector (`CONN3D2`) between two nodes, or, without the first, from the ground to the
    /// second; `kind` is its connection, such as `AXIAL` or `CARTESIAN, CARDAN`.
    pub fn connector(
        &mut self,
        name: &str,
        element: u32,
        nodes: (Option<u32>, u32),
        kind: &str,
        orientation: Option<&str>,
    ) -> io::Result<()> {
        let from = nodes.0.map(|node| node.to_string()).unwrap_or_default();
        self.keyword(&format!("*ELEMENT, TYPE=CONN3D2, ELSET={name}"))?;
        writeln!(self.out, "{element}, {from}, {}", nodes.1)?;
        self.keyword(&format!(
            "*CONNECTOR SECTION, ELSET={name}, BEHAVIOR={name}-behavior"
        ))?;
        self.line(kind)?;
        orientation.map_or(Ok(()), |orientation| self.line(orientation))
    }

    /// `*CONNECTOR BEHAVIOR` that belongs to the connector `name`; elasticity and damping of its
    /// components follow.
    pub fn connector_behavior(&mut self, name: &str) -> io::Result<()> {
        self.keyword(&format!("*CONNECTOR BEHAVIOR, NAME={name}-behavior"))
    }

    /// `*CONNECTOR ELASTICITY` of a component, 1 to 6, with a table of (force, displacement) or
    /// (moment, angle in rad) in rising displacement.
    pub fn connector_elasticity(&mut self, component: u8, table: &[(f64, f64)]) -> io::Result<()> {
        self.keyword(&format!(
            "*CONNECTOR ELASTICITY, COMPONENT={component}, NONLINEAR"
        ))?;
        self.pairs_a_line(table)
    }

    /// `*CONNECTOR DAMPING` of a component, 1 to 6: force over velocity.
    pub fn connector_damping(&mut self, component: u8, damping: f64) -> io::Result<()> {
        self.keyword(&format!("*CONNECTOR DAMPING, COMPONENT={component}"))?;
        self.reals(&[damping])
    }

    /// `*ORIENTATION`: local x along `along_x`, local y towards `towards_y`.
    pub fn orientation(
        &mut self,
        name: &str,
        along_x: [f64; 3],
        towards_y: [f64; 3],
    ) -> io::Result<()> {
        self.keyword(&format!("*ORIENTATION, NAME={name}"))?;
        self.reals(&[along_x, towards_y].concat())
    }

    fn pairs_a_line(&mut self, table: &[(f64, f64)]) -> io::Result<()> {
        table
            .iter()
            .try_for_each(|&(force, displacement)| self.reals(&[force, displacement]))
    }
}

#[cfg(test)]
mod tests {
    use crate::formats::inp_writer::writer::tests::written;

    /// Free for 2.5 mm each way, then 7.24 N/mm one way and 33.8 N/mm the other.
    const TABLE: [(f64, f64); 4] = [(-72.4, -12.5), (0.0, -2.5), (0.0, 2.5), (338.0, 12.5)];
    const ROWS: &str = "-72.4, -12.5\n0.0, -2.5\n0.0, 2.5\n338.0, 12.5\n";

    #[test]
    fn springs_are_written_with_their_table() {
        let text = written(|inp| inp.spring_to_ground("ap", 5, 99, 1, &TABLE));
        let expected = "*ELEMENT, TYPE=SPRING1, ELSET=ap\n5, 99\n*SPRING, ELSET=ap, NONLINEAR\n1\n";
        assert_eq!(text, format!("{expected}{ROWS}"));
        let text = written(|inp| inp.spring_between("ap", 5, [99, 98], 1, &TABLE));
        let expected =
            "*ELEMENT, TYPE=SPRING2, ELSET=ap\n5, 99, 98\n*SPRING, ELSET=ap, NONLINEAR\n1, 1\n";
        assert_eq!(text, format!("{expected}{ROWS}"));
    }

    #[test]
    fn connectors_are_written_with_their_behavior() {
        let text = written(|inp| {
            inp.orientation("frame", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
            inp.connector("lateral", 6, (None, 99), "CARTESIAN", Some("frame"))?;
            inp.connector_behavior("lateral")?;
            inp.connector_elasticity(1, &TABLE)?;
            inp.connector_damping(1, 0.5)
        });
        let expected = "*ORIENTATION, NAME=frame\n1.0, 0.0, 0.0, 0.0, 1.0, 0.0\n\
            *ELEMENT, TYPE=CONN3D2, ELSET=lateral\n6, , 99\n\
            *CONNECTOR SECTION, ELSET=lateral, BEHAVIOR=lateral-behavior\nCARTESIAN\nframe\n\
            *CONNECTOR BEHAVIOR, NAME=lateral-behavior\n\
            *CONNECTOR ELASTICITY, COMPONENT=1, NONLINEAR\n";
        assert_eq!(
            text,
            format!("{expected}{ROWS}*CONNECTOR DAMPING, COMPONENT=1\n0.5\n")
        );
    }
}
