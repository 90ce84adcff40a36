//! M functions: strobe and acknowledgement, begin and end of block, stops [000:7076-7306].

use crate::stand::*;
use crate::support::*;
use bahn_tnc::RunState;

/// The pattern of the manual with the M function by a CASE, M03 acknowledged when the spindle has its speed
/// [000:7208-7247]; M04 is left without answer.
const PATTERN: &str = "
       L     M2045
       RN    M2482
       CMT   M_STROBE
       L     M2043
       = M2480
       L     M2046
       = M2483
       EM
LBL M_STROBE
       CASE  W260
         CM  M_DONE
         CM  M_DONE
         CM  M_DONE
         CM  M_03
         CM  M_04
         CM  M_05
       ENDC
       EM
LBL M_DONE
       L     M2719
       S     M2482
       EM
LBL M_03
       L     M2719
       S     M2485
       R     M2486
       R     M2487
       S     O10
       L     I12
       S     M2482
       EM
LBL M_04
       EM
LBL M_05
       L     M2719
       S     M2487
       R     M2485
       R     M2486
       S     M2482
";

/// Code with its strobe, speed reached, acknowledgement, strobe back, acknowledgement back; X waits for it.
#[test]
fn edges_of_m03() {
    let mut rig = bench_with(PATTERN, "TOOL CALL 0 Z S3000\nM3\nL X+60 R0 F6000");
    rig.start();
    rig.until(2.0, "M03 is output", |rig| rig.bit("M2045"));
    assert_eq!(rig.number("W260"), 3);
    let x = nominal(&rig, 'X');
    assert_eq!(
        edges(&mut rig, "I12 M2485 M2045 M2482 M2128", 0.6),
        // 3000 rpm are 4.5 V, on the ramp of 0.01 V/ms: 0.45 s.
        "I12+ M2482+ M2045- M2482- M2128+ M2128-",
    );
    near(x, 50.0);
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 60.0);
}

/// A missing acknowledgement waits for ever and says for what; NC stop and internal stop get out; the next
/// start executes the block again.
#[test]
fn missing_acknowledgement() {
    let mut rig = bench_with(PATTERN, "L X+60 R0 F6000 M4\nL X+70");
    rig.start();
    rig.seconds(10.0);
    assert_eq!(rig.control.snapshot().run, RunState::Running);
    let waiting = rig.control.snapshot().waiting.unwrap().to_string();
    assert_eq!(waiting, "strobe M2045: the PLC must set M2482");
    near(display(&rig, 'X'), 50.0);
    assert!(
        !rig.control.command("stop".parse().unwrap()),
        "only after an external stop"
    );
    rig.command("ce");
    rig.event("key NC_STOP tap");
    rig.seconds(0.3);
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    assert!(rig.bit("M2045") && rig.bit("M2183") && rig.bit("M2184"));
    rig.command("stop");
    rig.seconds(0.1);
    assert!(!rig.bit("M2045") && !rig.bit("M2184"));
    assert_eq!(rig.control.snapshot().waiting, None);
    rig.start();
    rig.until(1.0, "the strobe again", |rig| rig.bit("M2045"));
    assert_eq!(rig.number("W260"), 4);
}

/// NC stop while M08 waits, and START: the acknowledgement counts all the same, and the block goes on.
#[test]
fn stop_while_an_acknowledgement_is_missing() {
    let mut rig = bench_with(
        "       L     M2045\n       A     I20\n       = M2482",
        "L X+60 R0 F6000 M8",
    );
    rig.start();
    rig.seconds(0.5);
    rig.event("key NC_STOP tap");
    rig.seconds(0.5);
    rig.event("key A press");
    rig.seconds(0.5);
    near(display(&rig, 'X'), 50.0);
    assert!(!rig.bit("M2045"));
    rig.start();
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 60.0);
}

/// An acknowledgement that stays set blocks the next strobe, not the movement after the first
/// [000:11750-11752].
#[test]
fn acknowledgement_left_set() {
    let plc = "
       L     M2045
       O     I20
       = M2482
";
    let mut rig = bench_with(plc, "M7\nL X+52 R0 F6000\nM8\nL X+54");
    rig.event("key A press");
    rig.start();
    rig.seconds(1.0);
    assert_eq!(
        rig.control.snapshot().waiting.unwrap().to_string(),
        "next strobe M2045: the PLC must reset M2482"
    );
    rig.event("key A release");
    rig.seconds(0.06);
    rig.event("key A press");
    rig.seconds(1.0);
    near(display(&rig, 'X'), 52.0);
    assert_eq!(rig.number("W260"), 7, "M8 waits");
    rig.event("key A release");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 54.0);
}

