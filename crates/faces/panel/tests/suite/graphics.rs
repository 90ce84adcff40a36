//! Graphics of TEST RUN and program run: the part that is cut, and how it is looked at.

use std::collections::BTreeSet;

use crate::support::Trainee;
use bahn_interpreter::{Interpreter, NoPrograms, Rules, Settings};
use bahn_panel::{GraphicsView, Star};
use bahn_parameters::ParameterList;
use bahn_path::{BlockRef, ElementSource, LiveData, Step};
use bahn_workpiece::{Columns, Cutting, Hears, Memory, Remark};

/// A groove of 10 mm width and 5 mm depth through the whole of a blank of 40 x 30 x 10 mm.
const GROOVE: &str = "BEGIN PGM GROOVE MM
BLK FORM 0.1 Z X+0 Y+0 Z-10
BLK FORM 0.2 X+40 Y+30 Z+0
TOOL DEF 1 L+0 R+5
TOOL CALL 1 Z S2000
L Z+50 R0 FMAX M3
L X-10 Y+15 FMAX
L Z-5 FMAX
L X+50 F600
L Z+50 FMAX M2
END PGM GROOVE MM
";

/// Width, depth and length of the groove.
const REMOVED_MM3: f64 = 10.0 * 5.0 * 40.0;

fn trainee() -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.write("programs/GROOVE.H", GROOVE);
    trainee.ready();
    trainee
}

fn removed_mm3(trainee: &mut Trainee) -> f64 {
    let part = trainee.station.picture().unwrap().part();
    part.unwrap().removed_mm3()
}

/// What is removed is exact within a column on either side of the groove.
fn assert_is_groove(removed_mm3: f64) {
    let columns_mm3 = 2.0 * 0.1 * 5.0 * 40.0;
    assert!(
        (removed_mm3 - REMOVED_MM3).abs() < columns_mm3,
        "{removed_mm3} mm³"
    );
}

#[test]
fn a_test_run_cuts_the_part_and_tells_the_machining_time() {
    let mut trainee = trainee();
    trainee.press("TEST PGM_NR G R O O V E ENT").wait(0.3);
    assert!(trainee.screen().graphics.is_none(), "nobody has asked for them");
    trainee.press("GRAPHICS START");
    trainee.until(20.0, |screen| {
        screen
            .graphics
            .as_ref()
            .is_some_and(|shown| shown.progress == 1.0)
    });
    let shown = trainee.screen().graphics.unwrap();
    assert_eq!((shown.view, shown.running), (GraphicsView::Plan, false));
    // 60 mm at 600 mm/min, and what the rapid traverse takes beside it.
    let time_s = shown.machining_time_s.unwrap();
    assert!((6.0..30.0).contains(&time_s), "{time_s} s");
    assert_is_groove(removed_mm3(&mut trainee));
    // START again begins with the whole blank.
    trainee.press("START").wait(2.0);
    assert_is_groove(removed_mm3(&mut trainee));
    assert_eq!(trainee.screen().graphics.unwrap().machining_time_s, Some(time_s));
    // GRAPHICS and BLK FORM: the blank is whole.
    trainee.press("BLK_FORM");
    assert_eq!(removed_mm3(&mut trainee), 0.0);
}

#[test]
fn a_program_run_cuts_what_was_executed() {
    let mut trainee = trainee();
    trainee.press("FULL PGM_NR G R O O V E ENT GRAPHICS").wait(0.5);
    assert!(trainee.station.picture().is_none(), "nothing was run yet");
    trainee.press("NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    // On the way along the groove a part of it is there.
    let block = |text: &'static str| {
        move |screen: &bahn_panel::Screen| {
            let current = screen.program.lines.iter().find(|line| line.current);
            current.is_some_and(|line| line.text.contains(text))
        }
    };
    trainee.until(120.0, block("Z-5"));
    assert_eq!(removed_mm3(&mut trainee), 0.0);
    trainee.until(300.0, |screen| screen.status.star != Star::Steady);
    trainee.wait(0.5);
    assert_is_groove(removed_mm3(&mut trainee));
    // It is the same part that the test makes.
    let ran = removed_mm3(&mut trainee);
    trainee.press("TEST PGM_NR G R O O V E ENT START").wait(2.0);
    assert_eq!(removed_mm3(&mut trainee), ran);
}

