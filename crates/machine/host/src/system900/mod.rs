//! A machine with a System 900: its folder, what it begins with, and what a cycle of it is beside what every host does.
//!
//! - `machine` loads the folder, `plc` its PLC program with the `window`, `programs` reads part programs by their numbers, `ideal` is the machine of which nothing is
//!   known but its parameters;
//! - `command` is what is done, `notice` what happens, `operator` who stands by, `stage` what scripts say;
//! - `state` is what survives power-off, `flash` what is kept without battery.

mod command;
mod flash;
mod ideal;
mod machine;
mod notice;
mod operator;
mod plc;
mod programs;
mod stage;
mod state;
mod window;

pub use command::{By, Command900};
pub use flash::Flash900;
pub use ideal::IdealMachine;
pub use machine::Machine900;
pub use notice::Notice900;
pub use operator::{Job900, Operator900, reference_drives};
pub use programs::Programs900;
pub use stage::{Action900, Expectation900, Script900, Stage900};
pub use state::State900;

use std::convert::Infallible;
use std::path::PathBuf;

use bahn_control900::{Control900, Setup};
use bahn_reader::Warning;
use bahn_system900::{ChannelParameter, Memory, SpaceError, Value};

use self::notice::Before900;
use crate::action::Answer;
use crate::any_plant::AnyPlant;
use crate::error::HostError;
use crate::host::{Host, HostFamily};
use crate::hosted::{ByOperator, Executes, HostNotice, Hosted, Prepared};
use crate::moment::Moment;
use crate::operable::Operable;

/// Programs of a channel: that of P8800, and the emergency programs.
const PROGRAMS: usize = 5;

/// What a System 900 begins with.
pub struct PowerOn900 {
    /// Its parameters.
    pub memory: Memory,
    /// What answers in the place of a PLC, and how often.
    pub setup: Setup,
    /// Where its programs are.
    pub programs: Programs900,
    /// Where it keeps what changes; `None` keeps nothing.
    pub state: Option<State900>,
    /// Its FLASH.
    pub flash: Flash900,
}

/// What a System 900 has beside its control.
pub struct Beside900 {
    programs: Programs900,
    flash: Flash900,
}

/// A System 900 that is on, with any plant.
pub type Host900 = Host<AnyPlant, Control900>;

impl PowerOn900 {
    /// A machine that was never on, and keeps nothing.
    pub fn fresh(machine: &Machine900) -> PowerOn900 {
        PowerOn900 {
            memory: machine.parameters.memory().clone(),
            setup: Setup {
                answers: machine.answers(),
                plc: machine.plc.clone(),
                ..Setup::default()
            },
            programs: Programs900::of_folder(&machine.programs()),
            state: None,
            flash: Flash900::default(),
        }
    }

    /// A machine that finds what it kept, in the folder of its state.
    ///
    /// # Errors
    /// As [`State900::open`].
    pub fn kept(machine: &Machine900) -> Result<PowerOn900, HostError> {
        let folder = machine.root.join(&machine.folder.state);
        let (state, memory) = State900::open(&folder, machine.parameters.memory())?;
        Ok(PowerOn900 {
            memory,
            state: Some(state),
            flash: Flash900::open(&folder)?,
            ..PowerOn900::fresh(machine)
        })
    }

    /// The files are the programs of the channels in their order, from their beginning: their numbers are in P8800. Other
    /// channels run none.
    ///
    /// # Errors
    /// In words, when there is none of a name, or no number in it, or there are more files than channels.
    pub fn run(&mut self, files: &[PathBuf]) -> Result<(), String> {
        if files.is_empty() {
            return Ok(());
        }
        let channels = self.memory.channels();
        if files.len() > usize::from(channels) {
            return Err(format!(
                "the machine has {channels} channels, and each runs one program"
            ));
        }
        let mut files = files.iter();
        for channel in 1..=channels {
            let number = files.next().map_or(Ok(0), |file| self.programs.add(file))?;
            self.set(channel, ChannelParameter::Program, number)?;
            self.set(channel, ChannelParameter::StartBlock, 0)?;
        }
        Ok(())
    }

