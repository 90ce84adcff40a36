//! Rows of the loops: characteristics, offsets, supervision, lubrication.

use crate::bench::{
    Probe, Row, Verdict, begin, bench, both, duration, each_axis, holds, of_axes, only, pair, ready, same,
    signal, watch,
};
use crate::support::Rig;
use crate::support::knee::asked;

pub const ROWS: &[Row] = &[
    Row(28..=31, Probe::Acts(integral)),
    Row(32..=35, Probe::Acts(difference_factor)),
    Row(52..=52, Probe::Acts(rapid_voltage)),
    Row(53..=53, Probe::Acts(approach_speed)),
    Row(56..=57, Probe::Acts(position_supervision)),
    Row(60..=60, Probe::Acts(characteristic)),
    Row(64..=64, Probe::Acts(oscillation)),
    Row(159..=162, Probe::Acts(lubrication)),
    Row(169..=169, Probe::Acts(standstill)),
    Row(174..=175, Probe::Acts(position_supervision)),
    Row(176..=176, Probe::Acts(beyond_the_kink)),
    Row(177..=180, Probe::Acts(kv)),
    Row(181..=181, Probe::Acts(beyond_the_kink)),
    Row(185..=185, Probe::Acts(residual_voltage)),
    Row(234..=234, Probe::Acts(movement)),
    Row(252..=252, Probe::Acts(offset_adjustment)),
];

/// Drives whose amplifiers have an offset of 50 mV: 6000 mm/min / 9 V are 33.3 mm/min, and 16.7 µm of lag with kv 2.
fn drifting(mps: &str) -> crate::support::Build {
    bench(mps).plant("time_constant_ms = 2", "time_constant_ms = 2\noffset_mv = 50")
}

/// The lag of an offset.
const DRIFT_MM: f64 = 0.05 / 9.0 * 6000.0 / 2000.0;

/// At rest the integral factor takes the lag of an offset away [001:2754-2760].
fn integral(number: u16) -> Verdict {
    let seen = both(number, "2000", |mps| {
        let mut rig = ready(drifting(mps));
        rig.seconds(2.0);
        of_axes(&rig, "lag").map(f64::abs)
    });
    only(number - 28, seen, [DRIFT_MM, 0.0], 0.002)
}

/// Pre-control leaves the lag of an offset by the kv factor of MP32: 3.6864 · 2 / 6 for kv 2 at 6 m/min, half of it for
/// kv 1 [001:1742-1762].
fn difference_factor(number: u16) -> Verdict {
    let list = "60=0 32=1.229 33=1.229 34=1.229 35=1.229";
    let seen = both(number, "0.614", |mps| {
        let build = drifting(list)
            .mps(mps)
            .program("1", &each_axis("L I@-8 R0 F1000"));
        let mut rig = ready(build);
        let mut lags = [0.0; 4];
        watch(&mut rig, |rig| {
            for (index, speed) in of_axes(rig, "nominal-speed").into_iter().enumerate() {
                if (speed.abs() - 1000.0).abs() < 1.0 {
                    lags[index] = of_axes(rig, "lag")[index].abs();
                }
            }
        });
        lags
    });
    only(number - 32, seen, [DRIFT_MM, 2.0 * DRIFT_MM], 0.003)
}

/// The lags at a feed, mm: those of the last cycle in which an axis has it.
fn lags(mps: &str, feed: u32) -> [f64; 4] {
    let program = each_axis(&format!("L I@-18 R0 F{feed}"));
    let mut rig = ready(bench("234=10").mps(mps).program("1", &program));
    let mut lags = [0.0; 4];
    watch(&mut rig, |rig| {
        for (index, speed) in of_axes(rig, "nominal-speed").into_iter().enumerate() {
            if (speed.abs() - f64::from(feed)).abs() < 1.0 {
                lags[index] = of_axes(rig, "lag")[index].abs();
            }
        }
    });
    lags
}

/// Lag = feed / kv [001:1695-1699].
fn kv(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| lags(mps, 3000));
    only(number - 177, seen, [1.5, 3.0], 0.03)
}

/// The drives turn 6 m/min at 9 V. When the control puts out 4.5 V for it, twice the lag makes up for it [001:1677].
fn rapid_voltage(number: u16) -> Verdict {
    let seen = both(number, "4.5", |mps| lags(mps, 3000)[0]);
    pair(seen, [1.5, 3.0], 0.03)
}

/// MP60 = 0 leaves almost no lag in programs, and that of kv by hand [001:1105-1121].
fn characteristic(number: u16) -> Verdict {
    let seen = both(number, "0", |mps| lags(mps, 3000)[0]);
    pair(seen, [1.5, 0.0], 0.03)?;
    let by_hand = both(number, "0", |mps| {
        let mut rig = ready(bench(mps));
        rig.event("key X- press");
        rig.seconds(0.5);
        signal(&rig, "X.lag").abs()
    });
    pair(by_hand, [0.6, 0.6], 0.02)
}

/// Kink at 50 % of 6 m/min, factor 0.5: F4500 lags 1.5 mm and (4500 - 3000) / (2000 · 0.5) = 1.5 mm more, not 2.25 mm
/// [001:1712-1725].
fn beyond_the_kink(number: u16) -> Verdict {
    let (other, value) = match number {
        176 => ("181=50 176=1", "0.5"),
        _ => ("181=100 176=0.5", "50"),
    };
    let seen = both(number, value, |mps| lags(&format!("{other} {mps}"), 4500)[0]);
    pair(seen, [2.25, 3.0], 0.06)
}

