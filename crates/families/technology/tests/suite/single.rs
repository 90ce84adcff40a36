//! Single block: the path stops at the end of each programmed block with a motion until the operator starts the next one.

use crate::common::{A, Asked, Bench, RAPID, T, at, ramp_s, when, x};
use bahn_technology::{EventKind, Report};

/// F6000, mm/s.
const V: f64 = 100.0;
const LINE: &str = "%T\nN10 G01 X20 F6000\nN20 X40 M8\nN30 M9\nN40 X60\nN50 X80\nM30\n";

fn stops(report: &Report) -> Vec<(f64, f64)> {
    let stops = report.of(EventKind::Stop);
    stops.iter().map(|event| (event.t, x(event))).collect()
}

/// When the path moves, without the first motion of the run.
fn goes(report: &Report) -> Vec<f64> {
    report
        .of(EventKind::Go)
        .iter()
        .skip(1)
        .map(|event| event.t)
        .collect()
}

fn blocks(report: &Report, kind: EventKind) -> Vec<&str> {
    let of = report.of(kind);
    of.iter().map(|event| event.block.as_deref().unwrap()).collect()
}

/// A start is a block: its functions, those of blocks without a motion after it, and the motion.
#[test]
fn a_start_is_a_block_with_a_motion() {
    let report = Bench::new(LINE, "m_synch[8] MOS\nm_synch[9] MOS")
        .script("single 0..9\nstart 1\nstart 2\nstart 3\nstart 4\n")
        .run();
    assert!(
        report.completed && report.waits.is_empty() && report.warnings.is_empty(),
        "{:?} {:?}",
        report.error,
        report.waits
    );
    let block_s = ramp_s(20.0, V);
    // The last standstill is the end of the path.
    let stops = stops(&report);
    assert_eq!(stops.len(), 3);
    for (number, (t, place)) in stops.iter().enumerate() {
        when(*t, number as f64 + block_s);
        at(*place, 20.0 * (number + 1) as f64);
    }
    assert_eq!(goes(&report), [1.0, 2.0, 3.0]);
    assert_eq!(blocks(&report, EventKind::Stop), ["N10", "N20", "N40"]);
    assert_eq!(blocks(&report, EventKind::Go), ["N10", "N20", "N40", "N50"]);
    // The function of a block goes out with its start, that of a block without a motion with the next one.
    assert_eq!((report.output("M8").t, report.output("M9").t), (1.0, 2.0));
    // M30 is started, too.
    when(report.time_s, 4.0);
}

/// Where single block ends, the path goes on; without it nothing stops.
#[test]
fn it_goes_on_where_single_block_ends() {
    let list = "m_synch[8] MOS\nm_synch[9] MOS";
    let report = Bench::new(LINE, list).script("single 0..1.5\n").run();
    assert_eq!(goes(&report), [1.5]);
    when(report.time_s, 1.5 + ramp_s(60.0, V));
    assert_eq!(report.output("M8").t, 1.5);
    let plain = Bench::new(LINE, list).run();
    when(plain.time_s, ramp_s(80.0, V));
    assert!(stops(&plain).is_empty());
}

/// Switched on too late for the end of a block, single block counts from the first one at which the path can stop.
#[test]
fn the_first_end_at_which_it_can_stop() {
    // Blocks of 1 mm; the path needs 5 mm to stop.
    let program: String = (1..=60)
        .map(|number| format!("N{number} G01 X{number} F6000\n"))
        .collect();
    let program = format!("%T\n{program}M30\n");
    let begin = 0.25;
    let report = Bench::new(&program, "")
        .script(&format!("single {begin}..2\n"))
        .run();
    let place = V * begin - V * V / (2.0 * A) + V * V / (2.0 * A);
    let stops = stops(&report);
    at(stops[0].1, place.ceil());
    assert_eq!(stops.len(), 1);
    // A start while it runs has no effect, and is reported.
    let early = Bench::new(&program, "")
        .script("single 0..2\nstart 0.02\nstart 1\n")
        .run();
    at(self::stops(&early)[1].1, 2.0);
    assert_eq!(early.warnings.len(), 1);
    assert!(
        early.warnings[0].message.contains("0.02 s has no effect"),
        "{:?}",
        early.warnings
    );
    assert_eq!(early.warnings[0].program, "p1.nc");
}

