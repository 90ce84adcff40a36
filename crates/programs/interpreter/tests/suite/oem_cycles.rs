//! Cycles of the machine builder, 68 to 99: programs with a dialogue block [000:17691-17984].

use crate::support::*;
use bahn_interpreter::Settings;
use bahn_parameters::MessageId::{
    BlockNotKnown, CyclIncomplete, EntryValueIncorrect, ExcessiveSubprogramming,
};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::Axis;

/// The program of a cycle.
fn cycle(number: u32, blocks: &str) -> (String, String) {
    let name = (99_999_900 + number).to_string();
    let text = format!("BEGIN PGM {name} MM\n{blocks}\nEND PGM {name} MM\n");
    (name, text)
}

/// A job with cycles in the program memory.
fn job(blocks: &str, cycles: &[(u32, &str)]) -> Job {
    let mut job = Job::new(program(blocks));
    for (number, blocks) in cycles {
        let (name, text) = cycle(*number, blocks);
        job = job.library(&name, text);
    }
    job
}

/// Rules of machine parameters on a TNC 415 B.
fn mp(assignments: &'static [&'static str]) -> impl FnOnce(&mut Settings) {
    move |settings| {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        for assignment in assignments {
            assert!(list.assign(assignment).is_ok(), "{assignment}");
        }
        settings.rules = bahn_interpreter::Rules::of(&list);
    }
}

/// What cycle 69 makes of Q1 and Q60, which the definition has set to 2 and the program to 5: 40 global parameters are
/// Q60 to Q99, 39 are Q61 to Q99 [000:17787-17800]. With 100 all of them are global.
#[test]
fn local_and_global_parameters() {
    let q = |globals: &'static [&'static str]| {
        let main = "FN 0: Q1 = +1\nFN 0: Q60 = +5\nCYCL DEF 69.0 COUNT ON\nCYCL DEF 69.1 Q1=+2\nL X+1 FMAX";
        let run = job(
            main,
            &[(
                69,
                "DLG-DEF 0/32\nFN 1: Q1 = +Q1 + +10\nFN 1: Q60 = +Q60 + +10\nFN 0: Q150 = +7",
            )],
        )
        .with(mp(globals))
        .run();
        run.assert_completed();
        [run.q[1], run.q[60], run.q[150]]
    };
    assert_eq!(q(&["7250=0", "7251=40"]), [2.0, 15.0, 7.0]);
    assert_eq!(q(&["7250=0", "7251=39"]), [2.0, 5.0, 7.0]);
    assert_eq!(q(&["7250=0", "7251=0"]), [2.0, 5.0, 7.0]);
    assert_eq!(q(&["7250=0", "7251=100"]), [12.0, 15.0, 7.0]);
}

/// Holes on a circle: Q1 how many, Q2 radius, Q3 and Q4 centre, Q5 clearance and Q6 depth with their signs, Q7 feed.
const HOLES: &str = "DLG-CALL 0/1/2/3/4/5/6/7\n; below the clearance\nFN 1: Q6 = +Q5 + +Q6\nFN 0: Q50 = +0\n\
                     CC X+Q3 Y+Q4\nLBL 1\nFN 3: Q51 = +Q50 * +360\nFN 4: Q51 = +Q51 DIV +Q1\n\
                     LP PR+Q2 PA+Q51 R0 FMAX\nL IZ+Q6 FQ7\nL IZ-Q6 FMAX\nFN 1: Q50 = +Q50 + +1\n\
                     FN 12: IF +Q50 LT +Q1 GOTO LBL 1";

