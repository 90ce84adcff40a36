//! What a scripted PLC does: a line for each function, and what happens at which time.

use std::collections::HashMap;
use std::ops::Range;
use std::str::FromStr;

use bahn_din::nearest;
use bahn_path::Axis;
use bahn_text::{Diagnostic, Span};

use super::said::{Named, Said};
use crate::settings::ChannelSettings;

/// What a line begins with that says nothing of a function.
const COMMANDS: [&str; 10] = [
    "default",
    "spindle",
    "probe",
    "hold",
    "backward",
    "simulated",
    "single",
    "start",
    "reset",
    "override",
];

/// A PLC script.
///
/// ```
/// use bahn_technology::Script;
/// let script: Script = "M25 ack 0.5   # after half a second\nX[M7] nofetch\nhold 2.0..2.5\n".parse()?;
/// let wrong = "M25 ack soon".parse::<Script>().unwrap_err();
/// assert_eq!((wrong.span.line, wrong.span.column), (1, 9));
/// # let _ = script;
/// # Ok::<(), bahn_text::Diagnostic>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    /// By range, empty for all of them, and function.
    replies: HashMap<(String, String), Reply>,
    default: Reply,
    /// By the name of the spindle.
    spindles: HashMap<String, After>,
    pub(crate) probes: Vec<(Axis, f64)>,
    pub(crate) holds: Vec<Range<f64>>,
    pub(crate) resets: Vec<f64>,
    /// Time and override, %, in the order of time.
    pub(crate) overrides: Vec<(f64, f64)>,
    pub(crate) backward: Vec<Range<f64>>,
    pub(crate) simulated: Vec<Range<f64>>,
    /// Where functions and spindles are named.
    said: Vec<Said>,
    /// Single block, and the starts of the operator.
    pub(crate) singles: Vec<Range<f64>>,
    pub(crate) starts: Vec<f64>,
}

/// What the PLC does with a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reply {
    /// It fetches it and acknowledges it after a time.
    Acknowledge(After),
    /// It fetches it and acknowledges it at this time of the run, s.
    At(f64),
    /// It does not fetch it.
    NoFetch,
}

impl Default for Reply {
    fn default() -> Reply {
        Reply::Acknowledge(After::Seconds(0.0))
    }
}

/// How long something takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum After {
    Seconds(f64),
    Never,
}

impl Script {
    /// Whether it says what the PLC does with functions, and not only what happens to path and spindles.
    pub fn answers_functions(&self) -> bool {
        !self.replies.is_empty() || self.default != Reply::default()
    }

    /// What happens to a function in a range, by any of its names: what is said of it in this range goes before what is
    /// said of it in all.
    pub(crate) fn reply(&self, names: &[String], function: &str) -> Reply {
        let said = |range: &str| self.replies.get(&(range.to_owned(), function.to_owned()));
        if self.replies.is_empty() {
            return self.default;
        }
        let own = names.iter().find_map(|name| said(name));
        own.or_else(|| said("")).copied().unwrap_or(self.default)
    }

    /// How long a spindle takes to confirm.
    pub(crate) fn ready(&self, names: &[String]) -> After {
        let said = names.iter().find_map(|name| self.spindles.get(name));
        said.copied().unwrap_or(After::Seconds(0.0))
    }
}

impl FromStr for Script {
    type Err = Diagnostic;

    fn from_str(text: &str) -> Result<Script, Diagnostic> {
        let (script, errors) = Script::from_text(text);
        errors.into_iter().next().map_or(Ok(script), Err)
    }
}

impl Script {
    /// Reads a script, with all that is wrong in it; lines with errors say nothing.
    pub fn from_text(text: &str) -> (Script, Vec<Diagnostic>) {
        let mut script = Script::default();
        let mut errors = Vec::new();
        for (line, text) in (1..).zip(text.lines()) {
            let code = text.split('#').next().unwrap_or_default();
            let mut words = Words { code, line, at: 0 };
            let Some(first) = words.next() else { continue };
            let read = script.read(first, &mut words);
            let read = read.and_then(|()| match words.next() {
                Some(more) => Err(words.error(more, format!("`{}` is too much", more.1))),
                None => Ok(()),
            });
            errors.extend(read.err());
        }
        script.overrides.sort_by(|a, b| a.0.total_cmp(&b.0));
        script.resets.sort_by(f64::total_cmp);
        script.starts.sort_by(f64::total_cmp);
        (script, errors)
    }

    /// Functions, ranges and spindles that a channel with these settings does not have; the programs may give functions their
    /// types as well.
    pub fn unknown(&self, settings: &ChannelSettings, typed: impl Fn(&str) -> bool) -> Vec<Diagnostic> {
        let errors = self.said.iter().filter_map(|said| said.unknown(settings, &typed));
        errors.collect()
    }

