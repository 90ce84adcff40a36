//! Functions that are output ahead, in backward motion and forward again.

use crate::common::{A, Asked, Bench, T, at, when, x};
use bahn_path::Axis;
use bahn_technology::{EventKind, Report};

/// F6000, mm/s, and the distance to that speed and from it, mm.
const V: f64 = 100.0;
const RAMP: f64 = V * V / (2.0 * A);
/// M96 belongs to X40.
const PROGRAM: &str = "%T\nN10 G01 X10 F6000\nN20 X20\nN30 X30\nN40 X40\nN50 M96\nN55 X80\nM30\n";
const PATH: &str = "m_synch[96] MEP_SVS\nm_pre_outp[96] 250000\n";

fn places(report: &Report) -> Vec<f64> {
    report.outputs("M96").iter().map(|event| x(event)).collect()
}

fn run(list: &str, script: &str) -> Report {
    let report = Bench::new(PROGRAM, list).script(script).run();
    assert!(report.completed, "{:?} {:?}", report.error, report.waits);
    at(report.path_end.0[Axis::X], 80.0);
    report
}

#[track_caller]
fn are(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (place, expected) in found.iter().zip(expected) {
        assert!((place - expected).abs() < 1e-3, "{found:?}");
    }
}

/// When the path begins to brake that is to stand at a place, s: it comes 5 mm late, and takes 5 mm to stop.
fn brakes_for(place: f64) -> f64 {
    place / V
}

/// Ahead, at its own place in backward motion, and ahead again.
#[test]
fn what_is_passed_back_goes_out_ahead_again() {
    let script = format!("M96 ack 0.05\nbackward {}..2\n", brakes_for(60.0));
    for (kind, waits) in [("MEP_SVS", true), ("MEP_MOS", false)] {
        let report = run(&PATH.replace("MEP_SVS", kind), &script);
        are(&places(&report), &[15.0, 40.0, 15.0]);
        assert!(report.waits.is_empty());
        // In backward motion it is MOS.
        let acknowledged = report.of(EventKind::Acknowledge).len();
        assert_eq!(acknowledged, if waits { 2 } else { 0 });
        assert_eq!(report.of(EventKind::Fetch).len(), 3);
    }
    // Where its acknowledgement is late, the path stands for it again: 25 mm take 0.3 s.
    let late = run(
        PATH,
        &format!("M96 ack 0.4\nbackward {}..3\n", brakes_for(60.0) + 0.2),
    );
    are(&places(&late), &[15.0, 40.0, 15.0]);
    let waits: Vec<f64> = late.waits.iter().map(|wait| wait.position.0[Axis::X]).collect();
    are(&waits, &[40.0, 40.0]);
}

/// With BWD_SYNCH the path waits at its place in backward motion.
#[test]
fn a_function_ahead_with_the_bit() {
    let list = PATH.replace("MEP_SVS", "MEP_SVS | BWD_SYNCH");
    let report = run(
        &list,
        &format!("M96 ack 0.2\nbackward {}..2.5\n", brakes_for(60.0)),
    );
    are(&places(&report), &[15.0, 40.0, 15.0]);
    let (from, to, place) = report.wait("M96");
    at(place, 40.0);
    when(to - from, 0.2);
}

/// Where the path turns between the place of output and its own, it goes out at once: nothing is left to go out earlier.
#[test]
fn it_turns_between_output_and_place() {
    // Back from X60 to X30: 30 mm in 0.3 s and a ramp.
    let back = brakes_for(60.0);
    let end = back + V / A + 30.0 / V;
    let report = run(PATH, &format!("M96 ack 0.05\nbackward {back}..{end}\n"));
    are(&places(&report), &[15.0, 40.0, 30.0]);
    assert!(report.waits.is_empty());
    // X40 was passed before in time; from X35 the path is there before the acknowledgement.
    let end = back + V / A + 25.0 / V;
    let waited = run(PATH, &format!("M96 ack 0.19\nbackward {back}..{end}\n"));
    are(&places(&waited), &[15.0, 40.0, 35.0]);
    let (from, to, place) = waited.wait("M96");
    at(place, 40.0);
    // It goes out a cycle after the turn.
    when(to - from, 0.19 + T - 2.0 * (5.0 / A).sqrt());
}

