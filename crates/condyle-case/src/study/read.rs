//! Reading of a study file.

use std::path::Path;
use std::sync::Arc;

use super::answers::Answers;
use super::contents::{Alternative, Correlation, PARETO, Study};
use super::declared::{
    AdaptiveKeys, AlternativeKeys, CorrelationKeys, Design, HeadingKeys, OptimiseKeys, Variation,
};
use super::input::{Input, check_count, read_rows, sorted_numbers};
use super::outputs::Outputs;
use crate::case::{Assignment, Case, CaseReader, ChangeError};
use crate::config::*;
use condyle_mesh::files::{Disk, Files};

/// Largest number of values that are checked on the case before the first test, since thousands of
/// files would take too long; invalid values beyond these fail as rows.
const MAX_TRIED: usize = 512;

const TABLES: &[&str] = &[
    "case",
    "title",
    "design",
    "vary",
    "correlation",
    "alternative",
    "output",
    "limit",
    "answers",
];

impl Study {
    /// Reads the study file at `path` on the disk, and the case that it names; paths in each count from its folder.
    ///
    /// # Errors
    /// The problems of either file, a key that the case does not have, and values that it does not accept.
    pub fn read(path: &Path) -> Result<Self, Problems> {
        Self::read_in(Disk, path)
    }

    /// Reads a study from `files`, which also contain the case and the files that it names.
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
    let heading = heading?;
    let case_path = heading.case.path().to_path_buf();
    let case = cases.read(&case_path);
    let case = case
        .map_err(|problems| log.problems.extend_from_slice(problems.problems()))
        .ok()?;
    // Without one of the study's own outputs, questions about it would be further problems.
    let outputs = Outputs::read(root, &case, log)?;
    let answers = Answers::read(root, &outputs, log);
    let design = design?;
    let (inputs, rows) = inputs(root, &design, &case, log)?;
    let alternatives = root.read_list("alternative", log, alternative)?;
    check_count(
        "designs",
        alternatives.len(),
        root.key_span("alternative"),
        log,
    )?;
    let correlations = root.read_list("correlation", log, |section, log| {
        correlation(section, &inputs, log)
    })?;
    let absolute = folder.canonicalize();
    let study = Study {
        title: heading.title,
        case_path,
        case,
        design,
        inputs,
        correlations,
        alternatives,
        outputs,
        answers: answers?,
        rows,
        text: String::new(),
        folder: absolute.unwrap_or_else(|_| folder.to_path_buf()),
        cases,
    };
    study.check_inputs(log);
    study.check_design(&section, log);
    Some(study)
}

fn inputs(
    root: &Section<'_>,
    design: &Design,
    case: &Case,
    log: &mut Log<'_>,
) -> Option<(Vec<Input>, Vec<Vec<Level>>)> {
    let count = root.list("vary", log)?.len();
    if let Design::Rows(keys) = design {
        if count > 0 {
            let fault = Fault::new(
                "a study of given rows has its inputs in the file",
                "remove `[[vary]]`, or choose another kind of design",
            );
            log.problem(root.key_span("vary"), fault);
        }
        return read_rows(&root.table("design", log), &keys.file, case, log);
    }
    check_count("inputs", count, root.key_span("vary"), log)?;
    let inputs = root.read_list("vary", log, |one, log| Input::read(one, case, log));
    let inputs = inputs.map(|mut inputs| {
        inputs.sort_by_key(|input| input.is_disturbance);
        inputs
    });
    if count == 0 && root.value("alternative").is_none() {
        let advice = "add `[[vary]]` with `key = \"contact.friction\"`, `low` and `high`";
        return log.reject(0..0, Fault::new("the study has no varied inputs", advice));
    }
    Some((inputs?, Vec::new()))
}

fn alternative(section: &Section<'_>, log: &mut Log<'_>) -> Option<Alternative> {
    let keys = AlternativeKeys::read_checked(section, log)?;
    let mut set = Vec::new();
    for written in &keys.set.0 {
        match Assignment::parse(written) {
            Ok(one) => set.push(one),
            Err(error) => {
                let advice = "write each as `\"insert.thickness_mm=8\"`";
                let fault = Fault::new(error.to_string(), advice);
                log.problem(section.value_span("set"), fault);
            }
        }
    }
    Some(Alternative {
        name: keys.name,
        set,
        span: section.value_span("name"),
    })
}

