//! What the oscilloscope sees of the axes in every servo step [000:18638-18660].

use std::fmt;
use std::str::FromStr;

use crate::axes::Axes;

/// A curve of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoSignal {
    /// `v-actual`: V ACTUAL, feed of the position encoder over the last contour cycle, mm/min.
    ActualFeed,
    /// `v-nominal`: V NOMINAL, feed of the nominal position, mm/min.
    NominalFeed,
    /// `s-actual`: S ACTUAL, mm in machine coordinates.
    ActualPosition,
    /// `s-nominal`: S NOMINAL, mm in machine coordinates.
    NominalPosition,
    /// `diff`: D DIFF, trailing error of the position loop, mm.
    Lag,
    /// `n-actual`: N ACTUAL, speed by the motor's encoder, mm/min.
    ActualSpeed,
    /// `n-nominal`: N NOMINAL, what the digital speed controller is asked for, mm/min.
    NominalSpeed,
    /// `n-int`: N INT, difference of both in the speed controller, mm/min.
    SpeedDifference,
    /// `u`: U ANALOGUE, mV.
    Voltage,
}

/// The signals with name and unit, in the order of the manual's table.
const SIGNALS: [(ServoSignal, &str, &str); 9] = [
    (ServoSignal::ActualFeed, "v-actual", "mm/min"),
    (ServoSignal::NominalFeed, "v-nominal", "mm/min"),
    (ServoSignal::ActualPosition, "s-actual", "mm"),
    (ServoSignal::NominalPosition, "s-nominal", "mm"),
    (ServoSignal::Lag, "diff", "mm"),
    (ServoSignal::ActualSpeed, "n-actual", "mm/min"),
    (ServoSignal::NominalSpeed, "n-nominal", "mm/min"),
    (ServoSignal::SpeedDifference, "n-int", "mm/min"),
    (ServoSignal::Voltage, "u", "mV"),
];

impl ServoSignal {
    fn row(self) -> (&'static str, &'static str) {
        let row = SIGNALS.iter().find(|(signal, ..)| *signal == self);
        row.map_or(("", ""), |(_, name, unit)| (name, unit))
    }

    /// All signals, in the order of the manual's table.
    pub fn all() -> impl Iterator<Item = ServoSignal> {
        SIGNALS.into_iter().map(|(signal, ..)| signal)
    }

    /// Unit of its values.
    pub fn unit(self) -> &'static str {
        self.row().1
    }

    /// It is one of the digital speed controller, which other axes do not have.
    pub fn is_digital(self) -> bool {
        matches!(
            self,
            ServoSignal::ActualSpeed | ServoSignal::NominalSpeed | ServoSignal::SpeedDifference
        )
    }
}

impl fmt::Display for ServoSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.row().0)
    }
}

impl FromStr for ServoSignal {
    type Err = String;

    fn from_str(text: &str) -> Result<ServoSignal, String> {
        let found = SIGNALS.iter().find(|(_, name, _)| *name == text);
        found.map(|(signal, ..)| *signal).ok_or_else(|| {
            let names: Vec<&str> = SIGNALS.iter().map(|(_, name, _)| *name).collect();
            format!(
                "`{text}` is no curve of the oscilloscope; there are {}",
                names.join(", ")
            )
        })
    }
}

/// Who looks at the axes in every servo step; it changes nothing.
pub trait ServoSampler {
    /// A servo step has given its outputs, at a time in µs.
    fn sample(&mut self, time_us: u64, axes: &ServoView<'_>);
}

/// The axes of the machine in a servo step.
pub struct ServoView<'a>(pub &'a Axes);

impl ServoView<'_> {
    /// A value of the first axis of a letter; 0 where there is none.
    pub fn value(&self, letter: char, signal: ServoSignal) -> f64 {
        let unit = self.0.iter().find(|unit| unit.axis.letter() == letter);
        unit.map_or(0.0, |unit| {
            let servo = &unit.servo;
            let speed = servo.speed().unwrap_or_default();
            match signal {
                ServoSignal::ActualFeed => servo.actual_velocity_mm_min(),
                ServoSignal::NominalFeed => servo.profile_mm_min(),
                ServoSignal::ActualPosition => servo.actual_mm(),
                ServoSignal::NominalPosition => servo.nominal_mm(),
                ServoSignal::Lag => servo.lag_mm(),
                ServoSignal::ActualSpeed => speed.actual_mm_min,
                ServoSignal::NominalSpeed => speed.nominal_mm_min,
                ServoSignal::SpeedDifference => speed.difference_mm_min,
                ServoSignal::Voltage => servo.volts() * 1e3,
            }
        })
    }

    /// Whether the control closes the speed loop of the axis of a letter.
    pub fn is_digital(&self, letter: char) -> bool {
        let mut units = self.0.iter().filter(|unit| unit.axis.letter() == letter);
        units.any(|unit| unit.servo.is_digital())
    }
}
