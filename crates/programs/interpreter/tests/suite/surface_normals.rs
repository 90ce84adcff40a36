//! LN: lines with the normal of the surface. The tool in the spindle touches the surface at the same point as the one
//! that the program was computed with. Expected positions are those of a tool of its own radii.

use crate::support::*;
use bahn_interpreter::Settings;
use bahn_parameters::ControlModel::{Tnc360, Tnc407, Tnc425};
use bahn_parameters::MessageId::{
    BlockNotKnown, EntryValueIncorrect, PathOffsetWronglyStarted, ToolRadiusTooLarge,
};
use bahn_parameters::ParameterList;
use bahn_path::{Axis, FeedRate, Oversize, ToolShape};

/// The tip of a tool of radius R and corner radius R2 that touches a point with this normal.
fn tip(point: [f64; 3], n: [f64; 3], [r, r2]: [f64; 2]) -> [f64; 3] {
    let beside = n[0].hypot(n[1]);
    let h = match beside {
        0.0 => [0.0; 3],
        _ => [n[0] / beside, n[1] / beside, 0.0],
    };
    let z = [0.0, 0.0, 1.0];
    [0, 1, 2].map(|i: usize| point[i] + r2 * n[i] + (r - r2) * h[i] - r2 * z[i])
}

/// Settings with tool 1 of nominal radii R, R2 that differs by DR, DR2.
fn worn([r, r2]: [f64; 2], [dr, dr2]: [f64; 2]) -> impl FnOnce(&mut Settings) {
    move |settings| {
        let shape = ToolShape {
            length: 0.0,
            radius: r + dr,
            corner_radius: r2 + dr2,
            oversize: Oversize {
                length: 0.0,
                radius: dr,
                corner_radius: dr2,
            },
            ..ToolShape::default()
        };
        settings.tools = Some([(1, shape)].into());
    }
}

fn ln(p: [f64; 3], n: [f64; 3]) -> String {
    format!(
        "LN X{:+.9} Y{:+.9} Z{:+.9} NX{:+.9} NY{:+.9} NZ{:+.9} F1000",
        p[0], p[1], p[2], n[0], n[1], n[2]
    )
}

