//! `bahn test` on the control of a machine, and with parameters of the command line.

use crate::support::Folder;

/// FN14 shows the texts of the machine: 300 is PLC message 0, 400 dialogue 0 [003:4364-4367].
#[test]
fn fn14_shows_the_texts_of_the_machine() {
    let folder = Folder::with_program("FN14: ERROR= 302");
    let message = |options: &str| {
        let run = folder.bahn(&format!("test main.H --format json {options}"));
        run.json()["error"]["message"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    let made = folder.bahn("machine new m --model tnc360");
    assert_eq!(made.code(), 0, "{}", made.err());
    let description = folder.read("m/machine.toml");
    let texts = |key: &str| {
        let name = description
            .lines()
            .find_map(|line| {
                line.strip_prefix(key)?
                    .trim()
                    .strip_prefix('=')?
                    .trim()
                    .strip_prefix('"')
            })
            .map(|name| name.trim_end_matches('"').to_owned());
        name.unwrap_or_else(|| panic!("{key} in {description}"))
    };
    let file = format!("m/{}", texts("plc_messages"));
    folder.write(&file, "NONE\nONE\nCLOSE THE DOOR\n");
    assert_eq!(message("--model tnc360"), "PLC ERROR 02");
    assert_eq!(message("--machine m"), "CLOSE THE DOOR");
    // Model, parameters and tools are those of the machine, too.
    let run = folder.bahn("test main.H --machine m --model tnc360");
    assert_eq!(run.code(), 2, "{}", run.err());
    folder.write(
        "main.H",
        "BEGIN PGM MAIN MM\nTOOL CALL 77 Z S500\nEND PGM MAIN MM\n",
    );
    assert_eq!(message("--machine m"), "TOOL NOT DEFINED");
    let text = folder.bahn("test main.H --machine m --report shelf.json");
    assert!(
        text.out().contains("TOOL NOT DEFINED"),
        "{}{}",
        text.out(),
        text.err()
    );
    folder.write("m/plc/MAIN.PLC", "EM X\n");
    let broken = folder.bahn("test main.H --machine m");
    assert_eq!(broken.code(), 2);
    assert!(
        broken.err().contains("`bahn machine check` shows all"),
        "{}",
        broken.err()
    );
}

/// A parameter of the command line that does nothing here, or only part of it, is told so.
#[test]
fn parameters_of_the_command_line_say_what_they_do_not() {
    let folder = Folder::with_program("L X+1 R0 FMAX");
    let made = folder.bahn("machine new m --model tnc415b");
    assert_eq!(made.code(), 0, "{}", made.err());
    for command in [
        "test main.H",
        "test main.H --report shelf.json",
        "run main.H --machine m --fresh --no-graphics",
    ] {
        let run = folder.bahn(&format!("{command} --mp 7315=1,7310=1,1060.0=2"));
        assert_eq!(run.code(), 0, "{command}: {}", run.err());
        let said = run.err();
        assert!(
            said.contains(
                "warning: --mp 7315=1: MP7315 has no effect here: no graphics without TOOL CALL, none that M functions start"
            ),
            "{command}: {said}"
        );
        assert!(
            said.contains("--mp 7310=1: MP7310 acts in part here, without: "),
            "{command}: {said}"
        );
        assert!(!said.contains("MP1060"), "{command}: {said}");
    }
}

/// A list of machine parameters that says which axes there are (MP10) and what they are called (MP410) means these alone
/// [000:3174-3182, 3350-3370]; without one of both all axes may be programmed.
#[test]
fn axes_of_a_list() {
    let folder = Folder::with_program("L X+0 R0 F500\nL C+90 R0 F500");
    folder.write("three.mp", "MP10 : %00111\n");
    folder.write("named.mp", "MP10 : %01111\nMP410.3 : 2\n");
    folder.write("other.mp", "MP1010.0 : 8000\n");
    for (options, has_c) in [
        ("--parameters three.mp", false),
        ("--parameters named.mp", true),
        ("--parameters named.mp --mp 410.3=0", false),
        ("--parameters other.mp", true),
        ("--mp 10=%00111", false),
        ("--mp 1010.0=8000", true),
        ("", true),
    ] {
        let run = folder.bahn(&format!(
            "test main.H --model tnc415b --no-graphics --format json {options}"
        ));
        assert_eq!(run.code(), i32::from(!has_c), "{options}: {}", run.err());
        if !has_c {
            let error = &run.json()["error"];
            assert_eq!(error["message"], "WRONG AXIS PROGRAMMED", "{options}");
            assert_eq!(error["detail"], "there is no axis C here", "{options}");
        }
    }
}

/// A program that moves an axis which the machine lacks, a slave or an axis of the PLC is WRONG AXIS PROGRAMMED in the test run and
/// for `machine check`, as on the running control; so is one axis too many in a block that also moves others. Without a machine
/// there is nothing that lacks.
#[test]
fn axes_that_the_machine_has_not_for_programs() {
    for (name, block, reason) in [
        ("mill", "L X+10 V+5 R0 F500", "there is no axis V here"),
        ("gantry", "L U+5 R0 F500", "U follows its master (MP850)"),
        ("dig425", "L W+5 R0 F500", "the PLC alone moves W (MP60)"),
    ] {
        let folder = Folder::with_program(&format!("L X+0 R0 F500\n{block}"));
        let model = if name == "dig425" { "tnc425" } else { "tnc415b" };
        let made = folder.bahn(&format!("machine new m --from {name} --model {model}"));
        assert_eq!(made.code(), 0, "{}", made.err());
        let run = folder.bahn("test main.H --machine m --no-graphics --format json");
        assert_eq!(run.code(), 1, "{name}: {}", run.err());
        let error = &run.json()["error"];
        assert_eq!(error["message"], "WRONG AXIS PROGRAMMED", "{name}");
        assert_eq!(
            (error["block"].as_u64(), error["detail"].as_str()),
            (Some(2), Some(reason))
        );
        let alone = folder.bahn("test main.H --model tnc415b --no-graphics");
        assert_eq!(alone.code(), 0, "{name}: {}", alone.err());
        folder.write("m/programs/BAD.H", folder.read("main.H"));
        let check = folder.bahn("machine check m");
        assert_eq!(check.code(), 1, "{name}: {}", check.err());
        let said = check.out().to_owned() + &check.err();
        assert!(
            said.contains("WRONG AXIS PROGRAMMED") && said.contains(reason),
            "{name}: {said}"
        );
    }
}
