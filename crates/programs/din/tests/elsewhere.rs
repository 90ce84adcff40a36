//! What programs of this dialect hold that the manual does not show: each is an error with its name, and what stands
//! beside it is read.

use bahn_din::Program;

fn reported(text: &str) -> Vec<String> {
    let faults = Program::from_bytes("a.nc", text.as_bytes()).faults();
    faults
        .into_iter()
        .map(|fault| format!("{}:{} {}", fault.span.line, fault.span.column, fault.message))
        .collect()
}

#[test]
fn what_the_manual_does_not_show_has_its_name() {
    for (text, name) in [
        ("#VAR", "unknown command #VAR"),
        ("N7 #ENDVAR", "unknown command #ENDVAR"),
        ("#MSG [\"at %f\", V.L.A]", "unknown command #MSG"),
        ("#RT CYCLE DELETE", "unknown command #RT CYCLE DELETE"),
        ("#WAIT SYN", "unknown command #WAIT SYN"),
        ("#SIGNAL SYN [ID1]", "unknown command #SIGNAL SYN"),
        ("#MC_MovePath SYN [ CH=1 ]", "unknown command #MC_MovePath SYN"),
        ("V.L.A = 1", "unknown variable V.L.A"),
        ("V.P.B[3][6] = 1", "unknown variable V.P.B[3][6]"),
        ("V.S.C[2] = 10", "unknown variable V.S.C[2]"),
        ("V.CYC.T = 1", "unknown variable V.CYC.T"),
        ("X1 YV.L.A", "unknown variable V.L.A"),
        ("P1 = V.G.WZ_AKT.R * 0.8", "unknown variable V.G.WZ_AKT.R"),
        ("N10 $IF P1 < 3", "unknown control statement $IF"),
        ("$ELSEIF P1", "unknown control statement $ELSEIF"),
        ("$FOR P1 = 0, 4, 1", "unknown control statement $FOR"),
        ("$SWITCH P1", "unknown control statement $SWITCH"),
        ("$GOTO N20", "unknown control statement $GOTO"),
        ("N20: X100", "unknown word N20: (a label)"),
        ("[PLACE] X0", "unknown word [PLACE]"),
        ("/N30 X5", "unknown word / (a block that may be skipped)"),
        ("L other.nc \\", "unknown word \\ after L other.nc"),
        ("L CYCLE [NAME=a.nc @P1=2]", "unknown word L CYCLE (a cycle)"),
        ("LL CYCLE[NAME=A]", "unknown word LL CYCLE (a cycle)"),
        ("@P51 = 3]", "unknown word @P51"),
        ("G90T12X20", "unknown word T12"),
        ("G90 A1 = 0", "unknown axis A1"),
        ("G0923", "unknown G function G0923"),
        ("N4 G23", "unknown G function G23"),
        (".....", "unknown word ....."),
        (":", "unknown word :"),
        ("N0 N1.....", "unknown word N1....."),
        ("words (more) of text", "unknown word words"),
        ("G1 XY", "unknown word XY"),
        ("…", "unknown word …"),
    ] {
        let [only] = &reported(text)[..] else {
            panic!("{text}: {:?}", reported(text))
        };
        let (_, message) = only.split_once(' ').unwrap_or_default();
        assert_eq!(message, name, "{text}");
    }
}

/// Heads with blanks, comments of several lines after a block's number, addresses with parameters as their values.
#[test]
fn what_the_manual_shows_is_read_in_other_clothes() {
    for text in [
        "%Part - one\nN10 G90 X1\nM30",
        "% Main\nN010 M30",
        "%L UP1           (1. local)\nN9 M17 (not needed)\n%MAIN            (main program)\nLL UP1 ; first\nN300 M30",
        "N100   #COMMENT BEGIN\n  V.P.A\nN120 #COMMENT END\nN130 ( alone )\nN140 ; alone",
        "#COMMENT BEGIN \nWith é and …\n#COMMENT END",
        "G01 X2 Y+0.0000 Z-2.0000 AP20 BP10+P20  C20 U10 V20 W1",
        "G02 XP10+P20 R5",
        "G01 X1 #COMMENT BEGIN\n no word\n #COMMENT END  F100",
    ] {
        assert_eq!(reported(text), [""; 0], "{text}");
    }
}
