//! What can be said in a script of a channel: rules of the PLC, and what happens to the path at which time.
//!
//! Decision: A script of `bahn technology` counts the time of its run: power-on and start of the program are its beginning

use std::convert::Infallible;
use std::ops::Range;
use std::path::Path;
use std::str::FromStr;

use bahn_path::{Axis, Switch};
use bahn_script::{Fault, Line, Times, Verbs, Words};
use bahn_text::{Diagnostic, Span};

use super::said::{Named, Said};
use super::script::{After, Driving, Reply, Script};
use crate::list::CYCLE_S;

/// What lasts for a span of time.
const LASTING: [(&str, Lasting); 4] = [
    ("hold", |driving| &mut driving.holds),
    ("backward", |driving| &mut driving.backward),
    ("simulated", |driving| &mut driving.simulated),
    ("single", |driving| &mut driving.singles),
];

/// What happens in a moment.
const SUDDEN: [(&str, Sudden); 2] = [
    ("start", |driving| &mut driving.starts),
    ("reset", |driving| &mut driving.resets),
];

/// What a script of a machine says, too.
const OF_ALL: [&str; 5] = ["key", "override", "mode", "stop", "end"];

/// What a line begins with that is ruled and is no function.
const RULES: [&str; 4] = ["default", "spindle", "probe", "override"];

/// The times from which on and up to which it is so, s.
type Lasting = fn(&mut Driving) -> &mut Vec<Range<f64>>;

/// The times at which it happens, s.
type Sudden = fn(&mut Driving) -> &mut Vec<f64>;

/// What a line does at its time.
#[derive(Clone, Copy, Debug)]
enum Change {
    Begins(Lasting),
    Ends,
    Happens(Sudden),
    Override(f64),
    NcStop,
    NcStart,
    /// A key is released.
    Nothing,
    SingleBlock(Switch),
    InternalStop,
    End,
}

impl Script {
    /// Reads a script, with all that is wrong in it; lines with errors say nothing.
    pub fn from_text(text: &str) -> (Script, Vec<Diagnostic>) {
        Script::for_cycle(text, CYCLE_S)
    }

    /// Reads a script for a channel whose contour cycle takes so long, s.
    pub fn for_cycle(text: &str, cycle_s: f64) -> (Script, Vec<Diagnostic>) {
        let times = Times::of_cycle((cycle_s * 1e6).round() as u32);
        let mut known = Known::default();
        let (read, mut errors) = bahn_script::Script::read(Path::new(""), text, times, &mut known);
        let Known(mut script) = known;
        let failed = happen(&mut script.driving, &read.lines);
        errors.extend(failed.map(|number| {
            let message = "`stop` ends a run that is interrupted: `key NC_STOP tap` comes before it";
            Diagnostic::error(Span::line(number as usize), message)
        }));
        errors.sort();
        script.driving.order();
        (script, errors)
    }
}

impl FromStr for Script {
    type Err = Diagnostic;

    fn from_str(text: &str) -> Result<Script, Diagnostic> {
        let (script, errors) = Script::from_text(text);
        errors.into_iter().next().map_or(Ok(script), Err)
    }
}

/// A time of the run, s.
fn seconds(us: u64) -> f64 {
    // Divided, so that it is the number nearest to what is written.
    us as f64 / 1e6
}

