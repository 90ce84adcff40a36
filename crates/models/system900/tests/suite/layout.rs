//! Zero points, tools and M functions: where the manual prints them.

use bahn_system900::{Acts, DataFile, MFunction, Tools, ZeroPoints, m_number};

fn file(lines: &str) -> DataFile {
    let blocks = "q102: 10000\nq103: 5000\nq104: 18000\nq105: 2000\n";
    let file = DataFile::read(format!("{blocks}{lines}").as_bytes());
    assert_eq!(file.faults(), []);
    file
}

fn zero_points(numbers: &str) -> ZeroPoints {
    let lines = (170..).zip(numbers.split(' '));
    let lines: String = lines.map(|(q, value)| format!("q{q}: {value}\n")).collect();
    ZeroPoints::of(file(&lines).memory(), 1)
}

/// The cell of a table of the manual: work area, point, group, axis.
fn p(points: &ZeroPoints, area: u32, point: &str, group: u32, axis: u32) -> u32 {
    let is_meant = |cell: &&bahn_system900::ZeroPoint| {
        (cell.area, cell.point.as_str(), cell.group, cell.axis) == (area, point, group, axis)
    };
    points.cells.iter().find(is_meant).unwrap().p
}

/// Two work areas with a sum and two shifts of three axes [002:1027-1083]: q170 to q174.
#[test]
fn two_work_areas() {
    let points = zero_points("20000 2 2 3 --");
    // 2 areas * 3 groups * 3 axes * 7 points.
    assert_eq!(
        (points.first, points.count, points.cells.len()),
        (Some(20_000), 126, 126)
    );
    assert_eq!(
        (points.areas, points.groups, points.axes, points.points),
        (2, 3, 3, 7)
    );
    for (area, point, group, axis, number) in [
        (1, "G53", 0, 1, 20_000),
        (1, "G54", 0, 2, 20_004),
        (1, "G59", 0, 3, 20_020),
        (1, "G53", 1, 1, 20_021),
        (1, "G55", 1, 3, 20_029),
        (1, "G53", 2, 1, 20_042),
        (1, "G59", 2, 3, 20_062),
        (2, "G53", 0, 1, 20_063),
        (2, "G58", 1, 2, 20_100),
        (2, "G59", 2, 3, 20_125),
    ] {
        assert_eq!(
            p(&points, area, point, group, axis),
            number,
            "{area} {point} {group} {axis}"
        );
    }
    let cell = &points.cells[62];
    assert_eq!((cell.p, cell.q, cell.value), (20_062, Some(18_062), None));
}

/// One work area with three shifts of four axes and the points up to G159 [002:1085-1144].
#[test]
fn further_zero_points() {
    let points = zero_points("20000 1 3 4 1");
    assert_eq!((points.points, points.count), (13, 4 * 13 * 4));
    for (point, group, axis, number) in [
        ("G53", 1, 1, 20_052),
        ("G59", 0, 4, 20_027),
        ("G154", 0, 1, 20_028),
        ("G156", 2, 3, 20_142),
        ("G159", 3, 4, 20_207),
    ] {
        assert_eq!(
            p(&points, 1, point, group, axis),
            number,
            "{point} {group} {axis}"
        );
    }
    let all = zero_points("20000 1 0 1 9");
    assert_eq!((all.points, all.cells[60].point.as_str()), (61, "G959"));
}

#[test]
fn without_zero_points_and_tools() {
    let file = file("");
    let points = ZeroPoints::of(file.memory(), 1);
    assert_eq!((points.first, points.count, points.cells.len()), (None, 0, 0));
    let tools = Tools::of(file.memory(), 1);
    assert_eq!((tools.first, tools.count, tools.records.len()), (None, 0, 0));
    // A number that nobody has memory for lists nothing that is not there.
    let huge = zero_points("20000 2000000000 2000000000 32 9");
    assert!(huge.cells.len() <= 20_000);
}

