//! The operator who stands by at a System 900: passes the reference points, goes to AUTO, starts, and goes on where a program
//! waits for him.
//!
//! Decision: He starts every channel whose P8800 is loaded and whose program is there, when all axes of all channels are
//! referenced

use bahn_control900::{Control900, Mode};
use bahn_system900::{AxisParameter, ChannelParameter, Memory, Place};

use super::command::Command900;
use super::notice::Notice900;
use crate::action::Action;
use crate::operator::Attendance;

/// Between two things that he does, µs.
const PAUSE_US: u64 = 500_000;
/// What P8682 gets for START [002:3613-3619].
const START: i64 = 2;
/// What P12130 gets: the reference point is sought in the direction plus, which byte 3 says.
const SEEK: i32 = 0x0001_0001;
/// What P8685 shows while a program is stopped.
const STOPPED: i64 = 1;

/// How he runs programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Job900 {
    /// Single block instead of sequence.
    pub single_block: bool,
}

/// The operator who stands by.
#[derive(Clone, Debug)]
pub struct Operator900 {
    attendance: Attendance,
    job: Job900,
    /// When he did something last, µs.
    acted_us: u64,
    /// What he has done for each channel.
    channels: Vec<Done>,
    /// What he does next in this moment.
    next: Vec<Command900>,
}

/// What was done for a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Done {
    seeks: bool,
    mode: bool,
    start: bool,
}

impl Operator900 {
    /// An operator.
    pub fn new(attendance: Attendance, job: Job900) -> Operator900 {
        Operator900 {
            attendance,
            job,
            acted_us: 0,
            channels: Vec::new(),
            next: Vec::new(),
        }
    }

    /// He starts programs.
    pub fn starts(&self) -> bool {
        self.attendance != Attendance::Absent
    }

    /// START was pressed in every channel that has a program.
    pub fn has_started(&self) -> bool {
        self.channels.iter().any(|done| done.start)
    }

    /// What he does in this cycle, and whether he goes on with a program that waited.
    pub(super) fn act(&mut self, control: &Control900) -> Option<(Action<Command900>, Option<Notice900>)> {
        if self.attendance == Attendance::Absent {
            return None;
        }
        if let Some(command) = self.next.pop() {
            return Some((Action::Command(0, command), None));
        }
        let now = control.now_us();
        if now.saturating_sub(self.acted_us) < PAUSE_US {
            return None;
        }
        self.channels
            .resize(usize::from(control.channels()), Done::default());
        let (command, notice) = self.decide(control)?;
        self.acted_us = now;
        Some((Action::Command(0, command), notice))
    }

    fn decide(&mut self, control: &Control900) -> Option<(Command900, Option<Notice900>)> {
        let first = self.reference(control)?;
        if first.is_some() {
            return first.map(|command| (command, None));
        }
        let jobs: Vec<u8> = (1..=control.channels())
            .filter(|channel| control.has_program(*channel))
            .collect();
        if let Some(command) = self.start(control, &jobs) {
            return command.map(|command| (command, None));
        }
        // A program that has stopped without a message waits for him.
        let waits = |channel: &&u8| {
            is(control, **channel, ChannelParameter::ProgramState, STOPPED)
                && control.pending_messages(**channel).next().is_none()
        };
        let channel = jobs
            .iter()
            .find(waits)
            .filter(|_| self.attendance == Attendance::Full)?;
        let command = write(control, *channel, ChannelParameter::StartKey, START)?;
        Some((command, Some(Notice900::Confirmed)))
    }

    /// The reference points: `None` while an axis is on its way, or must not move; `Some(None)` when all are passed.
    fn reference(&mut self, control: &Control900) -> Option<Option<Command900>> {
        let mut all = true;
        for channel in 1..=control.channels() {
            if is(control, channel, ChannelParameter::Referenced, 1) {
                continue;
            }
            all = false;
            let k = usize::from(channel) - 1;
            let seeks = self.channels.get(k).is_some_and(|done| done.seeks);
            if !seeks && is(control, channel, ChannelParameter::AxesEnabled, 1) {
                self.note(channel, |done| done.seeks = true);
                self.next = reference_drives(control, channel);
                if let Some(first) = self.next.pop() {
                    return Some(Some(first));
                }
            }
        }
        all.then_some(None)
    }

    /// AUTO, then START, in every channel with a program; `None` when that is done, `Some(None)` while he waits.
    fn start(&mut self, control: &Control900, jobs: &[u8]) -> Option<Option<Command900>> {
        let mode = if self.job.single_block {
            Mode::Single
        } else {
            Mode::Sequence
        };
        let open = |done: fn(&Done) -> bool| {
            let mut channels = jobs.iter().copied();
            channels.find(|channel| {
                self.channels
                    .get(usize::from(*channel) - 1)
                    .is_some_and(|of| !done(of))
            })
        };
        if let Some(channel) = open(|done| done.mode) {
            self.note(channel, |done| done.mode = true);
            return Some(write(
                control,
                channel,
                ChannelParameter::ModeRequest,
                mode.number(),
            ));
        }
        let channel = open(|done| done.start)?;
        // Channels of a network start when all of them are in AUTO.
        if !self.has_started() && jobs.iter().any(|channel| control.mode(*channel) != mode) {
            return Some(None);
        }
        self.note(channel, |done| done.start = true);
        Some(write(control, channel, ChannelParameter::StartKey, START))
    }

    fn note(&mut self, channel: u8, note: impl FnOnce(&mut Done)) {
        if let Some(done) = self.channels.get_mut(usize::from(channel) - 1) {
            note(done);
        }
    }
}

/// A parameter of a channel is this number.
fn is(control: &Control900, channel: u8, parameter: ChannelParameter, number: i64) -> bool {
    control.memory().of_channel(channel, parameter).whole() == Some(number)
}

/// Gives a parameter of a channel a number.
fn write(control: &Control900, channel: u8, parameter: ChannelParameter, number: i64) -> Option<Command900> {
    let place = control.memory().channel_place(channel, parameter)?;
    Some(Command900::by_operator(control.memory().name_of(place), number))
}

/// What drives the axes of a channel to their reference points that have not passed theirs; the last one first.
pub fn reference_drives(control: &Control900, channel: u8) -> Vec<Command900> {
    let memory = control.memory();
    let open = |physical: &u8| {
        let state = memory.of_axis(*physical, AxisParameter::ReferenceState).bits();
        state.unwrap_or(0) & 0xFF != 1
    };
    let axes = memory.axes_of(channel).map(|(_, physical)| physical).filter(open);
    let places = axes.filter_map(|physical| Memory::axis_place(physical, AxisParameter::Reference));
    let of = |place: Place| Command900::by_operator(memory.name_of(place), SEEK.into());
    let mut all: Vec<Command900> = places.map(of).collect();
    all.reverse();
    all
}
