//! Functions that are output and waited for at block limits: rows T1 to T12 of the acceptance.

use crate::common::{A, Asked, Bench, RAPID, T, at, ramp_s, when, x};
use bahn_technology::EventKind;

const PROGRAM: &str = "%T\nN20 G00 X25\nN30 X50\nN40 X75 M25\nN50 G01 X100 F2000\nN60 X125 Z100\nM30\n";

/// F2000, mm/s.
const F2000: f64 = 2000.0 / 60.0;

#[test]
fn t01_mvs_svs_stands_before_its_block() {
    let report = Bench::new(PROGRAM, "m_synch[25] MVS_SVS")
        .script("M25 ack 0.5")
        .run();
    assert!(report.completed, "{:?}", report.error);
    let arrival = ramp_s(50.0, RAPID);
    let output = report.output("M25");
    at(x(output), 50.0);
    when(output.t, arrival);
    assert_eq!(output.block.as_deref(), Some("N40"));
    let stops = report.of(EventKind::Stop);
    assert_eq!(stops.len(), 1, "{stops:?}");
    at(x(stops[0]), 50.0);
    when(stops[0].t, arrival);
    let (from, to, place) = report.wait("M25");
    at(place, 50.0);
    when(from, arrival);
    when(to, output.t + 0.5);
    let goes = report.of(EventKind::Go);
    assert_eq!(goes.len(), 2);
    assert_eq!((goes[0].t, goes[0].block.as_deref()), (0.0, Some("N20")));
    when(goes[1].t, output.t + 0.5);
    at(x(goes[1]), 50.0);
    // 25 mm rapid into 33.3 mm/s without a stop at X75, then to the corner at X100.
    let v = (A * 25.0 + F2000 * F2000 / 2.0).sqrt().min(RAPID);
    let rapid = v / A + (v - F2000) / A + (25.0 - v * v / A + F2000 * F2000 / (2.0 * A)) / v;
    let feed = 25.0 / F2000 + F2000 / (2.0 * A);
    let last = ramp_s(25.0f64.hypot(100.0), F2000);
    when(report.time_s, goes[1].t + rapid + feed + last);
}

#[test]
fn t02_mvs_sns_late_stands_after_its_block() {
    let report = Bench::new(PROGRAM, "m_synch[25] MVS_SNS")
        .script("M25 ack 2")
        .run();
    let output = report.output("M25");
    at(x(output), 50.0);
    assert!(output.v > 1000.0, "it moves: {}", output.v);
    let (from, to, place) = report.wait("M25");
    at(place, 75.0);
    when(from, ramp_s(75.0, RAPID));
    when(to, output.t + 2.0);
    assert_eq!(report.of(EventKind::Stop).len(), 1);
    at(x(report.of(EventKind::Stop)[0]), 75.0);
    assert_eq!(report.of(EventKind::Go)[1].t, to);
}

#[test]
fn t03_mvs_sns_early_does_not_stand() {
    let report = Bench::new(PROGRAM, "m_synch[25] MVS_SNS")
        .script("M25 ack 0")
        .run();
    at(x(report.output("M25")), 50.0);
    assert!(report.of(EventKind::Stop).is_empty());
    assert!(report.waits.is_empty());
    // As without any function.
    let without = Bench::new(PROGRAM, "m_synch[25] MOS").run();
    assert_eq!(report.time_s, without.time_s);
}

#[test]
fn t04_mns_sns_stands_in_any_case() {
    let report = Bench::new(PROGRAM, "m_synch[25] MNS_SNS")
        .script("M25 ack 0")
        .run();
    let output = report.output("M25");
    at(x(output), 75.0);
    when(output.t, ramp_s(75.0, RAPID));
    let (from, to, place) = report.wait("M25");
    at(place, 75.0);
    assert_eq!(from, output.t);
    when(to, from + T);
    let late = Bench::new(PROGRAM, "m_synch[25] MNS_SNS")
        .script("M25 ack 0.3")
        .run();
    when(late.wait("M25").1, output.t + 0.3);
}

#[test]
fn t05_mos_and_no_synch_do_not_wait() {
    let mos = Bench::new(PROGRAM, "m_synch[25] MOS")
        .script("M25 ack never")
        .run();
    assert!(mos.completed);
    at(x(mos.output("M25")), 50.0);
    assert!(mos.waits.is_empty() && mos.of(EventKind::Stop).is_empty());
    assert_eq!(mos.of(EventKind::Fetch).len(), 1);
    let none = Bench::new(PROGRAM, "m_synch[25] NO_SYNCH").run();
    assert!(none.completed && none.of(EventKind::Output).is_empty());
    assert_eq!(none.time_s, mos.time_s);
}

#[test]
fn t06_without_a_motion_all_types_are_one() {
    let program = "%T\nN10 G01 X20 F2000\nN20 M25\nN30 X40\nM30\n";
    let run = |kind: &str| {
        let list = format!("m_synch[25] {kind}");
        Bench::new(program, &list).script("M25 ack 0.2").run()
    };
    let [svs, sns, mns] = ["MVS_SVS", "MVS_SNS", "MNS_SNS"].map(run);
    assert_eq!(svs.events, sns.events);
    assert_eq!(svs.events, mns.events);
    assert_eq!(svs.waits, mns.waits);
    at(x(svs.output("M25")), 20.0);
    when(svs.output("M25").t, ramp_s(20.0, F2000));
    when(svs.wait("M25").1, svs.output("M25").t + 0.2);
    when(svs.time_s, svs.wait("M25").1 + ramp_s(20.0, F2000));
}

