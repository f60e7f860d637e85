//! The stored tests in columns.

use condyle_results::catalogue::Scalar;

use crate::{
    error::StudyError,
    plan::Plan,
    store::{Column, Store},
};

/// The table of a study that answers are computed from.
pub(crate) struct Data<'a> {
    pub plan: &'a Plan,
    pub inputs: Vec<Column>,
    /// The outputs of the study, with a value for each test.
    pub outputs: Vec<(&'static Scalar, Vec<f64>)>,
    /// Whether each test is done and within every limit.
    pub within: Vec<bool>,
}

impl<'a> Data<'a> {
    pub fn read(plan: &'a Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let values = |output: &Scalar| -> Result<Vec<f64>, StudyError> {
            Ok(store.column(plan, output.key)?.values)
        };
        let mut within = vec![true; plan.tests() as usize];
        for bound in &study.answers.bounds {
            for (within, value) in within.iter_mut().zip(values(bound.output)?) {
                *within &= bound.excess(value) == 0.0 && value.is_finite();
            }
        }
        let inputs = study.inputs.iter();
        let inputs = inputs.map(|input| store.column(plan, &input.key));
        let outputs = study.answers.outputs.iter();
        let outputs = outputs.map(|output| values(output).map(|values| (*output, values)));
        Ok(Self {
            plan,
            inputs: inputs.collect::<Result<_, _>>()?,
            outputs: outputs.collect::<Result<_, _>>()?,
            within,
        })
    }
}
