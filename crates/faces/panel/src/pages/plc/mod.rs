//! The PLC mode after code number 807 667: EDIT, TABLE, TRACE, COMPILE [000:11187-11480].
//!
//! Decision: The PLC mode (807 667) is of TNC 407, 415 and 425; elsewhere its number is an incorrect entry. What
//! COMPILE made runs from the next power-on or reset, not at once: the machine stands then. COMPILE of any file
//! without errors gives it the status M: machine.toml names it as the main file from then on. Whoever goes back finds
//! the program of then (also `host/src/host.rs`)

mod binary;
mod code;
mod compile;
mod convert;
mod diagram;
mod editor;
mod files;
mod form;
mod keys;
mod operands;
mod source;
mod texts;

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_screen::{Line, Window, WindowKind};

use crate::page::{Overlay, Page, Turn, View};
use crate::pages::external;
use crate::pages::{list, parameters};
use crate::site::Site;

/// The code number opens the mode until power-off; controls without it have no PLC that could be programmed.
pub(crate) fn open(site: &mut Site) -> Turn {
    if !site.control().model().has_plc_mode() {
        return Turn::Say(site.message(MessageId::EntryValueIncorrect));
    }
    site.plc.entered = true;
    Turn::Open(Box::new(MainMenu))
}

/// Soft keys of the main menu.
const SOFT_KEYS: [&str; 8] = [
    "EDIT",
    "TABLE",
    "TRACE",
    "COMPILE",
    "OUTPUT BINARY CODE",
    "SELECT .DI1/.ER1",
    "MP EDIT",
    "END",
];

/// Main menu of the PLC mode [000:11203-11241].
struct MainMenu;

impl MainMenu {
    fn lines(site: &Site) -> [String; 5] {
        let plc = site.control().plc();
        let time = plc.time();
        let bytes = plc.program().size_bytes;
        let runtime = plc.program().files.first().map_or("", |file| file.name.as_str());
        let edited = site.plc.edited.as_deref().unwrap_or_default();
        [
            format!(
                "{:<17}{:<9}{:>4.0} %",
                site.words("PROCESSING TIME:"),
                site.words("MAXIMUM"),
                time.maximum_percent()
            ),
            format!(
                "{:<17}{:<9}{:>4.0} %",
                "",
                site.words("CURRENT"),
                time.current_percent()
            ),
            format!(
                "{:<17}{:>13} KBYTE",
                site.words("CODE LENGTH"),
                bytes.div_ceil(1024)
            ),
            format!("{:<17}{runtime}", site.words("RUNTIME PGM")),
            format!("{:<17}{edited}", site.words("EDITOR PGM")),
        ]
    }
}

impl Page for MainMenu {
    fn overlay(&self) -> Overlay {
        Overlay::Plc
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::PgmNr => files::open(site),
            Key::Ext => external::of(source::FILES, site),
            Key::End | Key::Del | Key::NoEnt => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![list::soft_keys(&SOFT_KEYS, site)]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match list::name_at(&SOFT_KEYS, place) {
            "EDIT" => files::open(site),
            "TABLE" => Turn::Open(Box::new(operands::Table::default())),
            "TRACE" => Turn::Open(Box::new(code::Code::new(site))),
            "COMPILE" => compile::open(site),
            "OUTPUT BINARY CODE" => binary::open(site),
            "SELECT .DI1/.ER1" => texts::open(site),
            "MP EDIT" => parameters::all(site),
            _ => Turn::Close,
        }
    }

    fn show(&self, site: &Site, _lines: usize) -> View {
        let mut lines: Vec<String> = MainMenu::lines(site).to_vec();
        if let Some(program) = &site.plc.compiled {
            let name = program.files.first().map_or("", |file| file.name.as_str());
            lines.push(format!(
                "{name}: {}",
                site.words("COMPILED, RUNS FROM THE NEXT POWER-ON")
            ));
        }
        if let Some(error) = site.control().plc().stopped() {
            lines.push(error.to_string());
        }
        View::of(window(site.words("PLC PROGRAMMING"), lines))
    }
}

/// A window of lines without a cursor.
fn window(title: String, lines: Vec<String>) -> Window {
    let line = |text| Line {
        text,
        ..Line::default()
    };
    Window {
        title,
        kind: WindowKind::Text,
        total: lines.len(),
        lines: lines.into_iter().map(line).collect(),
        first: 0,
    }
}
