//! CODE NUMBER [000:6928-6947] [003:7023-7031].

use bahn_parameters::MessageId;
use bahn_parameters::code_numbers::{
    CANCEL_PROTECTION, CORRECTION_TABLES, ERASE_MEMORY, MACHINE_PARAMETERS, OFFSET_ADJUSTMENT, OSCILLOSCOPE,
    PLC_MODE, TIMERS, USER_PARAMETERS,
};
use bahn_tnc::{Command, RunState};

use super::{offsets, oscilloscope, timers};
use crate::page::Turn;
use crate::pages::ask::{Choice, Name};
use crate::pages::axis_errors;
use crate::pages::files::{Directory, Purpose};
use crate::pages::{parameters, plc};
use crate::site::Site;

/// Digits of a code number at most.
const DIGITS: usize = 9;

/// Asks for a code number.
pub(super) fn ask(site: &Site) -> Turn {
    let prompt = site.words("CODE NUMBER =");
    Turn::Open(Name::ask(prompt, DIGITS, |text, site| {
        let incorrect = |site: &Site| Turn::Say(site.message(MessageId::EntryValueIncorrect));
        let Ok(code) = text.parse() else {
            return incorrect(site);
        };
        match entered(code, site) {
            Turn::Open(page) => Turn::Replace(page),
            Turn::Done => Turn::Close,
            Turn::Say(text) => Turn::CloseSaying(text),
            other => other,
        }
    }))
}

/// What a code number opens. Each stands in D276 then; the PLC may have numbers of its own.
fn entered(code: u32, site: &mut Site) -> Turn {
    if code == ERASE_MEMORY {
        return erase_memory(site);
    }
    if !site.command(Command::Code(code)) {
        return Turn::Refused;
    }
    match code {
        USER_PARAMETERS => parameters::of_code(site),
        MACHINE_PARAMETERS => parameters::all(site),
        CORRECTION_TABLES => axis_errors::corrections(site),
        CANCEL_PROTECTION => Turn::Open(Box::new(Directory::new(Purpose::Unprotect, site))),
        OFFSET_ADJUSTMENT => offsets::open(site),
        OSCILLOSCOPE => oscilloscope::open(),
        PLC_MODE => plc::open(site),
        TIMERS => Turn::Open(Box::new(timers::Timers)),
        _ => Turn::Done,
    }
}

/// M1000 to M1999 and B0 to B127 are erased: the control asks before (inferred).
fn erase_memory(site: &Site) -> Turn {
    if site.control().run_state() != RunState::Idle {
        return Turn::Refused;
    }
    let prompt = format!(
        "M1000-M1999, B0-B127: {}",
        site.words("ERASE = ENT / END = NO ENT")
    );
    Turn::Open(Choice::confirm(prompt, site.words("ERASE"), |site| {
        match site.command(Command::Code(ERASE_MEMORY)) {
            true => Turn::Close,
            false => Turn::CloseSaying(site.message(MessageId::KeyNonFunctional)),
        }
    }))
}
