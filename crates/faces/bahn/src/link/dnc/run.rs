//! `bahn link dnc run`: a machine executes a program while it is transferred.

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_host::{Attendance, Clock, FolderPrograms, Host, Job, LoadedMachine, Operable, Operator, PowerOn};
use bahn_link::dnc::ProtocolLine;
use bahn_ports::dnc::{Ended, Session, Wishes};
use bahn_tnc::Mode;

use super::options::DncRunOptions;
use super::port;
use super::report::DncReport;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::{Outcome, UsageError, console, diagnostics, machine_folder, settings};

/// Executes a program on a machine while it comes from a line.
pub(super) fn command(options: &DncRunOptions) -> Result<Outcome, UsageError> {
    let mut machine = match machine_folder::load(&options.machine)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let model = machine.parameters.model();
    if !model.transfers_blockwise() {
        return Err(UsageError::new(format!(
            "the {} is an export version without \"transfer blockwise\": transfer the program first, then run \
             it from its memory",
            model.name()
        )));
    }
    let mut power_on = match options.fresh {
        true => PowerOn::fresh(&machine),
        false => PowerOn::kept(&machine)?,
    };
    diagnostics::print_warnings(&power_on.warnings);
    settings::assign(&mut power_on.parameters, &options.mp)?;
    settings::say_without_effect(&power_on.parameters, &options.mp);
    machine.parameters = power_on.parameters.clone();
    let Some((channel, settings)) = port::open(&options.port, &machine.parameters) else {
        return Ok(Outcome::ProgramError);
    };
    let mut line = ProtocolLine::new(channel, settings);
    let programs = Arc::new(FolderPrograms::of_folder(&machine.programs(0)));
    let host = Host::new(&machine, power_on, programs, operator(options, &machine))?;
    let interrupt = Interrupt::on_ctrl_c();
    let wishes = Wishes {
        name: options.name.clone(),
        restarts: options.restarts,
        realtime: options.realtime,
    };
    let mut session = Session::new(host, &mut line, wishes);
    session.host.break_off_by(interrupt.flag());
    if options.realtime {
        session.host.set_clock(Clock::Wall(1.0));
    }
    let ended = session.run(&|| interrupt.is_requested())?;
    let stored = session.host.store();
    print(&report(&session, &ended, options), options)?;
    stored?;
    Ok(match ended {
        Ended::Completed => Outcome::Fine,
        Ended::Message(_) => Outcome::ProgramError,
        Ended::Interrupted => Outcome::Interrupted,
    })
}

fn operator(options: &DncRunOptions, machine: &LoadedMachine) -> Operator {
    let attendance = match options.confirm_stops {
        true => Attendance::Full,
        false => Attendance::StopsWait,
    };
    let job = Job {
        program: options.name.clone(),
        mode: match options.single_block {
            true => Mode::SingleBlock,
            false => Mode::FullSequence,
        },
        start_block: options.start_block,
        transferred: true,
    };
    let first = Operator::new(attendance, machine.folder.operator.clone(), Some(job));
    machine.channels.iter().fold(first, |operator, channel| {
        operator.with_channel(channel.folder.operator.clone(), None)
    })
}

fn report<P: Operable>(session: &Session<'_, P>, ended: &Ended, options: &DncRunOptions) -> DncReport {
    let control = session.host.control();
    let axes = control.snapshot().axes;
    let position: BTreeMap<char, f64> = axes
        .iter()
        // The input step of all controls is coarser.
        .map(|axis| (axis.letter, (axis.nominal * 1e5).round() / 1e5))
        .collect();
    let since = session.start_us.unwrap_or(control.time_us());
    DncReport {
        program: options.name.clone(),
        completed: *ended == Ended::Completed,
        blocks: session.blocks(),
        executed: control.reader().map_or(0, |run| run.blocks_executed()),
        position,
        message: match ended {
            Ended::Message(message) => Some(message.clone()),
            _ => None,
        },
        machining_time_s: control.time_us().saturating_sub(since) as f64 * 1e-6,
    }
}

fn print(report: &DncReport, options: &DncRunOptions) -> Result<(), UsageError> {
    match options.format {
        Format::Text => console::print(&report.text()),
        // One line, since lines of others may stand before it.
        Format::Json => console::print_json_line(report),
    }
}
