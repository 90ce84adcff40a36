//! A control runs whatever is a [`Reader`]: here a program in no language at all, a list of places with their M function.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::stand::*;
use crate::support::{Build, Rig, machine};
use bahn_path::{
    At, Axis, BlockRef, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position, Step,
    Synchronisation, TechnologyFunction,
};
use bahn_program::Program;
use bahn_reader::{MachineRules, Mark, ProgramError, Reader, Start, Warning};
use bahn_tnc::{Control, Programs, RunState};

/// Where X goes in each block, mm, and the M function that goes out before it.
const BLOCKS: [(f64, Option<u16>); 2] = [(60.0, None), (70.0, Some(40))];

/// 50 mm/s.
const FEED_MM_MIN: f64 = 3000.0;

#[derive(Clone)]
struct Places {
    text: Arc<Program>,
    next: u32,
    position: Position,
    /// What is in force before each block that was handed out.
    kept: Vec<(Mark, Position)>,
}

impl Places {
    fn mark(&self) -> Mark {
        Mark {
            sequence: u64::from(self.next) + 1,
            at: self.at(),
        }
    }
}

impl ElementSource for Places {
    type Error = Box<ProgramError>;

    fn next(&mut self) -> Step<Box<ProgramError>> {
        let Some((x, m)) = BLOCKS.get(self.next as usize) else {
            return Step::End;
        };
        self.kept.push((self.mark(), self.position));
        let start = self.position;
        self.position[Axis::X] = *x;
        let out =
            |code: &u16| TechnologyFunction::new(Function::M(*code), At::Start, Synchronisation::MvsSvs);
        let ends = [start, self.position];
        let feed = FeedRate::Programmed(FEED_MM_MIN);
        let mut element = PathElement::new(self.at(), self.mark().sequence, Curve::Line, ends, feed);
        element.functions = m.as_ref().map(|code| [out(code)].into());
        self.next += 1;
        Step::Element(element)
    }

    fn resume(&mut self, _live: LiveData) {}
}

impl Reader for Places {
    fn boxed(&self) -> Box<dyn Reader> {
        Box::new(self.clone())
    }

    fn program(&self, index: u16) -> Option<&Arc<Program>> {
        (index == 0).then_some(&self.text)
    }

    fn at(&self) -> BlockRef {
        BlockRef {
            program: 0,
            block: self.next,
        }
    }

    fn blocks_executed(&self) -> u64 {
        u64::from(self.next)
    }

    fn position(&self) -> Position {
        self.position
    }

    fn take_warnings(&mut self) -> Vec<Warning> {
        Vec::new()
    }

    fn goto(&mut self, block: u32) {
        self.next = block;
    }

    fn keep_checkpoints(&mut self) {}

    fn forget_before(&mut self, sequence: u64) {
        self.kept.retain(|(mark, _)| mark.sequence >= sequence);
    }

    fn go_back(&mut self, so: &dyn Fn(Mark) -> bool) {
        if let Some((mark, position)) = self.kept.iter().rfind(|(mark, _)| so(*mark)).copied() {
            (self.next, self.position) = (mark.at.block, position);
        }
        self.kept.clear();
    }

    fn block_at(&self, sequence: u64) -> BlockRef {
        let mut kept = self.kept.iter();
        kept.rfind(|(mark, _)| mark.sequence <= sequence)
            .map_or(self.at(), |(mark, _)| mark.at)
    }

    fn retry(&mut self) {}

    fn relocate(&mut self, position: &Position) {
        self.position = *position;
    }

    fn stand_at(&mut self, position: &Position) {
        self.position = *position;
    }

    fn allow(&mut self, _work: u32) {}

    fn set_machine_rules(&mut self, _rules: MachineRules) {}

    fn set_interrupt(&mut self, _flag: Arc<AtomicBool>) {}
}

/// Any program is these places, as long as it is not one of a TNC.
struct Shelf;

