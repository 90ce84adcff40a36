//! Plain lines, which take a short cut.

use super::support::{reader, run};

/// With G17 in it no block is plain: the path is the same.
#[test]
fn plain_lines_go_the_way_of_all() {
    let data = "P8818: 50\nP8160: 0\nP8000: 3\nP8892: 2\n";
    let plain = [
        "G1 X10 F1000",
        "X10 Y-2.5",
        "Y7",
        "G1 X-1.5 Y2 Z0.001 F50",
        "X3",
        "X3",
    ];
    for before in [
        "",
        "G91",
        "G44",
        "G92 X5",
        "G61",
        "G28",
        "G93",
        "P160:1 P163:30 G45",
    ] {
        let of = |more: &str| {
            let lines: String = plain.iter().map(|line| format!("{line}{more}\n")).collect();
            let ran = run(&mut reader(data, &format!("{before}\n{lines}")));
            assert_eq!(ran.fault, None, "{before}");
            ran.elements
        };
        assert_eq!(of(""), of(" G17"), "{before}");
    }
}
