//! Feeds every reader of files with hostile inputs: valid files that are corrupted, reproducibly for a seed.
//!
//! `cargo run --release -p condyle-case --example hostile_inputs -- --inputs 1000000 --seed 1`
//!
//! Prints a table of the inputs of each reader; exits with 1 if one of them panicked, took more than a second or more
//! than 1 GB. Such an input is written into the folder of `--failures`, and `--repeat FILE` reads it again.

mod mutate;
mod random;
mod readers;
mod seeds;
mod watch;

use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

use self::{mutate::mutated, random::Random, readers::Reader, watch::Watch};

struct Asked {
    inputs: u64,
    seed: u64,
    failures: PathBuf,
    repeat: Option<PathBuf>,
}

fn main() -> ExitCode {
    match asked(std::env::args().skip(1)) {
        Ok(asked) => run(&asked),
        Err(word) => {
            eprintln!("{word}: write --inputs N, --seed N, --failures FOLDER or --repeat FILE");
            ExitCode::from(2)
        }
    }
}

/// Parses the command line; the error is the wrong word.
fn asked(mut words: impl Iterator<Item = String>) -> Result<Asked, String> {
    let mut asked = Asked {
        inputs: 20_000,
        seed: 1,
        failures: std::env::temp_dir().join("condyle-hostile-inputs"),
        repeat: None,
    };
    while let Some(word) = words.next() {
        let value = words.next().ok_or_else(|| word.clone())?;
        match word.as_str() {
            "--inputs" => asked.inputs = value.parse().map_err(|_| value)?,
            "--seed" => asked.seed = value.parse().map_err(|_| value)?,
            "--failures" => asked.failures = value.into(),
            "--repeat" => asked.repeat = Some(value.into()),
            _ => return Err(word),
        }
    }
    Ok(asked)
}

fn run(asked: &Asked) -> ExitCode {
    let Ok(folder) = tempfile::tempdir() else {
        eprintln!("no temporary folder can be created");
        return ExitCode::from(2);
    };
    let readers = readers::all(folder.path());
    if let Some(file) = &asked.repeat {
        return repeat(&readers, file);
    }
    // A panic is reported with the name of its input.
    std::panic::set_hook(Box::new(|_| ()));
    let failed = read_all(&readers, asked);
    ExitCode::from(u8::from(failed > 0))
}

fn repeat(readers: &[Reader], file: &Path) -> ExitCode {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let of = name.split('-').next().unwrap_or_default();
    match (
        readers.iter().find(|reader| reader.name == of),
        std::fs::read(file),
    ) {
        (Some(reader), Ok(bytes)) => {
            (reader.read)(&bytes);
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!(
                "{}: there is no such file, or no reader called {of}",
                file.display()
            );
            ExitCode::from(2)
        }
    }
}

/// Gives every reader its share of the inputs, prints the counts and returns the number of failures.
fn read_all(readers: &[Reader], asked: &Asked) -> usize {
    println!("| reader | inputs | failed | slowest, ms |\n| --- | --- | --- | --- |");
    let (mut number, mut failed) = (0, 0);
    for (index, reader) in readers.iter().enumerate() {
        let mut watch = Watch::new(&asked.failures);
        let end = asked.inputs * (index as u64 + 1) / readers.len() as u64;
        let count = end - number;
        while number < end {
            let mut random = Random::of_input(asked.seed, number);
            let seed = &reader.corpus[random.below(reader.corpus.len())];
            let bytes = mutated(seed, &reader.corpus, &mut random);
            watch.read(
                &format!("{}-{}-{number}", reader.name, asked.seed),
                &bytes,
                &*reader.read,
            );
            number += 1;
        }
        println!(
            "| {} | {count} | {} | {:.0} |",
            reader.name,
            watch.failed,
            watch.slowest_s * 1e3
        );
        failed += watch.failed;
    }
    println!("| all | {} | {failed} | |", asked.inputs);
    failed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_inputs_are_read_to_an_end() {
        let folder = tempfile::tempdir().expect("a folder for the cache");
        let failures = tempfile::tempdir().expect("a folder for failures");
        let asked = Asked {
            inputs: if cfg!(debug_assertions) {
                2_000
            } else {
                20_000
            },
            seed: 7,
            failures: failures.path().to_owned(),
            repeat: None,
        };
        assert_eq!(read_all(&readers::all(folder.path()), &asked), 0);
    }

    #[test]
    fn every_seed_is_a_valid_file_or_the_start_of_one() {
        let folder = tempfile::tempdir().expect("a folder for the cache");
        for reader in readers::all(folder.path()) {
            assert!(
                reader.corpus.iter().all(|seed| seed.len() > 20),
                "{}",
                reader.name
            );
        }
    }
}
