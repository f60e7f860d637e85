//! The answers of a study as pictures and a page.

use std::{iter::once, path::Path};

use condyle_case::study::Design;
use condyle_report::{
    Plot, plots_svg,
    study::{Bar, Distribution, bars_svg, distributions_svg, write_study_page},
};
use condyle_results::{json_text, replace_file, split_unit};
use serde::Serialize;

use crate::{
    answers::{
        Answers,
        data::{Spread, of_design},
        effects::Effect,
        emulated::Emulated,
        ranking::{Best, Front, Ranking},
        robust::Robust,
        words::{label, shown, sides_in_words},
    },
    error::StudyError,
    plan::Plan,
    statistics::{extent, mean, quantile},
    store::Store,
};

/// Number of inputs in a picture: those with the largest effects.
const MAX_INPUTS: usize = 24;
/// Number of inputs in a scatter matrix.
const MAX_COLUMNS: usize = 5;

/// Writes `table.csv`, `answers.json`, the pictures and `study.html` of the study in `folder`, and returns the answers.
///
/// # Errors
/// The folder does not hold the study, or it cannot be written.
pub fn write_answers(plan: &Plan, folder: &Path) -> Result<Answers, StudyError> {
    let store = Store::existing(folder, plan)?;
    let answers = Answers::read(plan, &store)?;
    store.export_csv(&folder.join("table.csv"))?;
    write_json(&folder.join("answers.json"), &answers)?;
    let emulators: Vec<_> = answers.emulated.iter().map(|one| &one.exported).collect();
    if !emulators.is_empty() {
        write_json(&folder.join("emulators.json"), &emulators)?;
    }
    let (kept, design) = (answers.kept, answers.design);
    let end = match answers.failed_tests() {
        0 => "none of them failed".to_owned(),
        some => format!("{some} of them failed"),
    };
    let title = Some(answers.title.as_str()).filter(|title| !title.is_empty());
    let doubts = answers.doubts().unwrap_or_default();
    let answer = answers.sentence().unwrap_or_default();
    let (all, study) = (plan.tests(), plan.study());
    // An adaptive study may know its output before its last test.
    let may_end = matches!(study.design, Design::Adaptive(_));
    let tests = match study.objectives().is_empty() {
        false => format!("A search of {kept} tests"),
        true if kept < all && !may_end => format!("{kept} of {all} tests, design {design}"),
        true => format!("{kept} tests, design {design}"),
    };
    let ended = answers.end_of_search().unwrap_or_default();
    let lede = format!("{answer} {tests}; {end}. {ended} {doubts}");
    let lede = lede.trim();
    let (mut tables, pictures) = (answers.tables(&answers.designs()), pictures(&answers));
    tables.push(("What was tested".to_owned(), tested(plan)));
    write_study_page(folder, title.unwrap_or("A study"), lede, &tables, &pictures)?;
    Ok(answers)
}

/// Returns the table of what was tested, within which limits, and with which version.
fn tested(plan: &Plan) -> Vec<Vec<String>> {
    let study = plan.study();
    let limits = study.answers.bounds.iter().flat_map(|bound| {
        let is_used = study.is_robust() || !study.alternatives.is_empty();
        let probability = match is_used {
            true => format!("probability {}", bound.probability),
            false => String::new(),
        };
        sides_in_words(bound).map(move |words| (format!("limit: {words}"), probability.clone()))
    });
    let version = concat!("condyle ", env!("CARGO_PKG_VERSION"));
    let written = [
        ("version", version),
        ("hash of the inputs", plan.inputs_blake3()),
    ];
    let written = written.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let all = study.described().into_iter().chain(limits).chain(written);
    let head = ("what".to_owned(), "value".to_owned());
    let rows = once(head).chain(all);
    rows.map(|(name, value)| vec![name, value]).collect()
}

fn write_json(path: &Path, content: &impl Serialize) -> Result<(), StudyError> {
    replace_file(path, json_text(content).as_bytes()).map_err(StudyError::refused(path))
}

