//! What of a DIN 66025 program reaches a contouring control, and how a run goes back in it.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a helper that panics fails its test"
)]

use std::sync::Arc;

use bahn_nc::NcReader;
use bahn_parameters::own_functions::{Lead, OwnFunction, OwnFunctions};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{
    At, Axis, AxisSet, Barrier, Curve, ElementSource, FeedRate, Function, LiveData, PathElement, Position,
    SpindleOrder, Step, Synchronisation,
};
use bahn_reader::{ProgramError, Reader, Start};
use bahn_text::MemoryFiles;

const MODEL: ControlModel = ControlModel::Tnc415b;

fn start(functions: OwnFunctions) -> Start {
    Start::of(
        &ParameterList::reference(MODEL),
        functions,
        AxisSet::EMPTY,
        Position::ZERO,
    )
}

fn reader(text: &str) -> NcReader {
    let beside = MemoryFiles::from([("side.sub", "N1 G01 Y5 F500\nN2 M17\n")]);
    NcReader::new(
        "part.nc",
        text.as_bytes(),
        start(OwnFunctions::default()),
        Arc::new(beside),
    )
}

/// All elements up to the end; barriers are answered.
fn elements(reader: &mut dyn Reader) -> Vec<PathElement> {
    let mut elements = Vec::new();
    loop {
        match reader.next() {
            Step::Element(element) => elements.push(element),
            Step::Barrier(_) => reader.resume(LiveData::default()),
            Step::End => return elements,
            Step::Starved => panic!("it is not starved"),
            Step::Error(error) => panic!("{error:?}"),
        }
    }
}

fn error(text: &str) -> Box<ProgramError> {
    let mut reader = reader(text);
    loop {
        match reader.next() {
            Step::Error(error) => return error,
            Step::End => panic!("{text} has no error"),
            _ => {}
        }
    }
}

fn x(element: &PathElement) -> (f64, f64) {
    (element.start[Axis::X], element.end[Axis::X])
}

/// Rapid, line with its feed, quarter of a circle to the right of its chord, dwell; the blocks are the lines of the text.
#[test]
fn the_path() {
    let mut run = reader(
        "%PATH\n(a quarter)\nN10 G00 X10\nN20 G01 X20 F600\n\nN30 G02 X30 Y-10 I0 J-10\nN40 G04 0.5\nN50 M30\n",
    );
    let path = elements(&mut run);
    assert_eq!(path[0].feed, FeedRate::Rapid);
    assert_eq!(
        (path[1].feed, x(&path[1])),
        (FeedRate::Programmed(600.0), (10.0, 20.0))
    );
    let Curve::Arc(arc) = path[2].curve else {
        panic!("{:?}", path[2].curve)
    };
    assert_eq!((arc.centre, arc.sweep_deg), ([20.0, -10.0], -90.0));
    assert_eq!((path[3].curve, path[3].dwell_s), (Curve::Hold, 0.5));
    let blocks: Vec<u32> = path.iter().map(|element| element.block.block).collect();
    // 1 %PATH, 2 the comment, 3 N10, 4 N20, 5 N30, 6 N40, 7 N50; the empty line is no block.
    assert_eq!(blocks, [3, 4, 5, 6, 7]);
    let program = run.program(0).unwrap();
    assert_eq!(program.text_of(5), "N30 G02 X30 Y-10 I0 J-10");
    assert_eq!(run.blocks_executed(), 5);
}

/// M3 and M8 at the start of the block, M5 at its end, as the control's own programs have them [000:7084-7089]; S before
/// M3, in the order of the text; M30 at the end.
#[test]
fn functions() {
    let path = elements(&mut reader("N10 G01 X10 F100 S800 M3\nN20 X20 M5\nN30 M30\n"));
    let of = |element: &PathElement| -> Vec<(Function, At, Option<SpindleOrder>)> {
        let functions = element.functions().iter();
        functions
            .map(|out| (out.function.clone(), out.at, out.spindle))
            .collect()
    };
    let clockwise = Some(SpindleOrder::Clockwise);
    assert_eq!(
        of(&path[0]),
        [
            (Function::SpindleSpeed(800.0), At::Start, None),
            (Function::M(3), At::Start, clockwise)
        ]
    );
    assert_eq!(
        of(&path[1]),
        [(Function::M(5), At::End, Some(SpindleOrder::Stop))]
    );
    assert_eq!(
        of(&path[2]),
        [(Function::M(30), At::End, Some(SpindleOrder::StopWithRun))]
    );
}

