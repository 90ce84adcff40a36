//! Cycles of DIN/ISO that need more than a program: tables, contours, swivel axes, cycles of the machine builder. Each does what
//! it does in plain language.

use std::sync::Arc;

use crate::support::*;
use bahn_interpreter::{DatumTable, Rules, Settings};
use bahn_parameters::{ControlModel, MessageId, ParameterList};
use bahn_path::{Axis, PerAxis, Position};

/// What a run says, without its blocks.
fn reported(run: &Run) -> Vec<String> {
    let nameless = |element: &bahn_path::PathElement| {
        let mut element = element.clone();
        element.block = bahn_path::BlockRef::default();
        element.sequence = 0;
        format!("{element:?}")
    };
    run.elements.iter().map(nameless).collect()
}

/// Both blocks do the same, and something, after the same begin.
#[track_caller]
fn same(plain: &str, blocks: &str, change: impl Fn(Job) -> Job) -> Run {
    let begin = "TOOL DEF 1 L+100 R+3\nTOOL CALL 1 Z S1000\nL X-5 Y-5 Z+50 R0 FMAX M3\n";
    let iso_begin = "G99 T1 L+100 R+3 *\nT1 G17 S1000 *\nG00 G40 G90 X-5 Y-5 Z+50 M3 *\n";
    let lines = |text: &str| {
        text.lines()
            .map(|line| format!("{} *\n", line.trim()))
            .collect::<String>()
    };
    let iso = format!("%TEST G71 *\n{iso_begin}{}N99999 %TEST G71 *\n", lines(blocks));
    let on_a_415 = |job: Job| change(job.with(|settings| settings.model = ControlModel::Tnc415b));
    let expected = on_a_415(Job::new(program(&format!("{begin}{plain}")))).run();
    let found = on_a_415(Job::iso(iso)).run();
    expected.assert_completed();
    found.assert_completed();
    let expected_reported = reported(&expected);
    // After the tool call and the way to the begin.
    assert!(expected_reported.len() > 2, "{expected_reported:?}");
    for (place, (found, expected)) in reported(&found).iter().zip(&expected_reported).enumerate() {
        assert_eq!(found, expected, "element {place}");
    }
    assert_eq!(found.elements.len(), expected.elements.len());
    assert_eq!(found.q, expected.q);
    expected
}

fn rules(settings: &mut Settings, machine: &[&str]) {
    let mut list = ParameterList::reference(ControlModel::Tnc415b);
    for assignment in machine {
        assert!(list.assign(assignment).is_ok(), "{assignment}");
    }
    settings.rules = Rules::of(&list);
}

#[test]
fn thread_cutting_is_g86() {
    let run = same(
        "CYCL DEF 18.0 THREAD CUTTING\nCYCL DEF 18.1 DEPTH -20\nCYCL DEF 18.2 PITCH -1.5\nL Z+2 FMAX\nCYCL CALL",
        "G86 P01 -20 P02 -1.5\nG00 Z+2\nG79",
        |job| job,
    );
    assert_eq!(run.position[Axis::Z], -18.0);
    assert!(run.elements.iter().any(|element| element.thread().is_some()));
}

#[test]
fn a_line_of_the_datum_table_is_g53() {
    let mut datum = Position::UNKNOWN;
    (datum[Axis::X], datum[Axis::Y]) = (40.0, -7.5);
    let table: Arc<DatumTable> = Arc::new([(3, datum)].into());
    let run = same(
        "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #3\nL X+1 Y+2 FMAX\nQ5 = 3\nCYCL DEF 7.0 DATUM SHIFT\n\
         CYCL DEF 7.1 #Q5\nL X+2 Y+2 FMAX",
        "G53 P01 3\nX+1 Y+2\nQ5 = 3\nG53 P01 Q5\nX+2 Y+2",
        |job| job.with(|settings| settings.datum_table = Ok(table.clone())),
    );
    assert_eq!(run.position[Axis::X], 42.0);
}

#[test]
fn tilting_the_plane_is_g80() {
    let run = same(
        "L A+0 B+45 FMAX\nCYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 A+0 B+45\nL X+10 Y+5 FMAX\n\
         CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1\nL X+0 Y+0 FMAX",
        "A+0 B+45\nG80 A+0 B+45\nX+10 Y+5\nG80\nX+0 Y+0",
        |job| {
            job.with(|settings| {
                rules(settings, SWIVEL_HEAD);
                settings.rules.machine_zero = Position::ZERO;
                settings.start = Position::ZERO;
            })
        },
    );
    assert!(run.elements.iter().any(|element| element.placement.is_some()));
}

