//! Lists to choose from: cycles, probe functions, functions of Q parameters.

use bahn_parameters::MessageId::{self, EntryValueIncorrect, KeyNonFunctional};
use bahn_parameters::conformance::{Kind, find};
use bahn_program::{CYCLES, CycleFunction};

use crate::blocks::{BLOCKS, block_row};
use crate::dialogue::{Dialogue, Source};
use crate::prompt::text_of;
use crate::{Key, OEM_CYCLES, Setting};

/// Most digits of a number.
const DIGITS_MAX: usize = 3;

/// Which list it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MenuKind {
    Cycles,
    Probes,
    Functions,
}

/// A line of a list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MenuItem {
    number: Option<u16>,
    pub(crate) text: String,
    source: Source,
}

/// An open list of soft keys or cycles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Menu {
    pub(crate) kind: MenuKind,
    pub(crate) items: Vec<MenuItem>,
    pub(crate) at: usize,
    /// The number as far as it was entered.
    pub(crate) typed: String,
}

/// What becomes of a list.
pub(crate) enum Choice {
    Stay,
    Close,
    Open(Box<Dialogue>),
}

impl Menu {
    pub(crate) fn new(kind: MenuKind, setting: &Setting) -> Menu {
        let items = match kind {
            MenuKind::Cycles => cycles(CycleFunction::Definition, setting),
            MenuKind::Probes => cycles(CycleFunction::Probe, setting),
            MenuKind::Functions => functions(setting),
        };
        Menu {
            kind,
            items,
            at: 0,
            typed: String::new(),
        }
    }

    pub(crate) fn prompt(&self) -> &'static str {
        match self.kind {
            MenuKind::Cycles => "cycles",
            MenuKind::Probes => "probes",
            MenuKind::Functions => "functions",
        }
    }

    pub(crate) fn key(&mut self, key: Key, setting: &Setting) -> Result<Choice, MessageId> {
        match key {
            Key::Up => self.at = self.at.saturating_sub(1),
            Key::Down => self.at = (self.at + 1).min(self.items.len().saturating_sub(1)),
            // GOTO and a number, or the number alone [003:4822-4829].
            Key::Goto | Key::Ce => self.typed.clear(),
            Key::Ent => {
                return self
                    .chosen(setting)
                    .map(|dialogue| Choice::Open(Box::new(dialogue)));
            }
            Key::NoEnt | Key::End | Key::Del => return Ok(Choice::Close),
            _ => {
                let digit = key.digit().and(key.character()).ok_or(KeyNonFunctional)?;
                if self.typed.len() >= DIGITS_MAX {
                    return Err(EntryValueIncorrect);
                }
                self.typed.push(digit);
                self.show_typed();
            }
        }
        Ok(Choice::Stay)
    }

    /// The line of the number that was entered is marked.
    fn show_typed(&mut self) {
        let number = self.typed.parse::<u16>().ok();
        let found = self
            .items
            .iter()
            .position(|item| number.is_some() && item.number == number);
        self.at = found.unwrap_or(self.at);
    }

    fn chosen(&self, setting: &Setting) -> Result<Dialogue, MessageId> {
        if self.typed.is_empty() {
            let item = self.items.get(self.at).ok_or(KeyNonFunctional)?;
            return Ok(Dialogue::new(item.source, setting));
        }
        let number = self.typed.parse::<u16>().map_err(|_| EntryValueIncorrect)?;
        if let Some(item) = self.items.iter().find(|item| item.number == Some(number)) {
            return Ok(Dialogue::new(item.source, setting));
        }
        match self.kind {
            MenuKind::Cycles if OEM_CYCLES.contains(&number) => Ok(Dialogue::new(
                Source::Cycle(CycleFunction::Definition, number),
                setting,
            )),
            _ => Err(EntryValueIncorrect),
        }
    }
}

/// The cycles of the model that the machine builder has not inhibited, in the order of their numbers.
fn cycles(function: CycleFunction, setting: &Setting) -> Vec<MenuItem> {
    let limits = setting.model.limits();
    let exists = |number: u16| match function {
        CycleFunction::Definition => {
            limits.has_cycle(u32::from(number)) && !setting.inhibited_cycles.contains(&number)
        }
        CycleFunction::Probe => find(setting.model, Kind::Cycle, &format!("TCH PROBE {number}")).is_some(),
    };
    let all = CYCLES
        .iter()
        .filter(|cycle| cycle.function == function && exists(cycle.number));
    let mut items: Vec<_> = all
        .map(|cycle| {
            let kind = match function {
                CycleFunction::Definition => "DEF",
                CycleFunction::Probe => "PROBE",
            };
            let name = crate::prompt::prompt(&format!("{kind} {}", cycle.number));
            let name = name.map_or(cycle.name, |name| name.text(setting.tongue));
            MenuItem {
                number: Some(cycle.number),
                text: format!("{} {name}", cycle.number),
                source: Source::Cycle(function, cycle.number),
            }
        })
        .collect();
    if function == CycleFunction::Definition {
        items.extend(setting.builder_cycles.iter().map(|cycle| MenuItem {
            number: Some(cycle.number),
            text: format!("{} {}", cycle.number, cycle.name),
            source: Source::Cycle(function, cycle.number),
        }));
    }
    items.sort_by_key(|item| item.number);
    items
}

