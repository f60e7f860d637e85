//! Prints the page of the book that lists every key of a case file.
//!
//! `cargo run -q -p condyle-case --example case_file_page > docs/src/case-file.md`

fn main() {
    print!(
        "{}",
        condyle_case::case::schema_markdown(condyle::wear::WEAR_LAWS)
    );
}
