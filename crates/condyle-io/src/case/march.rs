//! The march over the life of the insert.

use super::declared::{AutoUpdates, FixedUpdates, UpdateWord, WholeTest};
use super::keys::{Key, Settings};
use super::parse::{Log, Others, Section, names};
use super::setting::Setting;
use super::to_toml::Writer;

/// The march over the life of the insert.
#[derive(Clone, Debug, PartialEq)]
pub struct March {
    /// Gait cycles in all.
    pub cycles: u64,
    /// When the worn shape is brought up to date.
    pub update: Update,
}

/// When the worn shape is brought up to date.
#[derive(Clone, Debug, PartialEq)]
pub enum Update {
    /// So many times, evenly over the cycles.
    Fixed(FixedUpdates),
    /// As seldom as a tolerance on the maximum depth allows.
    Auto(AutoUpdates),
}

/// The key that chooses when the shape is updated.
pub(super) const UPDATE: Key = Key {
    name: "update",
    doc: "How often the worn shape is brought up to date: evenly, or as a tolerance on depth asks for.",
    kind: <UpdateWord as Setting>::kind,
    default: Some(|| Some("\"fixed\"".to_owned())),
    limits: None,
};

impl March {
    /// Words for `update` and the keys each brings.
    pub(super) const UPDATES: &'static [(&'static str, &'static [Key])] =
        &[("fixed", FixedUpdates::KEYS), ("auto", AutoUpdates::KEYS)];

    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let word = section.setting(&UPDATE, Some(UpdateWord::Fixed), log)?;
        check_keys(section, word, log);
        let test = WholeTest::read(section, log);
        let update = match word {
            UpdateWord::Fixed => Update::Fixed(FixedUpdates::read(section, log)?),
            UpdateWord::Auto => Update::Auto(AutoUpdates::read(section, log)?),
        };
        Some(Self {
            cycles: test?.cycles,
            update,
        })
    }

    pub(super) fn write(&self, out: &mut Writer) {
        WholeTest {
            cycles: self.cycles,
        }
        .write(out);
        match &self.update {
            Update::Fixed(fixed) => {
                out.setting(&UPDATE, &UpdateWord::Fixed);
                fixed.write(out);
            }
            Update::Auto(by_depth) => {
                out.setting(&UPDATE, &UpdateWord::Auto);
                by_depth.write(out);
            }
        }
    }
}

fn check_keys(section: &Section<'_>, word: UpdateWord, log: &mut Log<'_>) {
    let own = March::UPDATES.iter().filter(|(own, _)| *own == word.word());
    let keys = own.flat_map(|(_, keys)| names(keys));
    let known: Vec<&str> = names(WholeTest::KEYS)
        .chain([UPDATE.name])
        .chain(keys)
        .collect();
    let others = Others {
        key: UPDATE.name,
        word: word.word(),
        all: March::UPDATES,
    };
    section.check_keys(&known, &others, log);
}
