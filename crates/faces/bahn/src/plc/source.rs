//! A program for the desk, and what the compiler says about it.

use std::ops::Deref;
use std::sync::Arc;

use bahn_host::{Machine900, PlcSource};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Options, PlcProgram, ProgramMemory};
use bahn_text::Diagnostic;

use super::options::ProgramOptions;
use crate::diagnostics::{self, PRINTED_MAX};
use crate::{UsageError, files, settings};

/// A compiled program with its machine parameters.
pub(super) struct Source {
    source: PlcSource,
    /// What of a machine with a System 900 does not go together with it: its window, what is of a TNC.
    pub of_machine: Vec<Diagnostic>,
    /// The machine parameters of the model or of the user's list.
    pub parameters: ParameterList,
}

impl Source {
    /// Compiles the main file and what it links.
    pub fn compile(options: &ProgramOptions) -> Result<Source, UsageError> {
        if options.file.is_dir() {
            return Source::of_machine(options);
        }
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
        Ok(Source {
            source: PlcSource::compile(&options.file, Some(bytes), compile_options),
            of_machine: Vec::new(),
            parameters,
        })
    }

    /// The program of the folder of a machine with a System 900.
    fn of_machine(options: &ProgramOptions) -> Result<Source, UsageError> {
        let folder = &options.file;
        let wrong = |what: &str| UsageError::new(format!("{}: {what}", folder.display()));
        if !Machine900::is_meant(folder) {
            return Err(wrong(
                "this command takes the main file of a PLC program, or the folder of a machine with a System 900",
            ));
        }
        if options.parameters.is_some() || options.model != ControlModel::default() {
            return Err(wrong(
                "--parameters and --model are for a TNC, and this machine has a System 900",
            ));
        }
        let main = Machine900::plc_file(folder)?
            .ok_or_else(|| wrong("`plc` in machine.toml names no PLC program"))?;
        let bytes = files::read_table(&main)?;
        let mut compile_options = Options::default();
        compile_options.strict = options.strict;
        let source = PlcSource::compile(&main, Some(bytes), compile_options);
        let of_machine = match source.compilation.program.is_some() {
            true => Machine900::load(folder)?.err().unwrap_or_default(),
            false => Vec::new(),
        };
        Ok(Source {
            source,
            of_machine,
            parameters: settings::parameter_list(options.model, None)?,
        })
    }

    /// Prints errors and warnings as rustc does.
    pub fn print_faults(&self) {
        let faults = [self.source.faults(), self.of_machine.clone()].concat();
        let shown = faults.iter().take(PRINTED_MAX);
        shown.for_each(diagnostics::print_fault);
        let rest = faults.len().saturating_sub(PRINTED_MAX);
        diagnostics::print_rest(rest + self.source.compilation.not_listed);
    }

    /// The program; prints errors and warnings, and gives `None` when there are errors.
    pub fn program(mut self) -> Option<Arc<PlcProgram>> {
        self.print_faults();
        self.source.compilation.program.take().map(Arc::new)
    }
}

impl Deref for Source {
    type Target = PlcSource;

    fn deref(&self) -> &PlcSource {
        &self.source
    }
}
