//! What DIN/ISO has no blocks for is said by its path; what no path says is refused.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::support::*;
use bahn_convert::{Language, prove_unrolled, unroll};
use bahn_parameters::ControlModel;
use bahn_program::Program;

const HEAD: &str = "BEGIN PGM A MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 Z+0\nTOOL DEF 1 L+0 R+5\n\
                    TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+2 R0 FMAX M3\n";

/// The path of a program in DIN/ISO, proved.
fn unrolled(blocks: &str) -> Result<(String, u64), String> {
    let source = program(&format!("{HEAD}{blocks}END PGM A MM\n"), Language::Plain);
    let settings = settings(ControlModel::Tnc415b);
    let stop = Arc::new(AtomicBool::new(false));
    let begin = |program: &Program| run(program, &settings, &root());
    let plain = unroll(begin(&source), settings.model, true, &stop)?;
    let plain = program(&plain, Language::Plain);
    let (made, iso) = converted(&plain, Language::Iso);
    assert!(made.refused.is_empty(), "{:?}", made.refused);
    let proof = prove_unrolled(begin(&source), begin(&iso), settings.model, &stop);
    assert!(proof.holds(), "{proof:?}\n{}", made.text);
    Ok((made.text, proof.elements))
}

#[test]
fn scaling_of_single_axes_becomes_the_scaled_path() {
    let blocks = "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.5 Y0.5\nL Z-5 F200\nL X+10 F400\n\
                  L Y+10 M8\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.5\nL X+0 Y+0 FMAX\n";
    let source = program(&format!("{HEAD}{blocks}END PGM A MM\n"), Language::Plain);
    let (made, _) = converted(&source, Language::Iso);
    let reasons: Vec<&str> = made.refused.iter().map(|listed| listed.reason.as_str()).collect();
    assert_eq!(
        reasons,
        ["no G function defines cycle 26 AXIS-SPEC. SCALING with these words"]
    );
    assert!(made.text.contains("ERROR = CYCL DEF 26.0"), "{}", made.text);

    let (text, elements) = unrolled(blocks).unwrap();
    // 1.5 times 10 and half of 10.
    assert!(text.contains("G01 G40 G90 X+15 F400"), "{text}");
    assert!(text.contains("Y+5 F400 M8"), "{text}");
    assert!(text.contains("G04 F0.5"), "{text}");
    assert_eq!(elements, 5);
}

#[test]
fn lines_with_normals_arcs_and_helices_are_unrolled() {
    let blocks = "L X+20 Y+20 RL F300\nL X+60\nRND R5\nL Y+60\nL X-10 Y-10 R0 FMAX\nCC X+50 Y+50\n\
                  LP PR+20 PA+0 F100\nCP IPA+1080 IZ-6 DR+\nCP IPA-360 DR-\n";
    let (text, elements) = unrolled(blocks).unwrap();
    assert!(text.contains("G13 G91 Z-6") || text.contains("H+1080"), "{text}");
    assert!(elements >= 8);
}

#[test]
fn what_no_path_says_is_refused() {
    for (blocks, why) in [
        (
            "TCH PROBE 0.0 REF. PLANE Q5 Z-\nTCH PROBE 0.1 X+5 Y+0 Z-5\n",
            "probe",
        ),
        ("FN14: ERROR = 12\n", "ERROR 12"),
        (
            "L X+0 Y+0 F200 M112 T0.1\nL X+10 Z+4\nL Y+10 Z+6\nL X+0\n",
            "M112",
        ),
    ] {
        let refused = unrolled(blocks).unwrap_err();
        assert!(refused.contains(why), "{refused}");
    }
}

/// Both warn of a tool without data and of a sign; one that warns of more is not the same.
#[test]
fn warnings_are_compared() {
    let cycle = |setup: &str, depth: &str| {
        format!(
            "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP {setup}\nCYCL DEF 1.2 DEPTH {depth}\nCYCL DEF 1.3 PECKG -5\n\
             CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F100\n"
        )
    };
    let text = format!("{HEAD}TOOL CALL 9 Z S500\n{}END PGM A MM\n", cycle("+2", "-10"));
    let source = program(&text, Language::Plain);
    let (_, iso) = converted(&source, Language::Iso);
    let settings = settings(ControlModel::Tnc415b);
    let same = proof(&source, &iso, &settings, &root());
    assert!(same.holds(), "{same:?}");
    let defined = text.replace("TOOL CALL 9", "TOOL DEF 9 L+0 R+0\nTOOL CALL 9");
    let defined = program(&defined, Language::Plain);
    let other = proof(&source, &defined, &settings, &root());
    assert!(
        same.warnings > other.warnings && !other.holds(),
        "{same:?} {other:?}"
    );
    let difference = other.first_difference.unwrap();
    assert!(
        difference.what.contains("tool 9 is not defined")
            && difference.what.contains("0 times in the target"),
        "{difference:?}"
    );
    assert_eq!((difference.source.block, difference.target.block), (6, 0));
}