fn correlation(section: &Section<'_>, inputs: &[Input], log: &mut Log<'_>) -> Option<Correlation> {
    let keys = CorrelationKeys::read_checked(section, log)?;
    let span = section.value_span("keys");
    let [one, other] = &keys.keys.0[..] else {
        let advice = "write `keys = [\"contact.friction\", \"wear.wear_factor_mm3_per_nm\"]`";
        return log.reject(
            span,
            Fault::new("a correlation needs exactly two keys", advice),
        );
    };
    let mut place = |key: &String| {
        let is_input =
            |input: &Input| input.key == *key && !matches!(input.variation, Variation::Levels(_));
        let found = inputs.iter().position(is_input);
        if found.is_none() {
            let fault = Fault::new(
                format!("`{key}` is not an input with a distribution"),
                "give it a `[[vary]]` with a distribution, or omit the correlation",
            );
            log.problem(span.clone(), fault);
        }
        found
    };
    let (one, other) = (place(one), place(other));
    Some(Correlation {
        inputs: [one?, other?],
        coefficient: keys.coefficient,
    })
}

impl Study {
    /// Reports inputs and designs that are given twice, and values and designs that the case does not accept.
    fn check_inputs(&self, log: &mut Log<'_>) {
        let mut left = MAX_TRIED;
        for (place, input) in self.inputs.iter().enumerate() {
            if self.inputs[..place].iter().any(|one| one.key == input.key) {
                let fault = Fault::new(
                    format!("`{}` is varied twice; remove one entry", input.key),
                    "keep one of the two, or give both values as columns of rows",
                );
                log.problem(input.span.clone(), fault);
            }
            if self.outputs.get(&input.key).is_some() {
                let message = format!("`{}` is an input and an output", input.key);
                let fault = Fault::new(message, "give the output another name");
                log.problem(input.span.clone(), fault);
            }
            self.check_input(input, &mut left, log);
        }
        for (place, alternative) in self.alternatives.iter().enumerate() {
            let mut before = self.alternatives[..place].iter();
            if before.any(|one| one.name == alternative.name) {
                let message = format!("two designs have the name `{}`", alternative.name);
                let fault = Fault::new(message, "rename one: answers name the designs");
                log.problem(alternative.span.clone(), fault);
            }
            if let Some(key) = self.varied_key(alternative) {
                let message = format!(
                    "the design `{}` sets `{key}`, which is also varied: the varied value would replace that of the design",
                    alternative.name
                );
                let advice = "remove the key from the design or from `[[vary]]`";
                log.problem(alternative.span.clone(), Fault::new(message, advice));
            }
            if let Some((why, advice)) = self.refusal(&alternative.set) {
                let message = format!("the case rejects the design `{}`: {why}", alternative.name);
                let fault = Fault::new(message, advice);
                log.problem(alternative.span.clone(), fault);
            }
        }
    }

    /// Returns a key that a design and an input both set.
    fn varied_key(&self, alternative: &Alternative) -> Option<&str> {
        let is_set = |input: &&Input| {
            alternative.set.iter().any(|set| {
                let path = self.case.path_of_key(set.key());
                let path = path.unwrap_or_else(|_| set.key().to_owned());
                let rest = input.key.strip_prefix(&path);
                rest.is_some_and(|rest| rest.is_empty() || set.has(rest))
            })
        };
        self.inputs
            .iter()
            .find(is_set)
            .map(|input| input.key.as_str())
    }

