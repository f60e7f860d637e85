//! Measures the performance of condyle: times compared with their targets, and instruction counts compared with
//! their budgets. `scripts/figures` and `scripts/test budget` run it.

mod budgets;
mod cases;
mod counted;
mod gait;
mod instructions;
mod readable;
mod times;

use std::process::ExitCode;

const USAGE: &str = "say what to do:
  times [CONDYLE]        times beside their targets; with the path of the command, also the whole command's
  laws                   time of all wear laws in one pass beside that of Archard's alone
  instructions           instruction counts beside their budgets, by callgrind
  instructions --record  the same, and the budgets recorded anew
  solve CASE TIMES       a whole test so many times: what a profile is taken of
  counted CASE           what callgrind counts";

fn main() -> ExitCode {
    // `cargo bench` adds a word of its own.
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let words: Vec<&str> = words
        .into_iter()
        .filter(|word| *word != "--bench")
        .collect();
    match words[..] {
        ["times"] => times::print(None),
        ["times", condyle] => times::print(Some(condyle.as_ref())),
        ["laws"] => times::print_laws(),
        ["instructions"] => return instructions::hold(),
        ["instructions", "--record"] => instructions::record(),
        ["solve", case, times] => times::solve(case, times.parse().expect("a number of times")),
        ["counted", case] => counted::run(case),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
