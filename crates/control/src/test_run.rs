//! TEST RUN beside what the machine does: a program is executed without moving an axis, to find what is
//! wrong with it [003:1514-1535]. Nothing goes to the PLC.

use bahn_interpreter::Status;
use bahn_parameters::MessageId;
use bahn_path::{Barrier, BlockRef, ElementSource, Function, LiveData, Step, Touch};

use crate::control::Control;
use crate::feeder::{Feeder, RunFault};
use crate::message::Message;

/// Elements that one call of prepare tests at most: the machine comes first.
const BUDGET: usize = 500;

/// A test run.
#[derive(Clone)]
pub(crate) struct TestRun {
    program: String,
    feeder: Box<Feeder>,
    state: TestState,
    block: BlockRef,
}

/// The spindle speed that a function asks for, rpm.
fn speed(function: &Function) -> Option<f64> {
    match function {
        Function::Tool(call) => Some(call.speed_rpm),
        Function::SpindleSpeed(rpm) => Some(*rpm),
        _ => None,
    }
}

impl TestRun {
    pub fn feeder(&mut self) -> &mut Feeder {
        &mut self.feeder
    }
}

/// What a test run came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TestState {
    /// It goes on.
    #[default]
    Running,
    /// The program came to its end without an error.
    Finished,
    /// The program is wrong.
    Failed(Message),
}

/// A test run for the display.
#[derive(Clone, Debug, PartialEq)]
pub struct TestReport {
    /// The program.
    pub program: String,
    /// Block that was tested last.
    pub block: BlockRef,
    /// Blocks executed.
    pub blocks: u64,
    /// What it came to.
    pub state: TestState,
}

impl Control {
    /// TEST RUN of a program, from its first block; the machine goes on with what it does. Errors are in
    /// [`Control::test_report`]. `false` when there is no such program.
    pub fn test(&mut self, name: &str) -> bool {
        let Ok(Some(program)) = self.programs.open(name, "") else {
            return false;
        };
        let machine = self.machine_position();
        // A program that is selected finds nothing in force.
        let status = Status::default();
        let feeder = self.new_feeder_from(program, 0, &machine, self.traverse_box(), status);
        self.test = Some(TestRun {
            program: name.to_owned(),
            feeder: Box::new(feeder),
            state: TestState::Running,
            block: BlockRef::default(),
        });
        true
    }

    /// Breaks a test run off, or clears its result.
    pub fn end_test(&mut self) {
        self.test = None;
    }

    /// The program in TEST RUN.
    pub(crate) fn tested_program(&self) -> Option<&str> {
        self.test.as_ref().map(|test| test.program.as_str())
    }

    /// The test run that was started last.
    pub fn test_report(&self) -> Option<TestReport> {
        self.test.as_ref().map(|test| TestReport {
            program: test.program.clone(),
            block: test.block,
            blocks: test.feeder.interpreter().blocks_executed(),
            state: test.state.clone(),
        })
    }

    /// Goes on with a test run; may allocate.
    pub(crate) fn prepare_test(&mut self) {
        let Some(test) = self.test.as_mut().filter(|test| test.state == TestState::Running) else {
            return;
        };
        test.feeder.allow_work();
        for _ in 0..BUDGET {
            match test.feeder.next() {
                Step::Element(element) => {
                    test.block = element.block;
                    test.feeder.forget_before(element.sequence);
                    let spindle = &self.spindle;
                    let mut speeds = element
                        .functions()
                        .iter()
                        .filter_map(|output| speed(&output.function));
                    if speeds.any(|rpm| !spindle.has_speed(rpm)) {
                        test.state = TestState::Failed(Message::Plain(MessageId::WrongRpm));
                        return;
                    }
                }
                // Every probing touches where the block says it will.
                Step::Barrier(Barrier::Probe { to, .. }) => test.feeder.resume(LiveData {
                    touch: Some(Touch { position: to }),
                    q_values: Vec::new(),
                }),
                Step::Barrier(_) => test.feeder.resume(LiveData::default()),
                Step::Starved => return,
                Step::End => {
                    test.state = TestState::Finished;
                    return;
                }
                Step::Error(fault) => {
                    let message = match fault {
                        RunFault::Program(error) => Message::Program(error),
                        RunFault::Limit { axis, direction, .. } => {
                            let unit = self.axes.iter().find(|unit| unit.axis == axis);
                            Message::limit(unit.map_or(0, |unit| unit.index), direction)
                        }
                    };
                    test.state = TestState::Failed(message);
                    return;
                }
            }
        }
    }
}
