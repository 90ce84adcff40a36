//! Restart at the contour: the program is read without a movement up to the block that was broken off, the axes go to where it
//! begins, and it goes on there [002:4156-4216].
//!
//! Decision: A System 900 restarts at the block by its place in the order of execution, P8807, so that loops are passed as often as
//! before; within a cycle at its first block. Axes go there in one line with P8816, and stop there
//!
//! Decision: In the simulation M functions with bit 5 go out, others and branches do not; parameters are written and speeds
//! given; M0 and dwells do not stop it

use bahn_kernel::Outputs;
use bahn_path::{
    Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position, Step, TechnologyFunction,
};
use bahn_system900::ChannelParameter;

use crate::channel::{Restart, Site};
use crate::machine::Machine;
use crate::message::Kind;
use crate::restart_place::show;

/// Elements that one call of prepare passes over.
const BUDGET: usize = 256;

/// A program begins, as a restart or not: the place from which it is read. A restart reads it from where the axes stood when it
/// began, as increments need.
pub(crate) fn begin(machine: &mut Machine, k: usize, here: Position) -> Position {
    let number = k as u8 + 1;
    let [program, _] = machine.start_of(k);
    let of = |parameter| machine.memory.of_channel(number, parameter).whole().unwrap_or(0);
    let wanted = of(ChannelParameter::Restart) == 1;
    let is_kept = of(ChannelParameter::AbortProgram) == program;
    let place = u64::try_from(of(ChannelParameter::AbortPlace)).unwrap_or(0);
    let Some(channel) = machine.channels.get_mut(k) else {
        return here;
    };
    let runs_program = channel.runs.is_none();
    channel.restart = (wanted && is_kept && runs_program && place > 0).then_some(Restart::Simulating(place));
    let from = match (channel.restart, runs_program) {
        (Some(_), _) => channel.began_at.unwrap_or(here),
        (None, true) => *channel.began_at.insert(here),
        (None, false) => here,
    };
    let info = i64::from(channel.restart.is_some());
    show(&mut machine.memory, number, info);
    if wanted && info == 0 && runs_program {
        machine.memory.set_channel(number, ChannelParameter::Restart, 0);
    }
    from
}

/// Reads on in a simulation, outside the cycle. Whether one is on its way.
pub(crate) fn simulate(machine: &mut Machine, k: usize) -> bool {
    let Some(channel) = machine.channels.get(k) else {
        return false;
    };
    let Some(Restart::Simulating(target)) = channel.restart else {
        return false;
    };
    if channel.waits_for_m || !channel.run.progress().goes_on() {
        return true;
    }
    let rapid = rapid(machine, k);
    machine.give_memory(k);
    let passed = pass(machine, k, target, rapid);
    machine.take_memory(k);
    let Some((_, _, mut site)) = machine.parts(k) else {
        return true;
    };
    for function in &passed.functions {
        put_out(&mut site, function);
    }
    let number = k as u8 + 1;
    match passed.end {
        End::Open => {}
        End::Found => {
            if let Some(channel) = machine.channels.get_mut(k) {
                channel.restart = Some(Restart::Approaching(target));
            }
            show(&mut machine.memory, number, 2);
        }
        End::Missing => {
            let text = "restart at the contour: the block that was broken off does not come";
            machine.say(0, number, None, Kind::High, text.into());
        }
    }
    true
}

/// What a part of the simulation has come to.
enum End {
    Open,
    Found,
    /// The program is over, or has a fault: the run says which.
    Missing,
}

struct Passed {
    end: End,
    functions: Vec<TechnologyFunction>,
}

fn pass(machine: &mut Machine, k: usize, target: u64, rapid: FeedRate) -> Passed {
    let mut passed = Passed {
        end: End::Open,
        functions: Vec::new(),
    };
    let Some((_, Some(feeder), mut site)) = machine.parts(k) else {
        return passed;
    };
    let here = bahn_kernel::RunFamily::acting(&mut site).here();
    feeder.allow_work();
    for _ in 0..BUDGET {
        match feeder.next() {
            Step::Element(element) if element.sequence >= target => {
                let way = |curve| {
                    let before = target.saturating_sub(1);
                    PathElement::new(element.block, before, curve, [here, element.start], rapid)
                };
                let mut rest = way(Curve::Hold);
                rest.start = element.start;
                let line = way(Curve::Line);
                let approach = [line, rest, element];
                let from = usize::from(approach[0].start == approach[0].end);
                feeder.put_back(approach.into_iter().skip(from));
                passed.end = End::Found;
                return passed;
            }
            Step::Element(element) => {
                feeder.forget_before(element.sequence);
                passed.functions.extend(element.functions().iter().cloned());
            }
            // What was ordered before it is done first.
            Step::Barrier(_) => {
                feeder.resume(LiveData::default());
                return passed;
            }
            Step::Starved => return passed,
            Step::End | Step::Error(_) => {
                passed.end = End::Missing;
                return passed;
            }
        }
    }
    passed
}

/// P8816: the feed towards the contour.
fn rapid(machine: &Machine, k: usize) -> FeedRate {
    let feed = machine
        .memory
        .of_channel(k as u8 + 1, ChannelParameter::RapidFeed);
    let feed = feed.number().filter(|feed| *feed > 0.0);
    feed.map_or(FeedRate::Rapid, FeedRate::Programmed)
}

fn put_out(site: &mut Site, function: &TechnologyFunction) {
    match &function.function {
        Function::M(m) if site.m.restarts(*m) => site.transfer(*m, None),
        Function::M(_) | Function::Branch { .. } | Function::Residual => {}
        other => {
            site.output(other);
        }
    }
}

/// The contour is reached: P8686 and P8804 are 0 from then on.
pub(crate) fn follow(machine: &mut Machine) {
    for channel in &mut machine.channels {
        let Some(Restart::Approaching(target)) = channel.restart else {
            continue;
        };
        let executed = channel.run.element().map(|element| element.sequence);
        if executed.is_some_and(|executed| executed >= target) {
            channel.restart = None;
            show(&mut machine.memory, channel.number, 0);
            machine
                .memory
                .set_channel(channel.number, ChannelParameter::Restart, 0);
        }
    }
}

/// Where the block stands that is executed, for a restart: in a cycle, where that has begun.
pub(crate) fn note_place(machine: &mut Machine) {
    for channel in &mut machine.channels {
        let Some(element) = channel.run.element() else {
            continue;
        };
        let in_cycle = element.block.program > 0;
        channel.place = match (in_cycle, channel.place) {
            (true, Some((place, true))) => Some((place, true)),
            _ => Some((element.sequence, in_cycle)),
        };
    }
}

/// A program has come to its end: nothing of it is kept.
pub(crate) fn forget(machine: &mut Machine, k: usize) {
    if machine
        .channels
        .get(k)
        .is_some_and(|channel| channel.runs.is_some())
    {
        return;
    }
    for parameter in [
        ChannelParameter::AbortProgram,
        ChannelParameter::AbortBlock,
        ChannelParameter::AbortPlace,
    ] {
        machine.memory.set_channel(k as u8 + 1, parameter, 0);
    }
}
