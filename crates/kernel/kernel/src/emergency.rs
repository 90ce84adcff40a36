//! Power-on and the "control is ready" circuit: output X41/34 and its acknowledgement X42/4.
//!
//! At every power-on the control tests that its output switches the control voltage off: it waits for the
//! voltage, drops the output, and the acknowledgement must fall in time; then the output comes on again.
//! The TNC 415 and 425 have three processors that do so in turn, the others one [000:6175-6228].

use bahn_parameters::EmergencyStopTest;
use bahn_servo::{Measured, Step};

/// How finely the test times the acknowledgement, µs (inferred).
const LOOK_US: u32 = 1000;

/// What the circuit says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Circuit {
    /// `POWER INTERRUPTED` is shown; CE goes on [000:7033-7040].
    PowerInterrupted,
    /// `RELAY EXT. DC VOLTAGE MISSING`: waiting for the control voltage.
    VoltageMissing,
    /// The output is being tested.
    Testing,
    /// `EMERGENCY STOP DEFECTIVE`: the test of the output failed.
    Defective,
    /// The control voltage is on.
    Ready,
    /// `EXTERNAL EMERGENCY STOP`: the acknowledgement was lost.
    EmergencyStop,
    /// The acknowledgement is back; CE goes on.
    VoltageBack,
}

/// The circuit, step by step.
#[derive(Clone, Debug)]
pub struct EmergencyStop {
    test: EmergencyStopTest,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    PowerInterrupted,
    /// Waiting for the voltage before the test by a processor, or after the last one; it is said to be
    /// missing from a time on.
    Waiting {
        tested: u8,
        missing_from: Option<u64>,
        missing: bool,
    },
    /// The voltage is seen; the output drops at a time.
    Recognised {
        tested: u8,
        until: u64,
    },
    /// The output is off; the acknowledgement must fall before a time.
    Dropped {
        tested: u8,
        until: u64,
    },
    /// The acknowledgement fell; the output comes on at a time.
    Fallen {
        tested: u8,
        until: u64,
    },
    Defective,
    Ready,
    Lost,
    Back,
}

/// Waiting for the voltage from power-on.
const WAITING: State = State::Waiting {
    tested: 0,
    missing_from: None,
    missing: false,
};

impl EmergencyStop {
    /// The circuit at power-on, with the test of a control; `power_interrupted`: that is shown first.
    pub fn new(test: EmergencyStopTest, power_interrupted: bool) -> EmergencyStop {
        EmergencyStop {
            test,
            state: if power_interrupted {
                State::PowerInterrupted
            } else {
                WAITING
            },
        }
    }

    /// What the circuit says now.
    pub fn circuit(&self) -> Circuit {
        match self.state {
            State::PowerInterrupted => Circuit::PowerInterrupted,
            State::Waiting { missing: true, .. } => Circuit::VoltageMissing,
            State::Waiting { .. } => Circuit::Testing,
            State::Recognised { .. } | State::Dropped { .. } | State::Fallen { .. } => Circuit::Testing,
            State::Defective => Circuit::Defective,
            State::Ready => Circuit::Ready,
            State::Lost => Circuit::EmergencyStop,
            State::Back => Circuit::VoltageBack,
        }
    }

    /// The acknowledgement is timed.
    fn is_timing(&self) -> bool {
        matches!(self.state, State::Dropped { .. })
    }

    /// The output X41/34, control is ready: off, it opens the chain of EMERGENCY STOP.
    pub fn output(&self) -> bool {
        !matches!(
            self.state,
            State::Dropped { .. } | State::Fallen { .. } | State::Defective
        )
    }

    /// A servo step has passed: a timed acknowledgement counts as of the millisecond in which it fell.
    pub fn pass(&mut self, step: Step, before: bool, measured: &Measured) {
        if !self.is_timing() {
            return;
        }
        let changed_at = if before {
            measured.control_ready_changed_at
        } else {
            Some(0)
        };
        let (after_us, acknowledged) = match changed_at {
            Some(at) => {
                let looked_at = at.div_ceil(LOOK_US).max(1).saturating_mul(LOOK_US);
                (looked_at.min(step.length_us), false)
            }
            None => (step.length_us, measured.control_ready),
        };
        self.step(step.from_us + u64::from(after_us), acknowledged);
    }

    /// Goes on by a servo step with the acknowledgement X42/4.
    pub fn step(&mut self, now_us: u64, acknowledged: bool) {
        let test = &self.test;
        self.state = match self.state {
            State::Waiting { tested, .. } if acknowledged && tested >= test.times => State::Ready,
            State::Waiting { tested, .. } if acknowledged => State::Recognised {
                tested,
                until: now_us + test.recognise_us,
            },
            State::Waiting {
                tested, missing_from, ..
            } => {
                // The relay needs its time to come (inferred: as long as it may take to fall).
                let from = missing_from.unwrap_or(now_us + test.fall_us);
                State::Waiting {
                    tested,
                    missing_from: Some(from),
                    missing: now_us >= from,
                }
            }
            State::Recognised { tested, until } if now_us >= until => State::Dropped {
                tested,
                until: now_us + test.fall_us,
            },
            State::Dropped { tested, until } if !acknowledged && now_us <= until => State::Fallen {
                tested,
                until: now_us + test.restore_us,
            },
            State::Dropped { until, .. } if now_us > until => State::Defective,
            State::Fallen { tested, until } if now_us >= until => State::Waiting {
                tested: tested + 1,
                missing_from: None,
                missing: false,
            },
            State::Ready if !acknowledged => State::Lost,
            State::Lost if acknowledged => State::Back,
            State::Back if !acknowledged => State::Lost,
            state => state,
        };
    }

