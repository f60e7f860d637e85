//! Which tests are a sample of what may happen.

use condyle_io::study::Design;

use super::super::{design::Saltelli, plan::Plan};

/// Whether every row of a design is as likely as any other, so that shares of rows are probabilities. Of a Saltelli design
/// the two bases are such rows.
pub(super) fn is_of_sample(plan: &Plan, row: usize) -> bool {
    let study = plan.study();
    match &study.design {
        Design::LatinHypercube(_) | Design::Sobol(_) | Design::Rows(_) => true,
        Design::Saltelli(_) => !matches!(
            Saltelli::of(row as u64, study.inputs.len()).1,
            Saltelli::Changed(_)
        ),
        Design::Morris(_)
        | Design::FullFactorial(_)
        | Design::OneAtATime(_)
        | Design::Optimise(_) => false,
    }
}
