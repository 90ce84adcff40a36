//! What a scripted PLC does: a rule for each function, and what happens at which time.

use std::collections::HashMap;
use std::ops::Range;

use bahn_path::Axis;
use bahn_text::Diagnostic;

use super::said::Said;
use crate::settings::ChannelSettings;

/// A PLC script.
///
/// ```
/// use bahn_technology::Script;
/// let text = "M25 ack 0.5   # after half a second\nX[M7] nofetch\n2.0..2.5: hold\n3.0: override feed 50\n";
/// let script: Script = text.parse()?;
/// let wrong = "M25 ack soon".parse::<Script>().unwrap_err();
/// assert_eq!((wrong.span.line, wrong.span.column), (1, 9));
/// # let _ = script;
/// # Ok::<(), bahn_text::Diagnostic>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    pub(super) rules: Rules,
    pub(crate) driving: Driving,
    /// Where functions and spindles are named.
    pub(super) said: Vec<Said>,
}

/// What a PLC does that is not there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rules {
    /// By range, empty for all of them, and function.
    pub(super) replies: HashMap<(String, String), Reply>,
    pub(super) default: Reply,
    /// By the name of the spindle.
    pub(super) spindles: HashMap<String, After>,
}

/// What happens to the path, by its time, s.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Driving {
    /// Places of a measuring event.
    pub(crate) probes: Vec<(Axis, f64)>,
    pub(crate) holds: Vec<Range<f64>>,
    pub(crate) backward: Vec<Range<f64>>,
    pub(crate) simulated: Vec<Range<f64>>,
    /// Single block.
    pub(crate) singles: Vec<Range<f64>>,
    /// The starts of the operator in their order.
    pub(crate) starts: Vec<f64>,
    pub(crate) resets: Vec<f64>,
    /// Time and override, %, in the order of time.
    pub(crate) overrides: Vec<(f64, f64)>,
    /// When the run ends, whatever is still to come.
    pub(crate) end: Option<f64>,
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
        !self.rules.replies.is_empty() || self.rules.default != Reply::default()
    }

    /// Functions, ranges and spindles that a channel with these settings does not have; the programs may give functions their
    /// types as well.
    pub fn unknown(&self, settings: &ChannelSettings, typed: impl Fn(&str) -> bool) -> Vec<Diagnostic> {
        let errors = self.said.iter().filter_map(|said| said.unknown(settings, &typed));
        errors.collect()
    }

    /// What happens to a function in a range, by any of its names: what is said of it in this range goes before what is
    /// said of it in all.
    pub(crate) fn reply(&self, names: &[String], function: &str) -> Reply {
        let Rules { replies, default, .. } = &self.rules;
        let said = |range: &str| replies.get(&(range.to_owned(), function.to_owned()));
        if replies.is_empty() {
            return *default;
        }
        let own = names.iter().find_map(|name| said(name));
        own.or_else(|| said("")).copied().unwrap_or(*default)
    }

    /// How long a spindle takes to confirm.
    pub(crate) fn ready(&self, names: &[String]) -> After {
        let said = names.iter().find_map(|name| self.rules.spindles.get(name));
        said.copied().unwrap_or(After::Seconds(0.0))
    }
}

impl Driving {
    /// What is said in any order is put in that of time.
    pub(super) fn order(&mut self) {
        self.overrides.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.resets.sort_by(f64::total_cmp);
        self.starts.sort_by(f64::total_cmp);
    }

    /// The times at which it changes how the path is driven, s.
    pub(crate) fn changes(&self) -> impl Iterator<Item = f64> {
        let ranges = self.holds.iter().chain(&self.backward);
        let ranges = ranges.chain(&self.simulated).chain(&self.singles);
        let times = ranges.flat_map(|range| [range.start, range.end]);
        let overrides = self.overrides.iter().map(|(from, _)| *from);
        let moments = self.resets.iter().chain(&self.starts).chain(&self.end);
        let times = times.chain(overrides).chain(moments.copied());
        times.filter(|time| time.is_finite())
    }
}
