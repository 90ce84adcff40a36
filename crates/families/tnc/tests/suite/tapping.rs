//! Tapping on the mill: cycles 17 and 18, in which Z follows the spindle, and cycle 2 [000:6047-6145].

use crate::support::*;
use bahn_exchange::Bit;
use bahn_machine::Machine;
use bahn_servo::{Commands, Measured, Plant, Step};
use bahn_tnc::{RunState, Signal};

const PITCH: f64 = 1.5;
const DEPTH: f64 = 20.0;
const RPM: f64 = 600.0;

/// A hole M10 in the middle of the table, from 3 mm above it: `more` after the call.
fn rigid(more: &str) -> Build {
    let program = format!(
        "TOOL CALL 3 Z S{RPM}
CYCL DEF 17.0 RIGID TAPPING
CYCL DEF 17.1 SET UP -3
CYCL DEF 17.2 DEPTH -{DEPTH}
CYCL DEF 17.3 PITCH +{PITCH}
L X+20 Y+20 R0 FMAX
L Z+3 FMAX M3
CYCL CALL
{more}"
    );
    Build::mill().program("1.H", &program)
}

/// The same with a floating holder: cycle 2.
const FLOATING_HOLDER: &str = "TOOL CALL 3 Z S600
CYCL DEF 2.0 TAPPING
CYCL DEF 2.1 SET UP -3
CYCL DEF 2.2 DEPTH -20
CYCL DEF 2.3 DWELL 0.1
CYCL DEF 2.4 F900
L X+20 Y+20 R0 FMAX
L Z+3 FMAX M3
CYCL CALL
L Z+50 FMAX M5";

/// Power on, reference run, datum 100 mm below the tool; the program is selected.
fn ready(build: Build) -> Rig {
    let mut rig = build.rig();
    rig.power_on();
    rig.seconds(0.5);
    for (axis, value) in [("X", 0.0), ("Y", 0.0), ("Z", 100.0)] {
        rig.command(&format!("datum {axis} {value}"));
    }
    rig.command("mode full");
    rig.command("select 1.H");
    rig
}

fn observe(rig: &Rig, signal: &str) -> f64 {
    rig.control.observe(&signal.parse::<Signal>().unwrap())
}

/// One look at a thread.
#[derive(Clone, Copy, Debug)]
struct Seen {
    angle: f64,
    z: f64,
    rpm: f64,
}

fn look(rig: &Rig) -> Seen {
    Seen {
        angle: observe(rig, "S.angle"),
        z: observe(rig, "Z.actual"),
        rpm: observe(rig, "S.rpm"),
    }
}

/// Runs while M2095 is set and the spindle turns in the thread, `act` in every cycle; what was seen.
fn record(rig: &mut Rig, seconds: f64, mut act: impl FnMut(&mut Rig, &Seen)) -> Vec<Seen> {
    rig.until(60.0, "M2095", |rig| rig.bit("M2095"));
    rig.until(30.0, "orientation", |rig| rig.bit("M2127"));
    rig.until(30.0, "oriented", |rig| !rig.bit("M2127"));
    rig.until(5.0, "the thread begins", |rig| observe(rig, "path.speed") > 0.0);
    let end = rig.control.time_us() + (seconds * 1e6) as u64;
    let mut seen = Vec::new();
    while rig.bit("M2095") {
        assert!(
            rig.control.time_us() < end,
            "{:?} {:?}",
            rig.messages(),
            rig.control.snapshot()
        );
        rig.cycle();
        let now = look(rig);
        act(rig, &now);
        seen.push(now);
    }
    seen
}

/// Distance of Z from the line through the thread that fits best, mm. A right-hand thread: as the spindle turns on
/// Z goes down.
fn deviations(seen: &[Seen]) -> Vec<f64> {
    let line = |s: &Seen| s.z + s.angle / 360.0 * PITCH;
    let mut all: Vec<f64> = seen.iter().map(line).collect();
    all.sort_by(f64::total_cmp);
    let middle = all[all.len() / 2];
    seen.iter().map(|s| line(s) - middle).collect()
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, b| f64::max(a, b.abs()))
}

