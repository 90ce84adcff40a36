//! `bahn oem`: cycles of the machine builder with their dialogues, and EPROMs with them [000:17691-17984]
//! [000:11388-11412].

use crate::support::Folder;
use serde_json::Value;

/// The bolt hole circle with its dialogues; cycle 69 in the EPROM, 70 in both.
fn machine() -> Folder {
    let folder = Folder::new();
    assert_eq!(folder.bahn("machine new m --model tnc415b").code(), 0);
    let toml = std::fs::read_to_string(folder.path("m/machine.toml")).unwrap();
    let toml = toml.replacen("\"plc/DIALOG.TXT\"", "\"plc/MAIN.DI1\"", 1);
    folder.write("m/machine.toml", &toml);
    folder.write(
        "m/plc/MAIN.DI1",
        "BOLT HOLE CIRCLE\nNUMBER OF HOLES?\nRADIUS?\nX COORDINATE CC?\nY COORDINATE CC?\nSAFETY CLEARANCE?\n\
         TOTAL HOLE DEPTH?\nFEED RATE?\nSHIFT\nA TEXT OF MORE THAN THIRTY-FOUR CHARACTERS\n",
    );
    // The mill has a cycle 68 of its own in the EPROM.
    std::fs::remove_dir_all(folder.path("m/programs/eprom")).unwrap();
    std::fs::create_dir(folder.path("m/programs/eprom")).unwrap();
    let cycle = |number: u32, blocks: &str| {
        let name = 99_999_900 + number;
        format!("BEGIN PGM {name} MM\n{blocks}\nEND PGM {name} MM\n")
    };
    folder.write(
        "m/programs/99999968.H",
        cycle(
            68,
            "DLG-CALL 0/1/2/3/4/5/6/7\nFN 1: Q6 = +Q6 + +Q5\nFN 4: Q50 = +360 DIV +Q1\nFN 0: Q60 = +0\nCC X+Q3 Y+Q4\n\
             LBL 11\nLP PR+Q2 PA+Q60 R0 FMAX\nL IZ+Q6 FQ7\nL IZ-Q6 FMAX\nFN 1: Q60 = +Q60 + +Q50\n\
             FN 12: IF +Q60 LT +360 GOTO LBL 11",
        ),
    );
    folder.write("m/programs/eprom/99999969.H", cycle(69, "DLG-DEF 8/2"));
    folder.write("m/programs/99999970.H", cycle(70, "DLG-DEF 0"));
    folder.write("m/programs/eprom/99999970.H", cycle(70, "DLG-DEF 8"));
    folder
}