/// What belongs to the block that is at its end is waited for there; a start before that has no effect. What goes on by
/// itself does so while the path stands: acknowledgements, late functions, dwells.
#[test]
fn gates_and_late_functions_while_it_stands() {
    let program = "%T\nN10 M24 G00 X20\nN20 X40 M8\nN30 G01 X60 F6000 M9\nM30\n";
    let list = "m_synch[24] MVS_SLM\nm_synch[8] MNS_SNS\nm_synch[9] MVS_SVS\n";
    let rapid_s = ramp_s(20.0, RAPID);
    let script = "M24 ack 0.5\nM8 ack 0.4\nM9 ack 0.3\nsingle 0..9\nstart 1\nstart 1.5\nstart 2\nstart 8\n";
    let report = Bench::new(program, list).script(script).run();
    assert!(report.completed, "{:?} {:?}", report.error, report.waits);
    // The late function is acknowledged while the path stands, so that the feed block does not wait for it.
    assert!(report.waits.iter().all(|wait| wait.function != "M24"));
    // M8 is of N20: it goes out at the end of it, and holds it; the start at 1.5 comes while it does.
    when(report.output("M8").t, 1.0 + rapid_s);
    when(report.wait("M8").1, 1.0 + rapid_s + 0.4);
    assert_eq!(report.warnings.len(), 1);
    // Of N30 nothing goes out before its start; then its gate waits as always.
    assert_eq!(report.output("M9").t, 2.0);
    when(report.wait("M9").0, 2.0);
    when(report.wait("M9").1, 2.3);
    when(goes(&report)[1], 2.3);
    // At the end of a block the path stands once: for the function, and then for the start.
    assert_eq!(stops(&report).len(), 2);
}

/// A block that a Micro Joint splits is one; a joint at a block limit is as a block of its own after it.
#[test]
fn a_split_block_is_one_block() {
    let list = "configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n\
        m_synch[55] MOS\nm_pre_outp[55] 50000\nm_synch[56] MVS_SNS\nm_pre_outp[56] 50000\n\
        m_synch[57] MOS\nm_pre_outp[57] 200000\n";
    let program = "%T\nN10 G01 X20 F6000\nN20 X40 M55\nN30 X60 M56\nN40 X80\nN50 X100 M57\nM30\n";
    let report = Bench::new(program, list)
        .script("M56 ack 0.3\nsingle 0..9\nstart 1\nstart 2\nstart 3\nstart 4\nstart 5\n")
        .run();
    let places: Vec<f64> = stops(&report).iter().map(|stop| stop.1).collect();
    assert_eq!(places.len(), 4);
    for (place, expected) in places.iter().zip([20.0, 40.0, 60.0, 80.0]) {
        at(*place, expected);
    }
    for (function, place) in [("M55", 15.0), ("M56", 35.0), ("M57", 60.0)] {
        at(x(report.output(function)), place);
    }
    // M56 splits N20, at whose end it is waited for before the block is at its end.
    when(report.wait("M56").0, 1.0 + ramp_s(20.0, V));
    at(report.wait("M56").2, 40.0);
    // M57 lies at the limit between N30 and N40.
    assert_eq!(report.output("M57").t, 3.0);
}

/// What is output ahead goes out where the path passes its place, in whatever block that is; a time ahead does not count
/// how long the path stands.
#[test]
fn what_is_output_ahead() {
    let program = "%T\nN10 G01 X20 F6000\nN20 X40\nN30 X60 M55\nN40 X80 M56\nM30\n";
    let list = "m_synch[55] MEP_SVS\nm_pre_outp[55] 300000\nm_synch[56] MET_SVS\nm_pre_outp[56] 100000\n";
    let report = Bench::new(program, list)
        .script("single 0..9\nstart 1\nstart 2\nstart 3\nstart 4\ndefault ack 0.05\n")
        .run();
    assert!(
        report.completed && report.waits.is_empty(),
        "{:?} {:?}",
        report.error,
        report.waits
    );
    // 30 mm before X40.
    at(x(report.output("M55")), 10.0);
    assert!(report.output("M55").t < 1.0);
    // 0.1 s before the standstill at X60, which N30 reaches 0.1 s and more after its start.
    when(report.output("M56").t, 2.0 + ramp_s(20.0, V) - 0.1);
}

