//! Limits on the time and memory of each input, and detection of panics.

use std::{
    fs,
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    process::exit,
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

/// Largest time and memory of an input.
const MAX_SECONDS: f64 = 1.0;
const MAX_BYTES: u64 = 1 << 30;
/// An input that takes longer than this is not waited for.
const HANGS: Duration = Duration::from_secs(120);
/// Readings of a slow input: where the system does not report the time of a thread, other programs may delay one reading,
/// but hardly three.
const READINGS: usize = 3;

/// The input being read.
struct Current {
    name: String,
    bytes: Vec<u8>,
    since: Instant,
}

/// Watches inputs and keeps those that fail.
pub struct Watch {
    failures: PathBuf,
    current: Arc<Mutex<Option<Current>>>,
    pub failed: usize,
    pub slowest_s: f64,
}

impl Watch {
    /// Failing inputs are written into the folder.
    pub fn new(failures: &Path) -> Self {
        let current = Arc::new(Mutex::new(None));
        let (watched, folder) = (Arc::clone(&current), failures.to_path_buf());
        thread::spawn(move || {
            loop {
                thread::sleep(Duration::from_millis(10));
                end_if_out_of_bounds(&watched, &folder);
            }
        });
        Self {
            failures: failures.to_path_buf(),
            current,
            failed: 0,
            slowest_s: 0.0,
        }
    }

    /// Reads an input, and keeps it if it panics or takes too long.
    pub fn read(&mut self, name: &str, bytes: &[u8], read: &dyn Fn(&[u8])) {
        let mut least_s = f64::INFINITY;
        for _ in 0..READINGS {
            self.set(Some((name, bytes)));
            let began = Clock::now();
            let ended = catch_unwind(AssertUnwindSafe(|| read(bytes)));
            self.set(None);
            least_s = least_s.min(began.spent_s());
            if ended.is_err() {
                return self.fail(name, bytes, "panics");
            }
            if least_s <= MAX_SECONDS {
                self.slowest_s = self.slowest_s.max(least_s);
                return;
            }
        }
        self.fail(name, bytes, &format!("takes {least_s:.1} s"));
    }

    fn set(&self, input: Option<(&str, &[u8])>) {
        let input = input.map(|(name, bytes)| Current {
            name: name.to_owned(),
            bytes: bytes.to_vec(),
            since: Instant::now(),
        });
        *self.current.lock().unwrap_or_else(PoisonError::into_inner) = input;
    }

    fn fail(&mut self, name: &str, bytes: &[u8], what: &str) {
        self.failed += 1;
        keep(&self.failures, name, bytes, what);
    }
}

/// The processor time of this thread, or the elapsed time where the system does not report it.
struct Clock {
    worked_s: Option<f64>,
    began: Instant,
}

impl Clock {
    fn now() -> Self {
        Self {
            worked_s: worked_s(),
            began: Instant::now(),
        }
    }

    fn spent_s(&self) -> f64 {
        let all_s = self.began.elapsed().as_secs_f64();
        match (self.worked_s, worked_s()) {
            (Some(before), Some(after)) => after - before,
            _ => all_s,
        }
    }
}

/// Linux counts the time of a thread on a processor, in nanoseconds.
fn worked_s() -> Option<f64> {
    let counts = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = counts.split_ascii_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

fn end_if_out_of_bounds(current: &Mutex<Option<Current>>, failures: &Path) {
    let current = current.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(input) = current.as_ref() else {
        return;
    };
    let memory = resident_bytes();
    if input.since.elapsed() > HANGS {
        keep(failures, &input.name, &input.bytes, "hangs");
        exit(1);
    }
    if memory > MAX_BYTES {
        keep(failures, &input.name, &input.bytes, "takes more than 1 GB");
        exit(1);
    }
}

/// Returns the resident memory of the process; 0 where the system does not report it.
fn resident_bytes() -> u64 {
    let pages = fs::read_to_string("/proc/self/statm")
        .ok()
        .and_then(|statm| {
            let resident = statm.split_ascii_whitespace().nth(1)?;
            resident.parse::<u64>().ok()
        });
    pages.unwrap_or(0) * 4096
}

fn keep(folder: &Path, name: &str, bytes: &[u8], what: &str) {
    let path = folder.join(name);
    let kept = fs::create_dir_all(folder).and_then(|()| fs::write(&path, bytes));
    eprintln!(
        "{name} {what}; {} bytes of it in {}: {kept:?}",
        bytes.len(),
        path.display()
    );
    eprintln!("repeat it by: hostile_inputs --repeat {}", path.display());
}
