//! What a program for LinuxCNC says, line by line.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::support::*;
use bahn_convert::{Language, gcode as linuxcnc};
use bahn_parameters::ControlModel;
use bahn_path::{Axis, Position};

/// The lines of the text without comments, after its first four, and the reasons of what is refused.
fn lines(blocks: &str) -> (Vec<String>, Vec<String>) {
    let source = program(
        &format!("BEGIN PGM A MM\n{blocks}\nEND PGM A MM\n"),
        Language::Plain,
    );
    let mut settings = settings(ControlModel::Tnc415b);
    // Nobody says where the workpiece lies.
    settings.rules.machine_zero = Position::UNKNOWN;
    let (made, proof) = gcode(&source, &settings, &root());
    assert!(proof.holds(), "{proof:?}\n{}", made.text);
    let bare = |line: &str| line.split(';').next().unwrap_or_default().trim().to_owned();
    let lines = made.text.lines().skip(4).map(bare).collect();
    let reasons = made.refused.into_iter().map(|listed| listed.reason);
    (lines, reasons.collect())
}

#[track_caller]
fn says(blocks: &str, expected: &[&str]) {
    let (lines, refused) = lines(blocks);
    assert_eq!(
        (lines, refused),
        (expected.iter().map(|line| line.to_string()).collect(), Vec::new())
    );
}

#[test]
fn tools_are_changed_where_m06_stands_or_at_their_call() {
    says(
        "TOOL CALL 1 Z S500\nL Z+20 R0 FMAX M6\nTOOL CALL 2 Z S600\nL Z+30 FMAX\nTOOL CALL S700",
        &[
            "T1", "S500", "G0 Z20", "M6", "G43", "T2", "M6", "G43", "S600", "Z30", "S700", "M2",
        ],
    );
}

#[test]
fn taps_and_threads_follow_the_spindle() {
    let tap = |pitch: f64| {
        format!(
            "TOOL CALL 1 Z S500\nL X+0 Y+0 Z+2 R0 FMAX\nCYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP -2\n\
             CYCL DEF 17.2 DEPTH -10\nCYCL DEF 17.3 PITCH {pitch:+}\nCYCL CALL\nL Z+20 FMAX"
        )
    };
    let lines = |turn: &'static str| {
        [
            "T1",
            "M6",
            "G43",
            "S500",
            "G0 X0 Y0 Z2",
            turn,
            "G33.1 Z-10 K0.75",
            "M5",
            "G0 Z20",
            "M2",
        ]
    };
    says(&tap(0.75), &lines("M3"));
    says(&tap(-0.75), &lines("M4"));
    says(
        "TOOL CALL 1 Z S500\nL Z+10 R0 FMAX\nCYCL DEF 18.0 THREAD CUTTING\nCYCL DEF 18.1 DEPTH -5\n\
         CYCL DEF 18.2 PITCH +1\nCYCL CALL\nL Z+20 FMAX",
        &[
            "T1",
            "M6",
            "G43",
            "S500",
            "G0 Z10",
            "M3",
            "G33 Z5 K1",
            "M5",
            "G0 Z20",
            "M2",
        ],
    );
}

#[test]
fn arcs_lie_in_their_planes_and_helices_have_turns() {
    says(
        "TOOL CALL 1 Y S500\nL X+0 Y+0 Z+0 R0 FMAX\nCC X+10 Z+0\nC X+10 Z+10 DR+ F200\nCP IPA-360 DR-\n\
         TOOL CALL 1 Z\nL X+0 Y+0 Z+0 FMAX\nCC X+5 Y+0\nCP IPA+1080 IZ-6 DR+ F300",
        &[
            "T1",
            "M6",
            "G43",
            "S500",
            "G0 X0 Y0 Z0",
            // From (Z 0, X 0) about (Z 0, X 10): a quarter.
            "G18 G3 X10 Z10 K0 I10 F200",
            "G2 X10 Z10 K-10 I0",
            "T1",
            "M6",
            "G43",
            "S500",
            "G0 X10 Y0",
            "Z10",
            "X0 Z0",
            "G17 G3 X0 Y0 Z-6 I5 J0 P3 F300",
            "M2",
        ],
    );
}

