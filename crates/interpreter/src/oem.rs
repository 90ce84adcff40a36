//! Cycles of the machine builder: programs 99999968 to 99999999, defined and called like cycles 68 to 99
//! [000:17691-17984].
//!
//! The dialogue block of the program says when it runs: after its definition (DLG-DEF), or at the cycle call
//! (DLG-CALL). The definition assigns its parameters to Q1, Q2, ..., those of DLG-DEF cycles MP7250 higher. What the
//! cycle makes of Q parameters below Q[100 - MP7251] is gone after its end [000:17763-17800].

use std::sync::PoisonError;

use bahn_parameters::MessageId;
use bahn_program::{MFunctions, Operation};

use crate::Interpreter;
use crate::definition::{Definition, OEM_CYCLES, RunningOem};
use crate::error::{Fault, WarningKind};
use crate::run::Run;
use crate::settings::Settings;

/// Name of the program of a cycle less its number.
const NAME_BASE: u32 = 99_999_900;
/// Cycles of the machine builder inside each other [000:17711].
const NESTING_MAX: usize = 4;
/// Q parameters from this one on are never local.
const FIRST_NEVER_LOCAL: usize = 100;
/// The dialogue block stands within the first blocks.
const BLOCKS_BEFORE_DIALOG: u32 = 16;

/// What the dialogue block of a cycle says.
#[derive(Clone, Copy)]
pub(crate) struct Cycle {
    number: u16,
    program: u16,
    in_eprom: bool,
    /// It runs at the cycle call.
    call: bool,
    parameters: u16,
}