/// The functions of Q parameters that the model has.
fn functions(setting: &Setting) -> Vec<MenuItem> {
    let limits = setting.model.limits();
    let numbered = BLOCKS.iter().filter_map(|row| {
        let number = row.id.strip_prefix("FN ")?.parse::<u16>().ok()?;
        limits.has_fn(u32::from(number)).then(|| MenuItem {
            number: Some(number),
            text: format!("{}: {}", row.id, text_of(row.id, setting.tongue)),
            source: Source::Row(row),
        })
    });
    let formula = block_row("FORMULA").filter(|_| limits.formulas);
    let formula = formula.map(|row| MenuItem {
        number: None,
        text: text_of("FN FORMULA", setting.tongue).to_owned(),
        source: Source::Row(row),
    });
    numbered.chain(formula).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use bahn_parameters::{ControlModel, ParameterList};

    use super::*;
    use crate::cycles::cycle_lines;
    use crate::prompt::{prompt, prompts};
    use crate::soft_keys;

    /// Ids of all questions that can be asked.
    fn asked() -> BTreeSet<&'static str> {
        let slots = BLOCKS
            .iter()
            .flat_map(|row| row.lines)
            .flat_map(|line| line.slots);
        let mut ids: BTreeSet<&'static str> = slots.map(|slot| slot.prompt).collect();
        let setting = Setting::of(&ParameterList::reference(ControlModel::Tnc425));
        for cycle in CYCLES {
            for line in cycle_lines(cycle.function, cycle.number, &setting) {
                ids.extend(line.fields().iter().map(|field| field.slot.prompt));
            }
        }
        ids
    }

    #[test]
    fn every_text_is_there_and_is_used() {
        let mut used = asked();
        for id in &used {
            assert!(prompt(id).is_some(), "{id} has no text");
        }
        used.extend([
            "cycles",
            "probes",
            "functions",
            "goto",
            "find",
            "comment",
            "iso",
            "FN FORMULA",
            "parameter",
            "parameters",
        ]);
        let mut unused = Vec::new();
        for row in prompts() {
            let id = row.id();
            let of_cycle = |prefix, function| {
                let number = id
                    .strip_prefix(prefix)
                    .and_then(|number: &str| number.parse::<u16>().ok());
                number.is_some_and(|number| bahn_program::cycle(function, number).is_some())
            };
            let listed = of_cycle("DEF ", CycleFunction::Definition)
                || of_cycle("PROBE ", CycleFunction::Probe)
                || (id.starts_with("FN ") && block_row(id).is_some())
                || id.starts_with("soft ");
            if !used.contains(id) && !listed {
                unused.push(id);
            }
        }
        assert!(unused.is_empty(), "never shown: {unused:?}");
        for cycle in CYCLES {
            let kind = if cycle.function == CycleFunction::Probe {
                "PROBE"
            } else {
                "DEF"
            };
            assert!(
                prompt(&format!("{kind} {}", cycle.number)).is_some(),
                "{}",
                cycle.name
            );
        }
    }

    #[test]
    fn lists_and_soft_keys_have_texts_in_both_languages() {
        for tongue in [crate::Tongue::English, crate::Tongue::German] {
            let mut setting = Setting::of(&ParameterList::reference(ControlModel::Tnc425));
            setting.tongue = tongue;
            for kind in [MenuKind::Cycles, MenuKind::Probes, MenuKind::Functions] {
                let menu = Menu::new(kind, &setting);
                assert_ne!(text_of(menu.prompt(), tongue), menu.prompt());
                assert!(
                    menu.items.iter().all(|item| !item.text.ends_with(": ")),
                    "{:?}",
                    menu.items
                );
            }
            for (label, _) in soft_keys::of_program(false, true, tongue)
                .into_iter()
                .chain(soft_keys::of_program(true, true, tongue))
            {
                assert!(!label.starts_with("soft"), "{label}");
            }
        }
    }
}
