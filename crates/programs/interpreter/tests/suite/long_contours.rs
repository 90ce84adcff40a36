//! SL contours that take long to compute, or cannot be computed at all.

use std::fmt::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use bahn_interpreter::{Interpreter, Message, NoPrograms, Settings};
use bahn_parameters::MessageId;
use bahn_path::{ElementSource, PerAxis, Step};
use bahn_program::Program;

/// A control reacts within 0.2 s; the rest is for a test machine that has other things to do.
const SOON: Duration = Duration::from_millis(1000);

/// The block that calls the cycle.
const CALL: u32 = 10;

/// Cycle 6 on what the subprogram describes.
fn rough_out(subprogram: &str) -> Interpreter {
    let text = format!(
        "BEGIN PGM LONG MM\nTOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2 R0 FMAX M3\n\
         CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1\n\
         CYCL DEF 6.0 ROUGH-OUT\nCYCL DEF 6.1 SET UP -2 DEPTH -10\nCYCL DEF 6.2 PECKG -5 F100 ALLOW +0\n\
         CYCL DEF 6.3 ANGLE +0 F500\nCYCL CALL\nL Z+50 FMAX M2\nLBL 1\n{subprogram}LBL 0\nEND PGM LONG MM\n"
    );
    let settings = Settings {
        max_blocks_without_motion: u64::MAX,
        ..Settings::default()
    };
    let program = Arc::new(Program::from_bytes("LONG.H", text.into_bytes()));
    Interpreter::new(program, settings, Arc::new(NoPrograms))
}

/// A star whose sides each lead past `past` of its corners.
fn star(corners: usize, past: usize) -> String {
    let mut text = String::new();
    for k in 0..=corners {
        let turn = (k * past % corners) as f64 / corners as f64;
        let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
        let side = if k == 0 { " RL" } else { "" };
        let _ = writeln!(text, "L X{:+.4} Y{:+.4}{side}", 100.0 * cos, 100.0 * sin);
    }
    text
}

/// Its 300,000 crossings take seconds.
fn long_star() -> String {
    star(775, 387)
}

/// Executes up to the cycle, which the flag ends after a moment; the answer is how long that took.
fn interrupted(mut run: Interpreter) -> Duration {
    let flag = Arc::new(AtomicBool::new(false));
    run.set_interrupt(Arc::clone(&flag));
    let operator = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(300));
        flag.store(true, Ordering::Relaxed);
        Instant::now()
    });
    let step = loop {
        match run.next() {
            Step::Element(element) => assert!(element.block.block < CALL, "the cycle is not executed"),
            step => break step,
        }
    };
    let ended = Instant::now();
    let pressed = operator.join().expect("it only waits");
    assert!(matches!(step, Step::Starved), "{step:?}");
    assert!(ended >= pressed, "it would have taken longer");
    assert_eq!(run.at().block, CALL, "its block is executed anew");
    ended.duration_since(pressed)
}

#[test]
fn an_interrupt_ends_the_computation() {
    let took = interrupted(rough_out(&long_star()));
    assert!(took < SOON, "{took:?}");
}

#[test]
fn an_interrupt_ends_a_subprogram_without_end() {
    let endless = "L X+0 Y+0 RL\nLBL 2\nFN1: Q1 = +Q1 + +1\nFN9: IF +0 EQU +0 GOTO LBL 2\n";
    let took = interrupted(rough_out(endless));
    assert!(took < SOON, "{took:?}");
}

/// Whoever gives a computation up need not wait for it.
#[test]
fn a_computation_that_nobody_wants_ends() {
    type Leave = fn(Interpreter) -> Option<Interpreter>;
    let ways: [(&str, Leave); 3] = [
        ("given up", |mut run| {
            run.give_up_work();
            Some(run)
        }),
        ("elsewhere", |mut run| {
            run.goto(1);
            Some(run)
        }),
        ("dropped", |_| None),
    ];
    for (name, leave) in ways {
        let mut run = rough_out(&long_star());
        run.defer_work();
        while let Step::Element(_) = run.next() {}
        let work = run.take_work().expect("the contour is to be computed");
        let beside = std::thread::spawn(move || (work.compute(), Instant::now()));
        std::thread::sleep(Duration::from_millis(300));
        assert!(!beside.is_finished(), "{name}: it would have taken longer");
        let left = Instant::now();
        let run = leave(run);
        let (done, ended) = beside.join().expect("it does not panic");
        let took = ended.duration_since(left);
        assert!(took < SOON, "{name}: {took:?}");
        assert!(run.is_none_or(|run| !run.waits_for(&done)), "{name}");
    }
}

