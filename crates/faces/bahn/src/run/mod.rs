//! `bahn run`: a part program on the simulated machine.
//!
//! - `system900`: the same on a machine with a System 900;
//! - `options`: options and help text; `oscilloscope`: what is asked of the control's oscilloscope; `module`: the positioning
//!   module that goes along.
//!
//! What is seen of the run and said in the end is [`bahn_report::run`].

mod module;
mod options;
mod oscilloscope;
mod system900;

use options::SignalName;
pub(crate) use options::{EXAMPLES, RunMachineOptions};

use std::path::{Path, PathBuf};
use std::sync::Arc;

use bahn_host::{
    Action, Clock, FolderPrograms, Host, Job, LoadedMachine, LogFile, Machine900, Observable, Observed,
    Operator, Play, PowerOn, Script, Source, Stage, is_whole,
};
use bahn_panel::Waits;
use bahn_report::record::ErrorReport;
use bahn_report::run::{
    Ended, Executed, ModuleRun, Patience, Recording, Reported, Session, Table, usual_signals,
};
use bahn_report::test_run::Outputs;
use bahn_report::{Follower, junit, solid};
use bahn_tnc::{Checking, Control, Mode, Signal};
use bahn_workpiece::{Columns, Cutting, Projection};

use crate::cutting::{self, Written};
use crate::diagnostics;
use crate::interrupt::Interrupt;
use crate::machine_folder;
use crate::options::Format;
use crate::progress::Progress;
use crate::test_run::print_error;
use crate::{Outcome, UsageError, console, files, settings};

/// Runs a program on a machine and reports.
pub(crate) fn command(options: &RunMachineOptions) -> Result<Outcome, UsageError> {
    files::keep_inputs(&options.inputs(), &options.written())?;
    if Machine900::is_meant(&options.machine) {
        return system900::command(options);
    }
    if let Some(name) = options.read.first() {
        return Err(UsageError::new(format!(
            "--read {name}: a parameter of a System 900, and the machine has a TNC"
        )));
    }
    if options.run.sample.is_some() {
        return Err(UsageError::new(
            "--sample writes the event buffer of a System 900, and the machine has a TNC",
        ));
    }
    on_a_tnc(options)
}

/// Runs a program on a machine with a TNC.
fn on_a_tnc(options: &RunMachineOptions) -> Result<Outcome, UsageError> {
    let mut machine = match machine_folder::load_with_tools(&options.machine, options.run.tools.as_deref())? {
        Ok(machine) => machine,
        Err(faults) => return refused(&faults),
    };
    let inputs = machine.inputs();
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    files::keep_inputs(&inputs, &options.written())?;
    let mut programs = all_programs(options, &machine)?;
    let (beside, script) = match load_beside(options, &machine)? {
        Ok(found) => found,
        Err(faults) => return refused(&faults),
    };
    let mut power_on = power_on(options, &machine)?;
    settings::assign(&mut power_on.parameters, &options.run.mp)?;
    settings::say_without_effect(&power_on.parameters, &options.run.mp);
    machine.parameters = power_on.parameters.clone();
    let start_block = start_block(options.run.start_block, programs.first())?;
    let operator = operator(options, &machine, &programs, start_block);
    for (channel, programs) in power_on.channels.iter_mut().zip(programs.split_off(1)) {
        channel.programs = programs;
    }
    let Some(programs) = programs.pop() else {
        return Ok(Outcome::WrongUse);
    };
    let shared = Arc::clone(&programs) as Arc<dyn bahn_tnc::Programs>;
    let mut host = Host::new(&machine, power_on, shared, operator)?;
    let table = table(options, &machine, &mut host)?;
    if let Some(path) = &options.run.log {
        let program = programs.main_name().unwrap_or("no program");
        let title = format!("{}, {program}; bahn run --replay repeats it", machine.folder.name);
        host.set_log(Box::new(LogFile::create(path, &title)?));
    }
    if let Some(percent) = options.run.override_percent {
        let action = Action::parse(&format!("override feed {percent}"));
        host.act(
            Source::Operator,
            action.map_err(|error| UsageError::new(error.to_string()))?,
        )?;
    }
    let interrupt = Interrupt::on_ctrl_c();
    host.break_off_by(interrupt.flag());
    let cutting = (!options.output.no_graphics).then(|| {
        let columns = options.output.resolution;
        Cutting::new(
            columns.map_or(Columns::BySize, Columns::Millimetres),
            cutting::memory(&options.output),
            settings::left_hand(machine.tools.as_ref()),
        )
    });
    let module = module::switch_on(options, beside.as_ref(), &host)?;
    let recording = recording(options, &machine, host.control(), module.as_ref())?;
    let oscilloscope = oscilloscope::scoped(&options.oscilloscope, host.control())?;
    let outputs = Outputs::create(&options.output.path, options.output.print.as_deref())?;
    let executed = Executed::new(0, cutting, outputs);
    let patience = Patience {
        time_us: (options.run.max_time * 1e6) as u64,
        wait_us: (options.run.max_wait * 1e6) as u64,
    };
    keep_pace(options, &script, executed.needs_programs(), &mut host);
    let mut session = Session::new(host, Play::new(script), executed, recording, patience);
    session.oscilloscope = oscilloscope;
    session.table = table;
    session.module = module;
    session.waits = Some(Waits::new(&machine, session.host.plant()));
    let blocks = programs.main().map_or(0, |main| main.block_count());
    let mut progress = Progress::new(&interrupt);
    progress.begin(blocks);
    // A file that cannot be written loses no report.
    let ended = session.run(&mut progress, &machine);
    let ended = ended.unwrap_or_else(|error| Ended::Failed(error.to_string()));
    drop(progress);
    let switched_off = session.host.store();
    let module_off = session
        .module
        .as_mut()
        .map_or(Ok(()), |beside| beside.module.host.store());
    // What could not be stored loses no report.
    let outcome = finish(session, ended, &machine, &programs, options, &interrupt)?;
    switched_off.and(module_off)?;
    Ok(outcome)
}

