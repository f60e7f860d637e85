//! Designs that are compared.

use std::ops::Range;

use super::declared::AlternativeKeys;
use super::reason::StudyReason;
use crate::case::Assignment;
use crate::config::{Log, Section, Settings, names};

/// One of several designs, each tried under the same disturbances.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name.
    pub name: String,
    /// What it sets of the case.
    pub set: Vec<Assignment>,
    pub(super) span: Range<usize>,
}

impl Alternative {
    /// Reads one `[[alternative]]`.
    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let known: Vec<&str> = names(&AlternativeKeys::keys()).collect();
        section.check_keys(&known, log);
        let keys = AlternativeKeys::read(section, log)?;
        let mut set = Vec::new();
        for written in &keys.set.0 {
            match Assignment::parse(written) {
                Ok(one) => set.push(one),
                Err(error) => {
                    let why = error.to_string();
                    log.problem(section.value_span("set"), StudyReason::NotSet { why });
                }
            }
        }
        let span = section.value_span("name");
        let name = keys.name;
        Some(Self { name, set, span })
    }
}
