//! The operator who stands by: switches on, passes the reference marks, starts the program, and lets the
//! run go on where it waits for him.
//!
//! Decision: Programs of further channels begin when all channels have passed their reference marks; a run ends when
//! all programs have

use bahn_exchange::signal;
use bahn_machine::OperatorKeys;
use bahn_parameters::MessageId;
use bahn_tnc::{ChannelView, Command, Control, Dnc, Message, Mode, RunState, Waiting};

use crate::action::Action;
use crate::notice::Why;

/// Between two things that he does, µs.
const PAUSE_US: u64 = 500_000;
/// NC start between two blocks of single block, µs: a key must have been released.
const BLOCK_US: u64 = 300_000;
/// So long a tool change may take without him, µs.
const PATIENCE_US: u64 = 5_000_000;
/// Between the keys of a tool change, µs.
const CHANGE_US: u64 = 1_500_000;

/// How much he does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attendance {
    /// Everything: also NC start after programmed stops, and what a tool change waits for.
    Full,
    /// As [`Attendance::Full`], but a programmed stop waits for somebody else.
    StopsWait,
    /// Switches on, passes the reference marks and starts the program; then the script is alone.
    Start,
    /// Nothing: the script does it.
    Absent,
}

/// How far he is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Until the loops are closed.
    PowerUp,
    /// Until all reference marks are passed.
    Reference,
    /// The program was chosen and started.
    Program,
    /// There is no program to start.
    Ready,
}

/// The program that the operator starts, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The name of the program.
    pub program: String,
    /// Full sequence or single block.
    pub mode: Mode,
    /// The block to start at, when it is not the first.
    pub start_block: Option<u32>,
    /// It is executed while it is transferred.
    pub transferred: bool,
}

impl Job {
    /// A program from its beginning, in full sequence.
    pub fn whole(program: &str) -> Job {
        Job {
            program: program.to_owned(),
            mode: Mode::FullSequence,
            start_block: None,
            transferred: false,
        }
    }
}

/// The operator who stands by: at the panel of each channel.
#[derive(Clone, Debug)]
pub struct Operator {
    attendance: Attendance,
    stations: Vec<Station>,
}

/// What he does for a channel.
#[derive(Clone, Debug)]
struct Station {
    /// Which channel, from 0.
    channel: usize,
    keys: OperatorKeys,
    job: Option<Job>,
    phase: Phase,
    /// When he did something last.
    acted_us: u64,
    /// The steps of choosing the program that are done.
    chosen: u8,
    /// NC start was pressed for the program.
    started: bool,
    /// The state of the run, and since when.
    state: (RunState, u64),
    /// Since when a tool change waits, and how many of its keys were pressed.
    change: Option<(u64, usize)>,
    /// How often the control had begun when he looked last.
    starts: u32,
}

impl Operator {
    /// An operator with the keys of his machine.
    pub fn new(attendance: Attendance, keys: OperatorKeys, job: Option<Job>) -> Operator {
        Operator {
            attendance,
            stations: vec![Station::new(0, keys, job)],
        }
    }

    /// He stands by at the next channel, too, with its keys and its job.
    #[must_use]
    pub fn with_channel(mut self, keys: OperatorKeys, job: Option<Job>) -> Operator {
        self.stations.push(Station::new(self.stations.len(), keys, job));
        self
    }

    /// How far he is: the least of all channels; while programs are to run, [`Phase::Program`].
    pub fn phase(&self) -> Phase {
        let is = |phase| self.stations.iter().any(|station| station.phase == phase);
        let phases = [Phase::PowerUp, Phase::Reference, Phase::Program];
        phases
            .into_iter()
            .find(|phase| is(*phase))
            .unwrap_or(Phase::Ready)
    }

    /// NC start was pressed for a program.
    pub fn has_started(&self) -> bool {
        self.stations.iter().any(|station| station.started)
    }

    /// The channels, from 0, that have a program to start.
    pub fn channels_with_job(&self) -> impl Iterator<Item = usize> {
        let stations = self.stations.iter().filter(|station| station.job.is_some());
        stations.map(|station| station.channel)
    }

    /// What he does in this cycle, and for which channel.
    pub(crate) fn act(&mut self, control: &Control) -> Option<(usize, Action, Why)> {
        let attendance = self.attendance;
        let mut action = None;
        for station in &mut self.stations {
            let Some(channel) = control.channel(station.channel) else {
                continue;
            };
            station.follow(control, channel);
            if action.is_none() && attendance != Attendance::Absent {
                let done = station.act(attendance, control, channel);
                action = done.map(|(action, why)| (station.channel, action, why));
            }
        }
        action
    }
}

