//! M functions, tools and jumps of a block, with its movement between them.
//!
//! Decision: M0 stops after the block until the next start, M2 and M30 end the program after it; M1 puts off what follows
//! until it is executed [002:1638-1652]. M22 synchronises: the PLC gives its condition when everything before is executed
//!
//! Decision: M functions of the control that the machine defines go to the PLC beside what they do here; those that nobody
//! defines do not

use bahn_din::system900::{Block, MFunction, WordKind};
use bahn_path::{At, Barrier, Curve, FeedRate, Function, Synchronisation, TechnologyFunction};
use bahn_system900::{Acts, MFunction as Definition};

use crate::block::{Next, Work};
use crate::motion::Move;
use crate::refusal::Refusal;
use crate::run::{Loop, Said, Then};

/// M functions that the control itself executes [002:1638] [002:1795] [002:3884] [002:4857] [002:4892].
const OF_CONTROL: [u16; 9] = [0, 1, 2, 6, 16, 22, 24, 26, 30];

/// What the M functions of a block want.
#[derive(Default)]
struct Wanted {
    functions: Vec<TechnologyFunction>,
    /// The look-ahead waits after the block.
    synchronises: bool,
    stops: bool,
    ends: bool,
    cycle: Option<u16>,
    /// The block to jump to, where the PLC says so.
    skip: Option<u32>,
    repeat: Option<(u32, u32)>,
    changes_tool: Option<u16>,
}

