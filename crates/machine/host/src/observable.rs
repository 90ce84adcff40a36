//! What can be looked at of a machine that is switched on: signals of the control, and what only the plant knows.

use std::fmt;
use std::str::FromStr;

use bahn_parameters::ControlModel;
use bahn_tnc::{AxisSignal, ChannelView, Control, Signal, SignalError, split_channel};

use crate::of_module::of_module;
use crate::operable::Operable;

/// What only the plant knows of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// `table`: where its table stands, mm or degrees from the zero point of the plant.
    Table,
    /// `force`: force of its motor, N or Nm.
    Force,
}

const TRUTHS: [(&str, Truth); 2] = [("table", Truth::Table), ("force", Truth::Force)];

/// What only the plant knows of its tool magazine; 0 is no tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MagazineTruth {
    /// `magazine.pocket`: the pocket that is nearest to the change position.
    Pocket,
    /// `magazine.shuttle`: the tool in the shuttle.
    Shuttle,
    /// `magazine.gripper`: the tool in the gripper at the side of the shuttle.
    Gripper,
    /// `magazine.gripper2`: the tool in the gripper at the side of the spindle.
    SpindleGripper,
    /// `magazine.spindle`: the tool in the spindle.
    Spindle,
    /// `magazine.angle`: how far the arm has turned, degrees.
    Angle,
}

const MAGAZINE: [(&str, MagazineTruth); 6] = [
    ("magazine.pocket", MagazineTruth::Pocket),
    ("magazine.shuttle", MagazineTruth::Shuttle),
    ("magazine.gripper", MagazineTruth::Gripper),
    ("magazine.gripper2", MagazineTruth::SpindleGripper),
    ("magazine.spindle", MagazineTruth::Spindle),
    ("magazine.angle", MagazineTruth::Angle),
];

impl MagazineTruth {
    fn value(self, plant: &dyn Operable) -> f64 {
        let Some(magazine) = plant.magazine() else {
            return 0.0;
        };
        match self {
            MagazineTruth::Pocket => magazine.pocket as f64,
            MagazineTruth::Shuttle => f64::from(magazine.shuttle),
            MagazineTruth::Gripper => f64::from(magazine.arm[0]),
            MagazineTruth::SpindleGripper => f64::from(magazine.arm[1]),
            MagazineTruth::Spindle => f64::from(magazine.spindle),
            MagazineTruth::Angle => magazine.arm_deg,
        }
    }
}

/// Something with a value in every cycle: `X.lag`, `M2045`, `X.table`.
///
/// ```
/// use bahn_host::Observable;
/// assert_eq!("X.table".parse::<Observable>()?.to_string(), "X.table");
/// assert_eq!("W260".parse::<Observable>()?.to_string(), "W260");
/// # Ok::<(), bahn_tnc::SignalError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observable {
    /// What the control knows.
    Signal(Signal),
    /// What the plant knows of the axis of a letter.
    Truth(char, Truth),
    /// What the plant knows of its magazine; without one 0.
    Magazine(MagazineTruth),
}

impl FromStr for Observable {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<Observable, SignalError> {
        let text = text.trim();
        if let Some((_, truth)) = MAGAZINE.iter().find(|(known, _)| *known == text) {
            return Ok(Observable::Magazine(*truth));
        }
        if let Some((axis, name)) = text.split_once('.')
            && let Some((_, truth)) = TRUTHS.iter().find(|(known, _)| *known == name)
            && let Ok(Signal::Axis(letter, _)) = format!("{axis}.actual").parse()
        {
            return Ok(Observable::Truth(letter, *truth));
        }
        text.parse().map(Observable::Signal)
    }
}

impl fmt::Display for Observable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Observable::Signal(signal) => signal.fmt(f),
            Observable::Magazine(truth) => {
                let name = MAGAZINE.iter().find(|(_, of)| of == truth);
                f.write_str(name.map_or("", |(name, _)| name))
            }
            Observable::Truth(letter, truth) => {
                let name = TRUTHS.iter().find(|(_, of)| of == truth);
                write!(f, "{letter}.{}", name.map_or("", |(name, _)| name))
            }
        }
    }
}

impl Observable {
    /// Its value now, of a channel; an axis that is not there reads 0.
    pub fn value(&self, channel: ChannelView, plant: &dyn Operable) -> f64 {
        match self {
            Observable::Signal(signal) => channel.observe(signal),
            Observable::Magazine(truth) => truth.value(plant),
            Observable::Truth(letter, truth) => plant.true_axis(*letter).map_or(0.0, |axis| match truth {
                Truth::Table => axis.position,
                Truth::Force => axis.force,
            }),
        }
    }

    /// The letter of its axis.
    pub fn axis(&self) -> Option<char> {
        match self {
            Observable::Signal(Signal::Axis(letter, _)) | Observable::Truth(letter, _) => Some(*letter),
            Observable::Signal(_) | Observable::Magazine(_) => None,
        }
    }