/// M00 of the control stops spindle and coolant; STOP alone does not.
#[test]
fn stops_dwells_and_angles() {
    says(
        "L X+0 R0 F500 M13\nL X+1 M0\nSTOP\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\nL C+90 F360\n\
         CYCL DEF 13.0 ORIENTATION\nCYCL DEF 13.1 ANGLE 45\nL X+2 M19",
        &[
            "M3",
            "M8",
            "G1 X0 F500",
            "X1",
            "M5",
            "M9",
            "M0",
            "M0",
            "G4 P1.5",
            "G0 X1",
            "G1 C90 F360",
            "X2",
            "M19 R45",
            "M2",
        ],
    );
}

#[test]
fn inches_are_g20_with_feeds_in_inches() {
    let source = program(
        "BEGIN PGM A INCH\nL X+1 Y+0.5 R0 F10\nL C+90\nEND PGM A INCH\n",
        Language::Plain,
    );
    let (made, proof) = gcode(&source, &settings(ControlModel::Tnc415b), &root());
    assert!(proof.holds(), "{proof:?}");
    assert!(made.text.contains("\nG20 "), "{}", made.text);
    assert!(made.text.contains("X1 Y0.5 F"), "{}", made.text);
}

#[test]
fn what_cannot_be_said_stops_the_program_or_ends_it() {
    let (text, refused) = lines("L X+0 R0 F500\nL X+1 M17\nL X+2");
    assert_eq!(refused, ["LinuxCNC has no M17: it belongs to the machine"]);
    // The function comes at the begin of its block.
    assert!(text.iter().any(|line| line.starts_with("(MSG,")) && text.contains(&"M0".to_owned()));
    assert_eq!(text.last().map(String::as_str), Some("M2"));
    for (blocks, why) in [
        (
            "TCH PROBE 0.0 REF. PLANE Q5 Z-\nTCH PROBE 0.1 X+5 Y+0 Z-5\nL X+2 F5",
            "probe",
        ),
        ("L X+0 R0 F500\nL Z+0 FMAX M91\nL X+1", "M91"),
        ("L X+0 R0 F500\nFN14: ERROR = 3\nL X+1", "ERROR 3"),
    ] {
        let (text, refused) = lines(blocks);
        assert!(
            refused.len() == 1 && refused[0].contains(why),
            "{blocks}: {refused:?} {text:?}"
        );
        assert!(text.ends_with(&["M0".to_owned(), "M2".to_owned()]), "{text:?}");
    }
}

/// What LinuxCNC does not know stops the program, or is a function of its user; what the path does not depend on is named.
#[test]
fn functions_of_the_machine_builder_may_be_those_of_the_user() {
    let source = program(
        "BEGIN PGM A MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+9 Y+9 Z+0\nL X+1 R0 F500 M61\nL X+2 M90\n\
         L X+3 M105\nL X+4 M17\nEND PGM A MM\n",
        Language::Plain,
    );
    let settings = settings(ControlModel::Tnc415b);
    let begin = || run(&source, &settings, &root());
    let stop = Arc::new(AtomicBool::new(false));
    for (user_functions, refused, written) in [(false, 2, "M0"), (true, 0, "M161")] {
        let options = linuxcnc::Options {
            model: settings.model,
            unit: source.unit(),
            comments: false,
            rapid_mm_min: 15_000.0,
            user_functions,
        };
        let made = linuxcnc::write(&begin, &options, &stop);
        assert_eq!(made.refused.len(), refused, "{:?}", made.refused);
        assert!(made.text.lines().any(|line| line == written), "{}", made.text);
        let proof = linuxcnc::prove(&begin, &made.text, "A.ngc", &options, &stop);
        assert!(proof.holds(), "{proof:?}");
        let left: Vec<&str> = made
            .left_out
            .iter()
            .filter_map(|of| of.reason.split([':', ',']).next())
            .collect();
        assert_eq!(left, ["the blank", "M90", "M105"]);
    }
}

