//! Entries of declared tables: they define a table for the reader, the schema and the book.

use super::fault::{explain, other_choice};
use super::key::{Key, Kind, WhereSilent};
use super::problem::Log;
use super::section::Section;
use super::setting::read_word;

/// An entry of a declared table.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Key(Key),
    Choice(Choices),
    Table(TableItem),
    /// Exactly one of these keys must be given.
    OneOf(Vec<&'static str>),
    /// One of these keys may be given.
    AtMostOne(Vec<&'static str>),
    /// The first key needs the second.
    Needs(&'static str, &'static str),
}

#[derive(Clone, Debug)]
pub(crate) struct TableItem {
    pub name: &'static str,
    pub about: String,
    pub items: Vec<Item>,
    /// The file may have several, each headed `[[name]]`.
    pub is_list: bool,
}

impl TableItem {
    pub fn new(name: &'static str, about: &str, items: Vec<Item>) -> Self {
        Self {
            name,
            about: about.trim().to_owned(),
            items,
            is_list: false,
        }
    }
}

/// A key that determines the other entries of its table, such as `shape`.
#[derive(Clone, Debug)]
pub(crate) struct Choices {
    pub by: Key,
    pub offered: Vec<Offered>,
    pub default: &'static str,
}

/// A word of a choice and its entries.
#[derive(Clone, Debug)]
pub(crate) struct Offered {
    pub word: &'static str,
    pub items: Vec<Item>,
}

impl Choices {
    pub fn new(
        name: &'static str,
        doc: &'static str,
        default: &'static str,
        offered: Vec<Offered>,
    ) -> Self {
        let words: Vec<&'static str> = offered.iter().map(|offer| offer.word).collect();
        debug_assert!(words.contains(&default), "{name} offers its default");
        let by = Key {
            name,
            doc: doc.trim().into(),
            kind: Kind::Word(words),
            silent: WhereSilent::Takes(format!("{default:?}")),
            limits: None,
        };
        Self {
            by,
            offered,
            default,
        }
    }

    /// Returns the word that `section` gives, or the default; reports a word that is not offered.
    pub fn read(&self, section: &Section<'_>, log: &mut Log<'_>) -> Option<&'static str> {
        let report = || read_word(section.value(self.by.name)?, &self.by, &self.words(), log);
        self.word_in(section).or_else(report)
    }

    fn words(&self) -> Vec<&'static str> {
        self.offered.iter().map(|offer| offer.word).collect()
    }

    /// As [`Self::read`], without reports.
    fn word_in(&self, section: &Section<'_>) -> Option<&'static str> {
        let Some(value) = section.value(self.by.name) else {
            return Some(self.default);
        };
        let written = value.get_ref().as_str()?;
        self.words().into_iter().find(|word| *word == written)
    }

    /// Returns the word that offers the entry `name`, if `chosen` does not.
    pub fn other_owner(&self, name: &str, chosen: &str) -> Option<&'static str> {
        let has = |offer: &&Offered| offer.items.iter().any(|item| item.name() == Some(name));
        let mut offered = self.offered.iter();
        if self
            .offered
            .iter()
            .any(|offer| offer.word == chosen && has(&offer))
        {
            return None;
        }
        offered.find(has).map(|offer| offer.word)
    }

    /// Returns the default of the key `name` if `word` is chosen; none of other entries.
    pub fn default_of(&self, name: &str, word: &str) -> Option<&WhereSilent> {
        let offered = self.offered.iter().find(|offer| offer.word == word)?;
        offered.items.iter().find_map(|item| match item {
            Item::Key(key) if key.name == name => Some(&key.silent),
            _ => None,
        })
    }

    pub fn assignment(&self, word: &str) -> String {
        format!("{} = \"{word}\"", self.by.name)
    }
}

impl Item {
    /// Returns the entry as one that may be omitted.
    pub fn optional(mut self) -> Self {
        if let Self::Key(key) = &mut self {
            key.silent = WhereSilent::LeftOut;
        }
        self
    }

    pub fn name(&self) -> Option<&'static str> {
        match self {
            Self::Key(key) => Some(key.name),
            Self::Choice(choices) => Some(choices.by.name),
            Self::Table(table) => Some(table.name),
            Self::OneOf(_) | Self::AtMostOne(_) | Self::Needs(..) => None,
        }
    }
}

/// Returns the keys among `items`, without those that a choice brings.
pub(crate) fn keys(items: &[Item]) -> Vec<&Key> {
    let mut keys = Vec::new();
    for item in items {
        match item {
            Item::Key(key) => keys.push(key),
            Item::Choice(choices) => keys.push(&choices.by),
            Item::Table(_) | Item::OneOf(_) | Item::AtMostOne(_) | Item::Needs(..) => {}
        }
    }
    keys
}

/// Reports every key and table of `section`, and of the tables inside it, that is none of `items`.
pub(crate) fn check(section: &Section<'_>, items: &[Item], log: &mut Log<'_>) {
    let mut valid: Vec<&Item> = Vec::new();
    let mut chosen: Vec<(&Choices, &'static str)> = Vec::new();
    for item in items {
        valid.push(item);
        if let Item::Choice(choices) = item {
            let word = choices.word_in(section);
            // An unknown word is reported elsewhere; the keys that belong here are then unknown.
            let is_chosen = |offer: &&Offered| word.is_none_or(|word| word == offer.word);
            let offered = choices.offered.iter().filter(is_chosen);
            valid.extend(offered.flat_map(|offer| &offer.items));
            chosen.extend(word.map(|word| (choices, word)));
        }
    }
    let known: Vec<&str> = valid.iter().filter_map(|item| item.name()).collect();
    for (key, value) in section.other_keys(&known) {
        let name: &str = key.get_ref();
        let owner = chosen.iter().find_map(|(choices, word)| {
            let owner = choices.other_owner(name, word)?;
            Some((choices.assignment(owner), choices.assignment(word)))
        });
        let reason = match owner {
            Some((owner, chosen)) => {
                let table = section.part(name).name();
                let shown = value.as_table().map_or(name, |_| table.as_str());
                other_choice(shown, &owner, &chosen)
            }
            None => explain(name, value, &section.name(), &known),
        };
        log.problem(key.span(), reason);
    }
    for item in valid {
        if let Item::Table(table) = item {
            for inside in section.tables(table.name) {
                check(&inside, &table.items, log);
            }
        }
    }
}
