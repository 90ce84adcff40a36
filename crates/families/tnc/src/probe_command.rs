//! What the operator asks of the touch probe in MANUAL and HANDWHEEL: the functions of the TOUCH PROBE menu.

use std::fmt;

use bahn_path::{Axis, Direction};

/// An input of the TOUCH PROBE menu [003:1226-1405]; in commands it stands after `probe`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProbeCommand {
    /// A function of the menu is chosen: `length`, `radius`, `rotation`, `surface`, `corner`, `circle`.
    Choose(ProbeFunction),
    /// `direction X+`: what the next NC start probes.
    Direction(Axis, Direction),
    /// `direction all`: the next NC start probes in all four directions of the plane, from within.
    AllDirections,
    /// `turn`: the probe is turned by 180° for the centre offset [000:7654].
    Turn,
    /// `datum X 5`: the coordinate of what was probed becomes this value, mm.
    Datum(Axis, f64),
    /// `angle 0`: ROTATION ANGLE, degrees; it is the basic rotation, and the nominal angle of the side probed next.
    Angle(f64),
    /// `end`: leaves the function.
    End,
}

/// A function of the TOUCH PROBE menu [003:1226-1244].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProbeFunction {
    /// `length HEIGHT`: CALIBRATION EFFECTIVE LENGTH on a face at this height above the datum, mm.
    Length(f64),
    /// `radius R`: CALIBRATION EFFECTIVE RADIUS in a ring gauge of this radius, mm.
    Radius(f64),
    /// `rotation`: BASIC ROTATION over two points of a side.
    Rotation,
    /// `surface`: SURFACE = DATUM.
    Surface,
    /// `corner`: CORNER = DATUM over two points of each side; `corner reuse` takes over the side of the last basic
    /// rotation.
    Corner {
        /// The points of the basic rotation are the first side.
        reuse: bool,
    },
    /// `circle`: CIRCLE CENTER = DATUM.
    Circle,
}

/// Largest gauge, mm, and largest coordinate, mm.
const GAUGE_MAX: f64 = 99_999.0;

impl ProbeCommand {
    /// Reads what stands after `probe`.
    ///
    /// # Errors
    /// What is expected.
    pub fn parse(text: &str) -> Result<ProbeCommand, String> {
        let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        let value = |text: &str, max: f64| {
            let value = text.trim().parse::<f64>().ok();
            value
                .filter(|value| value.abs() <= max)
                .ok_or_else(|| format!("`probe {name}` takes a value up to {max}, not `{text}`"))
        };
        let choose = |function| match rest {
            "" => Ok(ProbeCommand::Choose(function)),
            _ => Err(format!("`probe {name}` takes nothing after it, not `{rest}`")),
        };
        match name {
            "length" => {
                value(rest, GAUGE_MAX).map(|height| ProbeCommand::Choose(ProbeFunction::Length(height)))
            }
            "radius" => match value(rest, GAUGE_MAX)? {
                radius if radius > 0.0 => Ok(ProbeCommand::Choose(ProbeFunction::Radius(radius))),
                _ => Err("the radius of the ring gauge is greater than 0".to_owned()),
            },
            "rotation" => choose(ProbeFunction::Rotation),
            "surface" => choose(ProbeFunction::Surface),
            "corner" if rest == "reuse" => Ok(ProbeCommand::Choose(ProbeFunction::Corner { reuse: true })),
            "corner" => choose(ProbeFunction::Corner { reuse: false }),
            "circle" => choose(ProbeFunction::Circle),
            "direction" if rest == "all" => Ok(ProbeCommand::AllDirections),
            "direction" => direction(rest)
                .map(|(axis, direction)| ProbeCommand::Direction(axis, direction))
                .ok_or_else(|| format!("`probe direction` takes X+, Y-, .. or all, not `{rest}`")),
            "turn" if rest.is_empty() => Ok(ProbeCommand::Turn),
            "end" if rest.is_empty() => Ok(ProbeCommand::End),
            "datum" => {
                let (letter, number) = rest.split_at_checked(1).unwrap_or((rest, ""));
                let axis =
                    axis(letter).ok_or("`probe datum` takes an axis and a value, as `probe datum X 5`")?;
                value(number, GAUGE_MAX).map(|value| ProbeCommand::Datum(axis, value))
            }
            "angle" => value(rest, 360.0).map(ProbeCommand::Angle),
            _ => Err(format!(
                "`probe` takes length, radius, rotation, surface, corner, circle, direction, turn, datum, angle or \
                 end, not `{name}`"
            )),
        }
    }
}

fn axis(letter: &str) -> Option<Axis> {
    let [letter] = letter.as_bytes() else { return None };
    Axis::from_letter(letter.to_ascii_uppercase())
}

/// Axis and direction of `X+` or `X-`.
fn direction(text: &str) -> Option<(Axis, Direction)> {
    Direction::BOTH.into_iter().find_map(|direction| {
        let letter = text.strip_suffix(direction.symbol())?;
        Some((axis(letter)?, direction))
    })
}

impl fmt::Display for ProbeCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProbeCommand::Choose(function) => function.fmt(f),
            ProbeCommand::Direction(axis, direction) => write!(f, "direction {axis}{direction}"),
            ProbeCommand::AllDirections => f.write_str("direction all"),
            ProbeCommand::Turn => f.write_str("turn"),
            ProbeCommand::Datum(axis, value) => write!(f, "datum {axis} {value}"),
            ProbeCommand::Angle(angle) => write!(f, "angle {angle}"),
            ProbeCommand::End => f.write_str("end"),
        }
    }
}

impl fmt::Display for ProbeFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProbeFunction::Length(height) => write!(f, "length {height}"),
            ProbeFunction::Radius(radius) => write!(f, "radius {radius}"),
            ProbeFunction::Rotation => f.write_str("rotation"),
            ProbeFunction::Surface => f.write_str("surface"),
            ProbeFunction::Corner { reuse: false } => f.write_str("corner"),
            ProbeFunction::Corner { reuse: true } => f.write_str("corner reuse"),
            ProbeFunction::Circle => f.write_str("circle"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_read_as_they_are_written() {
        for text in [
            "length 40",
            "radius 25.0025",
            "rotation",
            "surface",
            "corner",
            "corner reuse",
            "circle",
            "direction X-",
            "direction all",
            "turn",
            "datum Y -12.5",
            "angle 0",
            "end",
        ] {
            let command = ProbeCommand::parse(text);
            assert_eq!(command.map(|command| command.to_string()), Ok(text.to_owned()));
        }
    }

    #[test]
    fn faults_say_what_is_expected() {
        for (text, expected) in [
            ("", "length, radius"),
            ("radius 0", "greater than 0"),
            ("radius", "takes a value"),
            ("corner again", "nothing after it"),
            ("direction X", "X+, Y-"),
            ("datum 5", "`probe datum X 5`"),
            ("angle 400", "up to 360"),
        ] {
            let error = ProbeCommand::parse(text);
            assert!(
                error.as_ref().is_err_and(|error| error.contains(expected)),
                "{text}: {error:?}"
            );
        }
    }
}
