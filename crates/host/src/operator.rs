//! The operator who stands by: switches on, passes the reference marks, starts the program, and lets the
//! run go on where it waits for him.

use bahn_control::{Command, Control, Message, Mode, RunState, Waiting};
use bahn_exchange::signal;
use bahn_machine::OperatorKeys;
use bahn_parameters::MessageId;

use crate::deed::Deed;
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

/// What he starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The name of the program.
    pub program: String,
    /// Full sequence or single block.
    pub mode: Mode,
    /// The block to start at, when it is not the first.
    pub start_block: Option<u32>,
}

impl Job {
    /// A program from its beginning, in full sequence.
    pub fn whole(program: &str) -> Job {
        Job {
            program: program.to_owned(),
            mode: Mode::FullSequence,
            start_block: None,
        }
    }
}

/// The operator who stands by.
#[derive(Clone, Debug)]
pub struct Operator {
    attendance: Attendance,
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

    /// How far he is.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// NC start was pressed for the program.
    pub fn has_started(&self) -> bool {
        self.started
    }

    /// There is a program to start.
    pub fn has_job(&self) -> bool {
        self.job.is_some()
    }

    /// What he does in this cycle.
    pub(crate) fn act(&mut self, control: &Control) -> Option<(Deed, Why)> {
        self.follow(control);
        if self.attendance == Attendance::Absent {
            return None;
        }
        let now = control.time_us();
        let waited = now.saturating_sub(self.acted_us);
        let deed = match self.phase {
            Phase::PowerUp if waited >= PAUSE_US => self.power_up(control),
            Phase::Reference if waited >= 2 * PAUSE_US && control.stands() => {
                Some((Deed::tap(&self.keys.start), Why::Routine))
            }
            Phase::Program if !self.started && waited >= PAUSE_US => self.choose(),
            Phase::Program if self.attendance == Attendance::Full => self.stand_by(control, now, waited),
            _ => None,
        };
        if deed.is_some() {
            self.acted_us = now;
        }
        deed
    }

    /// The phase follows the control, whoever operates it.
    fn follow(&mut self, control: &Control) {
        if control.starts() != self.starts {
            // He switches on and passes the reference marks again; a program that was broken off he does not start.
            self.starts = control.starts();
            self.phase = Phase::PowerUp;
            self.acted_us = control.time_us();
            self.started |= self.chosen > 0;
        }
        let phase = match self.phase {
            Phase::PowerUp if !control.loops_closed() => Phase::PowerUp,
            Phase::PowerUp | Phase::Reference if control.mode() == Mode::Reference => Phase::Reference,
            Phase::PowerUp | Phase::Reference if self.job.is_some() => Phase::Program,
            Phase::PowerUp | Phase::Reference => Phase::Ready,
            phase => phase,
        };
        if phase != self.phase {
            self.phase = phase;
            self.acted_us = control.time_us();
        }
        let state = control.run_state();
        if self.phase == Phase::Program && state == RunState::Running {
            self.started = true;
        }
        if self.state.0 != state {
            self.state = (state, control.time_us());
        }
    }

    fn power_up(&self, control: &Control) -> Option<(Deed, Why)> {
        let shows = |id| {
            let message = Message::Plain(id);
            control.shown().iter().any(|shown| shown.message == message)
        };
        if shows(MessageId::PowerInterrupted) {
            return Some((Deed::Command(Command::Ce), Why::Routine));
        }
        let voltage = self.keys.control_voltage.clone();
        voltage
            .filter(|_| shows(MessageId::RelayExtDcVoltageMissing))
            .map(|key| (Deed::tap(&key), Why::Routine))
    }

    /// Mode, program, start block, then NC start.
    fn choose(&mut self) -> Option<(Deed, Why)> {
        let job = self.job.as_ref()?;
        loop {
            self.chosen += 1;
            let command = match self.chosen {
                1 => Command::Mode(job.mode),
                2 => Command::Select(job.program.clone()),
                3 => match job.start_block {
                    Some(block) => Command::Goto(block),
                    None => continue,
                },
                _ => {
                    self.started = true;
                    return Some((Deed::tap(&self.keys.start), Why::Routine));
                }
            };
            return Some((Deed::Command(command), Why::Routine));
        }
    }

    fn stand_by(&mut self, control: &Control, now: u64, waited: u64) -> Option<(Deed, Why)> {
        let start = |why| Some((Deed::tap(&self.keys.start), why));
        let (state, since) = self.state;
        let waited = waited.min(now.saturating_sub(since));
        match state {
            RunState::Stopped if waited >= PAUSE_US => return start(Why::Stop),
            RunState::BlockEnd if waited >= BLOCK_US => return start(Why::Routine),
            _ => {}
        }
        let changes = matches!(
            control.waiting(),
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
        Some((Deed::tap(key), Why::ToolChange))
    }
}
