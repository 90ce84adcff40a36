//! The rules: what a machine in some situation waits for. Each rule looks at one thing.

use bahn_exchange::signal::{self, SignalOperand};
use bahn_exchange::{Bit, BitArea};
use bahn_host::{LoadedMachine, Operable, Wired};
use bahn_parameters::{MessageId, Numbering};
use bahn_path::{BlockRef, Direction};
use bahn_screen::texts::{self, Language, filled as fill};
use bahn_servo::Rotation;
use bahn_tnc::{AxisState, Control, Message, Mode, RunState, Shown, Snapshot, Waiting};

use crate::reason::{Reason, Urgency};
use crate::trace::{Cause, Trace, Writers};
use crate::wiring;

/// The acknowledgement of the control voltage where the plant says nothing of its wires: I3, X42/4 [000:6149-6228]; E8 of the TNC
/// 151/155 [001:904].
const ACKNOWLEDGEMENT: u16 = 3;
const OLD_ACKNOWLEDGEMENT: u16 = 8;
/// A spindle that turns slower than this part of its nominal speed is not at speed.
const AT_SPEED: f64 = 0.5;
/// Slower is standing, rpm.
const TURNS_RPM: f64 = 1.0;
/// Suffixes of the names of markers of axes, by their index.
const SUFFIXES: &str = "XYZ45";
/// Machine parameters that reasons name, and what they are on a TNC 151/155: handwheel [001:2208-2226], order of the reference
/// run [001:1443-1478], software limits [001:3188-3195], positioning window [001:1784-1787].
const OLD_NUMBERS: [(&str, &str); 14] = [
    ("MP7640", "MP171"),
    ("MP1340", "MP59"),
    ("MP910.0", "MP44"),
    ("MP910.1", "MP46"),
    ("MP910.2", "MP48"),
    ("MP910.3", "MP50"),
    ("MP920.0", "MP45"),
    ("MP920.1", "MP47"),
    ("MP920.2", "MP49"),
    ("MP920.3", "MP51"),
    ("MP1030.0", "MP58"),
    ("MP1030.1", "MP58"),
    ("MP1030.2", "MP58"),
    ("MP1030.3", "MP192"),
];

/// A machine as it is now.
pub(crate) struct Situation<'a> {
    pub control: &'a Control,
    pub plant: &'a dyn Operable,
    pub machine: &'a LoadedMachine,
    pub wired: &'a [Wired],
    pub writers: &'a Writers,
    pub language: Language,
    /// How long the handshake has waited.
    pub waits_s: f64,
    /// NC start was pressed, and nothing came of it.
    pub start_in_vain: bool,
    /// A program runs, but no axis has moved for a while.
    pub stands_long: bool,
}