/// The lag law at 900 mm/min with kv = 4 (m/min)/mm: 0.225 mm. With pre-control there is a tenth of it left at
/// most, from friction and play of the drive at its reversals.
const TOLERANCE: f64 = 0.1 * RPM * PITCH / 4000.0;

fn assert_on_the_thread(seen: &[Seen]) {
    let off = greatest(&deviations(seen));
    assert!(off < TOLERANCE, "{off} mm off the thread");
}

/// Z stays on the thread all the way in, through the reversal and out: in at +600 rpm, out at -600 rpm. Where
/// nothing changes, the lag is within 1 µm.
#[test]
fn the_tool_axis_follows_the_spindle() {
    let mut rig = ready(rigid(""));
    rig.start();
    rig.until(60.0, "M2048", |rig| rig.bit("M2048"));
    assert!(rig.bit("M2095"));
    let seen = record(&mut rig, 30.0, |_, _| {});
    assert_on_the_thread(&seen);
    let steady: Vec<Seen> = seen
        .iter()
        .filter(|s| (s.rpm - RPM).abs() < 1.0)
        .copied()
        .collect();
    assert!(steady.len() > 100 && greatest(&deviations(&steady)) < 0.001);
    let rpm = seen.iter().map(|s| s.rpm);
    let (fastest, slowest) = (rpm.clone().fold(f64::MIN, f64::max), rpm.fold(f64::MAX, f64::min));
    // The drive of 60 ms swings past the end of its ramp.
    assert!(
        (fastest - RPM).abs() < 0.1 * RPM && (slowest + RPM).abs() < 0.1 * RPM,
        "{fastest} {slowest}"
    );
    let deepest = seen.iter().map(|s| s.z).fold(f64::MAX, f64::min);
    let depth = seen[0].z - deepest;
    // The spindle does not turn beyond the depth [000:6128]: 0.02 mm are 4.8 degrees.
    assert!((depth - DEPTH - 3.0).abs() < 0.02, "{depth}");
    // 23 mm at 15 mm/s; the ramp 0.01 V/ms, 1500 rpm at 9 V, is 1667 rpm/s: 0.36 s up and down. What the run-in
    // needs until the spindle stands within MP7150 comes to it.
    let planned = 2.0 * (23.0 / 15.0 + RPM / (0.01 * 1000.0 * 1500.0 / 9.0));
    let time = seen.len() as f64 * 0.003;
    assert!(time > planned - 0.01 && time < planned + 2.0, "{time} {planned}");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
    assert!(!rig.bit("M2048") && !rig.bit("M2095"));
    assert!(
        rig.bit("M2487") && !rig.bit("M2485"),
        "the spindle stands after the cycle"
    );
}

/// The machine, and what passed its connectors in each servo step.
struct Recorder<'a> {
    machine: &'a mut Machine,
    steps: Vec<ServoStep>,
}

/// Voltage of output S, turns of the spindle, place of Z, mm.
#[derive(Clone, Copy)]
struct ServoStep {
    volts: f64,
    turns: f64,
    z: f64,
}

impl ServoStep {
    fn seen(&self) -> Seen {
        Seen {
            angle: self.turns * 360.0,
            z: self.z,
            rpm: 0.0,
        }
    }
}

/// The greatest change of the voltage from one servo step to the next, V.
fn greatest_step(steps: &[ServoStep]) -> f64 {
    let volts = steps.windows(2).map(|pair| pair[1].volts - pair[0].volts);
    volts.fold(0.0, |greatest, volts| f64::max(greatest, volts.abs()))
}

