//! A PLC program in the control of a machine, scan by scan.
//!
//! Decision: The views of the PLC see a running machine from a host of their own, in whole scans; lines are stepped
//! on the bench only, since the control does not stop within a scan (also `report/src/plc/subject.rs`)

use std::sync::Arc;
use std::time::Duration;

use bahn_host::{
    Action, Assignment, Attendance, Content, FolderPrograms, Host, HostError, Job, LoadedMachine, Operand,
    Operator, Phase, Play, PowerOn, Script, Source, run_name,
};
use bahn_plc::{Machine, Tracer};
use bahn_text::Diagnostic;
use bahn_tnc::{Command, RunState};

use super::halt::Halt;

/// Time of the machine without a scan after which the PLC is given up, µs.
const PATIENCE_US: u64 = 60_000_000;

/// A machine that is on, with the script that is played on it.
pub struct Live {
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
    reported: usize,
}

impl Live {
    /// Switches on a machine, without what survived and keeping nothing. Each channel has its programs, the first one comes
    /// first; what is `set` is so from the beginning.
    ///
    /// # Errors
    /// When something cannot be set; why.
    pub fn new(
        machine: &LoadedMachine,
        attendance: Attendance,
        script: Script,
        mut programs: Vec<Arc<FolderPrograms>>,
        set: &[Assignment],
    ) -> Result<Option<Live>, String> {
        let job = |channel: usize| programs.get(channel)?.main_name().map(Job::whole);
        let mut operator = Operator::new(attendance, machine.folder.operator.clone(), job(0));
        for (number, channel) in (1..).zip(&machine.channels) {
            operator = operator.with_channel(channel.folder.operator.clone(), job(number));
        }
        let mut power_on = PowerOn::fresh(machine);
        for (channel, programs) in power_on.channels.iter_mut().zip(programs.split_off(1)) {
            channel.programs = programs;
        }
        let Some(first) = programs.pop() else {
            return Ok(None);
        };
        let host = Host::new(machine, power_on, first, operator).map_err(|error| error.to_string())?;
        let mut live = Live {
            host,
            play: Play::new(script),
            cycle: 0,
            scans: 0,
            started: false,
            ended: false,
            reported: 0,
        };
        for assignment in set {
            live.command(&assignment.to_string())?;
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
            .act(source, Action::Command(0, command))
            .map(drop)
            .map_err(|error| error.to_string())
    }

    /// Sets an operand as the table of the PLC menu does.
    pub fn set(&mut self, operand: Operand, content: &Content) -> Result<(), String> {
        self.command(&format!("{operand}={content}"))
    }

    /// What an operand holds now, in the control that is on.
    pub fn read(&self, operand: Operand) -> Content {
        operand.read(self.host.control().exchange().plc())
    }

    /// The program that runs.
    pub fn plc(&self) -> &Machine {
        self.host.control().plc()
    }

    /// From the start of a scan to the start of the next one.
    pub fn cycle_time(&self) -> Duration {
        let limits = self.host.control().model().limits();
        Duration::from_micros(limits.plc_cycle_us.into())
    }

    /// What happens at which time.
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
        let failed = self.play.failed.get(self.reported..).unwrap_or_default();
        let texts = failed
            .iter()
            .map(|failed| format!("{}: {}", failed.text, failed.actual));
        let texts = texts.collect();
        self.reported = self.play.failed.len();
        texts
    }

    /// The expectations that did not hold, with their lines of the script.
    pub fn failures(&self) -> Vec<Diagnostic> {
        self.play.failures()
    }
}
