//! M functions, stops, tool calls and what goes to the PLC: where on the path they are output.

use crate::support::*;
use bahn_parameters::ControlModel;
use bahn_path::{At, Axis, Barrier, Function, Position, Synchronisation};

/// The output of M functions with their place on the element of a block.
fn places(blocks: &str, block: u32) -> Vec<(Function, At, Synchronisation)> {
    let run = run(blocks);
    let elements = run.elements.iter().filter(|e| e.block.block == block);
    elements
        .flat_map(|e| {
            e.functions()
                .iter()
                .map(|f| (f.function.clone(), f.at, f.synchronisation))
        })
        .collect()
}

/// M3, M8, M13 go out before the movement of their block, M5, M9, M30 after it [003:7463-7487].
#[test]
fn start_and_end_of_block() {
    for m in [3, 4, 8, 13, 14] {
        let expected = (Function::M(m), At::Start, Synchronisation::MvsSvs);
        assert_eq!(places(&format!("L X+1 FMAX M{m}"), 1), [expected]);
    }
    for m in [5, 9, 2, 30] {
        let expected = (Function::M(m), At::End, Synchronisation::MnsSns);
        assert_eq!(places(&format!("L X+1 FMAX M{m}"), 1)[0], expected);
    }
}

/// M functions that act inside the control are not output [003:7476-7487].
#[test]
fn inner_functions() {
    for m in [90, 91, 97, 98] {
        assert_eq!(places(&format!("L X+1 FMAX M{m}"), 1), [], "M{m}");
    }
}

/// MP7440 bit 2: the axes do not wait, except where the run stops [000:7298-7305] [001:1651-1652].
#[test]
fn without_waiting() {
    let run = Job::new(program("L X+1 FMAX M3\nL X+2 FMAX M0"))
        .with(|s| s.rules.machine.halts.at_m_functions = false)
        .run();
    let all = run
        .elements
        .iter()
        .flat_map(|e| e.functions())
        .map(|f| (f.function.clone(), f.synchronisation));
    let m: Vec<_> = all.filter(|(f, _)| matches!(f, Function::M(_))).collect();
    assert_eq!(
        m,
        [
            (Function::M(3), Synchronisation::Mos),
            (Function::M(0), Synchronisation::MnsSns)
        ]
    );
}

/// STOP, M0 and M6 wait for the operator after their block; M6 by MP7440 bit 0 [003:2226-2236].
#[test]
fn stops() {
    let stops = |run: &Run| {
        let blocks = run.barriers.iter().filter_map(|b| {
            if let Barrier::Stop { block } = b {
                Some(block.block)
            } else {
                None
            }
        });
        blocks.collect::<Vec<_>>()
    };
    let text = program("L X+1 FMAX\nSTOP M5\nL X+2 FMAX M0\nL X+3 FMAX M6\nL X+4 FMAX M1\nL X+5 FMAX");
    let run = Job::new(text.clone()).run();
    // M1 is free [000:7080].
    assert_eq!(stops(&run), [2, 3, 4]);
    assert!(run.functions().contains(&(2, &Function::M(5))));
    let run = Job::new(text).with(|s| s.rules.machine.m6_stops = false).run();
    assert_eq!(stops(&run), [2, 3]);
    // M6 that does not stop takes nothing from M0 before it.
    let text = program("L X+1 FMAX M0 M6\nL X+2 FMAX");
    let run = Job::new(text).with(|s| s.rules.machine.m6_stops = false).run();
    assert_eq!(stops(&run), [1]);
}

/// TOOL CALL hands out tool, axis and speed; a call with S alone only the speed [003:1917-1952] [003:2188].
#[test]
fn tool_calls() {
    let run = run("TOOL DEF 5 L+10 R+5\nTOOL CALL 5 Z S500\nTOOL CALL S1000\nTOOL DEF 7\nTOOL CALL 0 Z");
    let calls = run.tool_calls();
    assert_eq!(
        calls
            .iter()
            .map(|c| (c.tool, c.axis, c.speed_rpm))
            .collect::<Vec<_>>(),
        [(5, Axis::Z, 500.0), (0, Axis::Z, 1000.0)]
    );
    assert!(run.functions().contains(&(3, &Function::SpindleSpeed(1000.0))));
    // Without data TOOL DEF announces the next tool [003:1931-1933].
    assert!(run.functions().contains(&(4, &Function::NextTool(7))));
    assert_eq!(calls[1].shape.radius, 0.0);
}