impl Plant for Recorder<'_> {
    fn exchange(&mut self, step: Step, commands: &Commands, measured: &mut Measured) {
        self.machine.exchange(step, commands, measured);
        if step.length_us > 0 {
            self.steps.push(ServoStep {
                volts: commands.axes[5].volts,
                // 1024 lines, 1024 steps of each; 20 µm, 1024 steps of each.
                turns: measured.encoders[5].count as f64 / 1024.0 / 1024.0,
                z: measured.encoders[2].count as f64 * 0.02 / 1024.0,
            });
        }
    }
}

/// In each servo step from the first on the voltage is on the ramp MP3410.3, and Z is where the turn of the spindle
/// says: in cycle 17 and cycle 18, one after the other, and in a thread after M03; with the drive of the mill and
/// with one that follows its voltage at once.
///
/// 0.01 V/ms are 0.006 V in a step of 0.6 ms. kv 2 is 33/s: the loop adds its part of a change of the lag, which is,
/// with the time constant of 60 ms, no more than the ramp itself for 60 ms: 33/s · 60 ms = 2 of it.
#[test]
fn the_voltage_is_on_its_ramp_in_every_servo_step_of_a_thread() {
    let thread = |cycle: u32, set_up: &str| {
        format!(
            "CYCL DEF {cycle}.0 THREAD
{set_up}CYCL DEF {cycle}.{} DEPTH -{DEPTH}
CYCL DEF {cycle}.{} PITCH +{PITCH}
L Z+5 FMAX
L Z+3 FMAX
CYCL CALL
",
            if cycle == 17 { 2 } else { 1 },
            if cycle == 17 { 3 } else { 2 },
        )
    };
    let [tap, cut] = [thread(17, "CYCL DEF 17.1 SET UP -3\n"), thread(18, "")];
    let program = format!(
        "TOOL CALL 3 Z S300\nL X+20 Y+20 R0 FMAX\n{tap}{cut}L X+25 FMAX\nL Z+3 FMAX M3\nL X+30 FMAX\n{tap}{cut}L X+40 FMAX"
    );
    for (milliseconds, reserve) in [("60", 3.0), ("0", 1.1)] {
        let mill = Build::mill().plant(
            "time_constant_ms = 60        # [0] of the drive",
            &format!("time_constant_ms = {milliseconds}"),
        );
        let mut rig = ready(mill.program("1.H", &program));
        rig.start();
        let rigid: Bit = "M2095".parse().unwrap();
        let mut threads = 0;
        while threads < 4 {
            rig.until(60.0, "M2095", |rig| rig.control.exchange().nc().bit(rigid));
            assert_eq!(observe(&rig, "path.speed"), 0.0);
            let mut recorder = Recorder {
                machine: &mut rig.machine,
                steps: Vec::new(),
            };
            let end = rig.control.time_us() + 60_000_000;
            // The servo steps with which the path begins and ends to follow the spindle.
            let (mut coupled, mut free) = (None, 0);
            while rig.control.exchange().nc().bit(rigid) {
                assert!(rig.control.time_us() < end, "{:?}", rig.control.snapshot());
                free = recorder.steps.len();
                rig.control.prepare();
                rig.control.cycle(&mut recorder);
                if coupled.is_none() && rig.control.observe(&"path.speed".parse().unwrap()) > 0.0 {
                    coupled = Some(free);
                }
            }
            let steps = &recorder.steps[coupled.unwrap()..free];
            let greatest = greatest_step(steps);
            let name = format!("thread {threads}, {milliseconds} ms");
            assert!(
                greatest <= 0.006 * reserve,
                "{name}: {greatest} V in a servo step"
            );
            let seen: Vec<Seen> = steps.iter().map(ServoStep::seen).collect();
            let off = self::greatest(&deviations(&seen));
            assert!(off < TOLERANCE, "{name}: {off} mm off the thread");
            threads += 1;
        }
        assert_eq!(rig.messages(), [""; 0]);
    }
}