/// Decoded M functions with M2496: M1909 comes and goes with the strobe.
#[test]
fn decoded_functions() {
    let plc = format!("       L     M2719\n       S     M2496\n{ACKNOWLEDGE}");
    let mut rig = bench_with(&plc, "M9");
    rig.start();
    assert_eq!(
        edges(&mut rig, "W260 M1909 M2045 M2482", 1.0),
        "W260=9 M1909+ M2045+ M2482+ M1909- M2045- M2482-"
    );
}

/// M08 acts before the movement of its block, M09 after it; several in one block go out one after another in
/// the order of the block.
#[test]
fn begin_and_end_of_block() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+52 R0 F600 M8\nL X+54 M9\nM7 M24");
    rig.start();
    let mut codes = Vec::new();
    let mut before = false;
    for _ in 0..1000 {
        rig.cycle();
        let strobe = rig.bit("M2045");
        if strobe && !before {
            codes.push((rig.number("W260"), nominal(&rig, 'X').round()));
        }
        before = strobe;
    }
    assert_eq!(codes, [(8, 50.0), (9, 54.0), (7, 54.0), (24, 54.0)]);
}

/// MP7440 bit 2: the axes do not wait for the acknowledgement.
#[test]
fn without_waiting() {
    let mut rig = ready(
        bench("")
            .mp("7440=%00111")
            .program("1.H", "L X+60 R0 F6000 M8\nL X+70"),
    );
    rig.start();
    rig.seconds(2.0);
    near(display(&rig, 'X'), 70.0);
    let waiting = rig.control.snapshot().waiting.unwrap().to_string();
    assert_eq!(waiting, "strobe M2045: the PLC must set M2482");
    assert!(!rig.control.snapshot().ended, "the end waits");
}

/// M0, STOP and, with MP7440 bit 0 = 0, M6 stop the run at the end of the block; NC start goes on.
#[test]
fn programmed_stops() {
    for stop in ["M0", "STOP", "STOP M8", "M6"] {
        let program = format!("L X+60 R0 F6000\n{stop}\nL X+70");
        let mut rig = ready(bench(ACKNOWLEDGE).mp("7440=%00010").program("1.H", &program));
        rig.start();
        rig.seconds(1.5);
        assert_eq!(rig.control.snapshot().run, RunState::Stopped, "{stop}");
        near(display(&rig, 'X'), 60.0);
        assert!(!rig.bit("M2061"));
        rig.start();
        rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
        near(display(&rig, 'X'), 70.0);
    }
    let mut rig = ready(
        bench(ACKNOWLEDGE)
            .mp("7440=%00011")
            .program("1.H", "M6\nL X+70 R0 F6000"),
    );
    run(&mut rig, 3.0);
    near(display(&rig, 'X'), 70.0);
}

/// M2, M30 and END PGM end the run: M2061 until the next start, which begins at the first block again.
#[test]
fn ends_of_the_program() {
    for (end, code) in [("M2", 2), ("M30", 30), ("L IX+1", 0)] {
        let program = format!("L IX+5 R0 F6000\n{end}");
        let mut rig = bench_with(ACKNOWLEDGE, &program);
        run(&mut rig, 3.0);
        rig.seconds(0.1);
        assert!(rig.bit("M2061"), "{end}");
        assert_eq!(rig.number("W260"), code);
        rig.start();
        rig.until(1.0, "M2061 is reset", |rig| !rig.bit("M2061"));
        rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
        let once = if code == 0 { 6.0 } else { 5.0 };
        near(display(&rig, 'X'), 50.0 + 2.0 * once);
    }
}

/// M91 is the machine datum, M92 the one of MP950, whatever the workpiece datum.
#[test]
fn machine_datums() {
    let mut rig = bench_with(ACKNOWLEDGE, "L X+20 R0 F15000 M91\nL Y-5 M92");
    rig.command("mode manual");
    rig.command("datum X 7");
    rig.command("datum Y 9");
    rig.command("mode full");
    run(&mut rig, 5.0);
    near(rig.machine_position('X'), 20.0);
    near(rig.machine_position('Y'), 400.0 - 5.0);
}

