//! What the fault campaign found where the machine leads the path: a probe, or a spindle.

use crate::support::{host, machine, mill, seconds};
use bahn_exchange::signal;
use bahn_host::{Action, Host, PowerOn, Source};
use bahn_path::Axis;
use bahn_tnc::{AxisWatch, Control, RunState, Signal};

fn give(host: &mut Host, what: &str) {
    host.act(Source::Script, Action::parse(what).unwrap()).unwrap();
}

fn until(host: &mut Host, what: &str, holds: impl Fn(&Control) -> bool) {
    let end_us = host.control().time_us() + 120_000_000;
    while !holds(host.control()) {
        let shown = host.control().shown();
        assert!(
            host.control().time_us() < end_us,
            "{what} does not come: {shown:?}"
        );
        host.step().unwrap();
    }
}

fn axis(control: &Control, axis: Axis) -> AxisWatch {
    control.first().watch().find(|watch| watch.axis == axis).unwrap()
}

/// A program of a machine's folder without its first and last line.
fn shipped(name: &str, program: &str) -> Host {
    let machine = machine(name);
    let text = std::fs::read_to_string(machine.root.join("programs").join(program)).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let blocks = lines.get(1..lines.len() - 1).unwrap().join("\n");
    host(&machine, PowerOn::fresh(&machine), &blocks)
}

/// EMERGENCY STOP and CE; no axis is commanded to move before NC start. Then the run goes on.
fn stop_and_go_on(host: &mut Host) {
    give(host, "emergency press");
    seconds(host, 1.0);
    give(host, "emergency release");
    seconds(host, 0.5);
    let stood = host.control().first().commanded();
    give(host, "ce");
    for _ in 0..100 {
        host.step().unwrap();
        let stands = host.control().first().commanded();
        for letter in [Axis::X, Axis::Y, Axis::Z] {
            let way = (stands[letter] - stood[letter]).abs();
            assert!(way < 1e-9, "{letter:?} jumps by {way} mm with CE");
        }
    }
    assert_eq!(host.control().run_state(), RunState::Interrupted);
    give(host, "key NC_START tap");
}

fn probes(control: &Control, letter: Axis) -> bool {
    control.first().is_led_by_probe() && axis(control, letter).speed_mm_s.abs() > 1.0
}

/// EMERGENCY STOP while the probe is on its way to a side: CE takes the axes over from where they stand, and what probes
/// left them 0.2 mm farther on. They go back there with NC start alone, and the side X = 0 is found as it is, within what
/// the probe resolves at 250 mm/min in a servo step of 3 ms: 0.0125 mm.
#[test]
fn a_probing_axis_does_not_jump_after_an_emergency_stop() {
    let mut host = shipped("mill", "DATUM.H");
    until(&mut host, "the way to the side", |control| {
        probes(control, Axis::X) && axis(control, Axis::X).speed_mm_s > 4.0
    });
    seconds(&mut host, 0.3);
    stop_and_go_on(&mut host);
    until(&mut host, "the touch", |control| {
        control.element().is_some_and(|element| element.block.block >= 11)
    });
    let found = host.control().first().q_value(1);
    assert!(found.abs() < 0.0125, "Q1 = {found}");
}

/// As well while a tool is measured: the ways of its sequence begin where the axes are led back to.
#[test]
fn a_measuring_axis_does_not_jump_after_an_emergency_stop() {
    let mut host = shipped("mill", "MEASURE.H");
    until(&mut host, "the way to the tool probe", |control| {
        probes(control, Axis::X)
    });
    seconds(&mut host, 0.1);
    stop_and_go_on(&mut host);
    until(&mut host, "the next block", |control| {
        control.element().is_some_and(|element| element.block.block >= 9)
    });
}

