//! Rows of part programs: tapping, pockets, M functions, scaling, cycles of the machine builder.

use bahn_host::oem_cycles;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_tnc::RunState;

use crate::bench::{
    Probe, Row, Verdict, begin, bench, both, duration, holds, of_axes, only, pair, ready, same, signal, watch,
};
use crate::support::Rig;
use crate::terminals::terminals;

pub const ROWS: &[Row] = &[
    Row(67..=67, Probe::Acts(tapping_dwell)),
    Row(73..=73, Probe::Acts(tapping_lead)),
    Row(93..=93, Probe::Acts(overlap)),
    Row(173..=173, Probe::Acts(cleared_status)),
    Row(182..=183, Probe::Acts(tapping_override)),
    Row(186..=189, Probe::Acts(tool_change_position)),
    Row(213..=213, Probe::Acts(scaling)),
    Row(214..=214, Probe::Acts(m_functions)),
    Row(241..=241, Probe::Acts(contour_pocket)),
    Row(259..=259, Probe::Acts(language_offset)),
    Row(263..=263, Probe::Acts(first_q)),
];

/// A thread of 10 mm, 5 mm below the axes' reference marks, with F300.
const THREAD: &str = "TOOL CALL 0 Z S300
CYCL DEF 2.0 TAPPING
CYCL DEF 2.1 SET UP -2
CYCL DEF 2.2 DEPTH -10
CYCL DEF 2.3 DWELL 0.0
CYCL DEF 2.4 F300
L IX-1 IY-1 IZ-3 R0 F9999 M3
CYCL CALL";

/// The bench with the standard PLC program, about to cut the thread.
fn tapping(mps: &str) -> Rig {
    let list = format!("61=0 62=2 67=0 73=0 182=90 183=110 {mps}");
    let mut rig = terminals().mps(&list).program("1", THREAD).rig();
    rig.power_on();
    rig
}

/// The dwell before the direction of rotation changes at the bottom [001:1804-1807].
fn tapping_dwell(number: u16) -> Verdict {
    let [before, after] = both(number, "1.3", |mps| {
        duration(&mut tapping(&format!("67=0.5 {mps}")))
    });
    pair([before, after - before], [before, 0.8], 0.05)
}

/// M05 comes MP73 before the bottom, where the speed goes out in code: at F300 and 90 % at least 5 mm/s for 0.5 s
/// [001:1809-1812].
fn tapping_lead(number: u16) -> Verdict {
    let [before, after] = both(number, "0.5", |mps| {
        let mut rig = tapping(mps);
        begin(&mut rig);
        rig.until(20.0, "M03", |rig| rig.bit("A15"));
        rig.until(20.0, "M05", |rig| rig.bit("A17"));
        let at = signal(&rig, "Z.nominal");
        rig.until(20.0, "M04", |rig| rig.bit("A16"));
        at
    });
    pair([before, after - before], [before, 2.5], 0.3)
}

/// The feed override in the thread is MP182 at the least, MP183 at the most [001:1409-1412].
fn tapping_override(number: u16) -> Verdict {
    let (value, percent, wanted) = match number {
        182 => ("50", 10, [270.0, 150.0]),
        _ => ("130", 150, [330.0, 390.0]),
    };
    let seen = both(number, value, |mps| {
        let mut rig = tapping(mps);
        begin(&mut rig);
        rig.until(20.0, "M03", |rig| rig.bit("A15"));
        rig.event(&format!("override feed {percent}"));
        rig.until(20.0, "the thread", |rig| {
            signal(rig, "Z.nominal-speed") < -100.0 && signal(rig, "path.block") >= 8.0
        });
        rig.seconds(0.4);
        signal(&rig, "path.speed")
    });
    pair(seen, wanted, 3.0)
}

/// The greatest distance of two neighbouring passes of a rectangular pocket, over the tool's radius of 2 mm: the factor
/// [001:1819-1824].
fn overlap(number: u16) -> Verdict {
    let seen = both(number, "0.6", |mps| {
        let blocks = "TOOL DEF 1 L+0 R+2\nTOOL CALL 1 Z S1000
CYCL DEF 4.0 POCKET MILLING\nCYCL DEF 4.1 SET UP -1\nCYCL DEF 4.2 DEPTH -2\nCYCL DEF 4.3 PECKG -2 F6000
CYCL DEF 4.4 X+30\nCYCL DEF 4.5 Y+30\nCYCL DEF 4.6 F6000 DR+
L X-30 Y-30 R0 F9999 M3\nL Z-3 M99";
        let mut rig = ready(bench("93=1.2 61=0 62=2").mps(mps).program("1", blocks));
        let mut passes: Vec<f64> = Vec::new();
        let mut resting = 0;
        watch(&mut rig, |rig| {
            let [x, y, ..] = of_axes(rig, "nominal-speed");
            let along_y = x.abs() < 1e-6 && y.abs() > 1000.0;
            resting = if along_y { resting + 1 } else { 0 };
            if resting == 3 {
                passes.push(signal(rig, "X.nominal"));
            }
        });
        passes.sort_by(f64::total_cmp);
        passes.dedup_by(|a, b| (*a - *b).abs() < 0.01);
        let apart = passes.windows(2).map(|pair| pair[1] - pair[0]);
        apart.filter(|apart| *apart < 2.5).fold(0.0, f64::max) / 2.0
    });
    pair(seen, [1.2, 0.6], 0.06)
}

