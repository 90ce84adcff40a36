//! What a campaign holds a machine to, and what does not hold.

use serde::Serialize;

/// What must hold in every run, whatever happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// Every position is a number, every voltage within 10 V.
    Numbers,
    /// No axis is commanded out of its traverse range.
    Travel,
    /// No axis is commanded faster than its rapid traverse.
    Speed,
    /// Nor with more than its acceleration, but for the steps of velocity at corners.
    Acceleration,
    /// Without closed loop, feed enable or supply the nominal value is 0 V.
    Enable,
    /// What a loop monitors is said as soon as it is so.
    Monitoring,
    /// What the table of faults says is done: message, loops, outputs, PLC.
    Reaction,
    /// After a reaction no axis travels farther than the table says.
    Distance,
    /// No message comes without a cause.
    Cause,
    /// An output has one writer, an axis one channel.
    Writer,
    /// What survives power-off is what it was.
    Retained,
    /// The path is that of the undisturbed run.
    Contour,
    /// When everything is put back, the run goes on or the control says why not.
    Recovery,
    /// The control goes on.
    Alive,
}

impl Rule {
    /// Every rule, in the order of the variants.
    pub const ALL: [Rule; 14] = [
        Rule::Numbers,
        Rule::Travel,
        Rule::Speed,
        Rule::Acceleration,
        Rule::Enable,
        Rule::Monitoring,
        Rule::Reaction,
        Rule::Distance,
        Rule::Cause,
        Rule::Writer,
        Rule::Retained,
        Rule::Contour,
        Rule::Recovery,
        Rule::Alive,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Rule::Numbers => "numbers",
            Rule::Travel => "travel",
            Rule::Speed => "speed",
            Rule::Acceleration => "acceleration",
            Rule::Enable => "enable",
            Rule::Monitoring => "monitoring",
            Rule::Reaction => "reaction",
            Rule::Distance => "distance",
            Rule::Cause => "cause",
            Rule::Writer => "writer",
            Rule::Retained => "retained",
            Rule::Contour => "contour",
            Rule::Recovery => "recovery",
            Rule::Alive => "alive",
        }
    }
}

/// A rule that did not hold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Violation {
    /// The rule that was broken.
    pub rule: Rule,
    /// When, s since power-on.
    pub time_s: f64,
    /// The values, in words.
    pub values: String,
}

impl Violation {
    pub(in crate::torture) fn new(rule: Rule, time_us: u64, values: String) -> Violation {
        Violation {
            rule,
            time_s: time_us as f64 * 1e-6,
            values,
        }
    }
}
