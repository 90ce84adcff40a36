//! Which functions of a program are executed here, as the registry of the control models says it
//! ([`bahn_parameters::conformance`]): nothing is passed over in silence.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use bahn_parameters::conformance::{Effect, Entry, Kind, find};
use bahn_parameters::{ControlModel, MessageId};
use bahn_program::{CycleBlock, CycleWord, InputSteps, InvalidBlock, Unit};

use crate::error::{Cause, Fault, WarningKind};
use crate::flow::Flow;
use crate::run::Run;
use crate::settings::Settings;

/// A function of a block that has a row of its own in the registry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Feature {
    /// `M114`.
    M(u16),
    /// `CYCL DEF 19`.
    Cycle(u16),
    /// `TCH PROBE 5`.
    Probe(u16),
    /// `FN15`.
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
    /// Oversizes of a tool call.
    pub const OVERSIZE: &str = "TOOL CALL DL DR";
}

impl Feature {
    /// The row of the registry; `None` when the model does not have the function.
    fn entry(self, model: ControlModel) -> Option<&'static Entry> {
        let kind = match self {
            Feature::M(_) => Kind::MFunction,
            Feature::Cycle(_) | Feature::Probe(_) => Kind::Cycle,
            Feature::Fn(_) => Kind::Fn,
            Feature::Word(_) => Kind::Word,
        };
        find(model, kind, &self.to_string())
    }

    /// What a model does with the function.
    fn judge(self, model: ControlModel, strict: bool) -> Judgement {
        let Some(entry) = self.entry(model) else {
            return Judgement::Refused(format!("this control has no {self}"));
        };
        let Some(remark) = entry.remark() else {
            return Judgement::Executed;
        };
        let remark = format!("{self} {remark}");
        match entry.effect {
            Effect::None if entry.moves => Judgement::Refused(remark),
            _ if strict => Judgement::Refused(remark),
            Effect::None => Judgement::PassedOver(remark),
            Effect::Partly | Effect::Acts => Judgement::Remarked(remark),
        }
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

/// What becomes of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Judgement {
    /// It is executed.
    Executed,
    /// It is executed in part; the text says what is missing.
    Remarked(String),
    /// It has no effect, and the path is the same without it; the text says what it would do.
    PassedOver(String),
    /// The control lacks it, or the path would be another with it; the text says why.
    Refused(String),
}

/// What was said in a run, each thing once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Said {
    /// Functions, and whether they are executed: each is looked up where it first stands.
    features: BTreeMap<Feature, bool>,
    /// Programs with numbers that were rounded.
    rounded: BTreeSet<u16>,
}

impl Run {
    /// Whether a function is to be executed. Where it is met first, the user is told when it is not, or not
    /// wholly.
    ///
    /// # Errors
    /// FUNCTION NOT AVAILABLE ON THIS CONTROL for what must not be passed over.
    pub(crate) fn executes(&mut self, feature: Feature, settings: &Settings) -> Result<bool, Fault> {
        if let Some(executes) = self.said.features.get(&feature) {
            return Ok(*executes);
        }
        let executes = match feature.judge(settings.model, settings.strict) {
            Judgement::Executed => true,
            Judgement::Remarked(text) => {
                self.warn(WarningKind::Function { text });
                true
            }
            Judgement::PassedOver(text) => {
                self.warn(WarningKind::Function { text });
                false
            }
            Judgement::Refused(text) if settings.skip_unknown => {
                self.warn(WarningKind::PassedOver { what: text });
                false
            }
            Judgement::Refused(text) => return Err(Fault::new(MessageId::BlockNotKnown, text)),
        };
        self.said.features.insert(feature, executes);
        Ok(executes)
    }

    /// The block has numbers that were rounded: the user is told at the first of each program.
    ///
    /// # Errors
    /// ENTRY VALUE INCORRECT where checking is strict.
    #[cold]
    pub(crate) fn tell_rounded(&mut self, settings: &Settings) -> Result<(), Fault> {
        let steps = InputSteps::of(settings.model, self.unit);
        let unit = match self.unit {
            Unit::Mm => "mm",
            Unit::Inch => "inch",
        };
        let step = format!("{} {unit} and {}°", steps.length(), steps.angle());
        let first = self.said.rounded.insert(self.block.program);
        // A rehearsal goes on after an error, and says this one once, too.
        if settings.strict && (first || !self.rehearsal) {
            let detail = format!("the input step of this control is {step}");
            return Err(Fault::new(MessageId::EntryValueIncorrect, detail));
        }
        if first {
            self.warn(WarningKind::Rounded { step });
        }
        Ok(())
    }

    /// A block that could not be read. With [`Settings::skip_unknown`] a word that nothing knows is left
    /// out, and a block that opens with one is passed over.
    #[cold]
    pub(crate) fn unreadable(&mut self, block: &InvalidBlock, settings: &Settings) -> Result<Flow, Fault> {
        let error = &block.error;
        if !settings.skip_unknown || !block.is_unknown() {
            let cause = error.help.map_or(Cause::Message, Cause::Written);
            return Err(Fault::new(error.message, error.detail.to_string()).because(cause));
        }
        let (operation, words) = block.without_unknown_words();
        self.warn(WarningKind::PassedOver { what: words });
        match operation {
            Some(operation) => self.execute_operation(&operation, settings),
            None => Ok(Flow::Next),
        }
    }
}

/// Whether the words of cycle 7 are a line of a datum table.
pub(crate) fn names_datum_table(block: &CycleBlock) -> bool {
    let is_line = |word: &CycleWord| matches!(word, CycleWord::Text(text) if text.starts_with('#'));
    block.number == 7 && block.sub > 0 && block.words.iter().any(is_line)
}