impl Situation<'_> {
    pub fn reasons(&self) -> Vec<Reason> {
        if self.control.is_off() {
            let text = self.words("The control is off: switch its supply on");
            return vec![reason(Urgency::Stands, text)];
        }
        let snapshot = self.control.snapshot();
        let mut found = Vec::new();
        self.messages(&snapshot, &mut found);
        self.voltage(&mut found);
        self.reference(&snapshot, &mut found);
        self.axes(&snapshot, &mut found);
        self.run(&snapshot, &mut found);
        self.handshake(&snapshot, &mut found);
        self.positions(&snapshot, &mut found);
        self.spindle(&snapshot, &mut found);
        self.start(&snapshot, &mut found);
        found
    }

    /// What a message says is to be done.
    fn messages(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        for shown in &snapshot.messages {
            match &shown.message {
                Message::Plain(MessageId::PowerInterrupted) => {
                    let text = self.words("POWER INTERRUPTED waits for CE");
                    found.push(reason(Urgency::Waits, text));
                }
                Message::Plain(MessageId::HandwheelMissing) => {
                    let text = self.words("The handwheel does not answer: plug it in (MP7640), then CE");
                    found.push(self.with_parameter(reason(Urgency::Stands, text), "MP7640"));
                }
                Message::Limit { axis, end } => found.extend(self.limit(snapshot, *axis, *end)),
                _ if shown.flashing => found.push(self.flashing(shown)),
                Message::Program(_) => {
                    let text = self.words("The program stands at block {1}: {2}. Correct it, then CE");
                    let block = self.number_of(shown.block);
                    let message = self.control.shown_text(shown);
                    found.push(reason(Urgency::Stands, fill(&text, &[&block, &message])));
                }
                _ => {}
            }
        }
    }

    fn flashing(&self, shown: &Shown) -> Reason {
        let text =
            self.words("The drives are off: {1}. Remove its cause, then switch the control off and on");
        reason(Urgency::Stands, fill(&text, &[&self.control.shown_text(shown)]))
    }

    fn limit(&self, snapshot: &Snapshot, index: u8, end: Direction) -> Option<Reason> {
        let axis = snapshot
            .axes
            .iter()
            .find(|axis| axis.index == usize::from(index))?;
        let (name, parameter) = match end {
            Direction::Plus => ("_PLUS", "MP910"),
            Direction::Minus => ("_MINUS", "MP920"),
        };
        let marker = axis_signal("LIMIT_REACHED_", axis.index, name)?;
        let text = self.words("{1} stands at its software limit {1}{2}, {3} is 1: drive it off with {1}{4}");
        let letter = axis.letter.to_string();
        let text = fill(
            &text,
            &[
                &letter,
                &end.to_string(),
                &marker.to_string(),
                &end.opposite().to_string(),
            ],
        );
        let parameter = format!("{parameter}.{index}");
        let reported = Reason {
            marker: Some(marker.to_string()),
            ..reason(Urgency::Stands, text)
        };
        Some(self.with_parameter(reported, &parameter))
    }

    /// EMERGENCY STOP chain and control voltage.
    fn voltage(&self, found: &mut Vec<Reason>) {
        let Some(input) = self.acknowledgement() else {
            return;
        };
        let says = |id| self.shows(id);
        let missing = says(MessageId::RelayExtDcVoltageMissing) || says(MessageId::ExternalEmergencyStop);
        let is_there = self.control.memory().bit(input);
        if !missing && is_there {
            return;
        }
        if is_there {
            let text = self.words("EMERGENCY STOP is over: CE closes the loops again");
            found.push(reason(Urgency::Waits, text));
            return;
        }
        if !missing && says(MessageId::PowerInterrupted) {
            return;
        }
        let text = self.words(
            "The control voltage is missing: {1}, the acknowledgement of the EMERGENCY STOP chain, is 0",
        );
        found.push(Reason {
            marker: Some(input.to_string()),
            causes: self.chain(),
            ..reason(Urgency::Stands, fill(&text, &[&input.to_string()]))
        });
    }

    /// The input at which the control sees its voltage.
    fn acknowledgement(&self) -> Option<Bit> {
        let is_it = |wire: &&Wired| wire.part == "emergency_stop" && wire.function == "acknowledgement";
        let wired = self.wired.iter().find(is_it);
        let wired = wired.and_then(|wire| wire.operand.parse().ok());
        let usual = match self.control.model().limits().numbering {
            Numbering::Old => OLD_ACKNOWLEDGEMENT,
            Numbering::New => ACKNOWLEDGEMENT,
        };
        wired.or_else(|| Bit::new(BitArea::I, usual))
    }

    /// What keeps the relay of the chain open.
    fn chain(&self) -> Vec<String> {
        let chain = self.plant.stop_chain();
        let mut causes = Vec::new();
        if chain.pressed {
            causes.push(self.words("the EMERGENCY STOP button is pressed: release it"));
        }
        if !chain.supply {
            causes.push(self.words("the supply of the control voltage is missing"));
        }
        if !chain.limits_clear {
            causes.push(self.words("a limit switch of the chain is actuated"));
        }
        if let Some(key) = &self.machine.folder.operator.control_voltage {
            causes.push(fill(&self.words("switch it on with {1}"), &[key]));
        } else if causes.is_empty() {
            causes.push(self.words("the relay of the control voltage does not pull in"));
        }
        causes
    }

    /// PASS OVER REFERENCE MARKS.
    fn reference(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        if snapshot.mode != Mode::Reference || !self.control.stands() {
            return;
        }
        let missing = snapshot.axes.iter().filter(|axis| !axis.referenced);
        let letters: Vec<String> = missing.map(|axis| axis.letter.to_string()).collect();
        if letters.is_empty() {
            return;
        }
        let text = self.words(
            "Reference marks are missing of {1}, in the order of MP1340: NC start, or the key of the axis",
        );
        let text = fill(&text, &[&letters.join(" ")]);
        found.push(self.with_parameter(reason(Urgency::Waits, text), "MP1340"));
    }

    /// Feed enable, override, loops that the PLC opens.
    fn axes(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        if !self.control.loops_closed() {
            return;
        }
        let locked: Vec<&AxisState> = snapshot.axes.iter().filter(|axis| !axis.enabled).collect();
        if let Some(first) = locked.first() {
            let letters = if locked.len() == snapshot.axes.len() {
                self.words("All axes stand")
            } else {
                let letters: Vec<String> = locked.iter().map(|axis| axis.letter.to_string()).collect();
                fill(&self.words("{1} stands"), &[&letters.join(" ")])
            };
            let _ = first;
            let text = self.words("{1}: no feed enable, {2} is 0, {3}");
            found.push(self.of_bit(Urgency::Stands, &text, &letters, signal::FEED_ENABLE, true));
        }
        if snapshot.feed_override_percent <= 0.0 {
            found.push(self.feed_override());
        }
        for axis in snapshot.axes.iter().filter(|axis| !axis.closed) {
            found.extend(self.open_loop(axis));
        }
    }

    fn feed_override(&self) -> Reason {
        let [knob, _] = self.plant.knobs();
        let text = match knob > 0.0 {
            true => self.words("The feed override is 0: the PLC program writes {1}"),
            false => self.words("The feed override is 0 ({1}): turn its knob up"),
        };
        let word = signal::FEED_OVERRIDE_FROM_PLC.to_string();
        Reason {
            marker: Some(word.clone()),
            ..reason(Urgency::Stands, fill(&text, &[&word]))
        }
    }

    fn open_loop(&self, axis: &AxisState) -> Option<Reason> {
        let all = signal::NC_STOP_AND_OPEN_LOOPS;
        let marker = match self.bit(all) {
            true => all,
            false => axis_signal("OPEN_CONTROL_LOOP_AXIS_", axis.index, "")?,
        };
        if !self.bit(marker) {
            return None;
        }
        let text = self.words("{1} is clamped: its loop is open, {2} is 1, {3}");
        Some(self.of_bit(Urgency::Reported, &text, &axis.letter.to_string(), marker, false))
    }

    /// What a block is called.
    fn number_of(&self, block: Option<BlockRef>) -> String {
        let number = block.map(|block| self.control.first().number_of(block));
        number.map_or_else(String::new, |number| number.to_string())
    }

    /// Where the program stands.
    fn run(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        let block = self.number_of(snapshot.block);
        let at = |text: &'static str| fill(&self.words(text), &[&block]);
        match snapshot.run {
            RunState::Idle if snapshot.ended => {
                let text = self.words("The program has come to its end: NC start runs it again");
                found.push(reason(Urgency::Reported, text));
            }
            RunState::Idle => {}
            RunState::Running => self.stop_line(found),
            RunState::Interrupted => {
                self.stop_line(found);
                let text = match (self.control.is_broken(), self.control.first().restores()) {
                    (true, _) => {
                        at("A fault has interrupted the program at block {1}: NC start tries it again")
                    }
                    (_, true) => at("The axes are off the contour of block {1}: NC start brings them back"),
                    _ => at("The program is interrupted at block {1}: NC start goes on"),
                };
                found.push(started(reason(Urgency::Waits, text)));
            }
            RunState::Stopped => {
                let text = at("A programmed stop in block {1}: NC start goes on");
                found.push(started(reason(Urgency::Waits, text)));
            }
            RunState::BlockEnd => {
                let text = at("Single block: NC start executes the block after {1}");
                found.push(started(reason(Urgency::Waits, text)));
            }
        }
    }

    /// NC stop that is there all the time.
    fn stop_line(&self, found: &mut Vec<Reason>) {
        if !self.bit(signal::NC_STOP) {
            let text = self.words("{1}: NC stop, {2} is 0, {3}");
            let program = self.words("The program stands");
            found.push(self.of_bit(Urgency::Stands, &text, &program, signal::NC_STOP, true));
        }
    }

    /// A function that the PLC has not acknowledged.
    fn handshake(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        // Whole seconds: a screen that nobody changes is not another one ten times a second.
        let seconds = format!("{:.0}", self.waits_s.floor());
        match snapshot.waiting {
            None => {}
            Some(Waiting::Acknowledge(pair)) => {
                let text =
                    self.words("{1} has waited {4} s for {2}, the acknowledgement: the strobe {5} is 1, {3}");
                let text = text
                    .replace("{4}", &seconds)
                    .replace("{5}", &self.named(pair.strobe));
                let program = self.words("The program");
                found.push(self.of_bit(Urgency::Waits, &text, &program, pair.acknowledge, true));
            }
            Some(Waiting::AcknowledgeReset(pair)) => {
                let text =
                    self.words("{1} has waited {4} s until {2}, the last acknowledgement, is 0 again, {3}");
                let text = text.replace("{4}", &seconds);
                let program = self.words("The program");
                found.push(self.of_bit(Urgency::Waits, &text, &program, pair.acknowledge, false));
            }
        }
        if self.bit(signal::PROBING_ENABLE) {
            let text = self.words("{1} waits until {2}, the enable of probing, is 0, {3}");
            let program = self.words("The program");
            found.push(self.of_bit(Urgency::Waits, &text, &program, signal::PROBING_ENABLE, false));
        }
        if self.bit(signal::READ_IN_INHIBIT) && snapshot.run == RunState::Running {
            let text = self.words("{1} reads no further block: {2} is 1, {3}");
            let program = self.words("The program");
            found.push(self.of_bit(Urgency::Waits, &text, &program, signal::READ_IN_INHIBIT, false));
        }
    }

    /// Axes that do not come into their positioning windows, which a program waits for.
    fn positions(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        if !self.stands_long {
            return;
        }
        let off = snapshot.axes.iter();
        for axis in off.filter(|axis| axis.closed && axis.enabled && !axis.in_position) {
            let Some(marker) = axis_signal("AXIS_", axis.index, "_IN_POSITION") else {
                continue;
            };
            let text = self.words(
                "The program waits for {1}: its lag {2} is beyond the positioning window {4}, {3} is 0",
            );
            let parameter = format!("MP1030.{}", axis.index);
            let values = [
                axis.letter.to_string(),
                format!("{:.3}", axis.lag),
                marker.to_string(),
                parameter.clone(),
            ];
            let [letter, lag, name, window] = &values;
            let reported = Reason {
                marker: Some(name.clone()),
                ..reason(Urgency::Stands, fill(&text, &[letter, lag, name, window]))
            };
            found.push(self.with_parameter(reported, &parameter));
        }
    }

    /// It should turn, but does not.
    fn spindle(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        let spindle = &snapshot.spindle;
        if spindle.rotation == Rotation::M5 || spindle.programmed_rpm < TURNS_RPM {
            return;
        }
        if self.bit(signal::SPINDLE_DISPLAY_INVERSE) {
            let text = self.words("{1} gets 0 V: {2} is 1, {3}");
            let name = self.words("The spindle");
            let marker = signal::SPINDLE_DISPLAY_INVERSE;
            found.push(self.of_bit(Urgency::Stands, &text, &name, marker, false));
        } else if snapshot.spindle_override_percent <= 0.0 {
            let word = signal::SPINDLE_OVERRIDE_FROM_PLC.to_string();
            let text = self.words("The spindle override is 0 ({1}): turn its knob up");
            found.push(Reason {
                marker: Some(word.clone()),
                ..reason(Urgency::Stands, fill(&text, &[&word]))
            });
        } else if spindle.actual_rpm.abs() < AT_SPEED * spindle.nominal_rpm.abs()
            && self.bit(signal::SPINDLE_VOLTAGE_NOT_ON_RAMP)
        {
            let text =
                self.words("The spindle does not reach its speed: it turns with {1} of {2} rpm at {3} V");
            let numbers = [
                format!("{:.0}", spindle.actual_rpm.abs()),
                format!("{:.0}", spindle.nominal_rpm.abs()),
                format!("{:.1}", spindle.volts),
            ];
            let [actual, nominal, volts] = &numbers;
            found.push(reason(Urgency::Stands, fill(&text, &[actual, nominal, volts])));
        }
    }

    /// NC start was pressed in vain.
    fn start(&self, snapshot: &Snapshot, found: &mut Vec<Reason>) {
        let automatic = snapshot.mode.is_automatic();
        if self.start_in_vain && automatic && self.control.first().lacks_reference() {
            let text = self.words("No program starts: reference marks are missing (MP1340)");
            found.push(self.with_parameter(reason(Urgency::Stands, text), "MP1340"));
        } else if self.start_in_vain && automatic && snapshot.program.is_none() && snapshot.mode != Mode::Mdi
        {
            let text = self.words("No program is selected: choose one with PGM NR");
            found.push(reason(Urgency::Stands, text));
        } else if self.start_in_vain {
            let mut image = self.control.memory().clone();
            let key = &self.machine.folder.operator.start;
            // As if it were pressed: what else keeps the start away?
            for wired in self.wired.iter().filter(|wired| wired.is_key(key)) {
                if let Ok(bit) = wired.operand.parse::<Bit>() {
                    image.set_bit(bit, !wired.opens);
                }
            }
            let trace = Trace {
                program: &self.machine.plc,
                writers: self.writers,
                image: &image,
            };
            let causes = trace.causes(signal::NC_START, true);
            if causes.is_empty() {
                return;
            }
            let text = self.words("{1} is not permitted: {2} is 0, {3}");
            let name = self.words("NC start");
            let mut reported = self.of_bit(Urgency::Stands, &text, &name, signal::NC_START, true);
            reported.causes = self.causes(&causes);
            found.push(reported);
        }
    }

    /// A reason that is a bit which is not as it is wanted: `{1}` who, `{2}` the bit, `{3}` who sets it and where.
    fn of_bit(&self, urgency: Urgency, text: &str, who: &str, bit: Bit, wanted: bool) -> Reason {
        let trace = Trace {
            program: &self.machine.plc,
            writers: self.writers,
            image: self.control.memory(),
        };
        let lines = trace.lines(bit, Some(wanted));
        let by = match (lines.is_empty(), wanted) {
            (true, _) => self.words("the PLC program does not write it"),
            (false, true) => fill(&self.words("the PLC program sets it ({1})"), &[&lines.join(", ")]),
            (false, false) => fill(
                &self.words("the PLC program resets it ({1})"),
                &[&lines.join(", ")],
            ),
        };
        Reason {
            marker: Some(bit.to_string()),
            lines,
            causes: self.causes(&trace.causes(bit, wanted)),
            ..reason(urgency, fill(text, &[who, &bit.name(self.is_old()), &by]))
        }
    }

    /// The control has the letters and numbers of the TNC 151/155.
    fn is_old(&self) -> bool {
        self.control.model().limits().has_old_numbers()
    }

    fn causes(&self, causes: &[Cause]) -> Vec<String> {
        let in_words = |cause: &Cause| match cause {
            Cause::Bit(bit, value) => {
                let is = fill(
                    &self.words("{1} is {2}"),
                    &[&bit.name(self.is_old()), if *value { "1" } else { "0" }],
                );
                match self.meaning(*bit) {
                    Some(meaning) => format!("{is} ({meaning})"),
                    None => is,
                }
            }
            Cause::Compare(text, true) => text.clone(),
            Cause::Compare(text, false) => fill(&self.words("not {1}"), &[text]),
        };
        causes.iter().map(in_words).collect()
    }

    /// What is wired to an input or output, what a marker means.
    fn meaning(&self, bit: Bit) -> Option<String> {
        let name = bit.to_string();
        let wired: Vec<String> = self
            .wired
            .iter()
            .filter(|wired| wired.operand == name)
            .map(|wired| wiring::in_words(wired, self.plant, self.language))
            .collect();
        if !wired.is_empty() {
            return Some(wired.join(", "));
        }
        let known = signal::named(SignalOperand::Bit(bit));
        known.map(|signal| signal.function.to_owned())
    }

    /// `M2045` with what it means.
    fn named(&self, bit: Bit) -> String {
        match self.meaning(bit) {
            Some(meaning) => format!("{bit} ({meaning})"),
            None => bit.to_string(),
        }
    }

    fn shows(&self, id: MessageId) -> bool {
        let mut shown = self.control.shown().iter();
        shown.any(|shown| shown.message == Message::Plain(id))
    }

    fn bit(&self, bit: Bit) -> bool {
        self.control.memory().bit(bit)
    }

    fn words(&self, english: &'static str) -> String {
        texts::words(self.language, english).to_owned()
    }

    /// A reason with its machine parameter, which a control with old numbers names by its own.
    fn with_parameter(&self, reason: Reason, parameter: &str) -> Reason {
        let mut own = OLD_NUMBERS.iter().filter(|_| self.is_old());
        let old = own.find(|(new, _)| *new == parameter);
        let own = old.map_or(parameter, |(_, old)| *old);
        Reason {
            text: reason.text.replace(parameter, own),
            parameter: Some(own.to_owned()),
            ..reason
        }
    }
}

fn reason(urgency: Urgency, text: String) -> Reason {
    Reason {
        urgency,
        text,
        marker: None,
        parameter: None,
        lines: Vec::new(),
        causes: Vec::new(),
    }
}

/// NC start is what goes on.
fn started(reason: Reason) -> Reason {
    Reason {
        marker: Some(signal::NC_START.to_string()),
        ..reason
    }
}

/// The marker of an axis by the beginning and the end of its name.
fn axis_signal(begin: &str, index: usize, end: &str) -> Option<Bit> {
    let suffix = SUFFIXES.chars().nth(index)?;
    let name = format!("{begin}{suffix}{end}");
    let signal = signal::all().iter().find(|signal| signal.name == name)?;
    match signal.operand {
        SignalOperand::Bit(bit) => Some(bit),
        _ => None,
    }
}
