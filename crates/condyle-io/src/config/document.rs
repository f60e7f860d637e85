//! A whole file, from its text to what it says or everything that is wrong with it.

use toml::de::DeTable;

use super::base::Base;
use super::key_reason::KeyReason;
use super::log::Log;
use super::problems::Problems;
use super::section::Section;
use super::source::Source;

/// What `read` makes of the file `source`; those it names are looked for from `base`.
///
/// # Errors
/// Everything that is wrong, what is no TOML before all else.
pub(crate) fn read_document<T>(
    source: &Source,
    base: Base<'_>,
    read: impl FnOnce(&Section<'_>, &mut Log<'_>) -> Option<T>,
) -> Result<T, Problems> {
    let (document, errors) = DeTable::parse_recoverable(source.inner());
    let mut log = Log::new(source, base);
    for error in &errors {
        let message = error.message().to_owned();
        log.problem(error.span().unwrap_or(0..0), KeyReason::Syntax { message });
    }
    let found = if errors.is_empty() {
        read(&Section::root(document.get_ref()), &mut log)
    } else {
        None
    };
    let problems = log.into_problems();
    match found {
        Some(found) if problems.is_empty() => Ok(found),
        Some(_) | None => Err(Problems::new(problems, source)),
    }
}
