//! Programs one after the other.

use bahn_din::{Place, Unit};
use bahn_path::Position;

use super::Channel;
use super::back::Backward;
use super::fault::named;
use super::in_force::InForce;
use super::plan::Around;
use super::record::{self, EVENTS};
use super::single::braked;
use super::skipped::Begun;
use super::track::Action;
use crate::bounds::Bounds;
use crate::plc::{PlcMemory, cycle_at};
use crate::report::{Coordinates, Fault, ProgramEnd, Report, Warning};
use crate::run::{Blocks, Run};

/// Elements of the path that are decoded ahead of it at most.
const AHEAD: u64 = 300;
/// Actions at the end of what is known, and blocks at a time.
const ACTIONS: usize = 2000;
const BLOCKS: usize = 2000;
/// Rounds of decoding and doing in a cycle.
const ROUNDS: usize = 8;
/// What the path has passed is forgotten every so many cycles.
const FORGET: u64 = 1024;

/// How a program ended.
enum Ended {
    Completed,
    Reset,
    Faulty,
    /// Nothing can move any more.
    Stuck,
}

impl Run<'_> {
    /// Runs the programs up to their end or an error.
    pub fn execute(self) -> Report {
        execute(&self, None)
    }

    /// Runs them with a PLC that reads and answers the functions in a window of bytes. The script says nothing of them: what
    /// it says of path and spindles holds.
    pub fn execute_beside(self, plc: &mut dyn PlcMemory) -> Report {
        execute(&self, Some(plc))
    }
}

fn execute<'a>(run: &'a Run<'a>, memory: Option<&'a mut (dyn PlcMemory + 'a)>) -> Report {
    let mut channel = Channel::new(run.settings, run.limits, run.script, memory, run.start);
    channel.progress.bounds = run.bounds;
    let mut programs = Vec::new();
    let mut begun = None;
    if let Some(block) = run.from {
        let start = channel.now().position;
        match channel.plan.search(run, block, start, channel.cycle_s) {
            Ok(mut found) => {
                channel.progress.skipped = Some(std::mem::take(&mut found.skipped));
                begun = Some(found);
            }
            Err(fault) => channel.progress.fault = Some(fault),
        }
    }
    let first = begun.as_ref().map_or(0, |begun| begun.index);
    for index in first..run.programs.count() {
        let ended = channel.open(run, index, begun.take());
        programs.push(ProgramEnd {
            program: run.programs.name(index),
            completed: matches!(ended, Ended::Completed),
            time_s: record::time(channel.t()),
        });
        if matches!(ended, Ended::Faulty | Ended::Stuck) {
            break;
        }
    }
    let end_s = channel.t();
    channel.fetch_the_rest();
    let completed =
        first + programs.len() == run.programs.count() && programs.iter().all(|program| program.completed);
    if completed {
        channel.record.drop_last_stop();
    }
    Report {
        completed,
        error: channel.progress.fault.take(),
        time_s: record::time(end_s),
        cycle_s: channel.cycle_s,
        path_end: Coordinates(channel.now().position),
        events: channel.record.events,
        waits: channel.record.waits,
        skipped: channel.progress.skipped,
        programs,
        warnings: channel.record.warnings,
        samples: channel.record.samples,
    }
}

