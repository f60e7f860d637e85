//! Times compared with their targets.
//!
//! A time is the least of several: whatever else a machine does makes it longer, never shorter.

use std::{
    hint::black_box,
    path::Path,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use condyle::{contact::ContactModel, evolve::MarchState};
use condyle_case::{
    cache::Cache,
    case::{Case, SharedBodies},
};

use crate::{
    budgets,
    cases::{self, GENERIC, REAL, built, marched},
    gait::{Asked, SECOND, Updates, press},
};

/// Of whole tests.
const ROUNDS: usize = 9;
/// Of every contact evaluation.
const EVALUATION_ROUNDS: usize = 25;
/// Axial force of the figure for one contact evaluation, N.
const AXIAL_FORCE_N: f64 = 2600.0;

/// The last of ten updates, from 0.
const LAST: usize = 9;

/// Prints the table of figures; the whole command's only where its path is given.
pub fn print(condyle: Option<&Path>) {
    println!("| figure | at most | measured | |");
    println!("| --- | ---: | ---: | --- |");
    let generic = cases::read(GENERIC).expect("a shipped case is read");
    let generic_s = least_s(ROUNDS, || solved(&generic));
    row("`knight-2007`, solver only", 0.10, generic_s, "s");
    if let Some(condyle) = condyle {
        let whole_s = least_s(ROUNDS, || run_command(condyle));
        row(
            "the whole command, with files and report",
            0.5,
            whole_s,
            "s",
        );
    }
    if let Some(real) = cases::read(REAL) {
        print_real(&real, &generic);
    }
    print_laws();
    let finer = finer(&generic);
    let ratio = least_s(ROUNDS, || solved(&finer)) / generic_s;
    row(
        "time with four times the articulating nodes, relative",
        4.5,
        ratio,
        "times",
    );
    row(
        "time of each of two simultaneous runs, relative to one alone",
        1.1,
        beside_another(&generic),
        "times",
    );
    println!("\n{WORK}");
    print_work(GENERIC, &generic);
    if let Some(real) = cases::read(REAL) {
        print_work(REAL, &real);
    }
}

/// Prints the time of a whole test with every wear law in one pass, relative to that with Archard's law alone.
pub fn print_laws() {
    let case = cases::read(GENERIC).expect("a shipped case is read");
    let alone = || {
        let mut test = built(&case);
        test.comparison_laws.clear();
        marched(test)
    };
    // By turns, so that both see the same of whatever else the machine does.
    let rounds = (0..2 * ROUNDS).map(|_| [least_s(1, alone), least_s(1, || solved(&case))]);
    let least = rounds.fold([f64::INFINITY; 2], |least, round| {
        [least[0].min(round[0]), least[1].min(round[1])]
    });
    row(
        "time of all wear laws in one pass, relative to Archard's alone",
        1.15,
        least[1] / least[0],
        "times",
    );
}

/// Prints the figures of a real implant. A test with the same femur and an insert that takes no time separates the
/// time of the femur from that of the insert.
fn print_real(real: &Case, generic: &Case) {
    let mut femur_only = real.clone();
    femur_only.insert = generic.insert.clone();
    let preparation_s = least_s(ROUNDS, || built(&femur_only));
    let whole_s = least_s(ROUNDS, || solved(real));
    row(
        "`dm-knee`, solver only, after the femur's preparation",
        0.3,
        whole_s - preparation_s,
        "s",
    );
    row(
        "preparation of its femur, 24,442 triangles",
        0.2,
        preparation_s,
        "s",
    );
    row("the same, from the cache", 0.2, kept_s(&femur_only), "s");
    let under_2600_n = Updates::of(real, SECOND + 1, |test| press(test, AXIAL_FORCE_N));
    let evaluations = Evaluations::of(&under_2600_n, SECOND);
    row(
        "`dm-knee`, one contact evaluation at 2600 N, with the accuracy of the march",
        15.0,
        evaluations.median_us(),
        "us",
    );
    row(
        "the same, first look only",
        15.0,
        evaluations.median_of_firsts_us(),
        "us",
    );
    row(
        "the same in the first cycle, without separation bounds",
        15.0,
        Evaluations::of(&under_2600_n, 0).median_of_firsts_us(),
        "us",
    );
    let in_gait = Updates::of(real, LAST + 1, |_| ());
    row(
        "the same under the force of gait, with the accuracy of the march",
        15.0,
        Evaluations::of(&in_gait, SECOND).median_us(),
        "us",
    );
    row(
        "the same in the last update, on the worn insert",
        15.0,
        Evaluations::of(&in_gait, LAST).median_us(),
        "us",
    );
}

fn row(figure: &str, target: f64, measured: f64, unit: &str) {
    let verdict = if measured <= target { "met" } else { "not met" };
    println!("| {figure} | {target} {unit} | {measured:.3} {unit} | {verdict} |");
}

/// Time to build a case whose femur's preparation was kept.
fn kept_s(case: &Case) -> f64 {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let cache = Cache::in_folder(folder.path());
    let build = || {
        let built = case.build_sharing(1, &cache, &SharedBodies::default());
        built.expect("a shipped case builds")
    };
    build();
    least_s(ROUNDS, build)
}

/// Prints the amount of work in the march of a case, which determines its time.
fn print_work(name: &str, case: &Case) {
    let state = solved(case);
    let updates = Updates::of(case, SECOND + 1, |_| ());
    let second = updates.gait(SECOND);
    let cycles = state.increments_solved as f64 / case.time.increments as f64;
    let per_cycle = |work: u64| work as f64 / cycles;
    let budgets = budgets::read();
    let budget = |work: &str| budgets.get(name).and_then(|of_case| of_case.get(work));
    let nodes = second.contact().node_count();
    let cells = [
        format!("`{name}`"),
        format!("{cycles:.1}"),
        format!("{:.0}", per_cycle(state.counters.newton_iterations)),
        format!("{:.0}", per_cycle(state.counters.contact_evaluations)),
        format!("{nodes}"),
        format!("{:.0}", mean_pressing(&updates)),
        budget("contact_evaluation").map_or_else(String::new, u64::to_string),
        format!("{:.1} us", Evaluations::of(&updates, SECOND).mean_us()),
    ];
    println!("| {} |", cells.join(" | "));
}

/// Columns of the table of work.
const WORK: &str = "\
| case | cycles solved | Newton iterations a cycle | contact evaluations a cycle | articulating nodes | \
pressing nodes, mean | instructions an evaluation | time of one, mean |
| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |";

/// Nodes that press, averaged over the evaluations of a cycle.
fn mean_pressing(updates: &Updates) -> f64 {
    let (asked, gait) = (updates.asked(SECOND), updates.gait(SECOND));
    let mut contact = gait.contact_after(updates.cache(SECOND));
    let pressing = |asked: &Asked| {
        contact.respond(&asked.motion);
        contact.evaluate(&asked.motion).touched.len()
    };
    asked.iter().map(pressing).sum::<usize>() as f64 / asked.len() as f64
}

/// Solves a case repeatedly, and prints the time of each solution.
pub fn solve(name: &str, times: usize) {
    let case = cases::read(name).expect("the case is read");
    for _ in 0..times {
        println!("{:.4}", least_s(1, || solved(&case)));
    }
}

/// Solves a parsed case up to its last update.
fn solved(case: &Case) -> MarchState {
    marched(built(case))
}

/// The generic case with edges half as long.
fn finer(generic: &Case) -> Case {
    let condyle_case::case::InsertShape::Generic(insert) = &generic.insert.shape else {
        panic!("the generic case has a generic insert");
    };
    cases::generic_with([&*format!("insert.edge_mm={}", insert.edge_mm / 2.0)])
}

fn run_command(condyle: &Path) {
    let folder = tempfile::tempdir().expect("a folder for results");
    let done = Command::new(condyle)
        .arg("run")
        .arg(cases::path(GENERIC))
        .arg("--out")
        .arg(folder.path().join("results"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("the command runs");
    assert!(done.success(), "the command fails: {done}");
}

/// The time of a whole test in this process while another solves the same, over that alone.
fn beside_another(generic: &Case) -> f64 {
    let alone_s = least_s(ROUNDS, || solved(generic));
    let this = std::env::current_exe().expect("a program knows where it is");
    let mut other = Command::new(this)
        .args(["solve", GENERIC, "1000000"])
        .stdout(Stdio::null())
        .spawn()
        .expect("this program runs twice");
    // The other must be at work before the first round.
    std::thread::sleep(Duration::from_secs_f64(alone_s));
    let beside_s = least_s(ROUNDS, || solved(generic));
    other.kill().expect("the other run ends");
    other.wait().expect("the other run ends");
    beside_s / alone_s
}

/// The least time of every evaluation of a cycle, and whether it is the first of its increment.
struct Evaluations(Vec<(Duration, bool)>);

impl Evaluations {
    /// Returns the evaluations of the cycle of an update.
    fn of(updates: &Updates, update: usize) -> Self {
        let (asked, gait) = (updates.asked(update), updates.gait(update));
        let mut least = vec![Duration::MAX; asked.len()];
        for _ in 0..EVALUATION_ROUNDS {
            let mut contact = gait.contact_after(updates.cache(update));
            for (asked, least) in asked.iter().zip(&mut least) {
                *least = (*least).min(evaluation_time(contact.as_mut(), asked));
            }
        }
        let is_first = asked.iter().map(|asked| asked.is_first);
        Self(least.into_iter().zip(is_first).collect())
    }

    fn median_us(&self) -> f64 {
        median_us(self.0.iter().map(|(time, _)| *time).collect())
    }

    fn median_of_firsts_us(&self) -> f64 {
        let firsts = self.0.iter().filter(|(_, is_first)| *is_first);
        median_us(firsts.map(|(time, _)| *time).collect())
    }

    fn mean_us(&self) -> f64 {
        let sum: Duration = self.0.iter().map(|(time, _)| *time).sum();
        sum.as_secs_f64() * 1e6 / self.0.len() as f64
    }
}

/// Wrench and tangent.
fn evaluation_time(contact: &mut dyn ContactModel, asked: &Asked) -> Duration {
    let start = Instant::now();
    contact.begin_increment(asked.increment);
    contact.respond(&asked.motion);
    black_box(contact.tangent());
    start.elapsed()
}

fn median_us(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e6
}

fn least_s<T>(rounds: usize, mut work: impl FnMut() -> T) -> f64 {
    let mut time = || {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    (0..rounds).map(|_| time()).fold(f64::INFINITY, f64::min)
}
