//! The sentences of the page that depend on the results.

use serde::Serialize;

use crate::number::{cycles, fixed, significant};
use crate::results::{contents::Results, measure::Region, summary::Summary};

/// The result in two sentences.
pub(super) fn lede(results: &Results) -> Option<String> {
    let summary = results.summary.as_ref()?;
    let (count, mass) = (summary.number("cycles")?, summary.number("mass_loss_mg")?);
    let mut text = format!(
        "After {} gait cycles the insert has lost {} mg",
        cycles(count),
        significant(mass, 3)
    );
    if let Some(volume) = summary.number("volume_loss_mm3") {
        text += &format!(" ({} mm\u{b3})", significant(volume, 3));
    }
    if count > 0.0 {
        text += &format!(
            ", {} mg in a million cycles",
            significant(mass * 1e6 / count, 3)
        );
    }
    text += ".";
    Some(text + &deepest(results).unwrap_or_default())
}

fn deepest(results: &Results) -> Option<String> {
    let surface = results.surface.as_ref()?;
    let values = surface.field("wear_depth_mm")?;
    let [left, right] = [Region::Left, Region::Right].map(|region| {
        surface
            .largest(values, region)
            .map_or(0.0, |found| found.value)
    });
    let deeper = usize::from(right > left);
    let side = results.side.regions()[deeper].to_lowercase();
    let depth = left.max(right);
    (depth > 0.0).then(|| {
        format!(
            " The deepest point is {side}, {} mm deep.",
            significant(depth, 3)
        )
    })
}

/// How far the two counts of the worn volume differ.
pub(super) fn volume_check(results: &Results) -> Option<String> {
    let summary = results.summary.as_ref()?;
    let depth = summary.number("volume_loss_mm3")?;
    let mesh = summary.number("volume_loss_mesh_mm3")?;
    let percent = 100.0 * (mesh - depth).abs() / depth.abs().max(mesh.abs()).max(f64::MIN_POSITIVE);
    Some(format!(
        "The two counts of the volume differ by {}\u{a0}%.",
        fixed(percent, 2)
    ))
}

/// Why the numbers are to be doubted, and what to do.
#[derive(Serialize)]
pub(super) struct Doubt {
    message: String,
    advice: String,
}

/// What makes the run doubtful, as the summary says.
pub(super) fn doubts(results: &Results) -> Vec<Doubt> {
    let warnings = results.summary.as_ref().map(Summary::plausibility);
    let warnings = warnings.unwrap_or_default().into_iter();
    let doubts = warnings.map(|warning| Doubt {
        message: first_letter_large(&warning.message),
        advice: warning.advice,
    });
    doubts.collect()
}

/// A fact about the run's origin.
#[derive(Serialize)]
pub(super) struct Fact {
    name: String,
    value: String,
}

/// Versions, then hashes, whatever they are called.
pub(super) fn provenance(results: &Results) -> Vec<Fact> {
    let Some(summary) = &results.summary else {
        return Vec::new();
    };
    let mut facts: Vec<_> = summary
        .entries()
        .filter(|(key, _)| key.contains("version") || key.contains("hash"))
        .filter_map(|(key, value)| {
            let name = first_letter_large(&key.replace('_', " "));
            Some(Fact {
                name,
                value: value.as_str()?.to_owned(),
            })
        })
        .collect();
    facts.sort_by_key(|fact| fact.name.to_lowercase().contains("hash"));
    facts
}

fn first_letter_large(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

/// Files of the contract that the folder does not hold.
pub(super) fn missing(results: &Results) -> Vec<&'static str> {
    [
        ("summary.json", results.summary.is_none()),
        ("wear.csv", results.wear.is_none()),
        ("kinematics.csv", results.kinematics.is_none()),
        ("insert_*.vtu", results.surface.is_none()),
        ("case.toml", results.case.is_none()),
    ]
    .into_iter()
    .filter_map(|(name, gone)| gone.then_some(name))
    .collect()
}
