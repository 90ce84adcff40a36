//! MANUAL OPERATION, ELECTRONIC HANDWHEEL, and the reference run before them [003:1031-1145].
//!
//! Decision: DATUM SET stands in a second row of soft keys; INCREMENT in ELECTRONIC HANDWHEEL alone (also
//! `panel/src/pages/datum.rs`)
//!
//! Decision: Where a control has no soft keys, MANUAL goes to the reference marks that were left out when it is pressed
//! in MANUAL OPERATION, ENT begins TEST RUN and GOTO says where it stops, P in the directory gives and takes protection
//! (also `panel/src/console.rs`, `panel/src/pages/test_run.rs`, `panel/src/pages/files.rs`)

use bahn_dialogue::Key;
use bahn_exchange::signal;
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, Window, WindowKind};
use bahn_tnc::{AxisState, Command, Message, Mode};

use crate::page::{Page, Turn, View};
use crate::pages::handwheel::Handwheel;
use crate::pages::number::Number;
use crate::pages::{datum, handwheel, plane, probe, supplementary, table};
use crate::site::Site;

/// Largest jog increment, mm [000:8494-8520].
const JOG_MAX: f64 = 50.0;

/// Axes are moved by hand.
pub(crate) struct ByHand;

/// An axis key highlights its axis, which the PLC sees [000:6425], and asks for its datum; with MP7296 = 1 the soft key alone
/// does that [000:6277-6285].
fn axis(key: Key, site: &mut Site) -> Turn {
    let Some(axis) = datum::axis_of(key, site) else {
        return Turn::Refused;
    };
    site.command(Command::AxisKey(axis));
    match site.parameters().operation_parameters().datums.soft_key_only {
        true => Turn::Done,
        false => datum::of_key(key, site),
    }
}

/// Enters an M function or a speed, when it is one.
fn enter(command: Command, site: &mut Site) -> bool {
    command.can_be_entered(site.control().model()) && site.command(command)
}

impl Page for ByHand {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if site.mode() == Mode::Reference {
            return Turn::Refused;
        }
        match key {
            _ if leads_handwheel(key, site) => {
                let mut page = Handwheel::default();
                match page.key(key, site) {
                    Turn::Done => Turn::Open(Box::new(page)),
                    other => other,
                }
            }
            Key::X | Key::Y | Key::Z | Key::Iv | Key::V => axis(key, site),
            Key::M => self.soft_key(0, 0, site),
            Key::S | Key::ToolCall => self.soft_key(0, 1, site),
            Key::TouchProbe => probe::menu(),
            Key::ToolDef => table::tools(site),
            // The tool table, by simply pressing ENT [003:1897].
            Key::Ent if table::has_tools(site) => table::tools(site),
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        if site.mode() == Mode::Reference {
            return Vec::new();
        }
        let there = |there: bool, text: String| if there { text } else { String::new() };
        let rules = site.parameters().operation_parameters();
        // "Jog increment" is asked in ELECTRONIC HANDWHEEL, where the PLC enables it [000:8496-8499].
        let jogs =
            site.mode() == Mode::Handwheel && site.control().memory().bit(signal::ENABLE_JOG_INCREMENT);
        let first = vec![
            "M".to_owned(),
            "S".to_owned(),
            site.words("TOUCH PROBE"),
            there(jogs, site.words("INCREMENT")),
            site.words("HANDWHEEL"),
            there(rules.tilting, site.words("3D ROT")),
            // Until all axes have passed theirs [000:4581].
            there(
                site.control().first().misses_marks(),
                site.words("PASS OVER REFERENCE"),
            ),
            there(table::has_tools(site), site.words("TOOL TABLE")),
        ];
        vec![first, vec![site.words("DATUM SET")]]
    }

