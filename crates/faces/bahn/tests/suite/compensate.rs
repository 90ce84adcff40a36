//! `bahn compensate`: the residual error of machines with pitch error, backlash and thermal drift.

use crate::support::*;

/// The mill with an encoder of 100 µm on the screw of X: pitch error, 12 µm of backlash, and 15 µm of drift in some minutes.
fn worn() -> Folder {
    let folder = Folder::new();
    copy(&machines().join("mill"), &folder.path("m"));
    let plant = folder.read("m/plant.toml");
    let (head, rest) = plant.split_once("[axis.X.encoder]").unwrap();
    let (encoder, tail) = rest.split_once("\n[axis.Y]").unwrap();
    let head = head.replace("backlash = 0.003", "backlash = 0.012");
    assert!(encoder.contains("period_um = 20") && encoder.contains("on = \"table\""));
    let encoder = encoder
        .replace("period_um = 20", "period_um = 100")
        .replace("on = \"table\"", "on = \"motor\"")
        .replace("marks_coded = 20", "mark = 530")
        .replace("marks_from = -20", "# ")
        + "errors_um = [[-20, 4], [100, -3], [230, 5], [400, 12], [620, 6]]\ndrift_um = 15\ndrift_min = 5\n";
    folder.write(
        "m/plant.toml",
        format!("{head}[axis.X.encoder]{encoder}\n[axis.Y]{tail}"),
    );
    let list = folder.read("m/parameters.mp");
    let mut new = String::new();
    for line in list.lines() {
        new += match line.split_whitespace().next() {
            Some("MP330.0") => "MP330.0  : 100",
            Some("MP1350.0") => "MP1350.0 : 1",
            Some("MP960.0") => "MP960.0  : -530",
            Some("MP30") => "MP30     : %00010",
            _ => line,
        };
        new.push('\n');
    }
    folder.write("m/parameters.mp", new);
    folder
}

/// Twice a counting step of the encoder, 100 µm / 1024, is what may be left; 0.1 µm are the entries of the tables.
#[test]
fn what_is_left_is_below_twice_the_resolution_of_the_encoder() {
    let folder = worn();
    let run = folder.bahn("compensate m --axes X --warm-up 10 --write --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    let report = run.json();
    let axis = &report["axes"][0];
    let resolution = number(axis, "/resolution_um");
    assert!((resolution - 100.0 / 1024.0).abs() < 1e-3);
    assert!(number(axis, "/before_um") > 8.0, "{axis}");
    assert!(
        number(axis, "/after_um") <= 2.0 * resolution,
        "{}",
        number(axis, "/after_um")
    );
    assert!(
        (number(axis, "/backlash_mm") - 0.012).abs() < 0.0002,
        "as the plant has it"
    );
    assert_eq!(axis["by_table"], true);
    // Of 15 µm the exponential has 15 · e^(-10/5) = 2 µm left after 10 minutes, and the run takes some of them.
    let drift = number(axis, "/drift_um");
    assert!(drift > 0.3 && drift < 2.0, "{drift}");
    // Errors between the points of the plant's table, -3 µm at 100 mm of the plant and 12 µm at 400: 15 µm between them.
    let errors = axis["errors"].as_array().unwrap();
    let up = |at: f64| {
        let near = |point: &&serde_json::Value| (point["at_mm"].as_f64().unwrap() - at).abs();
        let found = errors.iter().min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
        found["up_um"].as_f64().unwrap()
    };
    assert!(
        (up(400.0) - up(100.0) - 15.0).abs() < 1.0,
        "{} {}",
        up(400.0),
        up(100.0)
    );
    // The files are those that the machine runs with.
    assert!(
        folder
            .read("m/LASER-X.COM")
            .starts_with("LASER-X MM DATUM -2.4464 DIST ")
    );
    assert_eq!(folder.read("m/compensation.CMA"), "0 X=LASER-X\nACTIVE 0\n");
    assert!(
        folder
            .read("m/parameters.mp")
            .lines()
            .any(|line| line.starts_with("MP730    : %00001"))
    );
    let check = folder.bahn("machine check m");
    assert_eq!(check.code(), 0, "{}{}", check.out(), check.err());
    // Once more it finds the same, its own tables may be replaced.
    let again = folder.bahn("compensate m --axes X --warm-up 10 --write --format json");
    assert_eq!(again.json()["axes"][0]["errors"], axis["errors"]);
}

/// Encoders on the screws without pitch error: backlash is all there is, a TNC 360 has entries of 0.1 µm.
#[test]
fn backlash_alone_needs_no_table() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc360"), &folder.path("m"));
    let list = folder.read("m/parameters.mp");
    let run = folder.bahn("compensate m --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(
        folder.read("m/parameters.mp"),
        list,
        "without --write nothing is changed"
    );
    for (axis, backlash) in run.json()["axes"]
        .as_array()
        .unwrap()
        .iter()
        .zip([0.02, 0.02, 0.01])
    {
        assert!((number(axis, "/backlash_mm") - backlash).abs() < 0.0002, "{axis}");
        assert_eq!(axis["by_table"], false);
        assert!(number(axis, "/after_um") < 0.2, "{}", number(axis, "/after_um"));
    }
    let text = folder.bahn("compensate m --axes X");
    assert!(text.out().contains("MP710.0") && text.out().contains("nothing is changed"));
}

