//! `bahn machine`: folders of machines, whole and broken.

use crate::support::Folder;

const MODELS: [&str; 6] = ["tnc151", "tnc155", "tnc360", "tnc407", "tnc415b", "tnc425"];

/// A folder with a new machine `m`.
fn new(model: &str) -> Folder {
    let folder = Folder::new();
    let run = folder.bahn(&format!("machine new m --model {model} --name Test"));
    assert_eq!(run.code(), 0, "{}", run.err());
    folder
}

/// A positioning module is started from by its name alone: whoever asks for its model gets a mill.
#[test]
fn a_new_positioning_module_goes_beside_a_mill() {
    let folder = new("tnc360");
    assert!(!folder.read("m/machine.toml").contains("[module]"));
    let run = folder.bahn("machine new loader --model tnc360 --from module-tnc360");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert!(folder.read("loader/machine.toml").contains("[module]"));
    let check = folder.bahn("machine check loader");
    assert_eq!(check.code(), 0, "{}{}", check.out(), check.err());
    assert_eq!(folder.bahn("machine new mill --model tnc415b").code(), 0);
    let run = folder.bahn("run PALLET.H --machine mill --with loader --fresh --no-graphics --format json");
    assert_eq!(run.code(), 0, "{}{}", run.err(), run.out());
    assert_eq!(run.json()["module"]["axes"]["X"]["referenced"], true);
}

#[test]
fn a_new_machine_of_each_model_is_whole_and_runs() {
    for model in MODELS {
        let folder = new(model);
        let check = folder.bahn("machine check m --format json");
        assert_eq!(check.code(), 0, "{model}: {}", check.err());
        let report = &check.json()[0];
        assert_eq!(
            (&report["name"], &report["model"]),
            (&"Test".into(), &model.into())
        );
        let programs = ["INDEX.H", "COVER.H", "BLOCK.H"].into_iter();
        let mut program = programs.filter(|name| folder.path(&format!("m/programs/{name}")).exists());
        let program = program.next_back().unwrap();
        let run = folder.bahn(&format!("run {program} --machine m --no-graphics --fresh"));
        assert_eq!(run.code(), 0, "{model}: {}{}", run.err(), run.out());
    }
}

/// The part programs are checked with the tools and the control of the machine.
#[test]
fn the_part_programs_are_checked() {
    let folder = new("tnc360");
    let good = folder.bahn("machine check m --format json").json();
    assert_eq!(good[0]["programs"][0]["errors"], 0, "{good}");
    // Tool 77 is not in the table, M114 not on the control.
    folder.write(
        "m/programs/BAD.H",
        "BEGIN PGM BAD MM\nTOOL CALL 77 Z S500\nL X+5 R0 F100 M114\nEND PGM BAD MM\n",
    );
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    assert!(run.err().contains("BAD.H:2:"), "{}", run.err());
    assert!(run.err().contains("BAD.H:3:"), "{}", run.err());
    assert_eq!(
        folder.bahn("machine check m --format json").json()[0]["ok"],
        false
    );
}

#[test]
fn nothing_is_overwritten() {
    let folder = new("tnc360");
    folder.write("m/machine.toml", "mine");
    let run = folder.bahn("machine new m --model tnc360");
    assert_eq!(run.code(), 2);
    assert!(run.err().contains("not empty"), "{}", run.err());
    assert_eq!(folder.read("m/machine.toml"), "mine");
}

/// Replaces a text in a file.
fn edit(folder: &Folder, file: &str, from: &str, to: &str) {
    let text = folder.read(file);
    assert!(text.contains(from), "{file} has no `{from}`");
    folder.write(file, text.replacen(from, to, 1));
}

/// The line of a text in a file, from 1.
fn line(folder: &Folder, file: &str, part: &str) -> usize {
    folder
        .read(file)
        .lines()
        .position(|line| line.contains(part))
        .unwrap()
        + 1
}

