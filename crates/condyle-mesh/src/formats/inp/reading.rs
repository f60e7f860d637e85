//! What has been read of an Abaqus input file, and the words of its rows.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::Path;

use super::super::error::{FileLine, MeshFileError};
use super::super::hex_draft::HexDraft;
use super::keyword::Keyword;

/// A row of a few bytes can make a set of any size, so that the length of the file bounds them
/// all: a node takes more bytes than this, and a set seldom has more than all nodes.
const MEMBERS_A_BYTE: u64 = 8;
/// Short files may number sparsely.
const MEMBERS_OF_ANY_FILE: u64 = 1_000_000;

/// What has been read so far.
pub(super) struct Reading<'a> {
    pub path: &'a Path,
    pub draft: HexDraft<'a>,
    /// Members by the name in capitals, since names do not know their case.
    pub node_sets: HashMap<String, Vec<u64>>,
    pub element_sets: HashMap<String, Vec<u64>>,
    pub parts: usize,
    pub instances: usize,
    most_members: u64,
    members: Cell<u64>,
}

impl<'a> Reading<'a> {
    /// Nothing read yet of the file at `path`, which has `length` bytes.
    pub(super) fn new(path: &'a Path, length: usize) -> Self {
        Self {
            path,
            draft: HexDraft::new(path),
            node_sets: HashMap::new(),
            element_sets: HashMap::new(),
            parts: 0,
            instances: 0,
            most_members: MEMBERS_OF_ANY_FILE + MEMBERS_A_BYTE * length as u64,
            members: Cell::new(0),
        }
    }

    /// Counts members of sets and surfaces before they are made.
    pub(super) fn count_members(&self, line: usize, more: u64) -> Result<(), MeshFileError> {
        let members = self.members.get().saturating_add(more);
        self.members.set(members);
        if members <= self.most_members {
            return Ok(());
        }
        let what = format!(
            "with the {more} members of this row, the sets of the file have more than {}, \
             which a file of its length does not need; name only nodes and elements that there are",
            self.most_members
        );
        Err(self.at(line).error(what))
    }

    pub(super) fn at(&self, line: usize) -> FileLine {
        FileLine::line(self.path, line)
    }

    pub(super) fn required<'k>(
        &self,
        keyword: &'k Keyword,
        parameter: &str,
    ) -> Result<&'k str, MeshFileError> {
        keyword.value(parameter).ok_or_else(|| {
            let what = format!("*{} needs {parameter}=name", keyword.name);
            self.at(keyword.line).error(what)
        })
    }

    /// A number, perhaps behind the name of the instance: `Insert-1.17`.
    pub(super) fn label(&self, line: usize, field: &str) -> Result<u64, MeshFileError> {
        plain(field).parse().map_err(|_| {
            let what = format!("{field:?} is neither a number nor a set given before");
            self.at(line).error(what)
        })
    }
}

/// Fields between commas; a comma at the end of a row is not a field.
pub(super) fn fields(row: &str) -> impl Iterator<Item = &str> {
    row.split(',')
        .map(str::trim)
        .filter(|field| !field.is_empty())
}

/// A name in capitals without its instance and quotes: `Insert-1.Top` is `TOP`.
pub(super) fn plain(name: &str) -> String {
    let name = name.trim_matches('"');
    name.rsplit('.').next().unwrap_or(name).to_ascii_uppercase()
}
