//! Functions that are output ahead, and those with a time stamp: rows T13 to T16 of the acceptance.

use crate::common::{A, Asked, Bench, RAPID, T, at, ramp_s, when, x};
use bahn_technology::{EventKind, Report};

const PROGRAM: &str = "%T\nN10 G01 X10 G90 F5000\nN20 X20\nN30 X30\nN40 X40\nN50 M96\nN55 X80\nN60 X0\nM30\n";

/// F5000, mm/s.
const V: f64 = 5000.0 / 60.0;

fn run(kind: &str, lead: u32, script: &str) -> Report {
    let list = format!("m_synch[96] {kind}\nm_pre_outp[96] {lead}\n");
    Bench::new(PROGRAM, &list).script(script).run()
}

/// Time from standstill to a place, at full speed there.
fn time_at(place: f64) -> f64 {
    V / A + (place - V * V / (2.0 * A)) / V
}

#[test]
fn t13_mep_svs_is_output_a_distance_ahead() {
    let in_time = run("MEP_SVS", 250_000, "M96 ack 0.1");
    let output = in_time.output("M96");
    at(x(output), 15.0);
    when(output.t, time_at(15.0));
    assert_eq!(output.block.as_deref(), Some("N50"));
    assert!(in_time.completed && in_time.waits.is_empty());
    assert!(in_time.of(EventKind::Stop).is_empty());

    let late = run("MEP_SVS", 250_000, "M96 ack 2");
    at(x(late.output("M96")), 15.0);
    let (from, to, place) = late.wait("M96");
    at(place, 40.0);
    when(from, ramp_s(40.0, V));
    when(to, late.output("M96").t + 2.0);
    let go = late.of(EventKind::Go)[1];
    assert_eq!((go.t, go.block.as_deref()), (to, Some("N55")));
}

/// Longer than the path that is known: where the path begins.
#[test]
fn t13_a_lead_beyond_the_start_is_output_at_the_start() {
    let report = run("MEP_SVS", 990_000, "");
    at(x(report.output("M96")), 0.0);
    assert_eq!(report.output("M96").t, 0.0);
}

/// The look-ahead of 50 blocks ends it.
#[test]
fn t13_the_look_ahead_is_counted_in_blocks() {
    let blocks: String = (1..=80).map(|x| format!("N{x} X{x}\n")).collect();
    let program = format!("%T\nG01 F5000\n{blocks}N90 M96\nN91 X100\nM30\n");
    let list = "m_synch[96] MEP_SVS\nm_pre_outp[96] 700000\n";
    at(x(Bench::new(&program, list).run().output("M96")), 30.0);
    let more = format!("{list}m_h_pre_outp_nbr_block 75\n");
    at(x(Bench::new(&program, &more).run().output("M96")), 10.0);
}

#[test]
fn t14_met_svs_is_planned_to_a_stop() {
    let lead = 0.3;
    let place = 40.0 - (V * lead - V * V / (2.0 * A));
    for script in ["M96 ack 0.1", "M96 ack 2"] {
        let report = run("MET_SVS", 300_000, script);
        let output = report.output("M96");
        assert!((x(output) - place).abs() <= V * T, "{} is not {place}", x(output));
        when(output.t, time_at(place));
        assert_eq!(report.waits.is_empty(), script == "M96 ack 0.1");
    }
    // From the planned instant on, 0.3 s to the standstill at X40.
    let late = run("MET_SVS", 300_000, "M96 ack 2");
    when(late.wait("M96").0, late.output("M96").t + lead);
    at(late.wait("M96").2, 40.0);
}

/// While the path still accelerates it is the plan that counts: 10 mm from standstill to standstill with a peak of 100 mm/s.
#[test]
fn t14_met_svs_in_an_accelerating_path() {
    let program = "%T\nN10 G00 X10\nN20 M96\nN30 X50\nM30\n";
    let list = "m_synch[96] MET_SVS\nm_pre_outp[96] 150000\n";
    let report = Bench::new(program, list).script("M96 ack 1").run();
    let output = report.output("M96");
    // 0.2 s in all: after 0.05 s it still accelerates.
    when(output.t, ramp_s(10.0, RAPID) - 0.15);
    let place = 0.5 * A * output.t * output.t;
    at(x(output), place);
}