/// Eight holes on a circle of R40 about (60,50), from Z+2 to Z-20; at the cycle call, not at the definition. Q6 is what
/// it was after it, so that a second call drills as deep; where it is global the second goes 2 mm deeper.
#[test]
fn bolt_hole_circle() {
    let main = "TOOL CALL 1 Z S1000\nL Z+2 R0 FMAX M3\nCYCL DEF 68.0 HOLES\nCYCL DEF 68.1 Q1=+8 Q2=+40 Q3=+60\n\
                CYCL DEF 68.2 Q4=+50 Q5=-2 Q6=-20\nCYCL DEF 68.3 Q7=+100\nL X+0 Y+0 FMAX\nCYCL CALL\nL X+1 FMAX M99";
    let drilled = |globals: &'static [&'static str]| {
        let run = job(main, &[(68, HOLES)]).with(mp(globals)).run();
        run.assert_completed();
        let moves: Vec<_> = run.moves().collect();
        let bottoms = moves.iter().filter(|e| e.end[Axis::Z] < 0.0).map(|e| xyz(&e.end));
        // Nothing was drilled at the definition.
        assert_eq!(moves[1].block.block, 7);
        bottoms.collect::<Vec<_>>()
    };
    let holes = |depth: f64| {
        (0..8).map(move |hole| {
            let (sin, cos) = (f64::from(hole) * 45.0).to_radians().sin_cos();
            [60.0 + 40.0 * cos, 50.0 + 40.0 * sin, depth]
        })
    };
    let twice: Vec<_> = holes(-20.0).chain(holes(-20.0)).collect();
    close_points(&drilled(&["7251=93"]), &twice, 1e-9);
    let deeper: Vec<_> = holes(-20.0).chain(holes(-22.0)).collect();
    close_points(&drilled(&["7251=94"]), &deeper, 1e-9);
    // As a called program all parameters are global.
    let called = "TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2 R0 FMAX M3\nFN 0: Q1 = +8\nFN 0: Q6 = -20\nFN 0: Q5 = -2\n\
                  FN 0: Q7 = +100\nFN 0: Q2 = +9\nCALL PGM 99999968";
    let run = job(called, &[(68, HOLES)]).run();
    run.assert_completed();
    assert_eq!(run.q[6], -22.0);
}

/// A DLG-DEF cycle runs after the last block of its definition, its parameters MP7250 higher; the cycle for the call
/// stays the one that was defined before, whatever it defines itself, and M89 waits.
#[test]
fn a_cycle_that_acts_at_its_definition() {
    let shift = "DLG-DEF 0/1/2\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+Q31\nCYCL DEF 7.2 Y+Q32\n\
                 CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -5\nCYCL DEF 1.3 PECKG -5\n\
                 CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\nL X+3 FMAX";
    let main = "CYCL DEF 72.0 MARK\nL X+0 Y+0 FMAX M89\nCYCL DEF 70.0 SHIFT\nCYCL DEF 70.1 Q31=+10\n; between\n\
                CYCL DEF 70.2 Q32=+20\nL X+1 Y+1 FMAX";
    let mark = "DLG-CALL 0\nFN 1: Q80 = +Q80 + +1";
    let run = job(main, &[(70, shift), (72, mark)])
        .with(mp(&["7250=30", "7251=40"]))
        .run();
    run.assert_completed();
    close_points(
        &ends(&run.moves().collect::<Vec<_>>()),
        &[[0.0, 0.0], [13.0, 0.0], [11.0, 21.0]],
        1e-12,
    );
    // M89 called cycle 72 after both blocks of the main program, not within cycle 70.
    assert_eq!(run.q[80], 2.0);
}

/// Four within each other run, the fifth does not [000:17711].
#[test]
fn nesting() {
    let call = |number: u32| format!("DLG-DEF 0\nFN 1: Q90 = +Q90 + +1\nCYCL DEF {number}.0 NEXT");
    let texts: Vec<(u32, String)> = (80..84).map(|number| (number, call(number + 1))).collect();
    let deep = |first: u32| {
        let mut cycles: Vec<(u32, &str)> = texts
            .iter()
            .map(|(number, text)| (*number, text.as_str()))
            .collect();
        cycles.push((84, "DLG-DEF 0\nFN 1: Q90 = +Q90 + +1\nL X+1 FMAX"));
        job(&format!("CYCL DEF {first}.0 FIRST"), &cycles)
            .with(mp(&["7251=40"]))
            .run()
    };
    let four = deep(81);
    four.assert_completed();
    assert_eq!(four.q[90], 4.0);
    assert_eq!(
        deep(80).error.unwrap().message,
        bahn_interpreter::Message::Control(ExcessiveSubprogramming)
    );
}