/// Taps that follow the spindle are the same from where the tool stands, scaled or not, up or down, left or right.
#[test]
fn taps_that_follow_the_spindle_become_cycles_of_their_path() {
    for (pitch, depth) in [("+1.5", "-10"), ("-0.75", "-10"), ("+1.5", "+10")] {
        for scaled in ["", "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.5 Z0.5\n"] {
            let setup = depth.replace("10", "2");
            let (text, elements) = unrolled(&format!(
                "{scaled}CYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP {setup}\nCYCL DEF 17.2 DEPTH {depth}\n\
                 CYCL DEF 17.3 PITCH {pitch}\nL X+10 Y+10 FMAX M99\nCYCL DEF 18.0 THREAD CUTTING\n\
                 CYCL DEF 18.1 DEPTH {depth}\nCYCL DEF 18.2 PITCH {pitch}\nCYCL CALL\nL Z+20 FMAX\n"
            ))
            .unwrap();
            assert!(text.contains("G85 ") && text.contains("G86 "), "{text}");
            // To the first place and over the hole, in and out, the cut, and away.
            assert_eq!(elements, 6, "{text}");
        }
    }
}

/// A tap with a floating holder is the same from where the tool stands: the plunge, the spindle back, the dwell and the retraction,
/// whichever way the spindle turns, scaled or not.
#[test]
fn taps_with_a_floating_holder_become_cycles_of_their_path() {
    for (turn, depth, dwell) in [("M3", "-10", "0.5"), ("M4", "-10", "0"), ("M3", "+10", "0")] {
        for scaled in ["", "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X1.5 Z0.5\n"] {
            let setup = depth.replace("10", "2");
            let (text, elements) = unrolled(&format!(
                "{scaled}CYCL DEF 2.0 TAPPING\nCYCL DEF 2.1 SET UP {setup}\nCYCL DEF 2.2 DEPTH {depth}\n\
                 CYCL DEF 2.3 DWELL {dwell}\nCYCL DEF 2.4 F500\nL X+10 Y+10 FMAX {turn}\nCYCL CALL\nL X+20 FMAX M99\n\
                 L Z+20 FMAX\n"
            ))
            .unwrap();
            let pause = format!("P03 {dwell} P04 500");
            assert!(text.contains("G84 P01 ") && text.contains(&pause), "{text}");
            // To the first place and over both holes, in and out of each, and away.
            assert_eq!(elements, 8, "{text}");
        }
    }
}

/// What is unrolled may lose a warning of words that are gone; one that only the target gives is a difference.
#[test]
fn a_warning_of_the_target_alone_is_a_difference() {
    let source = program(&format!("{HEAD}L X+10 F200\nEND PGM A MM\n"), Language::Plain);
    let blank = "BLK FORM 0.1 Z X+0 Y+0 Z-20\nEND PGM A MM\n";
    let other = program(&format!("{HEAD}L X+10 F200\n{blank}"), Language::Plain);
    let settings = settings(ControlModel::Tnc415b);
    let stop = Arc::new(AtomicBool::new(false));
    let prove = |one: &Program, other: &Program| {
        let (one, other) = (run(one, &settings, &root()), run(other, &settings, &root()));
        prove_unrolled(one, other, settings.model, &stop)
    };
    let loses = prove(&other, &source);
    assert!(loses.holds() && loses.warnings == 0, "{loses:?}");
    let both = prove(&other, &other);
    assert!(both.holds() && both.warnings == 1, "{both:?}");
    let gains = prove(&source, &other);
    let difference = gains.first_difference.unwrap().what;
    assert!(difference.contains("BLK FORM 0.2 is missing"), "{difference}");
}
