//! MOD: supplementary functions, of PROGRAMMING and TEST RUN and of the machine operating modes [003:6980-7160].
//!
//! Decision: CODE NUMBER stands in both MOD menus; 531 210 asks before it erases; machine times are kept in whole
//! minutes

mod axis_limit;
mod code;
mod offsets;
mod oscilloscope;
mod timers;

use std::time::{SystemTime, UNIX_EPOCH};

use bahn_dialogue::Key;
use bahn_screen::texts::{self, Language};

use crate::page::{Overlay, Page, Side, Turn};
use crate::pages::ask::Name;
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::{help, interface, parameters, plc};
use crate::settings::PositionType;
use crate::site::Site;

/// Axes that an L block takes over at most [003:7104-7113].
const CAPTURED_AXES: usize = 3;

/// A function of the menu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    PositionDisplay,
    Unit,
    Input,
    Language,
    /// Of a traverse range, 1 to 3.
    AxisLimit(u8),
    CapturedAxes,
    UserParameters,
    NcNumber,
    PlcNumber,
    Code,
    /// PLC EDIT: without the code number, once it was entered [000:11195-11197].
    Plc,
    /// OSZI: the oscilloscope without its code number, once it was entered [000:18674-18675].
    Oscilloscope,
    Help,
    /// Modes and baud rates of both interfaces [000:17216-17218].
    Interfaces,
}

/// Functions of the machine operating modes.
const MACHINE: &[Function] = &[
    Function::PositionDisplay,
    Function::Unit,
    Function::Input,
    Function::Language,
    Function::AxisLimit(1),
    Function::AxisLimit(2),
    Function::AxisLimit(3),
    Function::CapturedAxes,
    Function::NcNumber,
    Function::PlcNumber,
    Function::Code,
    Function::Help,
    Function::Plc,
    Function::Oscilloscope,
];

/// Functions of PROGRAMMING and TEST RUN.
const PROGRAMMING: &[Function] = &[
    Function::Code,
    Function::UserParameters,
    Function::CapturedAxes,
    Function::Interfaces,
    Function::Language,
    Function::NcNumber,
    Function::PlcNumber,
    Function::Help,
    Function::Plc,
    Function::Oscilloscope,
];

/// Those that a soft key opens, too, once their code number was entered.
const SOFT_KEYS: [Function; 2] = [Function::Plc, Function::Oscilloscope];

/// The menu of a side.
pub(crate) fn menu(side: Side) -> Box<dyn Page> {
    let functions = match side {
        Side::Machine => MACHINE,
        Side::Programming => PROGRAMMING,
    };
    Box::new(Menu::new(Supplementary { functions }))
}

struct Supplementary {
    functions: &'static [Function],
}

impl Supplementary {
    fn functions(&self, site: &Site) -> impl Iterator<Item = Function> + use<> {
        let (plc, oscilloscope) = (site.plc.entered, site.control().oscilloscope().open);
        let all = self.functions.iter().copied();
        let ranges = site.parameters().operation_parameters().datums.ranges;
        let helps = help::is_there(site);
        let operator_chooses = site.parameters().operation_parameters().iso_programs.is_none();
        all.filter(move |function| match function {
            Function::Plc => plc,
            Function::Oscilloscope => oscilloscope,
            // MP7490: one traverse range or three [000:3499-3508].
            Function::AxisLimit(range) => *range <= ranges,
            // Where there is a help file [000:7044].
            Function::Help => helps,
            // MP217 says it on a TNC 151/155 [001:1653].
            Function::Input => operator_chooses,
            _ => true,
        })
    }
}

impl Items for Supplementary {
    fn title(&self, site: &Site) -> String {
        site.words("SUPPLEMENTARY FUNCTIONS")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let functions = self.functions(site);
        functions.map(|function| function.item(site)).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        let function = self.functions(site).nth(place);
        function.map_or(Turn::Refused, |function| function.choose(true, site))
    }

    fn overlay(&self) -> Overlay {
        Overlay::Mode
    }

    fn own_keys(&self, site: &Site) -> [&'static str; 6] {
        let offered = |function: Function| match self.functions(site).any(|own| own == function) {
            true => function.code_name(),
            false => "",
        };
        let [plc, oscilloscope] = SOFT_KEYS.map(offered);
        [plc, oscilloscope, "", "", "", ""]
    }

    fn own_key(&mut self, name: &str, _place: usize, site: &mut Site) -> Turn {
        let function = SOFT_KEYS
            .into_iter()
            .find(|function| function.code_name() == name);
        function.map_or(Turn::Refused, |function| function.choose(true, site))
    }

    fn key(&mut self, place: usize, key: Key, site: &mut Site) -> Turn {
        match (self.functions(site).nth(place), key) {
            (Some(Function::CapturedAxes), Key::X | Key::Y | Key::Z | Key::Iv | Key::V) => {
                toggle_axis(key, site)
            }
            (Some(function), Key::Right) if function.is_switch() => function.choose(true, site),
            (Some(function), Key::Left) if function.is_switch() => function.choose(false, site),
            _ => Turn::Refused,
        }
    }
}