/// Puts together what happens at each time. Numbers the line that stops a run which is not interrupted.
fn happen(driving: &mut Driving, lines: &[Line<Change, Infallible>]) -> Option<u32> {
    let of = |line: &Line<Change, Infallible>| seconds(line.offset_us);
    for (at, line) in lines.iter().enumerate() {
        if let Change::Begins(lasting) = line.action {
            // The other end of its span of time is the next line; without one it lasts for the rest of the run.
            let end = lines.get(at + 1).filter(|end| matches!(end.action, Change::Ends));
            lasting(driving).push(of(line)..end.map_or(f64::INFINITY, of));
        }
    }
    let mut ordered: Vec<&Line<Change, Infallible>> = lines.iter().collect();
    ordered.sort_by_key(|line| line.offset_us);
    let (mut stopped, mut single) = (None, None);
    for line in ordered {
        let now = of(line);
        match line.action {
            Change::Begins(_) | Change::Ends | Change::Nothing => {}
            Change::Happens(sudden) => sudden(driving).push(now),
            Change::Override(percent) => driving.overrides.push((now, percent)),
            Change::NcStop => stopped = stopped.or(Some(now)),
            Change::NcStart => match stopped.take() {
                Some(from) => driving.holds.push(from..now),
                None => driving.starts.push(now),
            },
            Change::SingleBlock(Switch::On) => single = single.or(Some(now)),
            Change::SingleBlock(Switch::Off) => {
                driving.singles.extend(single.take().map(|from| from..now));
            }
            Change::InternalStop => match stopped.take() {
                Some(from) => {
                    driving.holds.push(from..now);
                    driving.resets.push(now);
                }
                None => return Some(line.number),
            },
            Change::End => driving.end = Some(driving.end.map_or(now, |end: f64| end.min(now))),
        }
    }
    driving.holds.extend(stopped.map(|from| from..f64::INFINITY));
    driving.singles.extend(single.map(|from| from..f64::INFINITY));
    None
}

/// What is known in a script of a channel; rules are kept at once.
#[derive(Default)]
struct Known(Script);

impl Verbs for Known {
    type Action = Change;
    type Condition = Infallible;

    fn action<'a>(&mut self, what: &'a str) -> Result<Change, Fault<'a>> {
        let mut words = Words::of(what);
        let verb = words.some("what happens")?;
        let change = match verb {
            "key" => {
                let key = words.one_of(&["NC_STOP", "NC_START"])?;
                match (words.one_of(&["press", "release", "tap"])?, key) {
                    ("release", _) => Change::Nothing,
                    (_, "NC_STOP") => Change::NcStop,
                    _ => Change::NcStart,
                }
            }
            "override" => {
                words.one_of(&["feed"])?;
                let word = words.clone().next().unwrap_or(verb);
                let percent = words.number("an override from 0 to 150 %")?;
                if percent > 150.0 {
                    return Err(Fault::new(
                        word,
                        format!("`{word}` is no override from 0 to 150 %"),
                    ));
                }
                Change::Override(percent)
            }
            "mode" => Change::SingleBlock(Switch::from(words.one_of(&["single", "full"])? == "single")),
            "stop" => Change::InternalStop,
            "end" => Change::End,
            verb => return self.own(verb, words),
        };
        words.end()?;
        Ok(change)
    }

    fn end<'a>(&mut self, what: &'a str) -> Result<Change, Fault<'a>> {
        let word = what.split_whitespace().next().unwrap_or_default();
        if LASTING.iter().any(|(name, _)| *name == word) {
            return Ok(Change::Ends);
        }
        Err(Fault::new(
            what,
            "it lasts no time: it takes a time, no span of time",
        ))
    }

    fn rule<'a>(&mut self, _: &'a str, words: &mut Words<'a>, times: &Times) -> Result<(), Fault<'a>> {
        let first = words.some("a rule")?;
        let Script { rules, driving, .. } = &mut self.0;
        if let Some((_, lasting)) = LASTING.iter().find(|(name, _)| *name == first) {
            let (from_us, to_us) = times.span_of(words)?;
            lasting(driving).push(seconds(from_us)..seconds(to_us));
            return Ok(());
        }
        if let Some((_, sudden)) = SUDDEN.iter().find(|(name, _)| *name == first) {
            sudden(driving).push(seconds(times.duration_of(words, "a time, s")?));
            return Ok(());
        }
        match first {
            "default" => rules.default = reply(words, times)?,
            "spindle" => {
                let word = words.some("the name of a spindle")?;
                words.one_of(&["ready"])?;
                let after = after(words, times)?;
                let name = word.to_uppercase();
                self.said(words.span(word), Named::Spindle(name.clone()));
                self.0.rules.spindles.insert(name, after);
            }
            "probe" => {
                let word = words.some("a place as X45")?;
                let axis = word.bytes().next().and_then(Axis::from_letter);
                let value = word.get(1..).and_then(|number| number.parse().ok());
                let place = axis.zip(value.filter(|value: &f64| value.is_finite()));
                let wrong = || Fault::new(word, format!("`{word}` is no place as X45"));
                driving.probes.push(place.ok_or_else(wrong)?);
            }
            "override" => {
                let percent = words.number("an override, %")?;
                words.one_of(&["at"])?;
                let time = seconds(times.duration_of(words, "a time, s")?);
                driving.overrides.push((time, percent));
            }
            name => {
                let key = function(name).ok_or_else(|| {
                    let message = format!("`{name}` is no function and no command");
                    Fault::new(first, message).meant(name, RULES.into_iter().chain(own_verbs()))
                })?;
                let reply = reply(words, times)?;
                self.said(words.span(first), Named::Function(key.0.clone(), key.1.clone()));
                self.0.rules.replies.insert(key, reply);
            }
        }
        Ok(())
    }
}

