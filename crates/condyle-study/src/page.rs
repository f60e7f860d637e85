//! The answers of a study as pictures and a page.

use std::{
    fs,
    io::{self, BufWriter, Write},
    path::Path,
};

use condyle_report::study::{
    Bar, Bars, Cloud, Distribution, StudyPage, bars_svg, clouds_svg, distributions_svg,
    write_study_page,
};

use crate::{
    answers::{
        Answers,
        effects::Effect,
        ranking::{Best, Front, Ranking},
        shown,
        spread::Spread,
    },
    error::StudyError,
    plan::Plan,
    store::Store,
};

/// Inputs that pictures show at most, those that matter most.
const MAX_INPUTS: usize = 12;
/// Inputs of a scatter matrix at most.
const MAX_COLUMNS: usize = 5;

/// Writes the pictures and `study.html` into `folder`.
pub(crate) fn write_page(answers: &Answers, folder: &Path) -> Result<(), StudyError> {
    let name = if answers.title.is_empty() {
        "A study"
    } else {
        answers.title.as_str()
    };
    let page = StudyPage {
        title: name.to_owned(),
        lede: lede(answers),
        tables: answers.tables(),
        pictures: pictures(answers),
    };
    write_study_page(folder, &page)?;
    Ok(())
}

fn lede(answers: &Answers) -> String {
    let failed: u64 = answers.failed.iter().map(|failed| failed.tests).sum();
    let fate = match failed {
        0 => "all of them came to their end".to_owned(),
        some => format!("{some} of them failed"),
    };
    format!(
        "{} tests of a {} design; {fate}.",
        answers.kept, answers.design
    )
}

type Picture = (&'static str, String, String);

fn pictures(answers: &Answers) -> Vec<Picture> {
    let all = [
        answers.ranking.as_ref().map(ranking),
        answers.best.as_ref().and_then(progress),
        indices(answers),
        elementary(answers),
        tornado(answers),
        distributions(answers),
        main_effects(answers),
        scatter(answers),
        answers.front.as_ref().and_then(front),
    ];
    all.into_iter().flatten().collect()
}

fn superscript(unit: &str) -> String {
    unit.replace('2', "\u{b2}").replace('3', "\u{b3}")
}

fn ranking(ranking: &Ranking) -> Picture {
    let bar = |design: &crate::answers::ranking::Designed| Bar {
        name: format!("{} (best in {:.0} %)", design.name, 100.0 * design.best),
        span: [0.0, design.mean],
        interval: Some([-1.96, 1.96].map(|by| design.mean + by * design.standard_deviation)),
    };
    let svg = bars_svg(&Bars {
        title: format!("Designs by {}", ranking.title),
        unit: superscript(ranking.unit),
        middle: None,
        bars: ranking.designs.iter().map(bar).collect(),
    });
    let said = "Mean over the disturbances, with 1.96 standard deviations to either side. Every design met the same \
                disturbances: the table says how often one beats another, which these intervals cannot.";
    ("ranking.svg", said.to_owned(), svg)
}

fn progress(best: &Best) -> Option<Picture> {
    if best.progress.is_empty() {
        return None;
    }
    let cloud = Cloud {
        title: "Best so far within all limits".to_owned(),
        unit: best.minimised.to_owned(),
        across: "test".to_owned(),
        marks: Vec::new(),
        points: Vec::new(),
        line: best.progress.clone(),
    };
    let svg = clouds_svg("Search", &[cloud], 1, ["", "best so far"]);
    Some((
        "search.svg",
        "What the search came to, test by test.".to_owned(),
        svg,
    ))
}

fn indices(answers: &Answers) -> Option<Picture> {
    let output = answers.indices.first()?.output;
    let own = answers.indices_of(output);
    let bar = |index: &crate::answers::indices::Indices| Bar {
        name: index.input.clone(),
        span: [0.0, index.total],
        interval: Some(index.total_interval),
    };
    let svg = bars_svg(&Bars {
        title: format!("Total index of Sobol: part of the variance of {output}"),
        unit: String::new(),
        middle: None,
        bars: own.into_iter().take(MAX_INPUTS).map(bar).collect(),
    });
    let said = "What part of the variance would remain if all inputs but this one were known, with 95 % intervals.";
    Some(("indices.svg", said.to_owned(), svg))
}

fn elementary(answers: &Answers) -> Option<Picture> {
    let output = answers.elementary.first()?.output;
    let own = answers.elementary_on(output);
    let bar = |one: &crate::answers::effects::Elementary| Bar {
        name: one.input.clone(),
        span: [0.0, one.mu_star],
        interval: Some([-1.0, 1.0].map(|by| one.mu_star + by * one.mu_star_half_interval)),
    };
    let svg = bars_svg(&Bars {
        title: format!("Elementary effects of Morris on {output}: mu*"),
        unit: String::new(),
        middle: None,
        bars: own.into_iter().take(MAX_INPUTS).map(bar).collect(),
    });
    let said = "By how much the output moves when an input goes from its low end to its high one, with 95 % intervals.";
    Some(("morris.svg", said.to_owned(), svg))
}

/// Effects on an output, the largest of them.
fn effects_on<'a>(answers: &'a Answers, output: &str) -> Vec<&'a Effect> {
    let mut own = answers.effects_on(output);
    own.truncate(MAX_INPUTS);
    own
}