/// The path is that of the tool's tip, whatever the length of the tool [003:1979].
#[test]
fn tool_length_does_not_change_the_path() {
    let path = |length: &str| {
        shapes(&run(&format!(
            "TOOL DEF 1 L{length} R+0\nTOOL CALL 1 Z S1\nL X+1 Y+2 Z+3 FMAX\nL Z-1 F50"
        )))
    };
    assert_eq!(path("+0"), path("+120.5"));
}

/// FN 15 prints texts and values, with slashes between them [003:4383-4385], FN 19 hands values to the PLC: the TNC 360 counts in micrometres, later
/// controls take millimetres in 1/10 000 [003:4371-4395] [000:11597-11655].
#[test]
fn output_to_printer_and_plc() {
    let text = "FN 0: Q1 = +20.25\nFN 15: PRINT 1/Q1\nFN 19: PLC = +10/+Q1";
    let on = |model| {
        let run = Job::new(program(text)).with(|s| s.model = model).run();
        run.assert_completed();
        run.functions()
            .into_iter()
            .map(|(_, f)| f.clone())
            .collect::<Vec<_>>()
    };
    let print = Function::Print("ERROR 1/+20.25".into());
    assert_eq!(
        on(ControlModel::Tnc360),
        [print.clone(), Function::Plc([Some(10.0), Some(20.25)])]
    );
    assert_eq!(
        on(ControlModel::Tnc415b),
        [print, Function::Plc([Some(100_000.0), Some(202_500.0)])]
    );
}

/// Axes have no position, and add no path, until they are programmed or given.
#[test]
fn unknown_positions() {
    let run = run("L Z+100 R0 FMAX\nL X+10 Y+20 FMAX\nL X+20 F100");
    let lengths: Vec<f64> = run.moves().map(|e| e.length()).collect();
    assert_eq!(lengths, [0.0, 0.0, 10.0]);
    assert_eq!(run.position.get(Axis::C), None);
    let mut start = Position::UNKNOWN;
    start[Axis::Z] = 70.0;
    let run = Job::new(program("L Z+100 R0 FMAX"))
        .with(|s| s.start = start)
        .run();
    assert_eq!(run.moves().map(|e| e.length()).collect::<Vec<_>>(), [30.0]);
}

/// Rotary axes turn with degrees per minute when they move alone [003:7424-7430].
#[test]
fn rotary_axes() {
    let run = run("L X+0 C+0 FMAX\nL C+90 F360\nL IC+45 X+30");
    let lengths: Vec<f64> = run.moves().map(|e| e.length()).collect();
    assert_eq!(lengths[1..], [90.0, 30.0]);
    assert_eq!(run.position[Axis::C], 135.0);
}

/// On a machine the axes stand at a tool change: the tip of a tool that is 15 mm longer stands 15 mm lower, and
/// IZ counts from there. M91 positions the spindle nose: with a tool of 25 mm its tip is 25 mm below.
#[test]
fn tip_follows_the_length_at_a_tool_change() {
    let text = program(
        "TOOL DEF 1 L+10 R+1\nTOOL DEF 2 L+25 R+1\nTOOL CALL 1 Z S500\nL X+0 Y+0 Z+100 R0 FMAX\n\
         TOOL CALL 2 Z S500\nL X+5 R0 FMAX\nL IZ+10 R0 FMAX\nL Z+0 R0 FMAX M91",
    );
    let run = Job::new(text).with(|s| s.machine = true).run();
    let moves: Vec<_> = run.moves().map(|e| (xyz(&e.start), xyz(&e.end))).collect();
    assert_eq!(moves[1], ([0.0, 0.0, 85.0], [5.0, 0.0, 85.0]));
    assert_eq!(moves[2], ([5.0, 0.0, 85.0], [5.0, 0.0, 95.0]));
    assert_eq!(moves[3].1, [5.0, 0.0, -25.0]);
}

