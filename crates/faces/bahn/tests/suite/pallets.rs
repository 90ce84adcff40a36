//! Pallet file and datum tables in the folder of a machine: modules 9090 and 9094 and cycle 7 in the product.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::support::Folder;

/// FN4: module 9090 with line 3 of the pallet file. FN5: module 9094 writes X = 12.5 mm into line 7 of the table.
const KEYS: &str = "\
       L     I141
       AN    M86
       CMT   PALLET
       L     I141
       = M86
       L     I142
       AN    M87
       CMT   TABLE_7
       L     I142
       = M87
";
const JOBS: &str = "
LBL PALLET
       SUBM  PALLET_3
       = B120
       EM
LBL PALLET_3
       PS    K+3
       CM    9090
       PL    W112
       EM
LBL TABLE_7
       SUBM  WRITE_7
       = B121
       EM
LBL WRITE_7
       PS    K+1
       PS    K+7
       PS    K+0
       PS    K+125000
       CM    9094
       PL    W114
       EM
";

/// The machine `m` with a pallet file and two datum tables; the program of line 3 shifts the datum by line 7.
fn machine() -> Folder {
    let folder = Folder::new();
    let run = folder.bahn("machine new m --model tnc415b --name Test");
    assert_eq!(run.code(), 0, "{}", run.err());
    let plc = folder.read("m/plc/MAIN.PLC");
    let with_keys = plc.replacen("LBL TOOL\n", &format!("LBL TOOL\n{KEYS}"), 1);
    assert_ne!(plc, with_keys);
    folder.write("m/plc/MAIN.PLC", with_keys + JOBS);
    let toml = folder.read("m/machine.toml");
    let named = toml.replacen(
        "\nprograms = ",
        "\npallets = \"JOBS.P\"\ndatum_table = \"ONE.D\"\nprograms = ",
        1,
    );
    assert_ne!(toml, named);
    folder.write("m/machine.toml", named);
    folder.write(
        "m/programs/JOBS.P",
        "NR\tPGM\tDATUM\n0\tCIRCLE\t-\n3\tshifted\tTWO\n",
    );
    folder.write("m/programs/ONE.D", "NR X Y\n7 10 20\n");
    folder.write("m/programs/two.d", "NR X Y\n0 0 0\n7 -15 30\n");
    folder.write(
        "m/programs/SHIFTED.H",
        "BEGIN PGM SHIFTED MM\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #7\nL X+60 Y+70 R0 F6000\nEND PGM SHIFTED MM\n",
    );
    folder
}

/// The process is killed when what module 9090 selected and module 9094 wrote is in the state; started again, the
/// program of the pallet runs at the datum that was written.
#[test]
fn killed_and_started_again_the_pallet_is_selected() {
    let folder = machine();
    folder.write(
        "select.txt",
        "25: mode full\n+1: key FN4 tap\n+1: key FN5 tap\n+80000: end\n",
    );
    let mut child = folder
        .command()
        .args("run --machine m --script select.txt --max-wait 86400 --no-graphics".split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let since = Instant::now();
    let state = || std::fs::read_to_string(folder.path("m/state/control.toml")).unwrap_or_default();
    while !state().contains("written_datums") {
        let ended = child.try_wait().unwrap();
        assert!(
            since.elapsed() < Duration::from_secs(120) && ended.is_none(),
            "{}",
            state()
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    for line in [
        "program = \"SHIFTED.H\"",
        "pallet_line = 3",
        "datum_table = \"TWO.D\"",
        "[\"TWO.D\", 7, 0, 12.5, -15.0]",
    ] {
        assert!(state().contains(line), "{line}\n{}", state());
    }
    // From the machine datum: 200 + 60 + 12.5, 120 + 70 + 30.
    folder.write(
        "start.txt",
        "50: mode full\n+1: key NC_START tap\n+20: expect run ended\n+0: expect X.actual=272.5±0.01\n\
         +0: expect Y.actual=220±0.01\n+0.1: end\n",
    );
    let run = folder.bahn("run --machine m --script start.txt --no-graphics");
    assert_eq!(run.code(), 0, "{}{}", run.err(), run.out());
    // A table that is gone is no other table: the machine is on, and the block that wants a datum of it is refused.
    std::fs::remove_file(folder.path("m/programs/two.d")).unwrap();
    let run = folder.bahn("run --machine m --script start.txt --no-graphics");
    let said = "TWO.D, the datum table that module 9090 selected, is missing";
    assert!(run.code() == 1 && run.err().contains(said), "{}", run.err());
    let all = run.out() + &run.err();
    assert!(all.contains("ENTRY VALUE INCORRECT"), "{all}");
}

/// All faults of all tables, at their lines; a name that is nowhere, at its key.
#[test]
fn faults_of_the_tables_are_found() {
    let folder = machine();
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 0, "{}", run.err());
    folder.write("m/programs/two.d", "NR X Y\n0 0 0\n7 1O 30\n");
    folder.write("m/programs/JOBS.P", "NR PGM DATUM\n0 CIRCLE\n0 SHIFTED\n");
    let toml = folder.read("m/machine.toml").replace("ONE.D", "GONE.D");
    let line = 1 + toml.lines().position(|line| line.contains("GONE.D")).unwrap();
    folder.write("m/machine.toml", toml);
    let run = folder.bahn("machine check m");
    let said = run.err();
    assert_eq!(run.code(), 1, "{said}");
    let at_the_key = format!("machine.toml:{line}:");
    for part in [
        "two.d:3:",
        "`1O` is no number",
        "JOBS.P:3:",
        &at_the_key,
        "no datum table GONE.D",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
}

/// `bahn test` and `bahn machine check` take the datum table of the machine; without one the block is refused.
#[test]
fn a_test_run_on_the_machine_shifts() {
    let folder = machine();
    let run = folder.bahn("test m/programs/SHIFTED.H --machine m --path path.csv");
    assert_eq!(run.code(), 0, "{}{}", run.err(), run.out());
    let path = folder.read("path.csv");
    let head: Vec<&str> = path.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = path.lines().last().unwrap().split(',').collect();
    let of = |name: &str| -> f64 {
        let at = head.iter().position(|column| *column == name);
        last[at.unwrap_or_else(|| unreachable!("{head:?}"))]
            .parse()
            .unwrap()
    };
    assert_eq!((of("X"), of("Y")), (70.0, 90.0), "{path}");
    let run = folder.bahn("test m/programs/SHIFTED.H --model tnc415b");
    assert!(
        run.code() == 1 && run.err().contains("no datum table is selected"),
        "{}",
        run.err()
    );
    folder.write("m/programs/ONE.D", "NR X Y\n6 10 20\n");
    let run = folder.bahn("machine check m");
    assert!(
        run.code() == 1 && run.err().contains("the datum table has no line 7"),
        "{}",
        run.err()
    );
}
