//! The commands of the operator.

use bahn_exchange::signal;
use bahn_parameters::technology::Technology;
use bahn_path::Axis;

use crate::axes::Mover;
use crate::command::{Command, Mode};
use crate::control::Control;
use crate::message::Message;
use crate::run::RunState;

/// Code numbers [000:6928-6947].
const ERASE_MEMORY: u32 = 531_210;
const OFFSET_ADJUSTMENT: u32 = 75_368;
const CODE_84159: u32 = 84_159;
/// Marker of a key = code + this [000:7326-7404].
const KEY_MARKER: u16 = 2796;

impl Control {
    /// Executes a command; `false` when it is not possible now.
    pub(crate) fn execute(&mut self, command: Command) -> bool {
        match command {
            Command::Mode(mode) => self.choose_mode(mode),
            Command::Ce => self.clear_message(),
            Command::InternalStop => self.internal_stop(),
            Command::Select(name) => self.select(name),
            Command::Goto(block) => self.goto(block),
            Command::Mdi(blocks) => {
                let possible = !self.run.is_active();
                if possible {
                    self.run.mdi = Some(blocks);
                }
                possible
            }
            Command::MFunction(m) => self.enter_function(|manual| manual.m = Some(m)),
            Command::Speed(rpm) => self.enter_function(|manual| manual.s = Some(rpm)),
            Command::Datum(axis, value) => self.set_datum(axis, value),
            Command::JogIncrement(mm) => {
                self.manual.increment = mm;
                true
            }
            Command::ToolLife(tool, minutes) => {
                self.unsaved = true;
                self.set_tool_life(tool, minutes)
            }
            Command::Handwheel(axis, factor) => self.choose_handwheel(axis, factor),
            Command::ManualOperation => self.manual_operation(),
            Command::RestorePosition => self.restore_position(),
            Command::RestoreAt(block) => self.restore_at(block),
            Command::Code(code) => self.enter_code(code),
            Command::Key(code) => self.press_key(code),
            Command::Test(name) => self.test(&name),
            Command::EndTest => {
                self.end_test();
                true
            }
            Command::OffsetAdjustment(adjust) => self.adjust_offsets(adjust),
        }
    }

    fn choose_mode(&mut self, mode: Mode) -> bool {
        let possible = match self.run.state {
            _ if mode == self.mode => true,
            _ if !self.run.is_active() => true,
            RunState::Idle => false,
            // Single block ends a full sequence at the end of its block, and back.
            _ => self.mode != Mode::Mdi && matches!(mode, Mode::SingleBlock | Mode::FullSequence),
        };
        let missing = self
            .axes
            .iter()
            .any(|unit| !unit.referenced && !unit.is_plc_axis());
        if !possible || mode == Mode::Reference && !missing {
            return false;
        }
        self.set_mode(mode);
        true
    }

    /// Changes the operating mode, and with it the kind of positioning.
    pub(crate) fn set_mode(&mut self, mode: Mode) {
        if mode == self.mode {
            return;
        }
        if self.mode == Mode::Reference {
            self.reference.abort();
        }
        // What the old mode moved comes to a standstill on its ramp.
        for unit in &mut self.axes {
            if matches!(unit.mover, Mover::Reference | Mover::Manual) {
                unit.mover = Mover::None;
            }
        }
        self.mode = mode;
        self.manual.stop();
    }

    /// CE: clears a message, and what it stands for.
    fn clear_message(&mut self) -> bool {
        use crate::emergency::Circuit;
        use bahn_parameters::MessageId;
        let circuit = self.emergency.circuit();
        let may = |message: &Message| match message {
            // Only when the control voltage is back [000:6203-6204].
            Message::Plain(MessageId::ExternalEmergencyStop) => {
                matches!(circuit, Circuit::VoltageBack | Circuit::Ready)
            }
            Message::Plain(MessageId::RelayExtDcVoltageMissing) => false,
            _ => true,
        };
        let Some(message) = self.messages.clear(&mut self.exchange, may) else {
            return false;
        };
        match message {
            Message::Plain(MessageId::PowerInterrupted | MessageId::ExternalEmergencyStop) => {
                self.emergency.clear();
            }
            Message::Axis {
                id: MessageId::PositioningError,
                axis,
                ..
            } => {
                let unit = self.axes.iter_mut().find(|unit| unit.index == usize::from(axis));
                if let Some(unit) = unit {
                    unit.servo.acknowledge();
                    unit.transfer();
                }
            }
            _ => {}
        }
        true
    }

