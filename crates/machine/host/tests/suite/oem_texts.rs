//! The dialogue texts of customized macros of a TNC 155 [001:2764-2823] [001:2895-2925].

use std::path::PathBuf;

use bahn_host::LoadedMachine;
use bahn_host::oem_cycles::{self, OemCycle};
use bahn_parameters::{ControlModel, ParameterList};

/// A folder with the bolt hole circle, which is removed in the end.
struct Folder(PathBuf);

impl Folder {
    fn new(block: &str) -> Folder {
        let name = format!("bahn-oem-texts-{}-{}", std::process::id(), block.len());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let text = format!("0 BEGIN PGM 99999968      MM P\n1 {block}\n2 END PGM 99999968      MM P\n");
        std::fs::write(folder.join("99999968.H"), text).unwrap();
        Folder(folder)
    }

    fn cycle(&self, texts: &[String], entries: &[&str]) -> OemCycle {
        let mut list = ParameterList::reference(ControlModel::Tnc155);
        for entry in entries {
            assert!(list.assign(entry).is_ok(), "{entry}");
        }
        oem_cycles::find(&self.0, texts, &list).unwrap().remove(0)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Texts 0 to 2 in the original language, 10 to 12 in English.
fn two_languages() -> Vec<String> {
    let mut texts = vec![String::new(); 13];
    for (number, text) in [
        (0, "LOCHKREIS"),
        (1, "ANZAHL DER BOHRUNGEN"),
        (2, "RADIUS"),
        (10, "BOLT HOLE CIRCLE"),
        (11, "NUMBER OF HOLES"),
    ] {
        texts[number] = text.to_owned();
    }
    texts
}

fn shown(cycle: &OemCycle) -> Vec<(u32, String)> {
    let dialog = cycle.dialog.as_ref().unwrap();
    let parameters = dialog.parameters.iter().map(|(q, text)| (*q, text.text.clone()));
    [(0, dialog.name.text.clone())]
        .into_iter()
        .chain(parameters)
        .collect()
}

fn rows(rows: &[(u32, &str)]) -> Vec<(u32, String)> {
    rows.iter().map(|(q, text)| (*q, (*text).to_owned())).collect()
}

/// In the English dialogue (MP92 + 2) the text has a number that is MP259 higher: dialogue 0 is 10 [001:2801-2823]; what has none
/// there has the text of the control [001:2911-2922]. Parameters of DLG-DEF begin behind MP263 [001:2784-2799].
#[test]
fn mp259_leads_to_the_english_texts() {
    let folder = Folder::new("DLG-DEF 0/1/2/ / /");
    let original = folder.cycle(&two_languages(), &["92=1", "259=10", "263=50"]);
    let german = [(0, "LOCHKREIS"), (51, "ANZAHL DER BOHRUNGEN"), (52, "RADIUS")];
    assert_eq!(shown(&original), rows(&german));
    let english = folder.cycle(&two_languages(), &["92=3", "259=10", "263=0"]);
    let expected = [
        (0, "BOLT HOLE CIRCLE"),
        (1, "NUMBER OF HOLES"),
        (2, "Cycl parameter 2"),
    ];
    assert_eq!(shown(&english), rows(&expected));
    let without = folder.cycle(&[], &["92=1"]);
    let expected = [(0, "User Cycl"), (1, "Cycl parameter 1"), (2, "Cycl parameter 2")];
    assert_eq!(shown(&without), rows(&expected));
}

/// Texts 0 to 99; 32 characters for a parameter [001:2764] [001:2925]. The name may have 14, and that of the manual's example has
/// 16 [001:2908]: it is taken.
#[test]
fn texts_keep_to_their_limits() {
    let folder = Folder::new("DLG-CALL 0/1/100");
    let mut texts = vec![String::new(); 101];
    texts[0] = "BOLT HOLE CIRCLES".to_owned();
    texts[1] = "A".repeat(33);
    texts[100] = "RADIUS".to_owned();
    let expected = [
        "dialogue 0 has 17 characters, 16 fit",
        "dialogue 1 has 33 characters, 32 fit",
        "dialogue 100: the texts have the numbers 0 to 99",
    ];
    assert_eq!(folder.cycle(&texts, &[]).faults(false), expected);
}

/// A machine whose macro has no dialogue block, and another that repeats a part in the EPROM, is switched on all the same, and says
/// at the files what `bahn oem list` says.
#[test]
fn a_machine_says_what_is_wrong_with_its_macros() {
    let copy = crate::support::Copy::of("mill-tnc155", "macros");
    let programs = copy.path().join("programs");
    std::fs::create_dir_all(programs.join("eprom")).unwrap();
    let program =
        |number: u32, blocks: &str| format!("BEGIN PGM {number} MM\n{blocks}\nEND PGM {number} MM\n");
    let of_68 = programs.join("99999968.H");
    std::fs::write(&of_68, program(99_999_968, "L X+1 R0 F500")).unwrap();
    let of_69 = programs.join("eprom/99999969.H");
    let repeats = "DLG-DEF 0\nLBL 1\nCALL LBL 1 REP 2/2";
    std::fs::write(&of_69, program(99_999_969, repeats)).unwrap();
    let machine = LoadedMachine::load(copy.path()).unwrap().unwrap();
    let said: Vec<_> = machine
        .warnings
        .iter()
        .map(|warning| (warning.file.clone(), warning.message.clone()))
        .collect();
    let no_block = "cycle 68 of the machine builder: no dialogue block DLG-DEF or DLG-CALL";
    let repeat = "cycle 69 of the machine builder: line 4: CALL LBL REP must not stand in the EPROM";
    assert_eq!(said, [(of_68, no_block.to_owned()), (of_69, repeat.to_owned())]);
}
