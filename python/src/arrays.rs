//! Vectors of Rust as arrays of NumPy: the memory changes hands, and no number is copied.

use numpy::{Element, IntoPyArray, PyArrayMethods, ndarray::IntoDimension};
use pyo3::prelude::*;

/// `values` as an array of this shape.
pub fn array<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: impl IntoDimension,
) -> PyResult<Bound<'_, PyAny>> {
    let flat = values.into_pyarray(py);
    Ok(flat.reshape(shape)?.into_any())
}