/// M92 counts from MP186 to MP189 [001:1592-1598].
fn tool_change_position(number: u16) -> Verdict {
    let seen = both(number, "-3", |mps| {
        let block = "L X-5 Y-5 Z-5 R0 F9999 M92\nL U-5 M92";
        let mut rig = ready(bench("186=0 187=0 188=0 189=0").mps(mps).program("1", block));
        watch(&mut rig, |_| {});
        rig.settle();
        of_axes(&rig, "ref")
    });
    only(number - 186, seen, [-5.0, -8.0], 0.02)
}

/// Cycle 11 scales all main axes, or those of the working plane alone [001:1649].
fn scaling(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let blocks = "TOOL CALL 0 Z S100\nCYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2\nL X-4 Y-4 Z-4 R0 F9999";
        let mut rig = ready(bench("61=0 62=0").mps(mps).program("1", blocks));
        watch(&mut rig, |_| {});
        rig.settle();
        let [x, y, z, _] = of_axes(&rig, "ref").map(|at| at.round());
        [x, y, z]
    });
    same(seen, [[-8.0, -8.0, -8.0], [-8.0, -8.0, -4.0]])
}

/// With 1 the end of the program cancels what the status display shows, here a datum shift, which else holds when the program
/// is started again [001:1643-1646].
fn cleared_status(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let blocks = "L X-1 R0 F9999\nCYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X-2";
        let mut rig = ready(bench("173=0").mps(mps).program("1", blocks));
        watch(&mut rig, |_| {});
        rig.seconds(0.1);
        let shown = rig.control.first().in_force();
        let shifted = shown.is_some_and(|shown| !shown.shifted.is_empty());
        rig.start();
        rig.seconds(1.5);
        (shifted, signal(&rig, "X.ref").round())
    });
    same(seen, [(true, -3.0), (false, -1.0)])
}

/// The least path speed between the two lines of 8 mm of a program, mm/min.
fn least_between(mps: &str, blocks: &str) -> f64 {
    let list = format!("61=0 62=2 63=1991 {mps}");
    let mut rig = ready(bench(&list).program("1", blocks));
    let mut least = f64::INFINITY;
    watch(&mut rig, |rig| {
        let at = signal(rig, "X.nominal");
        if (-10.0..-6.0).contains(&at) {
            least = least.min(signal(rig, "path.speed"));
        }
    });
    least
}

/// +1: M06 does not stop; +2: M89 calls a cycle at the block's end and is not put out; +4: a speed alone does not halt the
/// axes; +8: nor does an M function [001:1650-1652].
fn m_functions(number: u16) -> Verdict {
    let stops = [0, 1].map(|value: u8| {
        let build = bench("61=0").mps(&format!("{number}={value}"));
        let mut rig = ready(build.program("1", "L M6\nL IX-1 R0 F1000"));
        begin(&mut rig);
        rig.seconds(1.0);
        rig.control.snapshot().run == RunState::Stopped
    });
    same(stops, [true, false])?;
    let cycles = [0, 2].map(|value: u8| {
        let blocks = "TOOL CALL 0 Z S100
CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP -1\nCYCL DEF 1.2 DEPTH -3\nCYCL DEF 1.3 PECKG -3\nCYCL DEF 1.4 DWELL 0\nCYCL DEF 1.5 F3000
L X-3 Y-3 Z-5 R0 F9999 M89\nL X-4";
        let build = bench("61=0 62=0").mps(&format!("{number}={value}"));
        let mut rig = ready(build.program("1", blocks));
        let (mut deepest, mut put_out) = (0.0_f64, false);
        watch(&mut rig, |rig| {
            deepest = deepest.min(signal(rig, "Z.nominal"));
            put_out |= rig.bit("M2045");
        });
        (deepest.round(), put_out)
    });
    same(cycles, [(-5.0, true), (-9.0, false)])?;
    for (bit, blocks) in [
        (4, "L X-8 R0 F3000\nTOOL CALL S500\nL X-16"),
        (8, "L X-8 R0 F3000\nL X-16 M8"),
    ] {
        let least = [0, bit].map(|value: u8| least_between(&format!("{number}={value}"), blocks));
        holds(least[0] < 1.0 && least[1] > 2900.0, || {
            format!("{bit}: {least:?}")
        })?;
    }
    Ok(())
}

