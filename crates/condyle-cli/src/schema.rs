//! `condyle schema`.

use std::process::ExitCode;

use condyle_case::case::Case;

use crate::output;

pub fn schema() -> ExitCode {
    output::print(&Case::json_schema())
}
