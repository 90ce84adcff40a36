//! `bahn run` on a machine with a System 900.

use std::path::Path;

use bahn_host::{
    AnyPlant, Clock, Host, Host900, Job900, LogFile, Machine900, Operator900, Play, PowerOn900, Script900,
    Stage900, is_whole,
};
use bahn_report::Follower;
use bahn_report::junit;
use bahn_report::record::ErrorReport;
use bahn_report::run::Patience;
use bahn_report::run900::{Ended900, Recording900, RunReport900, Session900, usual_parameters};
use bahn_report::test_run::Outputs;
use bahn_system900::Memory;
use bahn_text::Diagnostic;

use super::options::RunMachineOptions;
use crate::interrupt::Interrupt;
use crate::options::Format;
use crate::progress::Progress;
use crate::{Outcome, UsageError, console, diagnostics, files};

/// Runs the programs of a machine and reports.
pub(super) fn command(options: &RunMachineOptions) -> Result<Outcome, UsageError> {
    UsageError::unless_of_a_tnc(&of_a_tnc(options), &options.machine)?;
    let machine = match Machine900::load(&options.machine)? {
        Ok(machine) => machine,
        Err(faults) => return refused(&faults),
    };
    let inputs = machine.inputs();
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    files::keep_inputs(&inputs, &options.written())?;
    let power_on = power_on(options, &machine)?;
    let plant = machine.plant(&power_on.memory);
    let script = match load_script(options, &power_on.memory, &plant)? {
        Ok(script) => script,
        Err(faults) => return refused(&faults),
    };
    let recording = recording(options, &power_on.memory)?;
    let job = Job900 {
        single_block: options.run.single_block,
    };
    let attendance = options.run.attendance();
    let host = Host::of_system900(power_on, plant, Operator900::new(attendance, job));
    let mut session = session(options, &machine, host, script, recording)?;
    let interrupt = Interrupt::on_ctrl_c();
    session.host.break_off_by(interrupt.flag());
    let mut progress = Progress::new(&interrupt);
    progress.begin(0);
    let ended = session.run(&mut progress);
    drop(progress);
    // What could not be stored loses no report.
    let switched_off = session.host.store();
    let ended = ended.unwrap_or_else(|error| Ended900::Failed(error.to_string()));
    let outcome = finish(session, &ended, &machine, options)?;
    switched_off?;
    Ok(outcome)
}

