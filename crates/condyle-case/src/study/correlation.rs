//! Inputs that go together.

use super::declared::CorrelationKeys;
use super::input::Input;
use super::reason::StudyReason;
use crate::config::{Log, Section, Settings, names};

/// Two inputs that go together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Their places among the inputs.
    pub inputs: [usize; 2],
    /// Correlation of their normal scores.
    pub coefficient: f64,
}

impl Correlation {
    /// Reads one `[[correlation]]` between two of `inputs`.
    pub(super) fn read(section: &Section<'_>, inputs: &[Input], log: &mut Log<'_>) -> Option<Self> {
        let known: Vec<&str> = names(&CorrelationKeys::keys()).collect();
        section.check_keys(&known, log);
        let keys = CorrelationKeys::read(section, log)?;
        let span = section.value_span("keys");
        let [one, other] = &keys.keys.0[..] else {
            log.problem(span, StudyReason::NotTwoKeys);
            return None;
        };
        let mut place = |key: &String| {
            let found = inputs
                .iter()
                .position(|input| input.key == *key && input.is_continuous());
            if found.is_none() {
                let key = key.clone();
                log.problem(span.clone(), StudyReason::NotVaried { key });
            }
            found
        };
        let (one, other) = (place(one), place(other));
        Some(Self {
            inputs: [one?, other?],
            coefficient: keys.coefficient,
        })
    }
}
