//! Names in a script that the channel must have.
//!
//! Decision: A script with errors is used for nothing, and one that names what the channel does not have is in error;
//! of a faulty program what stands before is executed (also `bahn/src/technology/mod.rs`)

use bahn_path::Axis;
use bahn_text::Diagnostic;
use bahn_text::nearest;

use crate::settings::{ChannelSettings, SPINDLE_M};

/// A name that stands somewhere in a script.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Said {
    /// The error that it is, still without its words.
    place: Diagnostic,
    named: Named,
}

/// What is named, in capitals.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Named {
    /// Range, empty for all, and function.
    Function(String, String),
    Spindle(String),
}

impl Said {
    pub(super) fn new(place: Diagnostic, named: Named) -> Said {
        Said { place, named }
    }

    /// What is wrong with it where the channel is set so.
    pub(super) fn unknown(
        &self,
        settings: &ChannelSettings,
        typed: &impl Fn(&str) -> bool,
    ) -> Option<Diagnostic> {
        let (message, near) = match &self.named {
            Named::Spindle(name) => spindle(settings, name)?,
            Named::Function(range, _) if !range.is_empty() && !is_range(settings, range) => {
                let (_, near) = spindle(settings, range)?;
                (format!("no axis and no spindle is called {range}"), near)
            }
            Named::Function(_, label) if is_function(settings, label) || typed(label) => return None,
            Named::Function(_, label) => {
                let known = functions(settings);
                let near = nearest(label, known.iter().map(String::as_str)).map(str::to_owned);
                (
                    format!("{label} has no synchronisation type: it is never output"),
                    near,
                )
            }
        };
        Some(Diagnostic {
            message,
            help: near.map(|name| format!("did you mean `{name}`?")),
            ..self.place.clone()
        })
    }
}

/// What is wrong with the name of a spindle.
fn spindle(settings: &ChannelSettings, name: &str) -> Option<(String, Option<String>)> {
    if settings.spindle_called(name).is_some() {
        return None;
    }
    let known = settings
        .spindles
        .iter()
        .map(|(index, spindle)| spindle.name(*index));
    let known: Vec<String> = known.collect();
    let near = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
    Some((format!("no spindle is called {name}"), near))
}

fn is_range(settings: &ChannelSettings, name: &str) -> bool {
    let axis = match name.as_bytes() {
        [letter] => Axis::from_letter(*letter).is_some(),
        _ => false,
    };
    axis || name == "CHANNEL" || settings.spindle_called(name).is_some()
}

/// Whether a function is ever output, as far as the list says.
fn is_function(settings: &ChannelSettings, label: &str) -> bool {
    let number: Option<u32> = label.get(1..).and_then(|digits| digits.parse().ok());
    let table = match (label.as_bytes().first(), number) {
        (Some(b'M'), Some(number)) if SPINDLE_M.contains(&number) && !settings.spindle_m_free => return true,
        (Some(b'M'), _) => &settings.m,
        (Some(b'H'), _) => &settings.h,
        _ => return true,
    };
    let own = number.and_then(|number| table.get(number));
    own.is_some_and(|own| own.synch.is_some())
}

/// All functions that the list gives a type.
fn functions(settings: &ChannelSettings) -> Vec<String> {
    let of = |letter: char, table: &crate::settings::FunctionTable| -> Vec<String> {
        let typed = table
            .iter()
            .filter(|(_, own)| own.synch.is_some_and(|synch| synch.bits() != 0));
        typed.map(|(number, _)| format!("{letter}{number}")).collect()
    };
    let mut all = of('M', &settings.m);
    all.extend(of('H', &settings.h));
    all
}