/// F of a program in inches counts tenths of an inch/min on all models [001:471] but the TNC 360 [003:2140];
/// the setting overrides; cycles and roundings count as positioning blocks do.
#[test]
fn feeds_of_programs_in_inches() {
    use bahn_parameters::{ControlModel, InchFeed};
    let text = "\
BEGIN PGM 1 INCH
CYCL DEF 1.0 PECKING
CYCL DEF 1.1 SET UP -0.1
CYCL DEF 1.2 DEPTH -0.5
CYCL DEF 1.3 PECKG -0.5
CYCL DEF 1.4 DWELL 0
CYCL DEF 1.5 F50
L X+0 Y+0 Z+1 R0 FMAX M99
L X+5 F300
RND R0.2 F70
L Y+5
END PGM 1 INCH
";
    for (model, setting, f1) in [
        (ControlModel::Tnc151, None, 2.54),
        (ControlModel::Tnc155, None, 2.54),
        (ControlModel::Tnc360, None, 25.4),
        (ControlModel::Tnc407, None, 2.54),
        (ControlModel::Tnc415b, None, 2.54),
        (ControlModel::Tnc425, None, 2.54),
        (ControlModel::Tnc360, Some(InchFeed::Tenths), 2.54),
        (ControlModel::Tnc415b, Some(InchFeed::Whole), 25.4),
    ] {
        let run = Job::new(text)
            .with(|settings| {
                settings.model = model;
                settings.inch_feed = setting;
            })
            .run();
        run.assert_completed();
        let feeds: Vec<f64> = run
            .moves()
            .filter_map(|element| match element.feed {
                bahn_path::FeedRate::Programmed(feed) => Some(feed),
                bahn_path::FeedRate::Rapid => None,
            })
            .collect();
        let expected = [50.0, 300.0, 70.0, 300.0].map(|feed| feed * f1);
        assert_eq!(feeds.len(), expected.len(), "{model}: {feeds:?}");
        for (feed, expected) in feeds.iter().zip(expected) {
            assert!((feed - expected).abs() < 1e-9, "{model}: {feeds:?}");
        }
    }
}

/// Rapid traverse of the TNC 151/155 is 6299 tenths of an inch/min [001:471].
#[test]
fn rapid_traverse_in_tenths_of_an_inch() {
    let run = Job::new("BEGIN PGM 1 INCH\nL X+1 R0 F6299\nEND PGM 1 INCH\n")
        .with(|settings| settings.model = bahn_parameters::ControlModel::Tnc155)
        .run();
    run.assert_completed();
    assert!(
        run.moves()
            .all(|element| element.feed == bahn_path::FeedRate::Rapid)
    );
}

/// Without a machine another tool is lifted out, at least to the upper face of the blank, until its axis is
/// positioned; the same tool with another DL stays where it is, its tip lower by the difference.
#[test]
fn another_tool_is_lifted_out_of_the_workpiece() {
    let text = program(
        "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+50 Y+50 Z+3\nTOOL DEF 1 L+10 R+1\nTOOL DEF 2 L+95 R+1\n\
         TOOL CALL 1 Z S500\nL X+0 Y+0 Z-5 R0 FMAX\nTOOL CALL 1 Z S800 DL+2\nL X+1 FMAX\n\
         TOOL CALL 2 Z S500\nL X+5 R0 FMAX\nL Z+60 R0 FMAX\nTOOL CALL 1 Z S500\nL X+6 R0 FMAX",
    );
    let starts = |job: Job| job.run().moves().map(|e| xyz(&e.start)).collect::<Vec<_>>();
    let seen = starts(Job::new(text.clone()));
    assert_eq!(seen[1], [0.0, 0.0, -7.0]);
    assert_eq!(seen[2], [1.0, 0.0, 3.0]);
    assert_eq!(seen[4], [5.0, 0.0, 60.0]);
    let seen = starts(Job::new(text).with(|s| {
        s.tool_change[Axis::X] = -30.0;
        s.tool_change[Axis::Z] = 200.0;
    }));
    assert_eq!(seen[2], [-30.0, 0.0, 200.0]);
    assert_eq!(seen[4], [-30.0, 0.0, 200.0]);
}