/// In real time the programs are watched where somebody looks into them.
fn keep_pace(options: &RunMachineOptions, script: &Script, needs_programs: bool, host: &mut Host) {
    if options.run.realtime {
        host.set_clock(Clock::Wall(1.0));
        let q = |signal: &SignalName| {
            let observed = signal.observed.as_ref();
            observed.is_ok_and(|signal| matches!(signal.what, Observable::Signal(Signal::Q(_))))
        };
        let looks = options.recording.signals.iter().any(q) || !script.lines.is_empty();
        if looks || needs_programs {
            host.watch_programs();
        }
    }
}

/// What files hold, or what is wrong with them.
type Loaded<T> = Result<T, Vec<bahn_text::Diagnostic>>;

/// The module that goes along, and the script, which may speak of it.
fn load_beside(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
) -> Result<Loaded<(Option<LoadedMachine>, Script)>, UsageError> {
    let beside = match module::load(options, machine)? {
        Ok(beside) => beside,
        Err(faults) => return Ok(Err(faults)),
    };
    let script = load_script(options, machine, beside.as_ref())?;
    Ok(script.map(|script| (beside, script)))
}

/// What lies on the table: the solid of the command or of machine.toml, at the datum of machine.toml.
fn table(options: &RunMachineOptions, machine: &LoadedMachine, host: &mut Host) -> Result<Table, UsageError> {
    let own = machine
        .folder
        .solid
        .as_ref()
        .map(|solid| machine.root.join(solid));
    let solid = match options.output.solid.clone().or(own) {
        Some(path) => Some(solid::read(&path, options.output.resolution)?),
        None => None,
    };
    if solid.is_some() && host.plant().probe_radius_mm().is_none() {
        return Err(UsageError::new(format!(
            "a solid lies on the table, and {} has no touch probe: [probe] in {}",
            machine.folder.name,
            machine.folder.plant.as_deref().unwrap_or_default()
        )));
    }
    Ok(Table::with(solid, &machine.datum(), host))
}

/// Prints the faults of files that keep a machine from being switched on.
fn refused(faults: &[bahn_text::Diagnostic]) -> Result<Outcome, UsageError> {
    diagnostics::print_faults(faults);
    Ok(Outcome::ProgramError)
}

fn load_script(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
    module: Option<&LoadedMachine>,
) -> Result<Loaded<Script>, UsageError> {
    let (path, is_log) = match (&options.run.script, &options.run.replay) {
        (Some(path), _) => (path, false),
        (None, Some(path)) => (path, true),
        (None, None) => return Ok(Ok(Script::default())),
    };
    let bytes = files::read_table(path)?;
    if is_log && !is_whole(&bytes) {
        diagnostics::print_text(&format!(
            "warning: {}: the log is not as it was written: damaged, cut off or edited",
            path.display()
        ));
    }
    let mut stage = Stage::machine(machine.simulated()?, &machine.parameters);
    if let Some(module) = module {
        stage = stage.with_module(Stage::machine(module.simulated()?, &module.parameters));
    }
    Ok(stage.script(path, &bytes))
}

