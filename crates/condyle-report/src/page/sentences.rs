//! The sentences of the page that depend on the results.

use condyle_results::{
    PlausibilityWarning,
    catalogue::{
        CYCLES, INCREMENTS, MASS_LOSS_MG, Scalar, UPDATES, VOLUME_LOSS_MESH_MM3, VOLUME_LOSS_MM3,
    },
};

use crate::number::{
    cycles_in_words, first_letter_large, fixed, in_words, significant, with_powers,
};
use crate::results::{CaseFacts, Region, Results, Table};
use crate::scene::Scene;

/// The version of condyle that makes this page.
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Changes of the wear rate below this count as none, %.
const MIN_CHANGE_PERCENT: f64 = 0.5;
const MILLION: f64 = 1e6;

/// Returns a number of the summary; for an unfinished run, the number in the last row of wear.csv.
pub(super) fn reached(results: &Results, scalar: &Scalar) -> Option<f64> {
    let summary = results.summary.as_ref();
    let stated = summary.and_then(|summary| summary.get(scalar));
    stated.or_else(|| results.wear.as_ref()?.column(scalar.key)?.last().copied())
}

/// Returns the result in two sentences; for an unfinished run, the result so far.
pub(super) fn lede(results: &Results, case: &CaseFacts) -> Option<String> {
    let cycles = reached(results, &CYCLES)?;
    let mass_mg = reached(results, &MASS_LOSS_MG)?;
    let done = cycles_in_words(cycles);
    let asked = case.cycles.filter(|asked| *asked > cycles);
    let of = asked.map(|asked| format!(" of {}", cycles_in_words(asked)));
    let volume = reached(results, &VOLUME_LOSS_MM3);
    let volume = volume.map(|volume| format!("{} mm\u{b3}", significant(volume, 3)));
    let facts: Vec<String> = volume.into_iter().chain(laboratories(results)).collect();
    let facts = match facts.as_slice() {
        [] => String::new(),
        facts => format!(" ({})", facts.join("; ")),
    };
    let rate = (cycles > 0.0).then(|| significant(mass_mg * MILLION / cycles, 3));
    let rate = rate.map(|rate| format!(", {rate} mg in a million cycles on average"));
    let [_, bearing] = results.directions().joint.bodies();
    Some(format!(
        "After {done}{} cycles the {bearing} has lost {} mg{}{}.{}",
        of.unwrap_or_default(),
        significant(mass_mg, 3),
        facts,
        rate.unwrap_or_default(),
        deepest(results).unwrap_or_default()
    ))
}

/// Returns the interval of the mass that laboratories would weigh; none if it is that of another law.
fn laboratories(results: &Results) -> Option<String> {
    let prediction = results.summary.as_ref()?.prediction.as_ref()?;
    let interval = prediction.interval(&MASS_LOSS_MG)?;
    let [low, high] = [interval.low, interval.high].map(|value| significant(value, 2));
    let is_of_run = prediction.is_of_run;
    is_of_run.then(|| format!("90 % of laboratories: {low} to {high} mg"))
}

fn deepest(results: &Results) -> Option<String> {
    let surface = results.surface.as_ref()?;
    let values = surface.field("wear_depth_mm")?;
    let regions = Region::all_of(results.directions()).into_iter();
    let deepest = regions.filter_map(|(region, name)| {
        let found = surface.largest(values, region)?;
        Some((found.value, name))
    });
    let (depth, name) = deepest.reduce(|one, other| if other.0 > one.0 { other } else { one })?;
    (depth > 0.0).then(|| {
        let (depth, name) = (significant(depth, 3), name.to_lowercase());
        let side = if name.is_empty() { name } else { name + ", " };
        format!(" The deepest point is {side}{depth} mm deep.")
    })
}

/// States that a run has no summary, or a damaged one, and the remedy.
pub(super) fn unfinished(results: &Results) -> Option<&'static str> {
    let is_begun = results.wear.is_some() || results.surface.is_some();
    if results
        .left_out
        .iter()
        .any(|why| why.contains("summary.json"))
    {
        return Some(
            "The file summary.json is damaged: the numbers have not been checked for plausibility. Restore it from a copy, or run \
             the case again.",
        );
    }
    (results.summary.is_none() && is_begun).then_some(
        "This run is not finished, or its next cycle could not be solved: there is no summary.json, and the numbers have not \
         been checked for plausibility. Continue it with condyle run and --resume.",
    )
}

/// A doubt or a note.
pub(super) struct Finding {
    pub message: String,
    pub advice: String,
}

/// Returns the plausibility warnings of the summary, and the errors that it could not estimate.
pub(super) fn doubts(results: &Results) -> Vec<Finding> {
    let summary = results.summary.iter();
    let warnings = summary.flat_map(|summary| &summary.plausibility);
    let doubtful = warnings.map(finding);
    let advice = "The stated discretisation error does not include it.";
    let unknown = not_estimated(results).into_iter();
    let unknown = unknown.map(|message| Finding {
        message,
        advice: advice.to_owned(),
    });
    doubtful.chain(unknown).collect()
}

