use bahn_plc::{Bar, WindowView};

use crate::desk::{Desk, done, failed, value};

#[test]
fn m9080_deletes_the_window() {
    let mut desk = Desk::new();
    desk.set_text(0, b"OIL");
    desk.submit(9082, &[1, 0, 15, 0], 0);
    desk.submit(9083, &[0, 100, 50, 1, 2], 0);
    assert_eq!(desk.cyclic(9080, &[], 0), failed());
    assert_eq!(desk.nc.window.text(1).trim_end(), "OIL");
    assert_eq!(desk.submit(9080, &[], 0), done());
    assert_eq!(desk.nc.window.text(1), " ".repeat(38));
    assert_eq!(desk.nc.window.bar(0), None);
}

#[test]
fn m9081_tells_whether_the_window_shows() {
    let mut desk = Desk::new();
    assert_eq!(desk.cyclic(9081, &[], 1), value(0));
    desk.nc.window_view = WindowView {
        displayed: true,
        in_foreground: false,
    };
    assert_eq!(desk.cyclic(9081, &[], 1), value(1));
    desk.nc.window_view.in_foreground = true;
    assert_eq!(
        desk.set("M3171", 1).cyclic(9081, &[], 1),
        (vec![3], true),
        "M3171 stays"
    );
}

#[test]
fn m9082_shows_a_string() {
    let mut desk = Desk::new();
    desk.set_text(0, b"SPINDLE")
        .set_text(1, b"110 %")
        .set_text(2, b"A\xe4\x01B");
    assert_eq!(desk.submit(9082, &[0, 10, 0, 0], 0), done());
    assert_eq!(desk.submit(9082, &[0, 2, 11, 1], 0), done());
    assert_eq!(desk.nc.window.text(0).trim_end(), "  110 %   SPINDLE");
    // Colour 0 is that of the value to its left [000:15285].
    assert_eq!(desk.nc.window.line(0)[10].colour, 11);
    desk.submit(9082, &[0, 2, 15, 1], 0);
    assert_eq!(desk.nc.window.line(0)[10].colour, 15);
    assert_eq!(
        desk.submit(9082, &[1, 34, 15, 2], 0),
        done(),
        "the last four columns"
    );
    assert_eq!(desk.nc.window.text(1).trim_start(), "A^^B");
    let shown = desk.nc.window.clone();
    for wrong in [
        [2, 0, 1, 0],
        [-1, 0, 1, 0],
        [0, 38, 1, 0],
        [0, -1, 1, 0],
        [0, 0, 16, 0],
        [0, 0, -1, 0],
        [0, 0, 1, 4],
        [0, 32, 1, 0],
    ] {
        assert_eq!(desk.submit(9082, &wrong, 0), failed(), "{wrong:?}");
    }
    assert_eq!(desk.cyclic(9082, &[0, 0, 1, 0], 0), failed());
    assert_eq!(desk.endless_text(3).submit(9082, &[0, 0, 1, 3], 0), failed());
    assert_eq!(desk.nc.window, shown);
}

#[test]
fn m9082_replaces_references() {
    let mut desk = Desk::new();
    desk.nc.messages = vec!["OIL MISSING".to_owned()];
    desk.nc.dialogues = vec!["NO".to_owned(), "READY".to_owned()];
    desk.set_text(0, b"1 \x1aE000, \x1aD001 \x1aD002 \x1aX");
    assert_eq!(desk.submit(9082, &[0, 0, 12, 0], 0), done());
    assert_eq!(desk.nc.window.text(0).trim_end(), "1 OIL MISSING, READY @ ^X");
}

#[test]
fn m9083_shows_a_bar() {
    let mut desk = Desk::new();
    desk.set_text(0, b"LEFT").set_text(1, b"RIGHT");
    desk.submit(9082, &[1, 0, 1, 0], 0);
    desk.submit(9082, &[1, 19, 1, 1], 0);
    assert_eq!(desk.submit(9083, &[1, 100, 40, 11, 12], 0), done());
    assert_eq!(
        desk.nc.window.bar(1),
        Some(Bar {
            maximum: 100,
            current: 40,
            bar_colour: 11,
            scale_colour: 12
        })
    );
    assert_eq!(
        desk.nc.window.text(1).trim(),
        "RIGHT",
        "text shows in the right half only"
    );
    assert_eq!(desk.submit(9083, &[1, 500, 400, 11, 12], 0), done());
    let bar = desk.nc.window.bar(1).unwrap();
    assert_eq!((bar.maximum, bar.current), (150, 150), "both are limited");
    for wrong in [
        [2, 1, 1, 1, 1],
        [-1, 1, 1, 1, 1],
        [0, -1, 1, 1, 1],
        [0, 1, -1, 1, 1],
        [0, 1, 1, 16, 1],
        [0, 1, 1, 1, -1],
    ] {
        assert_eq!(desk.submit(9083, &wrong, 0), failed(), "{wrong:?}");
    }
    assert_eq!(desk.cyclic(9083, &[0, 1, 1, 1, 1], 0), failed());
}
