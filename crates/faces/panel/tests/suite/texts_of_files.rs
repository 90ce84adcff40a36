//! Whatever stands in a file of the panel is read, or its fault has a line.

use std::sync::LazyLock;

use bahn_machine::Machine;
use bahn_panel::{check_lesson, check_session};
use bahn_parameters::{ControlModel, ParameterList};
use proptest::prelude::*;

static PARAMETERS: LazyLock<ParameterList> =
    LazyLock::new(|| ParameterList::reference(ControlModel::Tnc415b));
static PLANT: LazyLock<Machine> = LazyLock::new(|| {
    let text = "name = 'one'\n[keys]\nNC_START = 'I1'\n[emergency_stop]\nacknowledgement = 'I3'\n[axis.X]\noutput = '1'\n\
                speed = 15000\nvolts = 9\nencoder = { input = 'X1', period_um = 20 }";
    Machine::from_toml(text).unwrap_or_else(|faults| panic!("{faults:?}"))
});

const LESSON: &str = "title: T\ntitle de: T\ntask: Do it\nhint: H\nhint de: H\nlimit: 60\nbegin: here\n[prepare]\n0: key NC_START tap\n\
                      [events]\nwhen X.actual>5: ce\n[checks]\nA | B => X.actual=1, screen \"X\", no did ce\n[never]\nC => no message\n";
const SESSION: &str = "{\"session\":1,\"machine\":\"M\",\"model\":\"tnc360\",\"version\":\"0\",\"kept\":\"0\"}\n\
                       {\"t_us\":1,\"input\":{\"key\":\"ENT\"}}\n{\"t_us\":2,\"input\":{\"go_to\":0.5,\"branch\":1}}\n";

#[test]
fn the_seeds_are_right() {
    assert_eq!(check_lesson(&PLANT, &PARAMETERS, LESSON.as_bytes()), Ok(()));
    assert_eq!(check_session(SESSION.as_bytes()), Ok(2));
}

/// The example of docs/lessons.md is one.
#[test]
fn the_documented_lesson_is_right() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let page = std::fs::read_to_string(root.join("docs/lessons.md")).unwrap();
    let example = page.split("```").nth(1).unwrap();
    let mill = bahn_panel::load(&root.join("machines/mill")).unwrap();
    assert_eq!(
        check_lesson(mill.simulated().unwrap(), &mill.parameters, example.as_bytes()),
        Ok(())
    );
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_lesson_has_faults_with_lines(at in 0..LESSON.len(), length in 0..40_usize, text in "[ -~\n]{0,12}") {
        let end = (at + length).min(LESSON.len());
        let damaged = format!("{}{text}{}", &LESSON[..at], &LESSON[end..]);
        if let Err(lines) = check_lesson(&PLANT, &PARAMETERS, damaged.as_bytes()) {
            let last = damaged.lines().count().max(1) as u32;
            prop_assert!(!lines.is_empty() && lines.iter().all(|line| (1..=last).contains(line)), "{lines:?}");
        }
    }

    #[test]
    fn any_text_is_a_lesson_or_has_faults(text in "([a-z\\[\\]]{0,8}[:=> ]{0,3}[ -~]{0,12}\n){0,8}") {
        let read = check_lesson(&PLANT, &PARAMETERS, text.as_bytes());
        prop_assert!(read.is_err_and(|lines| !lines.is_empty()));
    }

    #[test]
    fn a_damaged_session_has_a_line(at in 0..SESSION.len(), length in 0..40_usize, text in "[ -~\n]{0,12}") {
        let end = (at + length).min(SESSION.len());
        let damaged = format!("{}{text}{}", &SESSION[..at], &SESSION[end..]);
        if let Err(line) = check_session(damaged.as_bytes()) {
            prop_assert!((1..=damaged.lines().count().max(1)).contains(&line), "{line}");
        }
    }
}