    fn read<'a>(&mut self, first: Word<'a>, words: &mut Words<'a>) -> Result<(), Diagnostic> {
        match first.1 {
            "default" => self.default = words.reply()?,
            "spindle" => {
                let word = words.some("the name of a spindle")?;
                let name = word.1.to_uppercase();
                words.keyword("ready")?;
                let after = words.after()?;
                self.said.push(Said::new(
                    words.error(word, String::new()),
                    Named::Spindle(name.clone()),
                ));
                self.spindles.insert(name, after);
            }
            "probe" => {
                let word = words.some("a place as X45")?;
                let axis = word.1.bytes().next().and_then(Axis::from_letter);
                let value = word.1.get(1..).and_then(|number| number.parse().ok());
                let place = axis.zip(value.filter(|value: &f64| value.is_finite()));
                let wrong = || words.error(word, format!("`{}` is no place as X45", word.1));
                self.probes.push(place.ok_or_else(wrong)?);
            }
            "hold" => self.holds.push(words.range()?),
            "backward" => self.backward.push(words.range()?),
            "simulated" => self.simulated.push(words.range()?),
            "single" => self.singles.push(words.range()?),
            "start" => self.starts.push(words.time("a time, s")?),
            "reset" => self.resets.push(words.time("a time, s")?),
            "override" => {
                let percent = words.time("an override, %")?;
                words.keyword("at")?;
                self.overrides.push((words.time("a time, s")?, percent));
            }
            name => {
                let wrong = || Diagnostic {
                    help: nearest(name, COMMANDS).map(|known| format!("did you mean `{known}`?")),
                    ..words.error(first, format!("`{name}` is no function and no command"))
                };
                let key = function(name).ok_or_else(wrong)?;
                let reply = words.reply()?;
                self.said.push(Said::new(
                    words.error(first, String::new()),
                    Named::Function(key.0.clone(), key.1.clone()),
                ));
                self.replies.insert(key, reply);
            }
        }
        Ok(())
    }
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

/// A word and the column where it begins, from 0.
type Word<'a> = (usize, &'a str);

/// The words of a line.
struct Words<'a> {
    code: &'a str,
    line: usize,
    at: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<Word<'a>> {
        let rest = self.code.get(self.at..)?;
        let from = self.at + rest.find(|c: char| !c.is_whitespace())?;
        let rest = self.code.get(from..)?;
        let to = from + rest.find(char::is_whitespace).unwrap_or(rest.len());
        self.at = to;
        Some((from, self.code.get(from..to)?))
    }

    fn error(&self, at: Word<'_>, message: String) -> Diagnostic {
        let before = self.code.get(..at.0).unwrap_or_default();
        let (column, length) = (before.chars().count() + 1, at.1.chars().count().max(1));
        Diagnostic::error(Span::new(self.line, column, length), message)
    }

    fn some(&mut self, what: &str) -> Result<Word<'a>, Diagnostic> {
        let end = (self.code.trim_end().len(), "");
        self.next()
            .ok_or_else(|| self.error(end, format!("{what} is missing")))
    }

    fn keyword(&mut self, keyword: &str) -> Result<(), Diagnostic> {
        let word = self.some(&format!("`{keyword}`"))?;
        if word.1 == keyword {
            return Ok(());
        }
        let near = nearest(word.1, [keyword]).map(|known| format!("did you mean `{known}`?"));
        Err(Diagnostic {
            help: near,
            ..self.error(word, format!("`{}` stands where `{keyword}` is expected", word.1))
        })
    }

    fn number(&self, word: Word<'_>, text: &str, what: &str) -> Result<f64, Diagnostic> {
        let number = text.parse().ok();
        number
            .filter(|number: &f64| number.is_finite() && *number >= 0.0)
            .ok_or_else(|| self.error(word, format!("`{text}` is not {what}")))
    }

    fn time(&mut self, what: &str) -> Result<f64, Diagnostic> {
        let word = self.some(what)?;
        self.number(word, word.1, what)
    }

    fn after(&mut self) -> Result<After, Diagnostic> {
        let word = self.some("a time, s, or `never`")?;
        if word.1 == "never" {
            return Ok(After::Never);
        }
        self.number(word, word.1, "a time, s, or `never`")
            .map(After::Seconds)
    }

    fn range(&mut self) -> Result<Range<f64>, Diagnostic> {
        let what = "a range of times as 2.0..2.5";
        let word = self.some(what)?;
        let (from, to) = word
            .1
            .split_once("..")
            .ok_or_else(|| self.error(word, format!("`{}` is not {what}", word.1)))?;
        let range = self.number(word, from, what)?..self.number(word, to, what)?;
        if range.end < range.start {
            return Err(self.error(word, format!("`{}` ends before it begins", word.1)));
        }
        Ok(range)
    }

    fn reply(&mut self) -> Result<Reply, Diagnostic> {
        let word = self.some("`ack`, `at` or `nofetch`")?;
        match word.1 {
            "ack" => self.after().map(Reply::Acknowledge),
            "at" => self.time("a time, s").map(Reply::At),
            "nofetch" => Ok(Reply::NoFetch),
            other => {
                let message = format!("`{other}` stands where `ack`, `at` or `nofetch` is expected");
                let near = nearest(other, ["ack", "at", "nofetch"]);
                Err(Diagnostic {
                    help: near.map(|known| format!("did you mean `{known}`?")),
                    ..self.error(word, message)
                })
            }
        }
    }
}