fn finding(found: &PlausibilityWarning) -> Finding {
    Finding {
        message: ended(&first_letter_large(&found.message)),
        advice: with_powers(&found.advice),
    }
}

/// Returns the remarks on the physics that leave the numbers sound.
pub(super) fn notes(results: &Results) -> Vec<Finding> {
    let notes = results.summary.iter().flat_map(|summary| &summary.notes);
    notes.map(finding).collect()
}

/// Returns the origin of the interval of the mass, in two sentences.
pub(super) fn interval(results: &Results) -> Option<String> {
    let prediction = results.summary.as_ref()?.prediction.as_ref()?;
    let sources = prediction.sources_in_words('×');
    let measured = prediction.measured.iter();
    let measured: String = measured
        .map(|measured| format!(" {}.", first_letter_large(measured)))
        .collect();
    Some(format!(
        "The interval of the mass is due to these factors, either way: {sources}.{measured}"
    ))
}

/// Warnings and corrections from reading the case and its meshes.
pub(super) fn warnings(results: &Results) -> Vec<String> {
    let warnings = results.summary.iter().flat_map(|summary| &summary.warnings);
    warnings.map(|warning| ended(warning)).collect()
}

fn ended(text: &str) -> String {
    let text = with_powers(text);
    if text.ends_with('.') {
        text
    } else {
        text + "."
    }
}

/// Returns the reasons why parts of the discretisation error have no estimate, one sentence each.
pub(super) fn not_estimated(results: &Results) -> Vec<String> {
    let summaries = results.summary.iter();
    let errors = summaries.filter_map(|summary| summary.error.as_ref());
    let reasons = errors.flat_map(|error| &error.not_estimated);
    let sentence = |(part, why): (&String, &String)| {
        let part = part.replace('_', " ");
        format!("The error from {part} could not be estimated: {why}.")
    };
    reasons.map(sentence).collect()
}

/// Returns the change of wear per cycle over the test; none without wear.
pub(super) fn rate(results: &Results) -> Option<String> {
    let rates = rates_mg_per_million(results.wear.as_ref()?)?;
    let (first, last) = (*rates.first()?, *rates.last()?);
    let [from, to] = [first, last].map(|rate| significant(rate, 3));
    if rates.len() == 1 {
        return Some(format!(
            "One solved cycle represents the whole test: {from} mg in a million cycles throughout"
        ));
    }
    let percent = 100.0 * (last / first - 1.0);
    if percent.abs() < MIN_CHANGE_PERCENT {
        return Some(format!(
            "Wear per cycle stayed the same, {to} mg in a million cycles"
        ));
    }
    let verb = if percent > 0.0 { "grew" } else { "fell" };
    let change = fixed(percent.abs(), usize::from(percent.abs() < 10.0));
    Some(format!(
        "Wear per cycle {verb} by {change}\u{a0}% from the first interval to the last, from {from} to {to} mg in a million cycles"
    ))
}

/// Mass lost in a million cycles in each interval between updates; none if one has no cycles or no wear.
fn rates_mg_per_million(wear: &Table) -> Option<Vec<f64>> {
    let ends = wear
        .column("cycles")?
        .iter()
        .zip(wear.column("mass_loss_mg")?);
    let (mut rates, mut before) = (Vec::new(), (0.0, 0.0));
    for (&cycles, &mass_mg) in ends.filter(|(cycles, _)| **cycles > 0.0) {
        rates.push(MILLION * (mass_mg - before.1) / (cycles - before.0));
        before = (cycles, mass_mg);
    }
    let is_usable = rates.iter().all(|rate| rate.is_finite() && *rate > 0.0);
    is_usable.then_some(rates)
}

/// Files of the folder that contradict each other or come from another version, a sentence each.
pub(super) fn disagreements(results: &Results) -> Vec<String> {
    let mut found = Vec::new();
    let summary = results.summary.as_ref();
    let number = |scalar| summary.and_then(|summary| summary.get(scalar));
    let version = summary.map_or("", |summary| &summary.version);
    if !version.is_empty() && version != VERSION {
        found.push(format!(
            "The run is from condyle {version} and this page from {VERSION}: numbers that this version names differently or \
             that the other did not write are not shown."
        ));
    }
    let rows = results.wear.as_ref().map(Table::rows);
    if let Some((stated, rows)) = number(&UPDATES).zip(rows)
        && stated != rows as f64
    {
        found.push(format!(
            "summary.json states {stated} updates, and wear.csv has {rows}: one of them is cut short or from another run."
        ));
    }
    let table = results.kinematics.as_ref();
    let cycles = table.and_then(|table| table.column("cycles"));
    if let Some((stated, cycles)) = number(&INCREMENTS).zip(cycles) {
        let lengths = cycles.chunk_by(|one, next| one == next).map(<[f64]>::len);
        let other = lengths.into_iter().find(|length| *length as f64 != stated);
        found.extend(other.map(|length| {
            format!(
                "summary.json states {stated} increments per cycle, and kinematics.csv has a cycle of {length}: one of them is \
                 cut short or from another run."
            )
        }));
    }
    found
}

