//! What may be written behind a key.

use std::fmt;

use super::value::quoted_list;

/// What may be written behind a key; its `Display` says it in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A number without a fraction.
    WholeNumber,
    /// 1 or -1.
    Sign,
    /// True or false.
    Truth,
    /// Any text.
    Text,
    /// Where a file is.
    Path,
    /// One of a few words.
    Word(Vec<&'static str>),
    /// Three words, each one of a few.
    ThreeWords(&'static [&'static str]),
    /// Any names.
    Names,
    /// Numbers or words, one or more.
    Levels,
    /// Two numbers.
    TwoNumbers,
    /// Three numbers.
    ThreeNumbers,
    /// Any number of pairs of numbers.
    Pairs,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number => f.write_str("a number"),
            Self::WholeNumber => f.write_str("a whole number"),
            Self::Sign => f.write_str("1 or -1"),
            Self::Truth => f.write_str("true or false"),
            Self::Text => f.write_str("text in quotes"),
            Self::Path => f.write_str("a path in quotes"),
            Self::Word(words) => f.write_str(&quoted_list(words)),
            Self::ThreeWords(words) => write!(f, "three words of {}", quoted_list(words)),
            Self::Names => f.write_str("a list of names in quotes"),
            Self::Levels => f.write_str("a list of numbers or of words in quotes"),
            Self::TwoNumbers => f.write_str("a list of two numbers"),
            Self::ThreeNumbers => f.write_str("a list of three numbers"),
            Self::Pairs => f.write_str("a list of pairs of numbers"),
        }
    }
}
