//! Physical groups of a Gmsh mesh.

use std::collections::HashMap;

use super::super::error::MeshFileError;
use super::super::text;
use super::lines::Lines;

/// Physical groups: names by dimension and number, and in version 4 the groups of each entity.
#[derive(Default)]
pub(super) struct Groups {
    names: HashMap<(i64, i64), String>,
    pub of_entity: HashMap<(i64, i64), Vec<i64>>,
}

impl Groups {
    pub(super) fn read_names(&mut self, lines: &mut Lines) -> Result<(), MeshFileError> {
        let (_, count) = lines.integers(1)?;
        for _ in 0..count[0] {
            let (line, row) = lines.expect_row()?;
            let mut words = row.splitn(3, char::is_whitespace);
            let mut number = || text::number(lines.path, line, words.next().unwrap_or_default());
            let key = (number()?, number()?);
            let name = words.next().unwrap_or_default().trim().trim_matches('"');
            self.names.insert(key, name.to_string());
        }
        lines.skip_to_end_of("$PhysicalNames");
        Ok(())
    }

    pub(super) fn read_entities(&mut self, lines: &mut Lines) -> Result<(), MeshFileError> {
        let (_, counts) = lines.integers(4)?;
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                self.read_entity(lines, dimension)?;
            }
        }
        lines.skip_to_end_of("$Entities");
        Ok(())
    }

    /// Tag, a point or the two corners of a box, then the number of groups and the groups.
    fn read_entity(&mut self, lines: &mut Lines, dimension: i64) -> Result<(), MeshFileError> {
        let (line, row) = lines.expect_row()?;
        let mut words = row.split_ascii_whitespace();
        let tag = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let extent = if dimension == 0 { 3 } else { 6 };
        let mut words = words.skip(extent);
        let count: usize = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let groups: Result<_, _> = words
            .take(count)
            .map(|word| text::number(lines.path, line, word))
            .collect();
        self.of_entity.insert((dimension, tag), groups?);
        Ok(())
    }

    /// Name of a group; its number where it has none. A negative number means turned round.
    pub(super) fn name(&self, dimension: i64, group: i64) -> String {
        let group = group.saturating_abs();
        let name = self.names.get(&(dimension, group));
        name.cloned().unwrap_or_else(|| group.to_string())
    }
}