fn tornado(answers: &Answers) -> Option<Picture> {
    let spread = answers.spreads.first()?;
    let bar = |effect: &&Effect| {
        let of_output = || effect.means.iter().map(|mean| mean.1);
        let low = of_output().fold(f64::INFINITY, f64::min);
        Bar {
            name: effect.name.clone(),
            span: [low, low + effect.span],
            interval: None,
        }
    };
    let bars: Vec<Bar> = effects_on(answers, spread.output).iter().map(bar).collect();
    if bars.is_empty() || bars.iter().any(|bar| !bar.span[0].is_finite()) {
        return None;
    }
    let svg = bars_svg(&Bars {
        title: format!("What moves {}", spread.title),
        unit: superscript(spread.unit),
        middle: Some(spread.mean),
        bars,
    });
    let by_chance = effects_on(answers, spread.output)
        .iter()
        .filter_map(|effect| effect.span_by_chance)
        .reduce(f64::max)
        .map(|most| {
            let unit = superscript(spread.unit);
            format!(
                " An input that does nothing would span up to {} {unit} by chance.",
                shown(most)
            )
        });
    let said = format!(
        "From the least to the most of the means over a tenth of each input's values, or at each of its levels; the line \
         is the mean of all tests.{}",
        by_chance.unwrap_or_default()
    );
    Some(("tornado.svg", said, svg))
}

fn distributions(answers: &Answers) -> Option<Picture> {
    let one = |spread: &Spread| Distribution {
        title: spread.title.to_owned(),
        unit: superscript(spread.unit),
        sorted: spread.sorted.clone(),
        marks: [1, 3, 5].map(|place| spread.percentiles[place]).to_vec(),
        limits: spread
            .beyond
            .iter()
            .flat_map(|beyond| beyond.least.into_iter().chain(beyond.most))
            .collect(),
    };
    let all: Vec<Distribution> = answers
        .spreads
        .iter()
        .filter(|spread| spread.tests > 1)
        .map(one)
        .collect();
    let said = if answers.spreads.iter().all(|spread| spread.is_sample) {
        "Percent of the tests; upright lines are the 5th, the 50th and the 95th percentile."
    } else {
        "Percent of the tests. They are no sample of what may happen: shares of them are no probabilities."
    };
    (!all.is_empty()).then(|| {
        (
            "distributions.svg",
            said.to_owned(),
            distributions_svg(&all),
        )
    })
}