/// What was output, and whose place was not reached, is output again only if the path comes over the place of output.
#[test]
fn it_turns_before_its_place() {
    let turn = brakes_for(30.0);
    // Back to X20: not over X15.
    let short = run(
        PATH,
        &format!("M96 ack 0.05\nbackward {turn}..{}\n", turn + V / A + 10.0 / V),
    );
    are(&places(&short), &[15.0]);
    let long = run(PATH, &format!("M96 ack 0.05\nbackward {turn}..1.5\n"));
    are(&places(&long), &[15.0, 15.0]);
    // Not output yet, it is not repeated.
    let turn = brakes_for(12.0);
    let before = run(PATH, &format!("M96 ack 0.05\nbackward {turn}..1\n"));
    are(&places(&before), &[15.0]);
}

/// A time ahead is counted anew.
#[test]
fn a_time_ahead() {
    let list = "m_synch[96] MET_SVS\nm_pre_outp[96] 300000\n";
    let report = run(list, &format!("M96 ack 0.05\nbackward {}..2\n", brakes_for(60.0)));
    // 0.3 s before a standstill at X40: 0.1 s of them on the ramp.
    let ahead = 40.0 - (0.2 * V + RAMP);
    let found = places(&report);
    assert_eq!(found.len(), 3);
    at(found[1], 40.0);
    for place in [found[0], found[2]] {
        assert!((place - ahead).abs() <= V * T + 1e-6, "{place} {ahead}");
    }
    assert!(report.waits.is_empty());
}

/// Micro Joints lie at places of the path, and are functions there.
#[test]
fn a_micro_joint() {
    let list = "configuration.path_preparation.function FCT_DEFAULT | FCT_M_PRE_OUTPUT\n\
        m_synch[96] MVS_SVS\nm_pre_outp[96] 50000\n";
    let report = run(
        list,
        &format!("M96 ack 0.1\nbackward {}..2.5\n", brakes_for(60.0) + 0.3),
    );
    are(&places(&report), &[35.0, 35.0, 35.0]);
    assert_eq!(report.waits.len(), 2);
}

/// Several ahead keep their order, and path and time to go are those of the point that is turned to.
#[test]
fn several_ahead() {
    let program = "%T\nN10 G01 X20 F6000\nN20 X40 M61\nN30 X60 M62\nN40 X90 M63\nN50 X120\nM30\n";
    let list = "m_h_pre_outp_calc_value_to_go 1\nm_synch[61] MEP_SVS\nm_pre_outp[61] 150000\n\
        m_synch[62] MEP_SVS\nm_pre_outp[62] 150000\nm_synch[63] MEP_SVS\nm_pre_outp[63] 150000\n";
    let script = format!("default ack 0.02\nbackward {}..2.5\n", brakes_for(70.0));
    let report = Bench::new(program, list).script(&script).run();
    assert!(report.completed && report.waits.is_empty());
    let outputs = report.of(EventKind::Output);
    let functions: Vec<&str> = outputs
        .iter()
        .map(|event| event.function.as_deref().unwrap())
        .collect();
    assert_eq!(
        functions,
        ["M61", "M62", "M63", "M63", "M62", "M61", "M61", "M62", "M63"]
    );
    let found: Vec<f64> = outputs.iter().map(|event| x(event)).collect();
    are(&found, &[5.0, 25.0, 45.0, 60.0, 40.0, 20.0, 5.0, 25.0, 45.0]);
    let to_go: Vec<i64> = outputs
        .iter()
        .filter_map(|event| Some(event.to_go?.path))
        .collect();
    assert_eq!(to_go, [150_000; 6]);
}