/// Every file is broken in its way: all of them are named in one go, with file and line, by `check` and by
/// `run`.
#[test]
fn all_faults_of_all_files_are_named() {
    let folder = new("tnc415b");
    edit(&folder, "m/parameters.mp", "MP1010.0 : 15000", "MP1010.0 : fast");
    edit(
        &folder,
        "m/plant.toml",
        "[axis.Y]\noutput = \"2\"",
        "[axis.Y]\noutput = \"1\"",
    );
    edit(
        &folder,
        "m/plc/MAIN.PLC",
        "\n       EM",
        "\n       L     Q5\n       EM",
    );
    edit(&folder, "m/tools.tsv", "\n3\t85", "\nthree\t85");
    edit(&folder, "m/machine.toml", "X = 200", "V = 200");
    edit(&folder, "m/machine.toml", "\"CONFIRM\"]", "\"KONFIRM\"]");
    let lines = [
        (
            "parameters.mp",
            line(&folder, "m/parameters.mp", "fast"),
            "`fast` is no number",
        ),
        ("plc/MAIN.PLC", line(&folder, "m/plc/MAIN.PLC", "L     Q5"), ""),
        (
            "tools.tsv",
            line(&folder, "m/tools.tsv", "three"),
            "`three` is no tool number",
        ),
    ];
    for command in ["machine check m", "run INDEX.H --machine m --fresh"] {
        let run = folder.bahn(command);
        assert_eq!(run.code(), 1, "{command}: {}", run.err());
        let said = run.err();
        for (file, line, what) in lines {
            assert!(said.contains(&format!("{file}:{line}:")), "{file}:{line}\n{said}");
            assert!(said.contains(what), "{what}\n{said}");
        }
        assert!(said.contains("X and Y share an output"), "{said}");
    }
    // What must fit between the files shows when the files can be read.
    edit(
        &folder,
        "m/plant.toml",
        "[axis.Y]\noutput = \"1\"",
        "[axis.Y]\noutput = \"2\"",
    );
    let said = folder.bahn("machine check m").err();
    assert!(said.contains("parameters.mp:"), "{said}");
    let report = folder.bahn("machine check m --format json").json();
    assert_eq!(report[0]["ok"], false);
    assert!(report[0]["faults"].as_array().unwrap().len() >= 3);
}

#[test]
fn the_files_of_a_machine_fit_together() {
    let folder = new("tnc415b");
    edit(&folder, "m/machine.toml", "X = 200", "V = 200");
    edit(&folder, "m/machine.toml", "\"CONFIRM\"]", "\"KONFIRM\"]");
    let said = folder.bahn("machine check m").err();
    let datum = line(&folder, "m/machine.toml", "V = 200");
    let keys = line(&folder, "m/machine.toml", "tool_change");
    assert!(
        said.contains(&format!("machine.toml:{datum}:")) && said.contains("no axis V"),
        "{said}"
    );
    assert!(
        said.contains(&format!("machine.toml:{keys}:")) && said.contains("no key `KONFIRM`"),
        "{said}"
    );
}

#[test]
fn a_description_is_read_strictly() {
    let folder = new("tnc360");
    edit(&folder, "m/machine.toml", "plc = ", "plcc = ");
    edit(
        &folder,
        "m/machine.toml",
        "model = \"tnc360\"",
        "model = \"tnc999\"",
    );
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    let said = run.err();
    assert!(said.contains("the machine needs plc"), "{said}");
    assert!(said.contains("unknown key `plcc`"), "{said}");
    assert!(
        said.contains("`tnc999` is no control model; there are tnc151"),
        "{said}"
    );
    std::fs::remove_file(folder.path("m/tools.tsv")).unwrap();
    let said = folder.bahn("machine check m").err();
    let tools = line(&folder, "m/machine.toml", "tools = ");
    assert!(
        said.contains(&format!("machine.toml:{tools}:")) && said.contains("cannot read"),
        "{said}"
    );
}

/// A folder may describe no simulated machine: it is whole, and only a program with a plant of its own switches it on.
#[test]
fn a_folder_without_a_simulated_machine_is_whole() {
    let folder = new("tnc360");
    edit(&folder, "m/machine.toml", "plant = \"plant.toml\"", "");
    let check = folder.bahn("machine check m");
    assert_eq!(check.code(), 0, "{}", check.err());
    for command in ["machine list m", "run PLATE.H --machine m", "panel --machine m"] {
        let run = folder.bahn(command);
        let said = run.err();
        assert_eq!(run.code(), 2, "{command}: {said}");
        assert!(
            said.contains("the folder describes no simulated machine"),
            "{command}: {said}"
        );
    }
}

