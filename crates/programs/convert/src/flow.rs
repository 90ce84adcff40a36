//! Which G functions may be in force before each block of a program, wherever it is reached from.
//!
//! What a subprogram leaves in force is found once, relative to what is in force at its call: a subprogram that says nothing
//! of G90 leaves it to each of its calls as it was there.
//!
//! Decision: Behind a call of a DIN/ISO program any G function may be in force; a subprogram leaves behind what it
//! says itself, and else what was in force at its call

use std::collections::{BTreeMap, BTreeSet};

use bahn_path::{Axis, Sense};
use bahn_program::{CycleWord, Distance, InForce, Modality, Motion, Operation, PathFunction, Program};

use crate::lower::{State, bare};

/// A part of a set that stands for what was in force where the subprogram was called.
const AS_CALLED: u16 = 1 << 15;
/// All that the four parts of [`States`] can be.
const ANY: [u16; PARTS] = [(1 << 13) - 1, 0b11, 0b111, 0b111];
const PARTS: usize = 4;
const FUNCTION: usize = 0;
const DISTANCE: usize = 1;
const DIRECTION: usize = 2;
const PLANE: usize = 3;

const DISTANCES: [Distance; 2] = [Distance::Absolute, Distance::Incremental];
const DIRECTIONS: [Option<Sense>; 3] = [None, Some(Sense::Clockwise), Some(Sense::CounterClockwise)];
const PLANES: [Axis; 3] = [Axis::Z, Axis::Y, Axis::X];

/// All that may be in force: a set for the path function, G90 or G91, the direction of arcs and the tool axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct States([u16; PARTS]);

impl States {
    /// Any function may be in force.
    pub const UNKNOWN: States = States(ANY);
    const CALLED: States = States([AS_CALLED; PARTS]);

    /// What a run begins with.
    pub fn start() -> States {
        let state = State::default();
        let function = PathFunction::ALL
            .iter()
            .position(|(_, function)| *function == state.in_force.function);
        States([1 << function.unwrap_or(0), 1, 1, 1])
    }

    fn is_unreached(self) -> bool {
        self.0[FUNCTION] == 0
    }

    fn union(self, other: States) -> States {
        States(std::array::from_fn(|part| self.part(part) | other.part(part)))
    }

    fn part(self, part: usize) -> u16 {
        self.0.get(part).copied().unwrap_or_default()
    }

    /// With what a block says.
    fn after(self, change: States) -> States {
        States(std::array::from_fn(|part| match change.part(part) {
            0 => self.part(part),
            said => said,
        }))
    }

    /// This, left by a subprogram, where it was called with `call` in force.
    fn called_with(self, call: States) -> States {
        States(std::array::from_fn(|part| match self.part(part) {
            left if left & AS_CALLED != 0 => (left & !AS_CALLED) | call.part(part),
            left => left,
        }))
    }

    /// Every state that it allows.
    pub fn each(self) -> impl Iterator<Item = State> {
        let [functions, distances, directions, planes] = self.0;
        let of = |set: u16, index: usize| set & (1 << index) != 0;
        let functions = PathFunction::ALL
            .iter()
            .enumerate()
            .filter(move |(index, _)| of(functions, *index));
        functions.flat_map(move |(_, (_, function))| {
            let distances = DISTANCES
                .iter()
                .enumerate()
                .filter(move |(index, _)| of(distances, *index));
            distances.flat_map(move |(_, distance)| {
                let directions = DIRECTIONS
                    .iter()
                    .enumerate()
                    .filter(move |(index, _)| of(directions, *index));
                directions.flat_map(move |(_, direction)| {
                    let planes = PLANES
                        .iter()
                        .enumerate()
                        .filter(move |(index, _)| of(planes, *index));
                    planes.map(move |(_, plane)| State {
                        in_force: InForce {
                            function: *function,
                            distance: *distance,
                            direction: *direction,
                        },
                        plane: *plane,
                    })
                })
            })
        })
    }
}