/// In a thread nothing but the thread moves the spindle: what the PLC asks of it meanwhile, to jog (M2490, M2491), to turn
/// (M2501), to be oriented (M2712), M04, does nothing, and the tool stays in the thread (inferred).
#[test]
fn the_plc_does_not_turn_a_spindle_in_a_thread() {
    for marker in ["M2490", "M2491", "M2501", "M2712", "M2486"] {
        let mut build = rigid("");
        let others = if marker == "M2486" {
            "       L     M1999\n       R     M2485\n       R     M2487\n"
        } else {
            ""
        };
        build.plc = build.plc.replace(
            "       CM    PANEL\n",
            &format!(
                "       CM    PANEL\n       L     I134\n       AN    M1999\n       S     M1999\n{others}       L     M1999\n       S     {marker}\n"
            ),
        );
        let mut rig = ready(build);
        rig.start();
        rig.until(60.0, "M2095", |rig| rig.bit("M2095"));
        rig.until(30.0, "in the thread", |rig| observe(rig, "S.rpm") > 0.9 * RPM);
        rig.event("key Y+ press");
        let mut recorder = Recorder {
            machine: &mut rig.machine,
            steps: Vec::new(),
        };
        for _ in 0..2000 {
            rig.control.prepare();
            rig.control.cycle(&mut recorder);
        }
        let steps = std::mem::take(&mut recorder.steps);
        assert!(rig.bit("M1999") && !rig.bit("M2095"), "{marker}");
        let out = steps.iter().position(|s| s.volts < -3.5).unwrap();
        assert!(
            greatest_step(&steps[..out]) <= 0.006 * 3.0,
            "{marker}: {}",
            greatest_step(&steps[..out])
        );
        let seen: Vec<Seen> = steps[..out].iter().map(ServoStep::seen).collect();
        let off = greatest(&deviations(&seen));
        assert!(off < TOLERANCE, "{marker}: {off} mm off the thread");
    }
}

/// Cycle 18 cuts from where the tool stands to the depth and stays there, with M2095 and without M2048. The next cut
/// begins with the spindle at the same angle, so it is in the same groove [000:6143-6145].
#[test]
fn cycle_18_cuts_the_same_groove_again() {
    let program = format!(
        "TOOL CALL 3 Z S{RPM}
CYCL DEF 18.0 THREAD CUTTING
CYCL DEF 18.1 DEPTH -{DEPTH}
CYCL DEF 18.2 PITCH +{PITCH}
L X+20 Y+20 R0 FMAX
L Z+3 FMAX
CYCL CALL
L X+25 FMAX
L Z+3 FMAX
L X+20 FMAX
CYCL CALL
L X+25 FMAX"
    );
    let mut rig = ready(Build::mill().program("1.H", &program));
    rig.start();
    let cuts = [(); 2].map(|()| {
        let seen = record(&mut rig, 30.0, |rig, _| assert!(!rig.bit("M2048")));
        assert_on_the_thread(&seen);
        let depth = seen[0].z - seen.iter().map(|s| s.z).fold(f64::MAX, f64::min);
        assert!((depth - DEPTH).abs() < 0.1, "{depth}");
        // To a step of its encoder in a cycle of 3 ms: 60 / 4096 / 0.003 = 4.9 rpm.
        assert!(observe(&rig, "S.rpm").abs() < 5.0, "the spindle stands");
        seen
    });
    // Where Z is when the spindle is at 0 degrees: the same groove, or one that is whole pitches away.
    let groove = |seen: &[Seen]| seen[seen.len() / 2].z + seen[seen.len() / 2].angle / 360.0 * PITCH;
    let apart = (groove(&cuts[1]) - groove(&cuts[0])) / PITCH;
    assert!((apart - apart.round()).abs() * PITCH < TOLERANCE, "{apart}");
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}

