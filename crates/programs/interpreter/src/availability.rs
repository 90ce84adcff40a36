//! Which functions of a program are executed here, as the registry of the control models says it
//! ([`bahn_parameters::conformance`]): nothing is passed over in silence.
//!
//! Decision: M103, M105 and M106 that MP7440 does not enable are refused as functions that the control does not have
//!
//! Decision: A function without effect is said once at its first block; one without which the control would move
//! differently is refused (`--skip-unknown` passes over it); a row that acts names its test (also
//! `parameters/src/conformance.rs`)

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use bahn_parameters::conformance::{Effect, Entry, Kind, find};
use bahn_parameters::equipment::Use;
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::{CycleBlock, CycleWord};

use crate::error::{Fault, WarningKind};
use crate::settings::{Rules, Settings};

/// A function of a block that has a row of its own in the registry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Feature {
    /// M function, by its number: `M114`.
    M(u16),
    /// Cycle, by its number: `CYCL DEF 19`.
    Cycle(u16),
    /// Probe function, by its number: `TCH PROBE 5`.
    Probe(u16),
    /// Q parameter function, by its number: `FN15`.
    Fn(u16),
    /// Blocks and words, by their name in the registry: [`words`].
    Word(&'static str),
}

/// Names of [`Feature::Word`].
pub(crate) mod words {
    /// `CYCL DEF 7.1 #n`: a line of a datum table.
    pub const DATUM_TABLE: &str = "CYCL DEF # (line of a datum table)";
    /// The dialogue block of an OEM cycle that acts at its definition [000:17732-17736].
    pub const DIALOG_DEFINITION: &str = "DLG-DEF";
    /// The dialogue block of an OEM cycle that acts at its call [000:17738-17740].
    pub const DIALOG_CALL: &str = "DLG-CALL";
    /// Lines with the normal of the surface [000:175].
    pub const NORMALS: &str = "LN (surface normals)";
    /// Oversizes of a tool call.
    pub const OVERSIZE: &str = "TOOL CALL DL DR";
}

impl Feature {
    /// The row of the registry; `None` when the model does not have the function.
    fn entry(self, model: ControlModel) -> Option<&'static Entry> {
        find(model, self.kind(), &self.to_string())
    }

    fn kind(self) -> Kind {
        match self {
            Feature::M(_) => Kind::MFunction,
            Feature::Cycle(_) | Feature::Probe(_) => Kind::Cycle,
            Feature::Fn(_) => Kind::Fn,
            Feature::Word(_) => Kind::Word,
        }
    }

    /// Whether the function is executed, and what the user is told when it is not, or not wholly.
    ///
    /// # Errors
    /// FUNCTION NOT AVAILABLE ON THIS CONTROL for what must not be passed over.
    pub fn judge(self, settings: &Settings) -> Result<(bool, Option<WarningKind>), Fault> {
        let passed_over = |what: String| match settings.skip_unknown {
            true => Ok((false, Some(WarningKind::PassedOver { what }))),
            false => Err(Fault::new(MessageId::BlockNotKnown, what)),
        };
        let Some(entry) = self.entry(settings.model) else {
            return passed_over(format!("this control has no {self}"));
        };
        let name = self.to_string();
        let wanted = Use::of(self.kind(), &name);
        if let Some(why) = settings.rules.equipment.lacks(settings.model, wanted) {
            return Err(Fault::new(MessageId::BlockNotKnown, format!("{name} is {why}")));
        }
        if let Some(why) = self.not_enabled(&settings.rules) {
            return passed_over(format!("{self} {why}"));
        }
        let Some(remark) = entry.remark() else {
            return Ok((true, None));
        };
        let text = format!("{self} {remark}");
        match entry.effect {
            // The path would be another with it.
            Effect::None if entry.moves => passed_over(text),
            _ if settings.strict => passed_over(text),
            Effect::None => Ok((false, Some(WarningKind::Function { text }))),
            Effect::Partly | Effect::Acts => Ok((true, Some(WarningKind::Function { text }))),
        }
    }
}

impl Feature {
    /// Why a function that the model has is not active on this machine: M103, M105 and M106 by MP7440
    /// [000:7292-7304], M200 to M204 by MP3011 [000:9841-9848]. The path, its feed or the loops would be others with
    /// it: it is refused as those functions are that the model does not have (inferred: no manual prints a message).
    fn not_enabled(self, rules: &Rules) -> Option<&'static str> {
        let (enabled, why) = match self {
            Feature::M(103) => (rules.m_functions.m103_enabled, "is active with MP7440 bit 4 = 1"),
            Feature::M(105 | 106) => (rules.m_functions.m105_enabled, "is active with MP7440 bit 3 = 1"),
            Feature::M(200..=204) => (rules.voltages.is_some(), "is for output S with MP3011 = 3"),
            _ => return None,
        };
        (!enabled).then_some(why)
    }
}

impl fmt::Display for Feature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Feature::M(code) => write!(f, "M{code}"),
            Feature::Cycle(number) => write!(f, "CYCL DEF {number}"),
            Feature::Probe(number) => write!(f, "TCH PROBE {number}"),
            Feature::Fn(number) => write!(f, "FN{number}"),
            Feature::Word(name) => f.write_str(name),
        }
    }
}

/// What was said in a run, each thing once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Said {
    /// Functions, and whether they are executed: each is looked up where it first stands.
    features: BTreeMap<Feature, bool>,
    /// Programs with numbers that were rounded.
    rounded: BTreeSet<u16>,
}

impl Said {
    /// Whether a function is executed, when it was looked up before.
    pub fn executes(&self, feature: Feature) -> Option<bool> {
        self.features.get(&feature).copied()
    }

    /// Keeps what was found of a function.
    pub fn note(&mut self, feature: Feature, executes: bool) {
        self.features.insert(feature, executes);
    }

    /// Whether these are the first rounded numbers of a program.
    pub fn is_first_rounded(&mut self, program: u16) -> bool {
        self.rounded.insert(program)
    }
}

/// MP7245: refuses a cycle that the machine builder inhibits, be it one of the tool probe, 30 or 31 [000:6655-6699].
pub(crate) fn not_inhibited(number: u16, settings: &Settings) -> Result<(), Fault> {
    if number < 32 && settings.rules.inhibited_cycles >> number & 1 != 0 {
        let detail = format!("MP7245 inhibits cycle {number}");
        return Err(Fault::new(MessageId::BlockNotKnown, detail));
    }
    Ok(())
}

/// Whether the words of cycle 7 are a line of a datum table.
pub(crate) fn names_datum_table(block: &CycleBlock) -> bool {
    let is_line = |word: &CycleWord| matches!(word, CycleWord::Text(text) if text.starts_with('#'));
    block.number == 7 && block.sub > 0 && block.words.iter().any(is_line)
}
