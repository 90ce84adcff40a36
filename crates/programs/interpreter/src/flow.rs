//! Where the run stands: calls, repeats, returns.

use bahn_parameters::{Limits, MessageId};
use bahn_path::BlockRef;

use crate::error::{Cause, Fault};

/// What a block asks of the flow of the program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Flow {
    Next,
    /// Go to a label (FN9-FN12).
    Jump(u16),
    /// Subprogram call of a label.
    Call(u16),
    /// Section repeat: jump back this many times.
    Repeat(u16, u32),
    /// LBL 0: back to the block after the call.
    Return,
    /// CALL PGM or cycle 12.
    CallProgram(Box<str>),
    /// END PGM: the program ends, and with the main program the run.
    EndOfProgram,
    /// M2 or M30: the run ends in whatever program.
    EndOfRun,
    /// A block `number.sub` of the definition of a machine builder's cycle.
    OemDefinition(u16, u16),
    /// A machine builder's cycle is called.
    OemCall(u16),
    /// The dialogue block of such a cycle.
    Dialog,
    /// A surface is to be digitized.
    Scan,
    /// A cycle is called that needs the contour subprograms.
    ContourCycle,
}

/// The next block and the way back from it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Position {
    pub program: u16,
    pub block: u32,
    frames: Vec<Frame>,
    repeats: Vec<Repeat>,
}

#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Where to go on.
    program: u16,
    block: u32,
    /// Label of a subprogram; `None` for a program call.
    label: Option<u16>,
}

#[derive(Clone, Copy, Debug)]
struct Repeat {
    program: u16,
    /// The CALL LBL block.
    block: u32,
    depth: usize,
    remaining: u32,
}

impl Position {
    pub fn at(program: u16, block: u32) -> Position {
        Position {
            program,
            block,
            ..Position::default()
        }
    }

    pub fn block_ref(&self) -> BlockRef {
        BlockRef {
            program: self.program,
            block: self.block,
        }
    }

    /// The block of the main program that is executed next, or after which the run comes back to it.
    pub fn in_main(&self) -> u32 {
        let mut frames = self.frames.iter().filter(|frame| frame.program == 0);
        match self.program {
            0 => self.block,
            // The call itself is looked at when something in the called program fails.
            _ => frames.next().map_or(0, |frame| frame.block.saturating_sub(1)),
        }
    }

    /// Program section repeats that are under way: their CALL LBL block, and how many are left.
    pub fn repeats(&self) -> impl Iterator<Item = (BlockRef, u32)> + '_ {
        self.repeats.iter().map(|repeat| {
            let call = BlockRef {
                program: repeat.program,
                block: repeat.block,
            };
            (call, repeat.remaining)
        })
    }

    /// Whether a called program is running.
    pub fn in_called_program(&self) -> bool {
        self.frames.iter().any(|frame| frame.label.is_none())
    }

    /// How many calls are open.
    pub fn depth(&self) -> usize {
        self.frames.len()
    }

    /// Enters a subprogram that starts after its LBL block [003:3633-3650].
    pub fn call(&mut self, label: u16, target: u32, limits: &Limits) -> Result<(), Fault> {
        let open = || self.frames.iter().rev().take_while(|frame| frame.label.is_some());
        if open().any(|frame| frame.label == Some(label)) {
            return Err(
                Fault::new(MessageId::ExcessiveSubprogramming, "a subprogram calls itself")
                    .because(Cause::CallsItself),
            );
        }
        let nested = self.frames.iter().filter(|frame| frame.label.is_some()).count();
        if nested >= usize::from(limits.subprogram_nesting_max) {
            return Err(Fault::new(
                MessageId::ExcessiveSubprogramming,
                "too many nested subprograms",
            ));
        }
        self.frames.push(Frame {
            program: self.program,
            block: self.block + 1,
            label: Some(label),
        });
        self.block = target;
        Ok(())
    }

    /// Enters a called program at its first block [003:3870-3902].
    pub fn call_program(&mut self, program: u16, limits: &Limits) -> Result<(), Fault> {
        let nested = self.frames.iter().filter(|frame| frame.label.is_none()).count();
        if nested >= usize::from(limits.program_nesting_max) {
            return Err(Fault::new(
                MessageId::ExcessiveSubprogramming,
                "too many nested program calls",
            ));
        }
        self.frames.push(Frame {
            program: self.program,
            block: self.block + 1,
            label: None,
        });
        self.program = program;
        self.block = 0;
        Ok(())
    }

    /// LBL 0: back after the call; without a call it does nothing (inferred) [003:3644-3650].
    pub fn return_from_label(&mut self) {
        match self.frames.last() {
            Some(&Frame {
                program,
                block,
                label: Some(_),
            }) => {
                self.frames.pop();
                self.forget_repeats();
                self.program = program;
                self.block = block;
            }
            _ => self.block += 1,
        }
    }

    /// END PGM: back to the calling program; `false` when the main program has ended.
    pub fn return_from_program(&mut self) -> Result<bool, Fault> {
        match self.frames.pop() {
            None => Ok(false),
            Some(Frame {
                program,
                block,
                label: None,
            }) => {
                self.forget_repeats();
                self.program = program;
                self.block = block;
                Ok(true)
            }
            Some(_) => Err(
                Fault::new(MessageId::ExcessiveSubprogramming, "the subprogram has no LBL 0")
                    .because(Cause::NoReturn),
            ),
        }
    }

    /// CALL LBL REP: the section runs `count` more times [003:3747-3763]. A nested repeat starts again with
    /// its full count each time it is reached [003:3991-3997].
    pub fn repeat(&mut self, target: u32, count: u32) -> Result<(), Fault> {
        if target > self.block {
            // A label after the call is a subprogram, not a section [003:7930-7937].
            return Err(Fault::new(
                MessageId::ExcessiveSubprogramming,
                "a subprogram is called with REP",
            )
            .because(Cause::RepeatsAhead));
        }
        let depth = self.frames.len();
        let here = |r: &Repeat| r.program == self.program && r.block == self.block && r.depth == depth;
        match self.repeats.iter().position(here) {
            Some(index) => {
                if let Some(repeat) = self.repeats.get_mut(index)
                    && repeat.remaining > 0
                {
                    repeat.remaining -= 1;
                    self.block = target;
                    return Ok(());
                }
                self.repeats.swap_remove(index);
                self.block += 1;
            }
            None if count > 0 => {
                self.repeats.push(Repeat {
                    program: self.program,
                    block: self.block,
                    depth,
                    remaining: count - 1,
                });
                self.block = target;
            }
            None => self.block += 1,
        }
        Ok(())
    }

    fn forget_repeats(&mut self) {
        let depth = self.frames.len();
        self.repeats.retain(|repeat| repeat.depth <= depth);
    }
}