/// What was taken and never came back is to be computed again, be it that no thread could be had for it or that its
/// result was lost.
#[test]
fn a_computation_that_is_lost_is_handed_out_again() {
    let path = |run: &mut Interpreter| {
        let mut ends = Vec::new();
        loop {
            match run.next() {
                Step::Element(element) => ends.push(PerAxis::from_fn(|axis| element.end[axis].to_bits())),
                step => break (ends, step),
            }
        }
    };
    let expected = path(&mut rough_out(&star(51, 25)));
    assert!(matches!(expected.1, Step::End), "{:?}", expected.1);
    for name in ["work", "result"] {
        let mut run = rough_out(&star(51, 25));
        run.defer_work();
        let (mut ends, step) = path(&mut run);
        assert!(matches!(step, Step::Starved), "{name}: {step:?}");
        let lost = run.take_work().expect("the contour is to be computed");
        if name == "result" {
            drop(lost.compute());
        } else {
            drop(lost);
        }
        assert!(matches!(run.next(), Step::Starved), "{name}");
        let work = run.take_work().expect("it is to be computed again");
        assert!(matches!(run.next(), Step::Starved), "{name}: somebody has it");
        assert!(run.take_work().is_none(), "{name}");
        run.finish_work(work.compute());
        let (rest, step) = path(&mut run);
        ends.extend(rest);
        assert!(matches!(step, Step::End), "{name}: {step:?}");
        assert!(ends == expected.0, "{name}");
    }
}

/// A copy that is made meanwhile has the contour computed for itself, whatever becomes of the first.
#[test]
fn a_copy_computes_for_itself() {
    let rest = |run: &mut Interpreter| {
        let mut ends = Vec::new();
        loop {
            match run.next() {
                Step::Element(element) => ends.push(PerAxis::from_fn(|axis| element.end[axis].to_bits())),
                step => break (ends, matches!(step, Step::End)),
            }
        }
    };
    let mut run = rough_out(&star(51, 25));
    run.defer_work();
    let (_, ended) = rest(&mut run);
    assert!(!ended);
    let first = run.take_work().expect("the contour is to be computed");
    let mut copy = run.clone();
    let done = first.compute();
    assert!(!copy.waits_for(&done) && run.waits_for(&done));
    run.finish_work(done);
    let expected = rest(&mut run);
    assert!(expected.1 && !expected.0.is_empty());
    drop(run);
    assert!(matches!(copy.next(), Step::Starved));
    let second = copy.take_work().expect("it is to be computed again");
    copy.finish_work(second.compute());
    assert!(rest(&mut copy) == expected);
}

/// Millions of crossings would take gigabytes.
#[test]
fn a_contour_across_itself_everywhere_is_refused() {
    let mut run = rough_out(&star(3001, 1500));
    let error = loop {
        match run.next() {
            Step::Element(_) => {}
            Step::Error(error) => break error,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(error.message, Message::Control(MessageId::EntryValueIncorrect));
    assert!(error.detail.contains("too often"), "{}", error.detail);
}

/// The same star run through a hundred times is the star.
#[test]
fn repeats_of_a_contour_cost_no_more_than_the_contour() {
    let path = |repeats: usize| {
        let once = star(151, 75);
        let corners = once.lines().skip(1).collect::<Vec<_>>().join("\n");
        let repeated = format!("{corners}\n").repeat(repeats - 1);
        let mut run = rough_out(&format!("{once}{repeated}"));
        let mut ends = Vec::new();
        while let Step::Element(element) = run.next() {
            ends.push(PerAxis::from_fn(|axis| element.end[axis].to_bits()));
        }
        ends
    };
    let once = path(1);
    assert!(once.len() > 100, "{}", once.len());
    let begun = Instant::now();
    assert!(path(100) == once);
    assert!(begun.elapsed() < Duration::from_secs(10), "{:?}", begun.elapsed());
}