/// Returns the difference between the two values of the worn volume, and its reason.
pub(super) fn volume_check(results: &Results) -> Option<String> {
    let summary = results.summary.as_ref()?;
    let depth = summary.get(&VOLUME_LOSS_MM3)?;
    let mesh = summary.get(&VOLUME_LOSS_MESH_MM3)?;
    let percent = 100.0 * (mesh - depth).abs() / depth.abs().max(mesh.abs()).max(f64::MIN_POSITIVE);
    Some(format!(
        "The two values of the worn volume differ by {}\u{a0}%: depth times area takes each node's share of the surface at the \
         start of its interval, while the volume of the mesh includes the curvature and the growth of the surface during \
         the interval. Mass is from the former.",
        fixed(percent, 2)
    ))
}

/// Versions, then hashes, under any key that contains these words.
pub(super) fn provenance(results: &Results) -> Vec<(String, String)> {
    let is_hash = |name: &str| name.contains("hash") || name.contains("blake3");
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let own = [
        ("version", summary.version.as_str()),
        ("inputs_blake3", summary.inputs_blake3.as_str()),
    ];
    let others = summary.others.iter();
    let others = others.filter_map(|(key, value)| Some((key.as_str(), value.as_str()?)));
    let all = own.into_iter().chain(others);
    let named =
        all.filter(|(key, value)| !value.is_empty() && (key.contains("version") || is_hash(key)));
    let fact = |(key, value): (&str, &str)| {
        (
            in_words(key).0.replace("blake3", "(BLAKE3)"),
            value.to_owned(),
        )
    };
    let mut facts: Vec<_> = named.map(fact).collect();
    facts.sort_by_key(|(name, _)| is_hash(&name.to_lowercase()));
    facts
}

/// Returns the files that are not in the folder; damaged ones are omitted with reasons.
pub(super) fn missing(results: &Results) -> Vec<&'static str> {
    let files = [
        ("summary.json", results.summary.is_none()),
        ("wear.csv", results.wear.is_none()),
        ("kinematics.csv", results.kinematics.is_none()),
        ("slip_paths.csv", results.slip_paths.is_none()),
        ("insert_*.vtu", results.surface.is_none()),
        ("case.toml", results.case.is_none()),
    ];
    let is_damaged = |name: &str| {
        // Meshes have a number in place of the star.
        let begin = name.split('*').next().unwrap_or(name);
        results.left_out.iter().any(|why| why.contains(begin))
    };
    let missing = files.into_iter().filter(|(_, is_missing)| *is_missing);
    let missing = missing.filter(|(name, _)| !is_damaged(name));
    missing.map(|(name, _)| name).collect()
}

/// Returns the files that could not be read, with reasons, each once.
pub(super) fn left_out(results: &Results, scene: Option<&Scene>) -> Vec<String> {
    let mut all = results.left_out.clone();
    for why in scene.into_iter().flat_map(|scene| &scene.missing) {
        if !all.contains(why) {
            all.push(why.clone());
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn stated(rows: &str) -> Option<String> {
        let text = format!("cycles,mass_loss_mg\n{rows}");
        let wear = Table::parse(&text, Path::new("wear.csv")).expect("is a table");
        rate(&Results {
            wear: Some(wear),
            ..Results::default()
        })
    }

    #[test]
    fn a_rate_that_grows_or_falls_is_stated_from_the_numbers() {
        let grows = stated("1000000,10\n2000000,20\n3000000,32").expect("has wear");
        assert!(
            grows.contains("grew by 20\u{a0}%") && grows.contains("from 10.0 to 12.0 mg"),
            "{grows}"
        );
        let falls = stated("0,0\n1000000,10\n2000000,19.3").expect("has wear");
        assert!(falls.contains("fell by 7.0\u{a0}%"), "{falls}");
        let same = stated("1000000,10\n2000000,20.01").expect("has wear");
        assert!(same.contains("stayed the same"), "{same}");
        let alone = stated("5000000,50").expect("has wear");
        assert!(
            alone.contains("One solved cycle represents the whole test: 10.0 mg"),
            "{alone}"
        );
    }

    #[test]
    fn without_wear_no_rate_is_stated() {
        assert_eq!(stated(""), None);
        assert_eq!(stated("1000000,0\n2000000,0"), None);
    }
}