/// What the control finds.
fn power_on(options: &RunMachineOptions, machine: &LoadedMachine) -> Result<PowerOn, UsageError> {
    let mut power_on = match options.run.fresh {
        true => PowerOn::fresh(machine),
        false => PowerOn::kept(machine)?,
    };
    diagnostics::print_warnings(&power_on.warnings);
    power_on.checking = Checking {
        strict: options.run.strict,
        skip_unknown: options.run.skip_unknown,
    };
    power_on.inch_feed = options.run.inch_feed.map(Into::into);
    power_on.block_time = options.run.block_time;
    Ok(power_on)
}

/// The programs of each channel: those that were named in their order, or those of machine.toml.
fn all_programs(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
) -> Result<Vec<Arc<FolderPrograms>>, UsageError> {
    let channels = 1 + machine.channels.len();
    if options.files.len() > channels {
        return Err(UsageError::new(match channels {
            1 => "the machine has one channel: it runs one program".to_owned(),
            _ => format!("the machine has {channels} channels: there are more programs"),
        }));
    }
    let mut programs = Vec::new();
    for channel in 0..channels {
        let main = match options.files.is_empty() {
            true => machine.usual_program(channel).map(Path::new),
            false => options.files.get(channel).map(PathBuf::as_path),
        };
        let programs_of = FolderPrograms::new(&machine.programs(channel), main)?;
        programs.push(Arc::new(
            programs_of.with_digitized(options.output.digitized.as_deref()),
        ));
    }
    Ok(programs)
}

/// The block to begin with, which the operator names by its number.
fn start_block(
    number: Option<u32>,
    programs: Option<&Arc<FolderPrograms>>,
) -> Result<Option<u32>, UsageError> {
    let (Some(number), Some(programs)) = (number, programs) else {
        return Ok(None);
    };
    let block = programs.main().map_or(Some(number), |main| main.block_of(number));
    let name = programs.main_name().unwrap_or_default();
    let missing = || {
        UsageError::new(format!(
            "--start-block {number}: no block of {name} has this number"
        ))
    };
    block.map(Some).ok_or_else(missing)
}

fn operator(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
    programs: &[Arc<FolderPrograms>],
    start_block: Option<u32>,
) -> Operator {
    let attendance = options.run.attendance();
    let mode = match options.run.single_block {
        true => Mode::SingleBlock,
        false => Mode::FullSequence,
    };
    let job = |channel: usize| {
        let name = programs.get(channel)?.main_name()?;
        Some(Job {
            program: name.to_owned(),
            mode,
            start_block: start_block.filter(|_| channel == 0),
            transferred: false,
        })
    };
    let first = Operator::new(attendance, machine.folder.operator.clone(), job(0));
    let others = (1..).zip(&machine.channels);
    others.fold(first, |operator, (number, channel)| {
        operator.with_channel(channel.folder.operator.clone(), job(number))
    })
}

fn recording(
    options: &RunMachineOptions,
    machine: &LoadedMachine,
    control: &Control,
    module: Option<&ModuleRun>,
) -> Result<Option<Recording>, UsageError> {
    let wanted = &options.recording;
    let Some(path) = &wanted.record else {
        return Ok(None);
    };
    let of_module = module.map(|beside| beside.module.host.control());
    let observed: Vec<Observed> = wanted.observed()?;
    for signal in &observed {
        let control = match signal.module {
            true => of_module.ok_or_else(|| {
                UsageError::new(format!(
                    "--signals {signal}: there is no module; --with says which"
                ))
            })?,
            false => control,
        };
        let Some(channel) = control.channel(signal.channel) else {
            return Err(UsageError::new(format!(
                "--signals {signal}: the machine has no channel {}",
                signal.channel + 1
            )));
        };
        let guests = machine.hand_overs.iter().filter(|one| one.to == signal.channel);
        let guests = guests.map(|one| one.letter.letter());
        let letters: Vec<char> = channel.axis_letters().chain(guests).collect();
        if let Observable::Signal(Signal::Q(number)) = signal.what
            && number > control.model().limits().q_max
        {
            return Err(UsageError::new(format!(
                "--signals {signal}: the {} has Q0 to Q{}",
                control.model(),
                control.model().limits().q_max
            )));
        }
        if let Some(letter) = signal.what.axis()
            && !letters.contains(&letter)
        {
            let known: Vec<String> = letters.iter().map(char::to_string).collect();
            return Err(UsageError::new(format!(
                "--signals {signal}: the machine has no axis {letter}; there are {}",
                known.join(", ")
            )));
        }
    }
    let signals = match observed.is_empty() {
        true => usual_signals(control),
        false => observed,
    };
    let every_us = wanted.every.map_or(0, |ms| u64::from(ms) * 1000);
    Ok(Some(Recording::create(path, signals, every_us, control.model())?))
}

