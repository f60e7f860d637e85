//! Pictures as SVG, drawn from numbers; they know no file.

mod axis;
mod contour;
mod escape;
mod map;
mod marker;
mod panel;
mod path;
mod sheet;
mod style;

pub(crate) use axis::Axis;
pub(crate) use escape::escape;
pub(crate) use map::{ColourRange, Map, Shades};
pub(crate) use panel::{Curve, Panel};
pub(crate) use path::Path;
pub(crate) use sheet::{alone, sheet};
pub(crate) use style::{css, variables};
