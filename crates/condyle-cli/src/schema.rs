//! `condyle schema`.

use std::process::ExitCode;

use condyle_case::case::Case;

use crate::{arguments::Schema, output};

pub fn schema(arguments: &Schema) -> ExitCode {
    output::print(&if arguments.results {
        condyle_results::results_schema()
    } else {
        Case::json_schema()
    })
}
