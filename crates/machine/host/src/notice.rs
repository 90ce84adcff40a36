//! What happens while a machine is on, told once when it happens.

use std::sync::Arc;

use bahn_path::BlockRef;
use bahn_tnc::{ChannelView, Control, DataLineOrder, Message, Mode, OrderedLines, RunState, Shown};

use crate::action::{Action, Answer, Source};

/// An event that those who follow a run are told of.
#[derive(Clone, Debug, PartialEq)]
pub enum Notice {
    /// A message came up.
    Shown(Shown),
    /// A message is shown no more.
    Cleared(Message),
    /// The run is in another state.
    Run(RunState),
    /// The run has come to the end of its program.
    Ended,
    /// Another block is executed.
    Block(Option<BlockRef>),
    /// The operating mode is another one.
    Mode(Mode),
    /// Something was done, and what came of it.
    Given(Source, Action, Answer),
    /// The operator pressed a key because the run waited for him.
    Confirmed {
        /// Name of the key.
        key: String,
        /// What the run waited for.
        why: Why,
    },
    /// Module 9033 has selected this list of machine parameters: the control has been reset and begins with it.
    Restart(String),
    /// What a tool change, a datum or the PLC changed is on the medium.
    Stored,
    /// A program was digitized and stored: its name and its points.
    Digitized(String, u64),
    /// FN15 has printed a line; the channel is that of its program [003:4371-4397].
    Printed(Arc<str>),
    /// The PLC wants something of a data interface.
    Line(DataLineOrder),
    /// Something keeps the machine from going on; in words.
    Fault(String),
    /// An earlier moment was gone back to: what comes now follows from it.
    Restored,
}

/// Why the operator presses a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// Voltage, reference run, start of the program, next block of single block.
    Routine,
    /// The program has stopped the run: STOP, M0, M6.
    Stop,
    /// A tool change waits for him.
    ToolChange,
}

/// A notice with its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Stamped<N = Notice> {
    /// Time since power-on, µs.
    pub time_us: u64,
    /// The channel in which it happened, from 0; 0 for the machine as a whole, too.
    pub channel: usize,
    /// What happened then.
    pub notice: N,
}

/// What was so after the last cycle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Before {
    channels: Vec<ChannelBefore>,
    shown: Vec<Message>,
    lines: OrderedLines,
}

/// The same of a channel.
#[derive(Clone, Debug, Default)]
struct ChannelBefore {
    mode: Mode,
    run: RunState,
    ended: bool,
    block: Option<BlockRef>,
}

impl Before {
    /// Tells what a cycle has changed, and in which channel.
    pub fn compare(&mut self, control: &mut Control, mut tell: impl FnMut(usize, Notice)) {
        for shown in control.take_messages() {
            tell(shown.channel.unwrap_or(0), Notice::Shown(shown));
        }
        let shown = control.shown();
        let is_same = |message: &Message| shown.iter().any(|shown| shown.message == *message);
        if self.shown.len() != shown.len() || !self.shown.iter().all(is_same) {
            let cleared = self.shown.iter().filter(|message| !is_same(message));
            cleared.for_each(|message| tell(0, Notice::Cleared(message.clone())));
            self.shown = shown.iter().map(|shown| shown.message.clone()).collect();
        }
        let lost = control.take_printed(|(channel, line)| tell(channel, Notice::Printed(line)));
        if lost > 0 {
            tell(0, Notice::Fault(format!("{lost} printed lines are lost")));
        }
        control.line_orders(&mut self.lines, |order| tell(0, Notice::Line(order)));
        self.channels
            .resize_with(control.channels(), ChannelBefore::default);
        for (number, before) in self.channels.iter_mut().enumerate() {
            if let Some(channel) = control.channel(number) {
                before.compare(channel, |notice| tell(number, notice));
            }
        }
    }
}

impl ChannelBefore {
    fn compare(&mut self, channel: ChannelView, mut tell: impl FnMut(Notice)) {
        let (mode, run, ended) = (channel.mode(), channel.run_state(), channel.has_ended());
        if std::mem::replace(&mut self.mode, mode) != mode {
            tell(Notice::Mode(mode));
        }
        if std::mem::replace(&mut self.run, run) != run {
            tell(Notice::Run(run));
        }
        let block = channel.element().map(|element| element.block);
        let block = block.filter(|_| run != RunState::Idle);
        if std::mem::replace(&mut self.block, block) != block {
            tell(Notice::Block(block));
        }
        if !std::mem::replace(&mut self.ended, ended) && ended {
            tell(Notice::Ended);
        }
    }
}
