//! Time to read a results folder of the default size and write its page.

#[path = "../tests/report/fixture.rs"]
mod fixture;

use condyle_report::{Results, report_html, write_report};

fn main() {
    divan::main();
}

#[divan::bench]
fn whole_report(bencher: divan::Bencher) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    bencher.bench_local(|| write_report(folder.path()).expect("the report can be written"));
}

#[divan::bench]
fn page_without_reading(bencher: divan::Bencher) {
    let results: Results = fixture::results();
    bencher.bench_local(|| report_html(&results));
}
