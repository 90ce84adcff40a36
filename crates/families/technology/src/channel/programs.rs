//! Programs one after the other.
//!
//! Decision: What was decoded before a faulty block is executed, then the run ends

use bahn_din::{Place, Unit};
use bahn_kernel::gates::Action;
use bahn_path::Position;

use super::Channel;
use super::fault::named;
use super::in_force::InForce;
use super::own::Own;
use super::record::{self, EVENTS};
use super::skipped::Begun;
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

enum Ended {
    Completed,
    Reset,
    Faulty,
    /// Nothing can move any more, or the script has ended the run.
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
        let Channel { plan, side, .. } = &mut channel;
        match plan.search(run, block, start, &mut side.ranges, side.cycle_s) {
            Ok(mut found) => {
                channel.progress.skipped = Some(std::mem::take(&mut found.skipped));
                begun = Some(found);
            }
            Err(fault) => channel.side.fault = Some(fault),
        }
    }
    let first = begun.as_ref().map_or(0, |begun| begun.index);
    for index in first..run.programs.count() {
        let ended = channel.open(run, index, begun.take());
        programs.push(ProgramEnd {
            program: run.programs.name(index),
            completed: matches!(ended, Ended::Completed),
            time_s: record::time(channel.side.t()),
        });
        if matches!(ended, Ended::Faulty | Ended::Stuck) {
            break;
        }
    }
    let end_s = channel.side.t();
    channel.fetch_the_rest();
    let completed =
        first + programs.len() == run.programs.count() && programs.iter().all(|program| program.completed);
    if completed {
        channel.side.record.drop_last_stop();
    }
    Report {
        completed,
        error: channel.side.fault.take(),
        time_s: record::time(end_s),
        cycle_s: channel.side.cycle_s,
        path_end: Coordinates(channel.now().position),
        events: channel.side.record.events,
        waits: channel.side.record.waits,
        skipped: channel.progress.skipped,
        programs,
        warnings: channel.side.record.warnings,
        samples: channel.side.record.samples,
    }
}