/// Who has not said where the workpiece lies sees the axes of M91 leave it, and is told once.
#[test]
fn machine_positions_without_a_machine_lead_away() {
    let text = program(
        "TOOL DEF 1 L+10 R+1\nTOOL CALL 1 Z S500\nL X+0 Y+0 Z+2 R0 FMAX\nL Z-1 R0 FMAX M91\nL X+30 FMAX\n\
         L Y+300 R0 FMAX M92\nL X+9 Y+8 FMAX\nL Z+2 FMAX",
    );
    let unknown = |s: &mut bahn_interpreter::Settings| {
        s.rules.machine_zero = Position::UNKNOWN;
        s.rules.machine_zero[Axis::X] = -40.0;
    };
    let run = Job::new(text).with(unknown).run();
    run.assert_completed();
    let ends: Vec<_> = run
        .moves()
        .map(|e| [Axis::X, Axis::Y, Axis::Z].map(|a| e.end.get(a)))
        .collect();
    assert_eq!(
        ends,
        [
            [Some(0.0), Some(0.0), Some(2.0)],
            [Some(0.0), Some(0.0), None],
            [Some(30.0), Some(0.0), None],
            [Some(30.0), None, None],
            [Some(9.0), Some(8.0), None],
            [Some(9.0), Some(8.0), Some(2.0)],
        ]
    );
    // Only what lies between two positions has a length: 30, then from 30 to 9.
    assert_eq!(
        run.moves().map(|e| e.length()).collect::<Vec<_>>(),
        [0.0, 0.0, 30.0, 0.0, 21.0, 0.0]
    );
    assert_eq!(run.warnings.len(), 1);
    assert_eq!(run.warnings[0].block.block, 4);
    // With radius compensation and in an axis whose place is known all stays as it was.
    let run = Job::new(program(
        "TOOL DEF 1 L+10 R+1\nTOOL CALL 1 Z S500\nL X+0 Y+0 Z+2 R0 FMAX\nL X+10 Y+10 RL F100\nL X+50\n\
         L X+0 Y+0 FMAX M91\nL X+5 R0",
    ))
    .with(unknown)
    .run();
    run.assert_completed();
    assert!(run.moves().all(|e| !e.length().is_nan()));
}

/// M93: the coordinates of the block count from where the tool is, those of the next block from the datum
/// [003:7481].
#[test]
fn m93_counts_from_the_tool() {
    let run = run("L X+10 Y+7 R0 FMAX\nL X+5 FMAX M93\nL X+6 Y+2 FMAX");
    let ends: Vec<[f64; 3]> = run.moves().skip(1).map(|e| xyz(&e.end)).collect();
    assert_eq!(ends[0][..2], [15.0, 7.0]);
    assert_eq!(ends[1][..2], [6.0, 2.0]);
}

/// M94: 730 degrees count as 10, and C+20 turns by 10 degrees; under M127 and without it by -710 [003:7482] [000:836].
#[test]
fn m94_takes_whole_turns_off() {
    use bahn_parameters::ControlModel::Tnc415b;
    let turn = |m: &str| {
        let text = program(&format!(
            "L X+0 C+0 FMAX\nL C+730 F360\nL X+1 FMAX {m}\nL C+20 F360"
        ));
        let run = Job::new(text).with(|s| s.model = Tnc415b).run();
        run.assert_completed();
        let last = run.moves().last().unwrap().clone();
        last.end[Axis::C] - last.start[Axis::C]
    };
    assert_eq!(turn("M94"), 10.0);
    assert_eq!(turn("M127"), -710.0);
    assert_eq!(turn(""), -710.0);
}

/// M13 and M14 are M3 and M4 with M8: Q110 and Q111 [000:7093-7094].
#[test]
fn m13_and_m14_switch_the_coolant_on() {
    for (m, spindle) in [("M13", 0.0), ("M14", 1.0)] {
        let run = run(&format!(
            "TOOL DEF 1 L+0 R+1\nTOOL CALL 1 Z S100\nL X+0 FMAX {m}\nL X+1 FMAX"
        ));
        assert_eq!((run.q[110], run.q[111]), (spindle, 1.0), "{m}");
    }
}

/// M118 takes a range for each axis it names, mm or degrees, in inches those of linear axes as inches; without words
/// there is none any more. A range is a distance: -1 is no entry value.
#[test]
fn ranges_of_the_handwheel() {
    let ranges = |text: &str| {
        let run = Job::new(text).run();
        let of = |(_, function): (u32, &Function)| match function {
            Function::Superimpose(range) => Some([range[Axis::X], range[Axis::Z], range[Axis::C]]),
            _ => None,
        };
        run.functions().into_iter().filter_map(of).collect::<Vec<_>>()
    };
    let blocks = "L X+1 R0 FMAX M118 X0.5 Z2 C3\nL X+2 FMAX M118";
    let of_unit = |unit: &str| ranges(&format!("BEGIN PGM 1 {unit}\n{blocks}\nEND PGM 1 {unit}\n"));
    assert_eq!(of_unit("MM"), [[0.5, 2.0, 3.0], [0.0; 3]]);
    assert_eq!(of_unit("INCH"), [[12.7, 50.8, 3.0], [0.0; 3]]);
    let wrong = Job::new(program("L X+1 R0 FMAX M118 X-1")).run();
    assert_eq!(
        wrong.message(),
        Some((bahn_parameters::MessageId::EntryValueIncorrect, 1))
    );
}
