use crate::desk::{Desk, value};

#[test]
fn m9070_copies_the_first_number() {
    let mut desk = Desk::new();
    // The number -12,5 is followed by the character with offset 9.
    desk.set_text(0, b"TEMP-12,5 GRAD 7");
    assert_eq!(desk.cyclic(9070, &[0, 1], 1), value(9));
    assert_eq!(desk.text(1), "-12,5");
    desk.set_text(2, b"A-B+3.X");
    assert_eq!(
        desk.cyclic(9070, &[2, 2], 1),
        value(5),
        "source and destination may be the same"
    );
    assert_eq!(desk.text(2), "+3");
    for wrong in [[4, 0], [0, 4], [-1, 0]] {
        assert_eq!(desk.cyclic(9070, &wrong, 1), (vec![0], true), "{wrong:?}");
    }
    desk.set_text(3, b"NO NUMBER");
    assert_eq!(desk.cyclic(9070, &[3, 1], 1), (vec![0], true));
    desk.set_text(3, &[b'1'; 79]);
    assert_eq!(desk.cyclic(9070, &[3, 1], 1), value(79));
    desk.set_text(3, &[b'1'; 80]);
    assert_eq!(desk.cyclic(9070, &[3, 1], 1), (vec![0], true), "longer than 79");
    assert_eq!(desk.endless_text(0).cyclic(9070, &[0, 1], 1), (vec![0], true));
}

#[test]
fn m9071_counts_characters() {
    let mut desk = Desk::new();
    desk.set_text(0, b"OIL");
    desk.set_text(1, &[b'X'; 127]);
    assert_eq!(desk.cyclic(9071, &[0], 1), value(3));
    assert_eq!(desk.cyclic(9071, &[1], 1), value(127));
    assert_eq!(desk.cyclic(9071, &[2], 1), value(0));
    assert_eq!(desk.cyclic(9071, &[4], 1), (vec![0], true));
    assert_eq!(desk.endless_text(3).cyclic(9071, &[3], 1), (vec![0], true));
}
