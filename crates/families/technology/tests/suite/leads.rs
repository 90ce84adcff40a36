//! MET_MOS keeps its lead: the time between its output and the path at its place [004:87-90].
//!
//! Beside it stands a MOS_TS function, whose time stamp tells when the path was there [004:93].

use std::fmt::Write as _;

use crate::common::{A, Asked, Bench, T, at, x};
use bahn_technology::Report;
use proptest::prelude::*;

/// Channel parameters of M96 with a lead, ms, and of M25 that tells when the path is at its place. The look-ahead is as
/// long as it may be [004:222].
fn list(kind: &str, lead_ms: u32) -> String {
    format!(
        "m_synch[96] {kind}\nm_pre_outp[96] {}\nm_synch[25] MOS_TS\nm_synch[8] MVS_SVS\nm_h_pre_outp_nbr_block 200\n\
         configuration.interpolator.parameter 200\n",
        lead_ms * 1000
    )
}

/// When the path was at the place of M96, s.
fn passes(report: &Report) -> f64 {
    let mark = report.output("M25");
    mark.t - mark.offset_us.unwrap() * 1e-6
}

/// How long before that M96 went out, s.
fn lead(report: &Report) -> f64 {
    passes(report) - report.output("M96").t
}

/// The output comes in the first cycle in which no more than the lead is left.
fn keeps(report: &Report, lead_ms: u32) -> bool {
    let asked = f64::from(lead_ms) / 1000.0;
    let lead = lead(report);
    lead <= asked + 1e-6 && lead >= asked - T - 1e-6
}

fn run(program: &str, lead_ms: u32, script: &str) -> Report {
    Bench::new(program, &list("MET_MOS", lead_ms))
        .script(script)
        .run()
}

/// Blocks of a length, mm, up to X60, the functions there, and 60 mm more.
fn straight(length: f64) -> String {
    let mut program = "%T\nG01 F5000\n".to_owned();
    let count = (60.0 / length).round() as u32;
    for block in 1..=count {
        writeln!(program, "X{:.4}", f64::from(block) * length).unwrap();
    }
    program + "N50 M96 M25\nN55 X120\nM30\n"
}

/// 60 mm at F5000 take 0.76 s.
const LEADS: std::ops::RangeInclusive<u32> = 1..=50;

#[test]
fn every_lead_is_kept_over_long_and_short_blocks() {
    for length in [60.0, 10.0, 1.0, 0.5] {
        let program = straight(length);
        for lead_ms in LEADS.map(|step| 10 * step) {
            let report = run(&program, lead_ms, "");
            assert!(
                keeps(&report, lead_ms),
                "{lead_ms} ms over {length} mm: {}",
                lead(&report)
            );
            assert!(report.warnings.is_empty(), "{:?}", report.warnings);
        }
    }
}

/// The example of the manual: 300 ms at F5000 are 25 mm, from X40 to X15, for the path does not stop at X40 [004:90].
#[test]
fn the_example_of_the_manual() {
    let program = "%T\nN10 G01 X10 G90 F5000\nN20 X20\nN30 X30\nN40 X40\nN50 M96 M25\nN55 X80\nN60 X0\nM30\n";
    let report = run(program, 300, "M96 ack never");
    let place = x(report.output("M96"));
    assert!((15.0..15.0 + 5000.0 / 60.0 * T).contains(&place), "{place}");
    at(x(report.output("M25")), 40.0);
}

/// Before the place the path stops at a corner, slows down for a lower feed and speeds up again.
#[test]
fn every_lead_is_kept_over_corners_and_changes_of_the_feed() {
    let program = "%T\nG01 F5000\nX40\nY10\nF1000 X50\nF6000 X60\nG00 X70\nG01 F3000 X72\nN50 M96 M25\nN55 X80 F500\nM30\n";
    for lead_ms in LEADS.map(|step| 10 * step) {
        let report = run(program, lead_ms, "");
        assert!(keeps(&report, lead_ms), "{lead_ms} ms: {}", lead(&report));
    }
}

/// The path stops at the place for another reason.
#[test]
fn every_lead_is_kept_before_a_stop() {
    for after in [
        "N50 M96 M25 M8\nN55 X80\n",
        "N50 M96 M25\nN55 X60 Y40\n",
        "N50 M96 M25\n",
    ] {
        let program = format!("%T\nG01 F5000\nX60\n{after}M30\n");
        for lead_ms in LEADS.map(|step| 10 * step) {
            let report = run(&program, lead_ms, "M8 ack 0.2");
            assert!(keeps(&report, lead_ms), "{lead_ms} ms {after}: {}", lead(&report));
        }
    }
}

/// A dwell on the path is part of it.
#[test]
fn a_dwell_on_the_path_counts() {
    let program = "%T\nG01 F5000\nX40\nG04 0.25\nX50\nN50 M96 M25\nN55 X80\nM30\n";
    for kind in ["MET_MOS", "MET_SVS"] {
        for lead_ms in [50, 150, 200, 300, 350, 450, 500] {
            let script = "M96 ack 2";
            let report = Bench::new(program, &list(kind, lead_ms)).script(script).run();
            // MET_SVS stands at its place: it is planned so.
            let place = if kind == "MET_SVS" {
                report.wait("M96").0 - report.output("M96").t
            } else {
                lead(&report)
            };
            let asked = f64::from(lead_ms) / 1000.0;
            assert!((place - asked).abs() <= T * 1.001, "{kind} {lead_ms} ms: {place}");
        }
    }
}