    /// CE: goes on after `POWER INTERRUPTED`, and after an EMERGENCY STOP when the voltage is back.
    pub fn clear(&mut self) -> bool {
        self.state = match self.state {
            State::PowerInterrupted => WAITING,
            State::Back => State::Ready,
            _ => return false,
        };
        true
    }

    /// An internal fault: the output goes off and stays off [000:6153].
    pub fn fail(&mut self) {
        self.state = State::Defective;
    }
}

#[cfg(test)]
mod tests {
    use bahn_parameters::ControlModel;

    use super::*;

    /// A relay that follows the output after a delay; the operator switches the voltage on at 1 s.
    fn power_on(model: ControlModel, relay_us: u64) -> (Circuit, u32) {
        let mut stop = EmergencyStop::new(model.limits().emergency_stop_test, false);
        let (mut relay, mut changed, mut falls) = (false, 0, 0);
        for step in 0..10_000u64 {
            let now = step * 600;
            let wanted = stop.output() && now >= 1_000_000;
            if wanted == relay {
                changed = now;
            } else if now - changed >= relay_us {
                relay = wanted;
                changed = now;
                falls += u32::from(!relay);
            }
            stop.step(now, relay);
        }
        (stop.circuit(), falls)
    }

    /// X42/4 falling after 113 ms passes on the TNC 415, 115 ms gives EMERGENCY STOP DEFECTIVE; on the TNC
    /// 407 it is 145 and 147 ms [000:6177-6228]; on the TNC 155 199 and 201 ms, twice [001:929-932].
    #[test]
    fn the_circuit_must_answer_in_time() {
        use ControlModel::{Tnc155, Tnc407, Tnc415b};
        assert_eq!(
            power_on(Tnc415b, 113_000),
            (Circuit::Ready, 3),
            "each processor tests once"
        );
        assert_eq!(power_on(Tnc415b, 115_000).0, Circuit::Defective);
        assert_eq!(power_on(Tnc407, 145_000), (Circuit::Ready, 1));
        assert_eq!(power_on(Tnc407, 147_000).0, Circuit::Defective);
        assert_eq!(power_on(Tnc155, 199_000), (Circuit::Ready, 2));
        assert_eq!(power_on(Tnc155, 201_000).0, Circuit::Defective);
    }

    /// In a servo step of 6 ms the fall counts as of its millisecond: the test may last until 2 ms in the step.
    #[test]
    fn the_fall_is_timed_within_a_step() {
        let step = Step {
            from_us: 60_000,
            length_us: 6000,
        };
        let until = step.from_us + 2000;
        for (at, fallen_us) in [
            (1, Some(1000)),
            (1000, Some(1000)),
            (1001, Some(2000)),
            (2001, None),
            (5999, None),
        ] {
            let mut stop = EmergencyStop::new(ControlModel::Tnc155.limits().emergency_stop_test, false);
            stop.state = State::Dropped { tested: 0, until };
            let measured = Measured {
                control_ready_changed_at: Some(at),
                ..Measured::default()
            };
            stop.pass(step, true, &measured);
            let expected = fallen_us.map_or(State::Defective, |us| State::Fallen {
                tested: 0,
                until: step.from_us + us + stop.test.restore_us,
            });
            assert_eq!(stop.state, expected, "{at} us");
        }
        let mut stop = EmergencyStop::new(ControlModel::Tnc155.limits().emergency_stop_test, false);
        stop.state = State::Dropped { tested: 0, until };
        let held = Measured {
            control_ready: true,
            ..Measured::default()
        };
        stop.pass(step, true, &held);
        assert_eq!(stop.state, State::Defective, "it never fell");
    }

    #[test]
    fn the_voltage_must_come_back_before_ce() {
        let mut stop = EmergencyStop::new(ControlModel::Tnc407.limits().emergency_stop_test, true);
        stop.step(0, true);
        assert_eq!(stop.circuit(), Circuit::PowerInterrupted, "waits for CE");
        assert!(stop.clear());
        stop.state = State::Ready;
        stop.step(0, false);
        assert_eq!(stop.circuit(), Circuit::EmergencyStop);
        assert!(!stop.clear(), "not before the voltage is back");
        assert!(stop.output(), "the output stays on: the fault is outside");
        stop.step(0, true);
        assert!(stop.clear());
        assert_eq!(stop.circuit(), Circuit::Ready);
    }
}