/// With MP7240 = 1 a cycle in the program memory goes before that of the EPROM, with 0 it could not be there. The PLC
/// inhibits those of the EPROM only [000:17757-17761] [000:17812-17821].
#[test]
fn memory_and_eprom() {
    let (name, text) = cycle(75, "DLG-DEF 0\nL X+2 FMAX");
    let end = |in_memory: bool, inhibited: u32, free: &'static [&'static str]| {
        let cycles: &[(u32, &str)] = match in_memory {
            true => &[(75, "DLG-DEF 0\nL X+1 FMAX")],
            false => &[],
        };
        let run = job("CYCL DEF 75.0 GO", cycles)
            .eprom(&name, text.clone())
            .with(mp(free))
            .with(|settings| settings.inhibited_oem_cycles = inhibited)
            .run();
        match run.message() {
            Some(message) => Err(message),
            None => Ok(run.position[Axis::X]),
        }
    };
    const FREE: &[&str] = &["7240=1"];
    const FIXED: &[&str] = &["7240=0"];
    assert_eq!(end(true, 0, FREE), Ok(1.0));
    assert_eq!(end(true, 0, FIXED), Ok(2.0));
    assert_eq!(end(false, 0, FREE), Ok(2.0));
    // M2247: cycle 75.
    assert_eq!(end(false, 1 << 7, FREE), Err((BlockNotKnown, 1)));
    assert_eq!(end(true, 1 << 7, FREE), Ok(1.0));
    assert_eq!(end(false, 1 << 6, FREE), Ok(2.0));
}

/// What a cycle must not have [000:17705-17724].
#[test]
fn what_cycles_must_not_have() {
    for (block, in_memory, in_eprom) in [
        ("STOP", false, false),
        ("L X+1 FMAX M2", false, false),
        ("M30", false, false),
        ("M6", false, false),
        // M00 stops the program run as STOP does; M01 goes to the PLC, and the control does not stop for it [000:7080-7081].
        ("M0", false, false),
        ("L X+1 FMAX M0", false, false),
        ("M1", true, true),
        ("L X+1 FMAX M1", true, true),
        ("CALL PGM 7", false, false),
        ("CYCL DEF 14.0 CONTOUR GEOMETRY", false, false),
        ("LBL 1\nCALL LBL 1 REP 2/2", true, false),
        ("TOOL DEF 5 L+1 R+2", false, true),
        ("TOOL CALL 0 Z S100", true, true),
        ("M8", true, true),
    ] {
        let text = format!("DLG-DEF 0\n{block}");
        let (name, in_folder) = cycle(90, &text);
        for (eprom, permitted) in [(false, in_memory), (true, in_eprom)] {
            let run = match eprom {
                true => job("CYCL DEF 90.0 GO", &[]).eprom(&name, in_folder.clone()),
                false => job("CYCL DEF 90.0 GO", &[(90, text.as_str())]),
            }
            .run();
            let message = run.message().map(|(id, _)| id);
            assert_eq!(message, (!permitted).then_some(BlockNotKnown), "{block} {eprom}");
        }
    }
}

