//! A whole file, from its text to what it says or everything that is wrong with it.

use std::path::Path;

use toml::de::DeTable;

use super::key_reason::KeyReason;
use super::log::Log;
use super::problems::Problems;
use super::section::Section;
use super::source::Source;

/// What `read` makes of the file `source`, in which paths count from `folder`.
///
/// # Errors
/// Everything that is wrong, what is no TOML before all else.
pub(crate) fn read_document<T>(
    source: &Source,
    folder: &Path,
    read: impl FnOnce(&Section<'_>, &mut Log<'_>) -> Option<T>,
) -> Result<T, Problems> {
    let (document, errors) = DeTable::parse_recoverable(source.inner());
    let mut log = Log::new(source, folder);
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
