//! Random programs: to the other language and back they have the same operations and the same path.

use crate::support::*;
use bahn_convert::Language;
use bahn_interpreter::Settings;
use bahn_parameters::ControlModel;
use bahn_path::Axis;
use bahn_program::{CycleWord, Operation, Program};
use proptest::prelude::*;

const HEAD: &str = "BEGIN PGM A MM\nTOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S1000\nFN0: Q1 = +12.5\nCC X+20 Y+15\n\
                    L X+0 Y+0 Z+20 R0 F500 M3\n";
const TAIL: &str = "L Z+50 R0 FMAX M2\nLBL 1\nL IX+2.5 F300\nL IY+1\nLBL 0\nLBL 2\nL Z+2 FMAX\nLBL 0\n\
                    END PGM A MM\n";

fn coordinate() -> impl Strategy<Value = String> {
    (
        prop::sample::select(vec!["X", "Y", "Z", "IX", "IY", "IZ"]),
        prop_oneof![
            (-400_i32..400).prop_map(|n| format!("{:+}", f64::from(n) / 8.0)),
            Just("+Q1".to_owned())
        ],
    )
        .prop_map(|(axis, value)| format!("{axis}{value}"))
}

fn end() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => Just(String::new()),
        2 => Just(" FMAX".to_owned()),
        2 => (1_u32..2000).prop_map(|feed| format!(" F{feed}")),
        1 => Just(" M8".to_owned()),
        1 => Just(" FMAX M9".to_owned()),
    ]
}

/// One block, or a few that belong together, of plain language.
fn blocks() -> impl Strategy<Value = String> {
    let polar = || (-360_i32..360, prop::sample::select(vec!["PA", "IPA"]));
    prop_oneof![
        6 => (coordinate(), end()).prop_map(|(to, end)| format!("L {to}{end}")),
        2 => (polar(), 5_u32..40, end())
            .prop_map(|((angle, word), radius, end)| format!("LP PR+{radius} {word}{angle:+}{end}")),
        2 => (polar(), any::<bool>()).prop_map(|((angle, word), clockwise)| {
            format!("LP PR+10 PA+5 FMAX\nCP {word}{angle:+} DR{}", if clockwise { '-' } else { '+' })
        }),
        1 => (10_i32..60, any::<bool>()).prop_map(|(radius, clockwise)| {
            format!("L X+0 Y+0 F200\nCR X+10 Y+0 R{radius:+} DR{} F150", if clockwise { '-' } else { '+' })
        }),
        1 => Just("L X+0 Y+0 F300\nL X+10\nRND R2 F50\nL Y+10\nL3\nL X+30".to_owned()),
        1 => Just("CC".to_owned()),
        1 => (-30_i32..30).prop_map(|x| format!("CC X{x:+} IY+5")),
        1 => Just("CALL LBL 1 ; a call".to_owned()),
        1 => Just("CALL LBL 2".to_owned()),
        1 => Just("LBL 7\nL IX+1 F90\nCALL LBL 7 REP 2/2".to_owned()),
        1 => (1_u32..9).prop_map(|n| format!("FN1: Q1 = +Q1 + +{n}\nFN9: IF +Q1 EQU +0 GOTO LBL 1")),
        1 => (-20_i32..20).prop_map(|x| format!("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X{x:+}\nCYCL DEF 7.2 IY+1")),
        1 => (-90_i32..90).prop_map(|a| format!("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT{a:+}")),
        1 => Just("CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X".to_owned()),
        1 => Just("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.75".to_owned()),
        1 => Just("CYCL DEF 9.0 DWELL TIME ; wait\nCYCL DEF 9.1 DWELL 0.5".to_owned()),
        1 => Just("CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -9\nCYCL DEF 1.3 PECKG -4\n\
                   CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80\nL Z+2 FMAX M99".to_owned()),
        1 => Just("; only a comment".to_owned()),
        1 => Just("STOP M5".to_owned()),
        1 => Just("TOOL CALL 1 Z S800".to_owned()),
    ]
}

