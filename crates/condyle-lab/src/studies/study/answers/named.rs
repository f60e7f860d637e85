//! A column with what it is of.

use super::super::store::Column;

/// A column of an input or an output with what it is.
pub(super) struct Named<'a, T> {
    pub of: &'a T,
    pub column: Column,
}
