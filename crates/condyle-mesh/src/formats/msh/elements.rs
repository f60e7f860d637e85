//! Elements of a Gmsh mesh, in both versions.

use super::super::error::MeshFileError;
use super::super::hex_draft::{DraftHex, HexDraft};
use super::groups::Groups;
use super::lines::Lines;

pub(super) fn elements_v2(
    lines: &mut Lines,
    groups: &Groups,
    draft: &mut HexDraft,
) -> Result<(), MeshFileError> {
    let (_, count) = lines.integers(1)?;
    for _ in 0..count[0] {
        let (line, numbers) = lines.integers(3)?;
        let tags = usize::try_from(numbers[2]).unwrap_or(0);
        // Without a group, the first tag is missing or 0.
        let group = numbers[3..]
            .iter()
            .take(tags.min(1))
            .copied()
            .filter(|&group| group != 0);
        let element = Element {
            line,
            label: numbers[0].cast_unsigned(),
            kind: numbers[1],
            groups: &group.collect::<Vec<_>>(),
            nodes: numbers.get(3 + tags..).unwrap_or_default(),
        };
        element.add_to(draft, groups, lines)?;
    }
    lines.skip_to_end_of("$Elements");
    Ok(())
}

pub(super) fn elements_v4(
    lines: &mut Lines,
    groups: &Groups,
    draft: &mut HexDraft,
) -> Result<(), MeshFileError> {
    let (_, head) = lines.integers(4)?;
    for _ in 0..head[0] {
        let (_, block) = lines.integers(4)?;
        let [dimension, entity, kind, count] = [block[0], block[1], block[2], block[3]];
        let of_entity = groups.of_entity.get(&(dimension, entity));
        for _ in 0..count {
            let (line, numbers) = lines.integers(1)?;
            let element = Element {
                line,
                label: numbers[0].cast_unsigned(),
                kind,
                groups: of_entity.map_or(&[], Vec::as_slice),
                nodes: &numbers[1..],
            };
            element.add_to(draft, groups, lines)?;
        }
    }
    lines.skip_to_end_of("$Elements");
    Ok(())
}

struct Element<'e> {
    line: usize,
    label: u64,
    kind: i64,
    groups: &'e [i64],
    nodes: &'e [i64],
}

impl Element<'_> {
    fn add_to(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        lines: &Lines,
    ) -> Result<(), MeshFileError> {
        match self.kind {
            5 => draft.hex(DraftHex {
                label: self.label,
                line: Some(self.line),
                nodes: self.corners(lines)?,
            }),
            3 => self.add_quad(draft, groups, lines),
            1 => self.add_nodes(draft, groups, 1),
            15 => self.add_nodes(draft, groups, 0),
            other => Err(MeshFileError::NotHexahedron {
                at: lines.at(self.line),
                element: self.label,
                kind: kind_in_words(other),
            }),
        }
    }

    fn corners<const N: usize>(&self, lines: &Lines) -> Result<[u64; N], MeshFileError> {
        let corners = <[i64; N]>::try_from(self.nodes).map_err(|_| {
            let found = self.nodes.len();
            let what = format!("element {} has {found} nodes; its type has {N}", self.label);
            lines.at(self.line).error(what)
        })?;
        Ok(corners.map(i64::cast_unsigned))
    }

    fn add_quad(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        lines: &Lines,
    ) -> Result<(), MeshFileError> {
        let corners = self.corners(lines)?;
        for &group in self.groups {
            draft.quad(&groups.name(2, group), Some(self.line), corners);
        }
        Ok(())
    }

    fn add_nodes(
        &self,
        draft: &mut HexDraft,
        groups: &Groups,
        dimension: i64,
    ) -> Result<(), MeshFileError> {
        for &group in self.groups {
            let nodes = self.nodes.iter().map(|node| node.cast_unsigned());
            draft.set_nodes(&groups.name(dimension, group), nodes);
        }
        Ok(())
    }
}

fn kind_in_words(kind: i64) -> String {
    let name = match kind {
        2 => "3-node triangle",
        4 => "4-node tetrahedron",
        6 => "6-node prism",
        7 => "5-node pyramid",
        9 => "6-node triangle",
        11 => "10-node tetrahedron",
        12 => "27-node hexahedron",
        16 => "8-node quadrangle",
        17 => "20-node hexahedron",
        _ => return kind.to_string(),
    };
    format!("{kind} ({name})")
}
