//! `[[function]]` of machine.toml: M functions with a synchronisation of the machine builder's own.

use crate::support::*;
use bahn_host::LoadedMachine;
use bahn_parameters::own_functions::OwnFunction;
use bahn_path::{Ahead, At, Synchronisation};

fn load(what: &str, functions: &str) -> Result<LoadedMachine, Vec<(String, String)>> {
    let copy = Copy::of("mill", what);
    let file = copy.path().join("machine.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, format!("{text}\n{functions}")).unwrap();
    LoadedMachine::load(copy.path()).unwrap().map_err(|faults| {
        let marked = |fault: &bahn_text::Diagnostic| (fault.source.trim().to_owned(), fault.detail.clone());
        faults.iter().map(marked).collect()
    })
}

#[test]
fn functions_are_read() {
    let machine = load(
        "own-functions",
        "[[function]]\nm = [70, 71]\nsynchronisation = \"MEP_SVS\"\nlead = 25\n\
         [[function]]\nm = [72]\nsynchronisation = \"MET_MOS\"\nlead_ms = 300\n\
         [[function]]\nm = [73]\nsynchronisation = \"EXPL_SYN\"\n",
    );
    let functions = machine.unwrap().functions;
    let out = |at, synchronisation| Some(OwnFunction::Out { at, synchronisation });
    let ahead = out(At::Ahead(Ahead::Distance(25.0)), Synchronisation::MepSvs);
    assert_eq!([70, 71].map(|code| functions.get(code)), [ahead; 2]);
    assert_eq!(
        functions.get(72),
        out(At::Ahead(Ahead::Time(0.3)), Synchronisation::MetMos)
    );
    assert_eq!(functions.get(73), Some(OwnFunction::Point));
    assert_eq!(functions.get(74), None);
}

/// What the control does itself keeps its synchronisation; a lead stands where the type needs one.
#[test]
fn faults_stand_at_their_lines() {
    let faults = load(
        "wrong-functions",
        "[[function]]\nm = [3, 70]\nsynchronisation = \"MVS_SNS\"\n\
         [[function]]\nm = [70]\nsynchronisation = \"MOS\"\n\
         [[function]]\nm = [74]\nsynchronisation = \"MEP_SVS\"\n\
         [[function]]\nm = [75]\nsynchronisation = \"MVS_SVS\"\nlead = 5\n\
         [[function]]\nm = [76]\nsynchronisation = \"MNE_SNS\"\n\
         [[function]]\nsynchronisation = \"MOS\"\n",
    )
    .err()
    .unwrap();
    let has = |line: &str, label: &str| {
        let found = faults
            .iter()
            .any(|(text, own)| text.starts_with(line) && own.contains(label));
        assert!(found, "{line}: {label}\n{faults:#?}");
    };
    has("m = [3, 70]", "M3 is no free function of this control");
    has("m = [70]", "M70 stands there twice");
    has("synchronisation = \"MEP_SVS\"", "the type needs `lead`, mm");
    has("synchronisation = \"MVS_SVS\"", "the type has no lead");
    has(
        "synchronisation = \"MNE_SNS\"",
        "there is no such synchronisation; there are MOS, MVS_SVS",
    );
    assert!(
        faults.iter().any(|(_, label)| label.contains("needs m")),
        "{faults:#?}"
    );
}
