//! TCH PROBE 0: measuring in the program.

use crate::support::*;
use bahn_parameters::MessageId;
use bahn_path::{Axis, Barrier, MeasuredPart, Position, ScanPattern};

/// P17: the height of an island as the difference of two measured coordinates [003:4452-4487].
#[test]
fn p17_height_of_an_island() {
    let run = Job::new(manual("P17")).surfaces(&[10.0, 0.0]).run();
    run.assert_completed();
    assert_eq!((run.q[10], run.q[20]), (10.0, 0.0));
    assert_eq!(run.q[1], 0.0 - 10.0);
    // Both points are probed from above, at the place of the nominal point.
    let probes: Vec<_> = run
        .barriers
        .iter()
        .filter_map(|b| {
            if let Barrier::Probe { from, to, .. } = b {
                Some((*from, *to))
            } else {
                None
            }
        })
        .collect();
    assert_eq!(probes.len(), 2);
    for ((from, to), nominal) in probes.iter().zip([[20.0, 50.0, 10.0], [50.0, 10.0, 0.0]]) {
        close_points(
            &[[from[Axis::X], from[Axis::Y]]],
            &[[nominal[0], nominal[1]]],
            1e-9,
        );
        assert!(from[Axis::Z] > nominal[2] && to[Axis::Z] < nominal[2]);
    }
    // Q115 to Q117: the position at each touch [003:7643-7651].
    let touches: Vec<_> = run.touched_q.iter().filter(|q| q[115] != 0.0).collect();
    assert_eq!(touches[0][115..118], [20.0, 50.0, 10.0]);
    assert_eq!(run.q[115..118], [50.0, 10.0, 0.0]);
}

/// The surfaces of the test of the index: islands at Z = 4 and Z = -3.5 give -7.5.
#[test]
fn p17_other_surfaces() {
    let run = Job::new(manual("P17")).surfaces(&[4.0, -3.5]).run();
    run.assert_completed();
    assert_eq!((run.q[10], run.q[20], run.q[1]), (4.0, -3.5, -7.5));
}

/// The stylus meets nothing within the measuring range [003:4410].
#[test]
fn nothing_to_touch() {
    let run = Job::new(manual("P17")).surfaces(&[10.0]).run();
    assert_eq!(run.message(), Some((MessageId::TouchPointInaccessible, 13)));
}

/// In the plane the ball of the stylus touches beside its centre: the surface lies one radius further.
#[test]
fn probing_a_side() {
    let text = program(
        "TOOL CALL 0 Z
         L X-20 Y+0 Z+10 R0 FMAX
         TCH PROBE 0.0 REF. PLANE Q5 X+
         TCH PROBE 0.1 X+5 Y+0 Z-5",
    );
    // The centre of the ball of radius 2 stands at X = 2 when it touches the side X = 4.
    let run = Job::new(text).surfaces(&[4.0]).run();
    run.assert_completed();
    close(run.q[5], 4.0 + 2.0, 1e-9);
}

/// The stylus is deflected before it moves: the surface is where it starts, MP6140 before the nominal point.
#[test]
fn already_in_contact() {
    let clearance = bahn_interpreter::ProbeRules::default().clearance_mm;
    let run = Job::new(manual("P17")).surfaces(&[10.0 + clearance]).run();
    assert_eq!(run.message(), Some((MessageId::StylusAlreadyInContact, 10)));
}

/// The measured coordinate is one of the active system: shifted by cycle 7, it counts from the new datum.
#[test]
fn probing_in_a_shifted_system() {
    let text = program(
        "TOOL CALL 0 Z
         CYCL DEF 7.0 DATUM
         CYCL DEF 7.1 Z-30
         CYCL DEF 7.2 X+100
         L Z+50 R0 FMAX
         TCH PROBE 0.0 REF. PLANE Q5 Z-
         TCH PROBE 0.1 X+5 Y+0 Z+0",
    );
    let run = Job::new(text).surfaces(&[-29.5]).run();
    run.assert_completed();
    close(run.q[5], 0.5, 1e-9);
    close(run.q[115], 5.0, 1e-9);
}