/// The machine builder's synchronisation of an M function counts in every language.
#[test]
fn own_functions() {
    let mut own = OwnFunctions::default();
    own.add(MODEL, 40, OwnFunction::of("MVS_SNS", Lead::default()).unwrap())
        .unwrap();
    let mut run = NcReader::new(
        "a.nc",
        b"N10 G01 X10 F100 M40\n",
        start(own),
        Arc::new(MemoryFiles::default()),
    );
    let path = elements(&mut run);
    assert_eq!(path[0].functions()[0].synchronisation, Synchronisation::MvsSns);
}

/// M0 stops after its block; `#FLUSH WAIT` waits until everything before it is executed.
#[test]
fn stops() {
    let mut run = reader("N10 G01 X10 F100 M0\n#FLUSH WAIT\nN20 X20\n");
    assert!(matches!(run.next(), Step::Element(_)));
    assert!(matches!(run.next(), Step::Barrier(Barrier::Stop { block }) if block.block == 1));
    assert!(
        matches!(run.next(), Step::Barrier(Barrier::Stop { .. })),
        "until it is answered"
    );
    run.resume(LiveData::default());
    assert!(matches!(run.next(), Step::Barrier(Barrier::Acknowledge { block }) if block.block == 2));
    run.resume(LiveData::default());
    assert!(matches!(run.next(), Step::Element(element) if x(&element) == (10.0, 20.0)));
    assert_eq!(run.next(), Step::End);
}

/// A subroutine beside the program is a program of its own in the run; the main program goes on after it.
#[test]
fn subroutines() {
    let mut run = reader("N10 G00 X10\nN20 L side\nN30 G01 X20 F100\n");
    let path = elements(&mut run);
    let blocks: Vec<_> = path
        .iter()
        .map(|element| (element.block.program, element.block.block))
        .collect();
    assert_eq!(blocks, [(0, 1), (1, 1), (0, 3)]);
    assert_eq!(run.program(1).unwrap().name(), "side.sub");
}

/// The programs of a file run one after the other, each with new modal data, the path where it was.
#[test]
fn several_programs() {
    let path = elements(&mut reader("%A\nN10 G91 G01 X10 F100\nN20 M30\n%B\nN10 X40\n"));
    assert_eq!((x(&path[2]), path[2].feed), ((10.0, 40.0), FeedRate::Rapid));
}

/// What this control cannot do is refused at its block, with the name of what can; what a text has wrong is said, too.
#[test]
fn refusals() {
    for (text, detail) in [
        (
            "N20 H5",
            "H5: this control has no H functions: `bahn technology` runs it",
        ),
        (
            "N20 M7=3",
            "M7: its additive value goes to no PLC of this control: `bahn technology` runs it",
        ),
        (
            "N20 X[M7]",
            "a function goes to the range of axis X: `bahn technology` runs it",
        ),
        (
            "N20 S2[M3]",
            "there is no spindle S2 here: `bahn technology` runs it",
        ),
        (
            "N20 M300",
            "M300 is no function of a TNC 415 B: `bahn technology` runs it",
        ),
        (
            "N20 M91",
            "M91 acts on the path of a plain-language or DIN/ISO program alone",
        ),
        (
            "N20 G41",
            "G41 and G42: no tool has a radius in these programs: `bahn technology` runs it",
        ),
        (
            "N20 G108",
            "G107 and G108: this control measures no edge banding: `bahn technology` runs it",
        ),
        (
            "N20 V.G.M_FCT[40].SYNCH = \"MOS\"",
            "V.G.M_FCT[40].SYNCH is a variable of a TF5200 channel, which `bahn technology` has",
        ),
        (
            "N20 X[INDP G01 FEED=100 POS=5]",
            "INDP: axes of this control move on their own by the PLC: `bahn technology` runs it",
        ),
        (
            "N20 P1 = V.G.RW",
            "V.G.RW is a variable of a TF5200 channel, which `bahn technology` has",
        ),
        ("N20 G01 X20", "no feed F is programmed"),
    ] {
        let error = error(&format!("N10 G00 X10\n{text}\n"));
        assert_eq!((error.detail.as_str(), error.block.block), (detail, 2), "{text}");
        let said = match text {
            "N20 G01 X20" => "WRONG PROGRAM DATA",
            _ => "FUNCTION NOT YET SUPPORTED",
        };
        assert_eq!(error.message.text(MODEL), said, "{text}");
    }
    assert_eq!(
        error("N10 S1000000 M3").message.text(MODEL),
        "WRONG SPINDLE SPEED"
    );
}

