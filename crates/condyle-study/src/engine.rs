//! The engine of all studies: it runs tests on several threads, stores results as they arrive, and reports to a
//! listener that can stop it.

use std::{
    ops::ControlFlow::{self, Break, Continue},
    path::{Path, PathBuf},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
        mpsc::{SyncSender, sync_channel},
    },
    thread,
};

use condyle_case::{
    cache::Cache,
    case::{Case, SharedBodies},
    config::Problems,
};
use condyle_lab::{RunError, batch_run};
use condyle_results::{Summary, catalogue};

use crate::{
    adaptive,
    error::StudyError,
    plan::{Plan, Shard, Test, TestOutputs, TestResult},
    search,
    store::{DATABASE, Store},
};

/// Messages that may wait for the calling thread: the memory of finished tests is bounded while the disk is slow.
const MAX_WAITING: usize = 64;

/// Options of a study.
#[derive(Clone, Debug)]
pub struct StudyOptions {
    /// Folder for the database and the answers.
    pub out: PathBuf,
    /// Tests at the same time; the table does not depend on it.
    pub threads: usize,
    /// The part of the study to run.
    pub shard: Shard,
}

/// The number of tests that are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Tests that were stored before this run of the study.
    pub before: u64,
    /// Tests that are done, including those stored before.
    pub kept: u64,
    /// All tests; for a sequential design, the largest number allowed.
    pub tests: u64,
}

/// An event of a study.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum StudyEvent {
    /// The study starts, or tests are done.
    Progress(Progress),
    /// A warning or a result of one test, in words.
    Message(String),
    /// A test advances: breaking stops it between two increments.
    Working,
}

/// Receives the events of a study on the calling thread, and stops the study by breaking.
pub type Listener<'a> = dyn FnMut(&StudyEvent) -> ControlFlow<()> + 'a;

/// Runs every test of a plan that is not stored yet. Each result is stored as soon as the test is done, so that a study
/// that is killed at any instant resumes with the other tests. A test that fails is stored with its reason.
///
/// # Errors
/// A folder that holds other files or cannot be written; [`StudyError::Interrupted`] if the listener breaks.
pub fn run_study(
    plan: &Plan,
    options: &StudyOptions,
    listener: &mut Listener<'_>,
) -> Result<(), StudyError> {
    let StudyOptions { shard, threads, .. } = *options;
    if plan.is_sequential() && !shard.is_whole() {
        return Err(StudyError::no_shards());
    }
    let store = Store::take_shard(plan, shard, &options.out)?;
    let bench = TestBench::default();
    let kept = store.count()?;
    let mut progress = Progress {
        before: kept,
        kept,
        tests: shard.count(plan.tests()),
    };
    let mut run = |tests: &mut (dyn Iterator<Item = Test> + Send)| {
        let work = |test: &Test, _: &Reporter<'_, TestResult>| bench.run(plan, test);
        let mut keep = |found: Vec<Found<TestResult>>| store.keep(plan, &found);
        run_tests(tests, threads, &work, &mut keep, &mut progress, listener)
    };
    if plan.is_sequential() {
        let mut known = Vec::new();
        loop {
            known.extend(store.known(plan, known.len() as u64)?);
            let tests = search::next_tests(plan, &known);
            let Some(tests) = tests.or_else(|| adaptive::next_tests(plan, &known)) else {
                return Ok(());
            };
            // Of an interrupted batch, some tests are stored.
            let kept = store.kept(plan)?;
            run(&mut tests.into_iter().filter(|test| !kept[test.row as usize]))?;
        }
    }
    let rows = store.missing(plan)?.into_iter();
    run(&mut rows
        .filter(|row| shard.has(*row))
        .filter_map(|row| plan.test(row)))
}

/// Joins the tests of all `shards` of a plan in the folder `out`, and returns how many of them there are.
///
/// # Errors
/// A folder of another study.
pub fn merge(plan: &Plan, shards: &[PathBuf], out: &Path) -> Result<u64, StudyError> {
    let whole = Store::take(plan, out)?;
    for folder in shards {
        Store::existing(folder, plan)?;
        whole.take_all(&folder.join(DATABASE))?;
    }
    whole.count()
}

/// Returns the results of all tests of a plan, in the order of their rows; nothing is stored.
pub(crate) fn run_in_memory(
    plan: &Plan,
    bench: &TestBench,
    threads: usize,
    listener: &mut Listener<'_>,
) -> Result<Vec<TestResult>, StudyError> {
    let work = |test: &Test, _: &Reporter<'_, TestResult>| bench.run(plan, test);
    run_all(plan, threads, &work, listener)
}

/// Returns the results of `work` on all tests of a plan, in the order of their rows.
pub(crate) fn run_all<T: Send>(
    plan: &Plan,
    threads: usize,
    work: &Work<'_, T>,
    listener: &mut Listener<'_>,
) -> Result<Vec<T>, StudyError> {
    let tests = plan.tests();
    let mut progress = Progress {
        before: 0,
        kept: 0,
        tests,
    };
    let mut all: Vec<Found<T>> = Vec::new();
    let mut keep = |found| {
        all.extend(found);
        Ok(())
    };
    // The last row first: the finest run of a convergence study takes longest, and should not start last.
    let mut left = (0..tests).rev().filter_map(|row| plan.test(row));
    run_tests(&mut left, threads, work, &mut keep, &mut progress, listener)?;
    all.sort_by_key(|(test, _)| test.row);
    Ok(all.into_iter().map(|(_, result)| result).collect())
}