/// M105 takes kv from MP1815 in operation with lag, M106 from MP1810; without MP7440 bit 3 their blocks are refused.
/// Lag = v / kv: 6000 mm/min at kv 1 is 6 mm, at kv 4 1.5 mm.
#[test]
fn second_set_of_kv() {
    let started = |mp7440: &str| {
        let mut rig = ready(
            bench(ACKNOWLEDGE)
                .mp("1390=1")
                .mp("1810.0=1")
                .mp("1815.0=4")
                .mp("1710.0=50")
                .mp("1720.0=60")
                .mp(mp7440)
                .program("1.H", "L X+150 R0 F6000 M105\nL X+50 M106"),
        );
        rig.start();
        rig
    };
    let lags = |mp7440: &str| {
        let mut rig = started(mp7440);
        let lag = |rig: &Rig| rig.control.snapshot().axes[0].lag;
        rig.until(2.0, "half the way", |rig| nominal(rig, 'X') > 110.0);
        let first = lag(&rig);
        rig.until(5.0, "and back", |rig| nominal(rig, 'X') > 145.0);
        rig.until(5.0, "and back", |rig| nominal(rig, 'X') < 75.0);
        (first, lag(&rig))
    };
    let (second, first) = lags("7440=%01011");
    assert!(
        (second - 1.5).abs() < 0.015 && (first + 6.0).abs() < 0.06,
        "{second} {first}"
    );
    let mut rig = started("7440=%00011");
    let at = rig.machine_position('X');
    rig.until(1.0, "the message", |rig| !rig.messages().is_empty());
    assert!(rig.messages()[0].starts_with("FUNCTION NOT AVAILABLE ON THIS CONTROL"));
    near(rig.machine_position('X'), at);
}

/// M89 (MP7440 bit 1 = 1) calls the drilling cycle after each block until M99: three holes 10 deep from Z 10.
#[test]
fn drilling_with_m89_and_m99() {
    let cycle = "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SETUP -2\nCYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG -10\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F3000";
    let program = format!(
        "TOOL CALL 0 Z S0\n{cycle}\nL Z+2 R0 FMAX\nL X+60 FMAX M89\nL X+70 FMAX\nL X+80 FMAX M99\nL X+90 FMAX"
    );
    let mut rig = ready(bench(ACKNOWLEDGE).mp("7440=%00011").program("1.H", &program));
    rig.start();
    let mut holes = Vec::new();
    let mut deep = false;
    rig.until(1.0, "begin", |rig| {
        rig.control.snapshot().run == RunState::Running
    });
    while !rig.control.snapshot().ended {
        rig.cycle();
        let down = nominal(&rig, 'Z') < -9.999;
        if down && !deep {
            holes.push(nominal(&rig, 'X').round());
        }
        deep = down;
    }
    assert_eq!(holes, [60.0, 70.0, 80.0]);
    near(display(&rig, 'X'), 90.0);
}

/// Cycle 9 stands for its time: 1.5 s.
#[test]
fn dwell() {
    let program = "L X+51 R0 F6000\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\nL X+52";
    let mut rig = bench_with(ACKNOWLEDGE, program);
    rig.start();
    rig.until(2.0, "X+51", |rig| nominal(rig, 'X') == 51.0);
    let begin = rig.control.time_us();
    rig.until(3.0, "on", |rig| nominal(rig, 'X') > 51.0);
    let time = (rig.control.time_us() - begin) as f64 * 1e-6;
    assert!((1.5..1.56).contains(&time), "{time}");
}

/// The functions that the manual leaves to the machine builder, M15 to M18, M20 to M29, M31 to M88, each with its
/// code at a strobe, and no other [000:7095-7171].
#[test]
fn free_functions_go_to_the_plc() {
    // M60 and M89 stand for themselves.
    let free: Vec<i32> = (15..=18).chain(20..=29).chain(31..=59).chain(61..=88).collect();
    let blocks: Vec<String> = free.iter().map(|code| format!("M{code}")).collect();
    let mut rig = bench_with(ACKNOWLEDGE, &blocks.join("\n"));
    rig.start();
    let (mut codes, mut before) = (Vec::new(), false);
    for _ in 0..10_000 {
        rig.cycle();
        let strobe = rig.bit("M2045");
        if strobe && !before {
            codes.push(rig.number("W260"));
        }
        before = strobe;
    }
    assert_eq!(codes, free);
}

/// By hand as in the program: M1 goes to the PLC, M90 to M99 act on blocks alone and are not output [001:703-711].
#[test]
fn functions_by_hand() {
    let mut rig = bench_with(PATTERN, "L X+60 R0 F6000");
    rig.command("mode manual");
    for (code, goes) in [(90, false), (1, true), (99, false), (101, false), (2, true)] {
        rig.command(&format!("m {code}"));
        rig.start();
        let mut sent = false;
        for _ in 0..200 {
            rig.cycle();
            sent |= rig.bit("M2045") && rig.number("W260") == code;
        }
        assert_eq!(sent, goes, "M{code}");
    }
}