/// Where the run goes after a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Successor {
    Next,
    End,
    Jump(u16),
    Call(u16),
    Return,
    /// Another program may leave anything in force.
    Program,
}

#[derive(Clone, Copy, Debug)]
struct Step {
    change: States,
    successor: Successor,
}

/// What may be in force before each block.
#[derive(Debug)]
pub(crate) struct Flow {
    before: Vec<States>,
}

impl Flow {
    /// Follows a program that begins with `entry`; `foreign` says of a program that it may leave other functions in
    /// force after its call.
    pub fn of(program: &Program, entry: States, foreign: &dyn Fn(&str) -> bool) -> Flow {
        let mut analysis = Analysis::of(program, foreign);
        analysis.find_effects();
        let mut before = vec![States::default(); analysis.steps.len()];
        if let Some(first) = before.first_mut() {
            *first = entry;
        }
        while analysis.sweep(&mut before, 0..analysis.steps.len(), true) {}
        // What nothing reaches is read as it stands.
        let mut last = entry;
        for (step, states) in analysis.steps.iter().zip(&mut before) {
            if states.is_unreached() {
                *states = last;
            }
            last = states.after(step.change);
        }
        Flow { before }
    }

    /// What may be in force before a block.
    pub fn before(&self, block: usize) -> States {
        self.before.get(block).copied().unwrap_or(States::UNKNOWN)
    }
}

struct Analysis {
    steps: Vec<Step>,
    labels: BTreeMap<u16, usize>,
    /// Labels of contours, which cycles read from wherever they are called.
    contours: BTreeSet<u16>,
    /// What a subprogram leaves in force, relative to its call.
    effects: BTreeMap<u16, States>,
}

impl Analysis {
    fn of(program: &Program, foreign: &dyn Fn(&str) -> bool) -> Analysis {
        let mut analysis = Analysis {
            steps: Vec::new(),
            labels: program
                .labels()
                .map(|(label, block)| (label, block as usize))
                .collect(),
            contours: BTreeSet::new(),
            effects: BTreeMap::new(),
        };
        // A cycle may be a program that leaves other functions in force.
        let mut cycle_is_foreign = false;
        for numbered in program.blocks() {
            let operation = &numbered.block.operation;
            let mut step = Step {
                change: States::default(),
                successor: Successor::Next,
            };
            for part in operation.parts() {
                if let Operation::Cycle(block) = part {
                    for word in &block.words {
                        match word {
                            CycleWord::Labels(labels) => analysis.contours.extend(labels.iter()),
                            CycleWord::Text(name) if block.number == 12 => cycle_is_foreign |= foreign(name),
                            _ => {}
                        }
                    }
                }
                step.successor = match part {
                    Operation::End(_) => Successor::End,
                    Operation::Jump { label, .. } => Successor::Jump(*label),
                    Operation::CallLabel { label, repeats: None } => Successor::Call(*label),
                    Operation::CallLabel { label, .. } => Successor::Jump(*label),
                    Operation::Label(0) => Successor::Return,
                    Operation::CallProgram(name) if foreign(name) => Successor::Program,
                    _ => step.successor,
                };
            }
            if operation.m().is_some_and(|m| m.contains(2) || m.contains(30)) {
                step.successor = Successor::End;
            } else if cycle_is_foreign {
                step.successor = Successor::Program;
            }
            step.change = said(operation);
            analysis.steps.push(step);
        }
        analysis
    }

    /// What each subprogram that is called leaves in force; those that call others are looked at again.
    fn find_effects(&mut self) {
        let called: BTreeSet<u16> = self
            .steps
            .iter()
            .filter_map(|step| match step.successor {
                Successor::Call(label) => Some(label),
                _ => None,
            })
            .collect();
        for _ in 0..=called.len() {
            let mut changed = false;
            for label in &called {
                let found = self.effect(*label);
                changed |= self.effects.insert(*label, found) != Some(found);
            }
            if !changed {
                return;
            }
        }
    }