#[test]
fn wrong_definitions() {
    let message = |blocks: &str| job(blocks, &[(68, HOLES), (99, "L X+1 FMAX")]).run().message();
    let peck = "CYCL DEF 68.0 HOLES\nCYCL DEF 68.1 Q1=+8 Q2=+40 Q3=+60";
    assert_eq!(message(&format!("{peck}\nL X+1 FMAX")), Some((CyclIncomplete, 2)));
    assert_eq!(
        message(&format!("{peck}\nCYCL DEF 68.3 Q7=+1")),
        Some((CyclIncomplete, 3))
    );
    assert_eq!(message("CYCL DEF 77.0 NOBODY"), Some((BlockNotKnown, 1)));
    // A program without a dialogue block is no cycle, and one of another name has none.
    assert_eq!(message("CYCL DEF 99.0 NO DIALOGUE"), Some((BlockNotKnown, 1)));
    assert_eq!(message("L X+1 FMAX\nDLG-CALL 0/1"), Some((BlockNotKnown, 2)));
    assert_eq!(message("DLG-DEF 0/200"), Some((EntryValueIncorrect, 1)));
    let old =
        job("CYCL DEF 68.0 HOLES", &[(68, HOLES)]).with(|settings| settings.model = ControlModel::Tnc360);
    assert_eq!(old.run().message(), Some((BlockNotKnown, 1)));
}

/// Holes on a circle with the arithmetic of the manual [001:2853-2869]: the loop goes on while the angle is below 361.
fn bolts(block: &str, q: u32) -> String {
    let q = |number: u32| q + number;
    let [count, radius, x, y, clearance, depth, feed] = [1, 2, 3, 4, 5, 6, 7].map(q);
    format!(
        "{block} 0/1/2/3/4/5/6/7/ / / /\nFN 1 : Q{depth} = + Q{depth} + +Q{clearance}\n\
         FN 4 : Q80 = +360.000 DIV +Q{count}\nFN 0 : Q81 = +0.000\nCC X+Q{x} Y+Q{y}\nLBL 11\n\
         LP PR+Q{radius} PA+Q81 R0 F15999 M\nL IZ+Q{depth} R0 FQ{feed} M\nL IZ-Q{depth} R0 F15999 M\n\
         FN 1 : Q81 = +Q81 + +Q80\nFN 12 : IF +Q81 LT +361.000 GOTO LBL 11"
    )
}

/// Places of the strokes of a run, and how deep they are.
fn strokes(run: &Run) -> Vec<[f64; 3]> {
    let ends = run.moves().map(|element| xyz(&element.end));
    ends.filter(|end| end[2] < 0.0).collect()
}

/// 27 holes of R40 about (50,50) from Z+2: Q5 = -2 and Q6 = -20 go 22 mm down to Z-20. The last angle is 360, below 361, so that
/// the first hole is drilled twice: 28 strokes at 27 places. By DLG-CALL at CYCL CALL from Q1 on, by DLG-DEF after its
/// definition from Q51 on with MP263 = 50 [001:2784-2799] [001:3067-3080].
#[test]
fn the_bolt_circle_of_a_tnc_155() {
    let of_155 = |settings: &mut Settings| {
        let mut list = ParameterList::reference(ControlModel::Tnc155);
        assert!(list.assign("263=50").is_ok());
        settings.model = ControlModel::Tnc155;
        settings.rules = bahn_interpreter::Rules::of(&list);
    };
    for (block, offset, call) in [("DLG-CALL", 0, "CYCL CALL M\n"), ("DLG-DEF", 50, "")] {
        let q = |number: u32| offset + number;
        let main = format!(
            "TOOL DEF 1 L+0,000 R+2,000\nTOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2,000 R0 F15999 M03\n\
             CYCL DEF 68.0 BOLT HOLE CIRCLE\nCYCL DEF 68.1 Q{} = +27,000 Q{} = +40,000 Q{} = +50,000\n\
             CYCL DEF 68.2 Q{} = +50,000 Q{} = -2,000 Q{} = -20,000\nCYCL DEF 68.3 Q{} = +100,000 Q{} = Q{} =\n{call}L Z+50 R0 F15999",
            q(1),
            q(2),
            q(3),
            q(4),
            q(5),
            q(6),
            q(7),
            q(8),
            q(9)
        );
        let run = job(&main, &[(68, &bolts(block, offset))]).with(of_155).run();
        run.assert_completed();
        let expected: Vec<[f64; 3]> = (0..28)
            .map(|hole| {
                let (sin, cos) = (f64::from(hole) * 360.0 / 27.0).to_radians().sin_cos();
                [50.0 + 40.0 * cos, 50.0 + 40.0 * sin, -20.0]
            })
            .collect();
        close_points(&strokes(&run), &expected, 1e-6);
        let mut places: Vec<[i64; 2]> = strokes(&run)
            .iter()
            .map(|at| [0, 1].map(|axis| (at[axis] * 1e3).round() as i64))
            .collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 27, "{block}");
        // What the cycle has computed is there after it: nothing is local on this control.
        assert_eq!(run.q[(offset + 6) as usize], -22.0, "{block}");
    }
}

