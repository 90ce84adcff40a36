//! The data interfaces: which device is connected to each, how fast it is, and which of both a transfer takes
//! [000:16975-16995] [000:17216-17228] [003:7035-7062].
//!
//! What is chosen here is kept; the key EXT begins a transfer with it.

use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_parameters::interfaces::{BAUD_RATES, rates_exclude_each_other};

use crate::page::{Page, Turn};
use crate::pages::backup;
use crate::pages::menu::{Item, Items, Menu};
use crate::pages::number::Number;
use crate::pages::order::{baud, is_inhibited};
use crate::settings::{Interface, InterfaceMode, TransferOf};
use crate::site::Site;

/// Soft keys of the machine parameter editor.
const BACKUP: &str = "BACKUP DATA";
const RESTORE: &str = "RESTORE DATA";
/// Names of the interfaces.
const PORTS: [&str; 2] = ["RS-232", "RS-422"];
/// A line of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Row {
    /// Mode of operation of an interface.
    Mode(usize),
    /// Data transfer rate of an interface, baud.
    Baud(usize),
    /// The interface of a kind of transfer.
    Assigned(TransferOf),
    /// What the parameters say of EXT1 and EXT2.
    Ext(usize),
}

/// RS-232/RS-422 SETUP of the MOD function.
pub(crate) fn page() -> Box<dyn Page> {
    Box::new(Menu::new(Interfaces { backs_up: false }))
}

/// The page with BACKUP DATA and RESTORE DATA, of the machine parameter editor [000:465].
pub(crate) fn with_backup() -> Box<dyn Page> {
    Box::new(Menu::new(Interfaces { backs_up: true }))
}

struct Interfaces {
    backs_up: bool,
}

/// The lines of a control: one with a single interface assigns nothing, and its EXT is EXT1.
fn rows(site: &Site) -> Vec<Row> {
    use Row::{Assigned, Baud, Ext, Mode};
    match site.control().model().has_rs_422() {
        true => vec![
            Mode(0),
            Baud(0),
            Mode(1),
            Baud(1),
            Assigned(TransferOf::Files),
            Assigned(TransferOf::ProgramRun),
            Ext(0),
            Ext(1),
        ],
        false => vec![Baud(0), Mode(0), Ext(0)],
    }
}

/// `8E1 DC3 STANDARD`: data bits, parity and stop bits (MP5020), what stops the transfer, and its protocol (MP5030)
/// [000:17073-17105].
fn format(ext: usize, site: &Site) -> String {
    let formats = site.parameters().interface_parameters().formats;
    let Some(format) = formats.get(ext) else {
        return String::new();
    };
    let parity = match format.odd {
        None => 'N',
        Some(false) => 'E',
        Some(true) => 'O',
    };
    let rts = if format.stop_by_rts { " RTS" } else { "" };
    let dc3 = if format.stop_by_dc3 { " DC3" } else { "" };
    let protocol = match format.blockwise {
        true => site.words("BLOCKWISE"),
        false => site.words("STANDARD"),
    };
    let stop = f64::from(format.half_stop_bits) / 2.0;
    format!("{}{parity}{stop}{rts}{dc3} {protocol}", format.data_bits)
}

impl Items for Interfaces {
    fn title(&self, site: &Site) -> String {
        site.words("DATA INTERFACES")
    }

    fn items(&self, site: &Site) -> Vec<Item> {
        let single = !site.control().model().has_rs_422();
        let name = |port: usize| PORTS.get(port).copied().unwrap_or_default();
        let item = |row: &Row| match *row {
            Row::Mode(port) => {
                let mode = site.settings.interfaces.get(port).map(|own| own.mode);
                let value = match is_inhibited(port, site) {
                    true => site.words("INHIBITED (MP5000)"),
                    false => mode.unwrap_or_default().name(single).to_owned(),
                };
                Item::new(format!("{} {}", name(port), site.words("INTERFACE")), value)
            }
            Row::Baud(port) => Item::new(
                format!("{} {}", name(port), site.words("BAUD RATE")),
                baud(port, site).to_string(),
            ),
            Row::Assigned(transfer) => {
                let words = match transfer {
                    TransferOf::Files => site.words("ASSIGNMENT: FILES"),
                    TransferOf::ProgramRun => site.words("ASSIGNMENT: PROGRAM RUN"),
                };
                Item::new(words, name(site.settings.assigned_port(transfer)))
            }
            Row::Ext(ext) => Item::new(
                format!("EXT{} (MP5020.{ext}, MP5030.{ext})", ext + 1),
                format(ext, site),
            ),
        };
        rows(site).iter().map(item).collect()
    }

