//! Rows of the axes: speeds, encoders, marks, limits, windows.

use bahn_tnc::Mode;

use crate::bench::{
    AXES, Probe, Row, Verdict, all, bench, both, duration, each_axis, greatest, less, of_axes, only, pair,
    ready, same, signal, tables, watch,
};
use crate::support::knee::asked;
use crate::support::{Build, Rig};

pub const ROWS: &[Row] = &[
    Row(0..=3, Probe::Acts(rapid)),
    Row(4..=7, Probe::Acts(manual_feed)),
    Row(8..=11, Probe::Acts(reference_feed)),
    Row(12..=15, Probe::Acts(evaluation)),
    Row(16..=19, Probe::Acts(reference_direction)),
    Row(20..=23, Probe::Acts(counting_direction)),
    Row(24..=27, Probe::Acts(polarity)),
    Row(36..=39, Probe::Acts(backlash)),
    Row(40..=43, Probe::Acts(linear_error)),
    Row(44..=51, Probe::Acts(limits)),
    Row(54..=54, Probe::Acts(acceleration)),
    Row(55..=55, Probe::Acts(radial_acceleration)),
    Row(58..=58, Probe::Acts(window)),
    Row(59..=59, Probe::Acts(order_of_marks)),
    Row(69..=69, Probe::Acts(backing_off)),
    Row(72..=72, Probe::Acts(inhibited)),
    Row(75..=75, Probe::Acts(inhibited_marks)),
    Row(76..=76, Probe::Acts(supervision)),
    Row(90..=90, Probe::Acts(designation)),
    Row(91..=91, Probe::Acts(corner_angle)),
    Row(192..=192, Probe::Acts(window)),
    Row(242..=245, Probe::Acts(coded_marks)),
    Row(253..=256, Probe::Acts(inputs)),
    Row(257..=257, Probe::Acts(square_wave_input)),
];

/// A spindle with its encoder at X5.
const SPINDLE: &str = r#"
[spindle]
output = "S"
rpm = 3000
volts = 9
encoder = { input = "X5", lines = 1024, mark_deg = 0 }
"#;

/// 15 mm at rapid traverse: 6 m/min is reached after 100² / 4000 = 2.5 mm. 3 m/min are 9 V then [001:1388-1390].
fn rapid(number: u16) -> Verdict {
    let seen = both(number, "3000", |mps| {
        let build = bench(mps).program("1", &each_axis("L I@-15 R0 F15999"));
        greatest(&mut ready(build), "nominal-speed")
    });
    only(number, seen, [6000.0, 3000.0], 1.0)
}

/// The greatest nominal speed of each axis while its direction button is held, mm/min.
fn jogged(rig: &mut Rig) -> [f64; 4] {
    AXES.map(|axis| {
        let key = if axis == 'U' {
            "IV".to_owned()
        } else {
            axis.to_string()
        };
        rig.event(&format!("key {key}- press"));
        rig.seconds(0.2);
        let speed = signal(rig, &format!("{axis}.nominal-speed")).abs();
        rig.event(&format!("key {key}- release"));
        rig.seconds(0.2);
        speed
    })
}

/// Speed by a direction button [001:1018] [001:1392-1394].
fn manual_feed(number: u16) -> Verdict {
    let seen = both(number, "900", |mps| jogged(&mut ready(bench(mps))));
    only(number - 4, seen, [1200.0, 900.0], 1.0)
}

/// Speed to the marks, which are 30 mm off [001:1444-1446].
fn reference_feed(number: u16) -> Verdict {
    let seen = both(number, "1500", |mps| {
        let mut rig = asked(bench(mps).plant("start = 149", "start = 120"));
        rig.start();
        let mut most = [0.0_f64; 4];
        while rig.control.mode() == Mode::Reference {
            assert!(rig.control.time_us() < 60_000_000, "{:?}", rig.messages());
            rig.cycle();
            let now = of_axes(&rig, "nominal-speed");
            most = [0, 1, 2, 3].map(|axis: usize| most[axis].max(now[axis].abs()));
        }
        most
    });
    only(number - 8, seen, [3000.0, 1500.0], 1.0)
}

