//! Axis enable, feed enable, clamping [000:5326-5434].

use crate::support::bench::*;
use crate::support::*;
use bahn_tnc::RunState;

/// A run over a path, begun in full sequence.
fn running(build: Build) -> Rig {
    let mut rig = build.ready();
    rig.command("mode full");
    rig.command("select 1.H");
    rig.settle();
    rig.start();
    rig.until(5.0, "the run begins", |rig| {
        rig.control.snapshot().run == RunState::Running
    });
    rig
}

fn end(rig: &mut Rig) {
    rig.until(60.0, "the run ends", |rig| rig.control.snapshot().ended);
    rig.settle();
    assert_eq!(rig.messages(), [""; 0]);
}

/// Feed enable withdrawn by M2451 or B520: 0 V at once, without a ramp; given again the program goes on
/// without NC start, to its end [000:5352-5369].
#[test]
fn feed_enable_in_a_program() {
    let by_axis = "       R M2451\n       S M2467\n       LN I151\n       IFT\n       L K+7\n       = B520\n       ELSE\n       L K+6\n       = B520\n       ENDI\n";
    for instructions in ["", by_axis] {
        let mut rig = running(bench(instructions).program("1.H", "L X+150 Y+20 R0 F3000"));
        rig.seconds(1.0);
        let mut voltage = rig.control.observe(&"X.volts".parse().unwrap());
        assert!(voltage > 1.0, "{voltage}");
        rig.event("key NO_FEED press");
        // At most two PLC cycles until the NC knows; then it is 0 V from one step to the next.
        rig.until(0.05, "0 V", |rig| {
            rig.control.observe(&"X.volts".parse().unwrap()) == 0.0
        });
        rig.seconds(0.015);
        assert!(rig.speed('X').abs() < 50.0, "no ramp: {}", rig.speed('X'));
        rig.seconds(1.0);
        voltage = rig.control.observe(&"X.volts".parse().unwrap());
        assert_eq!(voltage, 0.0);
        assert!(!rig.axis('X').enabled && rig.axis('X').closed, "letter F inverse");
        assert_eq!(
            rig.control.snapshot().run,
            RunState::Running,
            "no message, no stop"
        );
        rig.event("key NO_FEED release");
        end(&mut rig);
        close(rig.table('X'), 150.0, 0.01);
        close(rig.table('Y'), 20.0, 0.01);
    }
}

/// By hand: the axis stands; with the enable and the key held it goes on.
#[test]
fn feed_enable_by_hand() {
    let mut rig = bench("").ready();
    rig.event("key X- press");
    rig.seconds(0.4);
    rig.event("key NO_FEED press");
    rig.seconds(0.2);
    let stands = rig.table('X');
    rig.seconds(0.3);
    close(rig.table('X'), stands, 0.001);
    rig.event("key NO_FEED release");
    rig.seconds(0.4);
    close(rig.speed('X'), -1200.0, 5.0);
    assert_eq!(rig.messages(), [""; 0]);
}

/// B520 gives one axis only [000:5358-5369].
#[test]
fn feed_enable_of_one_axis() {
    let mut rig = bench("       LN I30\n       IFT\n       R M2451\n       S M2467\n       L K+2\n       = B520\n       ENDI\n").rig();
    rig.input("I30", true);
    rig.power_on();
    rig.input("I30", false);
    rig.scan();
    rig.event("key X- press");
    rig.event("key Y- press");
    rig.seconds(0.4);
    close(rig.speed('X'), 0.0, 1.0);
    close(rig.speed('Y'), -1200.0, 5.0);
}

/// A standing axis without feed enable is held in its loop.
#[test]
fn a_standing_axis_is_held() {
    let mut rig = bench("").plant("[axis.X]", "[axis.X]\nweight = 0.01").ready();
    rig.settle();
    rig.event("key NO_FEED press");
    rig.settle();
    let stood = rig.table('X');
    rig.seconds(3.0);
    close(rig.table('X'), stood, 0.001);
}

