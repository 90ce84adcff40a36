//! Messages: each has a cause, and what must be said is said in its time.

use std::collections::BTreeSet;

use bahn_parameters::fault::{FaultId, Reaction};
use bahn_tnc::{AxisWatch, Control, Message, Shown};

use crate::torture::catalogue::Kind;
use crate::torture::plan::Happening;
use crate::torture::rule::{Rule, Violation};

/// From the relay to the message: the longest drop-out of a sound one and a contour cycle, µs.
const EMERGENCY_US: u64 = 60_000;
/// From a signal of an encoder to the message, µs.
const ENCODER_US: u64 = 20_000;

/// A message that must come.
#[derive(Clone, Debug)]
struct Due {
    fault: FaultId,
    axis: Option<u8>,
    until_us: u64,
    why: String,
}

/// Follows what is said.
#[derive(Clone, Debug, Default)]
pub(super) struct Messages {
    causes: BTreeSet<Kind>,
    /// What was done, in words.
    done: Vec<String>,
    due: Vec<Due>,
    /// A message that switches "control is ready" off is shown since then.
    pub fatal_since: Option<u64>,
    scans: u64,
}

impl Messages {
    /// Notes a happening, and which message it must bring.
    pub fn happens(&mut self, happening: &Happening, control: &Control) {
        self.causes.insert(happening.kind);
        self.done.push(happening.what.clone());
        let now = happening.time_us.max(control.time_us());
        // What is put back need not be said any more.
        let withdrawn = [
            "repair",
            "emergency release",
            "voltage on",
            "power",
            "fault input I3",
            "fault relay",
        ];
        if withdrawn.iter().any(|word| happening.what.starts_with(word)) {
            self.due.clear();
            return;
        }
        // An encoder has one fault: another one takes its place, maybe before its monitoring has seen it.
        if let Some((letter, _)) = encoder_fault(&happening.what) {
            self.due
                .retain(|due| encoder_fault(&due.why).is_none_or(|(other, _)| other != letter));
        }
        let stopped = control
            .shown()
            .iter()
            .any(|shown| shown.fault() == FaultId::ExternalEmergencyStop);
        if !control.loops_closed() || control.is_off() || is_fatal(control) || stopped || !self.due.is_empty()
        {
            return;
        }
        if ["emergency press", "voltage off"].contains(&happening.what.as_str())
            && !self.has("relay")
            && !self.has("I3")
        {
            self.due.push(Due {
                fault: FaultId::ExternalEmergencyStop,
                axis: None,
                until_us: now + EMERGENCY_US,
                why: happening.what.clone(),
            });
        }
        if let Some((letter, signal)) = encoder_fault(&happening.what) {
            self.encoder_fails(letter, signal, happening, control);
        }
    }

    /// A signal of an encoder fails, and its monitoring must say so.
    fn encoder_fails(&mut self, letter: &str, signal: &str, happening: &Happening, control: &Control) {
        let first = control.channel(0);
        let named = |watch: &AxisWatch| letter.starts_with(watch.axis.letter());
        let now = happening.time_us.max(control.time_us());
        let (fault, monitor) = match signal {
            "amplitude" => (FaultId::EncoderAmplitude, 0),
            "edges" => (FaultId::EncoderEdges, 1),
            _ => return,
        };
        // On a machine of several channels a letter of the plant may be another one of the control.
        let axis = first
            .filter(|_| control.channels() == 1)
            .and_then(|view| view.watch().find(named));
        let Some(axis) = axis.filter(|axis| axis.fault.is_none()) else {
            return;
        };
        if axis.monitors.get(monitor).copied().unwrap_or(false) && axis.closed {
            self.due.push(Due {
                fault,
                axis: Some(axis.id.number()),
                until_us: now + ENCODER_US,
                why: happening.what.clone(),
            });
        }
    }

    fn has(&self, word: &str) -> bool {
        self.done.iter().any(|done| done.contains(word))
    }

    /// Something of the machine has failed, or the PLC was made to say something wrong.
    pub fn is_broken(&self) -> bool {
        self.causes.contains(&Kind::Fault) || self.causes.contains(&Kind::Plc)
    }

    /// The way of the axes after a reaction is not the machine's usual one.
    pub fn is_unbraked(&self) -> bool {
        ["relay", "brake", "force", "drive", "offset", "input", "device"]
            .iter()
            .any(|word| self.has(word))
    }