#[test]
fn the_keys_choose_view_place_and_size() {
    let mut trainee = trainee();
    trainee.press("TEST PGM_NR G R O O V E ENT START").wait(2.0);
    let mut pictures = Vec::new();
    let mut look = |trainee: &mut Trainee, keys: &str| {
        let before = trainee.screen().graphics.map(|shown| shown.serial);
        trainee.press(keys);
        let shown = trainee.screen().graphics.unwrap();
        assert_ne!(before, Some(shown.serial), "{keys}: another picture");
        let png = trainee.station.picture().unwrap().png(320, 240).unwrap().unwrap();
        assert!(png.starts_with(b"\x89PNG"));
        assert!(!pictures.contains(&png), "{keys}: it looks as before");
        pictures.push(png);
        shown
    };
    assert_eq!(look(&mut trainee, "GRAPHICS").view, GraphicsView::Plan);
    assert_eq!(look(&mut trainee, "MAGN").magn, 2);
    trainee.press("MAGN MAGN");
    assert_eq!(look(&mut trainee, "GRAPHICS").view, GraphicsView::ThreePlanes);
    assert_eq!(look(&mut trainee, "LEFT").sections, [0.45, 0.5]);
    assert_eq!(look(&mut trainee, "UP").sections, [0.45, 0.55]);
    let solid = look(&mut trainee, "GRAPHICS");
    assert_eq!((solid.view, solid.azimuth_deg), (GraphicsView::Solid, 30.0));
    assert_eq!(look(&mut trainee, "RIGHT").azimuth_deg, 120.0);
    look(&mut trainee, "UP");
    trainee.press("GRAPHICS");
    assert!(trainee.screen().graphics.is_none() && trainee.station.picture().is_none());
}

