//! Writes the types of results for Python and for the web page; run it in the root of the repository.
//!
//! `cargo run -q -p condyle-results --example result_types`

use std::{fs, io};

fn main() -> io::Result<()> {
    fs::write(
        "python/condyle/_summary.py",
        condyle_results::python_types(),
    )?;
    fs::write(
        "web/src/page/catalogue.ts",
        condyle_results::typescript_types(),
    )
}
