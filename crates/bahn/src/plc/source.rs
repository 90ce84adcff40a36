//! Source files beside the main file, and what the compiler says about them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_parameters::ParameterList;
use bahn_plc::{Compilation, Diagnostic as Fault, Options, PlcProgram, ProgramMemory, SourceFiles};

use super::options::ProgramOptions;
use crate::diagnostics::{self, FileFault, Marked, PRINTED_MAX, Severity};
use crate::{UsageError, files, settings};

/// A compiled program with the folder it comes from.
pub(crate) struct Source {
    folder: Folder,
    /// The machine parameters of the model or of the user's list.
    pub parameters: ParameterList,
    pub compilation: Compilation,
}

impl Source {
    /// Compiles the main file and what it links.
    pub fn compile(options: &ProgramOptions) -> Result<Source, UsageError> {
        // An unreadable main file is wrong use; a linked one is an error of the program.
        let bytes = files::read_table(&options.file)?;
        let parameters = settings::parameter_list(options.model, options.parameters.as_deref())?;
        // Only the list of a machine says that it has an EPROM.
        let memory = match &options.parameters {
            Some(_) if parameters.plc_parameters().from_eprom => ProgramMemory::Eprom,
            _ => ProgramMemory::Ram,
        };
        let mut compile_options = Options::for_model(options.model).stored_in(memory);
        compile_options.strict = options.strict;
        Ok(Source::compile_bytes(
            &options.file,
            Some(bytes),
            parameters,
            compile_options,
        ))
    }

    /// Compiles the main file for a machine.
    pub fn compile_for(file: &Path, parameters: ParameterList, options: Options) -> Source {
        Source::compile_bytes(file, None, parameters, options)
    }

    /// Compiles a main file that was read already: a pipe can be read only once.
    fn compile_bytes(
        file: &Path,
        bytes: Option<Vec<u8>>,
        parameters: ParameterList,
        options: Options,
    ) -> Source {
        let main = file.file_name().unwrap_or_default().to_string_lossy();
        let memory = options.memory;
        let folder = Folder {
            folder: file.parent().map(Path::to_owned).unwrap_or_default(),
            main: main.to_string(),
            bytes,
            memory,
        };
        let compilation = Compilation::compile(&folder, &main, options);
        Source {
            folder,
            parameters,
            compilation,
        }
    }

    /// Prints errors and warnings as rustc does.
    pub fn print_faults(&self) {
        let faults = self.faults();
        faults.iter().take(PRINTED_MAX).for_each(FileFault::print);
        let rest = faults.len().saturating_sub(PRINTED_MAX);
        diagnostics::print_rest(rest + self.compilation.not_listed);
    }

    /// What keeps the program from running, then what is accepted although the printed rules refuse it.
    pub fn faults(&self) -> Vec<FileFault> {
        let errors = self.compilation.errors.iter();
        let errors = errors.map(|fault| self.fault(Severity::Error, fault));
        let warnings = self.compilation.warnings.iter();
        errors
            .chain(warnings.map(|fault| self.fault(Severity::Warning, fault)))
            .collect()
    }

    /// The program; prints errors and warnings, and gives `None` when there are errors.
    pub fn program(mut self) -> Option<Arc<PlcProgram>> {
        self.print_faults();
        self.compilation.program.take().map(Arc::new)
    }

    fn fault(&self, severity: Severity, fault: &Fault) -> FileFault {
        let detail = fault
            .message
            .strip_prefix(fault.error.text())
            .unwrap_or(&fault.message);
        FileFault {
            severity,
            title: format!("{} {}", fault.error.number(), fault.error.text()),
            path: self.folder.path(&fault.file),
            marked: self.marked(&fault.file, (fault.line, fault.column)),
            label: detail.trim_start_matches(':').trim().to_owned(),
            help: Some(format!("{} {}", fault.error.cause(), fault.error.cure())),
            opened: fault.opened.map(|place| self.marked(&fault.file, place)),
        }
    }

    /// The word of a file that begins at line and column.
    fn marked(&self, file: &str, (line, column): (u32, u32)) -> Marked {
        let file = self.compilation.files.iter().find(|own| own.name == file);
        let index = (line as usize).saturating_sub(1);
        let text = file.and_then(|file| file.lines.get(index)).cloned();
        let text = text.unwrap_or_default();
        let start = column.saturating_sub(1) as usize;
        let word = text.chars().skip(start).take_while(|c| !c.is_whitespace());
        let length = u32::try_from(word.count()).unwrap_or(1).max(1);
        Marked {
            line,
            text,
            columns: Some((column.max(1), length)),
        }
    }
}

/// The source files beside the main file, and those in its folder EPROM; names lose folders.
struct Folder {
    folder: PathBuf,
    main: String,
    /// Of the main file, where it was read before.
    bytes: Option<Vec<u8>>,
    memory: ProgramMemory,
}

impl Folder {
    /// Where a file was found.
    fn path(&self, name: &str) -> PathBuf {
        let (ram, eprom) = (self.folder.join(name), self.folder.join(EPROM).join(name));
        let is_ram = name == self.main || self.memory == ProgramMemory::Ram && ram.is_file();
        if is_ram { ram } else { eprom }
    }
}

/// The folder that stands for the EPROM.
const EPROM: &str = "EPROM";

impl SourceFiles for Folder {
    fn read(&self, name: &str) -> Option<Vec<u8>> {
        let main = self.bytes.as_ref().filter(|_| name == self.main);
        main.cloned().or_else(|| read_in(&self.folder, name))
    }

    /// The main file runs from wherever it is.
    fn read_eprom(&self, name: &str) -> Option<Vec<u8>> {
        if name == self.main {
            return self.read(name);
        }
        read_in(&self.folder.join(EPROM), name)
    }
}

fn read_in(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let name = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    if name.is_empty() || name == "." || name == ".." {
        return None;
    }
    [name.to_owned(), name.to_ascii_lowercase()]
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())
        .and_then(|path| files::read_table(&path).ok())
}