#[test]
fn t15_mep_mos_and_met_mos_are_never_waited_for() {
    let distance = run("MEP_MOS", 250_000, "M96 ack never");
    at(x(distance.output("M96")), 15.0);
    let time = run("MET_MOS", 300_000, "M96 ack never");
    // The path does not stop for it: 0.3 s at 83.33 mm/s are 25 mm.
    let place = x(time.output("M96"));
    assert!((15.0..15.0 + V * T).contains(&place), "{place}");
    for report in [distance, time] {
        assert!(report.completed && report.waits.is_empty());
        assert!(report.of(EventKind::Stop).is_empty());
        assert_eq!(report.of(EventKind::Fetch).len(), 1);
    }
}

/// The earlier one in the program decides when the later ones go out at the earliest; those of one block do not touch
/// each other.
#[test]
fn later_functions_are_not_output_before_earlier_ones() {
    let program = "%T\nN10 G01 X40 F5000\nN20 M96\nN30 X50\nN40 M97\nN50 X60\nN60 M98 M99\nN70 X100\nM30\n";
    let list = "m_synch[96] MEP_SVS\nm_pre_outp[96] 50000\nm_synch[97] MEP_SVS\nm_pre_outp[97] 250000\n\
                m_synch[98] MEP_MOS\nm_pre_outp[98] 10000\nm_synch[99] MEP_MOS\nm_pre_outp[99] 80000\n";
    let report = Bench::new(program, list).run();
    let place = |function: &str| x(report.output(function));
    at(place("M96"), 35.0);
    at(place("M97"), 35.0);
    assert_eq!(report.output("M97").t, report.output("M96").t);
    at(place("M99"), 52.0);
    at(place("M98"), 59.0);
}

/// With P-CHAN-00212 the next place is turned to when the one before is passed.
#[test]
fn one_place_after_the_other() {
    let program = "%T\nN10 G01 X40 F5000\nN20 M96\nN30 X50\nN40 M97\nN50 X90\nM30\n";
    let list = "m_synch[96] MEP_SVS\nm_pre_outp[96] 50000\nm_synch[97] MEP_SVS\nm_pre_outp[97] 250000\n\
                m_h_pre_outp_calc_value_to_go 1\n";
    let report = Bench::new(program, list).run();
    at(x(report.output("M96")), 35.0);
    // In the cycle in which the path is past X40.
    let place = x(report.output("M97"));
    assert!((40.0..=40.0 + V * T).contains(&place), "{place}");
    let held = Bench::new(program, list).script("M96 ack 1").run();
    at(x(held.output("M97")), 40.0);
    assert_eq!(held.output("M97").t, held.wait("M96").1);
}

#[test]
fn what_is_to_go_is_reported() {
    let list = "m_synch[96] MEP_SVS\nm_pre_outp[96] 250000\nm_h_pre_outp_calc_value_to_go 1\n";
    let report = Bench::new(PROGRAM, list).run();
    let to_go = report.output("M96").to_go.unwrap();
    assert_eq!(to_go.path, 250_000);
    let time = (25.0 - V * V / (2.0 * A)) / V + V / A;
    assert!((to_go.time as f64 / 1e6 - time).abs() <= T, "{to_go:?}");
}

/// The path passes X50 in the midst of a cycle.
#[test]
fn t16_mos_ts_tells_how_long_ago_it_was() {
    let program = "%T\nN10 G01 X25 G90 F5000\nN20 X50\nN30 M25\nN40 X100\nN50 X200\nM30\n";
    let report = Bench::new(program, "m_synch[25] MOS_TS").run();
    let output = report.output("M25");
    at(x(output), 50.0);
    let passed = time_at(50.0);
    let cycle = (passed / T).ceil() * T;
    assert!((output.t - cycle).abs() < 1e-9, "{} is not {cycle}", output.t);
    let offset = output.offset_us.unwrap();
    assert!((offset - (cycle - passed) * 1e6).abs() < 0.01, "{offset}");
    assert!((0.0..T * 1e6).contains(&offset));
    assert!((output.v - 5000.0).abs() < 1e-6);
    let of_axis = Bench::new(&program.replace("M25", "X[M25]"), "m_synch[25] MOS_TS").run();
    assert_eq!(of_axis.output("M25").offset_us, None);
    assert_eq!(of_axis.output("M25").target.as_deref(), Some("X"));
    assert_eq!(of_axis.output("M25").t, output.t);
}