#[test]
fn contours_with_data_are_g120_to_g125() {
    let contours = "LBL 1\nL X+0 Y+30 RL\nL Y+0\nL X+80\nL Y+60\nL X+0\nL Y+30\nLBL 0\nLBL 2\nL X+30 Y+30 RR\nL Y+25\n\
                    L X+50\nL Y+35\nL X+30\nL Y+30\nLBL 0";
    let iso_contours = "G98 L1\nG01 G41 X+0 Y+30\nY+0\nX+80\nY+60\nX+0\nY+30\nG98 L0\nG98 L2\nG42 X+30 Y+30\nY+25\n\
                        X+50\nY+35\nX+30\nY+30\nG98 L0";
    let data = "CYCL DEF 20.0 CONTOUR DATA\nCYCL DEF 20.1 Q1=-10 Q2=+1 Q3=+0.5\nCYCL DEF 20.2 Q4=+0.5 Q5=+0 Q6=+2\n\
                CYCL DEF 20.3 Q7=+20 Q8=+0 Q9=+1";
    let iso_data = "G120 Q1=-10 Q2=+1 Q3=+0.5 Q4=+0.5 Q5=+0 Q6=+2 Q7=+20 Q8=+0 Q9=+1";
    for (cycle, function, labels) in [
        (
            "CYCL DEF 21.0 PILOT DRILLING\nCYCL DEF 21.1 Q10=-5 Q11=+100 Q13=+1",
            "G121 Q10=-5 Q11=+100 Q13=+1",
            2,
        ),
        (
            "CYCL DEF 22.0 ROUGH-OUT\nCYCL DEF 22.1 Q10=-5 Q11=+100 Q12=+350",
            "G122 Q10=-5 Q11=+100 Q12=+350",
            2,
        ),
        (
            "CYCL DEF 23.0 FLOOR FINISHING\nCYCL DEF 23.1 Q11=+100 Q12=+350",
            "G123 Q11=+100 Q12=+350",
            2,
        ),
        (
            "CYCL DEF 24.0 SIDE FINISHING\nCYCL DEF 24.1 Q9=+1 Q10=-5 Q11=+100 Q12=+300 Q14=+0",
            "G124 Q9=+1 Q10=-5 Q11=+100 Q12=+300 Q14=+0",
            2,
        ),
        (
            "CYCL DEF 25.0 CONTOUR TRAIN\nCYCL DEF 25.1 Q1=-10 Q3=+0 Q5=+0 Q7=+20 Q10=-5 Q11=+100 Q12=+350 Q15=+1",
            "G125 Q1=-10 Q3=+0 Q5=+0 Q7=+20 Q10=-5 Q11=+100 Q12=+350 Q15=+1",
            1,
        ),
    ] {
        let (named, iso_named) = match labels {
            1 => ("1", "P01 1"),
            _ => ("1/2", "P01 1 P02 2"),
        };
        same(
            &format!(
                "CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL {named}\n{data}\n{cycle}\nCYCL CALL\n\
                 L Z+50 FMAX M2\n{contours}"
            ),
            &format!("G37 {iso_named}\n{iso_data}\n{function}\nG79\nG00 Z+50 M2\n{iso_contours}"),
            |job| job,
        );
    }
}

#[test]
fn a_cylinder_surface_is_g127() {
    let change = |job: Job| {
        job.with(|settings| {
            rules(settings, ROTARY_TABLE);
            let datum = [390.0, 120.0, -280.0];
            let zero = PerAxis::from_fn(|axis| datum.get(axis.index()).map_or(0.0, |datum: &f64| -datum));
            settings.rules.machine_zero = zero.into();
            settings.start = Position::ZERO;
        })
    };
    let run = same(
        "TOOL CALL 1 Y S2000\nL Y+250 R0 FMAX\nL X+10 R0 FMAX\nCYCL DEF 14.0 CONTOUR GEOMETRY\n\
         CYCL DEF 14.1 CONTOUR LABEL 1\n\
         CYCL DEF 27.0 CYLINDER SURFACE Q1=-7 Q3=+0 Q6=+2 Q10=+4 Q11=100 Q12=250 Q16=25 Q17=0\nCYCL CALL M3\n\
         L Y+250 FMAX M2\nLBL 1\nL C+10 Z+30 R0\nL C+100\nLBL 0",
        "T1 G18 S2000\nG00 G40 Y+250\nG40 X+10\nG37 P01 1\n\
         G127 Q1=-7 Q3=+0 Q6=+2 Q10=+4 Q11=100 Q12=250 Q16=25 Q17=0\nG79 M3\nY+250 M2\n\
         G98 L1\nG01 G40 C+10 Z+30\nC+100\nG98 L0",
        change,
    );
    assert!(run.elements.iter().any(|element| element.moves(Axis::C)));
}

#[test]
fn a_tool_is_announced_by_g51() {
    let run = same("TOOL DEF 2\nL X+1 FMAX", "G51 T2\nX+1", |job| {
        job.with(|settings| {
            let shape = bahn_path::ToolShape {
                length: 100.0,
                radius: 3.0,
                ..Default::default()
            };
            settings.tools = Some([(1, shape), (2, shape)].into());
        })
    });
    let announced = run
        .elements
        .iter()
        .flat_map(|element| element.functions())
        .any(|of| of.function == bahn_path::Function::NextTool(2));
    assert!(announced);
}

/// The parameters of D68 go to the cycle of the machine builder as those of CYCL DEF 68 do [000:17966-17984].
#[test]
fn a_cycle_of_the_machine_builder_is_d68() {
    let cycle =
        "BEGIN PGM 99999968 MM\nDLG-DEF 0/1/2\nL X+Q1 Y+Q2 F100\nFN0: Q60 = +Q1\nEND PGM 99999968 MM\n";
    let run = same(
        "CYCL DEF 68.0 HOLES\nCYCL DEF 68.1 Q1=+8\nCYCL DEF 68.2 Q2=+40",
        "D68 P01 +8 P02 +40",
        |job| {
            job.library("99999968", cycle)
                .with(|settings| rules(settings, &["7250=0", "7251=40"]))
        },
    );
    assert_eq!((run.position[Axis::X], run.position[Axis::Y]), (8.0, 40.0));
}

/// The fourth axis is no tool axis here.
#[test]
fn g20_is_refused_where_it_is_executed() {
    let run = Job::iso("%TEST G71 *\nG99 T1 L+0 R+3 *\nT1 G20 S1000 *\nN9 %TEST G71 *\n").run();
    assert_eq!(run.message(), Some((MessageId::WrongAxisProgrammed, 2)));
}
