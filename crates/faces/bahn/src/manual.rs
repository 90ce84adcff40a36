//! `bahn man` and `bahn completions`: what a shell and `man` know of the command line.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueHint};

use crate::files::{self, NewFile};
use crate::{Outcome, UsageError, console, diagnostics};

pub(crate) const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  bahn completions bash > ~/.local/share/bash-completion/completions/bahn
  bahn completions zsh > ~/.zfunc/_bahn
  bahn completions fish > ~/.config/fish/completions/bahn.fish";

pub(crate) const MAN_EXAMPLES: &str = "\
Examples:
  bahn man ~/.local/share/man/man1     a page for each command: man bahn, man bahn-test, ...
  bahn man > bahn.1                    the page of bahn alone";

/// Options of `bahn completions`.
#[derive(Args, Debug)]
pub(crate) struct CompletionsOptions {
    /// Shell that takes the completions.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Options of `bahn man`.
#[derive(Args, Debug)]
pub(crate) struct ManOptions {
    /// The folder that takes the pages; without it the page of `bahn` goes to standard output.
    #[arg(value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub folder: Option<PathBuf>,
}

/// Prints the script by which a shell completes commands and options.
pub(crate) fn completions(
    options: &CompletionsOptions,
    mut whole: clap::Command,
) -> Result<Outcome, UsageError> {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut whole, "bahn", &mut script);
    console::print_bytes(&script)?;
    Ok(Outcome::Fine)
}

/// Prints the manual page, or writes those of all commands into a folder.
pub(crate) fn man(options: &ManOptions, mut command: clap::Command) -> Result<Outcome, UsageError> {
    command.build();
    let Some(folder) = &options.folder else {
        console::print_bytes(&page(command)?)?;
        return Ok(Outcome::Fine);
    };
    fs::create_dir_all(folder).map_err(|error| files::cannot("make", folder, &error))?;
    let mut written = 0;
    for command in all(command) {
        let name = command.get_display_name().unwrap_or_else(|| command.get_name());
        let path = folder.join(format!("{name}.1"));
        let mut file = NewFile::create(&path)?;
        file.write_all(&page(command)?)
            .map_err(|error| files::cannot("write", &path, &error))?;
        file.finish()?;
        written += 1;
    }
    diagnostics::print_text(&format!("{}: {written} pages", folder.display()));
    Ok(Outcome::Fine)
}

fn page(command: clap::Command) -> Result<Vec<u8>, UsageError> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(|error| UsageError::new(format!("cannot write the page: {error}")))?;
    Ok(page)
}

/// A command and all below it.
fn all(command: clap::Command) -> Vec<clap::Command> {
    let below: Vec<clap::Command> = command
        .get_subcommands()
        .filter(|below| below.get_name() != "help")
        .flat_map(|below| all(below.clone()))
        .collect();
    std::iter::once(command).chain(below).collect()
}
