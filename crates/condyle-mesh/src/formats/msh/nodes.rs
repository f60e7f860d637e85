//! Nodes of a Gmsh mesh, in both versions.

use super::super::error::MeshFileError;
use super::super::hex_draft::HexDraft;
use super::super::text;
use super::lines::Lines;

pub(super) fn nodes_v2(lines: &mut Lines, draft: &mut HexDraft) -> Result<(), MeshFileError> {
    let (_, count) = lines.integers(1)?;
    for _ in 0..count[0] {
        let (line, row) = lines.expect_row()?;
        let mut words = row.split_ascii_whitespace();
        let label = text::number(lines.path, line, words.next().unwrap_or_default())?;
        let position = text::coordinates(lines.path, line, &mut words)?;
        draft.node(Some(line), label, position)?;
    }
    lines.skip_to_end_of("$Nodes");
    Ok(())
}

pub(super) fn nodes_v4(lines: &mut Lines, draft: &mut HexDraft) -> Result<(), MeshFileError> {
    let (_, head) = lines.integers(4)?;
    for _ in 0..head[0] {
        let (_, block) = lines.integers(4)?;
        let mut labels = Vec::new();
        for _ in 0..block[3] {
            labels.push(lines.integers(1)?.1[0]);
        }
        for label in labels {
            let (line, row) = lines.expect_row()?;
            let mut words = row.split_ascii_whitespace();
            let position = text::coordinates(lines.path, line, &mut words)?;
            draft.node(Some(line), label.cast_unsigned(), position)?;
        }
    }
    lines.skip_to_end_of("$Nodes");
    Ok(())
}