/// Stopped in N20 at X14, the run goes back to N20: it begins where the axes stand and ends where it would have, also with
/// incremental coordinates. N30 then counts from there.
#[test]
fn back_to_a_block() {
    let mut run = reader("N10 G00 X10\nN20 G91 G01 X10 Y4 F100\nN30 X5\n");
    run.keep_checkpoints();
    assert_eq!(elements(&mut run).len(), 3);
    run.go_back(&|mark| mark.sequence <= 2);
    assert_eq!(run.at().block, 2);
    run.retry();
    let mut stands = Position::ZERO;
    (stands[Axis::X], stands[Axis::Y], stands[Axis::Z]) = (14.0, 1.6, 7.0);
    run.relocate(&stands);
    let path = elements(&mut run);
    assert_eq!([x(&path[0]), x(&path[1])], [(14.0, 20.0), (20.0, 25.0)]);
    assert_eq!((path[0].end[Axis::Y], path[1].end[Axis::Y]), (4.0, 4.0));
    // Z was moved by hand meanwhile, and no block moves it back.
    assert_eq!((path[0].end[Axis::Z], path[1].end[Axis::Z]), (7.0, 7.0));
}

/// A run of a program that is read to its end and goes back to its first block, with the axes at a place in X and Y.
fn gone_back(text: &str, [x, y]: [f64; 2]) -> NcReader {
    let mut run = reader(text);
    run.keep_checkpoints();
    elements(&mut run);
    run.go_back(&|mark| mark.sequence == 1);
    run.retry();
    let mut stands = Position::ZERO;
    (stands[Axis::X], stands[Axis::Y]) = (x, y);
    run.relocate(&stands);
    run
}

/// Degrees of the arc with which a run goes on; `None` where it is refused.
fn sweep(run: &mut NcReader) -> Option<f64> {
    match run.next() {
        Step::Element(element) => match element.curve {
            Curve::Arc(arc) => Some(arc.sweep_deg),
            other => panic!("{other:?}"),
        },
        Step::Error(error) => {
            assert_eq!(error.message.text(MODEL), "ARC END-POINT INCORRECT");
            None
        }
        other => panic!("{other:?}"),
    }
}

/// A half circle from X0 to X20 about X10, left after a quarter of it: 90 degrees are left. Beside the circle there is no way.
#[test]
fn back_into_an_arc() {
    for (y, left) in [(-10.0, Some(90.0)), (-9.0, None)] {
        let mut run = gone_back("N10 G03 X20 I10 J0 F100\n", [10.0, y]);
        assert_eq!(sweep(&mut run).map(f64::round), left);
    }
}

/// Where the axes stand at the start of an arc, all of it is left: coordinates that come back from the machine are rounded,
/// and axes stop within a tolerance. 0.005 mm of a radius of 10 mm are 0.005 / 10 radians.
#[test]
fn back_to_the_start_of_an_arc() {
    let before_deg = (0.005_f64 / 10.0).to_degrees();
    let half = ("N10 G03 X20 I10 J0 F100\n", 180.0);
    let half_clockwise = ("N10 G02 X20 I10 J0 F100\n", -180.0);
    let full = ("N10 G03 X0 Y0 I10 J0 F100\n", 360.0);
    // No coordinate says the end: it is the start of the block, not where the axes stand.
    let of_centre = ("N10 G02 I10 J0 F100\n", -360.0);
    for (text, whole) in [half, half_clockwise, full, of_centre] {
        for place in [[0.0, 0.0], [1e-12, 0.0], [-1e-12, 1e-12], [0.0, -1e-12]] {
            let left = sweep(&mut gone_back(text, place)).unwrap();
            assert!((left - whole).abs() < 1e-9, "{text} from {place:?}: {left}");
        }
        // G03 begins towards Y-, G02 towards Y+: what is before the start lies on the other side.
        let before = 0.005 * f64::signum(whole);
        let mut run = gone_back(text, [0.0, before]);
        let left = sweep(&mut run).unwrap();
        let expected = whole + before_deg.copysign(whole);
        assert!((left - expected).abs() < 1e-4, "{text}: {left}");
    }
}

/// Where the axes stand at the end of an arc, nothing of it is left, even a rounding after it: the next block begins.
#[test]
fn back_to_the_end_of_an_arc() {
    for y in [0.0, 1e-12, 0.005] {
        let mut run = gone_back("N10 G03 X20 I10 J0 F100\nN20 G01 X30\n", [20.0, y]);
        let path = elements(&mut run);
        let turns: f64 = path.iter().map(PathElement::length).sum();
        assert!((turns - 10.0).abs() <= 0.01, "Y{y}: {turns} mm");
        assert!(
            path.iter().all(|element| element.length() > 0.0),
            "Y{y}: {path:?}"
        );
        let end = path.last().unwrap().end;
        assert_eq!((end[Axis::X], end[Axis::Y]), (30.0, 0.0));
    }
}

