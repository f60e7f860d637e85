//! How a surface gives way under loads on its nodes.

use std::{fmt::Debug, sync::Arc};

/// Deflections of all surface nodes under a unit load on one of them, both along the inward normals, mm/N.
pub(super) type Column = Arc<[f64]>;

/// The normal compliance of a surface: how far its nodes give way to loads on them.
///
/// It is symmetric and positive definite, and given column by column, as they are asked for: of most nodes
/// nobody ever asks. What a column says depends on nothing that was asked before.
pub(super) trait SurfaceCompliance: Debug + Send + Sync {
    /// The columns of surface nodes, and those that come with them.
    fn columns(&self, nodes: &[u32]) -> Vec<(u32, Column)>;
}

/// The columns that a contact has asked for so far.
pub(super) struct KnownColumns {
    source: Arc<dyn SurfaceCompliance>,
    columns: Vec<Option<Column>>,
}

impl KnownColumns {
    /// None so far, of a surface with so many nodes.
    pub fn none(source: Arc<dyn SurfaceCompliance>, node_count: usize) -> Self {
        Self {
            source,
            columns: vec![None; node_count],
        }
    }

    /// Asks for the columns of nodes that are not known.
    pub fn ask(&mut self, nodes: impl Iterator<Item = u32>) {
        let unknown: Vec<u32> = nodes
            .filter(|&node| self.columns[node as usize].is_none())
            .collect();
        if !unknown.is_empty() {
            for (node, column) in self.source.columns(&unknown) {
                self.columns[node as usize] = Some(column);
            }
        }
    }

    /// The column of a node that was asked for.
    #[inline(always)]
    pub fn of(&self, node: u32) -> &[f64] {
        self.columns[node as usize].as_deref().unwrap_or(&[])
    }
}
