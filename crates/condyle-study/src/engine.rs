//! Tests run side by side, and kept as they are done.

use std::{
    fs,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc::{Receiver, SyncSender, sync_channel},
    },
    thread,
};

use condyle_case::{cache::Cache, case::SharedBodies};
use condyle_lab::{Outcome, RunError, RunEvent, RunOptions, batch_run, run_case};
use condyle_results::catalogue;
use condyle_results::{FolderLock, ResultsFolder};

use crate::{
    error::StudyError,
    plan::{Plan, Shard, Test, TestResult},
    search::search,
    store::{DATABASE, Keeping, Store},
};

/// Tests that may wait to be kept.
const WAITING: usize = 64;

/// How a study is run.
#[derive(Clone, Debug)]
pub struct StudyOptions {
    /// Folder for the database and the answers.
    pub out: PathBuf,
    /// Tests at the same time; the table does not depend on it.
    pub threads: usize,
    /// Which part of the study.
    pub shard: Shard,
}

/// How far a study is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Tests that were kept before this run of the study.
    pub before: u64,
    /// Tests that are kept.
    pub kept: u64,
    /// Tests in all; of a search, at most.
    pub tests: u64,
}

/// How a study ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyEnd {
    /// All tests are kept.
    Done,
    /// Somebody asked to stop; what was found is kept, and the same command goes on.
    Interrupted,
}

/// Hears how far a study is, and may stop it by breaking.
pub type Listener<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// Runs every test of a plan that is not kept yet. What a test found is kept as soon as it is done: a study that is
/// killed at any instant goes on with the others.
///
/// # Errors
/// A folder of something else, or that cannot be written. A test that fails is kept with its reason.
pub fn run_study(
    plan: &Plan,
    options: &StudyOptions,
    listener: &mut Listener<'_>,
) -> Result<StudyEnd, StudyError> {
    let is_search = plan.is_search();
    if is_search && !options.shard.is_whole() {
        return Err(StudyError::NoShards);
    }
    let shard = options.shard;
    let folder = HeldFolder::take_for(plan, shard, &options.out)?;
    let bench = TestBench::default();
    let mut work = Work::new(&bench, &folder.store, options, plan)?;
    let is_interrupted = if is_search {
        search(plan, &mut |tests| work.done(plan, tests, listener))?.is_interrupted
    } else {
        work.rest(plan, shard, listener)?.is_break()
    };
    Ok(if is_interrupted {
        StudyEnd::Interrupted
    } else {
        StudyEnd::Done
    })
}

/// The folder `out` with the tests of all `shards` of a plan.
///
/// # Errors
/// A folder of another study.
pub fn merge(plan: &Plan, shards: &[PathBuf], out: &Path) -> Result<Done, StudyError> {
    let whole = HeldFolder::take(plan, out)?;
    let store = &whole.store;
    for folder in shards {
        Store::existing(folder, plan)?;
        store.take_all(&folder.join(DATABASE))?;
    }
    let (kept, tests) = (store.count()?, plan.tests());
    Ok(Done { kept, tests })
}

/// How many tests are kept, of how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Tests that are kept.
    pub kept: u64,
    /// Tests in all; of a search, at most.
    pub tests: u64,
}

/// What runs tests and keeps what they find.
struct Work<'a> {
    bench: &'a TestBench,
    store: &'a Store,
    threads: usize,
    kept: Vec<bool>,
    progress: Progress,
}

type Found = (Test, TestResult);

impl<'a> Work<'a> {
    fn new(
        bench: &'a TestBench,
        store: &'a Store,
        options: &StudyOptions,
        plan: &Plan,
    ) -> Result<Self, StudyError> {
        let kept = store.kept(plan.tests())?;
        let before = kept.iter().filter(|is_kept| **is_kept).count() as u64;
        let progress = Progress {
            before,
            kept: before,
            tests: options.shard.count(plan.tests()),
        };
        Ok(Self {
            bench,
            store,
            threads: options.threads.max(1),
            kept,
            progress,
        })
    }

    /// Runs the tests of a shard that are not kept.
    fn rest(
        &mut self,
        plan: &Plan,
        shard: Shard,
        listener: &mut Listener<'_>,
    ) -> Result<ControlFlow<()>, StudyError> {
        let kept = std::mem::take(&mut self.kept);
        let is_left = |row: &u64| shard.has(*row) && !kept[*row as usize];
        let tests = (0..plan.tests())
            .filter(is_left)
            .filter_map(|row| plan.test(row));
        self.run(plan, tests, listener)
    }

    /// Runs those of `tests` that are not kept, and gives what all of them found; a break if somebody asked to stop.
    fn done(
        &mut self,
        plan: &Plan,
        tests: Vec<Test>,
        listener: &mut Listener<'_>,
    ) -> Result<ControlFlow<(), Vec<TestResult>>, StudyError> {
        let rows: Vec<u64> = tests.iter().map(|test| test.row).collect();
        let left = tests
            .into_iter()
            .filter(|test| !self.kept[test.row as usize]);
        let left: Vec<Test> = left.collect();
        if self.run(plan, left.into_iter(), listener)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let found: Result<Vec<Option<TestResult>>, StudyError> = rows
            .iter()
            .map(|row| self.store.outputs(*row, plan))
            .collect();
        let missing = || Err("it was not kept".to_owned());
        let found = found?
            .into_iter()
            .map(|found| found.unwrap_or_else(missing));
        Ok(ControlFlow::Continue(found.collect()))
    }

