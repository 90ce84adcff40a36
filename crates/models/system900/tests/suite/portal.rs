//! The data file of the shipped machine `portal900`: without fault, and what it says.

use std::fs;
use std::path::Path;

use bahn_system900::{
    Acts, DataFile, MFunction, MessageKind, Name, Place, Together, Tools, ZeroPoints, check, row, together,
};

fn file() -> DataFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900/parameters.q");
    DataFile::read(&fs::read(path).unwrap())
}

fn number(file: &DataFile, text: &str) -> Option<f64> {
    file.memory().cell(text.parse().unwrap()).unwrap().number()
}

/// No error and no warning; two channels of eight axes with names or a master, and two spindles.
#[test]
fn the_portal_is_without_fault() {
    let file = file();
    let checked = check(&file);
    assert_eq!(checked.faults, []);
    let lines = file.text().lines().count();
    assert!((500..800).contains(&lines), "{lines}");
    let axes: Vec<String> = checked
        .channels
        .iter()
        .flat_map(|channel| {
            let axes = channel.axes.iter();
            axes.map(|axis| format!("{}:{}={}", channel.channel, axis.name, axis.physical))
        })
        .collect();
    let wanted = [
        "1:X=1", "1:Y=3", "1:Z=4", "1:=2", "1:=9", "2:X=5", "2:Y=6", "2:Z=7", "2:C=8", "2:=10",
    ];
    assert_eq!(axes, wanted);
}

/// Every number has a row that explains it, or lies in a user block.
#[test]
fn every_number_of_the_portal_is_explained() {
    let file = file();
    let memory = file.memory();
    let unexplained = memory.loaded().map(|place| memory.name_of(place)).filter(|name| {
        let is_of_user = name
            .of_channel()
            .is_some_and(|(_, p)| !(7000..20_000).contains(&p));
        row(*name).is_none() && !is_of_user
    });
    assert_eq!(unexplained.collect::<Vec<_>>(), []);
    assert!(memory.loaded().count() > 450);
}

/// The slave goes 1:1 with X; each head watches the other one: equal ranges seen from both sides.
#[test]
fn the_heads_of_the_portal() {
    let file = file();
    let coupling = ["P11480", "P11481", "P11492", "P11493"].map(|text| number(&file, text));
    assert_eq!(coupling, [Some(1.0), Some(2.0), Some(1.0), Some(1.0)]);
    let spindles = ["P11640", "P11660", "q142", "q242"].map(|text| number(&file, text));
    assert_eq!(spindles, [Some(9.0), Some(10.0), Some(1.0), Some(2.0)]);
    let position = |axis: &str| file.memory().q(axis.parse().unwrap()).ok().map(f64::from);
    let watched = |channel: u8, place: u32| number(&file, &format!("{channel}:P{}", 12_000 + place));
    assert_eq!(watched(1, 102), position("2:P12150"));
    assert_eq!(watched(2, 102), position("1:P12150"));
    for range in [103, 104] {
        let [one, two] = [1, 2].map(|channel| watched(channel, range).unwrap());
        assert!(one > 0.0 && two == -one, "{one} {two}");
    }
    for what in [
        Together::Mode,
        Together::Stop,
        Together::Abort,
        Together::Message(MessageKind::High),
    ] {
        assert_eq!(together(file.memory(), 2, what).to_string(), "1, 2", "{what:?}");
    }
    assert_eq!(
        together(file.memory(), 2, Together::Message(MessageKind::Display)).to_string(),
        "2"
    );
}

/// The sum of a zero point is that of its shifts; tools have distinct numbers and places.
#[test]
fn zero_points_and_tools_of_the_portal() {
    let file = file();
    for channel in 1..=2 {
        let points = ZeroPoints::of(file.memory(), channel);
        assert_eq!(
            (points.areas, points.groups, points.axes, points.points),
            (2, 3, 5, 13)
        );
        let value = |area: u32, point: &str, group: u32, axis: u32| {
            let mut cells = points.cells.iter();
            let cell = cells.find(|cell| {
                (cell.area, cell.point.as_str(), cell.group, cell.axis) == (area, point, group, axis)
            });
            cell.unwrap().value
        };
        let mut loaded = 0;
        for cell in points
            .cells
            .iter()
            .filter(|cell| cell.group == 0 && cell.value.is_some())
        {
            let shifts = (1..3).filter_map(|group| value(cell.area, &cell.point, group, cell.axis));
            let sum: f64 = shifts.sum();
            assert!((cell.value.unwrap() - sum).abs() < 1e-9, "{cell:?}");
            loaded += 1;
        }
        // Two points of two areas, of three and four axes.
        assert_eq!(loaded, if channel == 1 { 12 } else { 16 });
        let tools = Tools::of(file.memory(), channel);
        let mut groups: Vec<_> = tools
            .records
            .iter()
            .filter_map(|tool| Some((tool.group?, tool.place?)))
            .collect();
        let count = groups.len();
        groups.dedup();
        assert_eq!((tools.count, groups.len()), (16, count));
        assert!(
            count >= 4
                && tools
                    .records
                    .iter()
                    .take(count)
                    .all(|tool| tool.radius > Some(0.0)),
            "{count}"
        );
    }
}

/// What the comments say of M functions, the definitions do.
#[test]
fn m_functions_of_the_portal() {
    let file = file();
    for (channel, m, acts, before, after, sync) in [
        (1, 0, Acts::Stop, false, true, true),
        (1, 3, Acts::Stop, true, false, false),
        (1, 5, Acts::Stop, false, true, false),
        (2, 6, Acts::Stop, true, false, true),
        (1, 7, Acts::Flying, true, false, false),
        (1, 9, Acts::Flying, false, true, false),
        (1, 14, Acts::Stop, true, false, false),
        (1, 16, Acts::Stop, true, false, true),
        (1, 19, Acts::Stop, true, false, false),
        (1, 30, Acts::Stop, false, true, true),
        (1, 60, Acts::Branch, true, false, false),
        (2, 81, Acts::Stop, true, false, false),
        (1, 100, Acts::Cycle, false, true, false),
        (1, 200, Acts::Stop, true, false, false),
        (1, 234, Acts::None, false, false, false),
        (2, 234, Acts::Cycle, false, true, false),
        (2, 200, Acts::None, false, false, false),
    ] {
        let found = MFunction::of(file.memory(), channel, m);
        let found = (found.acts, found.before, found.after, found.sync);
        assert_eq!(found, (acts, before, after, sync), "M{m} of channel {channel}");
    }
}

/// Statuses as the head of the file explains them: stored, decimals, unit, lock.
#[test]
fn statuses_of_the_portal() {
    let file = file();
    let memory = file.memory();
    let status = |text: &str| memory.cell(text.parse().unwrap()).unwrap().status();
    for place in memory.loaded().filter(|place| *place != Place::Q(10)) {
        let name: Name = memory.name_of(place);
        let is_stored = memory.at(place).status().is_stored();
        assert!(is_stored, "{name}");
    }
    assert!(status("P12030").is_length() && status("2:P12231").is_length());
    assert!(!status("q3441").is_length(), "a turn of C is no length");
    assert_eq!(status("P12004").locks().collect::<Vec<_>>(), [1]);
    assert_eq!(status("P500").locks().collect::<Vec<_>>(), [2]);
    assert!(status("2:P600").receivers().sample && status("q2150").receivers().panel_always);
}