    /// Reports an end of an input that the case does not accept, neither alone nor with the others at one of their ends.
    /// At most `left` values are tried.
    fn check_input(&self, input: &Input, left: &mut usize, log: &mut Log<'_>) {
        let ends = input.ends();
        let tried = ends.len().min(*left);
        *left -= tried;
        for level in ends.into_iter().take(tried) {
            let own = input.assignments(&self.folder, &level);
            let Some((why, advice)) = self.refusal(&own) else {
                continue;
            };
            // A value that needs another key, such as a constant of another law, may be accepted together with it.
            let others = self.inputs.iter().filter(|other| other.key != input.key);
            let mut all = Vec::new();
            for other in others {
                let first = other.ends().into_iter().next();
                all.extend(first.map(|level| other.assignments(&self.folder, &level)));
            }
            all.push(own);
            if self.refusal(&all.concat()).is_some() {
                let key = &input.key;
                let value = match level {
                    Level::Number(number) => number.to_string(),
                    Level::Word(word) => format!("{word:?}"),
                };
                let (value, default) = match self.rejects_any_value(input, &why) {
                    true => (
                        String::new(),
                        "it rejects this key with any value; write in the case what is missing",
                    ),
                    false => (
                        format!(" = {value}"),
                        "choose values that the case accepts; a normal distribution is checked at four standard \
                         deviations, a truncated-normal one at its ends",
                    ),
                };
                let advice = Some(advice).filter(|advice| !advice.is_empty());
                let advice = advice.unwrap_or_else(|| default.to_owned());
                let message = format!("the case rejects `{key}{value}`: {why}");
                let fault = Fault::new(message, advice);
                log.problem(input.span.clone(), fault);
                break;
            }
        }
    }

    /// Returns whether the case rejects its own value of an input, or both ends of one that it leaves out, for this reason.
    fn rejects_any_value(&self, input: &Input, why: &str) -> bool {
        let own = self.value_of_case(input).map(|own| vec![own]);
        let values = own.unwrap_or_else(|| input.ends());
        values.iter().all(|value| {
            let refusal = self.refusal(&input.assignments(&self.folder, value));
            refusal.is_some_and(|(reason, _)| reason == why)
        })
    }

    /// Returns the reason why the case does not accept changes, and the remedy, which may be empty.
    fn refusal(&self, set: &[Assignment]) -> Option<(String, String)> {
        match self.changed_case(set) {
            Ok(_) => None,
            Err(ChangeError::Assignment(error)) => Some((error.to_string(), String::new())),
            Err(ChangeError::Case(problems)) => {
                let first = problems.problems().first()?;
                let advice = first.advice().unwrap_or_default();
                Some((first.to_string(), advice.to_owned()))
            }
        }
    }

    /// Reports a design that does not suit the inputs.
    fn check_design(&self, section: &Section<'_>, log: &mut Log<'_>) {
        let span = section.value_span("kind");
        let design = self.design.word();
        let is_sample = matches!(
            self.design,
            Design::LatinHypercube(_) | Design::Sobol(_) | Design::Adaptive(_)
        );
        if !self.correlations.is_empty() && !is_sample {
            let fault = Fault::new(
                format!("inputs of a design of the kind `{design}` cannot be correlated"),
                "use `kind = \"latin-hypercube\"` or `\"sobol\"`, or omit the correlation",
            );
            log.problem(span.clone(), fault);
        }
        if !self.alternatives.is_empty()
            && matches!(
                self.design,
                Design::Optimise(_) | Design::Adaptive(_) | Design::Saltelli(_) | Design::Morris(_)
            )
        {
            let fault = Fault::new(
                format!("alternatives cannot be compared in a design of the kind `{design}`"),
                "use `kind = \"latin-hypercube\"`, or omit the alternatives",
            );
            log.problem(span, fault);
        }
        match &self.design {
            Design::Optimise(keys) => self.check_search(keys, section, log),
            Design::Adaptive(keys) => self.check_adaptive(keys, section, log),
            Design::Morris(keys) if keys.levels % 2 == 1 => {
                let message = format!(
                    "a Morris design needs an even number of levels; {} is odd",
                    keys.levels
                );
                log.problem(
                    section.value_span("levels"),
                    Fault::new(message, "use 4, 6 or 8"),
                );
            }
            _ => {}
        }
    }

