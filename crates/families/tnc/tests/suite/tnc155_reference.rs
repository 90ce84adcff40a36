//! The reference run of a TNC 151/155: a mark counts under the closed end cam where the pulse is not inhibited
//! [001:951-995].

use crate::support::bench::{TABLE, close};
use crate::support::knee::*;
use crate::support::*;
use bahn_tnc::Mode;

/// Only X is there: its machine parameters, plant keys beside it, encoder and start.
fn only_x(keys: &str, marks: &str, start: f64) -> Build {
    knee("")
        .mps("72=14")
        .plant(
            "start = 50\nreference_cam = { range = [140, 200], input = \"I0\" }",
            &format!("start = {start}\nreference_cam = {{ range = [140, 200], input = \"I0\" }}\n{keys}"),
        )
        .plant(
            "input = \"X1\"\nperiod_um = 20\nmark = 150",
            &format!("input = \"X1\"\nperiod_um = 20\n{marks}"),
        )
}

/// From 50 mm up; a mark that lies at 100 mm, before the cam, is passed over, that at 150 mm under the closed cam counts
/// [001:957] [001:967-969]. At 3 m/min with 0.5 m/s² the axis stands 50² / 1000 = 2.5 mm and a lag after it.
#[test]
fn the_mark_lies_under_the_closed_cam() {
    let mut rig = asked(only_x("", "marks_every = 50\nmarks_from = 100", 50.0));
    let [least, most] = rig.way_to_mark();
    close(least, 50.0, 0.01);
    assert!((150.0..155.0).contains(&most), "{most}");
    close(rig.machine_position('X'), rig.table('X') - 150.0, 0.001);
}

/// All three axes one after the other, as MP59 = 12 says: Z, X, Y.
#[test]
fn axes_follow_in_the_order_of_mp59() {
    let mut rig = asked(knee("").mps("59=12"));
    rig.start();
    let edges = rig.edges(10.0, &["M2136", "M2137", "M2138"]);
    assert_eq!(edges, ["M2138=0", "M2136=0", "M2137=0"]);
    for letter in ['X', 'Y', 'Z'] {
        close(rig.machine_position(letter), rig.table(letter) - 150.0, 0.001);
    }
}

/// A rotary encoder on a screw of 10 mm gives a pulse in each turn: 145, 155, 165 mm. The inhibit cam opens 5 mm before
/// the pulse that is wanted and closes 5 mm after it [001:967-969]: it is that at 155 mm, not the first under the cam.
#[test]
fn the_pulse_of_a_rotary_encoder_is_chosen_by_the_inhibit_cam() {
    let inhibit = "pulse_inhibit = { open = [150, 160], input = \"I4\" }";
    let marks = "marks_every = 10\nmarks_from = 5";
    let mut rig = asked(only_x(inhibit, marks, 50.0));
    // Closed where X stands; nothing is wired for Y, Z and IV.
    let inhibited = ["M2616", "M2617", "M2618", "M2619"].map(|marker| rig.bit(marker));
    assert_eq!(inhibited, [true, false, false, false]);
    let [_, most] = rig.way_to_mark();
    assert!((155.0..160.0).contains(&most), "{most}");
    close(rig.machine_position('X'), rig.table('X') - 155.0, 0.001);
}

/// Negative direction with MP16 = 1: the cam of the other end.
#[test]
fn the_direction_is_that_of_mp16() {
    let build = only_x("", "marks_every = 50\nmarks_from = 0", 120.0)
        .mps("16=1")
        .plant(
            "range = [140, 200], input = \"I0\"",
            "range = [0, 60], input = \"I0\"",
        );
    let mut rig = asked(build);
    let [least, most] = rig.way_to_mark();
    close(most, 120.0, 0.01);
    assert!((45.0..50.0).contains(&least), "{least}");
    close(rig.machine_position('X'), rig.table('X') - 50.0, 0.001);
}

/// Several marks under the cam and no inhibit cam, the axis stands on the cam at 163 mm. With MP69 = 0 the first mark on
/// the way counts, that at 170 mm: another position than yesterday's. With MP69 = 1 the axis is first backed off the cam,
/// and the first mark after the cam has closed counts, that at 150 mm [001:989-995].
#[test]
fn mp69_backs_an_axis_off_its_cam_first() {
    let marks = "marks_every = 10\nmarks_from = 0";
    let mut rig = asked(only_x("", marks, 163.0));
    let [least, _] = rig.way_to_mark();
    close(least, 163.0, 0.01);
    close(rig.machine_position('X'), rig.table('X') - 170.0, 0.001);
    // The cam closes at 140.5 mm, so that no mark is at its edge.
    let build = only_x("", marks, 163.0).mps("69=1").plant(
        "range = [140, 200], input = \"I0\"",
        "range = [140.5, 200], input = \"I0\"",
    );
    let mut rig = asked(build);
    let [least, most] = rig.way_to_mark();
    assert!((130.0..140.5).contains(&least), "{least}");
    assert!((163.0..163.1).contains(&most), "{most}");
    close(rig.machine_position('X'), rig.table('X') - 150.0, 0.001);
}

