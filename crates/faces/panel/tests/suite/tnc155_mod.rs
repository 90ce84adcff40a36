//! MOD of a TNC 155: what the machine builder gives to the operator, and the offsets of the drives [001:1299-1334] [001:2573-2585].

use crate::support::Trainee;
use bahn_parameters::ControlModel::Tnc155;

fn lines(trainee: &mut Trainee) -> Vec<String> {
    let lines = trainee.screen().program.lines;
    lines.into_iter().map(|line| line.text).collect()
}

/// Parameters with the letter P are USER PAR. 1 and 2 in the order of their numbers, whatever their order in the list; what is
/// entered goes into the list, and the parameter stays the operator's.
#[test]
fn user_parameters_stand_in_mod() {
    let mut trainee = Trainee::with_tnc155(Tnc155, &["MP217 : 0 P", "MP4 : 1200 P"]);
    trainee.ready();
    trainee.press("PROGRAM MOD");
    trainee.down_to("USER PARAMETERS");
    trainee.press("ENT").wait(0.1);
    let shown = lines(&mut trainee);
    let shown: Vec<_> = shown
        .iter()
        .take(2)
        .map(|line| line.split_whitespace().collect::<Vec<_>>())
        .collect();
    assert_eq!(
        shown,
        [
            ["USER", "PAR.", "1", ":", "1200"],
            ["USER", "PAR.", "2", ":", "0"]
        ]
    );
    trainee.number("900").press("ENT END").wait(0.1);
    let list = trainee.file("parameters.mp");
    let entry = list
        .lines()
        .find(|line| line.split_whitespace().next() == Some("MP4"));
    let words: Vec<_> = entry.unwrap().split_whitespace().collect();
    assert_eq!(words, ["MP4", ":", "900", "P"], "{list}");
}

/// Code number 75368 shows the offsets in steps of 2.44 mV, and ENT compensates them. Here drives without friction stand at 0,
/// 2.44 and 4.88 mV: 0, 1 and 2 steps [001:2578-2583].
#[test]
fn code_75368_shows_and_compensates_the_offsets() {
    let mut trainee = Trainee::with("mill-tnc155", |folder| {
        let path = folder.join("plant.toml");
        let mut drives = ["0", "-2.44", "-4.88"].into_iter();
        let line = |line: &str| match line.split(' ').next() {
            Some("friction") => format!("friction = 0\noffset_mv = {}\n", drives.next().unwrap()),
            Some("stiction" | "offset_mv") => String::new(),
            _ => format!("{line}\n"),
        };
        let plant: String = std::fs::read_to_string(&path)
            .unwrap()
            .lines()
            .map(line)
            .collect();
        std::fs::write(&path, plant).unwrap();
    });
    trainee.ready();
    trainee.wait(2.0);
    let open = |trainee: &mut Trainee| {
        trainee.press("MOD");
        trainee.down_to("CODE NUMBER");
        trainee.press("ENT").number("75368").press("ENT").wait(0.5);
        let shown = lines(trainee);
        let words = |line: &String| line.split_whitespace().collect::<Vec<_>>().join(" ");
        shown.iter().map(words).collect::<Vec<_>>()
    };
    assert_eq!(open(&mut trainee), ["X 0", "Y 1", "Z 2"]);
    assert_eq!(trainee.screen().program.title, "OFFSET ADJUSTMENT (1 = 2.44 mV)");
    trainee.press("ENT END").wait(2.0);
    assert_eq!(open(&mut trainee), ["X 0", "Y 0", "Z 0"]);
}