/// The file, its caption, and its text.
type Picture = (&'static str, String, String);

/// Returns the pictures of each design, the one that ranks first before the others; their files are numbered from the second design
/// on.
fn of_designs(answers: &Answers) -> impl Iterator<Item = (String, String, String)> {
    let designs = answers.designs().into_iter().enumerate();
    designs.flat_map(move |(place, design)| {
        let all = [indices, tornado, main_effects].map(|draw| draw(answers, design));
        all.into_iter().flatten().map(move |(file, caption, svg)| {
            let file = match place {
                0 => file.to_owned(),
                _ => file.replace(".svg", &format!("_{}.svg", place + 1)),
            };
            (file, caption, svg)
        })
    })
}

fn pictures(answers: &Answers) -> Vec<(String, String, String)> {
    // The front is the answer of a search for it, and one more picture of other studies.
    let of_front = |is_searched| {
        let own = answers.front.as_ref();
        own.filter(|own| own.is_searched == is_searched)
            .and_then(front)
    };
    let first = [
        answers
            .ranking
            .as_ref()
            .filter(|ranking| ranking.solved > 0)
            .map(ranking),
        answers.best.as_ref().and_then(progress),
        answers.robust.as_ref().map(robust),
        of_front(true),
        elementary(answers),
    ];
    let last = [
        distributions(answers),
        scatter(answers),
        emulators(answers),
        of_front(false),
    ];
    let [first, last] = [first.to_vec(), last.to_vec()].map(|some| {
        let some = some.into_iter().flatten();
        some.map(|(file, caption, svg)| (file.to_owned(), caption, svg))
    });
    first.chain(of_designs(answers)).chain(last).collect()
}

/// Powers in units as they are printed.
pub(crate) fn superscript(unit: &str) -> String {
    unit.replace('2', "\u{b2}").replace('3', "\u{b3}")
}

fn ranking(ranking: &Ranking) -> Picture {
    let designs = ranking.designs.iter().map(|design| Bar {
        name: format!("{} (best in {:.0} %)", design.name, 100.0 * design.best),
        span: [0.0, design.mean],
        interval: Some([-1.96, 1.96].map(|by| design.mean + by * design.standard_deviation)),
        is_grey: false,
    });
    let title = format!("Designs by {}", ranking.title);
    let (solved, compared) = (ranking.solved, ranking.disturbances);
    let over = match solved == compared {
        true => "the disturbances".to_owned(),
        false => format!(
            "the {solved} of {compared} disturbances under which every design could be solved"
        ),
    };
    let caption = format!(
        "Mean over {over}, with 1.96 standard deviations to either side. Every design met the same disturbances: the table \
         states how often one beats another, which these intervals cannot."
    );
    let bars: Vec<Bar> = designs.collect();
    let svg = bars_svg(&title, &superscript(ranking.unit), None, &bars);
    ("ranking.svg", caption, svg)
}

fn progress(best: &Best) -> Option<Picture> {
    if best.progress.is_empty() {
        return None;
    }
    let label = label(best.minimised);
    let plot = Plot {
        title: format!("Best {label} so far within all limits"),
        unit: superscript(split_unit(best.minimised).1.unwrap_or_default()),
        x_title: "test".to_owned(),
        line: best.progress.clone(),
        ..Plot::default()
    };
    let svg = plots_svg("Search", &[plot], 1, &["", "", "best so far"]);
    Some(("search.svg", "The progress of the search.".to_owned(), svg))
}

fn robust(robust: &Robust) -> Picture {
    let both = [
        ("robust optimum", &robust.comparison.optimum),
        ("first design", &robust.comparison.first),
    ];
    let bars = both.map(|(name, design)| Bar {
        name: name.to_owned(),
        span: [0.0, design.statistic.value],
        interval: Some([0.05, 0.95].map(|share| quantile(&design.outputs, share))),
        is_grey: false,
    });
    let caption = format!(
        "The {} under the disturbances; the lines go from the 5th to the 95th percentile of the predicted output.",
        robust.statistic
    );
    let svg = bars_svg(&robust.statistic, &superscript(robust.unit), None, &bars);
    ("robust.svg", caption, svg)
}

fn indices(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let all = answers.largest_indices(design).into_iter().next()?;
    let title = format!(
        "Total Sobol index: part of the variance of {}",
        all.first()?.title()
    );
    let most = all.into_iter().take(MAX_INPUTS).map(|index| Bar {
        name: answers.name_of(&index.input).to_owned(),
        span: [0.0, index.total],
        interval: Some(index.total_interval),
        is_grey: index.total_interval[0] <= 0.0,
    });
    let caption = "The part of the variance that would remain if all other inputs were known, with 95 % intervals; bars whose interval \
                   contains 0 are grey.";
    let svg = bars_svg(&title, "", None, &most.collect::<Vec<_>>());
    Some(("indices.svg", caption.to_owned(), svg))
}

fn elementary(answers: &Answers) -> Option<Picture> {
    let all = answers.largest_elementary();
    let title = format!(
        "Elementary effects of Morris on {}: mu*",
        label(all.first()?.output)
    );
    let most = all.into_iter().take(MAX_INPUTS).map(|one| Bar {
        name: answers.name_of(&one.input).to_owned(),
        span: [0.0, one.mu_star],
        interval: one
            .mu_star_half_interval
            .map(|half| [one.mu_star - half, one.mu_star + half]),
        is_grey: false,
    });
    let caption = "The change of the output as an input goes from its low end to its high end, with 95 % intervals.";
    let svg = bars_svg(&title, "", None, &most.collect::<Vec<_>>());
    Some(("morris.svg", caption.to_owned(), svg))
}

fn tornado(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let spread = answers.first_spread(design)?;
    let mut effects = answers.main_effects_on(spread.output, design);
    effects.truncate(MAX_INPUTS);
    let all = effects.iter().map(|effect| {
        let [low, _] = extent(effect.means.iter().map(|mean| mean.1));
        Bar {
            name: effect.name.clone(),
            span: [low, low + effect.span],
            interval: None,
            is_grey: effect
                .span_by_chance
                .is_some_and(|most| effect.span <= most),
        }
    });
    let all: Vec<Bar> = all.collect();
    if all.is_empty() || all.iter().any(|bar| !bar.span[0].is_finite()) {
        return None;
    }
    let title = format!("Effects on {}", spread.name());
    let mut caption = "The range of the means over a tenth of each input's values, or at each of its levels; the line is \
                       the mean output."
        .to_owned();
    let by_chance = effects.iter().filter_map(|effect| effect.span_by_chance);
    if let Some(most) = by_chance.reduce(f64::max) {
        let (most, unit) = (shown(most), superscript(spread.unit));
        caption += &format!(
            " An inactive input would span up to {most} {unit} by chance or by the error of the emulator; bars within that are grey."
        );
    }
    let means: Vec<f64> = effects.iter().map(|effect| effect.mean).collect();
    let svg = bars_svg(&title, &superscript(spread.unit), Some(mean(&means)), &all);
    Some(("tornado.svg", caption, svg))
}

fn distributions(answers: &Answers) -> Option<Picture> {
    let several = answers.spreads.iter().filter(|spread| spread.tests > 1);
    let all = several.map(|spread| Distribution {
        output: spread.output,
        title: spread.name(),
        unit: superscript(spread.unit),
        sorted: spread.sorted.clone(),
        marks: [1, 3, 5].map(|place| spread.percentiles[place]).to_vec(),
        limits: spread
            .beyond
            .iter()
            .flat_map(|beyond| beyond.least.into_iter().chain(beyond.most))
            .collect(),
    });
    let all: Vec<Distribution> = all.collect();
    let caption = if answers.spreads.iter().all(|spread| spread.is_sample) {
        "Percent of the tests; the vertical lines are the 5th, the 50th and the 95th percentile."
    } else {
        "Percent of the tests. They are not a random sample, so fractions of them are not probabilities."
    };
    if all.is_empty() {
        return None;
    }
    let svg = distributions_svg(&all);
    Some(("distributions.svg", caption.to_owned(), svg))
}

fn main_effects(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let spread = answers.first_spread(design)?;
    let effects = answers.main_effects_on(spread.output, design);
    let is_emulated = effects.iter().any(|effect| effect.is_emulated);
    let all: Vec<Plot> = effects
        .into_iter()
        .take(MAX_INPUTS)
        .map(|effect| Plot {
            line: effect.means.clone(),
            ..plot(spread, effect)
        })
        .collect();
    let of = if is_emulated {
        "the emulator's predictions of "
    } else {
        ""
    };
    let caption = format!(
        "Mean of {of}{} over each input, in slices of a tenth of its values or at each level.",
        spread.name()
    );
    if all.is_empty() {
        return None;
    }
    let title = of_design("Main effects", design);
    let svg = plots_svg(&title, &all, 4, &["", "", "mean"]);
    Some(("main_effects.svg", caption, svg))
}

fn scatter(answers: &Answers) -> Option<Picture> {
    let first = answers.spreads.first()?;
    let columns = answers.effects_on(first.output, answers.designs()[0]);
    let columns = &columns[..columns.len().min(MAX_COLUMNS)];
    let mut all = Vec::new();
    let outputs = answers
        .spreads
        .chunk_by(|one, next| one.output == next.output);
    for designs in outputs {
        for column in columns {
            let points = designs.iter().map(|spread| {
                let mut own = answers
                    .effects
                    .iter()
                    .filter(|one| one.output == spread.output);
                let own = own.find(|one| one.input == column.input && one.design == spread.design);
                own.map(|effect| effect.points.clone()).unwrap_or_default()
            });
            all.push(Plot {
                clouds: points.collect(),
                ..plot(&designs[0], column)
            });
        }
    }
    if all.is_empty() {
        return None;
    }
    let caption = "Outputs over the inputs that affect the first of them most; of many tests, some are shown.";
    // The spreads of an output are those of its designs.
    let designs = answers
        .spreads
        .iter()
        .filter(|one| one.output == first.output);
    let names = designs.map(|one| one.design.as_deref().unwrap_or("tests"));
    let keys: Vec<&str> = once("").chain(names).chain([""]).collect();
    let svg = plots_svg("Scatter matrix", &all, columns.len().max(3), &keys);
    Some(("scatter.svg", caption.to_owned(), svg))
}

fn emulators(answers: &Answers) -> Option<Picture> {
    let plot = |one: &Emulated| {
        let [low, high] = extent(one.tested_and_predicted.iter().map(|both| both.0));
        Plot {
            title: of_design(one.title, one.design.as_deref()),
            unit: superscript(one.unit),
            x_title: format!("tested (Q2 {:.4})", one.q2),
            clouds: vec![one.tested_and_predicted.clone()],
            reference: vec![(low, low), (high, high)],
            ..Plot::default()
        }
    };
    let all: Vec<Plot> = answers.emulated.iter().map(plot).collect();
    if all.is_empty() {
        return None;
    }
    let keys = ["equal", "predicted from all other tests", ""];
    let svg = plots_svg("Emulators", &all, 2, &keys);
    let caption =
        "Each test as the emulator predicts it from all others: on the line, both are equal.";
    Some(("emulators.svg", caption.to_owned(), svg))
}

/// Returns the axes of an output over an input.
fn plot(spread: &Spread, effect: &Effect) -> Plot {
    let marks = effect.words.iter().enumerate();
    Plot {
        title: spread.title.to_owned(),
        unit: superscript(spread.unit),
        x_title: effect.name.clone(),
        x_marks: marks
            .map(|(place, word)| (place as f64, word.clone()))
            .collect(),
        ..Plot::default()
    }
}

fn front(front: &Front) -> Option<Picture> {
    if front.tests.is_empty() {
        return None;
    }
    let [unit, up_unit] = front.units.map(superscript);
    let tests = front.tests.iter();
    let plot = Plot {
        title: front.titles[1].to_owned(),
        unit: up_unit,
        x_title: format!("{}, {unit}", front.titles[0]),
        clouds: vec![front.others.clone()],
        line: tests.map(|(_, one, other)| (*one, *other)).collect(),
        reference: lines_to_knee(front).unwrap_or_default(),
        ..Plot::default()
    };
    let key = if front.knee.is_some() {
        "ends and knee"
    } else {
        ""
    };
    let svg = plots_svg(
        "Pareto front",
        &[plot],
        1,
        &[key, "within limits", "the front"],
    );
    let mut caption =
        "Tests within all limits; no test is better in both outputs than one on the front."
            .to_owned();
    if let Some(part) = front.hypervolume {
        let percent = 100.0 * part;
        caption += &format!(
            " The front dominates {percent:.1} % of the rectangle from its best to the worst values (its hypervolume), \
             which further tests widen."
        );
    }
    Some(("pareto.svg", caption, svg))
}

/// Returns lines from the ends of a front to its knee.
fn lines_to_knee(front: &Front) -> Option<Vec<(f64, f64)>> {
    let knee = front.tests.get(front.place_of_knee()?);
    let corners = [front.tests.first(), knee, front.tests.last()];
    let corners = corners.into_iter().flatten();
    Some(corners.map(|(_, one, other)| (*one, *other)).collect())
}
