//! A channel with three axes, and what a program does on it.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{Axis, Barrier, ElementSource, LiveData, PathElement, Step};
use bahn_reader::Message;
use bahn_system900::DataFile;
use bahn_text::MemoryFiles;

/// Channel 1 with X, Y, Z on the physical axes 1, 2, 3; user block 1 at q10000, block 2 at q18000.
pub const CHANNEL: &str = "q102: 10000\nq103: 5000\nq104: 18000\nq105: 2000\nq110: $01010058\nq111: $02020059\n\
                           q112: $0303005A\n";

/// A program on the channel with further lines of its data file.
pub fn reader(data: &str, program: &str) -> Reader900 {
    with_cycles(data, program, &[])
}

/// The same with cycles beside it.
pub fn with_cycles(data: &str, program: &str, cycles: &[(&str, &str)]) -> Reader900 {
    let text = format!("{CHANNEL}{data}");
    let file = DataFile::read(text.as_bytes());
    assert!(file.is_readable(), "{:?}", file.faults());
    let files: MemoryFiles = cycles.iter().copied().collect();
    let mut reader = Reader900::new(
        "P1000.900",
        program.as_bytes(),
        1,
        bahn_path::Position::ZERO,
        Arc::new(files),
    );
    reader.give_memory(file.memory().clone());
    reader
}

/// What came of a run.
#[derive(Debug, Default)]
pub struct Ran {
    pub elements: Vec<PathElement>,
    pub barriers: Vec<Barrier>,
    /// The message of the fault that ended it.
    pub fault: Option<String>,
}

impl Ran {
    /// Places of X, Y, Z where movements end.
    pub fn ends(&self) -> Vec<[f64; 3]> {
        let moving = self
            .elements
            .iter()
            .filter(|element| element.curve != bahn_path::Curve::Hold);
        moving
            .map(|element| {
                [Axis::X, Axis::Y, Axis::Z].map(|axis| (element.end[axis] * 1e6).round() / 1e6 + 0.0)
            })
            .collect()
    }
}

/// Runs to the end; nothing answers at barriers.
pub fn run(reader: &mut Reader900) -> Ran {
    let mut ran = Ran::default();
    loop {
        match reader.next() {
            Step::Element(element) => ran.elements.push(element),
            Step::Barrier(barrier) => {
                ran.barriers.push(barrier);
                reader.resume(LiveData::default());
            }
            Step::End => return ran,
            Step::Starved => panic!("starved"),
            Step::Error(error) => {
                let Message::Numbered(text) = error.message else {
                    panic!("a message of a TNC: {error:?}");
                };
                ran.fault = Some(text);
                return ran;
            }
        }
        assert!(ran.elements.len() + ran.barriers.len() < 100_000, "no end");
    }
}

/// The ends of the movements of a program that runs without a fault.
pub fn ends(data: &str, program: &str) -> Vec<[f64; 3]> {
    let ran = run(&mut reader(data, program));
    assert_eq!(ran.fault, None);
    ran.ends()
}

/// The fault of a program, in words.
pub fn fault(data: &str, program: &str) -> String {
    let ran = run(&mut reader(data, program));
    ran.fault.unwrap_or_else(|| panic!("it runs"))
}
