//! Numbers finer than the input resolution of a control [003:7825] [000:6419-6424].

use crate::support::*;
use bahn_interpreter::{Settings, WarningKind};
use bahn_parameters::{ControlModel, MessageId};
use bahn_path::{Axis, FeedRate};

const PATH: &str = "L X+1.00006 Y-2.0004 R0 F100.0006\nL X+3.1234\nL IX+0.00049";

fn on(model: ControlModel, strict: bool, text: &str) -> Run {
    let change = |settings: &mut Settings| (settings.model, settings.strict) = (model, strict);
    Job::new(text).with(change).run()
}

fn steps(run: &Run) -> Vec<(u32, &str)> {
    let rounded = run.warnings.iter().filter_map(|warning| match &warning.kind {
        WarningKind::Rounded { step } => Some((warning.block.block, step.as_str())),
        _ => None,
    });
    rounded.collect()
}

/// 0.001 mm on TNC 360 and 407, 0.0001 mm on TNC 415 B and 425: coordinates, increments and feed are rounded, and the
/// first such block is named, once.
#[test]
fn numbers_are_rounded_to_the_input_step() {
    use ControlModel::{Tnc155, Tnc360, Tnc407, Tnc415b, Tnc425};
    let coarse = ([1.0, 3.123, 3.123], -2.0, 100.001, "0.001 mm and 0.001°");
    let fine = (
        [1.0001, 3.1234, 3.1239],
        -2.0004,
        100.0006,
        "0.0001 mm and 0.0001°",
    );
    for (model, (x, y, feed, step)) in [
        (Tnc155, coarse),
        (Tnc360, coarse),
        (Tnc407, coarse),
        (Tnc415b, fine),
        (Tnc425, fine),
    ] {
        let run = on(model, false, &program(PATH));
        run.assert_completed();
        let ends: Vec<f64> = run.moves().map(|element| element.end[Axis::X]).collect();
        assert!(
            ends.iter().zip(x).all(|(end, x)| (end - x).abs() < 1e-9),
            "{model}: {ends:?}"
        );
        let first = run
            .moves()
            .next()
            .map(|element| (element.end[Axis::Y], element.feed));
        assert_eq!(first, Some((y, FeedRate::Programmed(feed))), "{model}");
        assert_eq!(steps(&run), [(1, step)], "{model}");
        // Strict checking refuses the block.
        let strict = on(model, true, &program(PATH));
        assert_eq!(
            strict.message(),
            Some((MessageId::EntryValueIncorrect, 1)),
            "{model}"
        );
    }
}

/// An inch has ten times as many steps as a millimetre: 0.0001 inch [003:7825].
#[test]
fn inches_have_finer_steps() {
    let text = "BEGIN PGM 1 INCH\nL X+1.00006 R0 F10\nL X+2.0001\nEND PGM 1 INCH";
    let run = on(ControlModel::Tnc360, false, text);
    let ends: Vec<f64> = run.moves().map(|element| element.end[Axis::X] / 25.4).collect();
    assert!(
        ends.iter()
            .zip([1.0001, 2.0001])
            .all(|(end, x)| (end - x).abs() < 1e-9),
        "{ends:?}"
    );
    assert_eq!(steps(&run), [(1, "0.0001 inch and 0.001°")]);
}

/// What has no more places than the control takes says nothing; Q parameters keep what was calculated.
#[test]
fn what_is_fine_enough_stays() {
    let text = program("FN 0: Q1 = +1.00006\nL X+Q1 Y+0.001 R0 F100\nL X+99999.999\nCC X+0.125 Y-0.5");
    let run = on(ControlModel::Tnc407, true, &text);
    run.assert_completed();
    assert_eq!(
        run.moves().next().map(|element| element.end[Axis::X]),
        Some(1.00006)
    );
    assert_eq!(steps(&run), []);
}

/// Lengths and dwell of a cycle, radius of a tool and pole count, too; the factor of cycle 11 has six places.
#[test]
fn cycles_tools_and_poles_are_rounded() {
    let first = |blocks: &str| {
        let run = on(ControlModel::Tnc407, false, &program(blocks));
        steps(&run).first().map(|(block, _)| *block)
    };
    assert_eq!(first("TOOL DEF 1 L+0 R+2.50004\nTOOL CALL 1 Z S100"), Some(1));
    assert_eq!(
        first("TOOL DEF 1 L+0 R+2.5\nTOOL CALL 1 Z S100 DR-0.00001"),
        Some(2)
    );
    assert_eq!(first("CC X+0 Y+0.33333"), Some(1));
    assert_eq!(
        first("CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -2.0001"),
        Some(2)
    );
    assert_eq!(
        first("CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.0004"),
        Some(2)
    );
    assert_eq!(first("CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.999999"), None);
}

/// Each program is told of once, however often it is called.
#[test]
fn called_programs_are_reported_once() {
    let run = Job::new(program("CALL PGM 2\nCALL PGM 2\nL X+1 R0 F100"))
        .library(
            "2",
            "BEGIN PGM 2 MM\nL X+0.12345678 R0 F100\nL Y+0.12345678\nEND PGM 2 MM",
        )
        .run();
    run.assert_completed();
    assert_eq!(steps(&run), [(1, "0.0001 mm and 0.0001°")]);
}