/// What the end velocity of 0 takes from a lead is reported: 83.3 mm/s with 1 m/s² are v/2a = 41.7 ms [004:87].
#[test]
fn a_lead_that_is_not_kept_is_reported() {
    let program = straight(10.0);
    let bench = Bench::new(&program, &list("MET_SVS", 300));
    let early = bench.clone().script("M96 ack 0").run();
    let lost = 5000.0 / 60.0 / (2.0 * A);
    assert!((lead(&early) - (0.3 - lost)).abs() <= T, "{}", lead(&early));
    assert_eq!(early.warnings.len(), 1, "{:?}", early.warnings);
    let warning = &early.warnings[0];
    assert_eq!(warning.block, "N50");
    let ms = ((lead(&early)) * 1000.0).round();
    let expected = format!("M96 is output {ms} ms before its place, not 300 ms");
    assert!(warning.message.starts_with(&expected), "{}", warning.message);
    assert!(
        warning.message.contains("end velocity of 0"),
        "{}",
        warning.message
    );
    // With the standstill the lead is what was asked for.
    assert!(bench.script("M96 ack 2").run().warnings.is_empty());

    // The path begins too near.
    let beyond = run(&program, 2000, "");
    assert_eq!(beyond.output("M96").t, 0.0);
    assert_eq!(beyond.warnings.len(), 1);
    assert!(
        beyond.warnings[0].message.contains("begins"),
        "{}",
        beyond.warnings[0].message
    );
    // So it is with a distance.
    let distance = Bench::new(
        &program,
        "m_synch[96] MEP_MOS\nm_pre_outp[96] 990000\nm_synch[25] MOS\n",
    )
    .run();
    let message = &distance.warnings[0].message;
    assert!(
        message.starts_with("M96 is output 60 mm before its place, not 99 mm"),
        "{message}"
    );
}

#[derive(Clone, Debug)]
struct Shape {
    /// Length, mm, direction, degrees, feed, mm/min (0 is rapid traverse).
    blocks: Vec<(f64, f64, u32)>,
    place: usize,
    lead_ms: u32,
    /// When the override changes, ms, and to what, %.
    overrides: Vec<(u32, u32)>,
}

fn shape() -> impl Strategy<Value = Shape> {
    let direction = prop_oneof![Just(0.0), -5.0..5.0f64, -180.0..180.0f64];
    let feed = prop_oneof![Just(0u32), 200u32..9000, Just(5000u32)];
    let block = (prop_oneof![0.05..2.0f64, 2.0..40.0f64], direction, feed);
    let blocks = prop::collection::vec(block, 2..40);
    let overrides = prop::collection::vec((0u32..4000, 20u32..140), 0..4);
    (blocks, any::<prop::sample::Index>(), 10u32..500, overrides).prop_map(
        |(blocks, place, lead_ms, mut overrides)| {
            overrides.sort_unstable();
            Shape {
                place: 1 + place.index(blocks.len() - 1),
                blocks,
                lead_ms,
                overrides,
            }
        },
    )
}

impl Shape {
    fn program(&self) -> String {
        let (mut x, mut y) = (0.0, 0.0);
        let mut program = "%T\n".to_owned();
        for (index, (length, direction, feed)) in self.blocks.iter().enumerate() {
            if index == self.place {
                program += "N50 M96 M25\n";
            }
            let direction = direction.to_radians();
            (x, y) = (x + length * direction.cos(), y + length * direction.sin());
            let word = if *feed == 0 {
                "G00".to_owned()
            } else {
                format!("G01 F{feed}")
            };
            writeln!(program, "{word} X{x:.5} Y{y:.5}").unwrap();
        }
        program + "M30\n"
    }

    fn script(&self) -> String {
        let mut script = String::new();
        for (ms, percent) in &self.overrides {
            writeln!(script, "override {percent} at {:.3}", f64::from(*ms) / 1000.0).unwrap();
        }
        script
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

    /// Output is the time at the place less the lead, within a cycle, unless the path begins too late or somebody turns the
    /// override in between.
    #[test]
    fn the_lead_is_kept_on_any_path(shape in shape()) {
        let report = run(&shape.program(), shape.lead_ms, &shape.script());
        prop_assert!(report.completed, "{:?}", report.error);
        let (output, passed) = (report.output("M96").t, passes(&report));
        let turned = shape.overrides.iter().any(|(ms, _)| {
            let t = f64::from(*ms) / 1000.0;
            t > output - 1.5 * T && t < passed + 1.5 * T
        });
        if output > 0.0 && !turned {
            prop_assert!(keeps(&report, shape.lead_ms), "{} ms: {}", shape.lead_ms, lead(&report));
            prop_assert!(report.warnings.is_empty(), "{:?}", report.warnings);
        } else if output == 0.0 && passed < f64::from(shape.lead_ms) / 1000.0 - 2.0 * T {
            prop_assert!(report.warnings.len() == 1, "{:?}", report.warnings);
        }
    }
}