/// Two pockets of 20 mm that overlap by 1 mm: the paths of a tool of radius 3 do not meet.
const POCKETS: &str = "TOOL DEF 1 L+0 R+3\nTOOL CALL 1 Z S1000
CYCL DEF 14.0 CONTOUR GEOM.\nCYCL DEF 14.1 CONTOUR LABEL 1/2
CYCL DEF 6.0 ROUGH-OUT\nCYCL DEF 6.1 SET UP -1 DEPTH -2\nCYCL DEF 6.2 PECKG -2 F6000 ALLOW +0\nCYCL DEF 6.3 ANGLE +0 F6000
L X-30 Y-30 R0 F9999 M3\nL Z-3 M99\nL M2
LBL 1\nL X-30 Y-20 RR\nL X-20\nL Y-40\nL X-40\nL Y-20\nL X-30\nLBL 0
LBL 2\nL X-50 Y-22 RR\nL X-39\nL Y-38\nL X-59\nL Y-22\nL X-50\nLBL 0";

/// One pocket.
fn one_pocket() -> String {
    POCKETS.replace("LABEL 1/2", "LABEL 1")
}

/// Where the nominal position of the tool is at the depth of a program, mm.
fn milled(mps: &str, blocks: &str) -> Vec<[f64; 2]> {
    let mut rig = ready(bench("61=0 62=0 93=1").mps(mps).program("1", blocks));
    let mut path = Vec::new();
    watch(&mut rig, |rig| {
        let [x, y, z, _] = of_axes(rig, "ref");
        if z < -4.5 {
            path.push([x, y]);
        }
    });
    path
}

/// Bit 0 turns the direction of the channel round, +2 clears out before it, +4 combines contours as programmed, so that both
/// pockets are one [001:1414-1439].
fn contour_pocket(number: u16) -> Verdict {
    // The side at X -23 is the channel's, 14 mm in one go: upwards or downwards, and when.
    let side = |mps: &str| {
        let path = milled(mps, &one_pocket());
        let mut from = None;
        for (place, at) in path.iter().enumerate() {
            if (at[0] + 23.0).abs() > 0.01 {
                from = None;
                continue;
            }
            let way = at[1] - *from.get_or_insert(at[1]);
            if way.abs() > 10.0 {
                return (way.signum(), place * 2 > path.len());
            }
        }
        (0.0, false)
    };
    let [usual, turned, late] = [0, 1, 2].map(|value: u8| side(&format!("{number}={value}")));
    holds(usual.0 == -turned.0, || format!("{usual:?} {turned:?}"))?;
    holds(late.1 && !usual.1, || format!("{usual:?} {late:?}"))?;
    // Where both overlap the tool goes at the depth only when they are one.
    let joined = [0, 4].map(|value: u8| {
        let path = milled(&format!("{number}={value}"), POCKETS);
        path.iter().any(|at| (at[0] + 39.5).abs() < 0.5)
    });
    same(joined, [false, true])
}

/// The texts of a cycle of the machine builder.
fn texts(mps: &str) -> Vec<(u32, String)> {
    let folder = std::env::temp_dir().join(format!("bahn-row-texts-{}-{}", std::process::id(), mps.len()));
    std::fs::create_dir_all(&folder).unwrap();
    let text = "0 BEGIN PGM 99999968      MM P\n1 DLG-DEF 0/1/ / / /\n2 END PGM 99999968      MM P\n";
    std::fs::write(folder.join("99999968.H"), text).unwrap();
    let mut list = ParameterList::reference(ControlModel::Tnc155);
    for assignment in format!("92=3 259=0 263=0 {mps}").split_whitespace() {
        list.assign(assignment).unwrap();
    }
    let mut dialogues = vec![String::new(); 13];
    for (number, text) in [
        (0, "LOCHKREIS"),
        (1, "ANZAHL"),
        (10, "BOLT HOLES"),
        (11, "NUMBER"),
    ] {
        dialogues[number] = text.to_owned();
    }
    let cycle = oem_cycles::find(&folder, &dialogues, &list).unwrap().remove(0);
    let _ = std::fs::remove_dir_all(&folder);
    let dialog = cycle.dialog.unwrap();
    let name = (0, dialog.name.text);
    let parameters = dialog.parameters.into_iter().map(|(q, text)| (q, text.text));
    [name].into_iter().chain(parameters).collect()
}

fn rows(rows: &[(u32, &str)]) -> Vec<(u32, String)> {
    rows.iter().map(|(q, text)| (*q, (*text).to_owned())).collect()
}

/// Dialogue 0 is 10 in the English dialogue [001:2801-2823].
fn language_offset(number: u16) -> Verdict {
    same(
        both(number, "10", texts),
        [
            rows(&[(0, "LOCHKREIS"), (1, "ANZAHL")]),
            rows(&[(0, "BOLT HOLES"), (1, "NUMBER")]),
        ],
    )
}

/// Parameters of DLG-DEF begin behind MP263 [001:2784-2799].
fn first_q(number: u16) -> Verdict {
    same(
        both(number, "50", texts),
        [
            rows(&[(0, "LOCHKREIS"), (1, "ANZAHL")]),
            rows(&[(0, "LOCHKREIS"), (51, "ANZAHL")]),
        ],
    )
}
