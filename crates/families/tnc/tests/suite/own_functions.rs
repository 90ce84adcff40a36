//! M functions that the machine builder synchronises as on a TF5200: M40 goes out where its type says, and the path
//! waits only where it has to [004:54-90].

use crate::stand::*;
use bahn_tnc::RunState;

/// M functions are acknowledged when key A lets them.
const BY_HAND: &str = "
       L     M2045
       A     I20
       = M2482
";

/// 50 mm/s; the path begins at X50.
const PROGRAM: &str = "L X+60 R0 F3000\nL X+70 M40\nL X+80\nL X+90\nL X+100 FMAX\nM41\nL X+110 F3000";

/// Where X was, on the path, when M40 went out, and where the path stands as long as nobody acknowledges it; it then
/// comes to its end.
fn without_answer(program: &str, synchronisation: &str, distance_mm: Option<f64>) -> (f64, f64) {
    let build = bench(&format!("{ACKNOWLEDGE_BUT_M}{BY_HAND}"))
        .function(40, synchronisation, distance_mm)
        .function(41, "EXPL_SYN", None)
        .program("1.H", program);
    let mut rig = ready(build);
    rig.start();
    rig.until(3.0, "M40 goes out", |rig| rig.bit("M2045"));
    assert_eq!(rig.number("W260"), 40);
    let out = nominal(&rig, 'X');
    rig.seconds(3.0);
    assert_eq!(rig.control.snapshot().run, RunState::Running, "it waits");
    let stands = nominal(&rig, 'X');
    rig.event("key A press");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 110.0);
    (out, stands)
}

/// M40 stands in the second block, from X60 to X70; F goes on to X90, and M41 is the explicit place after X100. What goes
/// out on the way is seen at most a PLC scan and two contour cycles later: 30 ms are 1.5 mm.
#[test]
fn each_type_goes_out_and_waits_in_its_place() {
    for (synchronisation, way, out, stands) in [
        ("MVS_SVS", None, 60.0, 60.0),
        ("MVS_SNS", None, 60.0, 70.0),
        ("MNS_SNS", None, 70.0, 70.0),
        ("MEP_SVS", Some(7.0), 53.0, 60.0),
        ("MVS_SLP", None, 60.0, 100.0),
    ] {
        let (was_out, stood) = without_answer(PROGRAM, synchronisation, way);
        assert!(
            (out..out + 1.5).contains(&was_out),
            "{synchronisation}: out at {was_out}"
        );
        near(stood, stands);
    }
}

/// `MVS_SLM` in rapid traverse waits where the feed begins [004:72].
#[test]
fn late_implicit() {
    let program = "L X+60 R0 FMAX M40\nL X+70 FMAX\nL X+80 F3000\nL X+110";
    let (_, stood) = without_answer(program, "MVS_SLM", None);
    near(stood, 70.0);
}

/// `MOS` and `MEP_MOS` hold nothing: the axes are at their end when it is acknowledged, and the program ends then.
#[test]
fn without_synchronisation() {
    for (synchronisation, way) in [("MOS", None), ("MEP_MOS", Some(7.0))] {
        let (_, stood) = without_answer("L X+60 R0 F3000\nL X+70 M40\nL X+110", synchronisation, way);
        near(stood, 110.0);
    }
}

/// Acknowledged in time nothing is seen of it: the run takes as long as without the function [004:63].
#[test]
fn in_time_it_costs_nothing() {
    let time = |synchronisation: &str, program: &str| {
        let build = bench(ACKNOWLEDGE)
            .function(40, synchronisation, None)
            .program("1.H", program);
        let mut rig = ready(build);
        let begin = rig.control.time_us();
        run(&mut rig, 5.0);
        rig.control.time_us() - begin
    };
    let program = "L X+60 R0 F3000\nL X+70 M40\nL X+80\nL X+110";
    let plain = time("MOS", &program.replace(" M40", ""));
    assert_eq!(time("MVS_SNS", program), plain);
    assert!(time("MVS_SVS", program) > plain);
}

/// INTERNAL STOP while the path waits takes the strobe back; the next start executes the block again.
#[test]
fn internal_stop_while_it_waits() {
    let build = bench(&format!("{ACKNOWLEDGE_BUT_M}{BY_HAND}"))
        .function(40, "MVS_SNS", None)
        .program("1.H", "L X+60 R0 F3000\nL X+70 M40\nL X+80");
    let mut rig = ready(build);
    rig.start();
    rig.until(3.0, "M40 goes out", |rig| rig.bit("M2045"));
    rig.seconds(2.0);
    near(nominal(&rig, 'X'), 70.0);
    rig.event("key NC_STOP tap");
    rig.seconds(0.3);
    rig.command("stop");
    rig.seconds(0.2);
    assert!(!rig.bit("M2045"));
    rig.event("key A press");
    rig.start();
    rig.until(3.0, "the end", |rig| rig.control.snapshot().ended);
    near(display(&rig, 'X'), 80.0);
}