/// How far the tables go for 4 mm of each axis.
fn ways(mps: &str, block: &str) -> [f64; 4] {
    let mut rig = ready(bench(mps).program("1", &each_axis(block)));
    let before = tables(&rig);
    watch(&mut rig, |_| {});
    rig.settle();
    less(tables(&rig), before)
}

/// 10-fold evaluation takes 10 µm for a period that is 20 µm: the table goes twice as far [001:1616-1625].
fn evaluation(number: u16) -> Verdict {
    let seen = both(number, "2", |mps| ways(mps, "L I@-4 R0 F1000"));
    only(number - 12, seen, [-4.0, -8.0], 0.01)
}

/// Where the axis of a row goes first in the reference run: +1 up, -1 down; and the sign of its voltage.
fn first_move(mps: &str, index: u16) -> [f64; 2] {
    let mut rig = asked(bench(mps));
    rig.start();
    let axis = AXES[usize::from(index)];
    let moves = |rig: &Rig| signal(rig, &format!("{axis}.nominal-speed")) != 0.0;
    rig.until(10.0, "it moves", moves);
    rig.seconds(0.012);
    let volts = signal(&rig, &format!("output.{}", index + 1));
    [
        signal(&rig, &format!("{axis}.nominal-speed")).signum(),
        volts.signum(),
    ]
}

/// 1 is down [001:1476-1478].
fn reference_direction(number: u16) -> Verdict {
    let index = number - 16;
    let seen = both(number, "1", |mps| first_move(mps, index));
    same(seen, [[1.0, 1.0], [-1.0, -1.0]])
}

/// 1 is a negative voltage for positive traverse [001:1665-1668].
fn polarity(number: u16) -> Verdict {
    let index = number - 24;
    let seen = both(number, "1", |mps| first_move(mps, index));
    same(seen, [[1.0, 1.0], [1.0, -1.0]])
}

/// All axes are inhibited and pushed up by hand; 1 lets one count down [001:1661-1664].
fn counting_direction(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let mut rig = bench("72=15 76=1 75=2").mps(mps).rig();
        rig.command("ce");
        rig.seconds(2.0);
        let before = tables(&rig);
        for axis in AXES {
            rig.event(&format!("force {axis} 20"));
        }
        rig.seconds(0.5);
        let moved = less(tables(&rig), before);
        let counted = AXES.map(|axis| rig.machine_position(axis));
        [0, 1, 2, 3].map(|axis: usize| (counted[axis] / moved[axis]).round())
    });
    only(number - 20, seen, [1.0, -1.0], 0.0)
}

/// 4 mm to and 4 mm fro: with a play of 0.05 mm the table does not come back to its place by it [001:1789-1794].
fn backlash(number: u16) -> Verdict {
    let seen = both(number, "0.05", |mps| {
        let blocks = format!(
            "{}\n{}",
            each_axis("L I@-4 R0 F1000"),
            each_axis("L I@+4 R0 F1000")
        );
        let mut rig = ready(bench(mps).program("1", &blocks));
        let before = tables(&rig);
        let mut least = before;
        watch(&mut rig, |rig| {
            let now = tables(rig);
            least = [0, 1, 2, 3].map(|axis: usize| least[axis].min(now[axis]));
        });
        rig.settle();
        less(tables(&rig), least)
    });
    only(number - 36, seen, [4.0, 4.05], 0.006)
}

/// 1 mm/m changes 4 mm by 4 µm [001:1797-1802].
fn linear_error(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| ways(mps, "L I@-4 R0 F1000"));
    only(number - 40, seen, [-4.0, -3.996], 0.0015)
}