/// The axes that a line names.
fn moves(line: &str) -> Vec<char> {
    let words = line.split_whitespace();
    let axes = words
        .filter_map(|word| word.chars().next())
        .filter(|c| "XYZABC".contains(*c));
    axes.collect()
}

/// A tool changer, an operator or a program M100 may leave the axes anywhere: every axis that the program has brought somewhere
/// is brought back by G0, with the tool axis last, or first where the path begins with its retraction.
#[test]
fn every_axis_is_brought_back_after_what_may_move_the_machine() {
    let begin = "TOOL CALL 1 Z S500\nL Z+50 R0 FMAX\nL X+10 Y+20 FMAX\nL Z-5 F200\n";
    let lines_after = |mark: &str, blocks: &str| {
        let (lines, _) = lines(&format!("{begin}{blocks}"));
        let at = lines.iter().rposition(|line| line == mark).unwrap();
        lines[at + 1..].to_vec()
    };
    // X alone moves: Y and Z as they stood, Z last.
    for (mark, blocks) in [
        ("S600", "L Z+50 FMAX\nTOOL CALL 2 Z S600\nL X+30 FMAX"),
        ("M0", "L Z+50 FMAX\nSTOP\nL X+30 FMAX"),
    ] {
        let after = lines_after(mark, blocks);
        assert_eq!(after, ["X10 Y20", "Z50", "X30", "M2"], "{blocks}");
    }
    // In the workpiece: up first, nothing goes down to where the tool was.
    let after = lines_after("S600", "TOOL CALL 2 Z S600\nL Z+50 FMAX\nL X+30 FMAX");
    assert_eq!(after, ["G0 Z50", "X10 Y20", "X30", "M2"]);
    let after = lines_after("S600", "TOOL CALL 2 Z S600\nL X+30 Z+50 FMAX");
    assert_eq!(after, ["G0 Z50", "X30 Y20", "M2"]);
    let after = lines_after("M0", "L Z+50 FMAX M17");
    assert_eq!(after, ["G0 Z50", "X10 Y20", "M2"]);
    // Up by feed is up by feed: after a stop the tool may stand where it was.
    let after = lines_after("M0", "STOP\nL Z+50 F300");
    assert_eq!(after, ["Z50 F300", "G0 X10 Y20", "M2"]);
}

/// A tool that is called before its M06 does not move the machine, but its tip is lifted out of the blank in a test run
/// (Z-310, where M91 has led, is below the top Z+0). The text brings the axis there before the path goes on.
#[test]
fn a_tool_call_before_its_m06_brings_the_tip_to_where_the_path_goes_on() {
    let source = program(
        "BEGIN PGM A MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 Z+0\nTOOL CALL 1 Z S1000\n\
         L Z-10 R0 FMAX M91\nM6\nTOOL CALL 2 Z S500\nL Z-10 R0 FMAX M91\nM6\nL X+5 Z+50 R0 FMAX\nEND PGM A MM\n",
        Language::Plain,
    );
    let mut settings = settings(ControlModel::Tnc415b);
    settings.rules.machine_zero[Axis::Z] = -300.0;
    let (made, proof) = gcode(&source, &settings, &root());
    assert!(proof.holds(), "{proof:?}\n{}", made.text);
    let bare = |line: &str| line.split(';').next().unwrap_or_default().trim().to_owned();
    let after = made.text.lines().map(bare).skip_while(|line| line != "T2");
    let expected = ["T2", "S500", "Z0", "Z-310", "M6", "G43", "Z50", "X5", "M2"];
    assert_eq!(after.collect::<Vec<_>>(), expected, "{}", made.text);
}

