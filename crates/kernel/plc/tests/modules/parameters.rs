use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{NcParameters, ParameterFault};

use crate::desk::{Desk, code, value};

#[test]
fn m9031_overwrites_in_the_run_time_memory() {
    let mut desk = Desk::new();
    desk.parameter("910.0=50");
    // MP910.0 = 100.12 has four decimal places [000:14857].
    assert_eq!(desk.submit(9031, &[910, 0, 1_001_200], 1), code(0));
    assert_eq!(desk.nc.parameters().get(910, 0), Some(100.12));
    assert_eq!(
        desk.submit(9032, &[910, 0], 1),
        value(500_000),
        "the edited list keeps its value"
    );
    desk.nc.leave_parameter_editor();
    assert_eq!(desk.nc.parameters().get(910, 0), Some(50.0));
}

#[test]
fn m9031_error_codes() {
    let mut desk = Desk::new();
    assert_eq!(desk.submit(9031, &[9999, 0, 1], 1), code(1), "does not exist");
    assert_eq!(desk.submit(9031, &[-1, 0, 1], 1), code(1));
    assert_eq!(
        desk.submit(9031, &[10, 0, 1], 1),
        code(1),
        "MP10 is changed in the list only"
    );
    assert_eq!(desk.submit(9031, &[7280, 0, 2], 1), code(2), "MP7280 is 0 or 1");
    assert_eq!(desk.cyclic(9031, &[7280, 0, 1], 1), code(4));
    desk.nc.saving_fails = true;
    assert_eq!(desk.submit(9031, &[7280, 0, 1], 1), code(3));
    desk.nc.saving_fails = false;
    desk.nc.program_running = true;
    assert_eq!(desk.submit(9031, &[7280, 0, 1], 1), code(5), "no strobe");
    for strobe in ["M2043", "M2044", "M2045", "M2046", "M2047", "M2149"] {
        desk.set(strobe, 1);
        assert_eq!(
            desk.submit(9031, &[7280, 0, 1], 1),
            code(0),
            "MP7280 may change while a program runs"
        );
        assert_eq!(desk.submit(9031, &[910, 0, 0], 1), code(1), "MP910 may not");
        desk.set(strobe, 0);
    }
}

#[test]
fn m9032_reads_the_edited_list() {
    let mut desk = Desk::new();
    desk.parameter("910.0=100.12");
    assert_eq!(desk.submit(9032, &[910, 0], 1), value(1_001_200));
    let point = desk.nc.parameters.get(7280, 0).unwrap() as i32;
    assert_eq!(
        desk.submit(9032, &[7280, 0], 1),
        value(point),
        "index 0 without indices"
    );
    assert_eq!(desk.submit(9032, &[7280, 1], 1), code(1), "no such index");
    assert_eq!(desk.submit(9032, &[70_000, 0], 1), code(1));
    assert_eq!(desk.cyclic(9032, &[910, 0], 1), code(6));
    let faults = [
        (ParameterFault::NoSuchNumber, 1),
        (ParameterFault::NoSeparator, 2),
        (ParameterFault::OutOfRange, 3),
        (ParameterFault::NotInFile, 4),
        (ParameterFault::NoFile, 5),
    ];
    for (fault, number) in faults {
        desk.nc.parameter_faults.insert((910, 0), fault);
        assert_eq!(desk.submit(9032, &[910, 0], 1), code(number));
    }
}

#[test]
fn m9033_selects_a_list() {
    let mut desk = Desk::new();
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    list.assign("7280=1").unwrap();
    desk.nc.parameter_files.insert("NEW.MP".to_owned(), Some(list));
    desk.nc.parameter_files.insert("BAD.MP".to_owned(), None);
    desk.set_text(0, b"NEW.MP")
        .set_text(1, b"BAD.MP")
        .set_text(2, b"GONE.MP");
    assert_eq!(desk.cyclic(9033, &[0], 1), code(4));
    assert_eq!(desk.submit(9033, &[1], 1), code(3));
    assert_eq!(desk.submit(9033, &[2], 1), code(2));
    assert_eq!(desk.submit(9033, &[4], 1), code(1));
    for name in ["NEW.MP ", "new.mp", "NEW", "", ".MP", "NEW.", "A.B.MP"] {
        desk.set_text(3, name.as_bytes());
        assert_eq!(desk.submit(9033, &[3], 1), code(1), "{name}");
    }
    assert_eq!(desk.nc.restarts, 0);
    // The control is reset: nothing returns to the job [000:14893].
    assert!(!desk.returns(9033, &[0], 1));
    assert_eq!(
        (desk.nc.restarts, desk.nc.parameters().get(7280, 0)),
        (1, Some(1.0))
    );
    desk.nc.resets = false;
    assert_eq!(desk.submit(9033, &[0], 1), code(0), "selected already");
    assert_eq!(desk.nc.restarts, 1);
    desk.nc.program_running = true;
    assert_eq!(desk.submit(9033, &[0], 1), code(5));
    assert_eq!(desk.set("M2045", 1).submit(9033, &[0], 1), code(0));
}