/// So functions go out in the order of the block: MNS_SNS waits for no motion that is not there, nor for one of no length.
#[test]
fn t06_functions_without_a_motion_keep_their_order() {
    for kind in ["MVS_SVS", "MVS_SNS", "MNS_SNS"] {
        for block in ["N20 M25 M26", "N20 M25 X20 M26"] {
            let program = format!("%T\nN10 G01 X20 F2000\n{block}\nN30 X40\nM30\n");
            let list = format!("m_synch[25] {kind}\nm_synch[26] MOS\nh_synch[7] {kind}\n");
            let report = Bench::new(&program, &list).script("M25 ack 0.2").run();
            assert_eq!(report.order(), ["channel:M25", "channel:M26"], "{kind} {block}");
            at(report.wait("M25").2, 20.0);
            let turned = program.replace("M26", "H7");
            let turned = turned.replace("M25", "M26").replace("H7", "M25");
            let report = Bench::new(&turned, &list).script("M25 ack 0.2").run();
            assert_eq!(report.order(), ["channel:M26", "channel:M25"], "{kind} {block}");
        }
    }
}

const LATE: &str =
    "%T\nN05 M24\nN10 M25 G00 X25\nN20 X50\nN30 X75\nN40 X100\nN50 G01 X125 F2000\nN60 Z100\nM30\n";

#[test]
fn t08_mvs_slm_waits_before_the_first_feed() {
    let list = "m_synch[24] 0x4000\nm_synch[25] 0x4000\n";
    for (first, second) in [(2.0, 3.0), (3.0, 2.0)] {
        let script = format!("M24 ack {first}\nM25 ack {second}\n");
        let report = Bench::new(LATE, list).script(&script).run();
        assert!(report.completed);
        for function in ["M24", "M25"] {
            at(x(report.output(function)), 0.0);
            assert_eq!(report.output(function).t, 0.0);
        }
        let arrival = ramp_s(100.0, RAPID);
        for (function, ack) in [("M24", first), ("M25", second)] {
            let (from, to, place) = report.wait(function);
            at(place, 100.0);
            when(from, arrival);
            when(to, ack);
        }
        let stops = report.of(EventKind::Stop);
        assert_eq!(stops.len(), 1);
        when(report.of(EventKind::Go)[1].t, 3.0);
    }
}

#[test]
fn t09_mvs_slm_in_a_feed_block_is_mvs_svs() {
    let program = "%T\nN10 G01 F100 M24 X10\nM30\n";
    let [late, plain] = ["MVS_SLM", "MVS_SVS"].map(|kind| {
        let list = format!("m_synch[24] {kind}");
        Bench::new(program, &list).script("M24 ack 0.4").run()
    });
    assert_eq!(late.events, plain.events);
    assert_eq!(late.waits, plain.waits);
    when(late.wait("M24").1, 0.4);
}

#[test]
fn t10_mvs_slp_waits_where_the_program_wants_it() {
    let program = "%T\nN05 M26 G00 X25\nN10 M27\nN20 X50\nN30 X75\nN40 X100\nN50 G01 X125 F2000\nN60 #EXPL SYN\nN70 G00 X0\nN80 X0 Y0\nM30\n";
    let list = "m_synch[26] 0x8000\nm_synch[27] 0x8000\n";
    let report = Bench::new(program, list).script("M26 ack 4\nM27 at 3.0\n").run();
    assert!(report.completed);
    at(x(report.output("M26")), 0.0);
    at(x(report.output("M27")), 25.0);
    let stops = report.of(EventKind::Stop);
    assert_eq!(stops.len(), 1);
    at(x(stops[0]), 125.0);
    when(report.wait("M26").1, 4.0);
    when(report.wait("M27").1, 3.0);
    at(report.wait("M27").2, 125.0);
}

const FIRST: &str = "%PRG1\nN05 M26 G00 X25\nN10 M27\nM30\n";
const SECOND: &str = "%PRG2\nN10 G01 F100 X10\nN20 #EXPL SYN\nN30 X5\nM30\n";

#[test]
fn t11_late_functions_live_over_programs() {
    let list = "m_synch[26] MVS_SLM\nm_synch[27] MVS_SLP\n";
    let script = "M26 at 3.0\nM27 at 20.0\n";
    let report = Bench::new(FIRST, list).and(SECOND).script(script).run();
    assert!(report.completed);
    let end = ramp_s(25.0, RAPID);
    when(report.programs[0].time_s, end);
    let (from, to, place) = report.wait("M26");
    at(place, 25.0);
    when(from, end);
    when(to, 3.0);
    let (from, to, place) = report.wait("M27");
    at(place, 10.0);
    when(from, 3.0 + ramp_s(15.0, 100.0 / 60.0));
    when(to, 20.0);
}

#[test]
fn t12_late_sync_ready_waits_at_the_end_of_the_program() {
    let list = "m_synch[26] MVS_SLM\nm_synch[27] MVS_SLP\nprog_start.late_sync_ready 1\n";
    let script = "M26 at 3.0\nM27 at 4.0\n";
    let report = Bench::new(FIRST, list).and(SECOND).script(script).run();
    assert!(report.completed);
    when(report.programs[0].time_s, 4.0);
    when(report.wait("M26").1, 3.0);
    when(report.wait("M27").1, 4.0);
    at(report.wait("M27").2, 25.0);
}