    /// Reports an aim that cannot be read, and inputs without an emulator.
    fn check_adaptive(&self, keys: &AdaptiveKeys, section: &Section<'_>, log: &mut Log<'_>) {
        let name = keys.known().split(' ').next().unwrap_or_default();
        let is_known = name.is_empty() || self.outputs.named(name, "until", section, log).is_some();
        if is_known && keys.aim(&self.outputs).is_none() {
            let problem = format!("`{}` does not state an output and its accuracy", keys.until);
            let advice = "write an output and a percentage from 0.01 to 50 %, such as `until = \"mass_loss_mg known to 1 \
                          %\"`, or a limit and a factor from 1.1 to 10, such as `until = \"peak_pressure_mpa above 40 known to \
                          a factor of 1.5\"`";
            log.problem(section.value_span("until"), Fault::new(problem, advice));
        }
        for input in &self.inputs {
            if matches!(&input.variation, Variation::Levels(keys) if !are_different_numbers(&keys.levels))
            {
                let problem = format!("an emulator needs numbers, and `{}` has none", input.key);
                let advice = "give a distribution, or two or more numbers as `levels`; compare words in separate studies";
                log.problem(input.span.clone(), Fault::new(problem, advice));
            }
        }
    }

    /// Reports outputs that a search cannot minimise, and inputs that it cannot choose.
    fn check_search(&self, keys: &OptimiseKeys, section: &Section<'_>, log: &mut Log<'_>) {
        if keys.minimise != PARETO {
            self.outputs.named(&keys.minimise, "minimise", section, log);
        } else if self.answers.pareto.is_none() {
            let fault = Fault::new(
                "a search for a Pareto front needs two outputs",
                "give `pareto = [\"mass_loss_mg\", \"peak_pressure_mpa\"]` in `[answers]`",
            );
            log.problem(section.value_span("minimise"), fault);
        }
        for input in &self.inputs {
            if let Some((problem, advice)) = unsearchable(input) {
                log.problem(input.span.clone(), Fault::new(problem, advice));
            }
        }
        let chosen = self.chosen();
        if chosen == 0 {
            let advice = "remove `disturbance = true` from an input with `low` and `high`";
            let fault = Fault::new("a search needs an input that is not a disturbance", advice);
            log.problem(section.span(), fault);
        }
        if keys.minimise == PARETO && chosen < self.inputs.len() {
            let advice =
                "minimise one of the outputs and limit the other, or remove `disturbance = true`";
            let fault = Fault::new("a robust search minimises one output", advice);
            log.problem(section.value_span("minimise"), fault);
        }
        if keys.percentile.is_some() && chosen == self.inputs.len() {
            let advice = "add `[[vary]]` with a distribution and `disturbance = true`, or omit the percentile";
            let fault = Fault::new("a percentile needs disturbances", advice);
            log.problem(section.value_span("percentile"), fault);
        }
    }
}

/// Returns the reason why a search can neither choose an input nor let it scatter, and the remedy.
fn unsearchable(input: &Input) -> Option<(String, &'static str)> {
    let key = &input.key;
    match &input.variation {
        Variation::Levels(_) if input.is_disturbance => {
            let problem = format!("a disturbance needs a distribution, and `{key}` has levels");
            Some((
                problem,
                "use `distribution = \"empirical\"` with `values`, or compare words as `[[alternative]]` designs",
            ))
        }
        _ if input.is_disturbance => None,
        Variation::Uniform(_) => None,
        Variation::Levels(keys) if are_different_numbers(&keys.levels) => None,
        _ => {
            let problem = format!("a search needs a range or numbers, and `{key}` has none");
            let advice = "give `low` and `high`, or two or more numbers as `levels`, or `disturbance = true` for an input that scatters; \
                 compare words as `[[alternative]]` designs";
            Some((problem, advice))
        }
    }
}

/// Returns whether levels are two or more numbers, each given once.
fn are_different_numbers(levels: &Levels) -> bool {
    let mut sorted = sorted_numbers(levels);
    sorted.dedup();
    sorted.len() == levels.0.len() && sorted.len() > 1
}