impl Cycle {
    /// Refuses a definition without one of the parameters.
    fn check(&self, definition: Option<&Definition>, settings: &Settings) -> Result<(), Fault> {
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

impl Interpreter {
    /// After a block of the definition of a cycle: the last one runs a DLG-DEF cycle, and makes a DLG-CALL cycle the
    /// one for the cycle call.
    pub(crate) fn oem_definition(&mut self, number: u16, sub: u16) -> Result<(), Fault> {
        let cycle = self.oem_cycle(number)?;
        if sub == 0 && cycle.is_none() {
            let what = format!(
                "CYCL DEF {number}: there is no program {}",
                NAME_BASE + u32::from(number)
            );
            if !self.settings.skip_unknown {
                return Err(Fault::new(MessageId::BlockNotKnown, what));
            }
            self.run
                .context(&self.settings)
                .warn(WarningKind::PassedOver { what });
        }
        let goes_on = self.definition_goes_on(number);
        let data = &mut self.run.modal.cycle;
        if goes_on {
            self.run.at.block += 1;
            return Ok(());
        }
        if let Some(cycle) = &cycle {
            cycle.check(data.oem.ready(), &self.settings)?;
        }
        match cycle {
            Some(cycle) if !cycle.call => self.enter_oem_cycle(cycle),
            _ => {
                data.machining = data.oem.clone();
                // A new definition ends M89 [003:4875-4881].
                self.run.modal.cycle_after_each_block = false;
                self.run.at.block += 1;
                Ok(())
            }
        }
    }

    /// CYCL CALL, M99 or M89 after the definition of a DLG-CALL cycle.
    pub(crate) fn oem_call(&mut self, number: u16) -> Result<(), Fault> {
        match self.oem_cycle(number)? {
            Some(cycle) => self.enter_oem_cycle(cycle),
            // Its definition was passed over.
            None => {
                self.run.at.block += 1;
                Ok(())
            }
        }
    }

    /// A dialogue block has no effect of its own, and stands in programs of cycles only [000:17728].
    pub(crate) fn dialog(&mut self) -> Result<(), Fault> {
        let program = self.code.program(self.run.at.program);
        let name = program.map_or("", |program| program.name());
        if !is_name(name) {
            let detail = "a dialogue block stands in programs 99999968 to 99999999 only";
            return Err(Fault::new(MessageId::BlockNotKnown, detail));
        }
        self.run.at.block += 1;
        Ok(())
    }

    /// Whether the next block that is no comment belongs to the same definition.
    fn definition_goes_on(&mut self, number: u16) -> bool {
        let (program, mut block) = (self.run.at.program, self.run.at.block);
        loop {
            block += 1;
            match self
                .code
                .block(program, block)
                .map(|fetched| &fetched.block.operation)
            {
                Some(Operation::Comment(_)) => {}
                Some(Operation::Cycle(next)) => return next.number == number && next.sub > 0,
                _ => return false,
            }
        }
    }

    /// The program of a cycle, from the program memory or the EPROM of the PLC; `None` when there is none. With
    /// MP7240 = 1 that of the memory goes first, with 0 it could not have been entered [000:17757-17761]. The PLC
    /// inhibits those of the EPROM [000:17812-17821].
    fn oem_cycle(&mut self, number: u16) -> Result<Option<Cycle>, Fault> {
        if let Some(known) = self.oem_cycles.get(&number) {
            return Ok(*known);
        }
        let found = self.find_oem_cycle(number)?;
        self.oem_cycles.insert(number, found);
        Ok(found)
    }

    fn find_oem_cycle(&mut self, number: u16) -> Result<Option<Cycle>, Fault> {
        let name = (NAME_BASE + u32::from(number)).to_string();
        let order = match self.settings.rules.oem_cycles.names_free {
            true => [false, true],
            false => [true, false],
        };
        for in_eprom in order {
            let Some(program) = self.open_oem_cycle(&name, in_eprom)? else {
                continue;
            };
            let bit = u32::from(number.saturating_sub(*OEM_CYCLES.start()));
            if in_eprom && self.settings.inhibited_oem_cycles >> bit & 1 != 0 {
                let detail = format!("M{} of the PLC inhibits cycle {number}", 2240 + bit);
                return Err(Fault::new(MessageId::BlockNotKnown, detail));
            }
            for block in 0..BLOCKS_BEFORE_DIALOG {
                let fetched = self.code.block(program, block);
                if let Some(Operation::Dialog(dialog)) = fetched.map(|fetched| &fetched.block.operation) {
                    return Ok(Some(Cycle {
                        number,
                        program,
                        in_eprom,
                        call: dialog.call,
                        parameters: dialog.texts.len().saturating_sub(1) as u16,
                    }));
                }
            }
            let detail = format!("program {name} has no dialogue block DLG-DEF or DLG-CALL");
            return Err(Fault::new(MessageId::BlockNotKnown, detail));
        }
        Ok(None)
    }

    fn open_oem_cycle(&mut self, name: &str, in_eprom: bool) -> Result<Option<u16>, Fault> {
        let caller = self.run.at.program;
        let mut library = self.library.lock().unwrap_or_else(PoisonError::into_inner);
        let found = match in_eprom {
            true => self.code.open_eprom(name, caller, library.as_mut()),
            false => self.code.open(name, caller, library.as_mut()),
        };
        found.map_err(|reason| Fault::new(MessageId::ProgramNotFound, reason))
    }

    fn enter_oem_cycle(&mut self, cycle: Cycle) -> Result<(), Fault> {
        if self.run.oem.len() >= NESTING_MAX {
            let detail = format!("cycles of the machine builder nest {NESTING_MAX} deep");
            return Err(Fault::new(MessageId::ExcessiveSubprogramming, detail));
        }
        self.enter_program(cycle.program)?;
        let run = &mut self.run;
        let machining = run.modal.cycle.machining.clone();
        run.oem.push(RunningOem {
            depth: run.at.depth(),
            in_eprom: cycle.in_eprom,
            q: run
                .numbers
                .q
                .values()
                .iter()
                .take(FIRST_NEVER_LOCAL)
                .copied()
                .collect(),
            machining,
            after_each_block: std::mem::take(&mut run.modal.cycle_after_each_block),
        });
        Ok(())
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
/// "without program-run stop": M00 stops as the block STOP does, M01 does not stop here [000:7080-7081].
pub(crate) fn permit(
    running: Option<&RunningOem>,
    operation: &Operation,
    settings: &Settings,
) -> Result<(), Fault> {
    let Some(running) = running else { return Ok(()) };
    let stops = |m: &MFunctions| {
        let m6 = settings.rules.machine.m6_stops && m.contains(6);
        let ends = [0, 2, 30].into_iter().any(|number| m.contains(number));
        (ends || m6).then_some("M00, M02, M30, or M06 with program stop,")
    };
    let what = match operation {
        Operation::Stop(_) => Some("STOP"),
        Operation::CallProgram(_) => Some("CALL PGM"),
        Operation::Cycle(block) if block.number == 14 => Some("CYCL DEF 14"),
        Operation::CallLabel { repeats: Some(_), .. } if running.in_eprom => Some("CALL LBL REP"),
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
fn is_name(name: &str) -> bool {
    let file = name.rsplit(['\\', '/', ':']).next().unwrap_or_default();
    let stem = file.split('.').next().unwrap_or_default();
    let number = stem
        .parse::<u32>()
        .ok()
        .and_then(|number| number.checked_sub(NAME_BASE));
    number.is_some_and(|number| u16::try_from(number).is_ok_and(|number| OEM_CYCLES.contains(&number)))
}
