//! The normalised listing as the manual prints its examples.

use bahn_program::{FormatOptions, Program, format_program};

/// Each line as it is typed or found in a file, and as the listing shows it.
const LINES: &[(&str, &str)] = &[
    ("blk form 0.1.z x0 y0 z-20", "BLK FORM 0.1 Z X+0 Y+0 Z-20"),
    ("BLK FORM 0.2 IX100 IY100 Z0", "BLK FORM 0.2 IX+100 IY+100 Z+0"),
    ("TOOL DEF 5 L10 R5,500", "TOOL DEF 5 L+10 R+5.5"),
    ("TOOL DEF 5......next tool", "TOOL DEF 5"),
    ("TOOL CALL 5Z S 500", "TOOL CALL 5 Z S500"),
    ("TOOL CALL S1000", "TOOL CALL S1000"),
    ("TOOL CALL 1 Z DL+0.1 DR-.05", "TOOL CALL 1 Z DL+0.1 DR-0.05"),
    ("L X5 Y-10.50 R0 F100 M03", "L X+5 Y-10.5 R0 F100 M3"),
    (
        "L IX-50Y10Z-20RRF100M3 M8 ;  in",
        "L IX-50 Y+10 Z-20 RR F100 M3 M8 ; in",
    ),
    ("/ L X+Q1 Y-Q2 R F MAX M", "/ L X+Q1 Y-Q2 FMAX"),
    ("L 5.0", "L5"),
    ("CHF 5 F20", "L5 F20"),
    ("C IX+5 Y-5 DR-", "C IX+5 Y-5 DR-"),
    ("CR X10 Y2 R-5 DR-RL", "CR X+10 Y+2 R-5 DR- RL"),
    ("CT IX+50 IY-10 RR", "CT IX+50 IY-10 RR"),
    ("LP PR5 PA30", "LP PR+5 PA+30"),
    ("CP IPA1080 IZ5 DR-RL", "CP IPA+1080 IZ+5 DR- RL"),
    ("CTP PR10 PA80", "CTP PR+10 PA+80"),
    ("X20 R+ F100 M3", "X+20 R+ F100 M3"),
    ("CC", "CC"),
    ("CC X+20Y-10", "CC X+20 Y-10"),
    ("RND 10 F 100", "RND R10 F100"),
    ("STOPM6", "STOP M6"),
    ("M8", "M8"),
    ("M112 T0.01 A10", "M112 T0.01 A10"),
    ("LBL01", "LBL 1"),
    ("CALL LBL1 REP10 / 2", "CALL LBL 1 REP 10/10"),
    ("CALL LBL 1 REP", "CALL LBL 1"),
    ("CALL PGM  NAME", "CALL PGM NAME"),
    ("FN 0 : Q5=60", "FN0: Q5 = +60"),
    ("FN1: Q1 = Q2 + 5", "FN1: Q1 = +Q2 + +5"),
    ("FN4: Q4 = +8 / Q2", "FN4: Q4 = +8 DIV +Q2"),
    ("FN5: Q20 = SQRT 4", "FN5: Q20 = SQRT +4"),
    ("FN13: Q20=10 ANG-Q1", "FN13: Q20 = +10 ANG -Q1"),
    ("FN9: IF Q1 EQU Q3 GOTO LBL1", "FN9: IF +Q1 EQU +Q3 GOTO LBL 1"),
    ("FN14: ERROR=+254", "FN14: ERROR = 254"),
    ("FN15:PRINT 1/+Q1", "FN15: PRINT 1/Q1"),
    ("FN19: PLC=10/Q3", "FN19: PLC = +10/+Q3"),
    ("Q1=SIN30+((SQRT Q2))", "Q1 = SIN 30 + SQRT Q2"),
    ("Q1 = (1+2)*3-(4-5)", "Q1 = (1 + 2) * 3 - (4 - 5)"),
    ("CYCLE DEF1 .0 FORATURA  PROF.", "CYCL DEF 1.0 FORATURA PROF."),
    ("CYCL DEF 1.1 SETUP-2", "CYCL DEF 1.1 SETUP -2"),
    ("CYCL DEF 1.4 DWELL 0", "CYCL DEF 1.4 DWELL 0"),
    ("CYCL DEF 3.3 PECKG -5F80", "CYCL DEF 3.3 PECKG -5 F80"),
    ("CYCL DEF 4.6 F100DR+RADIUS0", "CYCL DEF 4.6 F100 DR+ RADIUS 0"),
    (
        "CYCL DEF 6.2 PECKG -8 F100 ALLOW 0",
        "CYCL DEF 6.2 PECKG -8 F100 ALLOW +0",
    ),
    ("CYCL DEF 8.1 XY", "CYCL DEF 8.1 X Y"),
    ("CYCL DEF 11.1 SCL 0.80", "CYCL DEF 11.1 SCL 0.8"),
    ("CYCL DEF 12.1 50", "CYCL DEF 12.1 PGM 50"),
    (
        "CYCL DEF 14.1 CONTOUR LABEL 1 / 2/3",
        "CYCL DEF 14.1 CONTOUR LABEL 1/2/3",
    ),
    ("CYCL DEF 68.1 Q1 = 8,000 Q2=-Q5", "CYCL DEF 68.1 Q1=+8 Q2=-Q5"),
    ("CYCL CALL M", "CYCL CALL"),
    (
        "TOUCH PROBE 0.0 REF. PLANE Q5 X-",
        "TCH PROBE 0.0 REF. PLANE Q5 X-",
    ),
    ("TCH PROBE 5.1 PGM NAME:5007", "TCH PROBE 5.1 PGM NAME: 5007"),
    ("TCH PROBE 7.2 ORDER Y-X+", "TCH PROBE 7.2 ORDER Y-/X+"),
    ("* - Finishing", "* - Finishing"),
    (";outside", "; outside"),
    ("APPR  LT X+5 ;c", "APPR  LT X+5 ;c"),
];