    /// Unit of its values; empty for numbers without one. Rotary axes have degrees.
    pub fn unit(&self) -> &'static str {
        let unit = match self {
            Observable::Signal(signal) => signal.unit(),
            Observable::Magazine(MagazineTruth::Angle) => "degrees",
            Observable::Magazine(_) => "",
            Observable::Truth(_, Truth::Table) => "mm",
            Observable::Truth(_, Truth::Force) => "N",
        };
        let rotary = matches!(self.axis(), Some('A' | 'B' | 'C'));
        match unit {
            "mm" if rotary => "deg",
            "mm/min" if rotary => "deg/min",
            "N" if rotary => "Nm",
            "degrees" => "deg",
            unit => unit,
        }
    }

    /// A value with as many decimals as it is good for.
    pub fn decimals(&self, value: f64) -> Decimals {
        let places = match self {
            Observable::Magazine(MagazineTruth::Angle) => 1,
            Observable::Magazine(_) => 0,
            Observable::Truth(_, Truth::Table) => 5,
            Observable::Truth(_, Truth::Force) => 1,
            Observable::Signal(signal) => match signal {
                Signal::Axis(_, AxisSignal::Volts)
                | Signal::SpindleVolts
                | Signal::SpindleAngle
                | Signal::Output(_) => 4,
                Signal::Axis(_, signal) if signal.is_speed() => 3,
                Signal::PathSpeed | Signal::SpindleRpm => 3,
                Signal::Axis(..) | Signal::PathDistance | Signal::Probe(_) => 5,
                Signal::Q(_) => 6,
                _ => 0,
            },
        };
        Decimals { value, places }
    }
}

/// Something of a channel: `X.actual` and `1:X.actual` of the first one, `2:X.actual` of the second. What only the plant
/// knows is of no channel.
///
/// ```
/// use bahn_host::Observed;
/// let second: Observed = "2:X.lag".parse()?;
/// assert_eq!((second.channel, second.to_string().as_str()), (1, "2:X.lag"));
/// assert_eq!("1:M2045".parse::<Observed>()?.to_string(), "M2045");
/// # Ok::<(), bahn_tnc::SignalError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Observed {
    /// It is of the positioning module beside the machine: `module:X.actual`.
    pub module: bool,
    /// Which channel, from 0.
    pub channel: usize,
    /// What of it; operands of the PLC are those of its window.
    pub what: Observable,
}

impl FromStr for Observed {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<Observed, SignalError> {
        if let Some(of_it) = of_module(text) {
            let of_it: Observed = of_it.parse()?;
            return match of_it.module {
                true => Err(SignalError::of(text)),
                false => Ok(Observed {
                    module: true,
                    ..of_it
                }),
            };
        }
        let (channel, of_it) = split_channel(text);
        let what = of_it.parse()?;
        match (channel, what) {
            // That is no signal of a channel.
            (Some(_), Observable::Truth(..) | Observable::Magazine(_)) => Err(SignalError::of(text)),
            (channel, what) => Ok(Observed {
                module: false,
                channel: channel.unwrap_or(0),
                what,
            }),
        }
    }
}

impl fmt::Display for Observed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.module {
            write!(f, "module:")?;
        }
        if self.channel > 0 {
            write!(f, "{}:", self.channel + 1)?;
        }
        self.what.fmt(f)
    }
}

impl Observed {
    /// Its name in the words of a control, which the TNC 151/155 has of its own for inputs and outputs [001:477-482].
    pub fn name(&self, model: ControlModel) -> String {
        let old = model.limits().has_old_numbers();
        match &self.what {
            Observable::Signal(signal) if self.channel == 0 && !self.module => signal.name(old),
            _ => self.to_string(),
        }
    }

    /// Its value now; of a channel or an axis that is not there 0.
    pub fn value(&self, control: &Control, plant: &dyn Operable) -> f64 {
        let channel = control.channel(self.channel);
        channel.map_or(0.0, |channel| self.what.value(channel, plant))
    }
}

/// A number with its decimals, never -0.
#[derive(Clone, Copy, Debug)]
pub struct Decimals {
    value: f64,
    places: usize,
}

impl fmt::Display for Decimals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scale = 10f64.powi(i32::try_from(self.places).unwrap_or(0));
        let rounded = (self.value * scale).round() / scale + 0.0;
        write!(f, "{rounded:.*}", self.places)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;

    #[test]
    fn values_have_the_unit_and_the_decimals_of_what_they_are() {
        let text = |name: &str, number: f64| {
            let observable: Observable = name.parse().unwrap();
            format!("{} {}", observable.decimals(number), observable.unit())
        };
        assert_eq!(text("X.lag", -0.000001), "0.00000 mm");
        assert_eq!(text("X.volts", 9.12345), "9.1235 V");
        assert_eq!(text("M2045", 1.0), "1 ");
        assert_eq!(text("C.speed", 5.0), "5.000 deg/min");
        assert_eq!(text("C.force", 5.0), "5.0 Nm");
        assert_eq!(text("X.table", 5.0), "5.00000 mm");
        assert_eq!(text("magazine.angle", 90.04), "90.0 deg");
        assert_eq!(text("magazine.gripper2", 3.0), "3 ");
        assert!("magazine.table".parse::<Observable>().is_err());
        assert!("Q.table".parse::<Observable>().is_err() && "M.table".parse::<Observable>().is_err());
        assert!("X.table".parse::<Observed>().is_ok() && "2:X.table".parse::<Observed>().is_err());
    }
}
