//! `bahn scope`: summaries and drawings of recordings.

use crate::support::{Folder, number};

/// A ramp of 100 mm/s for a second, then still; the marker is set from 0.4 to 0.7 s.
fn recording() -> Folder {
    let mut text = "time [s],X.actual [mm],X.lag [mm],M2045\n".to_owned();
    for step in 0..2000 {
        let time = f64::from(step) * 0.001;
        let moved = 100.0 * time.min(1.0);
        let lag = if time < 1.0 { 2.5 } else { -0.5 };
        let marker = u8::from((400..700).contains(&step));
        text += &format!("{time:.3},{moved:.5},{lag:.5},{marker}\n");
    }
    let folder = Folder::new();
    folder.write("r.csv", text);
    folder
}

#[test]
fn the_summary_has_extremes_means_and_edges() {
    let folder = recording();
    let run = folder.bahn("scope r.csv --format json --cursor 0.5,1.5");
    assert_eq!(run.code(), 0, "{}", run.err());
    let json = run.json();
    assert_eq!(json["signals"][0]["name"], "X.actual");
    assert_eq!(json["signals"][0]["unit"], "mm");
    assert_eq!(number(&json, "/signals/1/min"), -0.5);
    assert_eq!(number(&json, "/signals/1/max"), 2.5);
    // 2.5 for 1.000 s, -0.5 for 0.999 s.
    assert!((number(&json, "/signals/1/mean") - (2.5 - 0.5 * 0.999) / 1.999).abs() < 1e-6);
    assert_eq!(json["signals"][2]["kind"], "logic");
    assert_eq!(
        (
            number(&json, "/signals/2/rising"),
            number(&json, "/signals/2/falling")
        ),
        (1.0, 1.0)
    );
    assert!((number(&json, "/signals/2/on_s") - 0.3).abs() < 1e-9);
    assert_eq!(number(&json, "/cursors/0/values/X.actual"), 50.0);
    assert_eq!(number(&json, "/difference_s"), 1.0);
    let part = folder.bahn("scope r.csv --from 1.2 --to 1.5 --signals X.lag");
    assert!(
        part.out().contains("1.200 to 1.500 s, 301 samples"),
        "{}",
        part.out()
    );
}

#[test]
fn drawings_are_svg_or_png() {
    let folder = recording();
    assert_eq!(folder.bahn("scope r.csv -o r.svg --cursor 0.5").code(), 0);
    let svg = folder.read("r.svg");
    for part in [
        "X.actual",
        "X.lag",
        "M2045",
        ">mm<",
        "time, s",
        "stroke-dasharray",
        "viewBox=\"0 0 1200 800\"",
    ] {
        assert!(svg.contains(part), "{part}");
    }
    let analogue = svg.matches("stroke-width=\"1.4\"").count();
    let logic = svg.matches("stroke-width=\"1.6\"").count();
    assert_eq!((analogue, logic), (2, 1), "a trace for each signal");
    let run = folder.bahn("scope r.csv -o r.png --size 600x400 --title Ramp");
    assert_eq!(run.code(), 0, "{}", run.err());
    let png = std::fs::read(folder.path("r.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG"));
    // Width and height in the header.
    assert_eq!(png.get(16..24), Some([0, 0, 2, 88, 0, 0, 1, 144].as_slice()));
}

#[test]
fn wrong_recordings_are_refused_with_their_line() {
    let folder = recording();
    folder.write("bad.csv", "time [s],M1\n1,0\n2,up\n");
    let bad = folder.bahn("scope bad.csv");
    assert_eq!(bad.code(), 2);
    assert!(
        bad.err().contains("bad.csv:3: M1: `up` is no number"),
        "{}",
        bad.err()
    );
    let none = folder.bahn("scope r.csv --signals Y.lag");
    assert!(
        none.err()
            .contains("--signals Y.lag: the recording has no such signal; there are X.actual, X.lag, M2045"),
        "{}",
        none.err()
    );
    let early = folder.bahn("scope r.csv --from 9");
    assert!(
        early
            .err()
            .contains("--from, --to: the recording runs from 0 to 1.999 s"),
        "{}",
        early.err()
    );
    assert_eq!(folder.bahn("scope r.csv -o r.gif").code(), 2);
    assert_eq!(folder.bahn("scope r.csv --cursor 1,2,3").code(), 2);
    let circle = folder.bahn("scope r.csv --circle X,Y");
    assert!(
        circle.err().contains("needs X.actual, Y.actual"),
        "{}",
        circle.err()
    );
    assert_eq!(folder.bahn("scope r.csv --xy X,Y -o r.png").code(), 2);
    assert_eq!(folder.bahn("scope r.csv --xy X,X -o r.png").code(), 2);
    let step = folder.bahn("scope r.csv --step X");
    assert!(
        step.err().contains("needs X.nominal and X.actual"),
        "{}",
        step.err()
    );
}

/// Power-up for 10 s, then the program with a message in its block 3.
#[test]
fn the_picture_begins_at_the_start_of_the_program() {
    let folder = Folder::new();
    let mut text = "time [s],X.lag [mm],event\n".to_owned();
    for second in 0..20 {
        let event = match second {
            10 => "start; block 1",
            14 => "block 3; message LIMIT SWITCH X+",
            _ => "",
        };
        text += &format!("{second},{}.5,{event}\n", second % 3);
    }
    folder.write("r.csv", text);
    let run = folder.bahn("scope r.csv -o r.svg");
    assert!(run.out().contains("10.000 to 19.000 s"), "{}", run.out());
    let svg = folder.read("r.svg");
    for part in [">block<", ">1<", ">3<", ">LIMIT SWITCH X+<"] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(
        folder
            .bahn("scope r.csv --all")
            .out()
            .contains("0.000 to 19.000 s")
    );
    assert!(
        folder
            .bahn("scope r.csv --from 3")
            .out()
            .contains("3.000 to 19.000 s")
    );
}

/// The same ramp a second later after its start, with 0.2 mm more lag.
#[test]
fn two_recordings_are_compared_from_their_starts() {
    let folder = Folder::new();
    let record = |start: i32, lag: f64| {
        let rows = (0..6).map(|second| {
            let event = if second == start { "start" } else { "" };
            let lag = if second > start { lag } else { 0.0 };
            format!("{second},{lag},{event}\n")
        });
        "time [s],X.lag [mm],event\n".to_owned() + &rows.collect::<String>()
    };
    folder.write("before.csv", record(1, 2.0));
    folder.write("after.csv", record(2, 2.2));
    let run = folder.bahn("scope after.csv --against before.csv -o c.svg --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let json = run.json();
    assert_eq!(json["against"][0]["name"], "X.lag");
    assert!((number(&json, "/against/0/difference") - 0.2).abs() < 1e-9);
    assert_eq!(number(&json, "/against/0/at_s"), 3.0);
    assert!(folder.read("c.svg").contains("compared with"));
}