pub(crate) type Found<T> = (Test, T);

type Work<'a, T> = dyn Fn(&Test, &Reporter<'_, T>) -> T + Sync + 'a;

enum Message<T> {
    Event(StudyEvent),
    Found(Found<T>),
}

/// Passes the events of a test from a worker to the listener.
pub(crate) struct Reporter<'a, T> {
    sender: SyncSender<Message<T>>,
    stop: &'a AtomicBool,
}

impl<T> Reporter<'_, T> {
    /// Passes an event to the listener; breaks if the study is to stop.
    pub fn report(&self, event: StudyEvent) -> ControlFlow<()> {
        let sent = self.sender.send(Message::Event(event));
        if sent.is_err() || self.stop.load(Ordering::Relaxed) {
            return Break(());
        }
        Continue(())
    }
}

/// Runs `work` on `tests` on several threads, and passes results to `keep` and events to the listener on the calling
/// thread.
fn run_tests<T: Send>(
    tests: &mut (dyn Iterator<Item = Test> + Send),
    threads: usize,
    work: &Work<'_, T>,
    keep: &mut dyn FnMut(Vec<Found<T>>) -> Result<(), StudyError>,
    progress: &mut Progress,
    listener: &mut Listener<'_>,
) -> Result<(), StudyError> {
    let (tests, stop) = (Mutex::new(tests), AtomicBool::new(false));
    // A full channel makes workers wait, so that results cannot pile up in memory.
    let (sender, receiver) = sync_channel(MAX_WAITING);
    thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            let (sender, tests, stop) = (sender.clone(), &tests, &stop);
            scope.spawn(move || work_off(tests, work, &Reporter { sender, stop }));
        }
        // Each worker has its own sender: without this one the channel closes when the last worker ends.
        drop(sender);
        let started = listener(&StudyEvent::Progress(*progress));
        let mut take_in = |messages: Vec<Message<T>>, listener: &mut Listener<'_>| {
            let mut flow = Continue(());
            let mut found = Vec::new();
            for message in messages {
                match message {
                    Message::Found(one) => found.push(one),
                    Message::Event(event) if flow.is_continue() => flow = listener(&event),
                    Message::Event(_) => {}
                }
            }
            if !found.is_empty() {
                progress.kept += found.len() as u64;
                keep(found)?;
                if flow.is_continue() {
                    flow = listener(&StudyEvent::Progress(*progress));
                }
            }
            Ok::<_, StudyError>(flow)
        };
        let mut flow = Ok(started);
        while let Ok(Continue(())) = flow
            && let Ok(first) = receiver.recv()
        {
            // All waiting results are stored in one transaction.
            let messages = std::iter::once(first).chain(receiver.try_iter());
            flow = take_in(messages.collect(), listener);
        }
        stop.store(true, Ordering::Relaxed);
        // Tests that were under way are stored as well.
        let last = take_in(receiver.iter().collect(), &mut |_| Break(()));
        match flow? {
            Continue(()) => last.map(|_| ()),
            Break(()) => last.and(Err(StudyError::Interrupted)),
        }
    })
}

/// Runs `work` on one test after another until none is left or the study is to stop.
fn work_off<T>(
    tests: &Mutex<&mut (dyn Iterator<Item = Test> + Send)>,
    work: &Work<'_, T>,
    reporter: &Reporter<'_, T>,
) {
    while !reporter.stop.load(Ordering::Relaxed) {
        let test = tests.lock().expect("no thread panics with it").next();
        let Some(test) = test else { break };
        let result = work(&test, reporter);
        let found = Message::Found((test, result));
        if reporter.sender.send(found).is_err() {
            break;
        }
    }
}

/// Runs tests in memory; bodies that do not vary are built once and shared.
pub struct TestBench {
    bodies: SharedBodies,
    cache: Cache,
}

impl TestBench {
    /// Runs a test of a plan. A failure is a result: it does not stop the study.
    pub fn run(&self, plan: &Plan, test: &Test) -> TestResult {
        let summary = plan.case_of(test).and_then(|case| self.summary(&case));
        let summary = summary.map_err(|error| {
            // The first line of the first problem: reasons are counted and listed.
            let problems = error.in_case().map(Problems::problems);
            let problem = problems.and_then(<[_]>::first);
            let words = problem.map_or_else(|| error.to_string(), ToString::to_string);
            words.lines().next().unwrap_or_default().trim().to_owned()
        })?;
        Ok(TestOutputs {
            values: plan
                .study()
                .outputs
                .values(&|key| catalogue::scalar(key).map_or(f64::NAN, |scalar| summary[scalar])),
            doubts: summary.doubts().join(" "),
        })
    }

    pub(crate) fn summary(&self, case: &Case) -> Result<Summary, RunError> {
        batch_run(case, &self.cache, &self.bodies)
    }
}

impl Default for TestBench {
    fn default() -> Self {
        let (bodies, cache) = (SharedBodies::default(), Cache::of_user());
        Self { bodies, cache }
    }
}
