//! The whole of a study file.

use std::path::Path;
use std::sync::Arc;

use super::alternative::Alternative;
use super::answers::{Answers, output};
use super::contents::Study;
use super::correlation::Correlation;
use super::count::check_count;
use super::declared::{Design, HeadingKeys, Variation};
use super::input::Input;
use super::reason::StudyReason;
use super::rows::{Rows, read_rows};
use super::tried::Trial;
use crate::case::{Case, CaseReader};
use crate::config::{Base, Log, Problems, Section, Settings, read_document, read_source};
use condyle_mesh::files::{Disk, Files};

/// Values that are tried on the case before the first test, at most: a thousand files of rows would take a while, and what the
/// case does not take is then the row's reason.
const MAX_TRIED: usize = 512;

const TABLES: &[&str] = &[
    "case",
    "title",
    "design",
    "vary",
    "correlation",
    "alternative",
    "limit",
    "answers",
];

impl Study {
    /// Reads the study file at `path` on the disk, and the case that it names; paths in each count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with either, a key that the case does not have, and values that it does not take.
    pub fn read(path: &Path) -> Result<Self, Problems> {
        Self::read_in(Disk, path)
    }

    /// The same from `files`, which have the case and the files that it names as well.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_in(files: impl Files + 'static, path: &Path) -> Result<Self, Problems> {
        let files: Arc<dyn Files> = Arc::new(files);
        let source = read_source(files.as_ref(), path).map_err(Problems::unreadable)?;
        let base = Base::of(&files, path);
        let cases = CaseReader::sharing(Arc::clone(&files));
        let study = read_document(&source, base, |root, log| {
            read_study(root, base.folder, cases, log)
        })?;
        let text = source.inner().clone();
        Ok(Self { text, ..study })
    }
}

fn read_study(
    root: &Section<'_>,
    folder: &Path,
    cases: CaseReader,
    log: &mut Log<'_>,
) -> Option<Study> {
    root.check_keys(TABLES, log);
    let heading = HeadingKeys::read(root, log);
    let section = root.table("design", log);
    let design = Design::read_checked(&section, log);
    let answers = Answers::read(root, log);
    let (heading, design) = (heading?, design?);
    let case_path = heading.case.path().to_path_buf();
    let case = cases.read(&case_path);
    let case = case.map_err(|problems| log.of_other_file(&problems)).ok()?;
    let Rows { inputs, rows } = inputs(root, &design, &case, log)?;
    let alternatives = alternatives(root, log)?;
    let correlations = correlations(root, &inputs, log)?;
    let folder = folder
        .canonicalize()
        .unwrap_or_else(|_| folder.to_path_buf());
    let trial = Trial {
        cases: &cases,
        case_path: &case_path,
        folder: &folder,
    };
    check_twice(&inputs, log);
    inputs.iter().fold(MAX_TRIED, |left, input| {
        trial.check_input(input, &inputs, left, log)
    });
    alternatives
        .iter()
        .for_each(|one| trial.check_alternative(one, log));
    check_fit(
        &section,
        &design,
        &inputs,
        (!correlations.is_empty(), !alternatives.is_empty()),
        log,
    );
    Some(Study {
        title: heading.title,
        case_path,
        case,
        design,
        inputs,
        correlations,
        alternatives,
        answers: answers?,
        rows,
        text: String::new(),
        folder,
        cases,
    })
}

/// What varies: every `[[vary]]`, or the columns of a file of rows.
fn inputs(root: &Section<'_>, design: &Design, case: &Case, log: &mut Log<'_>) -> Option<Rows> {
    let listed = root.list("vary", log)?;
    if let Design::Rows(keys) = design {
        if !listed.is_empty() {
            log.problem(root.key_span("vary"), StudyReason::RowsAndVary);
        }
        return read_rows(&root.table("design", log), &keys.file, case, log);
    }
    check_count("inputs", listed.len(), root.key_span("vary"), log)?;
    let read: Vec<Option<Input>> = listed
        .iter()
        .map(|one| Input::read(one, case, log))
        .collect();
    let is_ranking = root.value("alternative").is_some();
    if listed.is_empty() && !is_ranking {
        log.problem(0..0, StudyReason::NothingVaries);
        return None;
    }
    let inputs: Option<Vec<Input>> = read.into_iter().collect();
    Some(Rows {
        inputs: inputs?,
        rows: Vec::new(),
    })
}

fn alternatives(root: &Section<'_>, log: &mut Log<'_>) -> Option<Vec<Alternative>> {
    let listed = root.list("alternative", log)?;
    check_count("designs", listed.len(), root.key_span("alternative"), log)?;
    let read: Vec<_> = listed
        .iter()
        .map(|one| Alternative::read(one, log))
        .collect();
    read.into_iter().collect()
}

fn correlations(
    root: &Section<'_>,
    inputs: &[Input],
    log: &mut Log<'_>,
) -> Option<Vec<Correlation>> {
    let listed = root.list("correlation", log)?;
    let read: Vec<_> = listed
        .iter()
        .map(|one| Correlation::read(one, inputs, log))
        .collect();
    read.into_iter().collect()
}

fn check_twice(inputs: &[Input], log: &mut Log<'_>) {
    for (place, input) in inputs.iter().enumerate() {
        if inputs[..place].iter().any(|before| before.key == input.key) {
            let key = input.key.clone();
            log.problem(input.span.clone(), StudyReason::Twice { key });
        }
    }
}

/// Reports a design that does not fit what the study has.
fn check_fit(
    section: &Section<'_>,
    design: &Design,
    inputs: &[Input],
    (correlates, ranks): (bool, bool),
    log: &mut Log<'_>,
) {
    let span = section.value_span("kind");
    let word = design.word();
    let samples = matches!(design, Design::LatinHypercube(_) | Design::Sobol(_));
    if correlates && !samples {
        log.problem(span.clone(), StudyReason::CannotCorrelate { design: word });
    }
    if ranks
        && matches!(
            design,
            Design::Optimise(_) | Design::Saltelli(_) | Design::Morris(_)
        )
    {
        log.problem(span.clone(), StudyReason::CannotRank { design: word });
    }
    match design {
        Design::Optimise(keys) => {
            output(&keys.minimise, "minimise", section, log);
            let is_range =
                |input: &Input| matches!(input.variation, Variation::Uniform(_)) && !input.is_whole;
            if let Some(input) = inputs.iter().find(|input| !is_range(input)) {
                let key = input.key.clone();
                log.problem(input.span.clone(), StudyReason::NoRange { key });
            }
        }
        Design::Morris(keys) if keys.levels % 2 == 1 => {
            log.problem(
                section.value_span("levels"),
                StudyReason::OddLevels {
                    levels: keys.levels,
                },
            );
        }
        _ => {}
    }
}
