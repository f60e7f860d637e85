//! The writer of Abaqus keywords, lines and numbers.

use std::io::{self, Write};

/// Writes Abaqus keywords to a file or to memory, in the order of the calls.
///
/// Every method gives the errors of the writer it writes to. Units are whatever the caller is
/// consistent in; condyle uses mm, N, s, MPa, tonne.
#[derive(Debug)]
pub struct InpWriter<W: Write> {
    pub(super) out: W,
}

impl<W: Write> InpWriter<W> {
    /// A writer that begins with nothing.
    pub fn new(out: W) -> Self {
        Self { out }
    }

    /// Gives back what was written to.
    pub fn into_inner(self) -> W {
        self.out
    }

    /// `*HEADING` with its text.
    pub fn heading(&mut self, text: &str) -> io::Result<()> {
        self.keyword("*HEADING")?;
        text.lines().try_for_each(|line| self.line(line))
    }

    /// A comment, a line of `**` for each line of text.
    pub fn comment(&mut self, text: &str) -> io::Result<()> {
        text.lines()
            .try_for_each(|line| writeln!(self.out, "** {line}"))
    }

    /// A keyword line as it stands.
    pub fn keyword(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{text}")
    }

    /// A data line; one that starts like a keyword would be taken for one.
    pub fn line(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.out, "{}", text.trim_start_matches('*'))
    }

    /// A data line of numbers.
    pub fn reals(&mut self, values: &[f64]) -> io::Result<()> {
        let words: Vec<String> = values.iter().map(|&value| real(value)).collect();
        writeln!(self.out, "{}", words.join(", "))
    }

    /// Labels, sixteen a line as the format allows.
    pub(super) fn labels(&mut self, labels: impl IntoIterator<Item = u32>) -> io::Result<()> {
        let words: Vec<String> = labels.into_iter().map(|label| label.to_string()).collect();
        words
            .chunks(16)
            .try_for_each(|row| writeln!(self.out, "{},", row.join(", ")))
    }
}

/// A number in the shortest form that reads back the same, or, where that is longer than the
/// twenty characters a field may have, with thirteen digits.
pub(super) fn real(value: f64) -> String {
    let plain = format!("{value:?}");
    if plain.len() <= 20 {
        return plain;
    }
    format!("{value:.12e}")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// What a few calls write.
    pub(in super::super) fn written(
        calls: impl FnOnce(&mut InpWriter<Vec<u8>>) -> io::Result<()>,
    ) -> String {
        let mut writer = InpWriter::new(Vec::new());
        calls(&mut writer).unwrap();
        String::from_utf8(writer.into_inner()).unwrap()
    }

    #[test]
    fn heading_and_comments_cannot_become_keywords() {
        let text = written(|inp| {
            inp.heading("condyle\n*NODE")?;
            inp.comment("one\ntwo")
        });
        assert_eq!(text, "*HEADING\ncondyle\nNODE\n** one\n** two\n");
    }

    #[test]
    fn numbers_fit_their_field_and_read_back() {
        for value in [
            0.0,
            1.0,
            -0.07,
            33.8,
            1.0 / 3.0,
            -1.0 / 3e7,
            2.64e-7,
            1e300,
            -1.234_567_890_123_456_7e-101,
        ] {
            let text = real(value);
            assert!(text.len() <= 20, "{text}");
            let back: f64 = text.parse().unwrap();
            assert!((back - value).abs() <= 1e-12 * value.abs(), "{text}");
        }
        assert_eq!(
            (real(33.8), real(1.0), real(2.64e-7)),
            ("33.8".into(), "1.0".into(), "2.64e-7".into())
        );
    }
}
