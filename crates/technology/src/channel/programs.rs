//! Programs one behind the other.

use bahn_din::{Place, Unit};
use bahn_path::Position;

use super::Channel;
use super::backward::Backward;
use super::fault::named;
use super::in_force::InForce;
use super::record::{self, EVENTS};
use super::skipped::Begun;
use super::track::{Deed, Track};
use crate::bounds::Bounds;
use crate::plc::{PlcMemory, cycle_at};
use crate::report::{Coordinates, Fault, ProgramEnd, Report};
use crate::run::{Blocks, Run};

/// Elements of the path that are decoded ahead of it at most.
const AHEAD: u64 = 300;
/// Deeds at the end of what is known, and blocks at a time.
const DEEDS: usize = 2000;
const BLOCKS: usize = 2000;
/// Rounds of decoding and doing in a cycle.
const ROUNDS: usize = 8;
/// What lies behind is forgotten every so many cycles.
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
    /// Runs them.
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
    channel.bounds = run.bounds;
    let mut programs = Vec::new();
    let mut begun = None;
    if let Some(block) = run.from {
        match channel.search(run, block) {
            Ok(found) => begun = Some(found),
            Err(fault) => channel.fault = Some(fault),
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
        error: channel.fault.take(),
        time_s: record::time(end_s),
        cycle_s: channel.cycle_s,
        path_end: Coordinates(channel.now().position),
        events: channel.record.events,
        waits: channel.record.waits,
        skipped: channel.skipped,
        programs,
        warnings: channel.record.warnings,
        samples: channel.record.samples,
    }
}

