//! The 3D ROT menu: the tilted working plane for manual operation and for program run, each for itself, with the positions
//! of the swivel axes [000:4256].

use std::fmt;

use bahn_kernel::OwnAxes;
use bahn_path::{Axis, Position, Swivels};

/// The axes that may swivel, in the order of [`PlaneCommand::angles`].
pub(crate) const ROTARY: [Axis; 3] = [Axis::A, Axis::B, Axis::C];

/// `3d-rot on`, `3d-rot on B+30`, `3d-rot off`, the same for program run after `run`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneCommand {
    /// It is for program run, not for manual operation.
    pub run: bool,
    /// The plane is on, with machine positions of A, B and C in degrees; a swivel axis of which none is said counts where it
    /// stands. `None`: off.
    pub angles: Option<[Option<f64>; 3]>,
}

impl PlaneCommand {
    /// The positions of the swivel axes in the plane, `Some(None)` when it is off; `None` where an angle is said of an axis
    /// that does not swivel.
    pub(crate) fn positions(&self, swivels: &Swivels, axes: &OwnAxes) -> Option<Option<Position>> {
        let Some(angles) = self.angles else {
            return Some(None);
        };
        let mut positions = Position::ZERO;
        for axis in swivels.free_axes() {
            positions[axis] = axes.at(axis).map_or(0.0, |unit| unit.nominal);
        }
        for (axis, angle) in ROTARY.into_iter().zip(angles) {
            let Some(angle) = angle else { continue };
            if !swivels.free_axes().any(|free| free == axis) {
                return None;
            }
            positions[axis] = angle;
        }
        Some(Some(positions))
    }

    /// What stands after `3d-rot`.
    pub(crate) fn parse(text: &str) -> Result<PlaneCommand, String> {
        let wrong = || {
            "`3d-rot` takes `on` or `off`, after `run` for program run; `on` takes angles: `on B+30`"
                .to_owned()
        };
        let mut words = text.split_whitespace().peekable();
        let run = words.next_if_eq(&"run").is_some();
        let angles = match words.next() {
            Some("off") => None,
            Some("on") => Some(angles(&mut words).ok_or_else(wrong)?),
            _ => return Err(wrong()),
        };
        match words.next() {
            None => Ok(PlaneCommand { run, angles }),
            Some(_) => Err(wrong()),
        }
    }
}

/// `A+10 B-30`: each axis once.
fn angles<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<[Option<f64>; 3]> {
    /// Greatest angle that can be entered, degrees.
    const MAX: f64 = 99_999.999_9;
    let mut angles = [None; 3];
    for word in words {
        let mut letters = word.chars();
        let letter = letters.next()?;
        let place = ROTARY.iter().position(|axis| axis.letter() == letter)?;
        let value: f64 = letters.as_str().parse().ok()?;
        let own = angles.get_mut(place).filter(|own| own.is_none())?;
        *own = Some(value).filter(|value| value.abs() <= MAX);
        (*own)?;
    }
    Some(angles)
}

impl fmt::Display for PlaneCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of_run = if self.run { "run " } else { "" };
        let Some(angles) = self.angles else {
            return write!(f, "{of_run}off");
        };
        write!(f, "{of_run}on")?;
        for (axis, angle) in ROTARY.into_iter().zip(angles) {
            if let Some(angle) = angle {
                write!(f, " {}{angle:+}", axis.letter())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_plane() {
        for text in ["on", "off", "run on", "run off", "on B+30", "run on A-7.5 C+0"] {
            assert_eq!(
                PlaneCommand::parse(text).map(|command| command.to_string()),
                Ok(text.to_owned())
            );
        }
        for wrong in [
            "",
            "run",
            "of",
            "off B+30",
            "on X+3",
            "on B",
            "on B+30 B+40",
            "on B+100000",
            "on BNaN",
        ] {
            assert!(PlaneCommand::parse(wrong).is_err(), "{wrong}");
        }
    }
}
