//! From options to a program on the test bench.

use std::path::Path;
use std::sync::Arc;

use bahn_exchange::Exchange;
use bahn_host::{Assignment, Script, Stage};
use bahn_parameters::ParameterList;
use bahn_plc::PlcProgram;
use bahn_report::plc::Bench;

use super::options::BenchOptions;
use crate::{UsageError, diagnostics, files};

/// A program with the operands of `--set`; `exchange` holds what was retained.
pub(super) fn bench(
    program: Arc<PlcProgram>,
    parameters: ParameterList,
    options: &BenchOptions,
    exchange: Exchange,
) -> Result<Bench, UsageError> {
    let script = match &options.script {
        Some(path) => load(path, &parameters)?,
        None => Script::default(),
    };
    let bench = Bench::new(program, parameters, script, &set_operands(options)?, exchange);
    bench.map_err(|error| UsageError::new(format!("--set {error}")))
}

/// Reads a script for the bench.
fn load(path: &Path, parameters: &ParameterList) -> Result<Script, UsageError> {
    let bytes = files::read_table(path)?;
    Stage::bench(parameters).script(path, &bytes).map_err(|faults| {
        diagnostics::print_faults(&faults);
        UsageError::new(format!("{}: the script is wrong", path.display()))
    })
}

/// What `--set` assigns; an error names the operand.
pub(super) fn set_operands(options: &BenchOptions) -> Result<Vec<Assignment>, UsageError> {
    let mut all = Vec::new();
    for text in &options.set {
        all.extend(
            Assignment::parse_all(text).map_err(|error| UsageError::new(format!("--set {text}: {error}")))?,
        );
    }
    // Machine parameters first: they go to words that may be set, too.
    all.sort_by_key(|assignment| matches!(assignment, Assignment::Operand(..)));
    Ok(all)
}
