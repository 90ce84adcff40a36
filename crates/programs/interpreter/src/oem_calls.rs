//! Definitions and calls of cycles of the machine builder in a run [000:17691-17984].

use bahn_parameters::MessageId;
use bahn_program::Operation;

use crate::Interpreter;
use crate::definition::{OEM_CYCLES, RunningOem};
use crate::error::{Fault, WarningKind};
use crate::oem::{BLOCKS_BEFORE_DIALOG, Cycle, FIRST_NEVER_LOCAL, NAME_BASE, NESTING_MAX, is_name};

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
        let found = match in_eprom {
            true => self.code.open_eprom(name, caller, &*self.programs),
            false => self.code.open(name, caller, &*self.programs),
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