    /// A message has come up; the undisturbed run says it, too, or not.
    pub fn shown(&mut self, shown: &Shown, usual: bool, control: &Control) -> Result<(), Violation> {
        let fault = shown.fault();
        let of_axis = |due: &Due| match (&shown.message, due.axis) {
            (Message::Axis { axis, .. }, Some(own)) => *axis == own,
            _ => true,
        };
        self.due.retain(|due| !(due.fault == fault && of_axis(due)));
        if fault.row().flashes() {
            // The control does nothing more, and says nothing more.
            self.due.clear();
        }
        if shown.flashing != fault.row().flashes() {
            let text = control.shown_text(shown);
            let values = format!(
                "{text} flashes: {}, by the table: {}",
                shown.flashing,
                fault.row().flashes()
            );
            return Err(Violation::new(Rule::Reaction, control.time_us(), values));
        }
        if usual || self.explains(fault, control) {
            if fault == FaultId::ExternalEmergencyStop {
                // What follows it follows it, whoever has made it.
                self.causes.insert(Kind::Emergency);
            }
            return Ok(());
        }
        let text = control.shown_text(shown);
        let place = shown.message.place().unwrap_or_default();
        let values = format!("{text} {place} ({}) comes of {:?}", fault.name(), self.done);
        Err(Violation::new(Rule::Cause, control.time_us(), values))
    }

    /// What was done may lead to a fault.
    fn explains(&self, fault: FaultId, control: &Control) -> bool {
        let any = |kinds: &[Kind]| kinds.iter().any(|kind| self.causes.contains(kind));
        let stopped = any(&[Kind::Emergency, Kind::Power]);
        any(&[Kind::Fault])
            || match fault {
                // Blocked drives may lag behind an EMERGENCY STOP [000:6157].
                FaultId::Positioning
                | FaultId::GrossDeviation
                | FaultId::GrossMovement
                | FaultId::GrossStandstill => any(&[Kind::Emergency]),
                FaultId::PowerInterrupted => any(&[Kind::Power]),
                // Before its reference marks an axis has no software limits: a key may move it onto the switch behind them.
                FaultId::ExternalEmergencyStop if any(&[Kind::AxisKey]) && is_without_limits(control) => true,
                FaultId::VoltageMissing | FaultId::ExternalEmergencyStop => stopped,
                FaultId::PlcMessage => stopped || any(&[Kind::Thing, Kind::Plc, Kind::Use, Kind::AxisKey]),
                FaultId::PlcMessageFlashing
                | FaultId::EmergencyStopPlc
                | FaultId::PlcMarkers
                | FaultId::PlcStopped => any(&[Kind::Plc]),
                FaultId::Key | FaultId::Other => any(&[Kind::Use, Kind::AxisKey]) || stopped,
                FaultId::Limit => any(&[Kind::AxisKey]) || stopped,
                // A function that is acknowledged before it is done: what follows it may not be possible yet.
                FaultId::Program | FaultId::SpindleSpeed => any(&[Kind::Power, Kind::Use, Kind::Plc]),
                FaultId::HandOver => any(&[Kind::Plc]),
                _ => false,
            }
    }

    /// What must be so after a cycle.
    pub fn cycle(&mut self, control: &Control) -> Result<(), Violation> {
        let now = control.time_us();
        if let Some(due) = self.due.iter().find(|due| due.until_us < now) {
            let values = format!("{} does not come of `{}`", due.fault.name(), due.why);
            return Err(Violation::new(Rule::Reaction, now, values));
        }
        let scans = control.plc_scans();
        let runs = std::mem::replace(&mut self.scans, scans) != scans;
        if !is_fatal(control) || control.is_off() {
            self.fatal_since = None;
            return Ok(());
        }
        let since = *self.fatal_since.get_or_insert(now);
        // One cycle for the message, one for what is done about it.
        if now < since + 2 * u64::from(control.cycle_us()) {
            return Ok(());
        }
        let fault = |values: String| Err(Violation::new(Rule::Reaction, now, values));
        if control.loops_closed() {
            return fault("the loops are closed under a flashing message".to_owned());
        }
        if control.observe(&bahn_tnc::Signal::ReadyOutput) != 0.0 {
            return fault("control is ready is on under a flashing message".to_owned());
        }
        if runs {
            return fault("the PLC runs under a flashing message".to_owned());
        }
        Ok(())
    }
}

/// Axis and signal of `fault encoder X edges`.
fn encoder_fault(what: &str) -> Option<(&str, &str)> {
    let mut words = what.split_whitespace();
    match [words.next(), words.next(), words.next(), words.next()] {
        [Some("fault"), Some("encoder"), letter, signal] => letter.zip(signal),
        _ => None,
    }
}

/// A message is shown that switches "control is ready" off.
pub(super) fn is_fatal(control: &Control) -> bool {
    let mut shown = control.shown().iter();
    shown.any(|shown| shown.fault().row().reaction == Reaction::ControlReadyOff)
}

/// Some axis has no software limits.
fn is_without_limits(control: &Control) -> bool {
    let mut channels = (0..control.channels()).filter_map(|number| control.channel(number));
    channels.any(|channel| channel.watch().any(|axis| axis.limits.is_none()))
}
