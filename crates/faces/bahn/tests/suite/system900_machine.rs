//! Machines with a System 900: what is checked in their folder, and programs that run on them without servo and PLC.

use serde_json::json;

use crate::support::Folder;

#[test]
fn the_portal_is_fine() {
    let folder = Folder::with_portal();
    let run = folder.bahn("machine check portal --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    assert_eq!(
        (&report[0]["ok"], &report[0]["model"]),
        (&json!(true), &json!("system900")),
        "{report}"
    );
    assert_eq!(
        report[0]["programs"].as_array().map(Vec::len),
        Some(7),
        "{report}"
    );
}

/// Head 1 mills 420 + 210 + 10 * pi / 2 + 390 + 220 mm on each of both fixtures with 2400 mm/min, goes down 7 mm with 800 and
/// drills four holes of 14 mm with 600.
#[test]
fn a_program_runs_in_its_channel() {
    let folder = Folder::with_portal();
    let run = folder.bahn("test portal/programs/P1000.900 --machine portal --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let edge = 420.0 + 210.0 + 10.0 * std::f64::consts::FRAC_PI_2 + 390.0 + 220.0;
    let feed = report["path_mm"]["feed"].as_f64().unwrap();
    let wanted = 2.0 * (edge + 7.0) + 4.0 * 14.0;
    assert!((feed - wanted).abs() < 1e-6, "{feed} {wanted}");
    let least_s = 60.0 * (2.0 * (edge / 2400.0 + 7.0 / 800.0) + 4.0 * 14.0 / 600.0) + 4.0 * 0.2;
    let time = report["machining_time_s"].as_f64().unwrap();
    assert!((least_s..1.5 * least_s).contains(&time), "{time} {least_s}");
    // At half the override what is milled takes its time once more, and nothing more than twice its time.
    let half = folder.bahn("test portal/programs/P1000.900 --machine portal --override 50 --format json");
    let half = half.json()["machining_time_s"].as_f64().unwrap();
    let milled_s = least_s - 4.0 * 0.2;
    assert!(
        (time + milled_s..2.0 * time).contains(&half),
        "{half} {time} {milled_s}"
    );
    let text = folder
        .bahn("test portal/programs/P1000.900 --machine portal")
        .out();
    assert!(
        text.starts_with("Program           P1000.900 (mm), SYSTEM 900"),
        "{text}"
    );
    // Head 2 has its own axes and tools: T11 is none of channel 1.
    let run = folder.bahn("test portal/programs/P2000.900 --machine portal --path head2.svg --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("head2.svg").contains("<svg"));
}

#[test]
fn faults_have_their_place() {
    let folder = Folder::with_portal();
    folder.write(
        "P1000.900",
        "{ part }\nN10 G54 G1 X5 F100\nN20 G3 X0 Y10.1 I-5 J0\nN30 M30\n",
    );
    let run = folder.bahn("test P1000.900 --machine portal");
    assert_eq!(run.code(), 1, "{}", run.err());
    let err = run.err();
    assert!(err.contains("M1238") && err.contains("P1000.900:3"), "{err}");
    folder.write("X.H", "BEGIN PGM X MM\nEND PGM X MM\n");
    let run = folder.bahn("test X.H --machine portal");
    assert_eq!(run.code(), 1);
    assert!(
        run.err().contains("this machine has a System 900"),
        "{}",
        run.err()
    );
    for option in [
        "--mp 1010.0=3000",
        "--set Q1=5",
        "--start X5",
        "--skip-blocks",
        "--datum X1",
    ] {
        let run = folder.bahn(&format!("test P1000.900 --machine portal {option}"));
        assert_eq!(run.code(), 2, "{option}");
        let name = option.split(' ').next().unwrap();
        assert!(
            run.err().contains(&format!("{name} is for a TNC")),
            "{}",
            run.err()
        );
    }
}

/// A plant file is checked with the folder, and so is what answers in the place of a PLC.
#[test]
fn a_wrong_plant_is_a_fault_of_the_folder() {
    let folder = Folder::with_portal();
    let described = folder.read("portal/machine.toml");
    folder.write(
        "portal/machine.toml",
        format!("{described}answers = [\"enable\", \"luck\"]\n"),
    );
    folder.write("portal/plant.toml", "[axis.X]\nspeed = 1\n");
    let run = folder.bahn("machine check portal");
    assert_eq!(run.code(), 1, "{}", run.out());
    let said = run.err();
    assert!(
        said.contains("`luck` is no answer; there are enable, mode, start, m, tools"),
        "{said}"
    );
    assert!(
        said.contains("plant.toml:1") && said.contains("needs output"),
        "{said}"
    );
}

/// All that takes the folder of a TNC says why it does not take this one.
#[test]
fn what_is_for_a_tnc_says_so() {
    let folder = Folder::with_portal();
    for command in [
        "panel --machine portal --rs232 pty:line",
        "torture --machine portal --mp 7480.0=3",
    ] {
        let run = folder.bahn(command);
        assert!(run.code() == 1 || run.code() == 2, "{command}: {}", run.code());
        assert!(run.err().contains("System 900"), "{command}: {}", run.err());
    }
}

#[test]
fn wrong_folders_have_all_their_faults() {
    let folder = Folder::with_portal();
    let toml = "name = 'p'\ncontrol = 'system900'\nparameters = 'wrong.q'\nbeam = 2\n";
    folder.write("portal/machine.toml", toml);
    folder.write("portal/wrong.q", "q2: 9\n");
    let run = folder.bahn("machine check portal");
    assert_eq!(run.code(), 1);
    let err = run.err();
    for said in ["machine.toml:4:1", "unknown key `beam`", "wrong.q:1:5"] {
        assert!(err.contains(said), "{said} is missing in\n{err}");
    }
}
