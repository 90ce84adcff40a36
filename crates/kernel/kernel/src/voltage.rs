//! Output S for lasers and water jets: M200 to M204 set its voltage, synchronously with the path [000:9841-9909].
//!
//! Decision: The voltage of M200 to M204 stays after the end of a program; EMERGENCY STOP takes it away

use bahn_path::{Characteristic, Voltage};

/// Where the path is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Count of executed blocks: that of the element that is executed.
    pub sequence: u64,
    /// How much of it is covered, 0 to 1.
    pub part: f64,
    /// Speed along the path, mm/min.
    pub mm_min: f64,
}

/// What the output gives, and how it goes on.
#[derive(Clone, Copy, Debug, Default)]
pub struct VoltageOutput {
    volts: f64,
    course: Course,
}

#[derive(Clone, Copy, Debug, Default)]
enum Course {
    #[default]
    Stays,
    /// Linear along the block with this sequence.
    Along { sequence: u64, from: f64, to: f64 },
    /// As the characteristic gives it for the speed of the path.
    ByVelocity(Characteristic),
    /// Linear in time, so much of it to go.
    Ramp { to: f64, left_s: f64 },
    /// 0 V when so much time is over.
    Pulse { left_s: f64 },
}

impl VoltageOutput {
    /// Voltage at the output now, V.
    pub fn volts(&self) -> f64 {
        self.volts
    }

    /// The block with a sequence gives another order.
    pub fn order(&mut self, order: Voltage, sequence: u64) {
        let from = self.volts;
        self.course = match order {
            Voltage::Along(to) => Course::Along { sequence, from, to },
            Voltage::ByVelocity(characteristic) => Course::ByVelocity(characteristic),
            Voltage::Ramp { volts, time_s } => Course::Ramp {
                to: volts,
                left_s: time_s,
            },
            Voltage::Fixed(volts) => {
                self.volts = volts;
                Course::Stays
            }
            Voltage::Pulse { volts, time_s } => {
                self.volts = volts;
                Course::Pulse { left_s: time_s }
            }
        };
    }

    /// No voltage: EMERGENCY STOP (inferred).
    pub fn switch_off(&mut self) {
        *self = VoltageOutput::default();
    }

    /// A contour cycle is over.
    pub fn cycle(&mut self, along: Along, cycle_s: f64) {
        match self.course {
            Course::Stays => {}
            Course::Along { sequence, from, to } => {
                let part = if sequence == along.sequence {
                    along.part
                } else {
                    1.0
                };
                self.settle(from + (to - from) * part, part >= 1.0);
            }
            Course::ByVelocity(characteristic) => self.volts = characteristic.volts(along.mm_min),
            Course::Ramp { to, left_s } => {
                let over = left_s <= cycle_s;
                let step = if over { 1.0 } else { cycle_s / left_s };
                self.course = Course::Ramp {
                    to,
                    left_s: left_s - cycle_s,
                };
                self.settle(self.volts + (to - self.volts) * step, over);
            }
            Course::Pulse { left_s } if left_s <= cycle_s => self.settle(0.0, true),
            Course::Pulse { left_s } => {
                self.course = Course::Pulse {
                    left_s: left_s - cycle_s,
                };
            }
        }
    }

    fn settle(&mut self, volts: f64, over: bool) {
        self.volts = volts;
        if over {
            self.course = Course::Stays;
        }
    }
}