    /// From a label to the LBL 0 after it.
    fn effect(&self, label: u16) -> States {
        let Some(&start) = self.labels.get(&label) else {
            return States::default();
        };
        let after = self.steps.iter().skip(start);
        let length = after
            .take_while(|step| step.successor != Successor::Return)
            .count();
        let end = start + length;
        let mut before = vec![States::default(); length + 1];
        if let Some(first) = before.first_mut() {
            *first = States::CALLED;
        }
        while self.sweep(&mut before, start..end + 1, false) {}
        before.last().copied().unwrap_or_default()
    }

    /// Carries all states of a range in one direction along it; `true` if any was new. The states of a call go into its
    /// subprogram where that is wanted.
    fn sweep(&self, before: &mut [States], range: std::ops::Range<usize>, enter: bool) -> bool {
        let mut changed = false;
        let mut all = States::default();
        let mut add = |before: &mut [States], to: usize, states: States| {
            let place = to.checked_sub(range.start).and_then(|at| before.get_mut(at));
            if let Some(place) = place.filter(|_| !states.is_unreached()) {
                let more = place.union(states);
                changed |= more != *place;
                *place = more;
            }
        };
        for (at, step) in self.steps.iter().enumerate().take(range.end).skip(range.start) {
            let here = before.get(at - range.start).copied().unwrap_or_default();
            if here.is_unreached() {
                continue;
            }
            let after = here.after(step.change);
            all = all.union(after);
            match step.successor {
                Successor::End => {}
                Successor::Next | Successor::Return => add(before, at + 1, after),
                Successor::Program => add(before, at + 1, States::UNKNOWN),
                Successor::Jump(label) => {
                    add(before, at + 1, after);
                    if let Some(target) = self.labels.get(&label) {
                        add(before, *target, after);
                    }
                }
                Successor::Call(label) => {
                    let left = self.effects.get(&label).copied().unwrap_or_default();
                    add(before, at + 1, left.called_with(after));
                    if let Some(target) = self.labels.get(&label).filter(|_| enter) {
                        add(before, *target, after);
                    }
                }
            }
        }
        for label in self.contours.iter().filter(|_| enter) {
            if let Some(target) = self.labels.get(label) {
                add(before, *target, all);
            }
        }
        changed
    }
}

/// What a block says of the functions in force.
fn said(operation: &Operation) -> States {
    let mut change = States::default();
    if let Operation::Modal(block) = operation {
        take(&mut change, &block.modality);
    }
    for part in operation.parts() {
        match part {
            Operation::Motion(Motion {
                modal: Some(modality),
                ..
            }) => take(&mut change, modality),
            Operation::ToolCall { axis: Some(axis), .. } => change.0[PLANE] = plane(*axis),
            // The axis of the tool before, or Z.
            Operation::ToolCall { tool: Some(_), .. } => change.0[PLANE] = ANY[PLANE],
            _ => {}
        }
    }
    change
}

fn plane(axis: Axis) -> u16 {
    let index = PLANES.iter().position(|plane| *plane == axis);
    index.map_or(ANY[PLANE], |index| 1 << index)
}

fn take(change: &mut States, modality: &Modality) {
    if let Some(function) = modality.function {
        let index = PathFunction::ALL
            .iter()
            .position(|(_, listed)| *listed == function);
        change.0[FUNCTION] = 1 << index.unwrap_or(0);
        let mut after = InForce::default();
        // Without words nothing can be wrong with them.
        let _ = after.resolve(&bare(), modality);
        if let Some(index) = DIRECTIONS
            .iter()
            .position(|direction| *direction == after.direction)
            && after.direction.is_some()
        {
            change.0[DIRECTION] = 1 << index;
        }
    }
    if let Some(distance) = modality.distance {
        let index = DISTANCES.iter().position(|listed| *listed == distance);
        change.0[DISTANCE] = 1 << index.unwrap_or(0);
    }
    if let Some(axis) = modality.plane {
        change.0[PLANE] = plane(axis);
    }
}