impl Programs for Shelf {
    fn open(&self, name: &str, _caller: &str) -> Result<Option<Arc<Program>>, String> {
        let text = "BEGIN PGM 2 MM\nQ1 = +5\nL X+55 R0 F3000\nEND PGM 2 MM\n";
        let tilted = "BEGIN PGM 3 MM\nL X+300 Y+200 Z+300 B+30 R0 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 B+30\n\
                      L IX+100 F3000\nEND PGM 3 MM\n";
        let text = match name {
            "2.H" => text,
            "3.H" => tilted,
            _ => return Ok(None),
        };
        Ok(Some(Arc::new(Program::from_bytes(name, text.into()))))
    }

    fn reader(&self, name: &str, start: &Start) -> Result<Option<Box<dyn Reader>>, String> {
        Ok((name == "1.H").then(|| -> Box<dyn Reader> {
            Box::new(Places {
                text: Arc::new(Program::from_bytes(name, b"to 60\nto 70, M40\n".to_vec())),
                next: 0,
                position: start.position,
                kept: Vec::new(),
            })
        }))
    }
}

/// The axes stand at 50 in the display, the places are selected in full sequence.
fn rig() -> Rig {
    // Block scan and return to the contour [000:6765]; selecting a program cancels nothing [000:6589].
    let build = bench(ACKNOWLEDGE).mp("7680=%0000110").mp("7300=3");
    let (mut setup, machine) = build.setup();
    setup.programs = Arc::new(Shelf);
    let mut rig = Rig {
        control: Control::new(setup),
        machine,
    };
    rig.power_on();
    rig.seconds(0.3);
    for axis in ["X", "Y", "Z"] {
        rig.command(&format!("datum {axis} 50"));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    rig
}

/// Two blocks, and an M function that goes out with its strobe where the second one begins, at X60.
#[test]
fn it_runs_on_the_machine() {
    let mut rig = rig();
    rig.start();
    rig.until(2.0, "M40 goes out", |rig| rig.bit("M2045"));
    assert_eq!(rig.number("W260"), 40);
    near(nominal(&rig, 'X'), 60.0);
    rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 70.0);
    assert_eq!(rig.control.reader().map(|run| run.blocks_executed()), Some(2));
    assert!(rig.control.interpreter().is_none(), "it is no program of a TNC");
}

/// Stopped inside the second block, between X60 and X70, and broken off, the run goes on with that block from where the
/// axes stand; M40 goes out once more.
#[test]
fn it_goes_back_to_the_block_that_was_broken_off() {
    let mut rig = rig();
    rig.start();
    rig.until(2.0, "the second block", |rig| nominal(rig, 'X') > 64.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    rig.command("stop");
    let stands = nominal(&rig, 'X');
    assert!((64.0..69.0).contains(&stands), "{stands}");
    let next = rig.control.first().next_start();
    assert_eq!(next.map(|at| at.block), Some(1));
    rig.start();
    rig.until(2.0, "M40 goes out again", |rig| rig.bit("M2045"));
    near(nominal(&rig, 'X'), stands);
    rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 70.0);
}

/// In single block each block wants a start; the second one can also be the first one.
#[test]
fn single_block_and_a_block_to_begin_with() {
    let mut rig = rig();
    rig.command("mode single");
    rig.start();
    rig.until(2.0, "the end of the first block", |rig| {
        rig.control.snapshot().run == RunState::BlockEnd
    });
    near(display(&rig, 'X'), 60.0);
    rig.start();
    rig.until(2.0, "the end of the second block", |rig| {
        nominal(rig, 'X') > 69.99 && rig.control.snapshot().run == RunState::BlockEnd
    });
    rig.start();
    rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);

    rig.command("mode full");
    rig.command("goto 1");
    rig.seconds(0.3);
    rig.start();
    rig.until(2.0, "M40 goes out", |rig| rig.bit("M2045"));
    near(nominal(&rig, 'X'), 70.0);
}