impl Channel<'_> {
    /// After the end of the run the PLC fetches what was output last: the time of the run does not wait for it.
    fn fetch_the_rest(&mut self) {
        self.side.plc.keep_fetches();
        while let Some(cycle) = self.side.plc.next_cycle(self.side.cycle, 0) {
            self.side.cycle = self.side.cycle.max(cycle);
            self.plc();
        }
    }

    /// Runs a program of a run, from a block on where one was looked for.
    fn open<'r>(&mut self, run: &'r Run<'_>, index: usize, begun: Option<Begun<'r>>) -> Ended {
        self.progress.program = run.programs.name(index);
        if self.side.fault.is_some() {
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
                        self.side.fault = Some(fault);
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
        self.taking().begin_program();
        self.close();
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
                self.side.fault = Some(fault);
                return Ended::Faulty;
            }
        }
        self.run(blocks.as_mut())
    }

    /// The path begins anew, somewhere.
    fn begin_path(&mut self, start: Position) {
        self.gates.begin(start);
        self.side.beside.clear();
        self.side.record.begin_path();
        self.side.ended = false;
    }

    /// Takes a block into the path.
    fn take(&mut self, unit: &Unit) -> Result<(), Fault> {
        let taken = self.taking().take(unit);
        self.close();
        taken
    }

    /// Tells the gates whether anything comes after what is known.
    fn close(&mut self) {
        self.gates.closed = self.plan.decoding.holds || self.plan.decoding.ended;
    }

    /// Runs a program to its end.
    fn run(&mut self, blocks: &mut dyn Blocks) -> Ended {
        let mut quiet = 0;
        loop {
            let mut any = self.plc();
            self.follow_script();
            let drive = self.drive_now();
            for _ in 0..ROUNDS {
                let done = if self.gates.is_backward() {
                    self.gates.act_backward(&mut self.side)
                } else {
                    self.decode(blocks)
                        | self.gates.output_ahead(&drive, &mut self.side)
                        | self.gates.act(&mut self.side)
                };
                any |= done;
                if !done {
                    break;
                }
            }
            self.drop_start();
            let at = self.now();
            self.side.lists(at);
            self.stand();
            self.limits();
            if self.side.fault.is_some() {
                return Ended::Faulty;
            }
            if self.side.ended {
                let t = self.side.t();
                self.side.record.stands_for_nothing(t);
                return Ended::Completed;
            }
            if self.is_over() {
                return Ended::Stuck;
            }
            if self.resets() && self.gates.is_still() {
                self.reset();
                return Ended::Reset;
            }
            let moved = self.spend(drive);
            // In a dwell the time of what is output ahead comes nearer.
            let nears = self.gates.dwells_until().is_some() && !self.gates.leads.is_empty();
            quiet = if any || moved || nears { 0 } else { quiet + 1 };
            // Twice without anything to do, and nothing changes until something comes from outside.
            if quiet < 2 {
                self.side.cycle += 1;
                continue;
            }
            let next = [
                self.side.plc.next_cycle(self.side.cycle, quiet),
                self.next_change(),
                self.gates.dwells_until(),
            ];
            match next.into_iter().flatten().min() {
                Some(next) => self.side.cycle = next.max(self.side.cycle + 1),
                None => return Ended::Stuck,
            }
        }
    }

    /// Decodes as far ahead as there is room. Whether there was any block.
    fn decode(&mut self, blocks: &mut dyn Blocks) -> bool {
        let mut count = 0;
        while count < BLOCKS && !self.plan.decoding.ended && self.side.fault.is_none() {
            if self.plan.decoding.holds {
                if !self.gates.is_empty() {
                    break;
                }
                self.plan.decoding.holds = false;
                self.come_to_rest();
                self.take_over();
            }
            let last = self.gates.places.last();
            let done = self.gates.done_at_end();
            let known = self.gates.places.actions(last).len();
            if last > self.gates.reached() + AHEAD || known > ACTIONS + done {
                break;
            }
            if done > ACTIONS {
                self.gates.forget_done();
            }
            count += 1;
            let taken = match blocks.next(&mut self.plan.in_force) {
                Ok(Some(unit)) => self.take(&unit),
                Ok(None) => {
                    self.taking().end();
                    self.gates.release();
                    Ok(())
                }
                Err(fault) => Err(self.plan.coded(fault)),
            };
            if let Err(fault) = taken {
                self.gates.release();
                let fault = Own::Fault(Box::new(fault));
                self.gates.places.push_action(Action::Own(fault));
                self.plan.decoding.ended = true;
            }
        }
        self.close();
        count > 0
    }

    /// The path goes on from where axes went on their own: all that is decoded is executed.
    fn take_over(&mut self) {
        let position = self.now().position;
        if self.side.beside.take_over() {
            self.gates.stand_at(position);
        }
    }

    /// What the script says of this moment.
    fn follow_script(&mut self) {
        let t = self.side.t() + 0.5 * self.side.cycle_s;
        let script = self.side.plc.script();
        let simulated =
            script.is_some_and(|script| script.driving.simulated.iter().any(|range| range.contains(&t)));
        if simulated != self.side.simulated {
            self.side.simulated = simulated;
            self.gates.look_anew();
        }
        if let Some(script) = script {
            self.gates
                .single_block(script.driving.singles.iter().any(|range| range.contains(&t)));
            let cycle = self.side.cycle;
            let over = |start: &f64| cycle_at(*start, self.side.cycle_s) <= cycle;
            let starts = script
                .driving
                .starts
                .get(self.progress.starts..)
                .unwrap_or_default();
            for start in starts.iter().take_while(|start| over(start)) {
                self.progress.starts += 1;
                self.gates.start(*start);
            }
        }
        if self.side.cycle.is_multiple_of(FORGET) {
            let next = self.side.orders.next();
            let oldest = self.gates.forget().unwrap_or(next);
            self.side.orders.forget_before(oldest);
        }
    }

    /// A start while the path does not stand at the end of a block has no effect.
    fn drop_start(&mut self) {
        if let Some(start) = self.gates.take_start() {
            self.side.record.warnings.push(Warning {
                message: format!(
                    "the start at {start} s has no effect: the path does not stand at the end of a block"
                ),
                program: self.progress.program.clone(),
                block: self.gates.places.block_before(self.gates.reached()).to_string(),
            });
        }
    }

    /// Whether a reset is to come now.
    pub(super) fn resets(&self) -> bool {
        let next = self
            .side
            .plc
            .script()
            .and_then(|script| script.driving.resets.get(self.progress.reset_count));
        next.is_some_and(|reset| cycle_at(*reset, self.side.cycle_s) <= self.side.cycle)
    }

    /// Whether the script has ended the run, whatever is still to come.
    fn is_over(&self) -> bool {
        let end = self.side.plc.script().and_then(|script| script.driving.end);
        end.is_some_and(|end| cycle_at(end, self.side.cycle_s) <= self.side.cycle)
    }

    /// Drops all that is open: the path stands [004:48] (inferred).
    fn reset(&mut self) {
        self.progress.reset_count += 1;
        let t = self.side.t();
        self.side.record.stands_for_nothing(t);
        self.come_to_rest();
        self.side.reset();
        let at = self.now();
        self.side.lists(at);
    }

    /// The block in which the path is, or at whose end it stands, for faults of no block.
    pub(super) fn here(&self) -> Place {
        Place {
            program: self.progress.program.as_str().into(),
            block: self.gates.block_now(),
            line: 0,
        }
    }

    /// Named limits instead of runs without end.
    fn limits(&mut self) {
        let Bounds { time_s, blocks } = self.progress.bounds;
        let message = if self.plan.decoding.units > blocks {
            format!("more than {blocks} blocks")
        } else if self.side.t() > time_s {
            format!("longer than {time_s} s")
        } else if self.side.record.events.len() > EVENTS {
            format!("more than {EVENTS} events")
        } else {
            return;
        };
        self.side.fault = Some(named(&self.here(), "endless", message));
    }
}