/// The axes stand at X0 Y0 before the start: a line says nothing of them until an arc counts its centre from there.
#[test]
fn an_arc_begins_where_the_text_has_brought_its_axes() {
    let source = program(
        "BEGIN PGM A MM\nCC X+20 Y+0\nL X+0 Y+0 R0 F100\nCP IPA+90 DR+ F100\nEND PGM A MM\n",
        Language::Plain,
    );
    let mut settings = settings(ControlModel::Tnc415b);
    settings.start[Axis::X] = 0.0;
    settings.start[Axis::Y] = 0.0;
    let (made, proof) = gcode(&source, &settings, &root());
    assert!(proof.holds(), "{proof:?}\n{}", made.text);
    let bare = |line: &str| line.split(';').next().unwrap_or_default().trim().to_owned();
    let lines: Vec<_> = made.text.lines().skip(4).map(bare).collect();
    // A quarter turn about X20 Y0 from its left side goes down.
    assert_eq!(
        lines,
        ["G0 X0 Y0", "G17 G3 X20 Y-20 I20 J0 F100", "M2"],
        "{}",
        made.text
    );
}

/// A line that leaves an axis out after a tool change is found: the machine stands elsewhere there.
#[test]
fn the_proof_finds_an_axis_that_is_left_out_after_a_tool_change() {
    let text =
        "TOOL CALL 1 Z S500\nL Z+50 R0 FMAX\nL X+10 Y+20 FMAX\nTOOL CALL 2 Z S600\nL X+30 F500\nL X+0 F500";
    let source = program(
        &format!("BEGIN PGM A MM\n{text}\nEND PGM A MM\n"),
        Language::Plain,
    );
    let settings = settings(ControlModel::Tnc415b);
    let (made, proof) = gcode(&source, &settings, &root());
    assert!(proof.holds(), "{proof:?}");
    let back = made.text.rfind("X10 Y20").unwrap();
    let mut without = made.text.clone();
    without.replace_range(back..back + "X10 Y20".len(), "X10");
    let begin = || run(&source, &settings, &root());
    let options = linuxcnc::Options {
        model: settings.model,
        unit: source.unit(),
        comments: true,
        rapid_mm_min: 15_000.0,
        user_functions: false,
    };
    let proof = linuxcnc::prove(
        &begin,
        &without,
        "A.ngc",
        &options,
        &Arc::new(AtomicBool::new(false)),
    );
    assert!(!proof.holds(), "{without}");
}

/// In all programs of the repository: between a tool change and the first cut every axis is said that was said before.
#[test]
fn no_program_of_the_repository_cuts_after_a_tool_change_with_an_axis_left_out() {
    let mut changes = 0;
    for file in programs("H") {
        let bytes = std::fs::read(&file).unwrap();
        let source = bahn_program::Program::from_bytes(file.to_string_lossy(), bytes);
        let folder = file.parent().unwrap();
        let (made, _) = gcode_with(&source, &self::settings(ControlModel::Tnc415b), folder, true);
        let (mut known, mut left) = (Vec::new(), Vec::new());
        let mut motion = "";
        for line in made
            .text
            .lines()
            .map(|line| line.split([';', '(']).next().unwrap().trim())
        {
            for word in ["G0", "G1", "G2", "G3", "G33", "G33.1"] {
                if line.split(' ').any(|of| of == word) {
                    motion = word;
                }
            }
            if line == "M6" {
                left = std::mem::take(&mut known);
                changes += usize::from(!left.is_empty());
            }
            let axes = moves(line);
            left.retain(|axis| !axes.contains(axis));
            // A retraction by feed alone moves the tool axis.
            let cuts = !axes.is_empty() && motion != "G0" && (axes.len() > 1 || axes[0] != 'Z');
            assert!(!cuts || left.is_empty(), "{}: {line}: {left:?}", file.display());
            for axis in axes {
                if !known.contains(&axis) {
                    known.push(axis);
                }
            }
        }
    }
    assert!(changes >= 9, "{changes}");
}
