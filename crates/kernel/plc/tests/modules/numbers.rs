use crate::desk::{Desk, done, failed};

/// The manual's examples [000:15051-15064].
#[test]
fn m9050_writes_the_shortest_decimal() {
    let mut desk = Desk::new();
    desk.parameter("7280=1");
    let examples = [
        (123, 0, "123"),
        (-123, 0, "-123"),
        (123, 2, "12300"),
        (123, -3, "0.123"),
        (123_456, -3, "123.456"),
        (123, -5, "0.00123"),
        (100, -3, "0.1"),
        (1_234_567_890, -11, "0.0123456789"),
        (123_456_789, 1, "1234567890"),
        (0, 500, "0"),
        (i32::MIN, 0, "-2147483648"),
    ];
    for (mantissa, exponent, text) in examples {
        assert_eq!(desk.cyclic(9050, &[mantissa, exponent, 2], 0), done(), "{text}");
        assert_eq!(desk.text(2), text);
    }
    desk.set_text(2, b"OLD");
    for (mantissa, exponent) in [(123, -11), (123, 8), (1, i32::MAX), (1, i32::MIN)] {
        assert_eq!(desk.cyclic(9050, &[mantissa, exponent, 2], 0), failed());
    }
    assert_eq!(desk.cyclic(9050, &[1, 0, 4], 0), failed());
    assert_eq!(desk.cyclic(9050, &[1, 0, -1], 0), failed());
    assert_eq!(desk.text(2), "OLD");
    desk.parameter("7280=0");
    desk.cyclic(9050, &[-1500, -3, 0], 0);
    assert_eq!(desk.text(0), "-1,5");
}

/// The manual's examples with the blanks that the format makes [000:15108-15120].
#[test]
fn m9051_writes_a_format() {
    let mut desk = Desk::new();
    desk.parameter("7280=1");
    let examples = [
        (123, 0, 3, 0, "123"),
        (123, 0, 3, 2, "1.23"),
        (123, 8, 3, 2, "+1.23"),
        (123, 9, 3, 2, "+  1.23"),
        (123, 10, 3, 2, "  +1.23"),
        (2540, 0, 3, 1, "254.0"),
        (2540, 4, 3, 1, "10.0"),
        (1000, 9, 3, 3, "+  1.000"),
        (-1000, 9, 3, 3, "-  1.000"),
        (123_456, 0, 3, 0, "456"),
        // Without sign the absolute value; places after the point are always written.
        (-7, 0, 2, 2, "0.07"),
        (5, 2, 3, 0, "  5"),
    ];
    for (value, mode, before, after, text) in examples {
        let arguments = [value, mode, after, before, 1];
        assert_eq!(desk.cyclic(9051, &arguments, 0), done(), "{arguments:?}");
        assert_eq!(desk.text(1), text, "{arguments:?}");
    }
    // Format 11, 17 places, no place before the point, string 4.
    for wrong in [
        [1, 3, 0, 3, 1],
        [1, 0, 8, 9, 1],
        [1, 0, 2, 0, 1],
        [1, 0, -1, 3, 1],
        [1, 0, 0, 3, 4],
    ] {
        assert_eq!(desk.cyclic(9051, &wrong, 0), failed(), "{wrong:?}");
    }
    assert_eq!(
        desk.cyclic(9051, &[1, 10, 8, 8, 1], 0),
        done(),
        "16 places are allowed"
    );
}

#[test]
fn m9052_reads_a_decimal() {
    let mut desk = Desk::new();
    let examples = [
        ("123", 123, 0),
        ("-12,5", -125, -1),
        ("+0.0010", 10, -4),
        (" 7 ", 7, 0),
        ("2147483647", i32::MAX, 0),
        ("-2147483648", i32::MIN, 0),
        // One place too many: it is omitted, and the exponent corrected.
        ("21474836470", i32::MAX, 1),
    ];
    for (text, mantissa, exponent) in examples {
        desk.set_text(3, text.as_bytes());
        assert_eq!(
            desk.cyclic(9052, &[3], 2),
            (vec![mantissa, exponent], false),
            "{text}"
        );
    }
    // 3.1415926535: ten digits would be 3141592653, more than 2147483647; nine remain, eight after the point.
    desk.set_text(3, b"3.1415926535");
    assert_eq!(desk.cyclic(9052, &[3], 2), (vec![314_159_265, -8], false));
    for text in ["", "ABC", "1.2.3", "12X", "-", ".5"] {
        desk.set_text(3, text.as_bytes());
        assert_eq!(desk.cyclic(9052, &[3], 2), (vec![0, 0], true), "{text}");
    }
    assert!(desk.cyclic(9052, &[4], 2).1);
    assert!(desk.endless_text(3).cyclic(9052, &[3], 2).1);
}

#[test]
fn m9053_writes_hexadecimal() {
    let mut desk = Desk::new();
    desk.set("B0", 99).set("B1", -6);
    assert_eq!(desk.cyclic(9053, &[0, 0, 1], 0), done());
    assert_eq!(desk.text(0), "63", "99 = 63h");
    assert_eq!(desk.cyclic(9053, &[0, 1, 2], 0), done());
    assert_eq!(desk.text(1), "63FA");
    assert_eq!(desk.cyclic(9053, &[1023, 1, 1], 0), done());
    assert_eq!(desk.cyclic(9053, &[0, 1, 63], 0), done(), "126 characters");
    for wrong in [
        [1024, 0, 1],
        [-1, 0, 1],
        [1023, 0, 2],
        [0, 4, 1],
        [0, 0, 64],
        [0, 0, -1],
    ] {
        assert_eq!(desk.cyclic(9053, &wrong, 0), failed(), "{wrong:?}");
    }
}

#[test]
fn m9054_reads_hexadecimal() {
    let mut desk = Desk::new();
    desk.set_text(0, b"63FA");
    assert_eq!(desk.cyclic(9054, &[0, 100], 0), done());
    assert_eq!((desk.get("B100"), desk.get("B101")), (99, -6));
    assert_eq!(desk.cyclic(9054, &[0, 1022], 0), done());
    for wrong in [[4, 0], [0, 1024], [0, -1], [0, 1023]] {
        assert_eq!(desk.cyclic(9054, &wrong, 0), failed(), "{wrong:?}");
    }
    for text in ["6G", "63F", "fa", "-1"] {
        desk.set_text(0, text.as_bytes());
        assert_eq!(desk.cyclic(9054, &[0, 100], 0), failed(), "{text}");
    }
    assert_eq!(desk.get("B100"), 99, "nothing was written");
    assert_eq!(desk.endless_text(1).cyclic(9054, &[1, 0], 0), failed());
}
