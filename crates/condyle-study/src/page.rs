//! The answers of a study as pictures and a page.

use std::{iter::once, path::Path};

use condyle_case::study::Design;
use condyle_report::{
    Plot, plots_svg,
    study::{Bar, Distribution, bars_svg, distributions_svg, with_powers, write_study_page},
};
use condyle_results::{json_text, replace_file};
use serde::Serialize;

use crate::{
    answers::{
        Answers, TestsByReason,
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
    let end = match TestsByReason::count(&answers.failed) {
        0 => "none of them failed".to_owned(),
        some => format!("{some} of them failed"),
    };
    let title = Some(answers.title.as_str()).filter(|title| !title.is_empty());
    let doubts = answers.doubts().unwrap_or_default();
    let answer = answers.sentence();
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
type Picture = (String, String, String);

/// Returns a picture of bars; none without a bar.
fn of_bars(
    file: &str,
    [title, unit]: [&str; 2],
    middle: Option<f64>,
    bars: &[Bar],
    caption: &str,
) -> Option<Picture> {
    let svg = || bars_svg(title, &with_powers(unit), middle, bars);
    (!bars.is_empty()).then(|| (file.to_owned(), caption.to_owned(), svg()))
}

/// Returns a picture of plots in `columns`; none without a plot.
fn of_plots(
    file: &str,
    title: &str,
    plots: &[Plot],
    columns: usize,
    keys: &[&str],
    caption: &str,
) -> Option<Picture> {
    let svg = || plots_svg(title, plots, columns, keys);
    (!plots.is_empty()).then(|| (file.to_owned(), caption.to_owned(), svg()))
}

fn pictures(answers: &Answers) -> Vec<Picture> {
    // The front is the answer of a search for it, and one more picture of other studies.
    let of_front = |is_searched| {
        let own = answers.front.as_ref();
        own.filter(|own| own.is_searched == is_searched)
            .and_then(front)
    };
    let first = [
        answers.ranking.as_ref().and_then(ranking),
        answers.best.as_ref().and_then(progress),
        answers.robust.as_ref().and_then(robust),
        of_front(true),
        elementary(answers),
    ];
    let last = [
        distributions(answers),
        scatter(answers),
        emulators(answers),
        of_front(false),
    ];
    let first = first.into_iter().flatten().chain(of_designs(answers));
    first.chain(last.into_iter().flatten()).collect()
}

/// Returns the pictures of each design, the one that ranks first before the others; their files are numbered from the second design
/// on.
fn of_designs(answers: &Answers) -> impl Iterator<Item = Picture> {
    let designs = (1..).zip(answers.designs());
    designs.flat_map(move |(number, design)| {
        let all = [indices, tornado, main_effects].map(|draw| draw(answers, design));
        all.into_iter().flatten().map(move |(file, caption, svg)| {
            let file = match number {
                1 => file,
                _ => file.replace(".svg", &format!("_{number}.svg")),
            };
            (file, caption, svg)
        })
    })
}

fn ranking(ranking: &Ranking) -> Option<Picture> {
    let (solved, compared) = (ranking.solved, ranking.disturbances);
    let designs = ranking.designs.iter().filter(|_| solved > 0);
    let designs = designs.map(|design| Bar {
        name: format!("{} (best in {:.0} %)", design.name, 100.0 * design.best),
        span: [0.0, design.mean],
        interval: Some([-1.96, 1.96].map(|by| design.mean + by * design.standard_deviation)),
        is_grey: false,
    });
    let title = format!("Designs by {}", ranking.title);
    let over = match solved == compared {
        true => "the disturbances".to_owned(),
        false => format!(
            "the {solved} of {compared} disturbances under which every design could be solved"
        ),
    };
    let mut caption = format!("Mean over {over}, with 1.96 standard deviations to either side.");
    if ranking.designs.len() > 1 {
        caption += " Every design met the same disturbances: the table states how often one beats another, which these intervals cannot.";
    }
    let bars: Vec<Bar> = designs.collect();
    of_bars("ranking.svg", [&title, ranking.unit], None, &bars, &caption)
}

fn progress(best: &Best) -> Option<Picture> {
    best.progress.first()?;
    let label = label(best.minimised);
    let plot = Plot {
        title: format!("Best {label} so far within all limits"),
        unit: with_powers(best.unit),
        x_title: "test".to_owned(),
        line: best.progress.clone(),
        ..Plot::default()
    };
    let (keys, caption) = (["", "", "best so far"], "The progress of the search.");
    of_plots("search.svg", "Search", &[plot], 1, &keys, caption)
}

fn robust(robust: &Robust) -> Option<Picture> {
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
    let statistic = &robust.statistic;
    let caption = format!(
        "The {statistic} under the disturbances; the lines go from the 5th to the 95th percentile of the predicted output."
    );
    of_bars(
        "robust.svg",
        [statistic, robust.unit],
        None,
        &bars,
        &caption,
    )
}

fn indices(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let all = answers.largest_indices(design);
    let output = all.first()?.title();
    let title = format!("Total Sobol index: part of the variance of {output}");
    let most = all.into_iter().take(MAX_INPUTS).map(|index| Bar {
        name: answers.name_of(&index.input).to_owned(),
        span: [0.0, index.total],
        interval: Some(index.total_interval),
        is_grey: index.total_interval[0] <= 0.0,
    });
    let caption = "The part of the variance that would remain if all other inputs were known, with 95 % intervals; bars whose interval \
                   contains 0 are grey.";
    let bars: Vec<Bar> = most.collect();
    of_bars("indices.svg", [&title, ""], None, &bars, caption)
}

fn elementary(answers: &Answers) -> Option<Picture> {
    let all = answers.largest_elementary();
    let output = label(all.first()?.output);
    let title = format!("Elementary effects of Morris on {output}: mu*");
    let most = all.into_iter().take(MAX_INPUTS).map(|one| {
        let half = one.mu_star_half_interval;
        Bar {
            name: answers.name_of(&one.input).to_owned(),
            span: [0.0, one.mu_star],
            interval: half.map(|half| [one.mu_star - half, one.mu_star + half]),
            is_grey: false,
        }
    });
    let caption = "The change of the output as an input goes from its low end to its high end, with 95 % intervals.";
    let bars: Vec<Bar> = most.collect();
    of_bars("morris.svg", [&title, ""], None, &bars, caption)
}

fn tornado(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let spread = answers.first_spread(design)?;
    let mut effects = answers.main_effects_on(spread.output, design);
    effects.truncate(MAX_INPUTS);
    let all = effects.iter().map(|effect| {
        let [low, _] = extent(effect.means.iter().map(|mean| mean.1));
        let by_chance = effect.span_by_chance;
        Bar {
            name: effect.name.clone(),
            span: [low, low + effect.span],
            interval: None,
            is_grey: by_chance.is_some_and(|most| effect.span <= most),
        }
    });
    let mut caption = "The range of the means over a tenth of each input's values, or at each of its levels; the line is \
                       the mean output."
        .to_owned();
    let by_chance = effects.iter().filter_map(|effect| effect.span_by_chance);
    if let Some(most) = by_chance.reduce(f64::max) {
        let (most, unit) = (shown(most), with_powers(spread.unit));
        caption += &format!(
            " An inactive input would span up to {most} {unit} by chance or by the error of the emulator; bars within that are grey."
        );
    }
    let title = format!("Effects on {}", spread.in_words());
    let means: Vec<f64> = effects.iter().map(|effect| effect.mean).collect();
    let (middle, all) = (Some(mean(&means)), all.collect::<Vec<Bar>>());
    of_bars("tornado.svg", [&title, spread.unit], middle, &all, &caption)
}

fn distributions(answers: &Answers) -> Option<Picture> {
    let several = answers.spreads.iter().filter(|spread| spread.tests > 1);
    let all = several.map(|spread| Distribution {
        output: spread.output,
        title: spread.name(),
        unit: with_powers(spread.unit),
        sorted: spread.sorted.clone(),
        marks: [1, 3, 5]
            .map(|place| spread.distribution.percentiles[place])
            .to_vec(),
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
    let file = "distributions.svg".to_owned();
    (!all.is_empty()).then(|| (file, caption.to_owned(), distributions_svg(&all)))
}

fn main_effects(answers: &Answers, design: Option<&str>) -> Option<Picture> {
    let spread = answers.first_spread(design)?;
    let effects = answers.main_effects_on(spread.output, design);
    let of = match effects.iter().any(|effect| effect.is_emulated) {
        true => "the emulator's predictions of ",
        false => "",
    };
    let all = effects.into_iter().take(MAX_INPUTS).map(|effect| Plot {
        line: effect.means.clone(),
        ..plot(spread, effect)
    });
    let caption = format!(
        "Mean of {of}{} over each input, in slices of a tenth of its values or at each level.",
        spread.in_words()
    );
    let title = of_design("Main effects", design);
    let (all, keys) = (all.collect::<Vec<_>>(), ["", "", "mean"]);
    of_plots("main_effects.svg", &title, &all, 4, &keys, &caption)
}

fn scatter(answers: &Answers) -> Option<Picture> {
    let first = answers.spreads.first()?;
    let columns = answers.effects_on(first.output, answers.designs()[0]);
    let columns = &columns[..columns.len().min(MAX_COLUMNS)];
    let mut all = Vec::new();
    let outputs = answers
        .spreads
        .chunk_by(|one, next| one.output == next.output);
    for designs in outputs.clone() {
        for column in columns {
            let points = designs.iter().map(|spread| {
                let mut effects = answers.effects.iter();
                let own = effects.find(|one| {
                    (one.output, &one.design) == (spread.output, &spread.design)
                        && one.input == column.input
                });
                own.map(|effect| effect.points.clone()).unwrap_or_default()
            });
            all.push(Plot {
                clouds: points.collect(),
                ..plot(&designs[0], column)
            });
        }
    }
    let caption = "Outputs over the inputs that affect the first of them most; of many tests, some are shown.";
    // The spreads of an output are those of its designs.
    let designs = outputs
        .flatten()
        .take_while(|one| one.output == first.output);
    let names = designs.map(|one| one.design.as_deref().unwrap_or("tests"));
    let keys: Vec<&str> = once("").chain(names).chain([""]).collect();
    let most = columns.len().max(3);
    of_plots("scatter.svg", "Scatter matrix", &all, most, &keys, caption)
}

fn emulators(answers: &Answers) -> Option<Picture> {
    let plot = |one: &Emulated| {
        let [low, high] = extent(one.tested_and_predicted.iter().map(|both| both.0));
        Plot {
            title: of_design(one.title, one.design.as_deref()),
            unit: with_powers(one.unit),
            x_title: format!("tested (Q2 {:.4})", one.q2),
            clouds: vec![one.tested_and_predicted.clone()],
            reference: vec![(low, low), (high, high)],
            ..Plot::default()
        }
    };
    let all: Vec<Plot> = answers.emulated.iter().map(plot).collect();
    let keys = ["equal", "predicted from all other tests", ""];
    let caption =
        "Each test as the emulator predicts it from all others: on the line, both are equal.";
    of_plots("emulators.svg", "Emulators", &all, 2, &keys, caption)
}

/// Returns the axes of an output over an input.
fn plot(spread: &Spread, effect: &Effect) -> Plot {
    let marks = (0..).map(f64::from).zip(effect.words.iter().cloned());
    Plot {
        title: spread.title.to_owned(),
        unit: with_powers(spread.unit),
        x_title: effect.name.clone(),
        x_marks: marks.collect(),
        ..Plot::default()
    }
}

fn front(front: &Front) -> Option<Picture> {
    let [unit, up_unit] = front.units.map(with_powers);
    let both = |(_, one, other): &(u64, f64, f64)| (*one, *other);
    let (first, last) = (front.tests.first()?, front.tests.last()?);
    let knee = front.place_of_knee().map(|place| &front.tests[place]);
    let to_knee = knee.map_or_else(Vec::new, |knee| [first, knee, last].map(both).to_vec());
    let plot = Plot {
        title: front.titles[1].to_owned(),
        unit: up_unit,
        x_title: format!("{}, {unit}", front.titles[0]),
        clouds: vec![front.others.clone()],
        line: front.tests.iter().map(both).collect(),
        reference: to_knee,
        ..Plot::default()
    };
    let key = match knee {
        Some(_) => "ends and knee",
        None => "",
    };
    let keys = [key, "within limits", "the front"];
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
    of_plots("pareto.svg", "Pareto front", &[plot], 1, &keys, &caption)
}
