//! Control voltage, EMERGENCY STOP, loops and feed enable: whether an axis may move at all.

use bahn_exchange::signal;
use bahn_parameters::{MessageId, Station};
use bahn_servo::Fault;

use crate::axes::Mover;
use crate::command::Mode;
use crate::control::Control;
use crate::emergency::Circuit;
use crate::markers::{AXES, MONITORING_OFF, OPEN_LOOP};
use crate::message::{Message, SPINDLE_INDEX};

const VOLTAGE_MISSING: Message = Message::Plain(MessageId::RelayExtDcVoltageMissing);
const EMERGENCY_STOP: Message = Message::Plain(MessageId::ExternalEmergencyStop);

impl Control {
    /// Follows the "control is ready" circuit.
    pub(crate) fn follow_circuit(&mut self) {
        if self.operation.station != Station::Machine {
            // A programming station has no machine: its loops stay open [000:6951].
            return;
        }
        if self.messages.is_fatal() {
            self.emergency.fail();
        }
        let circuit = self.emergency.circuit();
        if circuit == Circuit::VoltageMissing {
            self.show(VOLTAGE_MISSING, false);
        } else if self.messages.contains(&VOLTAGE_MISSING) {
            self.messages.remove(&VOLTAGE_MISSING);
        }
        match circuit {
            Circuit::PowerInterrupted | Circuit::VoltageMissing | Circuit::Testing => {}
            Circuit::Ready => {
                if !self.loops_closed {
                    self.close_loops();
                }
            }
            Circuit::Defective => {
                if !self.messages.is_fatal() {
                    self.show(Message::Plain(MessageId::EmergencyStopDefective), true);
                }
                self.open_loops();
            }
            Circuit::EmergencyStop | Circuit::VoltageBack => self.emergency_stop(circuit),
        }
    }

    /// The acknowledgement was lost: as an external stop, a moving axis is ramped down under control
    /// [000:6155-6157]. Then the loops are opened (inferred). With M2827 nothing is reported and the loops
    /// open at once [000:5403-5421].
    fn emergency_stop(&mut self, circuit: Circuit) {
        self.stop_run();
        let silent = self.exchange.nc().bit(signal::EMERGENCY_STOP_AS_NC_STOP);
        if silent {
            self.open_loops();
            if circuit == Circuit::VoltageBack {
                self.emergency.clear();
            }
            return;
        }
        self.show(EMERGENCY_STOP, false);
        // What the PLC positions ends with it; the strobes are reset [000:4013-4019].
        for index in 0..AXES {
            self.end_positioning(index);
        }
        self.positioning.stop();
        let stands = if self.path.is_coupled() {
            self.thread_stands()
        } else {
            self.axes.iter().all(|unit| unit.stands())
        };
        if self.loops_closed && stands {
            self.open_loops();
        }
    }

    /// The control voltage has come: the axes are held where they are, M2000 ff. are set [000:5341-5350].
    fn close_loops(&mut self) {
        self.loops_closed = true;
        for unit in self.axes.iter_mut().filter(|unit| unit.parameters.controlled) {
            unit.transfer();
            unit.servo.close();
        }
        crate::gantry::switch_on(&mut self.axes);
        if !std::mem::replace(&mut self.reference.asked, true) && self.reference_is_missing(true) {
            self.set_mode(Mode::Reference);
        }
    }

    pub(crate) fn open_loops(&mut self) {
        self.loops_closed = false;
        self.part_thread();
        self.spindle.open();
        self.manual.stop();
        self.reference.abort();
        self.positioning.stop();
        self.path.halt();
        for unit in &mut self.axes {
            unit.servo.open();
            unit.transfer();
            unit.mover = Mover::None;
        }
    }

    /// Opens and closes the loop of each axis as the PLC asks for, and gives the feed enable
    /// [000:5352-5369] [000:5403-5421].
    pub(crate) fn follow_loops(&mut self) {
        let monitoring_off = self.monitoring_is_off();
        let nc = self.exchange.nc();
        let all_open = nc.bit(signal::NC_STOP_AND_OPEN_LOOPS);
        let by_axis = nc.number(signal::FEED_ENABLE_AXES);
        for unit in self.axes.iter_mut().filter(|unit| unit.parameters.controlled) {
            let open = OPEN_LOOP.get(unit.index).is_some_and(|marker| nc.bit(*marker));
            let wanted = self.loops_closed && !open && !all_open;
            let sound = unit.servo.fault().is_none_or(Fault::cancellable);
            if wanted && sound && !unit.servo.closed() {
                // A clamped axis goes back to its nominal position, unless it was moved meanwhile.
                let moved = (unit.servo.actual_mm() - unit.nominal).abs();
                if moved > unit.parameters.monitoring.standstill_mm {
                    unit.transfer();
                }
                unit.servo.close();
            } else if !wanted && unit.servo.closed() {
                unit.servo.open();
                unit.stand(unit.nominal);
            }
            let enabled = self.panel.feed_enable || by_axis >> unit.index & 1 != 0;
            if unit.enabled && !enabled && !(unit.stands() && unit.servo.in_position()) {
                // The voltage is 0 at once, without a ramp [000:5352]. An axis that stands is held in its
                // loop (inferred).
                unit.halted = true;
                unit.stand(unit.nominal);
            } else if unit.halted && enabled {
                // The lag that was left is driven out on a path; by hand the axis stands where it stopped.
                unit.halted = false;
                if unit.mover != Mover::Path {
                    unit.transfer();
                }
            }
            unit.enabled = enabled;
            unit.servo.set_enabled(!unit.halted);
            let suppressed = MONITORING_OFF
                .get(unit.index)
                .is_some_and(|marker| nc.bit(*marker));
            unit.servo.set_monitored(!(suppressed || monitoring_off));
        }
        if all_open {
            self.part_thread();
            self.spindle.open();
            self.stop_run();
        }
    }

    /// W522 bit 0 lets the input MP4130, sampled in each control cycle, switch the monitoring off
    /// [000:5178-5188].
    fn monitoring_is_off(&mut self) -> bool {
        let permitted = self.exchange.nc().number(signal::MONITORING_SUPPRESSION) & 1 != 0;
        let Some(input) = self.plc_parameters.monitoring_input.filter(|_| permitted) else {
            return false;
        };
        self.measured
            .inputs
            .get(usize::from(input.input))
            .is_some_and(|high| *high == input.active_high)
    }

    /// Faults of the loops and of the spindle's encoder: message and machine stop [000:5162].
    pub(crate) fn take_faults(&mut self) {
        for place in 0..=self.axes.len() {
            let (index, fault) = match self.axes.get(place) {
                Some(unit) => (unit.index, unit.servo.fault()),
                None => (SPINDLE_INDEX, self.spindle.fault()),
            };
            let Some(fault) = fault else {
                continue;
            };
            let message = Message::axis(fault.message(), index, fault.letter());
            if self.messages.contains(&message) {
                continue;
            }
            self.show(message, !fault.cancellable());
            self.part_thread();
            self.stop_run();
            // An error with stop ends what the PLC positions [000:4013-4019].
            for index in 0..AXES {
                self.end_positioning(index);
            }
        }
    }

    /// NC stop is given by the PLC, the circuit, a flashing message or a fault of an axis.
    pub(crate) fn stop_given(&self) -> bool {
        self.panel.stop
            || self.stylus.stops
            || self.exchange.nc().bit(signal::NC_STOP_AND_OPEN_LOOPS)
            || self.emergency.circuit() != Circuit::Ready
            || self.messages.is_fatal()
            || self.axes.iter().any(|unit| unit.servo.fault().is_some())
    }
}
