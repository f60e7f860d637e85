//! Pictures as SVG, drawn from numbers; this module reads no file.

mod axis;
mod contour;
mod map;
mod marker;
mod panel;
mod svg;

pub(crate) use axis::{Axis, finite_range};
pub(crate) use map::{ColourRange, Map, MapStyle, largest_size};
pub(crate) use panel::{Curve, MEASURED, Panel, run_class, sheet};
pub(crate) use svg::{Path, STYLE, colour_variables, escape, scale_bar, svg_file, titled};