/// The smaller the approach speed, the later the axis is in its window [001:1736] [001:2734-2736].
fn approach_speed(number: u16) -> Verdict {
    let [slow, fast] = both(number, "10", |mps| {
        let list = "60=0 53=0.1 58=0.004";
        duration(&mut ready(
            bench(list).mps(mps).program("1", "L IX-2 R0 F3000 M30"),
        ))
    });
    holds(slow > fast + 0.006, || format!("{slow} s, {fast} s"))
}

/// MP64 delays the pre-control of the acceleration by MP64 / (1 - MP64) steps of the loop, which costs lag [001:1735].
fn oscillation(number: u16) -> Verdict {
    let [least, most] = both(number, "0.8", |mps| {
        let build = bench("60=0 64=0.1 53=10 56=30 57=30").mps(mps);
        let mut rig = ready(build.program("1", "L IX-8 R0 F3000"));
        let mut most = 0.0_f64;
        watch(&mut rig, |rig| most = most.max(signal(rig, "X.lag").abs()));
        most
    });
    holds(most > 5.0 * least, || format!("lag {least}, {most}"))
}

/// Each time X to IV has travelled MP159 to MP162 times 65.536 mm, lubrication is asked for: M2012 to M2015 [001:1836].
fn lubrication(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let program = each_axis("L I@-35 R0 F6000\nL I@+35");
        let mut rig = ready(bench("159=0 160=0 161=0 162=0").mps(mps).program("1", &program));
        let mut asked = [0.0; 4];
        watch(&mut rig, |rig| {
            for (index, asked) in asked.iter_mut().enumerate() {
                if rig.bit(&format!("M{}", 2012 + index)) {
                    *asked = 1.0;
                }
            }
        });
        asked
    });
    only(number - 159, seen, [0.0, 1.0], 0.0)
}

/// X is held fast in a program with F1000. The lag at which a message comes, and the message.
fn held(mps: &str) -> (f64, String) {
    let mut rig = ready(
        bench("8=600 9=600 10=600 11=600 234=10 32=0.6144")
            .mps(mps)
            .program("1", "L IX-40 R0 F1000"),
    );
    begin(&mut rig);
    rig.event("fault clamp X");
    let before = lag(&rig);
    rig.until(20.0, "a message", |rig| !rig.messages().is_empty());
    (lag(&rig).max(before), rig.messages().join(" "))
}

fn lag(rig: &Rig) -> f64 {
    signal(rig, "X.lag").abs()
}

/// MP56 and MP57 with the square-root characteristic, MP175 and MP174 with the linear one: lag of 1 mm, changed to 2 mm. What is
/// erasable is POSITIONING ERROR, the other GROSS POSITIONING ERROR A [001:1774-1780].
fn position_supervision(number: u16) -> Verdict {
    let (base, message) = match number {
        56 => ("60=0 56=1 57=30", "POSITIONING ERROR X"),
        57 => ("60=0 57=1 56=30", "GROSS POSITIONING ERROR X A"),
        174 => ("60=1 174=1 175=30", "GROSS POSITIONING ERROR X A"),
        _ => ("60=1 175=1 174=30", "POSITIONING ERROR X"),
    };
    let [(first, said), (second, said_changed)] = both(number, "2", |mps| held(&format!("{base} {mps}")));
    same([said, said_changed], [message.to_owned(), message.to_owned()])?;
    pair([first, second], [1.07, 2.07], 0.08)
}

/// X rests and its drive dies; pushed by hand it leaves MP169: GROSS POSITIONING ERROR D [001:1627-1630].
fn standstill(number: u16) -> Verdict {
    let seen = both(number, "0.5", |mps| {
        let mut rig = ready(bench("234=10").mps(mps));
        rig.event("fault drive X dead");
        rig.event("force X -0.02");
        let from = rig.table('X');
        rig.until(20.0, "1 mm", |rig| from - rig.table('X') > 1.0);
        rig.messages().join(" ")
    });
    same(seen, [String::new(), "GROSS POSITIONING ERROR X D".to_owned()])
}

/// A voltage without movement above MP234, here 0.5 V: GROSS POSITIONING ERROR C; F1000 are 1.5 V [001:1632-1635].
fn movement(number: u16) -> Verdict {
    let seen = both(number, "0.5", |mps| held(&format!("175=3 174=6 {mps}")).1);
    same(
        seen,
        [
            "POSITIONING ERROR X".to_owned(),
            "GROSS POSITIONING ERROR X C".to_owned(),
        ],
    )
}

/// After POSITIONING ERROR the voltage goes after MP185 [001:1684-1685].
fn residual_voltage(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let mut rig = ready(
            bench("8=600 9=600 10=600 11=600 185=0 175=1 174=30")
                .mps(mps)
                .program("1", "L IX-40 R0 F1000"),
        );
        begin(&mut rig);
        rig.event("fault clamp X");
        rig.until(20.0, "a message", |rig| !rig.messages().is_empty());
        let from = rig.control.time_us();
        rig.until(5.0, "0 V", |rig| signal(rig, "output.1").abs() < 0.01);
        (rig.control.time_us() - from) as f64 * 1e-6
    });
    pair(seen, [0.0, 1.0], 0.03)
}

/// Every MP252 times 20 ms the offset is compensated by a step of 2.44 mV, while all stand [001:2591-2606].
fn offset_adjustment(number: u16) -> Verdict {
    const STEP: f64 = 10.0 / 4096.0;
    let seen = both(number, "25", |mps| {
        let build = bench("252=0").mps(mps);
        let mut rig = asked(build.plant("[axis.X]", "[axis.X]\noffset_mv = 11"));
        rig.seconds(5.0);
        (rig.control.remember().offsets_volts[0].abs() / STEP).round()
    });
    pair(seen, [0.0, 4.0], 0.0)
}
