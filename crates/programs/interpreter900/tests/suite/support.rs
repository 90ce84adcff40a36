//! A channel with the axes X, Y, Z and C, and its programs.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{
    Axis, Barrier, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position, Step,
};
use bahn_reader::{Message, ProgramError};
use bahn_system900::{DataFile, Memory, Name};
use bahn_text::MemoryFiles;

/// Zero points from P20000 on (7 points, 3 axes, a sum and two shifts), three tools of 15 parameters from P21000 on.
const CHANNEL: &str = "q102: 10000\nq103: 5000\nq104: 18000\nq105: 2000\n\
    q110: $01010058\nq111: $02020059\nq112: $0303005A\nq113: $04040043\n\
    q170: 20000\nq171: 1\nq172: 2\nq173: 3\nq174: 0\n\
    q175: 21000\nq176: 3\nq177: 1\nq178: 15\n\
    P21000: 2\nP21010: 5\nP21011: 100\nP21013: 0.5\nP21015: 7\nP21026: 80\n";

/// Parameters of the channel with some more lines.
pub fn memory(more: &str) -> Memory {
    let file = DataFile::read(format!("{CHANNEL}{more}").as_bytes());
    file.memory().clone()
}

pub fn reader_with(text: &str, more: &str, cycles: &[(&str, &str)]) -> Reader900 {
    let beside: MemoryFiles = cycles.iter().copied().collect();
    let mut reader = Reader900::new("P1000.900", text.as_bytes(), 1, Position::ZERO, Arc::new(beside));
    reader.give_memory(memory(more));
    reader
}

pub fn reader(text: &str) -> Reader900 {
    reader_with(text, "", &[])
}

/// What a run hands out.
#[derive(Default)]
pub struct Ran {
    pub elements: Vec<PathElement>,
    pub barriers: Vec<Barrier>,
    pub error: Option<Box<ProgramError>>,
}

/// Runs to the end; barriers are left at once.
pub fn run(reader: &mut Reader900) -> Ran {
    let mut ran = Ran::default();
    for _ in 0..1_000_000 {
        match reader.next() {
            Step::Element(element) => ran.elements.push(element),
            Step::Barrier(barrier) => {
                ran.barriers.push(barrier);
                reader.resume(LiveData::default());
            }
            Step::End => return ran,
            Step::Starved => panic!("it is not starved"),
            Step::Error(error) => {
                ran.error = Some(error);
                return ran;
            }
        }
    }
    panic!("it does not end");
}

/// Runs a program that has no fault.
pub fn ran(text: &str) -> Ran {
    ran_with(text, "")
}

pub fn ran_with(text: &str, more: &str) -> Ran {
    let ran = run(&mut reader_with(text, more, &[]));
    assert!(ran.error.is_none(), "{text}: {:?}", ran.error);
    ran
}

/// What is wrong with a program: the message.
pub fn fault_with(text: &str, more: &str) -> String {
    let error = run(&mut reader_with(text, more, &[])).error.unwrap();
    let Message::Numbered(text) = error.message else {
        panic!("a message of a TNC: {error:?}");
    };
    text
}

pub fn fault(text: &str) -> String {
    fault_with(text, "")
}

/// Where the movements end: X, Y, Z.
pub fn ends(ran: &Ran) -> Vec<[f64; 3]> {
    let moves = ran.elements.iter().filter(|element| element.curve != Curve::Hold);
    moves
        .map(|element| [Axis::X, Axis::Y, Axis::Z].map(|axis| (element.end[axis] * 1e6).round() / 1e6))
        .collect()
}

/// The feeds of the movements, mm/min; 0 is rapid.
pub fn feeds(ran: &Ran) -> Vec<f64> {
    let moves = ran.elements.iter().filter(|element| element.curve != Curve::Hold);
    moves
        .map(|element| match element.feed {
            FeedRate::Rapid => 0.0,
            FeedRate::Programmed(feed) => feed,
        })
        .collect()
}

/// All functions in the order of output.
pub fn functions(ran: &Ran) -> Vec<Function> {
    let all = ran.elements.iter().flat_map(PathElement::functions);
    all.map(|function| function.function.clone()).collect()
}

pub fn number(memory: &Memory, name: &str) -> Option<f64> {
    memory.cell(name.parse::<Name>().unwrap()).unwrap().number()
}
