//! The words of a line by their kind.

use bahn_din::{SpanKind, words};

fn marked(line: &str) -> Vec<(&str, SpanKind)> {
    let of = |column: u32, length: u32| {
        let start = column as usize - 1;
        line.get(start..start + length as usize).unwrap_or_default()
    };
    words(line)
        .into_iter()
        .map(|span| (of(span.column, span.length), span.kind))
        .collect()
}

#[test]
fn every_kind_of_word() {
    use SpanKind::*;
    let line = "N10 G01 X-1.5 XP1 M52=P2 ; off";
    let expected = [
        ("N10", Number),
        ("G01", Function),
        ("X", Address),
        ("1.5", Value),
        ("X", Address),
        ("P1", Variable),
        ("M52", Function),
        ("P2", Variable),
        ("; off", Comment),
    ];
    assert_eq!(marked(line), expected);
    assert_eq!(marked("  % MAIN (part)"), [("% MAIN", Head), ("(part)", Comment)]);
    assert_eq!(
        marked("N400#FLUSH WAIT"),
        [("N400", Number), ("#FLUSH WAIT", Command)]
    );
    assert_eq!(
        marked("V.G.M_FCT[11].SYNCH = \"MOS\""),
        [("V.G.M_FCT[11].SYNCH", Variable), ("\"MOS\"", Text)]
    );
    assert_eq!(
        marked("S[REV 1000 M03] Y=SIN[30] $IF"),
        [
            ("S", Address),
            ("REV", Address),
            ("1000", Value),
            ("M03", Function),
            ("Y", Address),
            ("SIN", Calculation),
            ("30", Value),
            ("$IF", Command),
        ]
    );
    assert_eq!(marked(" (* all *) "), [("(* all *)", Comment)]);
}