/// One block of DIN/ISO, which leaves to those before it what it does not say.
fn iso_blocks() -> impl Strategy<Value = String> {
    let words = prop::collection::vec((prop::sample::select(vec!["X", "Y", "Z"]), -300_i32..300), 1..3);
    let path = prop::sample::select(vec![
        "",
        "",
        "",
        "G00 ",
        "G01 ",
        "G90 ",
        "G91 ",
        "G00 G91 ",
        "G01 G90 G40 ",
    ]);
    prop_oneof![
        8 => (path, words, end()).prop_map(|(path, mut words, end)| {
            words.sort_unstable();
            words.dedup_by_key(|(axis, _)| *axis);
            let words: Vec<String> = words.iter().map(|(axis, n)| format!("{axis}{:+}", f64::from(*n) / 4.0)).collect();
            format!("{path}{}{}", words.join(" "), end.replace(" FMAX", ""))
        }),
        1 => (10_u32..200).prop_map(|feed| format!("F{feed}")),
        1 => Just("G91".to_owned()),
        1 => Just("G90 X+10 G91 Y+5".to_owned()),
        1 => Just("L1,0".to_owned()),
        1 => Just("L2,0".to_owned()),
        1 => Just("L3,0".to_owned()),
        1 => Just("G98 L7\nX+3\nL7,2".to_owned()),
        1 => Just("I+20 J+15\nG11 R+10 H+30 F200\nG91 H+15\nG13 G90 H+200\nG01".to_owned()),
        1 => Just("T1 G17 S900 G00 Z+30 M3".to_owned()),
        1 => Just("D01 Q1 P01 +Q1 P02 +1\nD11 P01 +Q1 P02 +40 P03 5".to_owned()),
        1 => Just("G54 G90 X+5 G91 Y+1".to_owned()),
        1 => Just("G73 G90 H+20".to_owned()),
        1 => Just("M8".to_owned()),
    ]
}

const ISO_HEAD: &str = "%A G71 *\nG99 T1 L+0 R+3 *\nT1 G17 S1000 *\nG01 G40 G90 X+0 Y+0 Z+20 F500 M3 *\n";
/// Subprograms that say G functions, that say none, and that change them.
const ISO_TAIL: &str = "G98 L5 *\nG00 G40 G90 Z+50 M2 *\nG98 L1 *\nG01 X+5 *\nG98 L0 *\nG98 L2 *\nM9 *\nG98 L0 *\n\
                        G98 L3 *\nG00 G91 Z+1 *\nL2,0 *\nG98 L0 *\nN99999 %A G71 *\n";

/// The operations of a program without the names beside the words of cycles, and without its frame.
fn operations(program: &Program) -> Vec<Operation> {
    let bare = |operation: Operation| match operation {
        Operation::Cycle(mut block) => {
            block.words.retain(|word| !matches!(word, CycleWord::Text(_)));
            Operation::Cycle(block)
        }
        other => other,
    };
    program
        .blocks()
        .map(|numbered| bare(numbered.block.operation))
        .collect()
}

/// Blocks that go to places of the machine, and what stands between those: tools, datum shifts, stops.
fn machine_blocks() -> impl Strategy<Value = String> {
    let axis = || prop::sample::select(vec!["X", "Y", "Z", "IX", "IZ", "C"]);
    let place = || prop::sample::select(vec!["M91", "M92"]);
    prop_oneof![
        3 => place().prop_map(|place| format!("L Z-10 R0 FMAX {place}")),
        3 => (axis(), -200_i32..200, place()).prop_map(|(axis, to, place)| format!("L {axis}{to:+} R0 FMAX {place}")),
        3 => (axis(), -50_i32..100).prop_map(|(axis, to)| format!("L {axis}{to:+} R0 F300")),
        2 => (1_u32..4, prop::sample::select(vec!["Z", "Z", "Z", "X"]), 0_u32..2)
            .prop_map(|(tool, axis, speed)| format!("TOOL CALL {tool} {axis} S{}", 500 * speed)),
        1 => prop::sample::select(vec!["M6", "STOP", "M0", "M1", "L Z+100 R0 FMAX M6"]).prop_map(str::to_owned),
        1 => (-60_i32..60).prop_map(|z| format!("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 Z{z:+}\nCYCL DEF 7.2 X+5")),
        1 => (0_i32..90).prop_map(|angle| format!("CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT{angle:+}")),
        1 => Just("CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X".to_owned()),
        1 => Just("CC X+20 Y+0\nL X+0 Y+0 R0 F100\nCP IPA+90 DR+ F100".to_owned()),
        1 => Just("CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2\nCYCL DEF 1.2 DEPTH -9\nCYCL DEF 1.3 PECKG -4\n\
                   CYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F80\nL Z+2 FMAX M99".to_owned()),
    ]
}