/// MP7411: the probe's calibrated data replace those of the tool, or do not [003:7365-7369].
#[test]
fn tool_data_while_probing() {
    let text = program(
        "TOOL DEF 1 L+20 R+9
         TOOL CALL 1 Z
         L Z+50 R0 FMAX
         TCH PROBE 0.0 REF. PLANE Q5 Z-
         TCH PROBE 0.1 X+5 Y+0 Z+0",
    );
    let with = |keeps: bool| {
        let run = Job::new(text.clone())
            .with(|s| {
                s.rules.probe_keeps_tool = keeps;
                s.rules.probe.radius_mm = 1.5;
                s.rules.probe.length_mm = 77.0;
            })
            .surfaces(&[0.0])
            .run();
        run.assert_completed();
        (run.q[108], run.q[114])
    };
    assert_eq!(with(true), (9.0, 20.0));
    assert_eq!(with(false), (1.5, 77.0));
}

/// A cycle that digitizes, over a range of 10 by 10 mm.
const DIGITIZING: &str = "TCH PROBE 5.0 RANGE
TCH PROBE 5.1 PGM NAME: 5007
TCH PROBE 5.2 Z X+0 Y+0 Z-5
TCH PROBE 5.3 X+10 Y+10 Z+2
TCH PROBE 5.4 HEIGHT: +20
TCH PROBE 6.0 MEANDER
TCH PROBE 6.1 DIRECTN: Y
TCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 1 P.P. INT: 0.5";

/// The stylus goes to clearance height, above MIN, and the surface is scanned from there; a datum shift moves the range.
#[test]
fn digitizing() {
    let blocks = format!("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+3\nL X+1 Y+1 Z+30 FMAX\n{DIGITIZING}");
    let run = Job::new(program(&blocks)).run();
    run.assert_completed();
    let [job] = run.scans.as_slice() else {
        panic!("{:?}", run.scans)
    };
    assert_eq!((job.min, job.max), ([3.0, 0.0, -5.0], [13.0, 10.0, 2.0]));
    assert_eq!(job.pattern, ScanPattern::Meander { line: Axis::Y });
    assert_eq!((job.travel_mm, job.spacing_mm, job.interval_mm), (0.5, 1.0, 0.5));
    // MP6210 = 5: 5 times 0.5 mm in a second.
    close(job.feed_mm_min(), 150.0, 1e-9);
    assert_eq!(job.begin(), [3.0, 0.0, 20.0]);
}

/// On a machine a digitized program replaces none: the block is refused before an axis moves. A test run writes elsewhere.
#[test]
fn on_a_machine_no_program_is_replaced() {
    let job = |machine: bool, there: &str| {
        let job = Job::new(program(DIGITIZING)).with(|settings| settings.machine = machine);
        job.library(there, program("L X+0")).run()
    };
    let refused = job(true, "5007");
    assert_eq!(refused.message(), Some((MessageId::EntryValueIncorrect, 8)));
    assert!(refused.elements.is_empty() && refused.scans.is_empty());
    job(true, "5008").assert_completed();
    job(false, "5007").assert_completed();
}

/// TCH PROBE 31 and 32 wait until the control has measured; the height is one of the program, the tool that of the
/// last TOOL CALL [000:7960-8058].
#[test]
fn tools_are_measured_at_a_barrier() {
    let blocks = "TOOL DEF 1 L+50 R+5\nTOOL CALL 1 Z S1000\nL Z+30 R0 FMAX\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 Z+20\n\
                  TCH PROBE 32.0 TOOL RADIUS\nTCH PROBE 32.1 CHECK: 1 Q5\nTCH PROBE 32.2 HEIGHT: +100\n\
                  TCH PROBE 32.3 PROBING THE TEETH: 0";
    let run = run(blocks);
    let [Barrier::MeasureTool(measuring)] = run.barriers.as_slice() else {
        panic!("{:?}", run.barriers);
    };
    assert_eq!(measuring.part, MeasuredPart::Radius);
    assert!(measuring.check && !measuring.teeth);
    assert_eq!((measuring.height, measuring.result), (120.0, Some(5)));
}

/// TCH PROBE 30 has the height only; PROBING THE TEETH: 1 wants each tooth.
#[test]
fn calibrating_and_single_teeth() {
    let tool = "TOOL DEF 1 L+50 R+5\nTOOL CALL 1 Z S1000\n";
    let calibrates = run(&format!(
        "{tool}TCH PROBE 30.0 TT CALIBRATION\nTCH PROBE 30.1 HEIGHT: +90"
    ));
    let teeth = run(&format!(
        "{tool}TCH PROBE 31.0 TOOL LENGTH\nTCH PROBE 31.1 CHECK: 0\nTCH PROBE 31.2 HEIGHT: +100\n\
         TCH PROBE 31.3 PROBING THE TEETH: 1"
    ));
    for (run, part, single, height) in [
        (calibrates, MeasuredPart::Probe, false, 90.0),
        (teeth, MeasuredPart::Length, true, 100.0),
    ] {
        let [Barrier::MeasureTool(measuring)] = run.barriers.as_slice() else {
            panic!("{:?}", run.barriers);
        };
        assert_eq!((measuring.part, measuring.teeth), (part, single));
        assert_eq!(measuring.height, height);
    }
}

