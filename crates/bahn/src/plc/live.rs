//! A PLC program in the control of a machine, scan by scan.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bahn_control::{Command, RunState};
use bahn_host::{
    Attendance, Content, Deed, FolderPrograms, Host, HostError, Job, LoadedMachine, Operand, Operator, Phase,
    Play, PowerOn, Script, Source, Stage, run_name,
};
use bahn_parameters::ControlModel;
use bahn_plc::{Machine, Tracer};

use super::bench::set_operands;
use super::halt::Halt;
use super::options::{BenchOptions, MachineOptions, ProgramOptions};
use crate::{Outcome, UsageError, diagnostics, files, machine_folder};

/// Time of the machine without a scan after which the PLC is given up, µs.
const PATIENCE_US: u64 = 60_000_000;

/// A machine that is on, with the script that is played on it.
pub(super) struct Live {
    host: Host,
    play: Play,
    /// Scans since power-on.
    pub cycle: u64,
    /// Those of the control that is on now.
    scans: u64,
    /// The program was started.
    started: bool,
    /// The script has ended it.
    ended: bool,
    /// Failed expectations that were told.
    told: usize,
}

impl Live {
    /// Switches on the machine of a folder, without what survived and keeping nothing. `None` when its files are faulty:
    /// that was said.
    pub fn new(
        program: &ProgramOptions,
        bench: &BenchOptions,
        options: &MachineOptions,
    ) -> Result<Option<Live>, UsageError> {
        let folder = &program.file;
        if program.parameters.is_some() || program.strict {
            return Err(UsageError::new(
                "--parameters and --strict are of the bench: a folder says what its machine has",
            ));
        }
        let machine = match machine_folder::load(folder)? {
            Ok(machine) => machine,
            Err(faults) => {
                diagnostics::print_faults(&faults);
                return Ok(None);
            }
        };
        let model = machine.parameters.model();
        if program.model != ControlModel::default() && program.model != model {
            return Err(UsageError::new(format!(
                "--model {}: this machine has a {model}",
                program.model
            )));
        }
        let Some(script) = load_script(bench, &machine)? else {
            return Ok(None);
        };
        let mut programs = load_programs(options, &machine)?;
        let attendance = match bench.script {
            Some(_) => Attendance::Start,
            None => Attendance::Full,
        };
        let job = |channel: usize| programs.get(channel)?.main_name().map(Job::whole);
        let mut operator = Operator::new(attendance, machine.folder.operator.clone(), job(0));
        for (number, channel) in (1..).zip(&machine.channels) {
            operator = operator.with_channel(channel.folder.operator.clone(), job(number));
        }
        let mut power_on = PowerOn::fresh(&machine);
        for (channel, programs) in power_on.channels.iter_mut().zip(programs.split_off(1)) {
            channel.programs = programs;
        }
        let Some(first) = programs.pop() else {
            return Ok(None);
        };
        let host = Host::new(&machine, power_on, first, operator);
        let mut live = Live {
            host,
            play: Play::new(script),
            cycle: 0,
            scans: 0,
            started: false,
            ended: false,
            told: 0,
        };
        for assignment in set_operands(bench)? {
            live.command(&assignment.to_string())
                .map_err(|error| UsageError::new(format!("--set {error}")))?;
        }
        Ok(Some(live))
    }

