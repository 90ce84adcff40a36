//! A program for the desk, and what the compiler says about it.

use std::ops::Deref;
use std::sync::Arc;

use bahn_host::PlcSource;
use bahn_parameters::ParameterList;
use bahn_plc::{Options, PlcProgram, ProgramMemory};

use super::options::ProgramOptions;
use crate::diagnostics::{self, PRINTED_MAX};
use crate::{UsageError, files, settings};

/// A compiled program with its machine parameters.
pub(super) struct Source {
    source: PlcSource,
    /// The machine parameters of the model or of the user's list.
    pub parameters: ParameterList,
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
        Ok(Source {
            source: PlcSource::compile(&options.file, Some(bytes), compile_options),
            parameters,
        })
    }

    /// Prints errors and warnings as rustc does.
    pub fn print_faults(&self) {
        let faults = self.source.faults();
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
