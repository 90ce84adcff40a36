//! What a control asks of the reader: checkpoints, places, memory.

use std::sync::Arc;

use bahn_interpreter900::Reader900;
use bahn_path::{Axis, ElementSource, Position, Step};
use bahn_reader::Reader;
use bahn_text::MemoryFiles;

use super::support::reader;

const PROGRAM: &str = "N10 G1 X1 F100\n\nN20 X2\nN30 X3\nN40 M30\n";

fn x(reader: &mut Reader900) -> f64 {
    match reader.next() {
        Step::Element(element) => element.end[Axis::X],
        other => panic!("{other:?}"),
    }
}

#[test]
fn nothing_is_read_without_the_memory() {
    let mut reader = Reader900::new(
        "P1.900",
        PROGRAM.as_bytes(),
        1,
        Position::ZERO,
        Arc::new(MemoryFiles::default()),
    );
    assert!(matches!(reader.next(), Step::Starved));
    let mut full = self::reader("", PROGRAM);
    let memory = full.take_memory().unwrap();
    assert!(matches!(full.next(), Step::Starved));
    full.give_memory(memory);
    assert_eq!(x(&mut full), 1.0);
}

#[test]
fn blocks_have_their_places_in_the_text() {
    let mut reader = reader("", PROGRAM);
    let mut blocks = Vec::new();
    while let Step::Element(element) = reader.next() {
        blocks.push(element.block.block);
    }
    assert_eq!(blocks, [1, 2, 3]);
    assert_eq!(reader.program(0).unwrap().line_of(2), 3);
}

#[test]
fn a_run_goes_back_to_a_kept_block() {
    let mut reader = reader("", PROGRAM);
    reader.keep_checkpoints();
    assert_eq!((x(&mut reader), x(&mut reader)), (1.0, 2.0));
    assert_eq!(reader.block_at(2).block, 2);
    reader.go_back(&|mark| mark.sequence == 2);
    assert_eq!(x(&mut reader), 2.0);
    reader.forget_before(2);
    let mut copy = reader.boxed();
    assert_eq!(x(&mut reader), 3.0);
    let Step::Element(element) = copy.next() else {
        panic!("a copy goes on")
    };
    assert_eq!(element.end[Axis::X], 3.0);
}

#[test]
fn a_run_goes_on_where_the_axes_stand() {
    let mut reader = reader("", "N10 G1 X1 F100\nN20 G91 X1\nN30 M30\n");
    assert_eq!(x(&mut reader), 1.0);
    let mut place = Position::ZERO;
    place[Axis::X] = 5.0;
    reader.relocate(&place);
    assert_eq!(x(&mut reader), 6.0);
}

#[test]
fn a_run_begins_at_a_block() {
    let mut reader = reader("", "N10 G1 X1 F100\nN20 G1 X2 F100\nN30 M30\n");
    reader.goto(2);
    assert_eq!(x(&mut reader), 2.0);
    assert!(matches!(reader.next(), Step::End));
}

#[test]
fn work_is_counted() {
    let mut reader = reader("", PROGRAM);
    reader.allow(1);
    assert_eq!(x(&mut reader), 1.0);
    assert!(matches!(reader.next(), Step::Starved));
    reader.allow(8);
    assert_eq!(x(&mut reader), 2.0);
}
