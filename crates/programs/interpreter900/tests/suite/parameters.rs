//! Parameters that programs write, compare and take.

use bahn_path::{Barrier, BlockRef, ElementSource, Function, LiveData, Step};

use crate::support::{ends, fault, functions, number, ran, ran_with, reader, run};

#[test]
fn a_block_writes_its_parameters_before_its_other_words() {
    let mut reader = reader("X:P1 P1:12.5 F100\nP2:P1 P3:$10\nP1:--\n");
    assert_eq!(ends(&run(&mut reader)), [[12.5, 0.0, 0.0]]);
    let memory = reader.take_memory().unwrap();
    let values = ["P1", "P2", "P3"].map(|name| number(&memory, name));
    assert_eq!(values, [None, Some(12.5), Some(16.0)]);
    assert_eq!(fault("X:P1\n"), "P1 is cleared: it has no number to take");
}

/// The forms of the manual [002:1636-1655], and `>`: one time more round the loop, then out of it.
#[test]
fn conditions_jump_to_their_block() {
    // P5 is cleared and equals nothing, so the loop is left at N145; N150 to N170 jump over N180.
    let text = "N100 G91 F100 P1:0\nN110 P1=2.150\nN120 X1\nN130 P1=1.145\nN140 P1:1\nN142 P1<2.110\nN145 P5=P5.110\n\
        N150 P6=1.110\nN160 P1>5.110\nN170 P1<2.190\nN180 X100\nN190 X10\n";
    assert_eq!(
        ends(&ran(text)),
        [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [12.0, 0.0, 0.0]]
    );
}

/// Bit 1.2: written when the path comes to the block; bit 1.3: the look-ahead stops at its end [002:268-280].
#[test]
fn status_bits_say_when_a_write_acts() {
    let real_time = "P600: 1 $00000005\n";
    let ran_ahead = ran_with("P600:7.5 F100 X1\nP600:--\n", real_time);
    let written = functions(&ran_ahead);
    let q = 10_600;
    assert_eq!(
        written,
        [
            Function::Write { q, value: Some(7.5) },
            Function::Write { q, value: None }
        ]
    );
    let ran_waiting = ran_with("P600:5 F100 X1\n", "P600: 1 $00000009\n");
    let block = BlockRef { program: 0, block: 1 };
    assert_eq!(ran_waiting.barriers, [Barrier::Acknowledge { block }]);
}

/// [002:1634-1655]: the loop waits at M1 for a value that somebody else writes.
#[test]
fn a_wait_loop_reads_what_others_have_written() {
    let mut reader = reader("N100 P7950:1\nN110 M1\nN120 P7960<10.110\nN130 F100 X1\n");
    let mut memory = reader.take_memory().unwrap();
    assert_eq!(
        reader.next(),
        Step::Starved,
        "without its memory it reads nothing"
    );
    for value in ["3", "9", "9.5"] {
        memory
            .write("P7960".parse().unwrap(), value.parse().unwrap())
            .unwrap();
        reader.give_memory(memory);
        assert!(matches!(reader.next(), Step::Barrier(_)), "{value}");
        reader.resume(LiveData::default());
        memory = reader.take_memory().unwrap();
    }
    memory
        .write("P7960".parse().unwrap(), "10".parse().unwrap())
        .unwrap();
    reader.give_memory(memory);
    assert!(matches!(reader.next(), Step::Element(_)));
}

#[test]
fn a_loop_without_movement_is_a_fault() {
    assert_eq!(
        fault("N10 P1:1\nN20 P1=1.10\n"),
        "the program goes round and round without a movement"
    );
}

/// P8810 skips blocks with a stroke [002:4241-4243], P8801 says where a program begins [002:4157-4158].
#[test]
fn strokes_and_the_start_block() {
    let text = "N10 F100 X1\n/N20 X2\nN30 X3\n";
    assert_eq!(ends(&ran_with(text, "P8810: 1\n")).len(), 2);
    assert_eq!(ends(&ran(text)).len(), 3);
    let started = ran_with("N10 F100 X1\nN20 F100 X2\n", "P8801: 20\n");
    assert_eq!(ends(&started), [[2.0, 0.0, 0.0]]);
}
