//! What an editor has to know of its control and machine.

use bahn_parameters::conformance::{Kind, find};
use bahn_parameters::machining::Decimal;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, AxisSet};
use bahn_program::{InputSteps, Program, Reading, Unit};

use crate::{Key, Tongue};

/// A cycle of the machine builder, with the texts of its dialogue [000:17691-17984].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BuilderCycle {
    /// Its number, 68 to 99.
    pub number: u16,
    /// The name of the cycle.
    pub name: String,
    /// Its parameters: Q parameter and text of the question.
    pub parameters: Vec<(u16, String)>,
}

/// What an editor has to know of its control and machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The control model, whose limits the entries keep to.
    pub model: ControlModel,
    /// Language of the dialogue.
    pub tongue: Tongue,
    /// The axes of the machine.
    pub axes: AxisSet,
    /// The axis of key IV.
    pub fourth: Option<Axis>,
    /// The axis of key V.
    pub fifth: Option<Axis>,
    /// Step of lengths that are entered, mm, where it is coarser than that of the model: MP65 of a TNC 151/155.
    pub input_step_mm: Option<f64>,
    /// Numbers are shown with a comma.
    pub decimal_comma: bool,
    /// Blocks with R+ and R- are inhibited.
    pub paraxial_inhibited: bool,
    /// Cycles that the machine builder has inhibited.
    pub inhibited_cycles: Vec<u16>,
    /// The cycles of the machine builder.
    pub builder_cycles: Vec<BuilderCycle>,
    /// Step of the numbers that blocks of DIN/ISO get: MP7220; with 0 they get none [000:6885].
    pub iso_step: u32,
    /// Bytes that a program may have in the memory of the control.
    pub bytes_max: u64,
}

/// Greatest number of a standard cycle.
const CYCLE_MAX: u16 = 31;

impl Setting {
    /// That of a machine.
    ///
    /// ```
    /// use bahn_dialogue::Setting;
    /// use bahn_parameters::{ControlModel, ParameterList};
    ///
    /// let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc360));
    /// assert_eq!(setting.model, ControlModel::Tnc360);
    /// ```
    pub fn of(list: &ParameterList) -> Setting {
        let axes = list.axes();
        let at = |index| axes.iter().find(|axis| list.axis_index(*axis) == Some(index));
        Setting {
            model: list.model(),
            tongue: match list.operation_parameters().english {
                true => Tongue::English,
                false => Tongue::German,
            },
            axes,
            fourth: at(3),
            fifth: at(4),
            input_step_mm: list.input_step_mm(),
            decimal_comma: list.decimal() == Decimal::Comma,
            paraxial_inhibited: list.paraxial_inhibited(),
            inhibited_cycles: (0..=CYCLE_MAX)
                .filter(|cycle| list.cycle_inhibited(u32::from(*cycle)))
                .collect(),
            builder_cycles: Vec::new(),
            iso_step: u32::from(list.operation_parameters().iso_step),
            bytes_max: Program::MAX_BYTES,
        }
    }

    /// The axis of a key. Letters of the alpha keyboard are the axes of this name.
    pub fn axis(&self, key: Key) -> Option<Axis> {
        let lettered = |key: Key| match key.name().as_bytes() {
            [letter] => Axis::from_letter(*letter).filter(|axis| self.axes.contains(*axis)),
            _ => None,
        };
        match key {
            Key::Iv => self.fourth,
            Key::V => self.fifth.or_else(|| lettered(key)),
            _ => lettered(key),
        }
    }

    /// A cycle of the machine builder by its number.
    pub(crate) fn builder_cycle(&self, number: u16) -> Option<&BuilderCycle> {
        self.builder_cycles.iter().find(|cycle| cycle.number == number)
    }

    /// Whether the model has a word or block, by its name in the registry.
    pub(crate) fn has(&self, word: &str) -> bool {
        word.is_empty() || find(self.model, Kind::Word, word).is_some()
    }

    /// The word for rapid traverse: `MAX`, or the feed that means it where there is no such word [001:471].
    pub(crate) fn rapid(&self) -> String {
        let feed = self.model.limits().rapid_feed_mm_min;
        feed.map_or_else(|| "MAX".to_owned(), |feed| feed.to_string())
    }

    /// How fine the numbers of a program may be.
    pub(crate) fn steps(&self, unit: Unit) -> InputSteps {
        InputSteps::of(self.model, unit).not_finer(self.input_step_mm, self.model)
    }

    /// What programs are read for.
    pub(crate) fn reading(&self) -> Reading<'static> {
        self.model.limits().into()
    }
}