impl Station {
    fn new(channel: usize, keys: OperatorKeys, job: Option<Job>) -> Station {
        Station {
            channel,
            keys,
            job,
            phase: Phase::PowerUp,
            acted_us: 0,
            chosen: 0,
            started: false,
            state: (RunState::Idle, 0),
            change: None,
            starts: 1,
        }
    }

    fn act(
        &mut self,
        attendance: Attendance,
        control: &Control,
        channel: ChannelView,
    ) -> Option<(Action, Why)> {
        let now = control.time_us();
        let waited = now.saturating_sub(self.acted_us);
        let start = || Some((Action::tap(&self.keys.start), Why::Routine));
        let action = match self.phase {
            Phase::PowerUp if waited >= PAUSE_US => self.power_up(control),
            Phase::Reference if channel.mode() != Mode::Reference => None,
            Phase::Reference if waited >= 2 * PAUSE_US && control.stands() => start(),
            Phase::Program if !self.started && waited >= PAUSE_US => self.choose(),
            Phase::Program if attendance == Attendance::Full => self.stand_by(channel, now, waited),
            Phase::Program if attendance == Attendance::StopsWait && self.state.0 != RunState::Stopped => {
                self.stand_by(channel, now, waited)
            }
            _ => None,
        };
        if action.is_some() {
            self.acted_us = now;
        }
        action
    }

    /// The phase follows the control, whoever operates it. Programs wait until all channels know where they are.
    fn follow(&mut self, control: &Control, channel: ChannelView) {
        if control.starts() != self.starts {
            // He switches on and passes the reference marks again; a program that was broken off he does not start.
            self.starts = control.starts();
            self.phase = Phase::PowerUp;
            self.acted_us = control.time_us();
            self.started |= self.chosen > 0;
        }
        let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
        let phase = match self.phase {
            Phase::PowerUp if !control.loops_closed() => Phase::PowerUp,
            Phase::PowerUp | Phase::Reference
                if channels.any(|channel| channel.mode() == Mode::Reference) =>
            {
                Phase::Reference
            }
            Phase::PowerUp | Phase::Reference if self.job.is_some() => Phase::Program,
            Phase::PowerUp | Phase::Reference => Phase::Ready,
            phase => phase,
        };
        if phase != self.phase {
            self.phase = phase;
            self.acted_us = control.time_us();
        }
        let state = channel.run_state();
        if self.phase == Phase::Program && state == RunState::Running {
            self.started = true;
        }
        if self.state.0 != state {
            self.state = (state, control.time_us());
        }
    }

    fn power_up(&self, control: &Control) -> Option<(Action, Why)> {
        if self.channel > 0 {
            // The first channel does it for the machine.
            return None;
        }
        let shows = |id| {
            let message = Message::Plain(id);
            control.shown().iter().any(|shown| shown.message == message)
        };
        if shows(MessageId::PowerInterrupted) {
            return Some((Action::Command(0, Command::Ce), Why::Routine));
        }
        let voltage = self.keys.control_voltage.clone();
        voltage
            .filter(|_| shows(MessageId::RelayExtDcVoltageMissing))
            .map(|key| (Action::tap(&key), Why::Routine))
    }

    /// Mode, program, start block, then NC start.
    fn choose(&mut self) -> Option<(Action, Why)> {
        let job = self.job.as_ref()?;
        loop {
            self.chosen += 1;
            let command = match self.chosen {
                1 => Command::Mode(job.mode),
                2 if job.transferred => Command::Dnc(Dnc::Begin(job.program.clone())),
                2 => Command::Select(job.program.clone()),
                3 => match job.start_block {
                    Some(block) => Command::Goto(block),
                    None => continue,
                },
                _ => {
                    self.started = true;
                    return Some((Action::tap(&self.keys.start), Why::Routine));
                }
            };
            return Some((Action::Command(self.channel, command), Why::Routine));
        }
    }

    fn stand_by(&mut self, channel: ChannelView, now: u64, waited: u64) -> Option<(Action, Why)> {
        let start = |why| Some((Action::tap(&self.keys.start), why));
        let (state, since) = self.state;
        let waited = waited.min(now.saturating_sub(since));
        match state {
            RunState::Stopped if waited >= PAUSE_US => return start(Why::Stop),
            RunState::BlockEnd if waited >= BLOCK_US => return start(Why::Routine),
            _ => {}
        }
        let changes = matches!(
            channel.waiting(),
            Some(Waiting::Acknowledge(pair)) if pair.strobe == signal::TOOL_CALL_STROBE
        );
        if !changes {
            self.change = None;
            return None;
        }
        let (since, pressed) = *self.change.get_or_insert((now, 0));
        let due = since + PATIENCE_US + pressed as u64 * CHANGE_US;
        let key = self.keys.tool_change.get(pressed)?;
        if now < due {
            return None;
        }
        self.change = Some((since, pressed + 1));
        Some((Action::tap(key), Why::ToolChange))
    }
}