/// The override of the spindle takes the feed along, that of the feed does nothing [003:5106].
#[test]
fn overrides_in_the_thread() {
    let mut rig = ready(rigid(""));
    rig.start();
    let mut fast = 0.0f64;
    let seen = record(&mut rig, 60.0, |rig, now| {
        if now.rpm > 300.0 && fast == 0.0 {
            rig.event("override spindle 80");
            rig.event("override feed 0");
            fast = now.rpm;
        }
    });
    assert_on_the_thread(&seen);
    let longest = seen.iter().filter(|s| (s.rpm - 0.8 * RPM).abs() < 2.0).count();
    assert!(fast > 0.0 && longest > 100, "{longest} cycles at 480 rpm");
}

/// NC stop in the thread, on the way in, near the depth and on the way out: spindle and axis come to a standstill
/// together; NC start goes on.
#[test]
fn nc_stop_in_the_thread() {
    for at_s in [0.3, 1.0, 1.75, 2.9] {
        let mut rig = ready(rigid(""));
        rig.start();
        let mut began = None;
        let mut stood = false;
        let seen = record(&mut rig, 60.0, |rig, now| {
            let time = rig.control.time_us();
            let since = (time - *began.get_or_insert(time)) as f64 * 1e-6;
            if (at_s..at_s + 0.003).contains(&since) {
                rig.event("key NC_STOP tap");
            }
            if (at_s + 1.5..at_s + 1.6).contains(&since) {
                assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
                assert!(now.rpm.abs() < 3.0, "{now:?} after {since} s");
                stood = true;
            }
            if (at_s + 2.0..at_s + 2.003).contains(&since) {
                rig.start();
            }
        });
        assert!(stood);
        assert_on_the_thread(&seen);
        rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
        let depth = seen[0].z - seen.iter().map(|s| s.z).fold(f64::MAX, f64::min);
        assert!((depth - DEPTH - 3.0).abs() < 0.1, "{depth}");
    }
}