/// RESTORE POSITION AT the second block: the scan passes the first one without moving, then the axes are led to X60.
#[test]
fn block_search() {
    let mut rig = rig();
    rig.command("restore-at 1");
    rig.seconds(0.3);
    near(nominal(&rig, 'X'), 50.0);
    rig.command("restore-position");
    rig.start();
    rig.until(2.0, "the axes are back", |rig| nominal(rig, 'X') > 59.99);
    rig.start();
    rig.until(2.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 70.0);
}

/// TEST RUN finds the end, and moves nothing; what the PLC writes into Q parameters and what a program of a TNC has left
/// there stays, since these places have none.
#[test]
fn test_run_and_q_parameters() {
    let mut rig = rig();
    rig.command("select 2.H");
    run(&mut rig, 3.0);
    rig.command("select 1.H");
    rig.command("test 1.H");
    rig.seconds(0.2);
    let report = rig
        .control
        .test_report()
        .map(|report| (report.blocks, report.state));
    assert_eq!(report, Some((2, bahn_tnc::TestState::Finished)));
    near(nominal(&rig, 'X'), 55.0);
    run(&mut rig, 3.0);
    let q = rig.control.remember().q;
    assert!(q.contains(&(1, 5.0)), "{q:?}");
}

/// The same on the mill with a head that swivels about B; after the end of a program what is in force stays.
fn swivelling() -> Rig {
    let (mut setup, machine) = Build::swivelling_mill().mp("7300=3").setup();
    setup.programs = Arc::new(Shelf);
    let mut rig = Rig {
        control: Control::new(setup),
        machine,
    };
    rig.power_on();
    rig.command("mode full");
    rig
}

/// A program in the plane of B+30 is broken off; the places that run then are upright ones: X goes to 70 of the machine,
/// Y and Z stay where they stand.
#[test]
fn it_begins_upright_where_a_tilted_program_was_broken_off() {
    let mut rig = swivelling();
    rig.command("select 3.H");
    rig.start();
    rig.until(60.0, "the way in the plane", |rig| machine(rig)[0] > 310.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    rig.command("stop");
    let stands = machine(&rig);
    assert!(stands[2] < 299.0, "Z comes down in the plane: {stands:?}");
    rig.command("select 1.H");
    // TEST RUN begins upright, too.
    rig.command("test 1.H");
    rig.seconds(0.2);
    let tested = rig.control.tested().map(|reader| reader.position());
    let tested = tested.map(|position| [Axis::Y, Axis::Z].map(|axis| position[axis]));
    assert!(
        tested.is_some_and(|[y, z]| (y - stands[1]).abs() < 0.01 && (z - stands[2]).abs() < 0.01),
        "{tested:?} {stands:?}"
    );
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    let there = machine(&rig);
    let expected = [70.0, stands[1], stands[2]];
    assert!(
        (0..3).all(|i| (there[i] - expected[i]).abs() < 0.01),
        "{there:?} is not {expected:?}"
    );
}

/// The plane in which programs begin is one of TNC programs: places that would run upright in spite of it are refused, with
/// the program and the block, and run when it is off.
#[test]
fn the_plane_of_the_menu_is_not_passed_over() {
    let mut rig = swivelling();
    rig.command("mode mdi");
    rig.command("mdi L X+300 Y+200 Z+300 B+30 R0 FMAX");
    rig.start();
    rig.until(60.0, "B+30", |rig| rig.control.snapshot().ended);
    rig.command("mode manual");
    rig.seconds(0.5);
    rig.command("3d-rot run on");
    rig.command("mode full");
    rig.command("select 1.H");
    let stands = machine(&rig);
    rig.start();
    rig.seconds(1.0);
    let messages = rig.messages();
    assert!(
        messages.len() == 1
            && messages[0].contains("FUNCTION NOT YET SUPPORTED")
            && messages[0].contains("3D ROT"),
        "{messages:?}"
    );
    assert!((machine(&rig)[0] - stands[0]).abs() < 0.01);
    assert!(rig.control.snapshot().run != RunState::Running);
    rig.command("ce");
    rig.command("3d-rot run off");
    rig.start();
    rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    assert!((machine(&rig)[0] - 70.0).abs() < 0.01);
}