/// Where the workpiece lies, where the tip stands after a tool change, and where the axes stand before the start.
fn machine_settings() -> impl Strategy<Value = Settings> {
    let models = prop::sample::select(vec![
        ControlModel::Tnc155,
        ControlModel::Tnc360,
        ControlModel::Tnc407,
        ControlModel::Tnc415b,
    ]);
    let place = |z: f64| prop::sample::select(vec![f64::NAN, 0.0, z]);
    (
        models,
        place(-300.0),
        place(-80.0),
        place(200.0),
        place(40.0),
        place(15.0),
    )
        .prop_map(|(model, zero_z, zero_x, change_z, start_z, start_y)| {
            let mut settings = settings(model);
            settings.rules.machine_zero[Axis::X] = zero_x;
            settings.rules.machine_zero[Axis::Z] = zero_z;
            settings.tool_change[Axis::Z] = change_z;
            settings.start[Axis::Z] = start_z;
            settings.start[Axis::Y] = start_y;
            settings
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn plain_language_comes_back_as_it_was(parts in prop::collection::vec(blocks(), 1..25)) {
        let source = program(&format!("{HEAD}{}\n{TAIL}", parts.join("\n")), Language::Plain);
        let (made, iso) = converted(&source, Language::Iso);
        prop_assert!(made.refused.is_empty(), "{:?}", made.refused);
        let (back, plain) = converted(&iso, Language::Plain);
        prop_assert!(back.refused.is_empty(), "{:?}\n{}", back.refused, made.text);
        prop_assert_eq!(operations(&plain), operations(&source), "{}", made.text);
        let settings = settings(ControlModel::Tnc415b);
        let proof = proof(&source, &iso, &settings, &root());
        prop_assert!(proof.holds(), "{:?}\n{}", proof, made.text);
    }

    /// What depends on where a block is reached from may be refused; what is not refused moves the same.
    #[test]
    fn functions_in_force_are_put_in_where_they_are(parts in prop::collection::vec(iso_blocks(), 1..25)) {
        let lines: String = parts.iter().flat_map(|part| part.lines()).map(|line| format!("{line} *\n")).collect();
        let source = program(&format!("{ISO_HEAD}{lines}{ISO_TAIL}"), Language::Iso);
        let (made, plain) = converted(&source, Language::Plain);
        let settings = settings(ControlModel::Tnc415b);
        let proof = proof(&source, &plain, &settings, &root());
        let differs = proof.first_difference.as_ref().map_or("", |of| of.target.text.as_str());
        let at_refused = differs.contains("ERROR =") && !made.refused.is_empty();
        prop_assert!(proof.holds() || at_refused, "{:?}\n{}\n{}", proof, lines, made.text);
    }

    /// The reader of G-code finds the same path as the run.
    #[test]
    fn gcode_has_the_path_of_the_run(parts in prop::collection::vec(blocks(), 1..25)) {
        let source = program(&format!("{HEAD}{}\n{TAIL}", parts.join("\n")), Language::Plain);
        let (made, proof) = gcode(&source, &settings(ControlModel::Tnc415b), &root());
        prop_assert!(proof.holds(), "{:?}\n{}", proof, made.text);
    }

    /// Places of the machine, tools with and without M06, shifts and lengths: in DIN/ISO, and as G-code.
    #[test]
    fn places_of_the_machine_stay_where_they_are(
        parts in prop::collection::vec(machine_blocks(), 1..16),
        settings in machine_settings(),
        blank in any::<bool>(),
        inches in any::<bool>(),
    ) {
        let unit = if inches { "INCH" } else { "MM" };
        let blank = if blank { "BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 Z+0\n" } else { "" };
        let tools = "TOOL DEF 1 L+42 R+5\nTOOL DEF 2 L+6.5 R+3\nTOOL DEF 3 L+0 R+1\n";
        let text = format!("BEGIN PGM A {unit}\n{blank}{tools}{}\nEND PGM A {unit}\n", parts.join("\n"));
        let source = program(&text, Language::Plain);
        let (made, found) = gcode(&source, &settings, &root());
        prop_assert!(found.holds(), "{:?}\n{}\n{}", found, text, made.text);
        let (made, iso) = converted(&source, Language::Iso);
        prop_assert!(made.refused.is_empty(), "{:?}", made.refused);
        let found = proof(&source, &iso, &settings, &root());
        prop_assert!(found.holds(), "{:?}\n{}\n{}", found, text, made.text);
    }
}