/// Where direction buttons bring each axis: 20 mm below its mark and 10 mm above it, changed by 5 mm [001:1669-1676].
fn limits(number: u16) -> Verdict {
    let base = "44=10 45=-20 46=10 47=-20 48=10 49=-20 50=10 51=-20 4=6000 5=6000 6=6000 7=6000";
    let is_minus = number % 2 == 1;
    let index = (number - 44) / 2;
    let seen = both(number, if is_minus { "-15" } else { "5" }, |mps| {
        let mut rig = ready(bench(base).mps(mps));
        let mut press = |sign: char| {
            for axis in ["X", "Y", "Z", "IV"] {
                rig.event(&format!("key {axis}{sign} press"));
            }
            rig.seconds(0.8);
            for axis in ["X", "Y", "Z", "IV"] {
                rig.event(&format!("key {axis}{sign} release"));
            }
            rig.seconds(0.2);
            AXES.map(|axis| rig.machine_position(axis))
        };
        [press('-'), press('+')]
    });
    let [[low, high], [low_changed, high_changed]] = seen;
    only(
        if is_minus { index } else { 4 },
        [low, low_changed],
        [-20.0, -15.0],
        0.02,
    )?;
    only(
        if is_minus { 4 } else { index },
        [high, high_changed],
        [10.0, 5.0],
        0.02,
    )
}

/// A ramp up to 3 m/min: 50 mm/s take 25 ms with 2 m/s², 100 ms with 0.5 m/s² [001:1678]; the way of 20 mm takes 0.4 s and one
/// ramp more.
fn acceleration(number: u16) -> Verdict {
    let seen = both(number, "0.5", |mps| {
        let mut rig = ready(bench(mps).program("1", "L IX-20 R0 F3000"));
        let mut moving = 0.0;
        let cycle_s = f64::from(rig.control.cycle_us()) * 1e-6;
        watch(&mut rig, |rig| {
            if signal(rig, "X.nominal-speed") != 0.0 {
                moving += cycle_s;
            }
        });
        moving
    });
    pair(seen, [0.425, 0.5], 0.012)
}

/// Arcs of 2 mm: 1 m/s² allows sqrt(1000 · 2) = 44.7 mm/s, 0.25 half of it [001:1679] [001:2701].
fn radial_acceleration(number: u16) -> Verdict {
    let seen = both(number, "0.25", |mps| {
        let circle = "CC IX-2 IY+0\nC IX-4 IY+0 DR+ R0 F9999\nC IX+4 IY+0 DR+";
        let mut rig = ready(bench(mps).program("1", circle));
        let mut most = 0.0_f64;
        watch(&mut rig, |rig| most = most.max(signal(rig, "path.speed")));
        most
    });
    let at = |a: f64| (a * 1000.0 * 2.0).sqrt() * 60.0;
    pair(seen, [at(1.0), at(0.25)], 30.0)
}

/// A smaller window is reached later: with kv 2, 33.3 1/s, from 0.05 to 0.005 mm after ln(10) / 33.3 = 69 ms. MP58 is that of
/// X, Y and Z, MP192 that of IV [001:1785-1787].
fn window(number: u16) -> Verdict {
    let time = |mps: &str, block: &str| duration(&mut ready(bench(mps).program("1", block)));
    let late = |axis: char| {
        let block = format!("L I{axis}-2 R0 F3000 M30");
        let [before, after] = both(number, "0.005", |mps| time(mps, &block));
        after - before
    };
    let delay = 10_f64.ln() / (2000.0 / 60.0);
    let wanted = AXES.map(|axis| {
        if (axis == 'U') == (number == 192) {
            delay
        } else {
            0.0
        }
    });
    all("later by", &AXES.map(late), &wanted, 0.025)
}

