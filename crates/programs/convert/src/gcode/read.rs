//! Reads what [`super::write`] writes: as much of RS-274/NGC as that, for the proof.

use bahn_path::{Arc, Axis, Curve, FeedRate, Plane, Position, SpindleOrder, Switch};

use super::back::elsewhere;
use super::line::Said;
use super::text::{turns, turns_only};

/// Reads a text line by line.
pub(super) struct Reader<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    line: u32,
    text: &'a str,
    unit_mm: f64,
    at: Position,
    plane: Plane,
    motion: Option<&'static str>,
    feed: f64,
    /// The message of a stop.
    message: Option<String>,
}

/// The words of a line that are no axes.
#[derive(Default)]
struct Words {
    motion: Option<&'static str>,
    end: Option<Position>,
    /// I, J and K of an arc: its centre from the start, in units of the program.
    centre: [Option<f64>; 3],
    k: Option<f64>,
    p: Option<f64>,
    r: Option<f64>,
    said: Option<Said>,
}

const MOTIONS: [&str; 6] = ["G0", "G1", "G2", "G3", "G33", "G33.1"];
/// Words that say nothing of the run.
const FRAME: [&str; 8] = ["G90", "G94", "G40", "G49", "G80", "G61", "G43", "G21"];

impl<'a> Reader<'a> {
    pub fn new(text: &'a str) -> Reader<'a> {
        Reader {
            lines: text.lines().enumerate(),
            line: 0,
            text: "",
            unit_mm: 1.0,
            at: Position::UNKNOWN,
            plane: Plane::XY,
            motion: None,
            feed: 0.0,
            message: None,
        }
    }

    /// The number of the line that was read last.
    pub fn line(&self) -> u32 {
        self.line
    }

    /// The text of the line that was read last.
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// What the next line says that says something.
    pub fn next(&mut self) -> Result<Option<Said>, String> {
        while let Some((index, line)) = self.lines.next() {
            self.line = index as u32 + 1;
            self.text = line;
            if let Some(comment) = line.trim().strip_prefix('(') {
                let comment = comment.split(')').next().unwrap_or_default();
                match comment.split_once(',') {
                    Some(("MSG", text)) => self.message = Some(text.to_owned()),
                    Some(("PRINT", text)) => return Ok(Some(Said::Print(text.to_owned()))),
                    _ => {}
                }
                continue;
            }
            let code = line.split(';').next().unwrap_or_default();
            let mut words = Words::default();
            for word in code.split_whitespace() {
                read_word(
                    word,
                    &mut words,
                    &mut self.unit_mm,
                    &mut self.plane,
                    &mut self.feed,
                    &self.at,
                )
                .ok_or_else(|| format!("no line has the word {word} here"))?;
            }
            if let Some(said) = self.said(words)? {
                if said.may_move_the_machine() {
                    self.at = elsewhere(&self.at);
                }
                return Ok(Some(said));
            }
        }
        Ok(None)
    }

    fn said(&mut self, words: Words) -> Result<Option<Said>, String> {
        if let Some(motion) = words.motion {
            self.motion = Some(motion);
        }
        if let Some(said) = words.said {
            return Ok(Some(match said {
                Said::Dwell(_) => Said::Dwell(words.p.ok_or("a dwell has no time")?),
                Said::Orient(_) => Said::Orient(words.r.ok_or("M19 has no angle")?),
                Said::Stop { optional: false } if self.message.is_some() => {
                    Said::Refused(self.message.take().unwrap_or_default())
                }
                other => other,
            }));
        }
        let Some(end) = words.end else {
            return Ok(None);
        };
        let mut start = self.at;
        // An axis that gets its first position has it at the end only.
        std::mem::swap(&mut start, &mut self.at);
        self.at = end;
        let feed = FeedRate::Programmed(match turns_only(&start, &end) {
            true => self.feed,
            false => self.feed * self.unit_mm,
        });
        let (curve, feed) = match self.motion {
            Some("G0") => (Curve::Line, FeedRate::Rapid),
            Some("G1") => (Curve::Line, feed),
            Some(arc @ ("G2" | "G3")) => (self.arc(arc, &start, &end, &words)?, feed),
            Some(thread @ ("G33" | "G33.1")) => {
                self.motion = None;
                let returns = thread == "G33.1";
                if returns {
                    self.at = start;
                }
                return Ok(Some(Said::Thread {
                    start,
                    end,
                    pitch_mm: words.k.ok_or("a thread has no pitch")? * self.unit_mm,
                    returns,
                }));
            }
            _ => return Err("no motion is in force".to_owned()),
        };
        Ok(Some(Said::Move {
            curve,
            start,
            end,
            feed,
        }))
    }

    fn arc(&self, motion: &str, start: &Position, end: &Position, words: &Words) -> Result<Curve, String> {
        let from = self.plane.point(start);
        let axes = [self.plane.first, self.plane.second];
        let mut centre = from;
        for (axis, centre) in axes.into_iter().zip(&mut centre) {
            let offset = words.centre.get(axis.index()).copied().flatten();
            *centre += offset.ok_or("an arc has no centre")? * self.unit_mm;
        }
        let to = self.plane.point(end);
        let angle = |point: [f64; 2]| (point[1] - centre[1]).atan2(point[0] - centre[0]).to_degrees();
        let count = words.p.unwrap_or(1.0);
        let mut sweep = (angle(to) - angle(from)).rem_euclid(360.0);
        if motion == "G2" {
            sweep = if sweep == 0.0 { 0.0 } else { 360.0 - sweep };
        }
        // Where it ends as it began it goes all the way round.
        if from == to || sweep == 0.0 {
            sweep = 360.0;
        }
        sweep += 360.0 * (count - 1.0);
        if turns(sweep) != count as u32 {
            return Err(format!("{sweep} degrees are no {count} turns"));
        }
        Ok(Curve::Arc(Arc {
            plane: self.plane,
            centre,
            sweep_deg: if motion == "G2" { -sweep } else { sweep },
        }))
    }
}

/// Takes one word; `None` for one that is not written here.
fn read_word(
    word: &str,
    words: &mut Words,
    unit_mm: &mut f64,
    plane: &mut Plane,
    feed: &mut f64,
    at: &Position,
) -> Option<()> {
    if let Some(motion) = MOTIONS.iter().find(|motion| **motion == word) {
        words.motion = Some(motion);
        return Some(());
    }
    if FRAME.contains(&word) {
        return Some(());
    }
    let said = |said| Some(Some(said));
    let function = match word {
        "G20" => {
            *unit_mm = 25.4;
            Some(None)
        }
        "G17" | "G18" | "G19" => {
            *plane = match word {
                "G17" => Plane::XY,
                "G18" => Plane::ZX,
                _ => Plane::YZ,
            };
            Some(None)
        }
        "G4" => said(Said::Dwell(0.0)),
        "M0" => said(Said::Stop { optional: false }),
        "M1" => said(Said::Stop { optional: true }),
        "M2" => said(Said::End),
        "M3" => said(Said::Spindle(SpindleOrder::Clockwise)),
        "M4" => said(Said::Spindle(SpindleOrder::CounterClockwise)),
        "M5" => said(Said::Spindle(SpindleOrder::Stop)),
        "M6" => said(Said::Change),
        "M8" => said(Said::Coolant(Switch::On)),
        "M9" => said(Said::Coolant(Switch::Off)),
        "M19" => said(Said::Orient(0.0)),
        "M48" => said(Said::Overrides(Switch::On)),
        "M49" => said(Said::Overrides(Switch::Off)),
        _ => None,
    };
    if let Some(said) = function {
        if said.is_some() {
            words.said = said;
        }
        return Some(());
    }
    let (letter, value) = word.split_at_checked(1)?;
    let value: f64 = value.parse().ok()?;
    match letter.as_bytes().first()? {
        b'F' => *feed = value,
        b'S' => words.said = Some(Said::Speed(value)),
        b'T' => words.said = Some(Said::Next(value as u32)),
        b'M' if (100.0..200.0).contains(&value) => words.said = Some(Said::User(value as u16)),
        b'P' => words.p = Some(value),
        b'R' => words.r = Some(value),
        letter @ b'I'..=b'K' => {
            if let Some(place) = words.centre.get_mut(usize::from(letter - b'I')) {
                *place = Some(value);
            }
            if *letter == b'K' {
                words.k = Some(value);
            }
        }
        letter => {
            let axis = Axis::from_letter(*letter)?;
            let unit = if axis.is_rotary() { 1.0 } else { *unit_mm };
            let end = words.end.get_or_insert(*at);
            end[axis] = value * unit;
        }
    }
    Some(())
}
