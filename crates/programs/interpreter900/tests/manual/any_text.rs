//! Whatever a text says, it ends: with its end, a fault or a stop, and the path hangs together.

use bahn_path::{Axis, ElementSource, LiveData, Position, Step};
use proptest::prelude::*;

use crate::support::reader;

/// Blocks that mean something, and some that do not.
fn block() -> impl Strategy<Value = String> {
    let number = || -999i32..999;
    prop_oneof![
        (number(), number()).prop_map(|(x, y)| format!("G1 X{x} Y{y} F500")),
        (number(), number(), number()).prop_map(|(x, y, i)| format!("G2 X{x} Y{y} I{i}")),
        (number(), number()).prop_map(|(x, r)| format!("G3 X{x} R{r}")),
        (0u16..200).prop_map(|g| format!("G{g} X1")),
        (0u16..1000).prop_map(|m| format!("M{m}")),
        (0u32..40_000, number()).prop_map(|(p, value)| format!("P{p}:{value}")),
        (0u32..12, 1u32..20).prop_map(|(p, target)| format!("P{p}<3.{target}")),
        (1u32..20, 0u32..9).prop_map(|(target, count)| format!("M24.{target}.{count}")),
        number().prop_map(|value| format!("G91 Z{value}")),
        "[ -~]{0,20}",
    ]
}

proptest! {
    #[test]
    fn any_text_ends(blocks in prop::collection::vec(block(), 1..20)) {
        let mut text = String::new();
        for (number, block) in (1..).zip(&blocks) {
            text.push_str(&format!("N{number} {block}\n"));
        }
        let mut reader = reader("P32: 100\nP33: -5\nP36: 2\n", &text);
        let mut place: Option<Position> = None;
        for _ in 0..2_000 {
            match reader.next() {
                Step::Element(element) => {
                    if let Some(place) = place {
                        for axis in Axis::ALL {
                            prop_assert_eq!(place[axis], element.start[axis]);
                        }
                    }
                    prop_assert!(Axis::ALL.iter().all(|axis| element.end[*axis].is_finite()));
                    place = Some(element.end);
                }
                Step::Barrier(_) => reader.resume(LiveData::default()),
                Step::End | Step::Error(_) => return Ok(()),
                Step::Starved => prop_assert!(false, "starved"),
            }
        }
    }
}