#[test]
fn a_list_names_what_scripts_can_speak_of() {
    let folder = new("tnc415b");
    let text = folder.bahn("machine list m").out();
    for part in [
        "axes      X Y Z C",
        "NC_START",
        "table_clamp",
        "override feed|spindle",
        "restore-at N",
        "expect tool=3",
        "MP4110.2=4",
        "power on|off",
        "X.table",
        "X41/34 X42/4",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

/// I63 and O127 are none of the inputs and outputs of the boards [000:11556-11567].
#[test]
fn wires_end_at_inputs_and_outputs_that_are_there() {
    let folder = new("tnc415b");
    let plant = folder.read("m/plant.toml");
    let wired = |plant: &str, from: &str, to: &str| {
        assert_eq!(plant.matches(from).count(), 1, "{from}");
        plant.replace(from, to)
    };
    let plant = wired(&plant, "\"I146\"", "\"I63\"");
    let plant = wired(&plant, "\"O18\"", "\"O127\"");
    folder.write("m/plant.toml", plant);
    let run = folder.bahn("machine check m");
    assert_eq!(run.code(), 1);
    for (wire, said) in [
        ("\"I63\"", "TNC 415 B has no input I63; there are I0-I31"),
        ("\"O127\"", "no output O127; there are O0-O30"),
    ] {
        let place = format!("plant.toml:{}:", line(&folder, "m/plant.toml", wire));
        assert!(
            run.err().contains(&place) && run.err().contains(said),
            "{}",
            run.err()
        );
    }
}

/// A jump in an open bracket: the bracket is shown where it was opened, as `plc check` shows it.
#[test]
fn faults_of_the_plc_program_show_what_was_opened() {
    let folder = new("tnc360");
    edit(
        &folder,
        "m/plc/MAIN.PLC",
        "\n       EM",
        "\n       L     M1\n       A[\n       JP    1\n       ]\n       =     M2\n       EM",
    );
    let opened = line(&folder, "m/plc/MAIN.PLC", "A[");
    for command in ["plc check m/plc/MAIN.PLC --model tnc360", "machine check m"] {
        let run = folder.bahn(command);
        assert_eq!(run.code(), 1, "{command}: {}", run.err());
        let shown = run.err();
        let mark = shown
            .find("opened here")
            .unwrap_or_else(|| panic!("{command}: {shown}"));
        assert!(
            shown[..mark].contains(&format!("\n{opened} |        A[")),
            "{command}: {shown}"
        );
    }
}

/// The TNC 151 and 155 have E0 to E62 and E64 to E126, A0 to A30 and A32 to A62 [001:297-323]; the others
/// those of [000:11556-11567].
#[test]
fn each_model_has_its_own_inputs_and_outputs() {
    for (model, there, missing) in [
        ("tnc155", ["I40", "I126", "O62"], ["I128", "I160", "O64"]),
        ("tnc151", ["I62", "I64", "O32"], ["I63", "I192", "O31"]),
        ("tnc415b", ["I128", "I254", "O94"], ["I40", "I63", "O63"]),
    ] {
        let folder = new(model);
        let plant = folder.read("m/plant.toml");
        let [input, output] = match model.starts_with("tnc15") {
            true => ["input_second = \"E18\"", "output = \"LUBRICATE\""],
            false => ["input_second = \"I18\"", "output = \"O24\""],
        };
        assert_eq!(
            (plant.matches(input).count(), plant.matches(output).count()),
            (1, 1)
        );
        let wired = |wire: &str| {
            let (from, key) = match wire.starts_with('I') {
                true => (input, "input_second"),
                false => (output, "output"),
            };
            folder.write(
                "m/plant.toml",
                plant.replace(from, &format!("{key} = \"{wire}\"")),
            );
            folder.bahn("machine check m").err()
        };
        for wire in there {
            let said = wired(wire);
            assert!(!said.contains("the wiring is wrong"), "{model} {wire}: {said}");
        }
        for wire in missing {
            let said = wired(wire);
            assert!(
                said.contains(&format!("put {wire}; there are ")),
                "{model} {wire}: {said}"
            );
        }
    }
}
