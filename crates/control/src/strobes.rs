//! What the PLC asks the NC for between the big handshakes: traverse range, datum correction, Q
//! parameters, actual-value transfer, keys, gear and speed, and the requests of modules.

use bahn_exchange::signal;
use bahn_plc::{CoordinateKind, JogLimit};

use crate::axes::Mover;
use crate::command::{Command, Mode};
use crate::control::Control;
use crate::markers::LUBRICATION_PULSE;
use crate::markers::{ACTUAL_TO_NOMINAL, AXES, LAG_TRACKING, LUBRICATED, PLC_POSITIONING, TRANSFER};
use crate::message::Message;
use crate::positioning::PER_MM;
use crate::q_transfer::Q_FROM_PLC;

/// W576 ff. count in 1/10 µm [000:10950].
const PER_MM_TRACKING: f64 = 10_000.0;

impl Control {
    /// Takes the strobes that the PLC set in a scan, and resets them.
    pub(crate) fn take_plc_strobes(&mut self) {
        if self.doubly_used_transfer() {
            return;
        }
        self.take_positioning_strobes();
        self.take_free_rotation();
        self.take_range();
        self.take_datum_correction();
        self.take_q_parameter();
        self.take_actual_values();
        self.take_key();
        self.take_lubrication();
        self.take_lag_tracking();
        self.tools
            .take_geometry_strobe(&mut self.exchange, &mut self.offsets);
        if let Some(code) = self.spindle.take_markers(&mut self.exchange) {
            self.show(Message::PlcMarkers(code), true);
        }
    }

    /// Two uses of D528 in one scan are a fault: 1R [000:631-633].
    fn doubly_used_transfer(&mut self) -> bool {
        let nc = self.exchange.nc();
        let new_positioning = PLC_POSITIONING
            .iter()
            .zip(&self.positioning.targets)
            .any(|(strobe, running)| nc.bit(*strobe) && running.is_none());
        let uses = [
            new_positioning,
            nc.bit(signal::TRANSFER_Q_PARAMETER),
            nc.bit(signal::CORRECT_DATUM),
        ];
        let fault = uses.into_iter().filter(|used| *used).count() > 1;
        if fault {
            self.show(Message::PlcMarkers(*b"1R"), true);
        }
        fault
    }

    /// M2824: the traverse range in M2816 and M2817 [000:3510-3520]. 3 is not defined; the range stays
    /// (inferred).
    fn take_range(&mut self) {
        let nc = self.exchange.nc();
        if !nc.bit(signal::ACTIVATE_TRAVERSE_RANGE) {
            return;
        }
        let bits = [
            nc.bit(signal::TRAVERSE_RANGE_BIT_0),
            nc.bit(signal::TRAVERSE_RANGE_BIT_1),
        ];
        match bits {
            [false, false] => self.select_range(0),
            [true, false] => self.select_range(1),
            [false, true] => self.select_range(2),
            [true, true] => {}
        }
        self.upkeep.range_changed = self.run.is_active();
        self.exchange.nc_set(signal::ACTIVATE_TRAVERSE_RANGE, false);
    }

    /// Makes a traverse range active, with its datum where each has one (MP7490).
    pub(crate) fn select_range(&mut self, range: usize) {
        self.range = range;
        for unit in &mut self.axes {
            if let Some(limits) = unit.parameters.travel.ranges_mm.get(range) {
                unit.limits = *limits;
            }
        }
        self.offsets.datum = self.active_datum();
    }

    /// The datum in force with its correction by the PLC.
    pub(crate) fn active_datum(&self) -> bahn_path::Position {
        let place = if self.operation.datums.datum_for_each_range {
            self.range
        } else {
            0
        };
        let mut datum = self
            .datums
            .get(place)
            .copied()
            .unwrap_or(bahn_path::Position::ZERO);
        for unit in &self.axes {
            // The display rises by the correction: the datum moves the other way [000:8916-8922].
            datum[unit.axis] -= self.correction.get(unit.index).copied().unwrap_or(0.0);
        }
        datum
    }

    /// M2716: datum correction D528 ff., each replaces the last one; during an M, S or T strobe only
    /// [000:8910-8940].
    fn take_datum_correction(&mut self) {
        if !self.exchange.nc().bit(signal::CORRECT_DATUM) {
            return;
        }
        if self.handshakes.strobe_is_set() || !self.run.is_running() {
            for (value, number) in self.correction.iter_mut().zip(TRANSFER) {
                *value = f64::from(self.exchange.nc().number(number)) / PER_MM;
            }
            self.offsets.datum = self.active_datum();
        }
        self.exchange.nc_set(signal::CORRECT_DATUM, false);
    }

    /// M2713: D528 into Q100 to Q107 by W516 [000:6997-7008] [000:11657-11663].
    fn take_q_parameter(&mut self) {
        let nc = self.exchange.nc();
        if !nc.bit(signal::TRANSFER_Q_PARAMETER) {
            return;
        }
        let number = nc.number(signal::KEY_CODE_OR_Q_NUMBER);
        let value = f64::from(nc.number(signal::TRANSFER_VALUE)) / PER_MM;
        if let Some(number) = u16::try_from(number).ok().filter(|number| *number <= 7) {
            self.set_q(Q_FROM_PLC + number, value);
        }
        self.exchange.nc_set(signal::TRANSFER_Q_PARAMETER, false);
    }