#[test]
fn stop_ends_a_test_and_what_was_cut_stays() {
    let mut trainee = trainee();
    // A groove a thousand times over.
    let again = GROOVE
        .replace("L Z+50 FMAX M2", "L Z+50 FMAX\nCALL LBL 1 REP 900\nL M2")
        .replace("L X-10 Y+15 FMAX", "LBL 1\nL X-10 Y+15 FMAX");
    trainee.write("programs/GROOVE.H", &again);
    trainee.press("TEST PGM_NR G R O O V E ENT GRAPHICS").wait(0.3);
    trainee.give(r#"{"key":"START"}"#);
    assert!(trainee.screen().graphics.unwrap().running);
    trainee.station.cycle().unwrap();
    // STOP interrupts it, once more it ends.
    trainee.give(r#"{"key":"STOP"}"#);
    let interrupted = trainee.screen().graphics.unwrap();
    trainee.wait(0.5);
    let later = trainee.screen().graphics.unwrap();
    assert!(later.running);
    assert_eq!(later.machining_time_s, interrupted.machining_time_s);
    trainee.give(r#"{"key":"STOP"}"#);
    let stopped = trainee.screen().graphics.unwrap();
    assert!(!stopped.running && stopped.progress < 1.0, "{stopped:?}");
    trainee.wait(1.0);
    assert_eq!(
        trainee.screen().graphics.unwrap().machining_time_s,
        stopped.machining_time_s
    );
    assert!(trainee.station.picture().unwrap().part().is_some());
}

#[test]
fn what_a_height_map_cannot_show_is_said() {
    let mut trainee = trainee();
    trainee.write(
        "programs/GROOVE.H",
        &GROOVE.replace("TOOL CALL 1 Z", "TOOL CALL 1 Y"),
    );
    trainee.press("TEST PGM_NR G R O O V E ENT START").wait(2.0);
    let messages = trainee.messages();
    assert!(
        messages.iter().any(|text| text == "PGM SECTION CANNOT BE SHOWN"),
        "{messages:?}"
    );
}

struct Deaf;

impl Hears for Deaf {
    fn hear(&mut self, _block: BlockRef, _remark: Remark, _count: u64) {}
}

/// What a program removes with the tools of the machine, without a machine and without a panel, as `bahn test` does it.
fn removed_without_a_panel(trainee: &Trainee, name: &str) -> f64 {
    let machine = trainee.station.machine();
    let bytes = trainee.file(&format!("programs/{name}"));
    let program = std::sync::Arc::new(bahn_program::Program::from_bytes(name, bytes.into_bytes()));
    let tools = machine.tools.as_ref().unwrap().iter();
    let settings = Settings {
        model: machine.parameters.model(),
        rules: Rules::of(&machine.parameters),
        tools: Some(tools.map(|(number, tool)| (*number, tool.shape)).collect()),
        ..Settings::default()
    };
    let mut run = Interpreter::new(program, settings, std::sync::Arc::new(NoPrograms));
    let mut cutting = Cutting::new(Columns::BySize, Memory::default(), BTreeSet::new());
    loop {
        match run.next() {
            Step::Element(element) => cutting.element(&element, &mut Deaf).unwrap(),
            Step::Barrier(_) => run.resume(LiveData::default()),
            Step::End => return cutting.finish(&mut Deaf).unwrap().removed_mm3(),
            step => panic!("{step:?}"),
        }
    }
}

/// A bracket with six tools, cycles and tapping: in simulation time with the machine, and in real time on a
/// thread of its own.
#[test]
fn the_part_is_that_of_the_program_however_it_is_tested() {
    let mut trainee = trainee();
    let expected = removed_without_a_panel(&trainee, "BRACKET.H");
    assert!(expected > 1000.0, "{expected} mm³");
    trainee.press("TEST PGM_NR B R A C K E T ENT GRAPHICS");
    for in_real_time in [false, true] {
        if in_real_time {
            trainee.station.run_in_real_time();
        }
        trainee.press("START");
        trainee.until(60.0, |screen| !screen.graphics.as_ref().unwrap().running);
        assert_eq!(trainee.screen().graphics.unwrap().progress, 1.0);
        assert_eq!(
            removed_mm3(&mut trainee),
            expected,
            "in real time: {in_real_time}"
        );
    }
}

/// The parameters MP7360 to MP7362 colour the views [000:6344-6360]: in the 3D view the upper faces, the front and the side, in
/// three planes plan and sections, and the line above them. A TNC 360 has no colours, and draws with ours.
#[test]
fn the_part_has_the_colours_of_mp7360_to_7362() {
    let colour = |coded: u32| [16, 8, 0].map(|shift| ((coded >> shift & 0x3f) * 255 / 63) as u8);
    let mut trainee = Trainee::with("mill", |folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let own = |line: &&str| {
            !["MP7360", "MP7361", "MP7362"]
                .iter()
                .any(|own| line.starts_with(own))
        };
        let mut text: String = text.lines().filter(own).map(|line| format!("{line}\n")).collect();
        for (number, colours) in [
            (7360, &[0x01_0000, 0x3f_0000, 0x00_3f00, 0x3f_3f3f, 0x00_003f][..]),
            (7361, &[0x00_0100, 0x3f_3f00, 0x00_3f3f, 0x3f_3f3f, 0][..]),
            (7362, &[0, 0x00_0020, 0x20_2020, 0x30_3030][..]),
        ] {
            for (index, coded) in colours.iter().enumerate() {
                text += &format!("MP{number}.{index} : ${coded:07X}\n");
            }
        }
        std::fs::write(path, text).unwrap();
    });
    trainee.write("programs/GROOVE.H", GROOVE);
    trainee.ready();
    trainee.press("TEST PGM_NR G R O O V E ENT START").wait(2.0);
    let mut counts = |keys: &str| {
        trainee.press(keys);
        let picture = trainee.station.picture().unwrap();
        let pixels = picture.pixels(800, 600).unwrap().unwrap();
        move |coded: u32| pixels.iter().filter(|pixel| **pixel == colour(coded)).count()
    };
    let plan = counts("GRAPHICS");
    assert!(plan(0x00_0100) > 50_000 && plan(0x3f_3f00) > 10_000);
    let planes = counts("GRAPHICS");
    assert!(planes(0x00_0100) > 50_000, "background");
    assert!(planes(0x3f_3f00) > 5_000, "plan");
    assert!(planes(0x00_3f3f) > 1_000, "sections");
    let solid = counts("GRAPHICS");
    for (coded, what) in [
        (0x01_0000, "background"),
        (0x3f_0000, "top"),
        (0x00_3f00, "front"),
        (0x00_003f, "side"),
    ] {
        assert!(solid(coded) > 2_000, "{what}: {}", solid(coded));
    }
    // A quarter turn shows another front: the eye stands as far beside it.
    let turned = counts("RIGHT");
    let (front, side) = (turned(0x00_3f00), turned(0x00_003f));
    assert!(front > 1_000 && side > 1_000, "{front} {side}");
    // The line above is drawn in a picture of its own, with its title.
    let picture = trainee.station.picture().unwrap();
    assert!(picture.png(800, 600).unwrap().is_some());
}

/// A TNC 407 has graphics in TEST RUN only, the TNC 415 those of what runs, too [000:6370].
#[test]
fn a_tnc_407_has_no_graphics_in_program_run() {
    for (model, there) in [("tnc407", false), ("tnc415b", true)] {
        let mut trainee = Trainee::with("mill", |folder| {
            let path = folder.join("machine.toml");
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(
                &path,
                text.replace("model = \"tnc415b\"", &format!("model = \"{model}\"")),
            )
            .unwrap();
            // The list without what that control does not have.
            let of_model = ParameterList::smallest(model.parse().unwrap());
            let is_there = |line: &&str| {
                let name = line.split(':').next().unwrap_or_default().trim();
                let Some((number, index)) = name
                    .strip_prefix("MP")
                    .map(|name| name.split_once('.').unwrap_or((name, "0")))
                else {
                    return true;
                };
                of_model
                    .get(number.parse().unwrap(), index.parse().unwrap())
                    .is_some()
            };
            let path = folder.join("parameters.mp");
            let list = std::fs::read_to_string(&path).unwrap();
            let lines: Vec<&str> = list.lines().filter(is_there).collect();
            std::fs::write(&path, lines.join("\n")).unwrap();
        });
        trainee.write("programs/GROOVE.H", GROOVE);
        trainee.ready();
        trainee.press("FULL PGM_NR G R O O V E ENT GRAPHICS");
        assert_eq!(trainee.screen().graphics.is_some(), there, "{model}");
        trainee.press("CE TEST PGM_NR G R O O V E ENT");
        if !there {
            trainee.press("GRAPHICS");
        }
        assert!(trainee.screen().graphics.is_some(), "{model}");
    }
}

/// The graphics of a TNC 360 are in the program run modes: START simulates the selected program as often as desired
/// [003:856-874], and what runs is drawn, too [003:1551].
#[test]
fn a_tnc_360_simulates_in_program_run() {
    let mut trainee = Trainee::at("mill-tnc360");
    trainee.write("programs/77.H", &GROOVE.replace("GROOVE", "77"));
    trainee.ready();
    trainee.press("FULL PGM_NR 7 7 ENT GRAPHICS START");
    for _ in 0..2 {
        trainee.until(20.0, |screen| {
            screen
                .graphics
                .as_ref()
                .is_some_and(|shown| shown.progress == 1.0)
        });
        assert_is_groove(removed_mm3(&mut trainee));
        assert_eq!(trainee.screen().status.star, Star::Off, "nothing moves");
        trainee.press("START");
    }
    trainee.press("NC_START");
    trainee.until(5.0, |screen| screen.status.star == Star::Steady);
    assert_eq!(removed_mm3(&mut trainee), 0.0, "the run has a blank of its own");
}