    /// Lets the machine go on to the end of the next scan; a tracer sees what is executed in it.
    pub fn scan(&mut self, mut tracer: Option<&mut (dyn Tracer + '_)>) -> Result<(), Halt> {
        let begin_us = self.host.control().time_us();
        let fault = |error: HostError| Halt::Fault(error.to_string());
        loop {
            self.ended |= self.play.follow(&mut self.host).map_err(fault)?;
            if self.ended {
                return Err(Halt::Ended);
            }
            self.host.begin().map_err(fault)?;
            let tracer: Option<&mut (dyn Tracer + '_)> = match &mut tracer {
                Some(tracer) => Some(&mut **tracer),
                None => None,
            };
            self.host.cycle_traced(tracer).map_err(fault)?;
            self.watch_start();
            let control = self.host.control();
            if let Some(error) = control.plc().stopped() {
                return Err(Halt::Plc(error.clone()));
            }
            let scans = control.plc_scans();
            if std::mem::replace(&mut self.scans, scans) != scans && scans > 0 {
                self.cycle += 1;
                return Ok(());
            }
            if control.time_us() - begin_us > PATIENCE_US {
                return Err(Halt::Fault(format!("the PLC does not run: {}", self.shown())));
            }
        }
    }

    /// What the script gives from the start of the program on counts from now.
    fn watch_start(&mut self) {
        let (control, operator) = (self.host.control(), self.host.operator());
        let runs = control.run_state() != RunState::Idle && operator.phase() != Phase::PowerUp;
        if runs && !std::mem::replace(&mut self.started, true) {
            self.play.start(control.time_us());
        }
    }

    /// Gives a command as a script writes it.
    fn command(&mut self, text: &str) -> Result<(), String> {
        let command: Command = text.parse().map_err(|error| format!("{error}"))?;
        let source = Source::Client("bahn plc".to_owned());
        self.host
            .act(source, Deed::Command(0, command))
            .map(drop)
            .map_err(|error| error.to_string())
    }

    /// Sets an operand as the table of the PLC menu does.
    pub fn set(&mut self, operand: Operand, content: &Content) -> Result<(), String> {
        self.command(&format!("{operand}={content}"))
    }

    pub fn read(&self, operand: Operand) -> Content {
        operand.read(self.host.control().exchange().plc())
    }

    pub fn plc(&self) -> &Machine {
        self.host.control().plc()
    }

    /// From the start of a scan to the start of the next one.
    pub fn cycle_time(&self) -> Duration {
        let limits = self.host.control().model().limits();
        Duration::from_micros(limits.plc_cycle_us.into())
    }

    pub fn script(&self) -> &Script {
        self.play.script()
    }

    /// Time, mode, state of the run and messages, for a line of the screen.
    pub fn state(&self) -> String {
        let control = self.host.control();
        let seconds = control.time_us() as f64 * 1e-6;
        let state = format!(
            "{seconds:.2} s  {}  {}",
            control.mode().name(),
            run_name(control.run_state())
        );
        match self.shown() {
            shown if shown.is_empty() => state,
            shown => format!("{state}  {shown}"),
        }
    }

    fn shown(&self) -> String {
        let control = self.host.control();
        let shown = control.shown().iter();
        let texts: Vec<String> = shown.map(|shown| control.shown_text(shown)).collect();
        texts.join(", ")
    }

    /// The expectations that did not hold since the last call.
    pub fn take_failures(&mut self) -> Vec<String> {
        let failed = self.play.failed.get(self.told..).unwrap_or_default();
        let texts = failed
            .iter()
            .map(|failed| format!("{}: {}", failed.text, failed.actual));
        let texts = texts.collect();
        self.told = self.play.failed.len();
        texts
    }

    /// Says which expectations did not hold.
    pub fn finish(&self) -> Outcome {
        diagnostics::print_faults(&self.play.failures());
        match self.play.failed.is_empty() {
            true => Outcome::Fine,
            false => Outcome::ProgramError,
        }
    }
}

/// The script, for a machine; `None` when it is faulty: that was said.
fn load_script(options: &BenchOptions, machine: &LoadedMachine) -> Result<Option<Script>, UsageError> {
    let Some(path) = &options.script else {
        return Ok(Some(Script::default()));
    };
    let bytes = files::read_table(path)?;
    let stage = Stage::machine(&machine.plant, &machine.parameters);
    match Script::of(path, &bytes, &stage) {
        Ok(script) => Ok(Some(script)),
        Err(faults) => {
            diagnostics::print_faults(&faults);
            Ok(None)
        }
    }
}

/// The programs of each channel, with the one that the operator starts; the first channel comes first.
fn load_programs(
    options: &MachineOptions,
    machine: &LoadedMachine,
) -> Result<Vec<Arc<FolderPrograms>>, UsageError> {
    let channels = 1 + machine.channels.len();
    if options.part.len() > channels {
        return Err(UsageError::new(format!(
            "--part: the machine has channels for {channels}"
        )));
    }
    let programs = (0..channels).map(|channel| {
        let main = match options.part.is_empty() {
            true => machine.usual_program(channel).map(Path::new),
            false => options.part.get(channel).map(PathBuf::as_path),
        };
        Ok(Arc::new(FolderPrograms::new(&machine.programs(channel), main)?))
    });
    programs.collect()
}

/// Whether a path is the folder of a machine.
pub(super) fn is_machine(path: &Path) -> bool {
    path.is_dir()
}