/// All axes on their cams are backed off before the first one approaches its reference point [001:993-995].
#[test]
fn all_axes_are_backed_off_before_the_first_approach() {
    let mut rig = asked(knee("").mps("69=1").plant("start = 50", "start = 145"));
    rig.start();
    let edges = rig.edges(15.0, &["M2556", "M2557", "M2558", "M2136", "M2137", "M2138"]);
    assert_eq!(
        edges,
        [
            "M2556=0", "M2557=0", "M2558=0", "M2556=1", "M2136=0", "M2557=1", "M2137=0", "M2558=1", "M2138=0"
        ]
    );
}

/// The cam of a rotary table is a permanent bridge to +24 V: its first mark counts, and MP69 has no cam to leave
/// [001:957].
#[test]
fn the_cam_of_a_rotary_table_is_bridged() {
    let mut rig = asked(knee("").with(TABLE).mps("72=7 69=1 90=2"));
    rig.input("I3", true);
    rig.scan();
    reference(&mut rig);
    close(rig.machine_position('C'), rig.table('C') - 90.0, 0.001);
}

/// Coded marks count while the contact is open: 20 mm at most [001:977-987].
#[test]
fn coded_marks_count_beside_the_open_cam() {
    let build = only_x("", "marks_coded = 20", 50.0).mps("242=1000");
    let mut rig = asked(build);
    let [least, most] = rig.way_to_mark();
    close(least, 50.0, 0.01);
    assert!(most < 50.0 + 20.0 + 5.0, "{most}");
    // With the contact closed no mark counts.
    let build = only_x("", "marks_coded = 20", 50.0).mps("242=1000");
    let mut rig = asked(build.plant(
        "range = [140, 200], input = \"I0\"",
        "range = [0, 120], input = \"I0\"",
    ));
    rig.start();
    rig.seconds(1.0);
    assert!(!rig.axis('X').referenced);
}

/// IV is inhibited (MP72 = 8) and shown (MP76 = 1): its prompt and its counter as MP75 says [001:3266].
fn inhibited(mp75: u8) -> Rig {
    let mut rig = knee("").with(TABLE).mps(&format!("72=8 76=1 90=2 75={mp75}"));
    rig.plc = rig.plc.replace("       L     I3\n", "       L     I30\n");
    let mut rig = asked(rig);
    // Its cam is bridged [001:957].
    rig.input("I30", true);
    rig.scan();
    rig
}

fn asked_for(rig: &Rig) -> String {
    let axes = rig.control.snapshot().axes;
    axes.iter()
        .filter(|axis| axis.mark_wanted)
        .map(|axis| axis.letter)
        .collect()
}

/// MP75 = 0: the prompt does not name the inhibited axis, and the run ends without it; its display stands until its
/// mark was passed.
#[test]
fn an_inhibited_axis_is_not_asked_for() {
    let mut rig = inhibited(0);
    assert_eq!(asked_for(&rig), "XYZ");
    reference(&mut rig);
    // The operator turns it by hand.
    rig.event("force C 20");
    rig.until(10.0, "it turns", |rig| rig.table('C') > 30.0);
    close(rig.machine_position('C'), 0.0, 0.001);
    rig.until(60.0, "its mark passes", |rig| rig.axis('C').referenced);
    close(rig.machine_position('C'), rig.table('C') - 90.0, 0.02);
}

/// MP75 = 1: the prompt names it, too, and stays until the operator has led it over its mark.
#[test]
fn an_inhibited_axis_is_asked_for() {
    let mut rig = inhibited(1);
    assert_eq!(asked_for(&rig), "XYZC");
    rig.start();
    rig.seconds(10.0);
    assert_eq!(asked_for(&rig), "C");
    assert_eq!(rig.control.snapshot().mode, Mode::Reference);
    rig.event("force C 20");
    rig.until(60.0, "the run is over", |rig| {
        rig.control.snapshot().mode == Mode::Manual
    });
    assert_eq!(asked_for(&rig), "");
}

/// MP75 = 2: neither asked for nor needed: the position is 0 at power-on and counts at once.
#[test]
fn an_inhibited_axis_counts_at_once() {
    let mut rig = inhibited(2);
    assert_eq!(asked_for(&rig), "XYZ");
    assert!(rig.axis('C').referenced);
    let before = rig.table('C');
    close(rig.machine_position('C'), before - 10.0, 0.001);
    rig.event("force C 20");
    rig.until(10.0, "it turns", |rig| rig.table('C') > 30.0);
    close(rig.machine_position('C'), rig.table('C') - 10.0, 0.05);
}

/// Direction buttons do nothing in the reference run until code number 84 159 was entered; then they lead the axis over its
/// mark, in their direction [001:955].
#[test]
fn direction_buttons_pass_the_mark_after_the_code() {
    let mut rig = asked(only_x("", "marks_every = 50\nmarks_from = 0", 180.0));
    rig.event("key X- press");
    rig.seconds(1.0);
    close(rig.table('X'), 180.0, 0.01);
    rig.event("key X- release");
    rig.command("code 84159");
    rig.event("key X- press");
    rig.until(5.0, "the mark", |rig| rig.axis('X').referenced);
    rig.event("key X- release");
    rig.settle();
    assert!((140.0..150.0).contains(&rig.table('X')), "{}", rig.table('X'));
    close(rig.machine_position('X'), rig.table('X') - 150.0, 0.001);
    assert_eq!(rig.control.snapshot().mode, Mode::Manual);
}
