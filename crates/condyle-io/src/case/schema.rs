//! The page of the book that lists every key.

use std::fmt::Write;

use condyle::machine::{JointKind, knee::KNEE};

use super::channel::Channel;
use super::contact;
use super::declared::{
    Accuracy, Friction, Heading, MachineSettings, Material, Rotation, Springs, Time, Translation,
    Wear, WholeTest,
};
use super::keys::{Key, Settings};
use super::machine::PRESET;
use super::march::{March, UPDATE};
use super::shapes::{FEMUR_SHAPE, INSERT_SHAPE};
use super::waveforms::{WaveformSource, knots_doc};
use super::{Femur, Insert, unit_of};

/// Every key of a case file with its unit, range, default and meaning, as Markdown.
pub fn schema_markdown() -> String {
    let mut page = String::from(OPENING);
    section(&mut page, "Top of the file", &[Heading::KEYS]);
    body(&mut page, "[femur]", FEMUR_SHAPE, Femur::SHAPES);
    body(&mut page, "[insert]", INSERT_SHAPE, Insert::SHAPES);
    section(&mut page, "[material]", &[Material::KEYS]);
    let law = [contact::LAW];
    section(
        &mut page,
        "[contact]",
        &[&law, contact::TABULATED, Friction::KEYS],
    );
    section(&mut page, "[machine]", &[&[PRESET], MachineSettings::KEYS]);
    section(&mut page, "[machine.springs]", &[Springs::KEYS]);
    section(
        &mut page,
        &freedoms(JointKind::Translation),
        &[Translation::KEYS],
    );
    section(&mut page, &freedoms(JointKind::Rotation), &[Rotation::KEYS]);
    waveforms(&mut page);
    section(&mut page, "[wear]", &[Wear::KEYS]);
    chosen(
        &mut page,
        "[march]",
        &[WholeTest::KEYS, &[UPDATE]],
        "update",
        March::UPDATES,
    );
    section(&mut page, "[time]", &[Time::KEYS]);
    section(&mut page, "[accuracy]", &[Accuracy::KEYS]);
    page
}

const OPENING: &str = "\
# The case file

A case is a TOML file. Every key that has a default may be left out; every number has its unit in
its name; paths count from the folder of the case file. This page is made from the declarations
that the program reads a case with.
";

/// The tables of all freedoms of a kind, such as `[machine.freedoms.ap], .ml and .is`.
fn freedoms(kind: JointKind) -> String {
    let joints = KNEE.in_files.into_iter().map(|index| KNEE.joint(index));
    let names: Vec<&str> = joints
        .filter(|joint| joint.kind() == kind)
        .map(|joint| joint.name)
        .collect();
    let others = names[1..].iter().map(|name| format!(".{name}"));
    let others: Vec<String> = others.collect();
    let first = format!("[machine.freedoms.{}]", names[0]);
    match others.split_last() {
        Some((last, between)) => {
            let listed = [&[first], between].concat().join(", ");
            format!("{listed} and {last}")
        }
        None => first,
    }
}

fn section(page: &mut String, title: &str, keys: &[&[Key]]) {
    page.push_str(&format!("\n## `{title}`\n\n").replace("`Top of the file`", "Top of the file"));
    table(page, keys);
}

fn table(page: &mut String, keys: &[&[Key]]) {
    page.push_str("| key | unit | may be | default | meaning |\n| --- | --- | --- | --- | --- |\n");
    keys.iter()
        .copied()
        .flatten()
        .for_each(|key| row(page, key));
}

fn row(page: &mut String, key: &Key) {
    let unit = unit_of(key.name).unwrap_or("");
    let range = match &key.limits {
        Some(limits) => format!("{}, {limits}", (key.kind)()),
        None => (key.kind)(),
    };
    let default = match key.default.map(|default| default()) {
        Some(Some(text)) => format!("`{text}`"),
        Some(None) => "none".to_owned(),
        None => "must be given".to_owned(),
    };
    let doc = key.doc.trim();
    let written = writeln!(
        page,
        "| `{}` | {unit} | {range} | {default} | {doc} |",
        key.name
    );
    debug_assert!(written.is_ok(), "writing to a String does not fail");
}

fn body(page: &mut String, title: &str, shape: Key, shapes: &[(&str, &[Key])]) {
    chosen(page, title, &[&[shape]], "shape", shapes);
}

/// A table whose other keys depend on the word that the key `by` has.
fn chosen(page: &mut String, title: &str, keys: &[&[Key]], by: &str, words: &[(&str, &[Key])]) {
    section(page, title, keys);
    for (word, keys) in words {
        page.push_str(&format!("\nWith `{by} = \"{word}\"`:\n\n"));
        table(page, &[keys]);
    }
}

fn waveforms(page: &mut String) {
    let named = |channel: Channel| format!("`[machine.{}]`", channel.name());
    let tables: Vec<String> = Channel::all().map(named).collect();
    page.push_str(&format!("\n## Waveforms: {}\n\n", tables.join(", ")));
    page.push_str(
        "One of `waveform`, `file` or the points themselves. A freedom takes the one its drive \
         needs; one for another drive is an error.\n\n",
    );
    table(page, &[WaveformSource::KEYS]);
    page.push_str("\n| table | points | unit | values may be | named | what |\n| --- | --- | --- | --- | --- | --- |\n");
    for channel in Channel::all() {
        let (key, unit) = knots_doc(channel);
        let words: Vec<&str> = channel.named().iter().map(|named| named.word).collect();
        page.push_str(&format!(
            "| `{}` | `{}` | {unit} | {} | {} | {} |\n",
            channel.name(),
            key.name,
            channel.limits(),
            words.join(", "),
            channel.about(),
        ));
    }
}
