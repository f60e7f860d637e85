//! The page as a whole, from a made-up folder.

mod fixture;

use condyle_report::{Results, report_html};

#[test]
fn the_page_stands_alone_and_is_small() {
    let html = report_html(&fixture::results());
    let kept = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("report.html");
    std::fs::write(kept, &html).expect("the target folder can be written");
    assert!(html.len() < 1_500_000, "{} bytes", html.len());
    for asks in ["<script", "<link", "src=", "url(", "@import"] {
        assert!(!html.contains(asks), "the page holds {asks}");
    }
}
