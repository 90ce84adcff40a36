//! Programs that are executed while they are still being transferred.

use std::path::PathBuf;
use std::sync::Arc;

use bahn_interpreter::{Interpreter, NoPrograms, Settings};
use bahn_path::{ElementSource, LiveData, Step};
use bahn_program::Program;

/// Steps, as text since positions that were never programmed are NaN, until there is nothing more; whether the
/// run has ended.
fn steps(run: &mut Interpreter, found: &mut Vec<String>) -> bool {
    loop {
        let step = run.next();
        match step {
            Step::Starved => return false,
            _ => found.push(format!("{step:?}")),
        }
        match step {
            Step::End | Step::Error(_) => return true,
            Step::Barrier(_) => run.resume(LiveData::default()),
            _ => {}
        }
    }
}

fn interpreter(program: Program) -> Interpreter {
    Interpreter::new(Arc::new(program), Settings::default(), Arc::new(NoPrograms))
}

fn whole(text: &[u8]) -> Vec<String> {
    let mut found = Vec::new();
    let mut run = interpreter(Program::from_bytes("1.H", text.to_vec()));
    assert!(steps(&mut run, &mut found));
    found
}

/// The steps of a program that comes some bytes at a time, and how many of them came before its end.
fn grown(text: &[u8], size: usize, forgets: bool) -> (Vec<String>, usize) {
    let mut program = Program::growing("1.H");
    let mut run = interpreter(program.clone());
    let mut found = Vec::new();
    let mut early = 0;
    for bytes in text.chunks(size) {
        assert!(program.is_growing() || bytes.iter().all(u8::is_ascii_whitespace));
        program = program.more(bytes);
        if forgets {
            program = program.forget(run.at().block);
            assert!(program.known().len() < 1000, "{:?}", program.known());
        }
        run.grow(Arc::new(program.clone()));
        if program.is_growing() {
            if steps(&mut run, &mut found) {
                // M30, or a fault.
                return (found, early);
            }
            early = found.len();
        }
    }
    run.grow(Arc::new(program.completed()));
    assert!(steps(&mut run, &mut found));
    (found, early)
}

/// The examples: rounding, compensation, jumps back and ahead, cycles, contours, Q parameters.
#[test]
fn programs_that_come_in_pieces_give_the_same_path() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../examples");
    let mut compared = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "H") {
            continue;
        }
        let text = std::fs::read(&path).unwrap();
        let expected = whole(&text);
        for size in [100, 1] {
            let (found, _) = grown(&text, size, false);
            assert!(found == expected, "{} by {size} bytes", path.display());
        }
        compared += expected.len();
    }
    assert!(compared > 1000, "{compared}");
}

/// Without jumps the path keeps up with the text, and executed blocks can be forgotten.
#[test]
fn long_programs_run_while_they_come() {
    let lines: String = (1..20_000)
        .map(|at| format!("L X+{} Y+{} R0 F1000\r\n", at % 100, at % 7))
        .collect();
    let text = format!("BEGIN PGM 1 INCH\r\n{lines}END PGM 1 INCH\r\n");
    let (found, early) = grown(text.as_bytes(), 100, true);
    assert_eq!(found, whole(text.as_bytes()));
    // The last bytes hold less than ten blocks.
    assert!(early + 10 > found.len(), "{early} of {}", found.len());
}

/// A transfer that breaks off leaves the program where it is; a label that never comes is an error only when
/// nothing more comes.
#[test]
fn a_label_ahead_is_waited_for() {
    let front = b"BEGIN PGM 1 MM\nL X+1 R0 F100\nFN9: IF +0 EQU +0 GOTO LBL 3\nL X+2\nL X+3\n";
    let mut program = Program::growing("1.H").more(front);
    let mut run = interpreter(program.clone());
    let mut found = Vec::new();
    assert!(!steps(&mut run, &mut found));
    // L X+1 is held: its corner may be rounded.
    assert_eq!((found.len(), run.at().block), (0, 2));
    program = program.more(b"LBL 3\nL X+4\n");
    run.grow(Arc::new(program.clone()));
    assert!(!steps(&mut run, &mut found));
    assert_eq!((found.len(), run.at().block), (0, 5));
    run.grow(Arc::new(program.completed()));
    assert!(steps(&mut run, &mut found));
    assert_eq!(found.len(), 3, "{found:?}");

    let mut run = interpreter(Program::growing("1.H").more(front).completed());
    let mut found = Vec::new();
    assert!(steps(&mut run, &mut found));
    assert!(
        found.last().unwrap().contains("LabelNumberNotAllocated"),
        "{found:?}"
    );
}
