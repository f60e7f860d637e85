//! The sentences of the page that depend on the results.

use serde::Serialize;

use condyle_results::catalogue::{
    CYCLES, MASS_LOSS_MG, Scalar, VOLUME_LOSS_MESH_MM3, VOLUME_LOSS_MM3,
};

use super::key_words::in_words;
use crate::number::{cycles, fixed, significant};
use crate::results::{case::cycles_asked, contents::Results, measure::Region};
use crate::scene::Scene;

/// The result in two sentences; of a run that is not finished, as far as it is.
pub(super) fn lede(results: &Results) -> Option<String> {
    let reached = Reached::of(results)?;
    let mut text = format!(
        "After {} gait cycles the insert has lost {} mg",
        reached.cycles_in_words(results),
        significant(reached.mass_loss_mg, 3)
    );
    if let Some(volume) = reached.volume_loss_mm3 {
        text += &format!(" ({} mm\u{b3})", significant(volume, 3));
    }
    if reached.cycles > 0.0 {
        text += &format!(
            ", {} mg in a million cycles on average",
            significant(reached.mass_loss_mg * 1e6 / reached.cycles, 3)
        );
    }
    text += ".";
    Some(text + &deepest(results).unwrap_or_default())
}

/// How far a run is, and what it has lost.
struct Reached {
    cycles: f64,
    mass_loss_mg: f64,
    volume_loss_mm3: Option<f64>,
}

impl Reached {
    /// As the summary says; without one, as the last row of wear.csv says.
    fn of(results: &Results) -> Option<Self> {
        let last = |key: &str| results.wear.as_ref()?.column(key)?.last().copied();
        let number = |scalar: &Scalar| match &results.summary {
            Some(summary) => summary.get(scalar),
            None => last(scalar.key),
        };
        Some(Self {
            cycles: number(&CYCLES)?,
            mass_loss_mg: number(&MASS_LOSS_MG)?,
            volume_loss_mm3: number(&VOLUME_LOSS_MM3),
        })
    }

    /// "2 of 5 million", where the case asks for more.
    fn cycles_in_words(&self, results: &Results) -> String {
        let asked = results.case.as_deref().and_then(cycles_asked);
        match asked.filter(|asked| *asked > self.cycles) {
            Some(asked) => format!("{} of {}", cycles(self.cycles), cycles(asked)),
            None => cycles(self.cycles),
        }
    }
}

/// That a run has no summary yet, and what to do.
pub(super) fn unfinished(results: &Results) -> Option<&'static str> {
    let is_begun = results.wear.is_some() || results.surface.is_some();
    (results.summary.is_none() && is_begun).then_some(
        "This run is not finished, or the physics of its next cycle could not be solved: there is no summary.json, and nothing \
         has judged whether these numbers are to be believed. Go on with condyle run and --resume.",
    )
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

/// How far the two counts of the worn volume differ, and why.
pub(super) fn volume_check(results: &Results) -> Option<String> {
    let summary = results.summary.as_ref()?;
    let depth = summary.get(&VOLUME_LOSS_MM3)?;
    let mesh = summary.get(&VOLUME_LOSS_MESH_MM3)?;
    let percent = 100.0 * (mesh - depth).abs() / depth.abs().max(mesh.abs()).max(f64::MIN_POSITIVE);
    Some(format!(
        "The two counts of the volume differ by {}\u{a0}%: depth times area takes each node's share of the surface as large as \
         it was at the start of its interval, and the mesh is counted as it bends and grows on the way down. Mass is from the \
         first.",
        fixed(percent, 2)
    ))
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
    let own = [
        ("version", summary.version.as_str()),
        ("inputs_blake3", summary.inputs_blake3.as_str()),
    ];
    let others = summary.others.iter();
    let others = others.filter_map(|(key, value)| Some((key.as_str(), value.as_str()?)));
    let all = own.into_iter().chain(others);
    let origins =
        all.filter(|(key, value)| !value.is_empty() && (key.contains("version") || is_hash(key)));
    let mut facts: Vec<_> = origins
        .map(|(key, value)| Fact {
            name: in_words(key).0.replace("blake3", "(BLAKE3)"),
            value: value.to_owned(),
        })
        .collect();
    facts.sort_by_key(|fact| is_hash(&fact.name.to_lowercase()));
    facts
}

fn is_hash(name: &str) -> bool {
    name.contains("hash") || name.contains("blake3")
}

/// Files of the contract that the folder does not hold.
pub(super) fn missing(results: &Results) -> Vec<&'static str> {
    [
        ("summary.json", results.summary.is_none()),
        ("wear.csv", results.wear.is_none()),
        ("kinematics.csv", results.kinematics.is_none()),
        ("slip_paths.csv", results.slip_paths.is_none()),
        ("insert_*.vtu", results.surface.is_none()),
        ("case.toml", results.case.is_none()),
    ]
    .into_iter()
    .filter_map(|(name, gone)| gone.then_some(name))
    .collect()
}

/// What could not be read, and why, each once.
pub(super) fn left_out(results: &Results, scene: Option<&Scene>) -> Vec<String> {
    let mut all = results.left_out.clone();
    for why in scene.into_iter().flat_map(|scene| &scene.missing) {
        if !all.contains(why) {
            all.push(why.clone());
        }
    }
    all
}