#[test]
fn lines_are_written_as_printed() {
    let text: String = LINES.iter().map(|(typed, _)| format!("{typed}\n")).collect();
    let program = Program::from_bytes("1.H", format!("BEGIN PGM 1 MM\n{text}END PGM 1 MM").into_bytes());
    let listing = format_program(&program, FormatOptions::default()).to_string();
    for (number, (line, (typed, printed))) in listing.lines().skip(1).zip(LINES).enumerate() {
        assert_eq!(line, format!("{} {printed}", number + 1), "{typed}");
    }
    assert_eq!(listing.lines().count(), LINES.len() + 2);
}

#[test]
fn the_decimal_comma_is_an_option() {
    let program = Program::from_bytes("1.H", b"CYCL DEF 11.1 SCL 0.8\nL X+2.5 F.5".to_vec());
    let listing = format_program(
        &program,
        FormatOptions {
            decimal_comma: true,
            ..FormatOptions::default()
        },
    )
    .to_string();
    assert_eq!(
        listing,
        "0 BEGIN PGM\n1 CYCL DEF 11.1 SCL 0,8\n2 L X+2,5 F0,5\n3 END PGM\n"
    );
}

#[test]
fn joined_lines_and_surrounding_text() {
    let text = "; by hand\n\nBEGIN PGM 1 MM\nCYCL DEF 200 DRILLING ~\n  Q200=2 ;SET-UP ~\n  Q201=-20 ;DEPTH\n\
                FN16: F ~\n  B\nEND PGM 1 MM\n rest\n";
    let program = Program::from_bytes("1.H", text.as_bytes().to_vec());
    assert_eq!(
        format_program(&program, FormatOptions::default()).to_string(),
        "; by hand\n\n0 BEGIN PGM 1 MM\n1 CYCL DEF 200 DRILLING Q200=+2 Q201=-20 ; SET-UP ; DEPTH\n\
         2 FN16: F ~\nB\n3 END PGM 1 MM\nrest\n"
    );
}
