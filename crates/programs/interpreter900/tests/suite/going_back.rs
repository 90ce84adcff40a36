//! A run that goes back, goes on elsewhere, and has little time.

use bahn_path::{Axis, ElementSource, Position, Step};
use bahn_reader::Reader;

use crate::support::{number, reader};

fn x(reader: &mut dyn Reader) -> f64 {
    match reader.next() {
        Step::Element(element) => element.end[Axis::X],
        other => panic!("{other:?}"),
    }
}

/// What the look-ahead has written is as it was before the block to which the run goes back.
#[test]
fn a_run_goes_back_with_its_parameters() {
    let mut reader = reader("P1:1\nF100 X:P1\nP1:2 X:P1\nP1:3 X:P1\n");
    reader.keep_checkpoints();
    assert_eq!([x(&mut reader), x(&mut reader), x(&mut reader)], [1.0, 2.0, 3.0]);
    reader.go_back(&|mark| mark.sequence == 3);
    assert_eq!(number(reader.memory().unwrap(), "P1"), Some(1.0));
    assert_eq!(reader.at().block, 3);
    assert_eq!(x(&mut reader), 2.0);
}

/// States that were forgotten take nothing from those that are kept.
#[test]
fn forgotten_states_leave_the_others() {
    let mut reader = reader("F100 P1:1 X:P1\nP1:2 X:P1\nP1:3 X:P1\n");
    reader.keep_checkpoints();
    let _ = [x(&mut reader), x(&mut reader), x(&mut reader)];
    reader.forget_before(2);
    reader.go_back(&|mark| mark.sequence == 2);
    assert_eq!(number(reader.memory().unwrap(), "P1"), Some(1.0));
    assert_eq!(x(&mut reader), 2.0);
}

/// A block that fails is tried again, once its parameter is there.
#[test]
fn retry_executes_the_block_again() {
    let mut reader = reader("F100 X:P1\n");
    reader.keep_checkpoints();
    assert!(matches!(reader.next(), Step::Error(_)));
    let mut memory = reader.take_memory().unwrap();
    memory.write("P1".parse().unwrap(), "4".parse().unwrap()).unwrap();
    reader.give_memory(memory);
    reader.retry();
    assert_eq!(x(&mut reader), 4.0);
}

/// A branch goes on at its target from where the axes stand, with what was in force before its block.
#[test]
fn a_branch_leads_to_its_target() {
    let mut reader = reader("F100 X1\nG91 X5\nN300 X10\n");
    reader.keep_checkpoints();
    let _ = [x(&mut reader), x(&mut reader)];
    let mut stands = Position::ZERO;
    stands[Axis::X] = 3.0;
    reader.branch(2, 3, &stands);
    match reader.next() {
        Step::Element(element) => {
            assert_eq!((element.start[Axis::X], element.end[Axis::X]), (3.0, 10.0));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn work_is_allowed_in_portions() {
    let mut reader = reader("P1:1\nP1:2\nP1:3\nF100 X1\n");
    reader.allow(2);
    assert_eq!(reader.next(), Step::Starved);
    reader.allow(2);
    assert_eq!(x(&mut reader), 1.0);
}

#[test]
fn goto_goes_on_at_a_block() {
    let mut reader = reader("F100 X1\nX2\nX3\n");
    assert_eq!(x(&mut reader), 1.0);
    reader.goto(3);
    assert_eq!((x(&mut reader), reader.next()), (3.0, Step::End));
}
