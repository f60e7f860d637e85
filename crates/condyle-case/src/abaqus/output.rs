//! What a step writes down.

use std::io::{self, Write};

use super::model::Model;
use super::names;
use condyle_mesh::formats::InpWriter;

/// Pictures of the whole model in a step.
const PICTURES: usize = 100;

/// Fields for pictures, histories for curves.
pub(super) fn write<W: Write>(
    model: &Model<'_>,
    seconds: f64,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    inp.keyword(&format!("*OUTPUT, FIELD, NUMBER INTERVAL={PICTURES}"))?;
    inp.keyword("*NODE OUTPUT")?;
    inp.line("U, RF")?;
    inp.keyword("*CONTACT OUTPUT")?;
    inp.line(if model.options.explicit {
        "CSTRESS, FSLIP, FSLIPR"
    } else {
        "CSTRESS, CDISP"
    })?;
    let interval = (seconds / model.increment_s()).round().max(1.0);
    inp.keyword(&format!(
        "*OUTPUT, HISTORY, TIME INTERVAL={:?}",
        seconds / interval
    ))?;
    for set in [names::FEMUR_REF, names::CARRIAGE, names::INSERT_REF] {
        inp.keyword(&format!("*NODE OUTPUT, NSET={set}"))?;
        inp.line("U, UR, RF, RM")?;
    }
    let springs = (1..=model.test.machine().springs.len()).map(|i| format!("AP-SPRING-{i}"));
    for connector in std::iter::once(names::HINGE.to_owned()).chain(springs) {
        inp.keyword(&format!("*ELEMENT OUTPUT, ELSET={connector}"))?;
        inp.line("CU, CTF")?;
    }
    inp.keyword("*CONTACT OUTPUT")?;
    inp.line("CFN, CFS, CAREA")
}

/// What the names of the output mean.
pub(super) fn comment(model: &Model<'_>) -> &'static str {
    if model.options.explicit {
        "\nOUTPUT. CSTRESS holds CPRESS, the contact pressure; FSLIP is the length of the path slid in\n\
         contact, FSLIPR its rate (Abaqus/Explicit has no COPEN and CSLIP). CFN, CFS: forces of pressure\n\
         and friction; CAREA: contact area; CU: VV and the motion of the springs; CTF: their force."
    } else {
        "\nOUTPUT. CSTRESS holds CPRESS, the contact pressure; CDISP holds COPEN, the gap (negative where\n\
         the bodies overlap), and CSLIP1 and CSLIP2, the slip added up while in contact. CFN, CFS: forces\n\
         of pressure and friction; CAREA: contact area; CU: VV and the motion of the springs; CTF: their\n\
         force. Archard's depth at a node is the wear factor times the sum of CPRESS |change of CSLIP|."
    }
}
