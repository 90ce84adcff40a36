//! The command line as a whole: its subcommands.

use std::ffi::OsString;

use clap::{CommandFactory, Parser, Subcommand};

use crate::channel::ChannelOptions;
use crate::compensate::CompensateOptions;
use crate::conformance::ConformanceOptions;
use crate::convert::ConvertOptions;
use crate::faults::FaultsOptions;
use crate::link::LinkOptions;
use crate::lsp::LspOptions;
use crate::machine_folder::MachineFolderOptions;
use crate::manual::{CompletionsOptions, ManOptions};
use crate::mp::MpOptions;
use crate::oem::OemOptions;
use crate::options::{
    CHECK_EXAMPLES, CheckOptions, EXPLAIN_EXAMPLES, ExplainOptions, FMT_EXAMPLES, FmtOptions,
};
use crate::panel::PanelOptions;
use crate::plc::PlcOptions;
use crate::q::QOptions;
use crate::run::RunMachineOptions;
use crate::scope::ScopeOptions;
use crate::table::TableOptions;
use crate::technology::TechnologyOptions;
use crate::test_run::TestOptions;
use crate::torture::TortureOptions;
use crate::tune::TuneOptions;
use crate::{Outcome, refused};

/// Software contouring control for HEIDENHAIN plain-language programs: checks them as the control would,
/// shows every tool movement, the machining time and the finished part.
#[derive(Debug, Parser)]
#[command(
    name = "bahn",
    version,
    after_help = "Exit codes: 0 fine, 1 the program has an error, 2 wrong use."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The commands of `bahn`.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a program without a machine: report, tool path, picture of the part.
    #[command(after_help = crate::test_run::EXAMPLES)]
    Test(Box<TestOptions>),
    /// Run a program on a simulated machine: power-up, reference run, program, with PLC and servo loops.
    #[command(after_help = crate::run::EXAMPLES)]
    Run(Box<RunMachineOptions>),
    /// Sit down at the operating panel of a machine, in the browser or in the terminal.
    #[command(after_help = crate::panel::EXAMPLES)]
    Panel(PanelOptions),
    /// Draw recorded signals like an oscilloscope, and sum them up.
    #[command(after_help = crate::scope::EXAMPLES)]
    Scope(Box<ScopeOptions>),
    /// Find machine parameters by circle tests on the simulated machine, as at commissioning.
    #[command(after_help = crate::tune::EXAMPLES)]
    Tune(Box<TuneOptions>),
    /// Measure axis errors of the simulated machine as a laser interferometer does, and compensate them.
    #[command(after_help = crate::compensate::EXAMPLES)]
    Compensate(CompensateOptions),
    /// Write, check and list folders of machines.
    Machine(MachineFolderOptions),
    /// Show all errors of programs that can be found without running them.
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckOptions),
    /// Write programs as normalised listing: block numbers, signs and spacing as the control prints them.
    #[command(after_help = FMT_EXAMPLES)]
    Fmt(FmtOptions),
    /// Write programs in another language, and prove that they do the same.
    #[command(after_help = crate::convert::EXAMPLES)]
    Convert(Box<ConvertOptions>),
    /// Serve an editor while programs and lists are written: the Language Server Protocol.
    #[command(after_help = crate::lsp::EXAMPLES)]
    Lsp(LspOptions),
    /// Compile, run and debug PLC programs.
    Plc(Box<PlcOptions>),
    /// Check, explain, compare and write lists of machine parameters.
    Mp(Box<MpOptions>),
    /// Run programs with M, H and S functions on a channel: where each is output, and where the path waits for it.
    #[command(after_help = crate::technology::EXAMPLES)]
    Technology(Box<TechnologyOptions>),
    /// Check, explain and write lists of channel parameters: when M, H and spindle functions reach the PLC.
    Channel(ChannelOptions),
    /// Check, explain, compare and change parameters of a System 900: data files with q and P numbers.
    Q(Box<QOptions>),
    /// List the cycles of the machine builder, and write EPROMs with them.
    Oem(OemOptions),
    /// Show, check, change and convert tables: tools, pockets, datums, pallets, points.
    Table(Box<TableOptions>),
    /// Talk with controls and devices by their data interfaces.
    Link(Box<LinkOptions>),
    /// List what each function of a control does here: M functions, cycles, words, machine parameters and so on.
    #[command(after_help = crate::conformance::EXAMPLES)]
    Conformance(ConformanceOptions),
    /// List what the control does about each fault: message, reaction, way that is left, what clears it.
    #[command(after_help = crate::faults::EXAMPLES)]
    Faults(FaultsOptions),
    /// Run the programs of machines while random things fail, and hold every contour cycle to rules.
    #[command(after_help = crate::torture::EXAMPLES)]
    Torture(TortureOptions),
    /// Say what a message or PLC error means and what to do about it; search by word.
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(ExplainOptions),
    /// Print the completions of a shell.
    #[command(after_help = crate::manual::COMPLETIONS_EXAMPLES)]
    Completions(CompletionsOptions),
    /// Write the manual pages.
    #[command(after_help = crate::manual::MAN_EXAMPLES)]
    Man(ManOptions),
}

/// Reads the arguments; prints help and errors of use itself.
pub(crate) fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Command, Outcome> {
    match Cli::try_parse_from(arguments) {
        Ok(cli) => Ok(cli.command),
        Err(error) => {
            // Nobody reads it when the output is closed.
            let _ = error.print();
            if !error.use_stderr() {
                return Err(Outcome::Fine);
            }
            // What is wrong stands before tips and usage.
            let text = error.to_string();
            refused::error(text.split("\n\n").next().unwrap_or_default());
            Err(Outcome::WrongUse)
        }
    }
}

/// The command with all subcommands, for what is made of it.
pub(crate) fn whole_command() -> clap::Command {
    Cli::command()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_consistent() {
        Cli::command().debug_assert();
    }
}