#[test]
fn faults_of_tool_measuring() {
    let fault = |blocks: &str| {
        let text = format!("TOOL DEF 1 L+50 R+5\nTOOL CALL 1 Z S1000\n{blocks}");
        Job::new(program(&text))
            .run()
            .message()
            .map(|(message, _)| message)
    };
    let check = |value: &str| format!("TCH PROBE 31.0 TOOL LENGTH\nTCH PROBE 31.1 CHECK: {value}\n");
    assert_eq!(fault(&check("2")), Some(MessageId::EntryValueIncorrect));
    let teeth = check("0") + "TCH PROBE 31.2 HEIGHT: +100\nTCH PROBE 31.3 PROBING THE TEETH: 2";
    assert_eq!(fault(&teeth), Some(MessageId::EntryValueIncorrect));
    let missing = check("0") + "TCH PROBE 31.3 PROBING THE TEETH: 0";
    assert_eq!(fault(&missing), Some(MessageId::CyclIncomplete));
    let other = check("0") + "TCH PROBE 32.2 HEIGHT: +100";
    assert_eq!(fault(&other), Some(MessageId::CyclIncomplete));
    let no_tool = "TOOL CALL 0 Z S0\n".to_owned() + &teeth.replace("TEETH: 2", "TEETH: 0");
    assert_eq!(fault(&no_tool), Some(MessageId::ToolNotDefined));
}

/// The range of a digitizing lies within the software limits [003:8047-8051], the stylus of 100 mm with it: here X may go to
/// 500 of the machine, where the datum is at 400, and Z from -300 to 200 with the datum at -100.
#[test]
fn the_range_lies_within_the_limits() {
    let message = |range: [f64; 6], height: f64, datum: f64| {
        let [x0, y0, z0, x1, y1, z1] = range;
        let blocks = format!(
            "TOOL DEF 1 L+100 R+2\nTOOL CALL 1 Z\nTCH PROBE 5.0 RANGE\nTCH PROBE 5.1 PGM NAME: DIG\n\
             TCH PROBE 5.2 Z X{x0:+} Y{y0:+} Z{z0:+}\nTCH PROBE 5.3 X{x1:+} Y{y1:+} Z{z1:+}\nTCH PROBE 5.4 HEIGHT:{height:+}\n\
             TCH PROBE 6.0 MEANDER\nTCH PROBE 6.1 DIRECTN: X\nTCH PROBE 6.2 TRAVEL: 0.5 L.SPAC: 0.2 P.P. INT: 0.8\nSTOP"
        );
        let run = Job::new(program(&blocks))
            .with(|settings| {
                settings.rules.machine_zero = Position::ZERO;
                (
                    settings.rules.machine_zero[Axis::X],
                    settings.rules.machine_zero[Axis::Z],
                ) = (-400.0, datum);
                let [least, greatest] = &mut settings.rules.traverse;
                (greatest[Axis::X], least[Axis::Z], greatest[Axis::Z]) = (500.0, -300.0, 200.0);
            })
            .run();
        run.error.map(|error| (error.message, error.detail))
    };
    let faulty = |axis: char| {
        Some((
            bahn_interpreter::Message::Control(MessageId::FaultyRangeData),
            format!("the range leaves the traverse range of {axis}"),
        ))
    };
    let good = [0.0, 0.0, -10.0, 100.0, 10.0, 0.0];
    assert_eq!(message(good, 20.0, 100.0), None);
    assert_eq!(
        message([0.0, 0.0, -10.0, 100.001, 10.0, 0.0], 20.0, 100.0),
        faulty('X')
    );
    // The spindle nose is 100 above the tip: at 0 - 100 + 100 + 200 it is at the limit.
    assert_eq!(message(good, 200.0, 100.0), None);
    assert_eq!(message(good, 200.001, 100.0), faulty('Z'));
    assert_eq!(message([0.0, 0.0, -300.0, 100.0, 10.0, 0.0], 20.0, 100.0), None);
    assert_eq!(
        message([0.0, 0.0, -300.001, 100.0, 10.0, 0.0], 20.0, 100.0),
        faulty('Z')
    );
    // Nobody knows where the workpiece lies.
    assert_eq!(message(good, 1000.0, f64::NAN), None);
}