/// Options that mean something to a TNC alone, and whether they are given.
fn of_a_tnc(options: &RunMachineOptions) -> [(&'static str, bool); 15] {
    let (run, output) = (&options.run, &options.output);
    [
        ("--with", options.with.is_some()),
        ("--tools", run.tools.is_some()),
        ("--mp", !run.mp.is_empty()),
        ("--override", run.override_percent.is_some()),
        ("--inch-feed", run.inch_feed.is_some()),
        ("--strict", run.strict),
        ("--skip-unknown", run.skip_unknown),
        ("--block-time", run.block_time),
        ("--oscilloscope", options.oscilloscope.oscilloscope.is_some()),
        ("--print", output.print.is_some()),
        ("--digitized", output.digitized.is_some()),
        ("--solid", output.solid.is_some()),
        ("--compare", output.compare.is_some()),
        ("--image", output.image.is_some()),
        ("--mesh", output.mesh.is_some()),
    ]
}

fn refused(faults: &[Diagnostic]) -> Result<Outcome, UsageError> {
    diagnostics::print_faults(faults);
    Ok(Outcome::ProgramError)
}

/// What the control finds, with the programs that were named.
fn power_on(options: &RunMachineOptions, machine: &Machine900) -> Result<PowerOn900, UsageError> {
    let mut power_on = match options.run.fresh {
        true => PowerOn900::fresh(machine),
        false => PowerOn900::kept(machine)?,
    };
    power_on.run(&options.files).map_err(UsageError::new)?;
    if let Some(block) = options.run.start_block {
        power_on.begin_at(block).map_err(UsageError::new)?;
    }
    Ok(power_on)
}

fn load_script(
    options: &RunMachineOptions,
    memory: &Memory,
    plant: &AnyPlant,
) -> Result<Result<Script900, Vec<Diagnostic>>, UsageError> {
    let Some(path) = options.run.script.as_ref().or(options.run.replay.as_ref()) else {
        return Ok(Ok(Script900::default()));
    };
    let bytes = files::read_table(path)?;
    if options.run.replay.is_some() && !is_whole(&bytes) {
        diagnostics::print_text(&format!(
            "warning: {}: the log is not as it was written: damaged, cut off or edited",
            path.display()
        ));
    }
    Ok(Stage900::new(memory, plant).script(path, &bytes))
}

fn recording(options: &RunMachineOptions, memory: &Memory) -> Result<Option<Recording900>, UsageError> {
    let wanted = &options.recording;
    let names = wanted.names()?;
    for name in names.iter().chain(&options.read) {
        memory
            .place(*name)
            .map_err(|error| UsageError::new(error.to_string()))?;
    }
    let Some(path) = &wanted.record else {
        return Ok(None);
    };
    let names = if names.is_empty() {
        usual_parameters(memory)
    } else {
        names
    };
    let every_us = wanted.every.map_or(0, |ms| u64::from(ms) * 1000);
    Ok(Some(Recording900::create(path, names, every_us, memory)?))
}

fn session(
    options: &RunMachineOptions,
    machine: &Machine900,
    mut host: Host900,
    script: Script900,
    recording: Option<Recording900>,
) -> Result<Session900, UsageError> {
    if let Some(path) = &options.run.log {
        let title = format!("{}; bahn run --replay repeats it", machine.folder.name);
        host.set_log(Box::new(LogFile::create(path, &title)?));
    }
    if options.run.realtime {
        host.set_clock(Clock::Wall(1.0));
    }
    let patience = Patience {
        time_us: (options.run.max_time * 1e6) as u64,
        wait_us: (options.run.max_wait * 1e6) as u64,
    };
    let outputs = Outputs::create(&options.output.path, None)?;
    Ok(Session900::new(
        host,
        Play::new(script),
        outputs,
        recording,
        patience,
    ))
}

/// Writes all files and the report.
fn finish(
    mut session: Session900,
    ended: &Ended900,
    machine: &Machine900,
    options: &RunMachineOptions,
) -> Result<Outcome, UsageError> {
    let mut written = session.finish_files().map_err(UsageError::from);
    if let Some(path) = &options.run.sample {
        written = written.and(write_sample(path, &session.host));
    }
    diagnostics::print_faults(&session.play.failures());
    let report = RunReport900::of(&mut session, ended, &machine.folder.name, &options.read);
    if let Some((channel, error)) = report.failure() {
        say_failure(&session, channel, error);
    }
    let outcome = match ended {
        Ended900::Completed if session.play.failed.is_empty() => Outcome::Fine,
        Ended900::Interrupted => {
            diagnostics::print_line("interrupted: the report so far");
            Outcome::Interrupted
        }
        _ => Outcome::ProgramError,
    };
    if let Some(path) = &options.run.junit {
        let stopped = report.failure().map(|(_, error)| error.message.as_str());
        let cases = junit::write(path, &machine.folder.name, &session.play.expectations(), stopped);
        written = written.and(cases.map_err(UsageError::from));
    }
    if options.format == Format::Json {
        console::print_json(&report)?;
    } else {
        let mut names = options.output.names(written.is_ok());
        let further = [&options.recording.record, &options.run.log, &options.run.sample];
        let files = further.into_iter().flatten();
        names.extend(files.map(|path| path.display().to_string()));
        console::print(&report.text(&names))?;
    }
    written?;
    Ok(outcome)
}

/// The event buffer as the control puts it out. It has no calendar: no date is said.
fn write_sample(path: &Path, host: &Host900) -> Result<(), UsageError> {
    let control = host.control();
    let text = control.events().output("-", control.now_us() / 1000);
    files::write_whole(path, text.as_bytes())?;
    Ok(())
}

/// Says it with the block where that is known.
fn say_failure(session: &Session900, channel: u8, error: &ErrorReport) {
    let program = session
        .host
        .control()
        .reader(channel)
        .and_then(|run| run.program(error.at.program))
        .filter(|_| error.line > 0);
    // A cycle lies beside the program that calls it.
    let main = session.host.program_file(channel).unwrap_or_default();
    match program {
        Some(program) => {
            let file = main.with_file_name(&error.program);
            diagnostics::print_faults(&[error.diagnostic(program, &file)]);
        }
        None => diagnostics::print_usage_error(&error.message),
    }
}