/// What a block programs is executed, also where it says the place at which the axes stood before they were moved by hand:
/// Z is raised again to 50, and Y goes back to 0.
#[test]
fn a_programmed_place_is_reached_from_anywhere() {
    let mut run = reader("N10 G00 Z50\nN20 Z50\nN30 G01 X20 Y0 F100\n");
    run.keep_checkpoints();
    elements(&mut run);
    run.go_back(&|mark| mark.sequence == 1);
    run.retry();
    assert!(matches!(run.next(), Step::Element(_)));
    let mut stands = Position::ZERO;
    (stands[Axis::X], stands[Axis::Y], stands[Axis::Z]) = (3.0, 5.0, 10.0);
    run.relocate(&stands);
    let path = elements(&mut run);
    assert_eq!(path.len(), 2);
    assert_eq!((path[0].start[Axis::Z], path[0].end[Axis::Z]), (10.0, 50.0));
    assert_eq!((path[0].end[Axis::X], path[0].end[Axis::Y]), (3.0, 5.0));
    assert_eq!((path[1].end[Axis::X], path[1].end[Axis::Y]), (20.0, 0.0));
}

/// Incremental coordinates count from where the block would have begun, X10, however often the axes are moved before it,
/// and in the next program of the file, too.
#[test]
fn increments_count_from_the_path() {
    for text in [
        "N10 G00 X10\nN20 G91 X5\n",
        "%A\nN10 G00 X10\nN20 M30\n%B\nN10 G91 X5\n",
    ] {
        let mut run = reader(text);
        assert!(matches!(run.next(), Step::Element(_)));
        for x in [12.0, 13.0] {
            let mut stands = Position::ZERO;
            stands[Axis::X] = x;
            run.relocate(&stands);
        }
        let path = elements(&mut run);
        assert!(
            path.iter().any(|element| x(element) == (13.0, 15.0)),
            "{text}: {path:?}"
        );
    }
}

/// An axis without a position stands at 0, also when it is moved by hand before the first block.
#[test]
fn an_arc_from_an_unknown_place() {
    let unknown = Start {
        position: bahn_path::PerAxis::splat(f64::NAN).into(),
        ..start(OwnFunctions::default())
    };
    let text = b"N10 G03 X20 I10 J0 F100\n";
    let mut run = NcReader::new("a.nc", text, unknown, Arc::new(MemoryFiles::default()));
    let mut untouched = run.clone();
    assert_eq!(sweep(&mut untouched), Some(180.0));
    let mut stands = Position::ZERO;
    (stands[Axis::X], stands[Axis::Y]) = (10.0, -10.0);
    run.relocate(&stands);
    assert_eq!(sweep(&mut run).map(f64::round), Some(90.0));
}

/// At a stop after the place where the axes were moved to, the PLC moves them again: the next block begins where they stand
/// then.
#[test]
fn moved_at_a_stop() {
    let mut run = reader("N10 G00 X10\nN20 M0\nN30 G01 X20 F100\n");
    assert!(matches!(run.next(), Step::Element(_)));
    let mut stands = Position::ZERO;
    stands[Axis::X] = 12.0;
    run.relocate(&stands);
    assert!(matches!(run.next(), Step::Element(element) if element.curve == Curve::Hold));
    assert!(matches!(run.next(), Step::Barrier(Barrier::Stop { .. })));
    stands[Axis::X] = 15.0;
    run.stand_at(&stands);
    run.resume(LiveData::default());
    assert_eq!(
        elements(&mut run).iter().map(x).collect::<Vec<_>>(),
        [(15.0, 20.0)]
    );
}

/// A block that was refused stays the next one, with everything as it was before it.
#[test]
fn a_refused_block_is_tried_again() {
    let mut run = reader("N10 G91 G00 X10\nN20 X5 H5\n");
    run.keep_checkpoints();
    assert!(matches!(run.next(), Step::Element(_)));
    for _ in 0..2 {
        assert!(matches!(run.next(), Step::Error(error) if error.block.block == 2));
        assert_eq!((run.at().block, run.blocks_executed()), (2, 1));
        run.retry();
    }
}

/// A run that begins at N20 of the second program, line 6, finds nothing in force but where the axes stand.
#[test]
fn a_block_to_begin_with() {
    let mut run = reader("%A\nN10 G01 X10 F100\nN20 X20\n%B\nN10 G00 X30\nN20 X40\n");
    run.goto(6);
    assert_eq!(run.at().block, 6);
    let path = elements(&mut run);
    assert_eq!((path.len(), x(&path[0])), (1, (0.0, 40.0)));
}