    /// Runs `tests` on all threads, and keeps them here as they are done.
    fn run(
        &mut self,
        plan: &Plan,
        tests: impl Iterator<Item = Test> + Send,
        listener: &mut Listener<'_>,
    ) -> Result<ControlFlow<()>, StudyError> {
        let (tests, stop) = (Mutex::new(tests), AtomicBool::new(false));
        let (sender, receiver) = sync_channel(WAITING);
        let bench = self.bench;
        thread::scope(|scope| {
            for _ in 0..self.threads {
                let (sender, tests, stop) = (sender.clone(), &tests, &stop);
                scope.spawn(move || work_on(plan, bench, tests, &sender, stop));
            }
            drop(sender);
            let kept = self.keep_all(plan, &receiver, listener);
            stop.store(true, Ordering::Relaxed);
            // What was on its way is not lost.
            let found: Vec<Found> = receiver.iter().collect();
            let flow = kept?;
            self.store.keep(plan, &found)?;
            Ok(flow)
        })
    }

    fn keep_all(
        &mut self,
        plan: &Plan,
        receiver: &Receiver<Found>,
        listener: &mut Listener<'_>,
    ) -> Result<ControlFlow<()>, StudyError> {
        if listener(self.progress).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        while let Ok(first) = receiver.recv() {
            let found: Vec<Found> = std::iter::once(first).chain(receiver.try_iter()).collect();
            self.store.keep(plan, &found)?;
            self.progress.kept += found.len() as u64;
            if listener(self.progress).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}

/// Takes tests and hands over what they find until there are none, or somebody asked to stop.
fn work_on(
    plan: &Plan,
    bench: &TestBench,
    tests: &Mutex<impl Iterator<Item = Test>>,
    sender: &SyncSender<Found>,
    stop: &AtomicBool,
) {
    while !stop.load(Ordering::Relaxed) {
        let test = tests.lock().expect("no thread panics with it").next();
        let Some(test) = test else { break };
        let result = bench.run(plan, &test);
        if sender.send((test, result)).is_err() {
            break;
        }
    }
}

/// What the tests of a study are run with: bodies that do not vary are built once.
pub struct TestBench {
    bodies: SharedBodies,
    cache: Cache,
}

impl TestBench {
    /// Runs a test of a plan. One that fails stops nothing: that is what it found.
    pub fn run(&self, plan: &Plan, test: &Test) -> TestResult {
        let case = plan.case_of(test);
        let summary = case.and_then(|case| batch_run(&case, &self.cache, &self.bodies));
        let summary = summary.map_err(|error| reason(&error))?;
        Ok(catalogue::outputs().map(|output| summary[output]).collect())
    }
}

impl Default for TestBench {
    fn default() -> Self {
        let (bodies, cache) = (SharedBodies::default(), Cache::of_user());
        Self { bodies, cache }
    }
}

/// Why a test found nothing, on one line.
fn reason(error: &RunError) -> String {
    let in_case = error
        .in_case()
        .and_then(|problems| problems.problems().first());
    let words = in_case.map_or_else(|| error.to_string(), ToString::to_string);
    words.lines().next().unwrap_or_default().trim().to_owned()
}

impl Plan {
    /// Runs a test into a results folder of its own, as `condyle run` runs a case.
    ///
    /// # Errors
    /// Those of a run.
    pub fn run_into_folder(
        &self,
        test: &Test,
        out: &Path,
        on_event: &mut dyn FnMut(RunEvent<'_>) -> ControlFlow<()>,
    ) -> Result<Outcome, StudyError> {
        let options = RunOptions {
            out: out.to_path_buf(),
            resume: false,
            force: false,
            threads: 1,
            cache: Cache::of_user(),
        };
        let case = self.case_of(test)?;
        Ok(run_case(&case, &options, on_event)?)
    }
}

/// The folder of a study, which nobody else writes into as long as this is there.
pub struct HeldFolder {
    pub(crate) store: Store,
    _lock: Option<FolderLock>,
}

impl HeldFolder {
    /// Takes the folder `out` for a plan; folder and database are made if they are not there.
    ///
    /// # Errors
    /// A folder of something else, in use by another, or that cannot be written.
    pub fn take(plan: &Plan, out: &Path) -> Result<Self, StudyError> {
        Self::take_for(plan, Shard::WHOLE, out)
    }

    pub(crate) fn take_for(plan: &Plan, shard: Shard, out: &Path) -> Result<Self, StudyError> {
        fs::create_dir_all(out).map_err(|source| StudyError::Refused {
            path: out.to_path_buf(),
            source,
        })?;
        let lock = ResultsFolder::lock(out)?;
        let store = Store::open(out, &Keeping { plan, shard })?;
        Ok(Self { store, _lock: lock })
    }

    /// Numbers of the tests of a plan that are not kept.
    ///
    /// # Errors
    /// A search, whose tests are not known before they are due.
    pub fn missing(&self, plan: &Plan) -> Result<Vec<u64>, StudyError> {
        if plan.is_search() {
            return Err(StudyError::NoShards);
        }
        let rows = (0..).zip(self.store.kept(plan.tests())?);
        Ok(rows
            .filter(|(_, is_kept)| !is_kept)
            .map(|(row, _)| row)
            .collect())
    }

    /// Keeps what tests found, all in one step; of a test that is kept already nothing changes.
    ///
    /// # Errors
    /// A disk that is full.
    pub fn keep(&self, plan: &Plan, found: &[(Test, TestResult)]) -> Result<(), StudyError> {
        self.store.keep(plan, found)
    }
}

/// What is said first.
pub(crate) fn first_line(words: &impl ToString) -> String {
    let words = words.to_string();
    words.lines().next().unwrap_or_default().to_owned()
}

/// `work` for each of `count` indices, in their order, `threads` at a time.
pub(crate) fn in_parallel<T: Send>(
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
