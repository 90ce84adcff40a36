//! The tool changer macros that replace those of the TNC 355 [000:16299-16430].

use crate::common::{Bench, lines};

/// The macros 200, 210, 220 and 230; the main program calls the one of W0. Their commands are the
/// manual's: machines have them in their programs as they are printed.
fn bench() -> Bench {
    Bench::new(&lines(
        "L W0 | == K+200 | CMT 200 | L W0 | == K+210 | CMT 210
         L W0 | == K+220 | CMT 220 | L W0 | == K+230 | CMT 230 | EM
         LBL 200
         L W262 | B= M3024 | == K+0 | = M3043
         LB M3200 | = B255
         LB M3024 | > B255 | = M3044 | EM
         LBL 210
         LB M3200 | = B255
         LB M3032 | + K+1 | B= M3032 | <= B255 | JPT 211
         L K+1 | B= M3032
         LBL 211 | EM
         LBL 220
         LB M3200 | = B255
         LB M3032 | - K+1 | B= M3032 | > K+0 | JPT 221
         L B255 | B= M3032
         LBL 221 | EM
         LBL230
         LB M3032 | = B250
         LB M3024 | = B252
         LW M3200 | = W254
         L B250 | == B252 | = M3040 | JPT 231
         L B250 | - B252 | = B248 | > K+0 | JPT 232
         L- B248 | = B248
         LBL232
         L B255 | - B254 | <= B248 | O[ | L B248 | <= B254 | ] | = M3041
         L B255 | >> K+1 | = B255
         L B252 | > B250 | A[ | L B248 | <= B255 | ]
         O[ | L B252 | < B250 | A[ | L B248 | >= B255 | ] | ] | = M3042
         LBL231 | EM",
    ))
}

/// The lowest eight markers from a number on.
fn byte(bench: &Bench, first: u32) -> i64 {
    (0..8)
        .map(|bit| bench.get(&format!("M{}", first + bit)) << bit)
        .sum()
}

fn set_byte(bench: &mut Bench, first: u32, value: u32) {
    for bit in 0..8 {
        bench.set(&format!("M{}={}", first + bit, value >> bit & 1));
    }
}

#[test]
fn a_tool_number_becomes_binary() {
    // MP4310.3 = 10 pockets: T12 does not exist.
    for (tool, none, too_large) in [(12, 0, 1), (10, 0, 0), (0, 1, 0)] {
        let mut bench = bench();
        bench.set(&format!("W0=200 MP4310.3=10 W262={tool}"));
        bench.scans(1);
        assert_eq!(byte(&bench, 3024), tool);
        bench.expect(&format!("M3043={none} M3044={too_large}"));
    }
}

#[test]
fn the_actual_pocket_is_counted_up_and_down() {
    for (macro_number, actual, expected) in [(210, 12, 1), (210, 5, 6), (220, 1, 12), (220, 5, 4)] {
        let mut bench = bench();
        bench.set(&format!("W0={macro_number} MP4310.3=12"));
        set_byte(&mut bench, 3032, actual);
        bench.scans(1);
        assert_eq!(byte(&bench, 3032), expected, "{macro_number} from {actual}");
    }
}

#[test]
fn actual_and_nominal_pocket_are_compared() {
    // Computed by hand from the listing: equal, reduction reached, forward.
    for (actual, nominal, reduction, pockets, equal, others) in [
        (7, 7, 2, 12, 1, None),
        (11, 2, 2, 12, 0, Some((0, 1))),
        (2, 11, 2, 12, 0, Some((0, 0))),
        (3, 5, 2, 12, 0, Some((1, 1))),
        (5, 3, 1, 12, 0, Some((0, 0))),
        (1, 12, 2, 12, 0, Some((1, 0))),
    ] {
        let mut bench = bench();
        bench.set(&format!("W0=230 MP4310.3={}", reduction << 8 | pockets));
        set_byte(&mut bench, 3032, actual);
        set_byte(&mut bench, 3024, nominal);
        bench.scans(1);
        bench.expect(&format!("M3040={equal}"));
        if let Some((reached, forward)) = others {
            bench.expect(&format!("M3041={reached} M3042={forward}"));
        }
    }
}
