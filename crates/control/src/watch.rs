//! What a driver asks in every cycle, without the copies that a snapshot takes.

use bahn_interpreter::Interpreter;
use bahn_path::PathElement;

use crate::command::Mode;
use crate::control::Control;
use crate::handshake::Waiting;
use crate::message::Shown;
use crate::run::RunState;

impl Control {
    /// Operating mode.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// State of the run.
    pub fn run_state(&self) -> RunState {
        self.run.state
    }

    /// A fault has interrupted the run: nothing of it is on its way, and NC start tries its block again.
    pub fn is_broken(&self) -> bool {
        self.run.broken
    }

    /// The run came to its end since it was started.
    pub fn has_ended(&self) -> bool {
        self.run.ended
    }

    /// The element of the path that is executed, or was last.
    pub fn element(&self) -> Option<&PathElement> {
        self.path.element()
    }

    /// Path length to the end of that element, mm.
    pub fn rest_mm(&self) -> f64 {
        self.path.rest_mm()
    }

    /// The interpreter of the program that runs, or ran last.
    pub fn interpreter(&self) -> Option<&Interpreter> {
        self.run.feeder.as_ref().map(crate::feeder::Feeder::interpreter)
    }

    /// Handshake that the run waits for.
    pub fn waiting(&self) -> Option<Waiting> {
        self.handshakes.waiting(self.exchange.nc())
    }

    /// Messages that are shown, the oldest first.
    pub fn shown(&self) -> &[Shown] {
        self.messages.shown()
    }

    /// Tool in the spindle.
    pub fn tool(&self) -> u32 {
        self.tools.number
    }

    /// The loops are closed: the control voltage is there.
    pub fn loops_closed(&self) -> bool {
        self.loops_closed
    }

    /// Feed override in force, %.
    pub fn feed_override_percent(&self) -> f64 {
        self.feed_override.percent()
    }

    /// Spindle.
    pub fn spindle(&self) -> crate::spindle::SpindleState {
        self.spindle.state()
    }

    /// No axis is commanded to move.
    pub fn stands(&self) -> bool {
        self.axes.iter().all(crate::axes::AxisUnit::stands)
    }

    /// The letters of the axes in the order of their indices.
    pub fn axis_letters(&self) -> impl Iterator<Item = char> {
        self.axes.iter().map(|unit| unit.axis.letter())
    }

    /// Nominal processing time of the latest PLC scan, %.
    pub fn plc_percent(&self) -> f64 {
        self.plc.machine.time().current_percent()
    }
}
