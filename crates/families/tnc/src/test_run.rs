//! TEST RUN beside what the machine does: a program is executed without moving an axis, to find what is
//! wrong with it [003:1514-1535]. Nothing goes to the PLC.
//!
//! Decision: STOP interrupts a test run, STOP again ends it; STOP AT N interrupts it at block N, or the first one
//! after that moves or stops; the graphics are interrupted at their own place, and each stop is passed once (also
//! `graphics/src/trial.rs`)

use bahn_interpreter::Interpreter;
use bahn_kernel::{AxisId, AxisUnit, Feeder, RunFault};
use bahn_parameters::MessageId;
use bahn_path::{Barrier, BlockRef, ElementSource, Function, LiveData, Step, Touch};
use bahn_reader::Reader;

use crate::language::{self, OwnLanguage};
use crate::message::Message;
use crate::spindle::SpindleUnit;
use crate::test_command::TestCommand;

/// Elements that one call of prepare tests at most: the machine comes first.
const BUDGET: usize = 500;

/// A program that is executed without a machine, as far as it has come.
#[derive(Clone)]
pub(crate) struct TestRun {
    program: String,
    feeder: Box<Feeder>,
    state: TestState,
    block: BlockRef,
    /// The block of the main program at which it is to be interrupted.
    interrupt_at: Option<u32>,
}

/// The spindle speed that a function asks for, rpm.
fn speed(function: &Function) -> Option<f64> {
    match function {
        Function::Tool(call) => Some(call.speed_rpm),
        Function::SpindleSpeed(rpm) => Some(*rpm),
        _ => None,
    }
}

/// What a test run came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TestState {
    /// Blocks are tested one after the other.
    #[default]
    Running,
    /// By the operator, or by a programmed stop: it goes on when he says so [003:1531-1535] [003:2234].
    Interrupted,
    /// The program came to its end without an error.
    Finished,
    /// The program is wrong.
    Failed(Message),
}

/// A test run for the display.
#[derive(Clone, Debug, PartialEq)]
pub struct TestReport {
    /// Name of the program that is tested.
    pub program: String,
    /// Block that was tested last.
    pub block: BlockRef,
    /// Number of blocks that were executed, repeats counted each time.
    pub blocks: u64,
    /// What it came to.
    pub state: TestState,
}

impl TestRun {
    /// A test run of a program, from its first block.
    pub fn new(name: &str, feeder: Feeder) -> TestRun {
        TestRun {
            program: name.to_owned(),
            feeder: Box::new(feeder),
            state: TestState::Running,
            block: BlockRef::default(),
            interrupt_at: None,
        }
    }

    /// What the operator asks for; `false` where it is not possible.
    pub fn execute(&mut self, command: TestCommand) -> bool {
        let (running, interrupted) = match self.state {
            TestState::Running => (true, false),
            TestState::Interrupted => (false, true),
            _ => (false, false),
        };
        match command {
            TestCommand::Interrupt if running => self.state = TestState::Interrupted,
            TestCommand::InterruptAt(block) if running || interrupted => self.interrupt_at = Some(block),
            TestCommand::GoOn if interrupted => self.state = TestState::Running,
            TestCommand::Q(number, value) if interrupted && self.has_q(number) => {
                if let Some(interpreter) = self.feeder.interpreter_mut() {
                    interpreter.set_q(number, value);
                }
            }
            _ => return false,
        }
        true
    }

    fn has_q(&self, number: u16) -> bool {
        let values = self.feeder.interpreter().map(Interpreter::q_values);
        values.is_some_and(|values| values.get(usize::from(number)).is_some())
    }

    /// A Q parameter as the test has it now.
    pub fn q_value(&self, number: u16) -> f64 {
        let interpreter = self.feeder.interpreter();
        interpreter.map_or(0.0, |interpreter| interpreter.q_value(number))
    }

    /// A block was tested: whether the test is to be interrupted at it.
    fn reached(&mut self, block: BlockRef) -> bool {
        self.block = block;
        let there = |at: &mut u32| block.program == 0 && block.block >= *at;
        self.interrupt_at.take_if(there).is_some()
    }

    pub fn feeder(&mut self) -> &mut Feeder {
        &mut self.feeder
    }

    /// The program that is tested.
    pub fn program(&self) -> &str {
        &self.program
    }

    /// The run as it stands, to be gone on with by somebody else.
    pub fn reader(&self) -> Box<dyn Reader> {
        self.feeder.reader().boxed()
    }

    pub fn report(&self) -> TestReport {
        TestReport {
            program: self.program.clone(),
            block: self.block,
            blocks: self.feeder.reader().blocks_executed(),
            state: self.state.clone(),
        }
    }

    /// Goes on; may allocate.
    pub fn prepare<'a>(&mut self, spindle: &SpindleUnit, axes: impl Iterator<Item = &'a AxisUnit>) {
        if self.state != TestState::Running {
            return;
        }
        self.feeder.allow_work();
        for _ in 0..BUDGET {
            match self.feeder.next() {
                Step::Element(element) => {
                    let reached = self.reached(element.block);
                    self.feeder.forget_before(element.sequence);
                    let mut speeds = element
                        .functions()
                        .iter()
                        .filter_map(|output| speed(&output.function));
                    if speeds.any(|rpm| !spindle.has_speed(rpm)) {
                        self.state = TestState::Failed(Message::Plain(MessageId::WrongRpm));
                        return;
                    }
                    if reached {
                        self.state = TestState::Interrupted;
                        return;
                    }
                }
                // STOP and M0 interrupt a test, too [003:2234].
                Step::Barrier(Barrier::Stop { block }) => {
                    self.reached(block);
                    self.feeder.resume(LiveData::default());
                    self.state = TestState::Interrupted;
                    return;
                }
                // Every probing touches where the block says it will.
                Step::Barrier(Barrier::Probe { to, .. }) => self.feeder.resume(LiveData {
                    touch: Some(Touch { position: to }),
                    ..LiveData::default()
                }),
                Step::Barrier(_) => self.feeder.resume(LiveData::default()),
                Step::Starved => return,
                Step::End => {
                    self.state = TestState::Finished;
                    return;
                }
                Step::Error(fault) => {
                    self.state = TestState::Failed(message(fault, axes));
                    return;
                }
            }
        }
    }
}

fn message<'a>(fault: RunFault, mut axes: impl Iterator<Item = &'a AxisUnit>) -> Message {
    match fault {
        RunFault::Program(error) => Message::Program(error),
        RunFault::Limit { axis, direction, .. } => {
            let unit = axes.find(|unit| unit.axis == axis);
            Message::limit(unit.map_or(AxisId::FIRST, |unit| unit.id), direction)
        }
        RunFault::Absent { axis, block, .. } => {
            let unit = axes.find(|unit| unit.axis == axis);
            Message::Program(Box::new(language::absent(axis, unit, block, None)))
        }
    }
}