/// Y is pushed 145 mm away from the plate, which is 70 mm wide, while its encoder is stuck: where the axis stands, the control
/// cannot know. The stylus meets nothing on its way down to Z = 0: MP6130 = 50 mm behind its start the way ends, with TOUCH POINT
/// INACCESSIBLE [003:4410] [003:7250]; nothing moves beside it or beyond.
#[test]
fn a_stylus_beside_its_plate_goes_to_the_end_of_its_way() {
    let mut host = shipped("mill-tnc360", "PLATE.H");
    until(&mut host, "the way to the plate", |control| {
        probes(control, Axis::Z)
    });
    let table = |host: &Host| host.plant().axis('Y').unwrap().position;
    let stood = table(&host);
    give(&mut host, "fault encoder Y stuck");
    give(&mut host, "force Y 4000");
    seconds(&mut host, 0.15);
    give(&mut host, "force Y 0");
    give(&mut host, "repair all");
    assert!(table(&host) - stood > 70.0, "{stood} to {}", table(&host));
    let [from, to] = host.control().first().probing_way().unwrap();
    assert!(
        (from[Axis::Z] - to[Axis::Z] - 50.0).abs() < 1e-9,
        "{from:?} {to:?}"
    );
    until(&mut host, "the message", |control| {
        let place = control.first().commanded();
        let beside = |axis: Axis| (place[axis] - from[axis]).abs();
        assert!(
            beside(Axis::X).max(beside(Axis::Y)) < 1e-9 && place[Axis::Z] >= to[Axis::Z],
            "{place:?}"
        );
        control.run_state() != RunState::Running
    });
    let control = host.control();
    let shown: Vec<String> = control
        .shown()
        .iter()
        .map(|shown| control.shown_text(shown))
        .collect();
    assert_eq!(shown, ["TOUCH POINT INACCESSIBLE"]);
    assert_eq!(control.first().commanded()[Axis::Z], to[Axis::Z]);
}

const TAPPING: &str = "TOOL CALL 6 Z S320\nL Z+50 R0 FMAX M13\nCYCL DEF 17.0 RIGID TAPPING\nCYCL DEF 17.1 SET UP -3\n\
    CYCL DEF 17.2 DEPTH -15\nCYCL DEF 17.3 PITCH +1.25\nL X+0 Y+0 FMAX\nL Z+3 FMAX M99\nL Z+50 FMAX";

/// EMERGENCY STOP ends the orientation before a thread [000:6122]; with NC start it is asked for again, or the path would
/// wait for it for ever.
#[test]
fn a_spindle_is_oriented_again_after_an_emergency_stop() {
    let mut host = mill(TAPPING);
    until(&mut host, "the orientation", |control| {
        let nc = control.memory();
        nc.bit(signal::RIGID_TAPPING_ACTIVE) && nc.bit(signal::SPINDLE_IN_MOTION)
    });
    stop_and_go_on(&mut host);
    until(&mut host, "the thread", |control| control.first().is_in_thread());
    until(&mut host, "the end", Control::has_ended);
}

/// The drive of the spindle fails in a thread, and the PLC withdraws the feed enable until it is back: the spindle has
/// run out by turns meanwhile. The tool axis does not go after it at once.
#[test]
fn a_tool_axis_does_not_jump_after_a_spindle_that_ran_out() {
    let mut host = mill(TAPPING);
    until(&mut host, "the thread", |control| {
        control.first().is_in_thread() && control.observe(&Signal::SpindleRpm).abs() > 300.0
    });
    give(&mut host, "fault drive S dead");
    seconds(&mut host, 0.53);
    give(&mut host, "repair all");
    for _ in 0..1000 {
        host.step().unwrap();
        let z = axis(host.control(), Axis::Z);
        assert!(z.speed_mm_s.abs() <= z.rapid_mm_s, "{} mm/s", z.speed_mm_s);
        assert_eq!(z.fault, None);
    }
}

/// The door withdraws the feed enable for 100 ms while a tool is measured in rapid traverse: what leads its axes stands, too, and no
/// axis goes after it with more than MP1060 when the enable is back.
#[test]
fn a_measuring_axis_does_not_jump_after_the_feed_enable() {
    let mut host = shipped("mill", "MEASURE.H");
    until(&mut host, "the way to the tool probe", |control| {
        probes(control, Axis::X) && axis(control, Axis::X).speed_mm_s.abs() > 30.0
    });
    give(&mut host, "switch door open");
    until(&mut host, "the halt", |control| axis(control, Axis::X).halted);
    seconds(&mut host, 0.1);
    give(&mut host, "switch door closed");
    let mut before = axis(host.control(), Axis::X);
    let cycle_s = f64::from(host.control().cycle_us()) * 1e-6;
    for _ in 0..500 {
        host.step().unwrap();
        let now = axis(host.control(), Axis::X);
        let most = now.acceleration_mm_s2 * std::f64::consts::SQRT_2 * cycle_s * 1.001;
        let step = (now.speed_mm_s - before.speed_mm_s).abs();
        assert!(
            now.halted || before.halted || step <= most,
            "{step} mm/s in a cycle, at most {most}"
        );
        before = now;
    }
    give(&mut host, "key NC_START tap");
    until(&mut host, "the next block", |control| {
        control.element().is_some_and(|element| element.block.block >= 9)
    });
}