    fn choose(&mut self, place: usize, site: &mut Site) -> Turn {
        change(place, true, site)
    }

    fn own_keys(&self, _site: &Site) -> [&'static str; 6] {
        match self.backs_up {
            true => [BACKUP, RESTORE, "", "", "", ""],
            false => [""; 6],
        }
    }

    fn own_key(&mut self, name: &str, _place: usize, site: &mut Site) -> Turn {
        match name {
            BACKUP => backup::save(site),
            RESTORE => backup::ask_to_restore(site),
            _ => Turn::Refused,
        }
    }

    /// ENT and RIGHT go to the next setting, LEFT back.
    fn key(&mut self, place: usize, key: Key, site: &mut Site) -> Turn {
        match key {
            Key::Right => change(place, true, site),
            Key::Left => change(place, false, site),
            key if key.digit().is_some() => enter_baud(place, key, site),
            _ => Turn::Refused,
        }
    }
}

/// A baud rate is entered with the numerical keys [003:7048].
fn enter_baud(place: usize, digit: Key, site: &mut Site) -> Turn {
    let Some(Row::Baud(port)) = rows(site).get(place).copied() else {
        return Turn::Refused;
    };
    let own = site.settings.interfaces.get(port).copied().unwrap_or_default();
    if is_inhibited(port, site) || own.mode == InterfaceMode::Me {
        return Turn::Refused;
    }
    let ask = Number::turning(format!("{} =", site.words("BAUD RATE")), move |value, site| {
        let mut rates = rates(site).iter().copied();
        let Some(baud) = rates.find(|rate| f64::from(*rate) == value) else {
            return Turn::Say(site.message(MessageId::EntryValueIncorrect));
        };
        match take(port, Interface { baud, ..own }, site) {
            Turn::Done => Turn::Close,
            turn => turn,
        }
    });
    Turn::Open(ask.beginning(digit))
}

/// Goes to the next setting of a line, or the one before.
fn change(place: usize, on: bool, site: &mut Site) -> Turn {
    let Some(row) = rows(site).get(place).copied() else {
        return Turn::Refused;
    };
    match row {
        Row::Mode(port) | Row::Baud(port) if is_inhibited(port, site) => Turn::Refused,
        Row::Mode(port) => change_mode(port, on, site),
        Row::Baud(port) => change_baud(port, on, site),
        Row::Assigned(transfer) => {
            site.settings.swap_port(transfer);
            Turn::Done
        }
        Row::Ext(_) => Turn::Refused,
    }
}

fn change_mode(port: usize, on: bool, site: &mut Site) -> Turn {
    let own = site.settings.interfaces.get(port).copied().unwrap_or_default();
    let mode = neighbour(InterfaceMode::all(site.control().model()), own.mode, on);
    take(port, Interface { mode, ..own }, site)
}

fn change_baud(port: usize, on: bool, site: &mut Site) -> Turn {
    let own = site.settings.interfaces.get(port).copied().unwrap_or_default();
    if own.mode == InterfaceMode::Me {
        return Turn::Refused;
    }
    let baud = neighbour(rates(site), own.baud, on);
    take(port, Interface { baud, ..own }, site)
}

/// Takes a setting, unless the other interface excludes its baud rate.
fn take(port: usize, wanted: Interface, site: &mut Site) -> Turn {
    let before = site.settings.interfaces;
    if let Some(own) = site.settings.interfaces.get_mut(port) {
        *own = wanted;
    }
    if excludes(site) {
        site.settings.interfaces = before;
        return Turn::Say(site.message(MessageId::BaudRateNotPossible));
    }
    Turn::Done
}

/// Whether the interfaces cannot have the baud rates that they have.
fn excludes(site: &Site) -> bool {
    rates_exclude_each_other(baud(0, site), baud(1, site)) && site.control().model().has_rs_422()
}

/// Baud rates that the control has.
fn rates(site: &Site) -> &'static [u32] {
    let most = site.control().model().limits().baud_rate_max;
    let count = BAUD_RATES.iter().take_while(|rate| **rate <= most).count();
    BAUD_RATES.get(..count).unwrap_or(&BAUD_RATES)
}

/// The next one of all, or the one before; after the last comes the first.
fn neighbour<T: Copy + PartialEq + Default>(all: &[T], own: T, on: bool) -> T {
    let at = all.iter().position(|other| *other == own).unwrap_or(0);
    let next = (at + if on { 1 } else { all.len() - 1 }) % all.len().max(1);
    all.get(next).copied().unwrap_or_default()
}
