//! What others see of the control, and take from it.

use bahn_interpreter::{Interpreter, Warning};
use bahn_parameters::ControlModel;
use bahn_path::PathElement;

use crate::axis::AxisUnit;
use crate::command::Mode;
use crate::control::Control;
use crate::handshake::Waiting;
use crate::message::{Message, Shown};
use crate::progress::RunState;
use crate::signal::Signal;
use crate::snapshot::Snapshot;
use crate::spindle::SpindleState;

impl Control {
    /// The state as of now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot::of(self.channels.first(), &self.machine, None)
    }

    /// The state as of now, in the memory of an earlier one: it does not allocate unless another program or
    /// message is shown.
    pub fn snapshot_again(&self, earlier: Snapshot) -> Snapshot {
        Snapshot::of(self.channels.first(), &self.machine, Some(earlier))
    }

    /// Messages came up since the last call of [`Control::take_messages`].
    pub fn has_news(&self) -> bool {
        self.machine.messages.has_news()
    }

    /// The messages that came up since the last call, in their order.
    pub fn take_messages(&mut self) -> Vec<Shown> {
        self.machine.messages.take_news()
    }

    /// The text of a message that is or was shown, with the number of its channel where there are several.
    pub fn shown_text(&self, shown: &Shown) -> String {
        let text = self.message_text(&shown.message);
        match shown.channel.filter(|_| self.channels() > 1) {
            Some(channel) => format!("{}: {text}", channel + 1),
            None => text,
        }
    }

    /// The text of a message as this control shows it.
    pub fn message_text(&self, message: &Message) -> String {
        let machine = &self.machine;
        message.text(machine.model, &machine.letters(), machine.link.messages())
    }

    /// Keeps the path elements of runs of all channels that begin from now on, for [`Control::take_path`].
    pub fn keep_path(&mut self, keep: bool) {
        for channel in self.channels.iter_mut() {
            channel.run.source.tap = keep;
        }
    }

    /// Of what [`Control::take_path`] has handed out so far, the elements from a sequence on are not executed: the tool
    /// is replaced before them. To be asked for before it.
    pub fn take_dropped_path(&mut self, channel: usize) -> Option<u64> {
        let feeder = self.channels.of_mut(channel).run.source.feeder_mut();
        feeder.and_then(|feeder| feeder.take_dropped())
    }

    /// The path elements of a channel that were prepared since the last call, in workpiece coordinates.
    pub fn take_path(&mut self, channel: usize) -> Vec<PathElement> {
        let feeder = self.channels.of_mut(channel).run.source.feeder_mut();
        feeder.map(|feeder| feeder.take_tap()).unwrap_or_default()
    }

    /// The warnings of a channel's interpreter since the last call.
    pub fn take_warnings(&mut self, channel: usize) -> Vec<Warning> {
        let interpreter = self.channels.of_mut(channel).run.source.interpreter_mut();
        interpreter.map(Interpreter::take_warnings).unwrap_or_default()
    }

    /// Operating mode.
    pub fn mode(&self) -> Mode {
        self.channels.first().desk().mode()
    }

    /// State of the run.
    pub fn run_state(&self) -> RunState {
        self.channels.first().run.progress().state()
    }

    /// A fault has interrupted the run: nothing of it is on its way, and NC start tries its block again.
    pub fn is_broken(&self) -> bool {
        self.channels.first().run.progress().is_broken()
    }

    /// The run came to its end since it was started.
    pub fn has_ended(&self) -> bool {
        self.channels.first().run.progress().has_ended()
    }

    /// The element of the path that is executed, or was last.
    pub fn element(&self) -> Option<&PathElement> {
        self.channels.first().run.track.path.element()
    }

    /// Path length to the end of that element, mm.
    pub fn rest_mm(&self) -> f64 {
        self.channels.first().run.track.path.rest_mm()
    }

    /// The interpreter of the program that runs, or ran last; `None` while it is [lent](Control::lend_reading).
    pub fn interpreter(&self) -> Option<&Interpreter> {
        self.channels.first().run.source.interpreter()
    }

    /// Handshake that the run waits for.
    pub fn waiting(&self) -> Option<Waiting> {
        let nc = self.machine.memory.first().nc();
        self.channels.first().handshakes.waiting(nc)
    }

    /// Messages that are shown, the oldest first.
    pub fn shown(&self) -> &[Shown] {
        self.machine.messages.shown()
    }

    /// Tool in the spindle.
    pub fn tool(&self) -> u32 {
        self.channels.first().tools.number
    }

    /// The loops are closed: the control voltage is there.
    pub fn loops_closed(&self) -> bool {
        self.machine.loops_closed
    }

    /// Feed override in force, %.
    pub fn feed_override_percent(&self) -> f64 {
        self.channels.first().desk().feed_percent()
    }

    /// Spindle.
    pub fn spindle(&self) -> SpindleState {
        self.machine.spindles.first().state()
    }

    /// No axis is commanded to move.
    pub fn stands(&self) -> bool {
        self.machine.axes.iter().all(AxisUnit::stands)
    }

    /// The letters of the axes in the order of their indices.
    pub fn axis_letters(&self) -> impl Iterator<Item = char> {
        self.machine.axes.owned(0).map(|unit| unit.axis.letter())
    }

    /// Nominal processing time of the latest PLC scan, %.
    pub fn plc_percent(&self) -> f64 {
        self.machine.plc.machine.time().current_percent()
    }

    /// The value of a signal now; an axis that the machine does not have reads 0.
    pub fn observe(&self, signal: &Signal) -> f64 {
        signal.value(self.channels.first(), &self.machine, &self.seam)
    }

    /// The model.
    pub fn model(&self) -> ControlModel {
        self.machine.model
    }

    /// Scans of the PLC that were started since the control began.
    pub fn plc_scans(&self) -> u64 {
        self.machine.plc.scans
    }

    /// The PLC: its program, accumulators, processing times, and the error that stopped it.
    pub fn plc(&self) -> &bahn_plc::Machine {
        &self.machine.plc.machine
    }
}