/// 0 is X Y Z IV, 22 is IV Z X Y [001:1448-1474].
fn order_of_marks(number: u16) -> Verdict {
    let seen = both(number, "22", |mps| {
        let mut rig = asked(bench(mps));
        rig.start();
        let mut order = String::new();
        while rig.control.mode() == Mode::Reference {
            assert!(rig.control.time_us() < 60_000_000, "{:?}", rig.messages());
            rig.cycle();
            for axis in AXES {
                if rig.axis(axis).referenced && !order.contains(axis) {
                    order.push(axis);
                }
            }
        }
        order
    });
    same(seen, ["XYZU".to_owned(), "UZXY".to_owned()])
}

/// An axis on its cam, which closes at 140 mm, is backed off it first [001:989-995].
fn backing_off(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let mut rig = asked(bench(mps));
        let [least, _] = rig.way_to_mark();
        least < 140.0
    });
    same(seen, [false, true])
}

/// +4: Z has no closed loop and is not asked for its mark [001:1340-1359].
fn inhibited(number: u16) -> Verdict {
    let seen = both(number, "4", |mps| {
        let rig = ready(bench(mps));
        let axes = rig.control.snapshot().axes;
        let closed = axes.iter().filter(|axis| axis.closed);
        closed.map(|axis| axis.letter).collect::<String>()
    });
    same(seen, ["XYZU".to_owned(), "XYU".to_owned()])
}

/// Axis IV is inhibited and shown. 0: not asked for; 1: asked for; 2: counts at once [001:3266].
fn inhibited_marks(number: u16) -> Verdict {
    let look = |value: u8| {
        let rig = asked(bench(&format!("72=8 76=1 {number}={value}")));
        let axes = rig.control.snapshot().axes;
        let asked = axes.iter().filter(|axis| axis.mark_wanted);
        let asked: String = asked.map(|axis| axis.letter).collect();
        (asked, rig.axis('U').referenced)
    };
    same(
        [0, 1, 2].map(look),
        [("XYZ", false), ("XYZU", false), ("XYZ", true)].map(|(asked, counts)| (asked.to_owned(), counts)),
    )
}

/// Bit 0 shows an inhibited axis; the others switch the supervision of the encoders of X, Y, Z and IV off, +32 that of
/// V [001:1366-1375].
fn supervision(number: u16) -> Verdict {
    let shown = both(number, "1", |mps| {
        let rig = asked(bench("72=8").mps(mps));
        let axes = rig.control.snapshot().axes;
        axes.iter().map(|axis| axis.letter).collect::<String>()
    });
    same(shown, ["XYZ".to_owned(), "XYZU".to_owned()])?;
    for (bit, part) in (1..).zip(["X", "Y", "Z", "U", "S"]) {
        let found = both(number, &format!("{}", 1 << bit), |mps| {
            let mut rig = ready(bench("237=1").with(SPINDLE).mps(mps));
            rig.event(&format!("fault encoder {part} amplitude"));
            rig.seconds(0.2);
            rig.messages().len()
        });
        same((part, found), (part, [1, 0]))?;
    }
    Ok(())
}

/// 3 is U, 5 is W [001:1377-1380].
fn designation(number: u16) -> Verdict {
    let seen = both(number, "5", |mps| {
        let build = bench("").mps(mps);
        let rig = if mps.is_empty() {
            asked(build)
        } else {
            asked(build.plant("[axis.U]", "[axis.W]").plant("[axis.U.", "[axis.W."))
        };
        let axes = rig.control.snapshot().axes;
        axes.last().map(|axis| axis.letter)
    });
    same(seen, [Some('U'), Some('W')])
}

/// A corner of 5 degrees is passed at the feed when MP91 is 10, not when it is 1 [001:1814-1817].
fn corner_angle(number: u16) -> Verdict {
    let seen = both(number, "10", |mps| {
        let blocks = "L IX-10 R0 F1500\nL IX-10 IY-0.875";
        let mut rig = ready(bench("91=1").mps(mps).program("1", blocks));
        let mut block = 0.0;
        let mut least = f64::INFINITY;
        watch(&mut rig, |rig| {
            let now = signal(rig, "path.block");
            if now != block && now >= 2.0 {
                least = least.min(signal(rig, "path.speed"));
            }
            block = now;
        });
        least > 1400.0
    });
    same(seen, [false, true])
}