    /// The program of channel 1 begins at the block of this number: P8801.
    ///
    /// # Errors
    /// In words, when the number does not go in.
    pub fn begin_at(&mut self, block: u32) -> Result<(), String> {
        self.set(1, ChannelParameter::StartBlock, block.into())
    }

    fn set(&mut self, channel: u8, parameter: ChannelParameter, number: i64) -> Result<(), String> {
        let place = self.memory.channel_place(channel, parameter);
        let name = place.map(|place| self.memory.name_of(place));
        let name = name.ok_or_else(|| format!("there is no channel {channel}"))?;
        let value = Value::Decimal {
            digits: number,
            decimals: 0,
        };
        let written = self.memory.write(name, value);
        written.map(drop).map_err(|error| error.to_string())
    }
}

/// What belongs to a moment beside the control.
#[derive(Clone)]
pub struct Aside900 {
    before: Before900,
    /// The numbers of the programs that each channel has.
    programs: Vec<[Option<i64>; PROGRAMS]>,
}

impl<P: Operable> Host<P, Control900> {
    /// Switches a System 900 on with its plant.
    pub fn of_system900(power_on: PowerOn900, plant: P, operator: Operator900) -> Host<P, Control900> {
        let control = Control900::new(power_on.memory, power_on.setup);
        let moment = Moment::new(control, plant, operator);
        let beside = Beside900 {
            programs: power_on.programs,
            flash: power_on.flash,
        };
        Host::switched_on(moment, beside, power_on.state)
    }

    /// The file of the program of a channel, from 1 on, as it was read last.
    pub fn program_file(&self, channel: u8) -> Option<PathBuf> {
        let of = self
            .now
            .aside
            .programs
            .get(usize::from(channel).checked_sub(1)?)?;
        let number = (*of.first()?)?;
        Some(self.beside.programs.file(number))
    }

    /// A function of q10 is executed. Programs that it has brought are read anew.
    fn execute_function(&mut self) {
        let Some(number) = self.now.control.take_function() else {
            return;
        };
        let Beside900 { programs, flash } = &mut self.beside;
        match flash.run(number, &mut self.now.control, programs) {
            Ok(true) => self.now.aside.programs.fill([None; PROGRAMS]),
            Ok(false) => {}
            Err(error) => self.tell(HostNotice::Fault(error.to_string())),
        }
    }

    /// Programs whose numbers were written are read.
    fn take_programs(&mut self) {
        for channel in 1..=self.now.control.channels() {
            for which in 0..PROGRAMS {
                self.take_program(channel, which);
            }
        }
    }

    fn take_program(&mut self, channel: u8, which: usize) {
        let k = usize::from(channel) - 1;
        let number = number_of(self.now.control.memory(), channel, which);
        let Some(known) = self
            .now
            .aside
            .programs
            .get_mut(k)
            .and_then(|of| of.get_mut(which))
        else {
            return;
        };
        if std::mem::replace(known, number) == number {
            return;
        }
        let number = number.filter(|number| *number > 0);
        let program = number
            .zip(self.now.control.language())
            .map(|(number, language)| self.beside.programs.read(number, channel, language));
        let program = match program {
            // Who calls an emergency program that is not there hears it then.
            Some(Err(what)) => {
                if which == 0 {
                    self.tell_in(k, Notice900::Fault(what));
                }
                None
            }
            other => other.and_then(Result::ok),
        };
        match which {
            0 => self.now.control.set_program(channel, program),
            which => self
                .now
                .control
                .set_emergency_program(channel, which as u8, program),
        }
    }
}

/// The number of a channel that a host counts from 0.
fn number(channel: usize) -> u8 {
    u8::try_from(channel + 1).unwrap_or(u8::MAX)
}