/// The blocks of program 1000 as printed [001:3067-3080].
const PRINTED: &str = "BLK FORM 0.1 Z X + 0,000 Y + 0,000 Z - 20,000\nBLK FORM 0.2 X + 100,000 Y + 100,000 Z + 0,000\n\
    TOOL DEF 1 L + 0,000 R + 2,000\nTOOL CALL 1 Z S\nL Z + 2,000 R0 F15999 M03\nCYCL DEF 68.0 BOLT HOLE CIRCLE\n\
    CYCL DEF 68.1 Q1 = +27,000 Q2 = +40,000 Q3 = +50,000\nCYCL DEF 68.2 Q4 = +50,000 Q5 = -2,000 Q6 = -20,000\n\
    CYCL DEF 68.3 Q7 = +100,000 Q8 = Q9 =\nCYCL CALL M";

/// The printed macro begins with DLG-DEF and runs at its definition; the printed program calls it after that: the 28 strokes are
/// not made twice. With DLG-CALL it is the call that makes them. Where a standard cycle was defined the call machines that one;
/// without any definition it is refused as before.
#[test]
fn the_printed_program_of_a_tnc_155() {
    let of_155 = |settings: &mut Settings| {
        settings.model = ControlModel::Tnc155;
        settings.rules = bahn_interpreter::Rules::of(&ParameterList::reference(ControlModel::Tnc155));
    };
    for block in ["DLG-DEF", "DLG-CALL"] {
        let run = job(PRINTED, &[(68, &bolts(block, 0))]).with(of_155).run();
        run.assert_completed();
        assert_eq!(strokes(&run).len(), 28, "{block}");
    }
    let pecking = "TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S500\nL X+0 Y+0 Z+2 R0 F15999 M03\nCYCL DEF 1.0 PECKING\n\
        CYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -5\nCYCL DEF 1.3 PECKG -5\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\n\
        CYCL DEF 68.0 COUNT\nCYCL CALL";
    let run = job(pecking, &[(68, "DLG-DEF 0\nFN 1: Q90 = +Q90 + +1")])
        .with(of_155)
        .run();
    run.assert_completed();
    assert_eq!((strokes(&run).len(), run.q[90]), (1, 1.0));
    let run = job("CYCL CALL", &[]).with(of_155).run();
    assert_eq!(run.message(), Some((CyclIncomplete, 1)));
}

/// A macro of a TNC 155 may stop and call programs; only repeats are forbidden, in the EPROM [001:2829-2833].
#[test]
fn what_a_macro_of_a_tnc_155_may_have() {
    let of_155 = |settings: &mut Settings| {
        settings.model = ControlModel::Tnc155;
        settings.rules = bahn_interpreter::Rules::of(&ParameterList::reference(ControlModel::Tnc155));
    };
    let cycle =
        "DLG-DEF 0\nLBL 1\nFN 1: Q90 = +Q90 + +1\nCALL LBL 1 REP 2/2\nCALL PGM 7\nFN 1: Q90 = +Q90 + +1";
    let run = job("CYCL DEF 68.0 COUNT\nL X+1 R0 F500", &[(68, cycle)])
        .library(
            "7",
            "BEGIN PGM 7 MM\nFN 1: Q90 = +Q90 + +10\nEND PGM 7 MM\n".to_owned(),
        )
        .with(of_155)
        .run();
    run.assert_completed();
    // Three times 1, 10 of program 7, and 1.
    assert_eq!(run.q[90], 14.0);
}
