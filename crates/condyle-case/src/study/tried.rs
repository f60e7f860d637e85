//! Whether a case takes what a study would set.

use std::path::Path;

use super::alternative::Alternative;
use super::input::Input;
use super::reason::StudyReason;
use crate::case::{Assignment, CaseReader, ChangeError};
use crate::config::{Level, Log};

/// What sets `key` of a case; files are counted from `folder`, the study's.
pub(super) fn assignment(folder: &Path, key: &str, level: &Level) -> Assignment {
    let is_file = key.rsplit('.').next() == Some("file");
    let value = match level {
        Level::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => {
            format!("{number:.0}")
        }
        Level::Number(number) => format!("{number:?}"),
        Level::Word(word) if is_file => folder.join(word).display().to_string(),
        Level::Word(word) => word.clone(),
    };
    Assignment::new(key, value)
}

/// A case, and the study's folder.
pub(super) struct Trial<'a> {
    pub cases: &'a CaseReader,
    pub case_path: &'a Path,
    pub folder: &'a Path,
}

impl Trial<'_> {
    /// Reports what an input has at its ends and the case does not take, alone or with the others as they may be; no more than
    /// `left` values are tried, which is how many then remain.
    pub fn check_input(
        &self,
        input: &Input,
        others: &[Input],
        left: usize,
        log: &mut Log<'_>,
    ) -> usize {
        let ends = input.ends();
        let remain = left.saturating_sub(ends.len());
        for level in ends.into_iter().take(left) {
            let own = assignment(self.folder, &input.key, &level);
            let Some((why, advice)) = self.refused(std::slice::from_ref(&own)) else {
                continue;
            };
            let beside = others.iter().filter(|other| other.key != input.key);
            let mut all: Vec<Assignment> = beside.filter_map(|other| self.first(other)).collect();
            all.push(own);
            if self.refused(&all).is_some() {
                let (key, value) = (input.key.clone(), level);
                let reason = StudyReason::Refused {
                    key,
                    value,
                    why,
                    advice,
                };
                log.problem(input.span.clone(), reason);
                break;
            }
        }
        remain
    }

    /// Reports what a design sets and the case does not take.
    pub fn check_alternative(&self, design: &Alternative, log: &mut Log<'_>) {
        if let Some((why, advice)) = self.refused(&design.set) {
            let name = design.name.clone();
            let reason = StudyReason::AlternativeRefused { name, why, advice };
            log.problem(design.span.clone(), reason);
        }
    }

    fn first(&self, input: &Input) -> Option<Assignment> {
        let level = input.ends().into_iter().next()?;
        Some(assignment(self.folder, &input.key, &level))
    }

    /// Why the case does not take what is set, and what to do.
    fn refused(&self, set: &[Assignment]) -> Option<(String, Option<String>)> {
        match self.cases.read_changed(self.case_path, set) {
            Ok(_) => None,
            Err(ChangeError::Assignment(error)) => Some((error.to_string(), None)),
            Err(ChangeError::Case(problems)) => {
                let first = problems.problems().first()?;
                Some((first.to_string(), first.reason.advice()))
            }
        }
    }
}
