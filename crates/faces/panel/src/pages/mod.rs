//! The pages: operating modes below, menus, tables and questions that stand on them.

mod ask;
mod axis_errors;
mod backup;
mod by_hand;
mod datum;
mod description;
mod editing;
mod external;
mod files;
mod handwheel;
mod help;
mod interface;
mod list;
mod mdi;
mod menu;
mod no_program;
mod number;
mod order;
mod parameters;
mod plane;
mod plc;
mod probe;
mod programming;
mod q_parameters;
mod row_after;
mod run;
mod supplementary;
mod table;
mod test_run;
mod transfer;

use bahn_dialogue::Key;
use bahn_parameters::ControlModel;
use bahn_tnc::Mode;

use crate::page::{Page, Side, Turn};
use crate::site::Site;

pub(crate) use backup::{ended as backup_ended, everything, restored};
pub(crate) use files::{is_needed, runs};
pub(crate) use help::follow as follow_help;
pub(crate) use parameters::{commission, is_erased};

use no_program::no_program;

/// The page of a machine operating mode.
pub(crate) fn of_mode(mode: Mode, model: ControlModel) -> Box<dyn Page> {
    match mode {
        Mode::Manual | Mode::Handwheel | Mode::Reference => Box::new(by_hand::ByHand),
        Mode::Mdi => Box::new(mdi::Mdi::default()),
        Mode::SingleBlock | Mode::FullSequence => Box::new(run::ProgramRun::new(model)),
    }
}

/// The page of PROGRAMMING AND EDITING.
pub(crate) fn editing(site: &mut Site) -> Box<dyn Page> {
    Box::new(programming::Programming::new(site))
}

/// What a key opens wherever nothing else takes it; HELP explains the note of the panel before messages of the control.
pub(crate) fn everywhere(key: Key, side: Side, note: Option<&str>, site: &mut Site) -> Turn {
    match key {
        Key::Mod => Turn::Open(supplementary::menu(side)),
        Key::Help => help::key(note, site),
        Key::Ext => external::open(side, site),
        _ => Turn::Refused,
    }
}

/// The page of TEST RUN.
pub(crate) fn test_run(site: &mut Site) -> Box<dyn Page> {
    Box::new(test_run::TestRun::new(site))
}
