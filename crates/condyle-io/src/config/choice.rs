//! Values that are one of a few words, each declared once.

/// Declares a value that is one of a few words.
macro_rules! choice {
    ($(
        $(#[doc = $about:literal])+
        $name:ident {
            $( $(#[doc = $doc:literal])+ $variant:ident = $word:literal, )+
        }
    )+) => { $(
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $( $(#[doc = $doc])+ $variant, )+
        }

        impl $name {
            /// Every one of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Every word a file may use.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// The word a file uses for it.
            pub fn word(self) -> &'static str {
                match self { $( Self::$variant => $word, )+ }
            }

            /// What it is, in one sentence.
            pub fn about(self) -> &'static str {
                match self { $( Self::$variant => concat!($($doc),+).trim(), )+ }
            }

            /// The choice that `word` stands for.
            pub fn from_word(word: &str) -> Option<Self> {
                match word { $( $word => Some(Self::$variant), )+ _ => None }
            }
        }

        impl $crate::config::setting::Setting for $name {
            fn kind() -> $crate::config::kind::Kind {
                $crate::config::kind::Kind::Word(Self::WORDS.to_vec())
            }

            fn read(
                value: &toml::Spanned<toml::de::DeValue<'_>>,
                key: &$crate::config::key::Key,
                log: &mut $crate::config::log::Log<'_>,
            ) -> Option<Self> {
                let word = $crate::config::words::read_word(value, key, Self::WORDS, log)?;
                Self::from_word(word)
            }

            fn text(&self) -> Option<String> {
                Some(format!("{:?}", self.word()))
            }
        }
    )+ };
}

pub(crate) use choice;