impl Function {
    fn item(self, site: &Site) -> Item {
        let settings = &*site.settings;
        match self {
            Function::PositionDisplay => Item::new(
                site.words("POSITION DISPLAY"),
                site.words(settings.position_type.name()),
            ),
            Function::Unit => Item::new(
                site.words("CHANGE MM/INCH"),
                if settings.inch { "INCH" } else { "MM" },
            ),
            Function::Input => {
                let language = if settings.iso { "ISO" } else { "HEIDENHAIN" };
                Item::new(site.words("PROGRAM INPUT"), language)
            }
            Function::Language => Item::new(site.words("DIALOGUE LANGUAGE"), site.words("ENGLISH")),
            Function::AxisLimit(range) => Item::new(format!("{} {range}", site.words("AXIS LIMIT")), ""),
            Function::CapturedAxes => {
                Item::new(site.words("AXES FOR L BLOCK"), settings.captured_axes.clone())
            }
            Function::UserParameters => Item::new(site.words("USER PARAMETERS"), ""),
            Function::NcNumber => Item::new(site.words("NC SOFTWARE NUMBER"), nc_number()),
            Function::PlcNumber => Item::new(site.words("PLC SOFTWARE NUMBER"), plc_number(site)),
            Function::Plc | Function::Oscilloscope => Item::new(site.words(self.code_name()), ""),
            Function::Code => Item::new(site.words("CODE NUMBER"), ""),
            Function::Help => Item::new(site.words("HELP"), ""),
            Function::Interfaces => Item::new(site.words("DATA INTERFACES"), ""),
        }
    }

    /// The name of a function that its code number has opened.
    fn code_name(self) -> &'static str {
        match self {
            Function::Oscilloscope => "OSZI",
            _ => "PLC EDIT",
        }
    }

    /// ENT and RIGHT go to the next setting, LEFT back.
    fn is_switch(self) -> bool {
        use Function::{Input, Language, PositionDisplay, Unit};
        matches!(self, PositionDisplay | Unit | Input | Language)
    }

    fn choose(self, on: bool, site: &mut Site) -> Turn {
        match self {
            Function::PositionDisplay => {
                site.settings.position_type = next_type(site.settings.position_type, on);
            }
            Function::Unit => site.settings.inch = !site.settings.inch,
            Function::Input => site.settings.iso = !site.settings.iso,
            Function::Language => {
                let other = match site.language() {
                    Language::English => Language::German,
                    Language::German => Language::English,
                };
                site.settings.language = Some(texts::language_code(other).to_owned());
            }
            Function::AxisLimit(range) => return Turn::Open(axis_limit::page(range)),
            Function::CapturedAxes => return ask_axes(site),
            Function::UserParameters => return parameters::user(site),
            Function::Code => return code::ask(site),
            Function::Plc => return plc::open(site),
            Function::Oscilloscope => return oscilloscope::open(),
            Function::Help => return help::files(site),
            Function::Interfaces => return Turn::Open(interface::page()),
            Function::NcNumber | Function::PlcNumber => return Turn::Refused,
        }
        Turn::Done
    }
}

/// The next type of positions, or the one before.
fn next_type(shown: PositionType, on: bool) -> PositionType {
    let all = PositionType::ALL;
    let at = all.iter().position(|own| *own == shown).unwrap_or(0);
    let next = (at + if on { 1 } else { all.len() - 1 }) % all.len();
    all.get(next).copied().unwrap_or_default()
}

/// An axis key takes its axis into the L block, or out of it.
fn toggle_axis(key: Key, site: &mut Site) -> Turn {
    let place = [Key::X, Key::Y, Key::Z, Key::Iv, Key::V]
        .iter()
        .position(|own| *own == key);
    let Some(axis) = place.and_then(|place| site.axis_of_key(place)) else {
        return Turn::Refused;
    };
    let mut axes = site.settings.captured_axes.clone();
    match axes.find(axis.letter()) {
        Some(at) => drop(axes.remove(at)),
        None if axes.len() < CAPTURED_AXES => axes.push(axis.letter()),
        None => return Turn::Refused,
    }
    site.settings.captured_axes = axes;
    Turn::Done
}

fn ask_axes(site: &Site) -> Turn {
    let prompt = format!("{} =", site.words("AXES FOR L BLOCK"));
    Turn::Open(Name::ask(prompt, CAPTURED_AXES, |letters, site| {
        let known: Vec<char> = site.control().axis_letters().collect();
        let once = |letter: char| letters.matches(letter).count() == 1;
        match letters
            .chars()
            .all(|letter| known.contains(&letter) && once(letter))
        {
            true => {
                site.settings.captured_axes = letters;
                Turn::Close
            }
            false => Turn::Say(site.message(bahn_parameters::MessageId::EntryValueIncorrect)),
        }
    }))
}

/// Number of the NC software.
pub(crate) fn nc_number() -> String {
    format!("BAHN {}", env!("CARGO_PKG_VERSION"))
}

/// Name of the PLC program that runs and the day on which it was written.
pub(crate) fn plc_number(site: &Site) -> String {
    let main = site.control().plc().program().files.first();
    let file = main.map_or("", |main| main.name.as_str());
    let path = site
        .machine
        .root
        .join(&site.machine.folder.plc)
        .with_file_name(file);
    let written = std::fs::metadata(path).and_then(|file| file.modified());
    match written {
        Ok(written) => format!("{file} {}", day(written)),
        Err(_) => file.to_owned(),
    }
}

/// A day as `2026-05-17`, of the universal time.
fn day(time: SystemTime) -> String {
    const DAY_S: u64 = 86_400;
    let seconds = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    // Days from 1 March of year 0, in eras of 400 years.
    let days = seconds / DAY_S + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = year + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn days() {
        for (seconds, expected) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_767_225_599, "2025-12-31"),
        ] {
            assert_eq!(day(UNIX_EPOCH + Duration::from_secs(seconds)), expected);
        }
    }
}