fn main_effects(answers: &Answers) -> Option<Picture> {
    let spread = answers.spreads.first()?;
    let cloud = |effect: &&Effect| cloud(spread, effect, Vec::new(), effect.means.clone());
    let all: Vec<Cloud> = effects_on(answers, spread.output)
        .iter()
        .map(cloud)
        .collect();
    let said = format!(
        "Mean of {} over each input, in slices of a tenth of the tests or at each level.",
        spread.title
    );
    (!all.is_empty()).then(|| {
        (
            "main_effects.svg",
            said,
            clouds_svg("Main effects", &all, 4, ["", "mean"]),
        )
    })
}

fn scatter(answers: &Answers) -> Option<Picture> {
    let first = answers.spreads.first()?;
    let shown: Vec<String> = effects_on(answers, first.output)
        .iter()
        .take(MAX_COLUMNS)
        .map(|effect| effect.input.clone())
        .collect();
    let mut all = Vec::new();
    for spread in &answers.spreads {
        for input in &shown {
            let own = answers
                .effects
                .iter()
                .find(|one| one.output == spread.output && one.input == *input);
            all.extend(own.map(|effect| cloud(spread, effect, effect.points.clone(), Vec::new())));
        }
    }
    let svg = clouds_svg("Scatter matrix", &all, shown.len().max(3), ["tests", ""]);
    let said =
        "Every test, or some of many: outputs over the inputs that move the first of them most.";
    (!all.is_empty()).then(|| ("scatter.svg", said.to_owned(), svg))
}

fn cloud(
    spread: &Spread,
    effect: &Effect,
    points: Vec<(f64, f64)>,
    line: Vec<(f64, f64)>,
) -> Cloud {
    let marks = effect.words.iter().enumerate();
    Cloud {
        title: spread.title.to_owned(),
        unit: superscript(spread.unit),
        across: effect.name.clone(),
        marks: marks
            .map(|(place, word)| (place as f64, word.clone()))
            .collect(),
        points,
        line,
    }
}

fn front(front: &Front) -> Option<Picture> {
    if front.tests.is_empty() {
        return None;
    }
    let cloud = Cloud {
        title: front.titles[1].to_owned(),
        unit: superscript(front.units[1]),
        across: format!("{}, {}", front.titles[0], superscript(front.units[0])),
        marks: Vec::new(),
        points: front.others.clone(),
        line: front
            .tests
            .iter()
            .map(|(_, one, other)| (*one, *other))
            .collect(),
    };
    let svg = clouds_svg("Pareto front", &[cloud], 1, ["within limits", "the front"]);
    Some((
        "pareto.svg",
        "Tests within all limits; on the line, none is better in both.".to_owned(),
        svg,
    ))
}

/// What the study in `folder` tells.
///
/// # Errors
/// A folder without the study.
pub fn answer(plan: &Plan, folder: &Path) -> Result<Answers, StudyError> {
    Answers::of(plan, &Store::existing(folder, plan)?)
}

/// Writes `table.csv`, `answers.json`, the pictures and `study.html` of the study in `folder`, and gives what it tells.
///
/// # Errors
/// A folder without the study, or one that cannot be written.
pub fn write_answers(plan: &Plan, folder: &Path) -> Result<Answers, StudyError> {
    let store = Store::existing(folder, plan)?;
    let answers = Answers::of(plan, &store)?;
    store.export_csv(&folder.join("table.csv"))?;
    let json = serde_json::to_string_pretty(&answers).expect("numbers and text always serialise");
    write(&folder.join("answers.json"), &(json + "\n"))?;
    write_page(&answers, folder)?;
    Ok(answers)
}

impl Store {
    /// Writes the table into a file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn export_csv(&self, path: &Path) -> Result<(), StudyError> {
        let refused = |source| refused(path, source);
        let file = fs::File::create(path).map_err(refused)?;
        let mut out = BufWriter::new(file);
        self.write_csv(&mut out)?.map_err(refused)?;
        out.flush().map_err(refused)
    }
}

fn write(path: &Path, text: &str) -> Result<(), StudyError> {
    fs::write(path, text).map_err(|source| refused(path, source))
}

fn refused(path: &Path, source: io::Error) -> StudyError {
    let path = path.to_path_buf();
    StudyError::Refused { path, source }
}