    /// M2552 ff.: the actual value becomes the nominal value, in Manual and Handwheel [000:5423-5434].
    fn take_actual_values(&mut self) {
        if !matches!(self.mode, Mode::Manual | Mode::Handwheel) {
            return;
        }
        let nc = self.exchange.nc();
        for unit in &mut self.axes {
            let wanted = ACTUAL_TO_NOMINAL
                .get(unit.index)
                .is_some_and(|marker| nc.bit(*marker));
            if wanted && unit.mover == Mover::None {
                unit.transfer();
            }
        }
    }

    /// M2813: a key by its code in W516, or a soft-key function; M2187 = 1 when it was not executed
    /// [000:7406-7440].
    fn take_key(&mut self) {
        let nc = self.exchange.nc();
        if !nc.bit(signal::SIMULATE_KEY) {
            return;
        }
        let code = nc.number(signal::KEY_CODE_OR_Q_NUMBER);
        let done = match code {
            0x0000 => self.execute(Command::InternalStop),
            0x0400 => self.execute(Command::Mode(Mode::Reference)),
            0x0500 => self.execute(Command::RestorePosition),
            58..=127 => u8::try_from(code).is_ok_and(|code| self.execute(Command::Key(code))),
            _ => false,
        };
        self.put(signal::SOFT_KEY_NOT_EXECUTED, !done);
        self.exchange.nc_set(signal::SIMULATE_KEY, false);
    }

    /// M2548 ff.: the PLC lubricated; the way counts anew. The NC acts on the level and leaves the marker
    /// to the PLC [000:3575-3598].
    fn take_lubrication(&mut self) {
        for unit in &mut self.axes {
            let (Some(done), Some(pulse)) = (LUBRICATED.get(unit.index), LUBRICATION_PULSE.get(unit.index))
            else {
                continue;
            };
            if self.exchange.nc().bit(*done) && self.exchange.nc().bit(*pulse) {
                unit.travelled = 0.0;
                self.exchange.nc_set(*pulse, false);
            }
        }
    }

    /// W576 ff.: thermal lag tracking, once in each PLC cycle [000:3902-3912].
    fn take_lag_tracking(&mut self) {
        let step = self.plc_parameters.tracking_step_mm;
        for unit in &mut self.axes {
            if let Some(word) = LAG_TRACKING.get(unit.index) {
                let offset = f64::from(self.exchange.nc().number(*word)) / PER_MM_TRACKING;
                unit.servo.track(offset, step);
            }
        }
    }

    /// What modules asked for in a scan.
    pub(crate) fn take_module_requests(&mut self) {
        for (axis, (command, percent)) in self.positioning.plc_axes.iter_mut().zip(
            self.link
                .requests
                .plc_axes
                .iter_mut()
                .zip(&mut self.link.requests.plc_axis_override),
        ) {
            if let Some(command) = command.take() {
                axis.command = Some(command);
                axis.target = None;
            }
            if let Some(percent) = percent.take() {
                axis.override_percent = percent;
            }
        }
        if let Some(orientation) = self.link.requests.orientation.take() {
            self.spindle.orient(orientation, &mut self.exchange);
        }
        if let Some(call) = self.link.requests.tool_call.take() {
            self.tools.inserted_call = Some(call);
        }
        if let Some(request) = self.link.requests.pallet.take() {
            self.select_pallet(request);
        }
        if let Some(volts) = self.link.requests.spindle_volts.take() {
            self.spindle.set_plc_volts(volts);
        }
        self.change_status();
        if std::mem::take(&mut self.link.requests.restart) {
            self.run.restart_wanted = true;
        }
        if let Some(line) = self.link.requests.compensation_line.take() {
            self.activate_compensation(usize::try_from(line).ok());
        }
        self.take_changed_parameters();
        if std::mem::take(&mut self.link.requests.geometry) {
            self.initialise_geometry();
            self.datums_written();
            self.unsaved = true;
        }
    }

    /// Module 9036.
    fn change_status(&mut self) {
        let changes = std::mem::take(&mut self.link.requests.status);
        for (factor, changed) in self.manual.factors.iter_mut().zip(changes.factors) {
            *factor = changed.unwrap_or(*factor);
        }
        if let Some(axis) = changes.handwheel_axis {
            self.manual.handwheel_axis = axis;
        }
        match changes.jog_limit {
            None => {}
            Some(JogLimit::At(limit)) => self.manual.increment_limit = Some(limit),
            Some(JogLimit::LastIncrement) => self.manual.increment_limit = None,
            Some(JogLimit::SmallerOfLastIncrementAndLimit) => {
                if let Some(limit) = self.manual.increment_limit.take() {
                    self.manual.increment = self.manual.increment.min(limit);
                }
            }
        }
    }

    /// The coordinates that modules 9040 and 9041 read in the next scan.
    pub(crate) fn publish_coordinates(&mut self) {
        let mut rows = [[0.0; AXES]; 5];
        for unit in &self.axes {
            let offset = self.offsets.of(unit.axis);
            let values = [
                unit.servo.actual_mm() - offset,
                unit.nominal - offset,
                unit.servo.actual_mm(),
                unit.servo.lag_mm(),
                self.distance_to_go(unit),
            ];
            for (row, value) in rows.iter_mut().zip(values) {
                if let Some(cell) = row.get_mut(unit.index) {
                    *cell = value;
                }
            }
        }
        for (kind, row) in CoordinateKind::ALL.iter().zip(rows) {
            self.link.set_coordinates(*kind, row);
        }
        if let Some(actual) = rows.first() {
            self.link.set_coordinates(CoordinateKind::ShiftedDatum, *actual);
        }
    }
}
