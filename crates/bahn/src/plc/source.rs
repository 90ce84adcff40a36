//! Source files beside the main file, and what the compiler says about them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_plc::{Compilation, Diagnostic as Fault, Options, PlcProgram, SourceFiles};

use super::options::ProgramOptions;
use crate::diagnostics::{self, Diagnostic, Marked, Severity};
use crate::{UsageError, files};

/// A compiled program with the folder it comes from.
pub(super) struct Source {
    folder: Folder,
    pub compilation: Compilation,
}

impl Source {
    /// Compiles the main file and what it links.
    pub fn compile(options: &ProgramOptions) -> Result<Source, UsageError> {
        // An unreadable main file is wrong use; a linked one is an error of the program.
        files::read_table(&options.file)?;
        let folder = Folder(options.file.parent().map(Path::to_owned).unwrap_or_default());
        let main = options.file.file_name().unwrap_or_default().to_string_lossy();
        let compilation = Compilation::compile(&folder, &main, Options::for_model(options.model));
        Ok(Source { folder, compilation })
    }

    /// Prints errors and warnings as rustc does.
    pub fn print_faults(&self) {
        let with = |severity, faults: &[Fault]| faults.iter().for_each(|fault| self.print(severity, fault));
        with(Severity::Error, &self.compilation.errors);
        with(Severity::Warning, &self.compilation.warnings);
    }

    /// The program; prints errors and warnings, and gives `None` when there are errors.
    pub fn program(mut self) -> Option<Arc<PlcProgram>> {
        self.print_faults();
        self.compilation.program.take().map(Arc::new)
    }

    fn print(&self, severity: Severity, fault: &Fault) {
        let bytes = self.folder.read(&fault.file).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        let line = (fault.line as usize).saturating_sub(1);
        let text = text.lines().nth(line).unwrap_or_default().to_owned();
        let start = fault.column.saturating_sub(1) as usize;
        let length = text
            .chars()
            .skip(start)
            .take_while(|c| !c.is_whitespace())
            .count();
        let detail = fault
            .message
            .strip_prefix(fault.error.text())
            .unwrap_or(&fault.message);
        diagnostics::print(&Diagnostic {
            severity,
            title: &format!("{} {}", fault.error.number(), fault.error.text()),
            path: &self.folder.0.join(&fault.file).to_string_lossy(),
            marked: Marked {
                line: fault.line,
                text,
                columns: Some((fault.column.max(1), u32::try_from(length).unwrap_or(1).max(1))),
            },
            label: detail.trim_start_matches(':').trim().to_owned(),
            help: None,
        });
        diagnostics::print_line("");
    }
}

/// The source files of one folder; names lose folders.
struct Folder(PathBuf);

impl SourceFiles for Folder {
    fn read(&self, name: &str) -> Option<Vec<u8>> {
        let name = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
        if name.is_empty() || name == "." || name == ".." {
            return None;
        }
        [name.to_owned(), name.to_ascii_lowercase()]
            .iter()
            .map(|name| self.0.join(name))
            .find(|path| path.is_file())
            .and_then(|path| files::read_table(&path).ok())
    }
}