impl Known {
    /// What happens to the path of a channel alone.
    fn own<'a>(&self, verb: &'a str, mut words: Words<'a>) -> Result<Change, Fault<'a>> {
        let lasting = LASTING.iter().find(|(name, _)| *name == verb);
        let sudden = SUDDEN.iter().find(|(name, _)| *name == verb);
        let change = match (lasting, sudden) {
            (Some((_, lasting)), _) => Change::Begins(*lasting),
            (_, Some((_, sudden))) => Change::Happens(*sudden),
            _ if verb == "expect" => {
                let message = "a machine is asked what is so; of a channel alone its report tells";
                return Err(Fault::new(verb, message));
            }
            _ if function(verb).is_some() || RULES.contains(&verb) => {
                let message = format!("`{verb}` begins a rule, which stands without a time");
                return Err(Fault::new(verb, message));
            }
            _ => {
                let message = format!("`{verb}` is no verb of a channel");
                return Err(Fault::new(verb, message).meant(verb, OF_ALL.into_iter().chain(own_verbs())));
            }
        };
        words.end()?;
        Ok(change)
    }

    /// A name that the channel must have.
    fn said(&mut self, place: Span, named: Named) {
        let place = Diagnostic::error(place, String::new());
        self.0.said.push(Said::new(place, named));
    }
}

fn own_verbs() -> impl Iterator<Item = &'static str> {
    let lasting = LASTING.iter().map(|(name, _)| *name);
    lasting.chain(SUDDEN.iter().map(|(name, _)| *name))
}

/// Range and function: `M25`, `X[M7]`, `S`.
fn function(name: &str) -> Option<(String, String)> {
    let (range, label) = match name.strip_suffix(']') {
        Some(open) => open.split_once('[').filter(|(range, _)| !range.is_empty())?,
        None => ("", name),
    };
    let upper = label.to_uppercase();
    let label = match (upper.get(..1)?, upper.get(1..)?) {
        ("S", "") => "S".to_owned(),
        (letter @ ("M" | "H"), number) if number.bytes().all(|byte| byte.is_ascii_digit()) => {
            format!("{letter}{}", number.parse::<u16>().ok()?)
        }
        _ => return None,
    };
    Some((range.to_uppercase(), label))
}

fn reply<'a>(words: &mut Words<'a>, times: &Times) -> Result<Reply, Fault<'a>> {
    match words.one_of(&["ack", "at", "nofetch"])? {
        "ack" => after(words, times).map(Reply::Acknowledge),
        "at" => {
            let us = times.duration_of(words, "a time, s")?;
            Ok(Reply::At(seconds(us)))
        }
        _ => Ok(Reply::NoFetch),
    }
}

fn after<'a>(words: &mut Words<'a>, times: &Times) -> Result<After, Fault<'a>> {
    let mut ahead = words.clone();
    if ahead.next() == Some("never") {
        *words = ahead;
        return Ok(After::Never);
    }
    let us = times.duration_of(words, "a time, s, or `never`")?;
    Ok(After::Seconds(seconds(us)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// A time is the number nearest to what is written, to the bit.
        #[test]
        fn times_are_what_is_written(whole in 0_u32..1_000_000, millionths in 0_u32..1_000_000) {
            let text = format!("{whole}.{millionths:06}");
            let us = Times::of_cycle(3000).duration(&text);
            prop_assert_eq!(us.map(seconds).ok(), text.parse().ok());
        }
    }
}
