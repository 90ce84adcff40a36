//! The times of a script.
//!
//! Decision: What follows a span of time with `+` counts from its end

use crate::fault::Fault;
use crate::words::Words;

/// The last cycle that a script may speak of: on the bench more than two days. A slip of the keyboard is not to run for
/// years.
const CYCLES_MAX: u64 = 10_000_000;

/// What a time counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Power-on of the machine.
    PowerOn,
    /// The start of the program.
    Start,
    /// The moment in which a condition came true; conditions are numbered in the order of the file.
    Condition(usize),
}

/// A moment: what it counts from, µs after it, and whether it is the beginning of a cycle that was named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Moment {
    pub(crate) base: Base,
    pub(crate) us: u64,
    pub(crate) cycle: bool,
}

/// How times are read.
#[derive(Clone, Debug)]
pub struct Times {
    pub(crate) cycle_us: u32,
    latest_s: f64,
    /// What the next line counts from with `+`.
    pub(crate) last: Moment,
}

impl Times {
    /// The control cycle is so long, µs.
    pub fn of_cycle(cycle_us: u32) -> Times {
        let last = Moment {
            base: Base::PowerOn,
            us: 0,
            cycle: false,
        };
        Times {
            cycle_us,
            latest_s: f64::MAX,
            last,
        }
    }

    /// A later time is none, s.
    pub fn up_to(self, latest_s: f64) -> Times {
        Times { latest_s, ..self }
    }

    /// A time, or a count of cycles, in µs: `12.5`, `20 cycles`.
    ///
    /// # Errors
    /// When it is neither.
    pub fn duration<'a>(&self, text: &'a str) -> Result<u64, Fault<'a>> {
        let trimmed = text.trim();
        let cycles = ["cycles", "cycle"]
            .iter()
            .find_map(|unit| trimmed.strip_suffix(unit));
        let us = match cycles {
            Some(count) => {
                let count = count.trim().parse::<u32>().ok();
                count.map(|count| u64::from(count) * u64::from(self.cycle_us))
            }
            None => {
                let seconds = trimmed.parse::<f64>().ok();
                let seconds = seconds.filter(|seconds| (0.0..=self.latest_s).contains(seconds));
                seconds.map(|seconds| (seconds * 1e6).round() as u64)
            }
        };
        us.filter(|us| *us as f64 <= self.latest_s * 1e6).ok_or_else(|| {
            let message = format!(
                "`{trimmed}` is no time: 12.5 (s since power-on), +2 (since the line before), start+3, +20 cycles, \
                 cycle 5, a span of time 2..2.5, or a condition: when X.actual > 50, after message TEXT"
            );
            Fault::new(text, message)
        })
    }

    /// The next words of a rule are a duration; `what` is missing otherwise. µs.
    ///
    /// # Errors
    /// When they are none.
    pub fn duration_of<'a>(&self, words: &mut Words<'a>, what: &str) -> Result<u64, Fault<'a>> {
        let word = words.some(what)?;
        let mut ahead = words.clone();
        let unit = ahead.next().filter(|unit| matches!(*unit, "cycles" | "cycle"));
        let us = match unit {
            Some(unit) => {
                *words = ahead;
                self.duration(&format!("{word} {unit}")).ok()
            }
            None => self.duration(word).ok(),
        };
        us.ok_or_else(|| Fault::new(word, format!("`{word}` is not {what}")))
    }

    /// The next word of a rule is a span of time from power-on on, as `2.0..2.5`. µs.
    ///
    /// # Errors
    /// When it is none.
    pub fn span_of<'a>(&self, words: &mut Words<'a>) -> Result<(u64, u64), Fault<'a>> {
        let what = "a span of time as 2.0..2.5";
        let word = words.some(what)?;
        let wrong = |_| Fault::new(word, format!("`{word}` is not {what}"));
        let (from, to) = word.split_once("..").ok_or(()).map_err(wrong)?;
        let part = |text| self.duration(text).map_err(|_| ());
        let (from_us, to_us) = (part(from).map_err(wrong)?, part(to).map_err(wrong)?);
        ordered(word, from_us, to_us)
    }

    /// A moment, and the end of the span of time that begins then. `started` tells why no program is ever started.
    pub(crate) fn moments<'a>(
        &self,
        text: &'a str,
        started: &dyn Fn() -> Result<(), String>,
    ) -> Result<(Moment, Option<Moment>), Fault<'a>> {
        let Some((from, to)) = text.split_once("..") else {
            return Ok((self.moment(text, started)?, None));
        };
        let from = self.moment(from.trim(), started)?;
        let after = Times {
            last: from,
            ..self.clone()
        };
        let to = after.moment(to.trim(), started)?;
        if from.base != to.base {
            let message =
                "both ends of a span of time count from the same moment, as start+2..start+3 or 2..+1";
            return Err(Fault::new(text, message));
        }
        ordered(text, from.us, to.us)?;
        Ok((from, Some(to)))
    }

    /// `12.5` since power-on, `+2` since the line before, `start` or `start+2` since the program was started, in seconds or,
    /// as `+20 cycles`, in cycles; `cycle 5` begins then.
    fn moment<'a>(
        &self,
        text: &'a str,
        started: &dyn Fn() -> Result<(), String>,
    ) -> Result<Moment, Fault<'a>> {
        let moment = |base, us| Moment {
            base,
            us,
            cycle: false,
        };
        if let Some(number) = text.strip_prefix("cycle ") {
            return self.cycle(text, number);
        }
        if let Some(rest) = text.strip_prefix('+') {
            let us = self.last.us.saturating_add(self.duration(rest)?);
            return Ok(moment(self.last.base, us));
        }
        let Some(rest) = text.strip_prefix("start") else {
            return Ok(moment(Base::PowerOn, self.duration(text)?));
        };
        started().map_err(|message| Fault::new(text, message))?;
        match (rest.trim(), rest.trim().strip_prefix('+')) {
            ("", _) => Ok(moment(Base::Start, 0)),
            (_, Some(rest)) => Ok(moment(Base::Start, self.duration(rest)?)),
            _ => Err(Fault::new(text, "after `start` stands + and a time")),
        }
    }

    /// When the cycle begins that `cycle 5` names.
    fn cycle<'a>(&self, text: &'a str, number: &str) -> Result<Moment, Fault<'a>> {
        let number = number.trim().parse().ok();
        let number = number.filter(|number| (1..=CYCLES_MAX).contains(number));
        let number =
            number.ok_or_else(|| Fault::new(text, format!("`{text}` is no cycle from 1 to {CYCLES_MAX}")))?;
        Ok(Moment {
            base: Base::PowerOn,
            us: (number - 1) * u64::from(self.cycle_us),
            cycle: true,
        })
    }
}

/// Both ends of a span of time, which does not end before it begins.
fn ordered(text: &str, from_us: u64, to_us: u64) -> Result<(u64, u64), Fault<'_>> {
    if to_us < from_us {
        return Err(Fault::new(text, format!("`{text}` ends before it begins")));
    }
    Ok((from_us, to_us))
}