    fn goto(&mut self, block: u32) -> bool {
        if self.run.is_active() {
            return false;
        }
        self.q = self.q_values();
        self.run.start_block = block;
        self.run.feeder = None;
        self.run.forget_interruption();
        true
    }

    /// M and S in Manual and Handwheel: entered here, output with NC start [003:1103-1111].
    fn enter_function(&mut self, enter: impl Fn(&mut crate::manual::Manual)) -> bool {
        let possible = matches!(self.mode, Mode::Manual | Mode::Handwheel);
        if possible {
            enter(&mut self.manual);
        }
        possible
    }

    /// NC start in Manual and Handwheel: outputs what was entered.
    pub(crate) fn output_entered(&mut self) {
        if !self.handshakes.is_idle() {
            return;
        }
        let inch = false;
        let mut target = crate::functions::Target {
            spindle: &mut self.spindle,
            tools: &mut self.tools,
            offsets: &mut self.offsets,
            handshakes: &mut self.handshakes,
            exchange: &mut self.exchange,
            axes: &mut self.axes,
            inch,
        };
        if let Some(rpm) = self.manual.s.take() {
            target.speed(rpm, false);
        }
        if let Some(m) = self.manual.m.take()
            && let Some(technology) = Technology::of_m(self.model, m)
        {
            target.m_by_hand(technology, m);
        }
    }

    /// DATUM SET: the actual position becomes a value.
    fn set_datum(&mut self, axis: Axis, value: f64) -> bool {
        let manual = matches!(self.mode, Mode::Manual | Mode::Handwheel);
        let unit = self.axes.iter().find(|unit| unit.axis == axis);
        let Some(unit) = unit.filter(|unit| manual && !unit.parameters.travel.datum_inhibited) else {
            return false;
        };
        let length = if axis == self.offsets.tool_axis {
            self.offsets.tool_length
        } else {
            0.0
        };
        let correction = self.correction.get(unit.index).copied().unwrap_or(0.0);
        let datum = unit.servo.actual_mm() - length - value + correction;
        let place = if self.operation.datums.datum_for_each_range {
            self.range
        } else {
            0
        };
        if let Some(datums) = self.datums.get_mut(place) {
            datums[axis] = datum;
        }
        self.offsets.datum = self.active_datum();
        self.unsaved = true;
        true
    }

    fn choose_handwheel(&mut self, axis: Axis, factor: u8) -> bool {
        let Some(index) = self
            .axes
            .iter()
            .find(|unit| unit.axis == axis)
            .map(|unit| unit.index)
        else {
            return false;
        };
        self.manual.handwheel_axis = index;
        if let Some(slot) = self.manual.factors.get_mut(index) {
            *slot = factor;
        }
        true
    }

    /// A code number; the last one stands in D276 for the PLC [000:6928-6947].
    fn enter_code(&mut self, code: u32) -> bool {
        self.put_number(signal::CODE_NUMBER, i32::try_from(code).unwrap_or(i32::MAX));
        match code {
            ERASE_MEMORY => self.exchange.erase_retained(),
            CODE_84159 => self.put(signal::CODE_84159_ENTERED, true),
            OFFSET_ADJUSTMENT => self.manual.offsets_shown = true,
            _ => {}
        }
        true
    }

    /// A key of the keyboard: inhibited ones only tell the PLC, with M2182 and W274 [000:7319].
    fn press_key(&mut self, code: u8) -> bool {
        let marker = bahn_exchange::Bit::new(bahn_exchange::BitArea::M, KEY_MARKER + u16::from(code));
        if marker.is_some_and(|marker| self.exchange.nc().bit(marker)) {
            self.put_number(signal::INHIBITED_KEY_CODE, code.into());
            self.exchange.nc_set(signal::INHIBITED_KEY_PRESSED, true);
        }
        true
    }
}
