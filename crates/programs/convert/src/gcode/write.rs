//! The lines of a program for LinuxCNC.

use std::fmt::Write as _;

use bahn_path::{Arc, Axis, Curve, FeedRate, Position, SpindleOrder};
use bahn_program::Unit;

use super::back::elsewhere;
use super::line::Said;
use super::options::Options;
use super::said::{STEPS, Sayer, plane_word};
use super::text::{bare, turns, turns_only};

/// Most characters of a source block in a comment: a line of LinuxCNC has 255.
const COMMENT_MAX: usize = 100;

/// Writes what is said.
pub(super) struct Writer {
    text: String,
    lines: u32,
    unit_mm: f64,
    comments: bool,
    last_comment: String,
    at: Position,
    plane: Option<&'static str>,
    motion: &'static str,
    feed: Option<String>,
}

impl Writer {
    pub fn new(sayer: &Sayer, options: &Options) -> Writer {
        let mut writer = Writer {
            text: String::new(),
            lines: 0,
            unit_mm: options.unit.mm(),
            comments: options.comments,
            last_comment: String::new(),
            at: Position::UNKNOWN,
            plane: None,
            motion: "",
            feed: None,
        };
        let name = sayer.run().program(0).map_or("", |program| program.name());
        let name = bare(name.rsplit(std::path::MAIN_SEPARATOR).next().unwrap_or_default());
        let model = options.model.to_string().to_uppercase();
        for line in [
            format!("; the path of {name} as a {model} moves it, for LinuxCNC"),
            "; It is the path of the tool's tip, its radius compensated already: no G41 or G42.".to_owned(),
            "; After a tool change G43 takes the length from LinuxCNC's tool table.".to_owned(),
        ] {
            writer.line(&line);
        }
        let unit = match options.unit {
            Unit::Mm => "G21",
            Unit::Inch => "G20",
        };
        writer.line(&format!("{unit} G90 G94 G40 G49 G80 G61"));
        writer
    }

    pub fn lines(&self) -> u32 {
        self.lines
    }

    pub fn finish(self) -> String {
        self.text
    }

    fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
        self.lines += 1;
    }

    /// The lines of one thing that is said; after the first one the block that it comes from, where that is another
    /// one than before.
    pub fn said(&mut self, said: &Said, block: impl FnOnce() -> String) {
        let mut text = String::new();
        if said.may_move_the_machine() {
            self.at = elsewhere(&self.at);
        }
        match said {
            Said::Move {
                curve,
                start,
                end,
                feed,
            } => text = self.movement(curve, [start, end], *feed),
            Said::Thread {
                start,
                end,
                pitch_mm,
                returns,
            } => {
                self.motion = "";
                text.push_str(if *returns { "G33.1" } else { "G33" });
                self.axes(&mut text, [start, end], None);
                push_word(&mut text, "K", pitch_mm / self.unit_mm);
                if !*returns {
                    self.goes_to([start, end]);
                }
            }
            Said::Dwell(seconds) => {
                text.push_str("G4");
                push_word(&mut text, "P", *seconds);
            }
            Said::Next(tool) => {
                let _ = write!(text, "T{tool}");
            }
            Said::Change => {
                self.line("M6");
                text.push_str("G43");
            }
            Said::Speed(rpm) => {
                text.push('S');
                push_number(&mut text, *rpm);
            }
            Said::Spindle(order) => text.push_str(match order {
                SpindleOrder::Clockwise => "M3",
                SpindleOrder::CounterClockwise => "M4",
                SpindleOrder::Stop | SpindleOrder::StopWithRun => "M5",
            }),
            Said::Coolant(switch) => text.push_str(if switch.is_on() { "M8" } else { "M9" }),
            Said::Orient(angle) => {
                text.push_str("M19");
                push_word(&mut text, "R", *angle);
            }
            Said::Overrides(switch) => text.push_str(if switch.is_on() { "M48" } else { "M49" }),
            Said::Stop { optional } => text.push_str(if *optional { "M1" } else { "M0" }),
            Said::Print(line) => {
                let _ = write!(text, "(PRINT,{line})");
            }
            Said::User(code) => {
                let _ = write!(text, "M{code}");
            }
            Said::Refused(what) => {
                let _ = write!(text, "(MSG,{})", bare(what));
                self.line(&text);
                text = "M0".to_owned();
            }
            Said::End => text.push_str("M2"),
        }
        if self.comments && *said != Said::End {
            let comment: String = bare(&block()).chars().take(COMMENT_MAX).collect();
            if comment != self.last_comment {
                let _ = write!(text, " ; {comment}");
                self.last_comment = comment;
            }
        }
        self.line(&text);
    }

    fn movement(&mut self, curve: &Curve, ends: [&Position; 2], feed: FeedRate) -> String {
        let mut text = String::new();
        let arc = match curve {
            Curve::Arc(arc) => Some(arc),
            _ => None,
        };
        if let Some(plane) = arc.and_then(|arc| plane_word(&arc.plane))
            && self.plane != Some(plane)
        {
            self.plane = Some(plane);
            text.push_str(plane);
            text.push(' ');
        }
        let motion = match (arc, feed) {
            (Some(arc), _) if arc.sweep_deg < 0.0 => "G2",
            (Some(_), _) => "G3",
            (None, FeedRate::Rapid) => "G0",
            (None, FeedRate::Programmed(_)) => "G1",
        };
        // The word of an arc stands in each of them, so that each can be read by itself.
        if motion != self.motion || arc.is_some() {
            self.motion = motion;
            text.push_str(motion);
        }
        self.axes(&mut text, ends, arc);
        if let Some(arc) = arc {
            self.centre(&mut text, arc);
        }
        if let FeedRate::Programmed(feed) = feed {
            let unit = if turns_only(&self.at, &self.after(ends)) {
                1.0
            } else {
                self.unit_mm
            };
            let mut word = String::new();
            push_word(&mut word, "F", feed / unit);
            if self.feed.as_ref() != Some(&word) {
                text.push(' ');
                text.push_str(&word);
                self.feed = Some(word);
            }
        }
        self.goes_to(ends);
        text.trim_start().to_owned()
    }

    /// The words of axes that move, and those of the plane of an arc.
    fn axes(&self, text: &mut String, ends: [&Position; 2], arc: Option<&Arc>) {
        for axis in self.written(ends) {
            let to = ends[1][axis];
            let in_plane = arc.is_some_and(|arc| arc.plane.contains(axis));
            if in_plane || self.at[axis] != to {
                let unit = if axis.is_rotary() { 1.0 } else { self.unit_mm };
                push_word(text, axis.letter().encode_utf8(&mut [0; 4]), to / unit);
            }
        }
    }

    /// The centre from the start, and the turns of a helix.
    fn centre(&self, text: &mut String, arc: &Arc) {
        let start = arc.plane.point(&self.at);
        let axes = [arc.plane.first, arc.plane.second];
        for (axis, (centre, start)) in axes.into_iter().zip(arc.centre.into_iter().zip(start)) {
            let letter = match axis {
                Axis::X => "I",
                Axis::Y => "J",
                _ => "K",
            };
            push_word(text, letter, (centre - start) / self.unit_mm);
        }
        let turns = turns(arc.sweep_deg);
        if turns > 1 {
            let _ = write!(text, " P{turns}");
        }
    }

    /// The axes whose position the text knows after a movement: not one that stands where no line has brought it.
    fn written(&self, [start, end]: [&Position; 2]) -> Vec<Axis> {
        let stands = |axis: Axis| self.at[axis].is_nan() && start[axis] == end[axis];
        let known = |axis: &Axis| end[*axis].is_finite() && !stands(*axis);
        Axis::ALL.into_iter().filter(known).collect()
    }

    fn goes_to(&mut self, ends: [&Position; 2]) {
        self.at = self.after(ends);
    }

    /// Where the text stands after a movement.
    fn after(&self, ends: [&Position; 2]) -> Position {
        let mut after = self.at;
        for axis in self.written(ends) {
            after[axis] = ends[1][axis];
        }
        after
    }
}

fn push_word(text: &mut String, letter: &str, value: f64) {
    if !text.is_empty() {
        text.push(' ');
    }
    text.push_str(letter);
    push_number(text, value);
}

/// A number without exponent and without trailing zeros.
fn push_number(text: &mut String, value: f64) {
    let rounded = (value * STEPS).round() / STEPS;
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    let written = format!("{rounded:.6}");
    text.push_str(written.trim_end_matches('0').trim_end_matches('.'));
}