const POINT: [f64; 3] = [31.0, -12.0, 4.0];
const NORMALS: [[f64; 3]; 5] = [
    [0.0, 0.0, 1.0],
    [0.6, 0.0, 0.8],
    [-0.48, 0.36, 0.8],
    [0.0, -1.0, 0.0],
    // 2/3, -1/3, 2/3.
    [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
];

/// Ball, toroid and flat end; smaller ones, and with M107 larger ones. With MP7680 bit 6 the position stays that of a
/// length with DR2: DR2 higher.
#[test]
fn tools_touch_the_same_point_of_the_surface() {
    for nominal in [[5.0, 5.0], [8.0, 2.0], [6.0, 0.0]] {
        for oversize in [[-0.2, -0.2], [-0.2, 0.0], [-0.1, -0.05], [0.3, 0.1]] {
            let [r, r2] = [0, 1].map(|i: usize| nominal[i] + oversize[i]);
            if r2 < 0.0 {
                continue;
            }
            for n in NORMALS {
                for with_dr2 in [false, true] {
                    let block = ln(tip(POINT, n, nominal), n);
                    let text = program(&format!(
                        "TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+50 R0 FMAX M107\n{block}"
                    ));
                    let run = Job::exact(&text)
                        .with(worn(nominal, oversize))
                        .with(|settings| settings.rules.normal_length_with_dr2 = with_dr2)
                        .run();
                    run.assert_completed();
                    let mut expected = tip(POINT, n, [r, r2]);
                    if with_dr2 {
                        expected[2] += oversize[1];
                    }
                    let last = run.moves().last().unwrap();
                    close_points(&[xyz(&last.end)], &[expected], 1e-8);
                    assert_eq!(last.feed, FeedRate::Programmed(1000.0));
                }
            }
        }
    }
    let mut list = ParameterList::reference(Tnc425);
    list.assign("7680=%1000000").unwrap();
    assert!(bahn_interpreter::Rules::of(&list).normal_length_with_dr2);
}

/// DR of TOOL CALL adds to that of the table; the surface turns with cycle 10, and is stretched by cycle 26.
#[test]
fn normals_follow_the_transformations() {
    let n = [0.6, 0.0, 0.8];
    let flat = |oversize: f64, before: &str, block: &str| {
        let text = format!("TOOL CALL 1 Z S1000 DR{oversize:+}\nL X+0 Y+0 Z+0 R0 FMAX\n{before}\n{block}");
        let run = Job::exact(&program(&text))
            .with(worn([6.0, 0.0], [-0.1, 0.0]))
            .run();
        run.assert_completed();
        xyz(&run.moves().last().unwrap().end)
    };
    let block = ln([10.0, 0.0, 0.0], n);
    // A flat end of 0.3 mm less: 0.3 mm towards the surface in the plane.
    close_points(&[flat(-0.2, "", &block)], &[[9.7, 0.0, 0.0]], 1e-9);
    let turned = "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT +90";
    close_points(&[flat(-0.2, turned, &block)], &[[0.0, 9.7, 0.0]], 1e-9);
    let mirrored = "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X";
    close_points(&[flat(-0.2, mirrored, &block)], &[[-9.7, 0.0, 0.0]], 1e-9);
    // A plane x + y = 10 that is twice as long in X is x/2 + y = 10, with the normal (1, 2) / √5.
    let stretched = "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X2";
    let root = 5f64.sqrt();
    let diagonal = ln([5.0, 5.0, 0.0], [0.5f64.sqrt(), 0.5f64.sqrt(), 0.0]);
    close_points(
        &[flat(-0.2, stretched, &diagonal)],
        &[[10.0 - 0.3 / root, 5.0 - 0.6 / root, 0.0]],
        1e-9,
    );
}

/// After LN an axis that is not programmed stays where it is, and LN without X and Y goes on from there with them.
#[test]
fn what_follows_starts_beside_the_surface() {
    let text =
        "TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 R0 FMAX\nLN X+10 Y+0 Z+0 NX+0.6 NY+0 NZ+0.8 F500\nL Z+20\nL X+10";
    let run = Job::new(program(text)).with(worn([5.0, 5.0], [-0.5, -0.5])).run();
    run.assert_completed();
    let ends: Vec<_> = run.moves().skip(1).map(|e| xyz(&e.end)).collect();
    // -0.5 · (0.6, 0.8) and 0.5 in Z.
    close_points(
        &ends,
        &[[9.7, 0.0, 0.1], [9.7, 0.0, 20.0], [10.0, 0.0, 20.0]],
        1e-9,
    );
}

#[test]
fn what_ln_does_not_take() {
    let message = |text: &str, oversize: [f64; 2]| {
        let text = format!("TOOL CALL 1 Z S1000\nL X+0 Y+0 Z+0 R0 F100\n{text}");
        Job::new(program(&text))
            .with(worn([5.0, 2.0], oversize))
            .run()
            .message()
    };
    let good = "LN X+1 Y+0 Z+0 NX+0 NY+0 NZ+1";
    assert_eq!(message(good, [0.0, 0.0]), None);
    assert_eq!(message(good, [0.1, 0.0]), Some((ToolRadiusTooLarge, 3)));
    assert_eq!(message(good, [0.0, 0.1]), Some((ToolRadiusTooLarge, 3)));
    assert_eq!(
        message(&format!("{good} M107\n{good} M108"), [0.1, 0.0]),
        Some((ToolRadiusTooLarge, 4))
    );
    assert_eq!(
        message("LN X+1 NX+0 NY+0 NZ+0", [0.0, 0.0]),
        Some((EntryValueIncorrect, 3))
    );
    assert_eq!(
        message("LN X+1 NX+0 NZ+1", [0.0, 0.0]),
        Some((EntryValueIncorrect, 3))
    );
    assert_eq!(
        message(&format!("L X+1 RL\nL X+2\n{good}"), [0.0, 0.0]),
        Some((PathOffsetWronglyStarted, 5))
    );
    for model in [Tnc360, Tnc407] {
        let run = Job::new(program(&format!("L X+0 Y+0 Z+0 R0 F100\n{good}")))
            .with(|settings| settings.model = model)
            .run();
        assert_eq!(run.message(), Some((BlockNotKnown, 2)), "{model}");
    }
    let run = Job::new(program(&format!("L X+0 Y+0 Z+0 R0 F100\n{good}")))
        .with(|settings| {
            settings.model = Tnc407;
            settings.skip_unknown = true;
        })
        .run();
    assert_eq!(run.position[Axis::X], 0.0);
}
