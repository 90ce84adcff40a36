//! Block search: what stands before the block with which a run begins is decoded and neither output nor moved.
//!
//! Its last state is listed (inferred): of each range the last of each function, of functions
//! that replace one another the last of all.
//!
//! Decision: A block search looks in the program itself, then in its subroutines, then in the next programs of the
//! file; what it passes over is neither output nor commanded nor waited for, only listed

use bahn_din::{Command, Unit};
use bahn_kernel::block_search::{Latest, PassOver, Passed, Search, search};
use bahn_path::Position;

use super::in_force::InForce;
use super::plan::Plan;
use super::ranges::Ranges;
use super::resolve::Resolve;
use crate::report::{Fault, Skipped};
use crate::run::{Blocks, Run};

/// Functions of a spindle that replace one another, and the gear stages.
const GROUPS: [&[&str]; 2] = [
    &["M3", "M4", "M5", "M19"],
    &["M40", "M41", "M42", "M43", "M44", "M45"],
];

/// Where a run begins.
pub(super) struct Begun<'a> {
    /// What was passed over before.
    pub(super) skipped: Vec<Skipped>,
    /// Number of the program.
    pub(super) index: usize,
    pub(super) blocks: Box<dyn Blocks + 'a>,
    pub(super) position: Position,
    /// Commands that are in force there: the last of each kind.
    pub(super) commands: Vec<Command>,
}

/// The programs of the first file, one after the other, of which one has the block.
struct Passing<'p, 'a, 'r> {
    plan: &'p mut Plan<'a>,
    ranges: &'p mut Ranges,
    cycle_s: f64,
    run: &'r Run<'r>,
    block: &'r str,
    /// Number of the program, with its blocks once it has begun.
    index: usize,
    blocks: Option<Box<dyn Blocks + 'r>>,
    position: Position,
    skipped: Latest<Skipped>,
    commands: Latest<Command>,
    /// The first program has no such block.
    missing: Option<Fault>,
}

impl Plan<'_> {
    /// Looks for a block in the programs of the first file, one after the other.
    pub(super) fn search<'r>(
        &mut self,
        run: &'r Run<'r>,
        block: &'r str,
        start: Position,
        ranges: &mut Ranges,
        cycle_s: f64,
    ) -> Result<Begun<'r>, Fault> {
        let mut passing = Passing {
            plan: self,
            ranges,
            cycle_s,
            run,
            block,
            index: 0,
            blocks: None,
            position: start,
            skipped: Latest::default(),
            commands: Latest::default(),
            missing: None,
        };
        // No more blocks than a run may have; beside them each program begins, and the block is found.
        let most = run.bounds.blocks.saturating_add(run.programs.count() as u64 + 1);
        let found = search(&mut passing, usize::try_from(most).unwrap_or(usize::MAX))?;
        passing.begun(found)
    }
}

impl<'r> Passing<'_, '_, 'r> {
    /// Where the run begins with what the search has come to.
    fn begun(self, found: Search) -> Result<Begun<'r>, Fault> {
        let fault = |code: &str, message: String| Fault {
            code: code.to_owned(),
            message,
            program: self.run.programs.name(self.index),
            block: self.block.to_owned(),
            line: 0,
        };
        match (found, self.blocks) {
            (Search::Found, Some(blocks)) => Ok(Begun {
                skipped: self.skipped.into_vec(),
                index: self.index,
                position: blocks.position(),
                blocks,
                commands: self.commands.into_vec(),
            }),
            (Search::Open, _) => Err(fault(
                "endless",
                format!("more than {} blocks", self.run.bounds.blocks),
            )),
            _ => Err(self
                .missing
                .unwrap_or_else(|| fault("syntax", "there is no program".to_owned()))),
        }
    }
}

impl PassOver for Passing<'_, '_, '_> {
    type Fault = Fault;

    fn pass(&mut self) -> Result<Passed, Fault> {
        let Some(blocks) = &mut self.blocks else {
            return Ok(Passed::End);
        };
        if blocks.next_is(self.block) {
            return Ok(Passed::Found);
        }
        let next = blocks.next(&mut self.plan.in_force);
        let Some(unit) = next.map_err(|fault| self.plan.coded(fault))? else {
            return Ok(Passed::End);
        };
        self.skip(&unit);
        if unit.ends {
            return Ok(Passed::End);
        }
        self.remember(unit);
        Ok(Passed::Block)
    }

    fn begin_next(&mut self) -> Result<bool, Fault> {
        let (programs, before) = (self.run.programs, self.blocks.take());
        if let Some(before) = before {
            self.index += 1;
            self.position = before.position();
            self.missing.get_or_insert_with(|| before.not_found(self.block));
        }
        if self.index >= programs.count() || programs.name(self.index) != programs.name(0) {
            return Ok(false);
        }
        self.plan.in_force = InForce::new(self.plan.settings);
        self.commands = Latest::default();
        self.blocks = Some(programs.open(self.index, &self.position)?);
        Ok(true)
    }
}

impl Passing<'_, '_, '_> {
    /// Notes the functions of a block that is passed over. What the channel does not know is nobody's state.
    fn skip(&mut self, unit: &Unit) {
        let settings = &self.plan.in_force.settings;
        let mut resolve = Resolve {
            settings,
            ranges: self.ranges,
            orders: &mut Default::default(),
            cycle_s: self.cycle_s,
        };
        for (function, value, target) in resolve.skipped(unit) {
            let group = GROUPS
                .iter()
                .filter(|_| !settings.spindle_m_free)
                .find(|group| group.contains(&function.as_str()));
            let one = Skipped {
                function: function.clone(),
                value,
                target: target.clone(),
                program: unit.place.program.to_string(),
                block: unit.place.block.to_string(),
            };
            self.skipped.put(one, |other| {
                let replaced = other.function == function
                    || group.is_some_and(|group| group.contains(&other.function.as_str()));
                other.target == target && replaced
            });
        }
    }

    /// Keeps the last command of each kind that stays in force. The Micro Joint that a command shapes is that of the next
    /// function, so it is over after one.
    fn remember(&mut self, unit: Unit) {
        if !unit.functions.is_empty() {
            self.commands
                .end(|command| matches!(command, Command::MicroJoint { .. }));
        }
        for command in unit.commands {
            let stays = matches!(
                command,
                Command::MicroJoint { .. }
                    | Command::VectorLimit { .. }
                    | Command::EdgeBanding(_)
                    | Command::RadiusCompensation(_)
            );
            if stays {
                let kind = std::mem::discriminant(&command);
                self.commands
                    .put(command, |other| std::mem::discriminant(other) == kind);
            }
        }
    }
}