/// The knee mill with encoders on its screws: X has 20 µm of play and a screw that is 30 µm long on 600 mm, Z one that is
/// 8 µm short on 400 mm.
fn knee_mill(plays: [&str; 3]) -> Folder {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc155"), &folder.path("m"));
    let mut plant = folder.read("m/plant.toml");
    let screws = [
        ("X1", plays[0], ", errors_um = [[0, 0], [600, 30]]"),
        ("X2", plays[1], ""),
        ("X3", plays[2], ", errors_um = [[0, 0], [400, -8]]"),
    ];
    for (input, play, errors) in screws {
        let encoder = format!("encoder = {{ input = \"{input}\",");
        let (head, tail) = plant.split_once(&encoder).unwrap();
        let tail = tail.trim_start_matches(" on = \"motor\",");
        let (before, after) = head.rsplit_once("backlash = 0.01").unwrap();
        plant = format!(
            "{before}backlash = {play}{after}encoder = {{ input = \"{input}\", on = \"motor\"{errors},{tail}"
        );
    }
    folder.write("m/plant.toml", plant);
    folder
}

/// TNC 151/155: backlash is MP36 to MP39, mm [001:1789-1794], the linear error MP40 to MP43, mm/m [001:1797-1802]; both have
/// three decimals, and there are no tables. 30 µm on 600 mm are 0.05 mm/m, -8 µm on 400 mm are -0.02 mm/m.
#[test]
fn a_tnc_155_gets_backlash_and_linear_error_under_its_own_numbers() {
    let folder = knee_mill(["0.02", "0.01", "0"]);
    let run = folder.bahn("compensate m --write --format json");
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    let report = run.json();
    assert_eq!(report["written"], true);
    let truth = [
        (0.02, 0.05, "MP36", "MP40"),
        (0.01, 0.0, "MP37", "MP41"),
        (0.0, -0.02, "MP38", "MP42"),
    ];
    for (axis, (play, slope, backlash, linear)) in report["axes"].as_array().unwrap().iter().zip(truth) {
        assert!((number(axis, "/backlash_mm") - play).abs() <= 0.0011, "{axis}");
        assert!((number(axis, "/linear_mm_m") - slope).abs() <= 0.0021, "{axis}");
        assert_eq!(axis["by_table"], false);
        assert_eq!(
            (&axis["entries"][0]["parameter"], &axis["entries"][1]["parameter"]),
            (&backlash.into(), &linear.into())
        );
        // Half a step of each entry: 0.5 µm, and 0.0005 mm/m on 600 mm; a counting step of 1 µm.
        assert!(number(axis, "/after_um") < 2.0, "{axis}");
    }
    let list = folder.read("m/parameters.mp");
    let entry = |name: &str| -> f64 {
        let line = list
            .lines()
            .find(|line| line.split_whitespace().next() == Some(name));
        let value = line.unwrap().split_once(':').unwrap().1;
        value.split(';').next().unwrap().trim().parse().unwrap()
    };
    assert!((entry("MP36") - 0.02).abs() <= 0.0011, "{list}");
    assert!((entry("MP40") - 0.05).abs() <= 0.0021, "{list}");
    let check = folder.bahn("machine check m");
    assert_eq!(check.code(), 0, "{}{}", check.out(), check.err());
    let text = folder.bahn("compensate m --axes X");
    assert!(
        text.out().contains("MP36") && !text.out().contains("MP710"),
        "{}",
        text.out()
    );
}