/// Names and parameters are the dialogue texts; the parameters of DLG-DEF cycles count from MP7250 on; with MP7240 = 0 the
/// EPROM goes before the program memory.
#[test]
fn cycles_are_listed_with_their_dialogues() {
    let folder = machine();
    let run = folder.bahn("oem list m");
    assert_eq!(run.code(), 0, "{}", run.err());
    let out = run.out();
    assert!(
        out.starts_with(
            "68 BOLT HOLE CIRCLE: program memory, acts at the cycle call\n   Q1   NUMBER OF HOLES?\n"
        ),
        "{out}"
    );
    assert!(out.contains("   Q7   FEED RATE?\n"), "{out}");
    assert!(
        out.contains("69 SHIFT: EPROM, acts at its definition, inhibited by M2241\n   Q1   RADIUS?\n"),
        "{out}"
    );
    let list = |replaced: &[(&str, &str)]| -> Value {
        let name = "m/parameters.mp";
        let mut text = std::fs::read_to_string(folder.path(name)).unwrap();
        for (mp, value) in replaced {
            let line = text.lines().find(|line| line.starts_with(mp)).unwrap().to_owned();
            text = text.replace(&line, &format!("{mp} : {value}"));
        }
        folder.write(name, &text);
        serde_json::from_str(&folder.bahn("oem list m --format json").out()).unwrap()
    };
    let hidden = |list: &Value| {
        let of_70 = list
            .as_array()
            .unwrap()
            .iter()
            .filter(|cycle| cycle["number"] == 70);
        of_70
            .filter(|cycle| cycle["hidden"] == true)
            .map(|cycle| cycle["memory"].clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(hidden(&list(&[("MP7240", "0")])), ["program memory"]);
    let changed = list(&[("MP7240", "1"), ("MP7250", "30")]);
    assert_eq!(hidden(&changed), ["EPROM"]);
    let shift = &changed.as_array().unwrap()[1];
    assert_eq!(
        (&shift["number"], &shift["parameters"][0]["q"]),
        (&69.into(), &31.into())
    );
    assert_eq!(shift["parameters"][0]["dialogue"], 2);
    // A text that does not fit, none at all, and no dialogue block.
    folder.write(
        "m/programs/99999971.H",
        "BEGIN PGM 99999971 MM\nDLG-DEF 9/20\nEND PGM 99999971 MM\n",
    );
    folder.write(
        "m/programs/99999972.H",
        "BEGIN PGM 99999972 MM\nL X+1 FMAX\nEND PGM 99999972 MM\n",
    );
    let run = folder.bahn("oem list m");
    assert_eq!(run.code(), 1);
    for fault in [
        "dialogue 9 has 42 characters, 34 fit",
        "dialogue 20 has no text",
        "no dialogue block DLG-DEF or DLG-CALL",
    ] {
        assert!(run.out().contains(fault), "{fault}: {}", run.out());
    }
}

/// A list as in the manual: PLC program, messages, dialogues, cycles of program memory and EPROM. What the records hold is
/// what is in the files; each record has the check sum of the format, computed here byte by byte.
#[test]
fn an_eprom_goes_out_and_comes_back() {
    let folder = machine();
    folder.write(
        "LIST.TXT",
        "IDENT  123 456 99\nLOAD   MAIN.PLC /M\nLOAD   MAIN.DI1\nLOAD   999 999 68.H\nLOAD   999 999 69.H\n",
    );
    let run = folder.bahn("oem export m LIST.TXT --output EPROM.S3");
    assert_eq!(run.code(), 0, "{}", run.err());
    let records = std::fs::read_to_string(folder.path("EPROM.S3")).unwrap();
    let kinds: Vec<&str> = records.lines().map(|line| &line[..2]).collect();
    assert_eq!((kinds[0], kinds[kinds.len() - 1]), ("S0", "S7"));
    assert!(kinds[1..kinds.len() - 1].iter().all(|kind| *kind == "S3"));
    for line in records.lines() {
        let bytes: Vec<u32> = (2..line.len())
            .step_by(2)
            .map(|i| u32::from_str_radix(&line[i..i + 2], 16).unwrap())
            .collect();
        assert_eq!(bytes[0] as usize, bytes.len() - 1);
        assert_eq!(bytes.iter().sum::<u32>() % 256, 255, "{line}");
    }
    std::fs::create_dir(folder.path("back")).unwrap();
    let run = folder.bahn("oem import EPROM.S3 --to back");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(
        run.out().starts_with("IDENT 12345699\nLOAD MAIN.PLC/M, "),
        "{}",
        run.out()
    );
    for (name, from) in [
        ("MAIN.PLC", "m/plc/MAIN.PLC"),
        ("MAIN.DI1", "m/plc/MAIN.DI1"),
        ("99999968.H", "m/programs/99999968.H"),
        ("99999969.H", "m/programs/eprom/99999969.H"),
    ] {
        let [there, here] = [folder.path(&format!("back/{name}")), folder.path(from)]
            .map(|path| std::fs::read(path).unwrap());
        assert_eq!(there, here, "{name}");
    }
    // What is there stays.
    assert_eq!(folder.bahn("oem import EPROM.S3 --to back").code(), 2);
    assert_eq!(folder.bahn("oem import EPROM.S3 --to back --force").code(), 0);
    // A digit that has changed, a record that is missing, an end that is missing.
    let lines: Vec<&str> = records.lines().collect();
    let changed = records.replacen("S3250000004", "S3250000014", 1);
    assert_ne!(changed, records);
    let missing = lines
        .iter()
        .enumerate()
        .filter(|(n, _)| *n != 2)
        .map(|(_, line)| format!("{line}\n"))
        .collect::<String>();
    let ended = lines[..lines.len() - 1].join("\n");
    for (text, fault) in [
        (changed, "the check sum is wrong"),
        (missing, "address 00000040 where 00000020 follows"),
        (ended, "the end record S7 is missing"),
    ] {
        folder.write("BAD.S3", &text);
        let run = folder.bahn("oem import BAD.S3");
        assert_eq!(run.code(), 1);
        assert!(run.err().contains(fault), "{fault}: {}", run.err());
    }
}

#[test]
fn wrong_lists_are_refused() {
    let folder = machine();
    folder.write(
        "m/programs/99999972.H",
        "BEGIN PGM 99999972 MM\nL X+1 FMAX\nEND PGM 99999972 MM\n",
    );
    folder.write(
        "m/programs/99999973.H",
        "BEGIN PGM 99999973 MM\nDLG-DEF 0\nLBL 1\nCALL LBL 1 REP 2/2\nEND PGM 99999973 MM\n",
    );
    // In the program memory it may stand.
    assert!(!folder.bahn("oem list m").out().contains("REP"));
    for (list, place, fault) in [
        ("LOAD MAIN.PLC\n", "LIST.TXT:1:1", "the first line is IDENT"),
        ("IDENT 123\n", "LIST.TXT:1:7", "has eight digits"),
        ("IDENT 123 456 99\n", "LIST.TXT", "the list names no file"),
        (
            "IDENT 123 456 99\nSIZE 4MB\nLOAD MAIN.PLC\n",
            "LIST.TXT:2:6",
            "the size is 2MB",
        ),
        (
            "IDENT 123 456 99\nLOAD MAIN.PLC\nLOAD main.plc\n",
            "LIST.TXT:3:6",
            "is loaded twice",
        ),
        (
            "IDENT 123 456 99\nLOAD NOBODY.PLC\n",
            "LIST.TXT:2:1",
            "there is no file NOBODY.PLC",
        ),
        (
            "IDENT 123 456 99\nLOAD ../m/machine.toml\n",
            "LIST.TXT:2:6",
            "no name of a file",
        ),
        (
            "IDENT 123 456 99\nLOAD 999 999 72.H\n",
            "LIST.TXT:2:1",
            "no dialogue block",
        ),
        (
            "IDENT 123 456 99\nLOAD 999 999 73.H\n",
            "LIST.TXT:2:1",
            "line 4: CALL LBL REP must not stand in the EPROM",
        ),
        (
            "IDENT 123 456 99\nSTORE MAIN.PLC\n",
            "LIST.TXT:2:1",
            "a line is IDENT, SIZE or LOAD",
        ),
    ] {
        folder.write("LIST.TXT", list);
        let run = folder.bahn("oem export m LIST.TXT");
        assert_eq!(run.code(), 1, "{list}");
        let err = run.err();
        assert!(err.contains(place) && err.contains(fault), "{list}: {err}");
    }
    // 1 Mbit are 131072 bytes: SIZE 2MB takes twice as many.
    folder.write("m/plc/LARGE.A", "x".repeat(140_000));
    for (size, code) in [("", 1), ("SIZE 2MB\n", 0)] {
        folder.write("LIST.TXT", format!("IDENT 123 456 99\n{size}LOAD LARGE.A\n"));
        assert_eq!(
            folder.bahn("oem export m LIST.TXT --output LARGE.S3").code(),
            code,
            "{size}"
        );
    }
}

/// The macros of a TNC 155, with the PLC program and the texts of their dialogues: they go into an EPROM, come out of it, and the
/// machine runs the bolt circle from there, with nothing of it in its program memory: 28 strokes [001:2962-3021].
#[test]
fn macros_of_a_tnc_155_run_from_the_eprom() {
    let folder = Folder::new();
    assert_eq!(folder.bahn("machine new m --model tnc155").code(), 0);
    let texts = "BOLT HOLE CIRCLE\nNUMBER OF HOLES\nRADIUS\nX CENTRE\nY CENTRE\nSET UP\nDEPTH\nFEED\n";
    folder.write("m/DIALOG.TXT", texts);
    let toml = std::fs::read_to_string(folder.path("m/machine.toml")).unwrap();
    // The image of the PLC program is what MP77 = 1 runs.
    let toml = toml.replacen(
        "plc = \"standard\"",
        "plc_dialogues = \"DIALOG.TXT\"\nplc = \"MAIN.PLC\"",
        1,
    );
    folder.write("m/machine.toml", &toml);
    folder.write("m/MAIN.PLC", folder.bahn("plc standard").out());
    let bolts = "DLG-DEF 0/1/2/3/4/5/6/7/ / / /\nFN 1 : Q6 = + Q6 + +Q5\nFN 4 : Q50 = +360.000 DIV +Q1\nFN 0 : Q60 = +0.000\n\
         CC X+Q3 Y+Q4\nLBL 11\nLP PR+Q2 PA+Q60 R0 F15999 M\nL IZ+Q6 R0 FQ7 M\nFN 1 : Q90 = +Q90 + +1\nL IZ-Q6 R0 F15999 M\n\
         FN 1 : Q60 = +Q60 + +Q50\nFN 12 : IF +Q60 LT +361.000 GOTO LBL 11";
    folder.write(
        "m/programs/99999968.H",
        format!("BEGIN PGM 99999968 MM P\n{bolts}\nEND PGM 99999968 MM P\n"),
    );
    folder.write(
        "LIST.TXT",
        "IDENT  155 000 01\nLOAD   MAIN.PLC /M\nLOAD   999 999 68.H\nLOAD   DIALOG.TXT\n",
    );
    let run = folder.bahn("oem export m LIST.TXT --output EPROM.S3");
    assert_eq!(run.code(), 0, "{}", run.err());
    for ram in ["m/programs/99999968.H", "m/MAIN.PLC"] {
        std::fs::remove_file(folder.path(ram)).unwrap();
    }
    std::fs::create_dir_all(folder.path("m/programs/eprom")).unwrap();
    std::fs::create_dir_all(folder.path("m/eprom")).unwrap();
    std::fs::create_dir(folder.path("out")).unwrap();
    assert_eq!(folder.bahn("oem import EPROM.S3 --to out").code(), 0);
    for (from, to) in [
        ("99999968.H", "m/programs/eprom/99999968.H"),
        ("MAIN.PLC", "m/eprom/MAIN.PLC"),
    ] {
        std::fs::copy(folder.path(&format!("out/{from}")), folder.path(to)).unwrap();
    }
    let list = folder.bahn("oem list m");
    assert_eq!(list.code(), 0, "{}{}", list.out(), list.err());
    assert!(
        list.out()
            .starts_with("68 BOLT HOLE CIRCLE: EPROM, acts at its definition"),
        "{}",
        list.out()
    );
    folder.write(
        "1000.H",
        "BEGIN PGM 1000 MM\nTOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S500\nL Z+20 R0 F5000 M03\nCYCL DEF 68.0 BOLT HOLE CIRCLE\n\
         CYCL DEF 68.1 Q1 = +27,000 Q2 = +40,000 Q3 = +50,000\nCYCL DEF 68.2 Q4 = +50,000 Q5 = -2,000 Q6 = -20,000\n\
         CYCL DEF 68.3 Q7 = +2000,000 Q8 = Q9 =\nCYCL CALL M\nL Z+30 R0 F5000\nEND PGM 1000 MM\n",
    );
    let run =
        folder.bahn("run 1000.H --machine m --fresh --no-graphics --record r.csv --signals Q90 --every 20");
    assert_eq!(run.code(), 0, "{}{}", run.out(), run.err());
    let table = folder.read("r.csv");
    let strokes = table
        .lines()
        .filter_map(|line| line.split(',').nth(1)?.parse::<f64>().ok());
    assert_eq!(strokes.fold(0.0, f64::max), 28.0);
}