impl Work<'_> {
    /// Executes what a block orders: its tool, its movement with its functions, what ends it.
    pub fn order(&mut self, block: &Block, said: &Said) -> Result<Next, Refusal> {
        let mut wanted = self.wanted(block)?;
        if let Some(feed) = said.feed {
            self.run.modal.feed = feed;
        }
        self.speed(block, &mut wanted);
        let write =
            |write: &Function| TechnologyFunction::new(write.clone(), At::Start, Synchronisation::Mos);
        wanted.functions.splice(0..0, said.writes.iter().map(write));
        self.tool(said.tool, wanted.changes_tool)?;
        if said.shifts {
            for (_, axis) in self.axes.iter() {
                if let Some(by) = said.coordinates[axis] {
                    self.run.modal.shift_axis(axis, by);
                }
            }
        }
        self.act(said, std::mem::take(&mut wanted.functions))?;
        if let Some(dwell_s) = said.dwell_s {
            self.halt(dwell_s.max(0.0));
        }
        self.end(wanted)
    }

    /// Moves, or drills at the place, with the functions of the block.
    fn act(&mut self, said: &Said, functions: Vec<TechnologyFunction>) -> Result<(), Refusal> {
        let frame = self.frame()?;
        let target = match said.shifts {
            true => None,
            false => self.target(said, &frame),
        };
        let Some(target) = target else {
            let here = Move {
                curve: Curve::Hold,
                end: self.run.position,
                feed: FeedRate::Rapid,
            };
            self.append(here, functions);
            return Ok(());
        };
        let to = self.movement(said, &frame, &target)?;
        self.append(to, functions);
        if self.stops_exactly(said) {
            self.halt(0.0);
        }
        match self.run.modal.drilling {
            Some(g) => self.drill(g),
            None => Ok(()),
        }
    }

    /// The spindle word goes out before the movement.
    fn speed(&self, block: &Block, wanted: &mut Wanted) {
        let says = |kind: &WordKind| matches!(kind, WordKind::Speed(1, _));
        if block.words.iter().any(|word| says(&word.kind)) {
            let speed = Function::SpindleSpeed(self.run.modal.speed_rpm);
            let speed = TechnologyFunction::new(speed, At::Start, Synchronisation::Mos);
            wanted.functions.insert(0, speed);
        }
    }

    fn wanted(&mut self, block: &Block) -> Result<Wanted, Refusal> {
        let mut wanted = Wanted::default();
        for word in &block.words {
            if let WordKind::M(function) = word.kind {
                self.m(function, &mut wanted)?;
            }
        }
        Ok(wanted)
    }

    fn m(&mut self, function: MFunction, wanted: &mut Wanted) -> Result<(), Refusal> {
        let MFunction {
            number: m,
            target,
            count,
        } = function;
        match (m, target, count) {
            (0, ..) => wanted.stops = true,
            (1, ..) => wanted.synchronises = true,
            (2 | 30, ..) => wanted.ends = true,
            (6 | 16, ..) => wanted.changes_tool = Some(m),
            (22, Some(target), _) => wanted.skip = Some(target),
            (24, Some(target), Some(count)) => wanted.repeat = Some((target, count)),
            (26, ..) => return Err(Refusal::not_executed("M26", "no sensor ends a movement here")),
            _ => {}
        }
        let own = OF_CONTROL.contains(&m);
        let definition = Definition::of(self.memory, self.channel, m);
        let stop = |at, synchronisation| TechnologyFunction::new(Function::M(m), at, synchronisation);
        match definition.acts {
            Acts::None if own || definition.bits != 0 => {}
            Acts::None => {
                return Err(Refusal::of(format!(
                    "M{m} is defined neither here nor by the machine"
                )));
            }
            Acts::Cycle => wanted.cycle = Some(m),
            Acts::Branch => {
                let Some(target) = target else {
                    return Err(Refusal::of(format!(
                        "M{m} branches and names no block, as in `M{m}.200`"
                    )));
                };
                let target = self.block_of(target)?;
                let branch = Function::Branch { m, target };
                let how = Synchronisation::MvsSvs;
                wanted
                    .functions
                    .push(TechnologyFunction::new(branch, At::Start, how));
            }
            // Tools that a cycle changes go to no PLC [002:1731-1735].
            _ if m == 6 && self.has_cycle(6) => {}
            Acts::Flying | Acts::Stop => {
                let waits = definition.acts == Acts::Stop;
                if definition.before {
                    let how = if waits {
                        Synchronisation::MvsSvs
                    } else {
                        Synchronisation::Mos
                    };
                    wanted.functions.push(stop(At::Start, how));
                }
                if definition.after {
                    let how = if waits {
                        Synchronisation::MnsSns
                    } else {
                        Synchronisation::Mos
                    };
                    wanted.functions.push(stop(At::End, how));
                }
            }
        }
        wanted.synchronises |= definition.sync;
        Ok(())
    }

    /// The block of a number in the program that runs, as elements count blocks.
    fn block_of(&self, number: u32) -> Result<u32, Refusal> {
        let level = self.run.levels.last().map_or(0, |level| level.program);
        let line = self
            .texts
            .program(level)
            .and_then(|program| program.line_of(number));
        let line = line.ok_or_else(|| Refusal::of(format!("no block has the number N{number}")))?;
        Ok(self.texts.block(level, line).block)
    }

    /// What comes after the movement.
    fn end(&mut self, wanted: Wanted) -> Result<Next, Refusal> {
        if wanted.synchronises {
            self.wait_for_execution();
        }
        if wanted.stops {
            self.run.stopped = Some(self.at);
            self.wait(Barrier::Stop { block: self.at }, Then::On);
        }
        if wanted.ends {
            return Ok(Next::End);
        }
        if let Some(cycle) = wanted.cycle {
            return Ok(Next::Cycle(cycle));
        }
        if wanted.changes_tool == Some(6) && self.has_cycle(6) {
            return Ok(Next::Cycle(6));
        }
        if let Some(target) = wanted.skip {
            self.wait(Barrier::Acknowledge { block: self.at }, Then::SkipTo(target));
        }
        match wanted.repeat {
            Some((target, count)) if self.repeats(count) => Ok(Next::Number(target)),
            _ => Ok(Next::Line),
        }
    }

    /// Counts a loop of M24; whether it jumps back once more [002:4892-4893].
    fn repeats(&mut self, count: u32) -> bool {
        let Some(level) = self.run.levels.last().copied() else {
            return false;
        };
        let is_own = |own: &Loop| own.program == level.program && own.line == level.line;
        let place = match self.run.loops.iter().position(is_own) {
            Some(place) => place,
            None => {
                self.run.loops.push(Loop {
                    program: level.program,
                    line: level.line,
                    left: count,
                });
                self.run.loops.len() - 1
            }
        };
        let left = self.run.loops.get_mut(place).map_or(0, |own| {
            let left = own.left;
            own.left = left.saturating_sub(1);
            left
        });
        if left == 0 {
            self.run.loops.remove(place);
        }
        left > 0
    }
}
