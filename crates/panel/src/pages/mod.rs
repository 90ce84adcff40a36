//! The pages: operating modes below, menus, tables and questions that stand on them.

mod by_hand;
mod datum;
mod editing;
mod files;
mod mdi;
mod number;
mod programming;
mod run;
mod test_run;

use bahn_control::Mode;

use crate::page::Page;
use crate::site::Site;

/// The page of a machine operating mode.
pub(crate) fn of_mode(mode: Mode) -> Box<dyn Page> {
    match mode {
        Mode::Manual | Mode::Handwheel | Mode::Reference => Box::new(by_hand::ByHand),
        Mode::Mdi => Box::new(mdi::Mdi::default()),
        Mode::SingleBlock | Mode::FullSequence => Box::new(run::ProgramRun::default()),
    }
}

/// PROGRAMMING AND EDITING.
pub(crate) fn editing(site: &mut Site) -> Box<dyn Page> {
    Box::new(programming::Programming::new(site))
}

/// TEST RUN.
pub(crate) fn test_run(site: &mut Site) -> Box<dyn Page> {
    Box::new(test_run::TestRun::new(site))
}