/// Writes all files and the report.
fn finish(
    mut session: Session,
    ended: Ended,
    machine: &LoadedMachine,
    programs: &FolderPrograms,
    options: &RunMachineOptions,
    interrupt: &Interrupt,
) -> Result<Outcome, UsageError> {
    let model = machine.parameters.model();
    let mut written = session
        .finish_files(&mut Progress::new(interrupt))
        .map_err(UsageError::from);
    diagnostics::print_faults(&session.play.failures());
    let part = session.take_part();
    let removed_mm3 = part.as_ref().map(|part| part.removed_mm3());
    let has_program = programs.main().is_some();
    let reported = Reported::of(
        &mut session,
        &ended,
        &machine.folder.name,
        has_program,
        removed_mm3,
    );
    if let Some(error) = &reported.failure {
        say_failure(error, reported.failed_in, &session, programs);
    }
    let outcome = match &ended {
        Ended::Completed if session.play.failed.is_empty() => Outcome::Fine,
        Ended::Interrupted => {
            diagnostics::print_line("interrupted: the report so far");
            Outcome::Interrupted
        }
        // What could not be written was said.
        Ended::Failed(_) => {
            written = Ok(());
            Outcome::WrongUse
        }
        _ => Outcome::ProgramError,
    };
    if let Some(path) = &options.run.junit {
        let suite = programs.main_name().unwrap_or("no program");
        let stopped = reported.failure.as_ref().map(|error| error.message.as_str());
        let cases = junit::write(path, suite, &session.play.expectations(), stopped);
        written = written.and(cases.map_err(UsageError::from));
    }
    let projection = if machine.parameters.graphics().third_angle {
        Projection::ThirdAngle
    } else {
        Projection::FirstAngle
    };
    let title = format!("PGM {}", programs.main_name().unwrap_or_default());
    let stop = interrupt.after_run();
    let drawn = cutting::write(part.as_ref(), &options.output, &title, projection, &stop);
    let all = matches!(drawn, Ok(Written::All)) && written.is_ok();
    print_report(&reported, model, options, all)?;
    written?;
    Ok(match drawn? {
        Written::All => outcome,
        Written::Interrupted => Outcome::Interrupted,
    })
}

/// Says it with the block where that is known.
fn say_failure(error: &ErrorReport, channel: usize, session: &Session, programs: &FolderPrograms) {
    let channel = session.host.control().channel(channel);
    let run = channel.and_then(|channel| channel.reader());
    let main = match channel.map_or(0, |channel| channel.number()) {
        0 => programs.main(),
        _ => run.and_then(|run| run.program(0)),
    };
    match (run, main) {
        (Some(run), Some(main)) if error.line > 0 => print_error(error, run, Path::new(main.name())),
        _ if error.detail.is_empty() => diagnostics::print_usage_error(&error.message),
        _ => diagnostics::print_usage_error(&format!("{}: {}", error.message, error.detail)),
    }
}

fn print_report(
    reported: &Reported,
    model: bahn_parameters::ControlModel,
    options: &RunMachineOptions,
    drawn: bool,
) -> Result<(), UsageError> {
    if options.format == Format::Json {
        return console::print_json(&reported.report);
    }
    let mut written = options.output.names(drawn);
    let scope = &options.oscilloscope.oscilloscope;
    let files = options
        .recording
        .record
        .iter()
        .chain(scope)
        .chain(&options.run.log);
    written.extend(files.map(|path| path.display().to_string()));
    console::print(&reported.report.text(model, reported.result(), &written))
}