    fn soft_key(&mut self, row: usize, place: usize, site: &mut Site) -> Turn {
        match place {
            0 if row == 1 => datum::page(),
            0 => Turn::Open(Number::ask(
                site.words("MISCELLANEOUS FUNCTION M ="),
                |value, site| {
                    let whole =
                        (value.fract() == 0.0 && (0.0..=999.0).contains(&value)).then_some(value as u16);
                    whole.is_some_and(|m| enter(Command::MFunction(m), site))
                },
            )),
            1 => Turn::Open(Number::ask(site.words("SPINDLE SPEED S ="), |value, site| {
                enter(Command::Speed(value), site)
            })),
            2 => probe::menu(),
            3 => Turn::Open(Number::ask(site.words("JOG-INCREMENT ="), |value, site| {
                (0.0..=JOG_MAX).contains(&value) && site.command(Command::JogIncrement(value))
            })),
            4 => Turn::Open(Box::new(Handwheel::default())),
            5 => plane::menu(),
            6 => match site.command(Command::Mode(Mode::Reference)) {
                true => Turn::Done,
                false => Turn::Refused,
            },
            _ => table::tools(site),
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        if has_just_come_on(site) {
            return View::of(software_numbers(site));
        }
        let asked = match site.mode() {
            Mode::Reference => missing_references(site),
            Mode::Handwheel => factor(site),
            _ => String::new(),
        };
        View {
            window: Some(Window {
                kind: WindowKind::Positions,
                lines: Vec::<Line>::new(),
                ..Window::default()
            }),
            dialogue: Dialogue {
                prompt: asked,
                ..Dialogue::default()
            },
        }
    }
}

/// In ELECTRONIC HANDWHEEL of a control without soft keys axis keys and digits choose axis and factor [001:1059].
fn leads_handwheel(key: Key, site: &Site) -> bool {
    let is_axis = matches!(key, Key::X | Key::Y | Key::Z | Key::Iv);
    let chooses = site.mode() == Mode::Handwheel && !site.control().model().has_soft_keys();
    chooses && (is_axis || key.digit().is_some())
}

/// POWER INTERRUPTED still stands there.
fn has_just_come_on(site: &Site) -> bool {
    let mut shown = site.control().shown().iter();
    shown.any(|shown| shown.message == Message::Plain(MessageId::PowerInterrupted))
}

/// After switch-on the numbers of the NC and PLC software are displayed [000:327].
fn software_numbers(site: &Site) -> Window {
    let numbers = [
        (site.words("NC SOFTWARE NUMBER"), supplementary::nc_number()),
        (site.words("PLC SOFTWARE NUMBER"), supplementary::plc_number(site)),
    ];
    let lines: Vec<Line> = numbers
        .into_iter()
        .map(|(name, number)| Line {
            text: format!("{name}: {number}"),
            ..Line::default()
        })
        .collect();
    Window {
        kind: WindowKind::Text,
        total: lines.len(),
        lines,
        ..Window::default()
    }
}

/// `X: INTERPOLATION FACTOR 3`: what the handwheel moves.
fn factor(site: &Site) -> String {
    let words = site.words("INTERPOLATION FACTOR");
    handwheel::chosen(site).map_or_else(String::new, |(axis, factor)| {
        format!("{}: {words} {factor}", axis.letter())
    })
}

/// `PASS OVER REFERENCE MARK X Y Z`: the axes that have not passed theirs and shall; `REFERENCE POINT X APPROACH` as long
/// as axes are backed off their cams first [001:993-995].
fn missing_references(site: &Site) -> String {
    let snapshot = site.control().snapshot();
    let letters = |named: fn(&&AxisState) -> bool| {
        let axes = snapshot.axes.iter().filter(named);
        axes.map(|axis| axis.letter.to_string()).collect::<Vec<_>>()
    };
    let on_cams = letters(|axis| axis.backs_off);
    match on_cams.is_empty() {
        true => {
            let missing = letters(|axis| axis.mark_wanted).join(" ");
            format!("{} {missing}", site.words("PASS OVER REFERENCE MARK"))
        }
        false => site
            .words("REFERENCE POINT {} APPROACH")
            .replace("{}", &on_cams.join("/")),
    }
}
