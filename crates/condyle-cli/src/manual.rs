//! Completions for shells and man pages, both from the declared arguments.

use std::{path::Path, process::ExitCode};

use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;

use crate::arguments::Arguments;
use crate::output::{self, Done, Unwritten};

pub fn completions(shell: Shell) -> Done {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "condyle", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

pub fn man(folder: &Path, force: bool) -> Done {
    let mut command = Arguments::command();
    // Names every page by the whole command, such as `condyle-run`.
    command.build();
    write_pages(&command, folder, force)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the page of a command and those of the commands below it.
fn write_pages(command: &clap::Command, folder: &Path, force: bool) -> Result<(), Unwritten> {
    let page = Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text).expect("a vector takes all bytes");
    output::write_into(&folder.join(page.get_filename()), &text, force)?;
    let below = command.get_subcommands();
    below
        .filter(|below| below.get_name() != "help" && !below.is_hide_set())
        .try_for_each(|below| write_pages(below, folder, force))
}
