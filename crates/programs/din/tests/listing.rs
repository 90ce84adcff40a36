//! The listing of a program is the same program, tidily written, and its own listing.

mod support;

use std::sync::Arc;

use bahn_din::{Decoder, Program, Step};
use bahn_path::Position;
use bahn_text::MemoryFiles;
use proptest::prelude::*;
use proptest::sample::select;
use support::Bench;

fn listing(text: &str) -> String {
    Program::from_bytes("a.nc", text.as_bytes()).listing()
}

/// Everything that a text orders, up to its first fault.
fn ordered(text: &str) -> String {
    let program = Arc::new(Program::from_bytes("a.nc", text.as_bytes()));
    let mut reported = format!("{:?}\n", program.landmarks());
    for main in program.mains() {
        let beside = Arc::new(MemoryFiles::from([("sub", "N1 G91 X1 M7\nLL A\n")]));
        let mut decoder = Decoder::new(Arc::clone(&program), main, Position::ZERO, beside);
        let mut bench = Bench::default();
        for _ in 0..500 {
            let mut step = decoder.next(&mut bench);
            match &mut step {
                // Words have other columns in the listing.
                Step::Unit(unit) => unit.functions.iter_mut().for_each(|function| function.column = 0),
                Step::Fault(fault) => (fault.column, fault.length) = (0, 0),
                Step::End => {}
            }
            reported += &format!("{step:?}\n");
            if !matches!(step, Step::Unit(_)) {
                break;
            }
        }
        reported += &bench.log.join("\n");
    }
    reported
}

#[test]
fn words_are_a_blank_apart_and_in_capitals() {
    for (text, listed) in [
        ("n010g1x25.50y - 3f200", "N010 G1 X25.50 Y-3 F200"),
        ("  G01   X10 ( to (the end )  M3  ", "G01 X10 ( to (the end ) M3"),
        ("M52 = - 345 h5m [ p1 + 2 ]", "M52=-345 H5 M[P1+2]"),
        ("p1=567 p [ p1+1 ] = 3*sin [ 30 ]", "P1=567 P[P1+1]=3*SIN[30]"),
        (
            "x[ m54 = 567  h4 ]s2 [m3 rev 1000]",
            "X[M54=567 H4] S2[M3 REV1000]",
        ),
        (
            "X[indp g90 feed = 2000 POS= 555]",
            "X[INDP G90 FEED=2000 POS=555]",
        ),
        ("v.g.m_fct [ 25 ].synch=p1", "V.G.M_FCT[25].SYNCH = P1"),
        ("S[REV V.G.RW M3]", "S[REV V.G.RW M3]"),
        ("#flush   wait", "#FLUSH WAIT"),
        (
            "#channel  set  [m_pre_output e = 20 f=[5]  vector_limit_off]",
            "#CHANNEL SET [M_PRE_OUTPUT E=20 F=[5] VECTOR_LIMIT_OFF]",
        ),
        ("n5  l   Laser_on.sub  ; Calls  ", "N5 L Laser_on.sub ; Calls  "),
        ("x  1 (*  ab  ", "X1 (*  ab  "),
        ("(first)n10#flush", "(first) N10 #FLUSH"),
        ("N10 (only this)", "N10 (only this)"),
        ("H'16 # 1f'", "H'16#1F'"),
        (" \t \n", "\n"),
    ] {
        assert_eq!(listing(text), listed, "{text}");
        assert_eq!(listing(listed), listed);
        assert_eq!(ordered(text), ordered(listed), "{text}");
    }
}

#[test]
fn what_may_mean_something_else_stays() {
    for text in [
        "  ( a comment alone )",
        "%  Main  (head)",
        "%L  sub",
        "  x1  \"A\"  y2",
        "\"a\"  =  \"x1  y2\"",
        "x1   t12",
        "$if v.l.a < 3",
        "x (within) 5  y2",
        "#comment begin  x1\n  x1  y1\n  #comment end  y2",
        "N20:  x100",
        "(*  ab  ",
    ] {
        assert_eq!(listing(text), text);
    }
}

#[test]
fn bytes_and_endings_stay() {
    let written = |bytes: &[u8]| {
        let program = Program::from_bytes("a.nc", bytes);
        program.encoded(&program.listing())
    };
    assert_eq!(written(b"g1\r\nm3\rx1\n\n"), b"G1\r\nM3\rX1\n\n");
    assert_eq!(written(b"x1 ;H\xf6he\nx2"), b"X1 ;H\xf6he\nX2");
    assert_eq!(written("x1 ;Höhe".as_bytes()), "X1 ;Höhe".as_bytes());
    assert_eq!(written(b"\xef\xbb\xbf%1\nx1"), b"\xef\xbb\xbf%1\nX1");
    assert_eq!(written(b"x1\r \nx2 \r\n \r\n"), b"X1\r \nX2\r\n\r\n");
    // Without the blank of Latin-1 the rest would be UTF-8.
    assert_eq!(written(b"\xa0\nv\xcb\x99"), b"\xa0\nv\xcb\x99");
    assert_eq!(written(b"x1\xa0\n(\xcb\x99)  m3"), b"x1\xa0\n(\xcb\x99) M3");
    // A mark of byte order is no text.
    assert_eq!(Program::from_bytes("a.nc", b"\xef\xbb\xbf%1\nX1").faults(), []);
}

const PARTS: &[&str] = &[
    "n10",
    "N",
    "x",
    "Y-1.5",
    "Z[",
    "]",
    "[",
    "g00",
    "G01 f5",
    "g91",
    "G90",
    "f100",
    "i1",
    "M3",
    "m17",
    "h5=",
    "=",
    "-",
    "+",
    "*",
    "**",
    "p1",
    "p1 = 3",
    "p 1",
    "s",
    "s2[m3 rev 1000]",
    "s [ rev p1 ]",
    "x[m7 h3 = 2]",
    "x[indp g01 feed=5 pos=1]",
    "v.g.rw",
    "v . e . a = 3",
    "v.g.m_fct[3].synch = 4",
    "\"A\"",
    "\"A\"=\"X1\"",
    "#flush",
    "#flush  wait",
    "#expl syn",
    "#channel set [m_pre_output e=1]",
    "#vector limit on[vel=1 acc = p1]",
    "#comment begin",
    "#comment end",
    "$if",
    "(",
    ")",
    "(*",
    "*)",
    "; c",
    "'16#1f'",
    "'",
    "sin[30]",
    "exist[m3]",
    "l sub",
    "ll Sub",
    "%",
    "%l sub",
    "%main",
    "\n",
    "\r\n",
    "1",
    "99",
    ".",
    ":",
    "\\",
    "ä",
    "g4 p1",
    "g04 0.5",
];

fn text() -> impl Strategy<Value = String> {
    let part =
        (select(PARTS), 0..4usize).prop_map(|(part, blanks)| format!("{part}{}", " ".repeat(blanks / 2)));
    prop::collection::vec(part, 0..40).prop_map(|parts| parts.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn a_listing_is_the_same_program_and_its_own_listing(text in text()) {
        let listed = listing(&text);
        prop_assert_eq!(ordered(&listed), ordered(&text), "{}", listed);
        prop_assert_eq!(&listing(&listed), &listed);
    }

    #[test]
    fn a_listing_of_any_bytes_is_its_own(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let program = Program::from_bytes("a.nc", &bytes);
        let listed = program.encoded(&program.listing());
        let again = Program::from_bytes("a.nc", &listed);
        prop_assert_eq!(again.encoded(&again.listing()), listed);
    }
}