/// An axis that moves on its own ends with its block, which counts as a block with a motion. A dwell does not.
#[test]
fn independent_axes_and_dwells() {
    let program = "%T\nN10 G01 X20 F6000\nN20 Y[INDP G90 G01 FEED=6000 POS=20]\nN30 G04 X0.5\nN40 X40\nM30\n";
    let report = Bench::new(program, "")
        .script("single 0..9\nstart 1\nstart 2\nstart 4\n")
        .run();
    assert!(
        report.completed && report.warnings.is_empty(),
        "{:?} {:?}",
        report.error,
        report.waits
    );
    // N20 is started at 1 s and at its end until 2 s; the dwell and the motion after it are one start.
    when(goes(&report)[0], 2.5);
    when(report.time_s, 4.0);
}

/// Subroutine ends and jumps change nothing: a block of a subroutine is a block. Decoding that waits for the path to run
/// empty waits for the start, too.
#[test]
fn subroutines_and_flushes() {
    let program = "%T\nN10 G01 X20 F6000\nN20 L SUB\n#FLUSH WAIT\nN30 X80\nM30\n";
    let report = Bench::new(program, "")
        .subroutine("SUB", "%SUB\nN1 X40\nN2 X60\nM17\n")
        .script("single 0..9\nstart 1\nstart 2\nstart 3\nstart 4\n")
        .run();
    assert!(report.completed, "{:?} {:?}", report.error, report.waits);
    assert_eq!(goes(&report), [1.0, 2.0, 3.0]);
    assert_eq!(blocks(&report, EventKind::Stop), ["N10", "N1", "N2"]);
}

/// In backward motion the path stops at the same places.
#[test]
fn backward_motion_is_block_by_block_too() {
    let program = "%T\nN10 G01 X20 F6000\nN20 X40\nN30 X60\nM30\n";
    let report = Bench::new(program, "")
        .script("backward 0.5..5\nsingle 0.55..4\nstart 2\nstart 3\n")
        .run();
    assert!(report.completed, "{:?} {:?}", report.error, report.waits);
    let stops = stops(&report);
    let places: Vec<f64> = stops.iter().map(|stop| stop.1).collect();
    // It turns past X50; the ends of N20 and N10 are its stops, then the start of the path.
    assert!(places[0] > 50.0 && places[0] < 60.0, "{stops:?}");
    for (place, expected) in places[1..].iter().zip([40.0, 20.0, 0.0]) {
        at(*place, expected);
    }
    when(goes(&report)[1], 2.0);
    when(goes(&report)[2], 3.0);
    at(report.path_end.0[bahn_path::Axis::X], 60.0);
}

/// Held, overridden and reset while it stands.
#[test]
fn a_hold_and_a_reset_while_it_stands() {
    let program = "%T\nN10 G01 X20 F6000\nN20 X40 M8\nM30\n";
    let held = Bench::new(program, "m_synch[8] MOS")
        .script("single 0..9\nhold 0.5..2\nstart 1\nstart 3\n")
        .run();
    // Functions go out at the start, the path goes when it may.
    assert_eq!((held.output("M8").t, goes(&held)), (1.0, vec![2.0]));
    let reset = Bench::new(program, "m_synch[8] MOS")
        .script("single 0..9\nreset 1\n")
        .run();
    assert!(!reset.completed && reset.error.is_none());
    when(reset.time_s, 1.0);
    assert!(reset.of(EventKind::Output).is_empty());
    // It ends in any case: no range of times is without end.
    let alone = Bench::new(program, "m_synch[8] MOS")
        .script("single 0..100\n")
        .run();
    when(alone.time_s, 100.0 + ramp_s(20.0, V));
    assert!(alone.completed && T < 0.01);
}