/// P21000 is the group of the first of 50 tools of 20 parameters each, P21020 that of the second [002:1999-2048]:
/// q175, q176, q178.
#[test]
fn the_tools_of_the_example() {
    let file = file(
        "q175: 21000\nq176: 50\nq177: 1\nq178: 20\nP21000: 1\nP21010: 4.5\nP21020: 2\nP21031: 80\nP21034: 9\n",
    );
    let tools = Tools::of(file.memory(), 1);
    assert_eq!((tools.first, tools.count, tools.length), (Some(21_000), 50, 20));
    let [first, second, third, ..] = tools.records.as_slice() else {
        panic!("{tools:?}");
    };
    assert_eq!(
        (first.p, first.q, first.group, first.radius),
        (21_000, Some(19_000), Some(1.0), Some(4.5))
    );
    assert_eq!((second.record, second.p, second.group), (1, 21_020, Some(2.0)));
    assert_eq!(
        (second.length, second.quadrant, second.radius),
        (Some(80.0), Some(9.0), None)
    );
    assert_eq!((third.p, third.group), (21_040, None));
}

fn function(file: &DataFile, m: &str) -> MFunction {
    MFunction::of(file.memory(), 1, m_number(m).unwrap())
}

/// P11051 $10050601: M7 branches, M6 goes out before the path with stop, M5 after it with stop, M4 before it, flying
/// [002:5503-5517]. P11050 is that of M0 to M3.
#[test]
fn the_example_of_the_manual() {
    let file = file("P11051: $10050601\nP11050: $00000800\n");
    let [m4, m5, m6, m7] = ["M4", "m05", "M6", "M07"].map(|m| function(&file, m));
    let how = |m: &MFunction| (m.acts, m.before, m.after, m.byte, m.bits);
    assert_eq!(how(&m4), (Acts::Flying, true, false, 1, 0x01));
    assert_eq!(how(&m5), (Acts::Stop, false, true, 2, 0x06));
    assert_eq!(how(&m6), (Acts::Stop, true, false, 3, 0x05));
    assert_eq!(how(&m7), (Acts::Branch, true, false, 4, 0x10));
    assert_eq!(m7.parameter, "P11051");
    let m1 = function(&file, "M1");
    assert_eq!(
        (m1.acts, m1.sync, m1.parameter.as_str()),
        (Acts::None, true, "P11050")
    );
    let defined = MFunction::defined(file.memory(), 1);
    assert_eq!(defined.iter().map(|m| m.m).collect::<Vec<_>>(), [1, 4, 5, 6, 7]);
}

/// M200 and all after it are defined in the channel, from P8300 on; with q158 = 1 the others, too, from P8250 on
/// [002:950-953]. M234 with bit 6 calls Z234 at the end of its block [002:5493-5501].
#[test]
fn the_block_of_the_channel() {
    let lines = "P11051: $10050601\nP8251: $02\nP8308: $00400000\nP8257: $00400000\n";
    let of_system = file(lines);
    let m234 = function(&of_system, "M234");
    // 234 = 4 * 58 + 2: P8250 + 58, byte 3.
    assert_eq!(
        (m234.parameter.as_str(), m234.byte, m234.bits),
        ("P8308", 3, 0x40)
    );
    assert_eq!((m234.acts, m234.before, m234.after), (Acts::Cycle, false, true));
    assert_eq!(function(&of_system, "M4").acts, Acts::Flying);
    assert_eq!(function(&of_system, "M200").parameter, "P8300");
    assert_eq!(function(&of_system, "M199").parameter, "P11099");
    let of_channel = file(&format!("q158: 1\n{lines}"));
    let m4 = function(&of_channel, "M4");
    assert_eq!(
        (m4.parameter.as_str(), m4.before, m4.after),
        ("P8251", false, true)
    );
    let m30 = function(&of_channel, "M30");
    assert_eq!(
        (m30.bits, m30.acts),
        (0x40, Acts::None),
        "a cycle has a number above 30"
    );
    for wrong in ["7", "M", "M-1", "M1000", "M1.5", "N7", ""] {
        assert_eq!(m_number(wrong), None, "{wrong}");
    }
}