/// A bump of 20 µm near the machine datum: the straight line through all points falls, so that the bump stands out of it by
/// more than 20 µm. Nothing is better than that line, nothing is written, and the exit code says so.
#[test]
fn what_gets_no_better_is_not_said_to_be_written() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc155"), &folder.path("m"));
    let plant = folder.read("m/plant.toml").replace(
        "encoder = { input = \"X1\",",
        "encoder = { input = \"X1\", errors_um = [[0, 0], [480, 0], [540, 20], [600, 0]],",
    );
    folder.write("m/plant.toml", plant);
    let list = folder.read("m/parameters.mp");
    let run = folder.bahn("compensate m --axes X --write");
    let json = folder.bahn("compensate m --axes X --format json").json();
    let (before, after) = (
        number(&json, "/axes/0/before_um"),
        number(&json, "/axes/0/after_um"),
    );
    assert!(before > 15.0 && after >= before, "{before} {after}");
    assert_eq!(run.code(), 1, "{}{}", run.out(), run.err());
    assert_eq!(folder.read("m/parameters.mp"), list);
    assert!(!run.out().contains("\nwritten"), "{}", run.out());
    assert!(run.out().contains("X gets no better"), "{}", run.out());
}

/// Scales on the tables see their play: there is nothing to write, and it is not said.
#[test]
fn a_machine_without_errors_keeps_its_list() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc155"), &folder.path("m"));
    let list = folder.read("m/parameters.mp");
    let run = folder.bahn("compensate m --axes X --write");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(run.out().ends_with("\nnothing is changed\n"), "{}", run.out());
    assert_eq!(folder.read("m/parameters.mp"), list);
}

/// A limit switch that lies before the software limit opens the EMERGENCY STOP chain: the run ends there.
#[test]
fn a_limit_switch_in_the_way_breaks_the_run_off() {
    let folder = Folder::new();
    copy(&machines().join("mill-tnc155"), &folder.path("m"));
    let plant = folder.read("m/plant.toml");
    folder.write(
        "m/plant.toml",
        plant.replace("limit_minus = { at = -5 }", "limit_minus = { at = 100 }"),
    );
    let run = folder.bahn("compensate m --axes X");
    assert_eq!(run.code(), 1, "{}", run.err());
    assert!(
        run.err().contains("cannot be measured: EMERGENCY STOP"),
        "{}",
        run.err()
    );
}

#[test]
fn wrong_use_says_what_is_right() {
    let folder = worn();
    for (arguments, code, expected) in [
        ("m --axes Q", 1, "no linear axis Q"),
        ("m --axes C", 1, "no linear axis C"),
        ("m --warm-up 500", 2, "0 to 480 minutes"),
        ("nowhere", 2, "nowhere"),
    ] {
        let run = folder.bahn(&format!("compensate {arguments}"));
        assert_eq!(run.code(), code, "{arguments}: {}", run.err());
        assert!(run.err().contains(expected), "{arguments}: {}", run.err());
    }
    // Tables of sag, which nobody measured here.
    let toml = folder
        .read("m/machine.toml")
        .replace("tools =", "compensation = \"SAG.CMA\"\ntools =");
    folder.write("m/machine.toml", toml);
    folder.write("m/SAG.CMA", "0 X=SAG\nACTIVE 0\n");
    folder.write("m/SAG.COM", "SAG MM DATUM 0 DIST 16 Z\n0 Z=0\n50 Z=0.01\n");
    let run = folder.bahn("compensate m --axes X --write");
    assert_eq!(run.code(), 2, "{}", run.err());
    assert!(
        run.err().contains("the table SAG, which was not measured here"),
        "{}",
        run.err()
    );
}
