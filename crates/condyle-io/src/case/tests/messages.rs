//! How messages are shown: not too many.

use super::{assert_shows, refusal};

#[test]
fn of_many_problems_the_first_are_shown_and_the_rest_counted() {
    let keys = |count: usize| (0..count).map(|key| format!("wrong_{key} = 1\n"));
    let shown = |count| refusal(&format!("[march]\n{}", keys(count).collect::<String>()));
    assert!(!shown(20).contains("more problem"));
    assert!(shown(20).contains("`wrong_19`"));
    assert_shows(
        &shown(21),
        &["`wrong_19`", "and 1 more problem; correct these first"],
    );
    let of_many = shown(5000);
    assert_shows(
        &of_many,
        &["`wrong_0`", "`wrong_19`", "and 4980 more problems"],
    );
    assert!(!of_many.contains("`wrong_20`"));
}
