//! Commands that act on the program run.

use bahn_parameters::operation::RestartParameters;

use crate::command::Command;
use crate::run::ProgramRun;
use crate::site::Site;
use crate::source::Basis;

/// Executes a command of the program run; `false` when it is not possible now, or none of the run.
pub(crate) fn execute(
    command: Command,
    rules: &RestartParameters,
    run: &mut ProgramRun,
    site: &mut Site,
    basis: &Basis,
) -> bool {
    match command {
        Command::InternalStop => run.internal_stop(site),
        Command::Select(name) => run.select(name, site, basis),
        Command::Goto(block) => run.goto(block),
        Command::Mdi(blocks) => run.set_mdi(blocks),
        Command::ManualOperation => run.manual_operation(rules, site),
        Command::RestorePosition => run.restore_position(site),
        Command::RestoreAt(block) => run.restore_at(block, rules, site, basis),
        // `Set` and `Power` are of the whole control.
        _ => false,
    }
}
