//! Many runs of a case, side by side, of which nothing is written.

use std::{
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

/// What is said first.
pub(super) fn first_line(words: &impl ToString) -> String {
    let words = words.to_string();
    words.lines().next().unwrap_or_default().to_owned()
}

/// `work` for each of `count` indices, in their order, `threads` at a time.
pub(super) fn in_parallel<T: Send>(
    count: usize,
    threads: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    let done: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let taken = AtomicUsize::new(0);
    let run = || {
        loop {
            let index = taken.fetch_add(1, Ordering::Relaxed);
            let Some(place) = done.get(index) else { break };
            *place.lock().expect("no thread panics with it") = Some(work(index));
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, count.max(1)) {
            scope.spawn(run);
        }
    });
    let found = |place: Mutex<Option<T>>| place.into_inner().expect("no thread panics with it");
    done.into_iter().filter_map(found).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_keeps_its_order_on_any_number_of_threads() {
        let squares: Vec<usize> = (0..20).map(|i| i * i).collect();
        for threads in [0, 1, 3, 50] {
            assert_eq!(in_parallel(20, threads, |i| i * i), squares);
        }
        assert!(in_parallel(0, 4, |i| i).is_empty());
    }
}
