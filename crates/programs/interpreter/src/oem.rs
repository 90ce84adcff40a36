//! Cycles of the machine builder: programs 99999968 to 99999999, defined and called like cycles 68 to 99
//! [000:17691-17984].
//!
//! The dialogue block of the program says when it runs: after its definition (DLG-DEF), or at the cycle call
//! (DLG-CALL). The definition assigns its parameters to Q1, Q2, ..., those of DLG-DEF cycles MP7250 higher. What the
//! cycle makes of Q parameters below Q[100 - MP7251] is gone after its end [000:17763-17800]. On a TNC 151/155 MP263 is what
//! MP7250 is later [001:2784-2799], and all Q parameters stay as the cycle leaves them.
//!
//! Decision: A cycle of the machine builder gives back the local Q parameters, the cycle for the call and M89 of who
//! called it; one in the EPROM is a program in the folder `eprom` beside the programs (also `host/src/files.rs`)
//!
//! Decision: M00 must not stand in a cycle of the machine builder, as STOP must not; M01 may, since the control does
//! not stop for it

use bahn_parameters::MessageId;
use bahn_program::{MFunctions, Operation};

use crate::definition::{Definition, OEM_CYCLES, RunningOem};
use crate::error::Fault;
use crate::run::Run;
use crate::settings::Settings;

/// Name of the program of a cycle less its number.
pub(crate) const NAME_BASE: u32 = 99_999_900;
/// Cycles of the machine builder inside each other [000:17711].
pub(crate) const NESTING_MAX: usize = 4;
/// Q parameters from this one on are never local.
pub(crate) const FIRST_NEVER_LOCAL: usize = 100;
/// The dialogue block stands within the first blocks.
pub(crate) const BLOCKS_BEFORE_DIALOG: u32 = 16;

/// What the dialogue block of a cycle says.
#[derive(Clone, Copy)]
pub(crate) struct Cycle {
    pub number: u16,
    pub program: u16,
    pub in_eprom: bool,
    /// It runs at the cycle call.
    pub call: bool,
    pub parameters: u16,
}

impl Cycle {
    /// Refuses a definition without one of the parameters.
    pub fn check(&self, definition: Option<&Definition>, settings: &Settings) -> Result<(), Fault> {
        let incomplete = |detail| Fault::new(MessageId::CyclIncomplete, detail);
        let definition =
            definition.ok_or_else(|| incomplete("blocks of the cycle are missing or out of order".into()))?;
        let offset = match self.call {
            true => 0,
            false => settings.rules.oem_cycles.definition_offset,
        };
        let mut numbers = (1..=self.parameters).map(|parameter| parameter + offset);
        match numbers.find(|number| definition.assigned(*number).is_none()) {
            Some(number) => Err(incomplete(format!(
                "CYCL DEF {}: Q{number} is missing",
                self.number
            ))),
            None => Ok(()),
        }
    }
}

/// After the end of a program: cycles that have ended give back what was local to them.
pub(crate) fn leave(run: &mut Run, settings: &Settings) {
    while run
        .oem
        .last()
        .is_some_and(|running| running.depth > run.at.depth())
    {
        let Some(running) = run.oem.pop() else { return };
        let global = usize::from(settings.rules.oem_cycles.global_parameters);
        let local = FIRST_NEVER_LOCAL.saturating_sub(global);
        for (number, value) in (0..local as u16).zip(running.q) {
            run.numbers.q.preassign(number, value);
        }
        run.modal.cycle.machining = running.machining;
        run.modal.cycle_after_each_block = running.after_each_block;
    }
}

/// Refuses what a cycle must not have [000:17705-17724]; no manual prints the message (inferred). M functions are permitted
/// "without program-run stop": M00 stops as the block STOP does, M01 does not stop here [000:7080-7081]. A TNC 151/155 forbids
/// repeats in the EPROM alone [001:2829-2833].
pub(crate) fn permit(
    running: Option<&RunningOem>,
    operation: &Operation,
    settings: &Settings,
) -> Result<(), Fault> {
    let Some(running) = running else { return Ok(()) };
    let old = settings.model.limits().has_old_numbers();
    let stops = |m: &MFunctions| {
        let m6 = settings.rules.machine.m6_stops && m.contains(6);
        let ends = [0, 2, 30].into_iter().any(|number| m.contains(number));
        (ends || m6).then_some("M00, M02, M30, or M06 with program stop,")
    };
    let what = match operation {
        Operation::CallLabel { repeats: Some(_), .. } if running.in_eprom => Some("CALL LBL REP"),
        _ if old => None,
        Operation::Stop(_) => Some("STOP"),
        Operation::CallProgram(_) => Some("CALL PGM"),
        Operation::Cycle(block) if block.number == 14 => Some("CYCL DEF 14"),
        Operation::ToolDefinition { length, radius, .. } if !running.in_eprom => {
            (length.is_some() || radius.is_some()).then_some("TOOL DEF, unless it is in the EPROM,")
        }
        Operation::Motion(motion) => stops(&motion.m),
        Operation::Miscellaneous(m) | Operation::CycleCall(m) => stops(m),
        _ => None,
    };
    match what {
        Some(what) => {
            let detail = format!("{what} must not stand in a cycle of the machine builder");
            Err(Fault::new(MessageId::BlockNotKnown, detail))
        }
        None => Ok(()),
    }
}

/// Whether a program has the name of a cycle: 99999968 to 99999999, with or without folder and ending.
pub(crate) fn is_name(name: &str) -> bool {
    let file = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    let stem = file.split('.').next().unwrap_or_default();
    let number = stem
        .parse::<u32>()
        .ok()
        .and_then(|number| number.checked_sub(NAME_BASE));
    number.is_some_and(|number| u16::try_from(number).is_ok_and(|number| OEM_CYCLES.contains(&number)))
}