/// A scale with coded marks: with 1000 · 20 µm the position is known within two marks while the cam is open; with 0 the axis
/// looks for a single mark under its cam [001:977-987] [001:1480].
fn coded_marks(number: u16) -> Verdict {
    let index = usize::from(number - 242);
    let seen = both(number, "1000", |mps| {
        let input = format!("input = \"X{}\"\nperiod_um = 20\nmark = 150", index + 1);
        let coded = format!("input = \"X{}\"\nperiod_um = 20\nmarks_coded = 20", index + 1);
        let first = ["59=0", "59=6", "59=12", "59=18"][index];
        let build = bench(first).mps(mps).plant(&input, &coded);
        let mut rig = asked(build.plant("start = 149", "start = 50"));
        rig.start();
        rig.seconds(1.0);
        rig.axis(AXES[index]).referenced
    });
    same(seen, [false, true])
}

/// How far each axis counts, and the spindle turns, when the table of an axis is pushed up by hand, in parts of its way;
/// all axes are inhibited. The counts are those of the cycle before.
fn counted(build: Build, pushed: usize) -> Vec<f64> {
    let mut rig = build.mps("72=15 76=63 75=2 237=1").with(SPINDLE).rig();
    rig.command("ce");
    rig.seconds(2.0);
    let look = |rig: &Rig| {
        let [x, y, z, iv] = AXES.map(|axis| rig.machine_position(axis));
        [x, y, z, iv, signal(rig, "S.angle")]
    };
    let (from, before) = (rig.table(AXES[pushed]), look(&rig));
    rig.event(&format!("force {} 20", AXES[pushed]));
    rig.seconds(0.2);
    let way = rig.table(AXES[pushed]) - from;
    let after = look(&rig);
    let parts = before.iter().zip(&after);
    parts
        .map(|(before, after)| ((after - before) / way * 10.0).round() / 10.0)
        .collect()
}

/// MP253 to MP256 name the axis that counts what comes at an input: beside its own axis Y, for Y's input Z, and for 5 the
/// spindle [001:2434-2454]. A period of 20 µm is 4 steps of a square wave of 4096 steps a turn.
fn inputs(number: u16) -> Verdict {
    let input = usize::from(number - 253);
    let other = if input == 1 { 2 } else { 1 };
    let own = counted(bench(&format!("{number}=0")), input);
    let named = counted(bench(&format!("{number}={}", other + 1)), input);
    let of_v = counted(bench(&format!("{number}=5")), input);
    let mut wanted = vec![0.0; own.len()];
    wanted[input] = 1.0;
    same(own, wanted)?;
    same([named[other], named[4]], [1.0, 0.0])?;
    let turn = 360.0 / 4096.0 * 4.0 / 0.02;
    all("MP = 5", &[of_v[4]], &[turn], 1.0)
}

/// MP257 = 1 gives the square-wave input X5 to X, whose EXE divides by 5 [001:2453-2454] [001:416].
fn square_wave_input(number: u16) -> Verdict {
    let seen = both(number, "1", |mps| {
        let build = bench("").mps(mps).plant("input = \"X1\"", "input = \"X5\"");
        let build = build.plant("input = \"X5\"\nperiod_um = 20", "input = \"X5\"\nperiod_um = 4");
        let mut rig = build.mps("72=15 76=63 75=2").rig();
        rig.command("ce");
        rig.seconds(2.0);
        let from = rig.table('X');
        let before = rig.machine_position('X');
        rig.event("force X 20");
        rig.seconds(0.2);
        (rig.machine_position('X') - before) / (rig.table('X') - from)
    });
    pair(seen, [0.0, 1.0], 0.05)
}