/// The number of a program of a channel: P8800, P8820, P8822, P8824, P8826.
fn number_of(memory: &Memory, channel: u8, which: usize) -> Option<i64> {
    let (parameter, after) = match which.checked_sub(1) {
        None => (ChannelParameter::Program, 0),
        Some(emergency) => (ChannelParameter::EmergencyProgram, 2 * emergency as u32),
    };
    let place = memory.channel_place_at(channel, parameter, after)?;
    memory.at(place).whole()
}

impl Hosted for Control900 {
    type Command = Command900;
    type Notice = Notice900;
    /// All parameters: the table is the control.
    type Snapshot = Memory;
    type Operator = Operator900;
    /// Parameters are edited by commands.
    type Renewed = Infallible;
    type Aside = Aside900;
    type Beside = Beside900;
    type State = State900;

    fn time_us(&self) -> u64 {
        self.now_us()
    }

    fn channels(&self) -> usize {
        usize::from(Control900::channels(self))
    }

    fn keep_path(&mut self) {
        Control900::keep_path(self);
    }

    fn take_prepared(&mut self, channel: usize) -> Prepared {
        Prepared {
            dropped: self.take_dropped_path(number(channel)),
            elements: self.take_path(number(channel)),
        }
    }

    fn executes(&self, channel: usize) -> Option<Executes<'_>> {
        let (_, has_ended) = self.run(number(channel));
        Some(Executes {
            element: self.executed(number(channel)),
            has_ended,
        })
    }

    fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        Control900::take_warnings(self, number(channel))
    }

    fn aside(&self) -> Aside900 {
        Aside900 {
            before: Before900::default(),
            programs: vec![[None; PROGRAMS]; Hosted::channels(self)],
        }
    }

    fn snapshot(&self) -> Memory {
        self.memory().clone()
    }

    fn stand_by(&self, operator: &mut Operator900) -> Option<ByOperator<Control900>> {
        let (action, notice) = operator.act(self)?;
        Some((0, action, notice))
    }
}

impl HostFamily for Control900 {
    fn spend<P: Operable>(host: &mut Host<P, Control900>) -> Result<(), HostError> {
        host.take_programs();
        let now = &mut host.now;
        now.control.prepare();
        now.control.cycle(&mut now.plant);
        let (time_us, repeats) = (now.control.now_us(), host.repeats);
        let feeds = &host.feeds;
        now.aside.before.compare(&now.control, |channel, notice| {
            if !repeats {
                feeds.tell(time_us, channel, notice);
            }
        });
        let kept = match (&mut host.state, repeats) {
            (Some(state), false) => state.keep(host.now.control.memory()),
            _ => Ok(()),
        };
        host.end_cycle();
        kept.map_err(|error| {
            host.tell(HostNotice::Fault(error.to_string()));
            HostError::NotStored(error.to_string())
        })
    }

    fn command<P: Operable>(host: &mut Host<P, Control900>, channel: usize, command: &Command900) -> Answer {
        let Command900 { by, name, value, .. } = *command;
        let written = match by {
            By::Operator => host.now.control.write_operator(name, value),
            By::Panel => host.now.control.write_panel(name, value),
            By::Plc => host.now.control.write_plc(name, value),
        };
        match written {
            Ok(()) => {
                host.execute_function();
                Answer::Done
            }
            Err(held @ (SpaceError::Locked(..) | SpaceError::Closed(..))) => {
                host.tell_in(channel, Notice900::Held(name, held.to_string()));
                Answer::Refused
            }
            Err(wrong) => Answer::Impossible(wrong.to_string()),
        }
    }

    fn take_over<P: Operable>(_: &mut Host<P, Control900>, renewed: Infallible) -> bool {
        match renewed {}
    }

    fn store<P: Operable>(host: &mut Host<P, Control900>) -> Result<(), HostError> {
        let state = host.state.as_mut();
        let stored = state.map_or(Ok(()), |state| state.flush(host.now.control.memory()));
        stored.map_err(|error| HostError::NotStored(error.to_string()))
    }
}