impl Channel<'_> {
    /// Behind the end of the run the PLC fetches what was output last: the time of the run does not wait for it.
    fn fetch_the_rest(&mut self) {
        self.plc.keep_fetches();
        while let Some(cycle) = self.plc.next_cycle(self.cycle, 0) {
            self.cycle = self.cycle.max(cycle);
            self.plc();
        }
    }

    /// Runs a program of a run, from a block on where one was looked for.
    fn open<'r>(&mut self, run: &'r Run<'_>, index: usize, begun: Option<Begun<'r>>) -> Ended {
        self.program = run.programs.name(index);
        if self.fault.is_some() {
            return Ended::Faulty;
        }
        let begun = match begun {
            Some(begun) => begun,
            None => {
                self.in_force = InForce::new(self.settings);
                let position = self.now().position;
                match run.programs.open(index, &position) {
                    Ok(blocks) => Begun {
                        index,
                        blocks,
                        position,
                        commands: Vec::new(),
                    },
                    Err(fault) => {
                        self.fault = Some(fault);
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
        self.begin_program();
        if !commands.is_empty() {
            let unit = Unit {
                place: Place {
                    program: self.program.as_str().into(),
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
                self.fault = Some(fault);
                return Ended::Faulty;
            }
        }
        self.run(blocks.as_mut())
    }

    /// The path begins anew, somewhere.
    pub(super) fn begin_path(&mut self, start: Position) {
        let (first, way) = (self.track.last() + 1, self.way());
        self.path.clear();
        self.path.set_position(start);
        self.track = Track::new(start, first, way);
        self.window.begin(way);
        self.leads.begin(way);
        (self.fed, self.reached, self.open_to) = (first, first, first);
        self.cursor = (first, 0);
        (self.dwell, self.ended, self.part) = (None, false, None);
        self.backward = Backward::default();
        self.all_block_ends();
        self.ended_at = Position::UNKNOWN;
        self.independent.clear();
    }

    /// The fault of a block with the code that a variable has given it.
    pub(super) fn coded(&mut self, fault: Fault) -> Fault {
        match self.in_force.code.take() {
            Some(code) => Fault { code, ..fault },
            None => fault,
        }
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
            if self.fault.is_some() {
                return Ended::Faulty;
            }
            if self.ended {
                self.record.stands_for_nothing(self.t());
                return Ended::Completed;
            }
            if self.resets() && self.still {
                self.reset();
                return Ended::Reset;
            }
            let moved = self.spend(drive);
            // In a dwell the time of what is output ahead comes nearer.
            let nears = self.dwell.is_some() && !self.leads.queue.is_empty();
            quiet = if any || moved || nears { 0 } else { quiet + 1 };
            // Twice without anything to do, and nothing changes until something comes from outside.
            if quiet < 2 {
                self.cycle += 1;
                continue;
            }
            let next = [
                self.plc.next_cycle(self.cycle, quiet),
                self.next_change(),
                self.dwell,
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
        while count < BLOCKS && !self.decoding.ended && self.fault.is_none() {
            if self.decoding.holds {
                if !self.is_empty() {
                    break;
                }
                self.decoding.holds = false;
                if !self.stands {
                    let at = self.now();
                    self.stop(at);
                }
                self.take_over();
            }
            let last = self.track.last();
            let done = if self.cursor.0 == last { self.cursor.1 } else { 0 };
            if last > self.reached + AHEAD || self.track.deeds(last).len() > DEEDS + done {
                break;
            }
            if done > DEEDS {
                self.track.forget_done(done);
                self.cursor.1 = 0;
            }
            count += 1;
            let taken = match blocks.next(&mut self.in_force) {
                Ok(Some(unit)) => self.take(&unit),
                Ok(None) => {
                    self.end();
                    self.window.release(&mut self.track);
                    Ok(())
                }
                Err(fault) => Err(self.coded(fault)),
            };
            if let Err(fault) = taken {
                self.window.release(&mut self.track);
                self.track.push_deed(Deed::Fault(Box::new(fault)));
                self.decoding.ended = true;
            }
        }
        count > 0
    }

    /// The path goes on from where axes went on their own: all that is decoded is executed.
    fn take_over(&mut self) {
        if !self.ended_at.known().is_empty() {
            let position = self.now().position;
            self.path.set_position(position);
            self.track.set_end(position);
            self.ended_at = Position::UNKNOWN;
        }
    }

    /// All that is decoded is executed.
    fn is_empty(&self) -> bool {
        let last = self.track.last();
        self.reached == last && self.cursor == (last, self.track.deeds(last).len())
    }

    /// Says which lists of active functions have changed.
    fn lists(&mut self) {
        let at = self.now();
        let record = &mut self.record;
        self.ranges
            .changed(|target, letter, numbers| record.active(target, letter, numbers, at));
    }

    /// What the script says of this moment.
    fn follow_script(&mut self) {
        let t = self.t() + 0.5 * self.cycle_s;
        let simulated = self
            .plc
            .script()
            .is_some_and(|script| script.simulated.iter().any(|range| range.contains(&t)));
        if simulated != self.simulated {
            self.simulated = simulated;
            self.open_to = self.cursor.0;
        }
        self.follow_single(t);
        if self.cycle.is_multiple_of(FORGET) {
            let first = self.track.forget_before(self.reached);
            let ahead = self.leads.forget_before(self.track.way(self.track.first()));
            let next = self.orders.next();
            self.orders
                .forget_before(first.into_iter().chain(ahead).min().unwrap_or(next));
        }
    }

    /// Whether a reset is to come now.
    pub(super) fn resets(&self) -> bool {
        let next = self
            .plc
            .script()
            .and_then(|script| script.resets.get(self.reset_count));
        next.is_some_and(|reset| cycle_at(*reset, self.cycle_s) <= self.cycle)
    }

    /// Drops all that is open: the path stands [004:48] (inferred).
    fn reset(&mut self) {
        self.reset_count += 1;
        self.record.stands_for_nothing(self.t());
        if !self.stands {
            let at = self.now();
            self.stop(at);
        }
        self.plc.reset();
        self.ranges.reset();
        self.decoding.late.iter_mut().for_each(Vec::clear);
        self.lists();
    }

    /// The block in which the path is, or at whose end it stands, for faults of no block.
    pub(super) fn here(&self) -> Place {
        Place {
            program: self.program.as_str().into(),
            block: self.block_now(),
            line: 0,
        }
    }

    /// Named limits instead of runs without end.
    fn limits(&mut self) {
        let Bounds { time_s, blocks } = self.bounds;
        let message = if self.decoding.units > blocks {
            format!("more than {blocks} blocks")
        } else if self.t() > time_s {
            format!("longer than {time_s} s")
        } else if self.record.events.len() > EVENTS {
            format!("more than {EVENTS} events")
        } else {
            return;
        };
        self.fault = Some(named(&self.here(), "endless", message));
    }
}