/// The rotary table C is clamped by the PLC after it was positioned: M2495 makes the NC wait until M2547
/// opens the loop (here 0.2 s later); when a block wants C again, M2011 falls, the PLC unclamps and closes
/// the loop, and C moves [000:5407].
const CLAMP: &str = "
       LN I151
       = M2451
       =N M2467
       L M2180
       S M2495
       L M2011        ; in position: clamp, 10 scans later open the loop
       AN M2547
       AN M60
       AN M61
       = T0
       L M2011
       AN M2547
       S M61
       L M61
       AN T48
       AN T0
       A M2011
       S M2547
       LN M2011       ; wanted again: unclamp
       R M2547
       R M61
";

fn table() -> Build {
    bench(CLAMP)
        .with(TABLE)
        .mps("10=15 50=15 810.3=360 960.3=-90 1010.3=3600 1020.3=1200 1330.3=1800 1340.0=1 1340.1=2 1340.2=3 1340.3=4 4110.0=10 1510.3=2")
}

#[test]
fn a_clamped_axis_in_a_program() {
    let mut rig = running(table().program(
        "1.H",
        "L C+30 R0 F1000\nL X+120 F3000\nL C+60 F1000\nL X+110 F3000",
    ));
    let edges = rig.edges(20.0, &["M2011", "M2547", "M2003", "M2131", "M2128"]);
    assert_eq!(
        rig.control.snapshot().run,
        RunState::Idle,
        "{edges:?} {:?}",
        rig.messages()
    );
    assert_eq!(rig.messages(), [""; 0]);
    let once = [
        // The block wants C: M2011 falls, the PLC closes the loop, M2003 comes, C moves.
        "M2011=0", "M2547=0", "M2003=1", "M2131=1", "M2131=0", "M2011=1",
        // In position; the PLC clamps; the loop opens.
        "M2547=1", "M2003=0", // The next block moves X.
        "M2128=1", "M2128=0",
    ];
    let expected: Vec<&str> = once.into_iter().chain(once).collect();
    assert_eq!(edges, expected);
    close(rig.table('C').rem_euclid(360.0), 60.0, 0.01);
}

/// The NC waits for the loop to be opened as long as the PLC takes.
#[test]
fn the_next_block_waits_for_the_clamp() {
    let mut rig = running(
        bench("       L I30\n       = M2492\n       L I29\n       = M2544\n")
            .program("1.H", "L X+120 R0 F3000\nL Y+80"),
    );
    rig.input("I30", true);
    rig.until(5.0, "X is there", |rig| rig.table('X') > 119.99);
    rig.seconds(2.0);
    assert!(rig.bit("M2008"));
    close(rig.speed('Y'), 0.0, 0.1);
    assert!((rig.table('Y') - 80.0).abs() > 1.0);
    rig.input("I29", true);
    rig.seconds(0.1);
    assert!(!rig.bit("M2000"), "open loop");
    end(&mut rig);
    close(rig.table('Y'), 80.0, 0.01);
}

/// M2008 falls when the axis starts and rises when it is inside MP1030; M2128 is up while it is commanded to
/// move. Blocks that run through at constant feed do not raise M2008 between them [000:5371-5397].
#[test]
fn in_position_and_in_motion() {
    let mut rig = running(bench("").program("1.H", "L X+120 R0 F3000\nL X+130\nL X+140"));
    let edges = rig.edges(5.0, &["M2008", "M2128"]);
    assert_eq!(edges, ["M2008=0", "M2128=1", "M2128=0", "M2008=1"]);
}

/// An axis that was clamped and did not move goes back to its nominal position when its loop closes.
#[test]
fn opening_a_loop_by_hand() {
    let mut rig = bench("       L I30\n       = M2544\n").ready();
    rig.settle();
    let stood = rig.table('X');
    rig.input("I30", true);
    rig.seconds(0.1);
    assert!(!rig.bit("M2000") && rig.bit("M2001"));
    rig.event("key X- press");
    rig.seconds(0.5);
    close(rig.table('X'), stood, 0.001);
    rig.event("key X- release");
    rig.input("I30", false);
    rig.seconds(0.1);
    assert!(rig.bit("M2000"));
    assert_eq!(rig.messages(), [""; 0]);
    close(rig.table('X'), stood, 0.001);
}