/// Stopped in the thread, MANUAL OPERATION and Z+ lead the tool out: the spindle turns back with the axis. Z- does
/// nothing. NC start then cuts the same thread again.
#[test]
fn the_way_out_after_nc_stop() {
    let mut rig = ready(rigid(""));
    rig.start();
    let (mut cycles, mut phase, mut out) = (0, 0, f64::MIN);
    let seen = record(&mut rig, 60.0, |rig, now| {
        cycles += 1;
        match cycles {
            300 => rig.event("key NC_STOP tap"),
            700 => {
                rig.command("manual-operation");
                rig.event("key Z- press");
            }
            800 => {
                assert!(now.rpm.abs() < 3.0, "Z- moves nothing: {now:?}");
                rig.event("key Z- release");
                rig.event("key Z+ press");
                phase = 1;
            }
            1000 => rig.event("key Z+ release"),
            1400 => {
                assert!(now.rpm.abs() < 3.0, "without the key it stands: {now:?}");
                rig.event("key Z+ press");
            }
            2500 => {
                rig.event("key Z+ release");
                out = now.z;
            }
            2600 => rig.start(),
            _ => {}
        }
    });
    assert_eq!(phase, 1);
    assert_on_the_thread(&seen);
    assert!((out - seen[0].z).abs() < 0.02, "{out} {}", seen[0].z);
    rig.until(5.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}

/// EMERGENCY STOP in the thread, at seeded times: the loops open; when the voltage is back and the message is
/// cleared, the tool is led out as spindle and axis then stand, or the thread is cut to its end.
#[test]
fn emergency_stop_in_the_thread() {
    for (at, retreats) in [(120, true), (437, true), (611, false), (1003, true)] {
        let mut rig = ready(rigid(""));
        rig.start();
        rig.until(60.0, "the thread begins", |rig| {
            rig.bit("M2095") && observe(rig, "path.speed") > 0.0
        });
        for _ in 0..at {
            rig.cycle();
        }
        rig.event("emergency press");
        rig.until(20.0, "the loops are open", |rig| !rig.bit("M2000"));
        assert!(rig.messages().iter().any(|text| text.contains("EMERGENCY STOP")));
        // The spindle runs out without power.
        rig.seconds(10.0);
        rig.event("emergency release");
        rig.seconds(1.0);
        while !rig.messages().is_empty() {
            rig.command("ce");
            rig.seconds(0.1);
        }
        rig.seconds(1.0);
        let before = look(&rig);
        assert!(before.rpm.abs() < 3.0);
        let mut seen = Vec::new();
        if retreats {
            rig.command("manual-operation");
            rig.event("key Z+ press");
        } else {
            rig.start();
        }
        for _ in 0..2500 {
            rig.cycle();
            if rig.bit("M2095") {
                seen.push(look(&rig));
            }
        }
        assert_on_the_thread(&seen);
        assert_eq!(rig.messages(), [""; 0]);
        let highest = seen.iter().map(|s| s.z).fold(f64::MIN, f64::max);
        assert!(highest > before.z + 1.0, "{highest} from {before:?}");
        if retreats {
            assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
            rig.event("key Z+ release");
            rig.seconds(0.5);
            rig.command("stop");
            rig.seconds(0.05);
            assert!(!rig.bit("M2095"));
            // The spindle is free again.
            rig.command("mode manual");
            rig.command("m 3");
            rig.start();
            rig.until(5.0, "M3", |rig| observe(rig, "S.rpm") > 0.9 * RPM);
        } else {
            rig.until(20.0, "the end", |rig| rig.control.snapshot().ended);
        }
    }
}

/// INTERNAL STOP in the thread is refused: axis and spindle stay coupled, and the way out is that after EMERGENCY STOP.
/// Led out of the thread the run can be broken off.
#[test]
fn internal_stop_in_the_thread() {
    let mut rig = ready(rigid(""));
    rig.start();
    let stop = |rig: &mut Rig| rig.control.command("stop".parse().unwrap());
    let (mut cycles, mut refused) = (0, 0);
    let seen = record(&mut rig, 60.0, |rig, now| {
        cycles += 1;
        match cycles {
            300 => rig.event("key NC_STOP tap"),
            700..1500 => {
                assert!(now.rpm.abs() < 3.0, "{now:?}");
                refused += u32::from(!stop(rig));
                assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"]);
                rig.command("ce");
            }
            1500 => {
                rig.command("manual-operation");
                rig.event("key Z+ press");
            }
            // Half way out.
            1700 => refused += u32::from(!stop(rig)),
            3300 => rig.event("key Z+ release"),
            3500 => assert!(stop(rig), "out of the thread: {:?}", rig.messages()),
            _ => {}
        }
    });
    assert_eq!(refused, 801);
    assert_on_the_thread(&seen);
    let out = seen.last().unwrap().z - seen[0].z;
    assert!(cycles >= 3500 && out.abs() < 0.02, "{cycles} {out}");
    rig.seconds(0.1);
    assert_eq!(rig.control.snapshot().run, RunState::Idle);
    assert!(!rig.bit("M2048") && !rig.bit("M2095"));
}

/// EMERGENCY STOP in cycle 2: the spindle is without power and the tap sits in the hole. When the voltage is back
/// nothing moves, and NC start, which would pull at the tap with the spindle standing, is refused. INTERNAL STOP ends
/// the run; by hand M4 and Z+ lead the tap out.
#[test]
fn emergency_stop_with_a_floating_holder() {
    let mut rig = ready(Build::mill().program("1.H", FLOATING_HOLDER));
    rig.start();
    rig.until(60.0, "M2048", |rig| rig.bit("M2048"));
    let top = observe(&rig, "Z.nominal");
    rig.until(5.0, "in the hole", |rig| observe(rig, "Z.nominal") < top - 8.0);
    rig.event("emergency press");
    rig.until(20.0, "the loops are open", |rig| !rig.bit("M2000"));
    rig.seconds(10.0);
    rig.event("emergency release");
    rig.seconds(1.0);
    while !rig.messages().is_empty() {
        rig.command("ce");
        rig.seconds(0.1);
    }
    let stood = observe(&rig, "Z.actual");
    let stands = |rig: &Rig| (observe(rig, "Z.actual") - stood).abs() < 0.005 && observe(rig, "S.rpm") == 0.0;
    rig.seconds(2.0);
    assert!(stands(&rig), "nobody has pressed START: {:?}", look(&rig));
    rig.start();
    rig.seconds(2.0);
    assert!(stands(&rig), "the spindle does not turn: {:?}", look(&rig));
    assert_eq!(rig.messages(), ["KEY NON-FUNCTIONAL"]);
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.command("ce");
    rig.command("stop");
    rig.seconds(0.1);
    assert!(!rig.bit("M2048"));
    rig.command("mode manual");
    rig.command("m 4");
    rig.start();
    rig.until(5.0, "M4", |rig| observe(rig, "S.rpm") < -590.0);
    rig.event("key Z+ press");
    rig.until(5.0, "out of the hole", |rig| observe(rig, "Z.actual") > top);
    rig.event("key Z+ release");
    assert_eq!(rig.messages(), [""; 0]);
}

/// Cycle 2: M2048 during the cycle; M05 before the depth, M04 there, above M05 and M03. The override of the
/// spindle is off, that of the feed acts from 90 to 110 % [000:6060-6101] [003:5032]. NC stop acts when the tool is
/// out of the thread.
#[test]
fn tapping_with_a_floating_holder() {
    let mut rig = ready(Build::mill().program("1.H", FLOATING_HOLDER));
    rig.start();
    rig.until(60.0, "M2048", |rig| rig.bit("M2048"));
    assert!(!rig.bit("M2095"));
    rig.event("override spindle 50");
    rig.event("override feed 50");
    let from = observe(&rig, "Z.nominal");
    let (mut m5_at, mut m4_at, mut stopped, mut speeds) = (None, None, false, Vec::new());
    while rig.bit("M2048") {
        rig.cycle();
        let z = observe(&rig, "Z.nominal");
        let strobe = rig.bit("M2045");
        match rig.number("W260") {
            5 if strobe => m5_at = m5_at.or(Some(z)),
            4 if strobe => m4_at = m4_at.or(Some(z)),
            _ => {}
        }
        if from - z > 5.0 && m5_at.is_none() {
            speeds.push(observe(&rig, "path.speed"));
            assert!(
                (observe(&rig, "S.rpm") - 600.0).abs() < 5.0,
                "the override of the spindle is off"
            );
        }
        if m4_at.is_some() && !stopped {
            stopped = true;
            rig.event("key NC_STOP tap");
        }
    }
    // F900 at 90 %.
    assert!(
        speeds.iter().all(|speed| (speed - 810.0).abs() < 1.0),
        "{:?}",
        &speeds[..5]
    );
    // S600 are 3.6 V: at 0.01 V/ms 0.36 s before the end, at 13.5 mm/s; the strobe is seen a scan later. With
    // 1.5 m/s² the feed brakes in 9 ms.
    let lead = 13.5 * (0.36 - 0.0045);
    let early = m5_at.unwrap() - m4_at.unwrap();
    assert!(
        early <= lead + 1e-6 && early > lead - 13.5 * 0.03,
        "{early} {lead}"
    );
    // Out of the thread, and there it stands.
    rig.seconds(1.0);
    let depth = observe(&rig, "Z.nominal") - m4_at.unwrap();
    assert!((depth - 23.0).abs() < 0.001, "{depth}");
    assert_eq!(rig.control.snapshot().run, RunState::Interrupted);
    rig.start();
    rig.until(30.0, "the end", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.messages(), [""; 0]);
}