/// A subroutine of the file is run by its calls alone: a run that shall begin in it, at its head or after it, is refused,
/// and stays so. Only a start elsewhere goes on.
#[test]
fn no_start_in_a_subroutine() {
    // Lines and blocks 1 %A, 2 N10, 3 N20, 4 %L SUB, 5 N10, 6 N30, 7 %B, 8 N10.
    let text = "%A\nN10 LL SUB\nN20 M30\n%L SUB\nN10 G00 X5\nN30 M17\n%B\nN10 G00 X30\n";
    for kept in [false, true] {
        for block in 4..=6 {
            let mut run = reader(text);
            if kept {
                run.keep_checkpoints();
            }
            run.goto(block);
            for _ in 0..2 {
                assert_eq!(run.at().block, block);
                let Step::Error(error) = run.next() else {
                    panic!("block {block} is begun with")
                };
                assert_eq!(error.message.text(MODEL), "WRONG PROGRAM DATA");
                assert_eq!(error.detail, "the block stands in a subroutine");
                assert_eq!(error.block.block, block);
                run.retry();
            }
            run.goto(8);
            assert_eq!(x(&elements(&mut run)[0]), (0.0, 30.0));
        }
    }
    // Neither what stands before the first head nor block 0, the begin that nobody writes, belongs to a subroutine.
    for (text, block) in [
        ("(of 1997)\n%L SUB\nN10 M17\n%B\nN10 G00 X30\n", 1),
        ("%L SUB\nN10 M17\n%B\nN10 G00 X30\n", 0),
    ] {
        let mut run = reader(text);
        run.goto(block);
        assert_eq!(x(&elements(&mut run)[0]), (0.0, 30.0));
    }
}

/// Whoever begins elsewhere in a run leaves what was before: its stop, the elements on their way, and its states.
#[test]
fn a_new_start_leaves_the_run_before() {
    let text = "N10 G00 X10\nN20 M0\nN30 X20\nN40 G01 X30 F100\n";
    let mut run = reader(text);
    run.keep_checkpoints();
    assert!(matches!(run.next(), Step::Element(_)));
    assert!(matches!(run.next(), Step::Element(_)));
    let Step::Barrier(Barrier::Stop { block }) = run.next() else {
        panic!("M0 stops")
    };
    assert_eq!(run.stop_function(block), Some("M0"));
    run.goto(4);
    assert_eq!(run.stop_function(block), None);
    // No state of the run before is left: nothing is gone back to.
    run.go_back(&|_| true);
    assert_eq!(run.at().block, 4);
    assert_eq!(x(&elements(&mut run)[0]), (10.0, 30.0));
}

/// Without states the block that failed is not tried again, and the error stays: the run has not done what stands there.
#[test]
fn an_error_is_not_passed_over() {
    for text in [
        "N10 G00 X10\nN20 X5 H5\nN30 X20\n",
        "N10 G00 X10\nN20 X=\nN30 X20\n",
    ] {
        let mut run = reader(text);
        assert!(matches!(run.next(), Step::Element(_)));
        for _ in 0..2 {
            assert!(matches!(run.next(), Step::Error(error) if error.block.block == 2));
            assert_eq!(run.at().block, 2, "{text}");
            run.retry();
        }
    }
    // Nor does a file without a program end as if it had run.
    let mut run = reader("%L SUB\nN10 M17\n");
    for _ in 0..2 {
        let Step::Error(error) = run.next() else {
            panic!("there is no program")
        };
        assert_eq!(error.detail, "the file has no program, only subroutines");
        run.retry();
    }
}

/// Work is counted, and a flag ends it: the run goes on later.
#[test]
fn work() {
    let mut run = reader("N10 G00 X10\nN20 X20\n");
    run.allow(1);
    assert!(matches!(run.next(), Step::Element(_)));
    assert_eq!(run.next(), Step::Starved);
    run.allow(10);
    assert!(matches!(run.next(), Step::Element(_)));
    assert_eq!(run.next(), Step::End);
}

/// The blocks of a subroutine have the numbers of its own file, whatever that is called.
#[test]
fn numbers_of_a_subroutine() {
    let mut run = reader("N10 G00 X10\n\nN50 L side\nN60 M30\n");
    let path = elements(&mut run);
    let numbers: Vec<(u16, u32)> = path
        .iter()
        .map(|element| {
            let program = run.program(element.block.program).unwrap();
            (element.block.program, program.number_of(element.block.block))
        })
        .collect();
    assert_eq!(numbers[..2], [(0, 10), (1, 1)]);
    assert_eq!(numbers.last(), Some(&(0, 60)));
}
