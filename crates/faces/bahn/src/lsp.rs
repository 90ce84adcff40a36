//! `bahn lsp`: the language server over standard input and output.

use std::io::BufReader;
use std::path::Path;
use std::sync::Arc;

use bahn_lsp::{Disk, Settings, Streams, serve};
use bahn_machine::MachineFolder;
use bahn_parameters::ControlModel;
use bahn_text::{Files, NamedFile};
use clap::Args;

use crate::options::model_parser;
use crate::{Outcome, UsageError, files};

pub(crate) const EXAMPLES: &str = "\
Examples:
  bahn lsp
  bahn lsp --model tnc360 --strict

An editor starts the command and speaks the Language Server Protocol with it by standard input
and output: errors while you type, what words mean, labels and programs, values of Q parameters
after a run, outline, completion of cycles with their prompts, listing, other label numbers,
conversion. Files .H, .I, .nc, .PLC and .MP; docs/lsp.md has the set-up for Visual Studio Code
and Neovim.

The editor may send the same settings by their names (model, strict, skipUnknown, comma,
isoStep), by themselves or below `bahn`. Without a model that of the machine counts in whose
folder a file lies. Without an editor at the other end the command ends with exit code 2.";

/// Options of `bahn lsp`.
#[derive(Args, Debug)]
pub(crate) struct LspOptions {
    /// Control model, wherever a file lies.
    #[arg(long, value_name = "MODEL", ignore_case = true, value_parser = model_parser())]
    pub model: Option<ControlModel>,
    /// Refuse what is otherwise accepted with a warning.
    #[arg(long)]
    pub strict: bool,
    /// Pass over words and functions that nothing here knows, with a warning.
    #[arg(long)]
    pub skip_unknown: bool,
    /// Protocol of the editor: editors that add this option to every command of theirs are obeyed.
    #[arg(long, hide = true)]
    pub stdio: bool,
}

/// Serves an editor until it says that it has done.
pub(crate) fn command(options: &LspOptions) -> Result<Outcome, UsageError> {
    let settings = Settings {
        model: options.model,
        strict: options.strict,
        skip_unknown: options.skip_unknown,
        ..Settings::default()
    };
    let input = BufReader::new(std::io::stdin());
    let (connection, streams) = Streams::connect(input, std::io::stdout());
    let served = serve(&connection, Arc::new(Folders), &settings);
    drop(connection);
    streams
        .end(served)
        .map_err(|error| UsageError::new(error.to_string()))?;
    Ok(Outcome::Fine)
}

/// The files beside a document.
struct Folders;

impl Files for Folders {
    fn read(&self, name: &str) -> Option<NamedFile> {
        let bytes = files::read_table(Path::new(name)).ok()?;
        let name = name.to_owned();
        Some(NamedFile { name, bytes })
    }
}

impl Disk for Folders {
    fn has(&self, path: &Path) -> bool {
        path.is_file()
    }

    /// A machine's folder holds its list and PLC program; part programs and sources lie one folder deeper.
    fn model_of(&self, path: &Path) -> Option<ControlModel> {
        const DEEPEST: usize = 2;
        path.ancestors().skip(1).take(DEEPEST).find_map(|folder| {
            let text = std::fs::read_to_string(folder.join(MachineFolder::FILE)).ok()?;
            MachineFolder::from_toml(&text).ok()?.model.parse().ok()
        })
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .collect();
        names.sort();
        names
    }
}