impl Channel<'_> {
    /// After the end of the run the PLC fetches what was output last: the time of the run does not wait for it.
    fn fetch_the_rest(&mut self) {
        self.plc.keep_fetches();
        while let Some(cycle) = self.plc.next_cycle(self.cycle, 0) {
            self.cycle = self.cycle.max(cycle);
            self.plc();
        }
    }

    /// Runs a program of a run, from a block on where one was looked for.
    fn open<'r>(&mut self, run: &'r Run<'_>, index: usize, begun: Option<Begun<'r>>) -> Ended {
        self.progress.program = run.programs.name(index);
        if self.progress.fault.is_some() {
            return Ended::Faulty;
        }
        let begun = match begun {
            Some(begun) => begun,
            None => {
                self.plan.in_force = InForce::new(self.plan.settings);
                let position = self.now().position;
                match run.programs.open(index, &position) {
                    Ok(blocks) => Begun {
                        skipped: Vec::new(),
                        index,
                        blocks,
                        position,
                        commands: Vec::new(),
                    },
                    Err(fault) => {
                        self.progress.fault = Some(fault);
                        return Ended::Faulty;
                    }
                }
            }
        };
        let Begun {
            mut blocks,
            position,
            commands,
            ..
        } = begun;
        self.begin_path(position);
        self.plan.begin_program();
        if !commands.is_empty() {
            let unit = Unit {
                place: Place {
                    program: self.progress.program.as_str().into(),
                    block: run.from.unwrap_or_default().into(),
                    line: 0,
                },
                motion: None,
                functions: Vec::new(),
                commands,
                dwell_s: 0.0,
                ends: false,
            };
            if let Err(fault) = self.take(&unit) {
                self.progress.fault = Some(fault);
                return Ended::Faulty;
            }
        }
        self.run(blocks.as_mut())
    }

    /// The path begins anew, somewhere.
    pub(super) fn begin_path(&mut self, start: Position) {
        let first = self.plan.begin_path(start, self.distance());
        self.motion.begin(start, first);
        (self.gates.cursor, self.gates.open_to) = ((first, 0), first);
        (self.gates.dwell, self.progress.ended) = (None, false);
        self.backward = Backward::default();
        self.single.all_block_ends();
    }

    /// Takes a block into the path.
    fn take(&mut self, unit: &Unit) -> Result<(), Fault> {
        let mut around = Around {
            cycle_s: self.cycle_s,
            script: self.plc.script(),
            warnings: &mut self.record.warnings,
        };
        self.plan.take(unit, &mut around)
    }

    /// Runs a program to its end.
    fn run(&mut self, blocks: &mut dyn Blocks) -> Ended {
        let mut quiet = 0;
        loop {
            let mut any = self.plc();
            self.follow_script();
            let drive = self.drive_now();
            for _ in 0..ROUNDS {
                let done = if self.backward.is_on() {
                    self.act_backward()
                } else {
                    self.decode(blocks) | self.output_ahead(&drive) | self.act()
                };
                any |= done;
                if !done {
                    break;
                }
            }
            self.drop_start();
            self.lists();
            self.stand();
            self.limits();
            if self.progress.fault.is_some() {
                return Ended::Faulty;
            }
            if self.progress.ended {
                self.record.stands_for_nothing(self.t());
                return Ended::Completed;
            }
            if self.resets() && self.motion.still {
                self.reset();
                return Ended::Reset;
            }
            let moved = self.spend(drive);
            // In a dwell the time of what is output ahead comes nearer.
            let nears = self.gates.dwell.is_some() && !self.plan.leads.queue.is_empty();
            quiet = if any || moved || nears { 0 } else { quiet + 1 };
            // Twice without anything to do, and nothing changes until something comes from outside.
            if quiet < 2 {
                self.cycle += 1;
                continue;
            }
            let next = [
                self.plc.next_cycle(self.cycle, quiet),
                self.next_change(),
                self.gates.dwell,
            ];
            match next.into_iter().flatten().min() {
                Some(next) => self.cycle = next.max(self.cycle + 1),
                None => return Ended::Stuck,
            }
        }
    }

    /// Decodes as far ahead as there is room. Whether there was any block.
    fn decode(&mut self, blocks: &mut dyn Blocks) -> bool {
        let mut count = 0;
        while count < BLOCKS && !self.plan.decoding.ended && self.progress.fault.is_none() {
            if self.plan.decoding.holds {
                if !self.is_empty() {
                    break;
                }
                self.plan.decoding.holds = false;
                if !self.motion.stands {
                    let at = self.now();
                    self.stop(at);
                }
                self.take_over();
            }
            let last = self.plan.track.last();
            let done = if self.gates.cursor.0 == last {
                self.gates.cursor.1
            } else {
                0
            };
            if last > self.motion.reached + AHEAD || self.plan.track.actions(last).len() > ACTIONS + done {
                break;
            }
            if done > ACTIONS {
                self.plan.track.forget_done(done);
                self.gates.cursor.1 = 0;
            }
            count += 1;
            let taken = match blocks.next(&mut self.plan.in_force) {
                Ok(Some(unit)) => self.take(&unit),
                Ok(None) => {
                    self.plan.end();
                    self.plan.window.release(&mut self.plan.track);
                    Ok(())
                }
                Err(fault) => Err(self.plan.coded(fault)),
            };
            if let Err(fault) = taken {
                self.plan.window.release(&mut self.plan.track);
                self.plan.track.push_action(Action::Fault(Box::new(fault)));
                self.plan.decoding.ended = true;
            }
        }
        count > 0
    }

    /// The path goes on from where axes went on their own: all that is decoded is executed.
    fn take_over(&mut self) {
        if !self.motion.ended_at.known().is_empty() {
            let position = self.now().position;
            self.motion.path.set_position(position);
            self.plan.track.set_end(position);
            self.motion.ended_at = Position::UNKNOWN;
        }
    }

    /// All that is decoded is executed.
    fn is_empty(&self) -> bool {
        let last = self.plan.track.last();
        self.motion.reached == last && self.gates.cursor == (last, self.plan.track.actions(last).len())
    }

    /// Says which lists of active functions have changed.
    fn lists(&mut self) {
        let at = self.now();
        let record = &mut self.record;
        self.plan
            .ranges
            .changed(|target, letter, numbers| record.active(target, letter, numbers, at));
    }

    /// What the script says of this moment.
    fn follow_script(&mut self) {
        let t = self.t() + 0.5 * self.cycle_s;
        let simulated = self
            .plc
            .script()
            .is_some_and(|script| script.simulated.iter().any(|range| range.contains(&t)));
        if simulated != self.gates.simulated {
            self.gates.simulated = simulated;
            self.gates.open_to = self.gates.cursor.0;
        }
        self.follow_single(t);
        if self.cycle.is_multiple_of(FORGET) {
            self.plan.forget_before(self.motion.reached);
        }
    }

    /// What the script says of single block at this moment.
    fn follow_single(&mut self, t: f64) {
        let Some(script) = self.plc.script() else { return };
        if self.single.switch(script, t) {
            self.gates.open_to = self.gates.cursor.0;
        }
        if self.single.is_unseen() {
            let distance = self.distance_of(&braked(self.motion.path.clone()));
            self.single.see(distance);
        }
        self.single.take_starts(script, self.cycle, self.cycle_s);
    }

    /// A start while the path does not stand at the end of a block has no effect.
    fn drop_start(&mut self) {
        if let Some(start) = self.single.take_start() {
            self.record.warnings.push(Warning {
                message: format!(
                    "the start at {start} s has no effect: the path does not stand at the end of a block"
                ),
                program: self.progress.program.clone(),
                block: self.plan.track.block_before(self.motion.reached).to_string(),
            });
        }
    }

    /// Whether a reset is to come now.
    pub(super) fn resets(&self) -> bool {
        let next = self
            .plc
            .script()
            .and_then(|script| script.resets.get(self.progress.reset_count));
        next.is_some_and(|reset| cycle_at(*reset, self.cycle_s) <= self.cycle)
    }

    /// Drops all that is open: the path stands [004:48] (inferred).
    fn reset(&mut self) {
        self.progress.reset_count += 1;
        self.record.stands_for_nothing(self.t());
        if !self.motion.stands {
            let at = self.now();
            self.stop(at);
        }
        self.plc.reset();
        self.plan.ranges.reset();
        self.plan.decoding.late.iter_mut().for_each(Vec::clear);
        self.lists();
    }

    /// The block in which the path is, or at whose end it stands, for faults of no block.
    pub(super) fn here(&self) -> Place {
        Place {
            program: self.progress.program.as_str().into(),
            block: self.block_now(),
            line: 0,
        }
    }

    /// Named limits instead of runs without end.
    fn limits(&mut self) {
        let Bounds { time_s, blocks } = self.progress.bounds;
        let message = if self.plan.decoding.units > blocks {
            format!("more than {blocks} blocks")
        } else if self.t() > time_s {
            format!("longer than {time_s} s")
        } else if self.record.events.len() > EVENTS {
            format!("more than {EVENTS} events")
        } else {
            return;
        };
        self.progress.fault = Some(named(&self.here(), "endless", message));
    }
}
