//! What the fault campaign found, each as the few things that lead to it.

use crate::support::{host, machine, mill, old_mill, seconds};
use bahn_host::{Action, Host, PowerOn, Source};
use bahn_parameters::fault::FaultId;
use bahn_path::Axis;
use bahn_tnc::{Control, RunState, Signal};

fn give(host: &mut Host, what: &str) {
    host.act(Source::Script, Action::parse(what).unwrap()).unwrap();
}

fn until(host: &mut Host, what: &str, holds: impl Fn(&Control) -> bool) {
    let end_us = host.control().time_us() + 60_000_000;
    while !holds(host.control()) {
        let shown = host.control().shown();
        assert!(
            host.control().time_us() < end_us,
            "{what} does not come: {shown:?}, {:?}",
            host.plant().magazine()
        );
        host.step().unwrap();
    }
}

fn commanded(control: &Control, axis: Axis) -> f64 {
    control.first().commanded()[axis]
}

/// EMERGENCY STOP, release, CE, NC start.
fn stop_and_go_on(host: &mut Host) {
    give(host, "emergency press");
    seconds(host, 1.0);
    give(host, "emergency release");
    seconds(host, 0.5);
    give(host, "ce");
    seconds(host, 0.3);
    assert_eq!(host.control().run_state(), RunState::Interrupted);
    give(host, "key NC_START tap");
}

/// The table is clamped (M10) when EMERGENCY STOP comes: its clamp holds it, so that it need not go back to the contour,
/// and the run goes on to its end.
#[test]
fn a_clamped_axis_holds_no_run_up_after_an_emergency_stop() {
    let mut host = mill("L C+45 F2000 M11\nL Z+100 R0 FMAX M10\nL Z+40 F300\nL Z+100 FMAX");
    until(&mut host, "the clamped table", |control| {
        let third = control.element().is_some_and(|element| element.block.block == 3);
        let below = third && commanded(control, Axis::Z) < 80.0;
        below
            && control.run_state() == RunState::Running
            && control
                .first()
                .watch()
                .any(|axis| axis.axis == Axis::C && !axis.closed)
    });
    stop_and_go_on(&mut host);
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::C), 45.0);
}

/// EMERGENCY STOP while the path waits for an M function: the axes are taken over from where they stand, within their
/// window, and go back to the programmed positions before the path goes on, not only by the next block that names them.
#[test]
fn axes_that_wait_for_a_function_go_back_to_the_contour() {
    let mut host =
        mill("L X+10 Y+20 R0 FMAX\nL C+45 F2000 M11\nL Z+100 R0 FMAX M10\nL Z+40 F300\nL Z+100 FMAX");
    until(&mut host, "the strobe of M10", |control| {
        control.waiting().is_some()
            && commanded(control, Axis::Z) == 100.0
            && commanded(control, Axis::C) == 45.0
    });
    stop_and_go_on(&mut host);
    until(&mut host, "the next block", |control| {
        commanded(control, Axis::Z) < 99.0 && control.run_state() == RunState::Running
    });
    let control = host.control();
    assert_eq!(
        (commanded(control, Axis::X), commanded(control, Axis::Y)),
        (10.0, 20.0)
    );
}

/// The door takes the feed enable away in rapid traverse: 0 V at once, and X runs on by what its drive needs,
/// v²/(2a) = 250²/(2 · 7000) = 4.5 mm, less than MP1710 = 9. MP1410 = 0.5 is the limit of pre-control, which does not
/// control then. Behind the door the run goes on.
#[test]
fn a_door_in_rapid_traverse_is_no_positioning_error() {
    let mut host = mill("L X-100 Y+0 Z+100 R0 FMAX\nL X+300 FMAX");
    until(&mut host, "rapid traverse", |control| {
        commanded(control, Axis::X) > 50.0 && control.run_state() == RunState::Running
    });
    give(&mut host, "switch door open");
    let mut farthest: f64 = 0.0;
    for _ in 0..400 {
        host.step().unwrap();
        let lag = host
            .control()
            .first()
            .watch()
            .find(|axis| axis.axis == Axis::X)
            .unwrap()
            .lag;
        farthest = farthest.max(lag.abs());
    }
    assert!((0.5..9.0).contains(&farthest), "{farthest}");
    let shown = host.control().shown();
    assert!(
        !shown.iter().any(|shown| shown.fault() == FaultId::Positioning),
        "{shown:?}"
    );
    give(&mut host, "switch door closed");
    seconds(&mut host, 1.5);
    for _ in 0..3 {
        give(&mut host, "ce");
        give(&mut host, "key NC_START tap");
        seconds(&mut host, 0.5);
    }
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::X), 300.0);
}

/// A rotary axis of 120 degrees/s, too: with 0 V it needs v²/(2a) = 120² / (2 · 113 N / 3 kg), 3.2 degrees, less than
/// MP1710 = 4.32.
#[test]
fn a_door_stops_rotary_axes_within_their_monitoring() {
    for (name, axis, letter) in [("mill", Axis::C, 'C'), ("gantry", Axis::B, 'B')] {
        let machine = machine(name);
        let blocks = format!("L Z+100 R0 FMAX\nL {letter}-100 FMAX\nL {letter}+100 FMAX");
        let mut host = host(&machine, PowerOn::fresh(&machine), &blocks);
        until(&mut host, "rapid traverse", |control| {
            let third = control.element().is_some_and(|element| element.block.block == 3);
            third && commanded(control, axis) > -10.0
        });
        let from = host.plant().axis(letter).unwrap().position;
        give(&mut host, "switch door open");
        seconds(&mut host, 0.5);
        let way = host.plant().axis(letter).unwrap().position - from;
        assert!(way > 3.0, "{name}: it was on its way, {way}");
        let shown = host.control().shown();
        let fault = shown.iter().find(|shown| shown.fault() == FaultId::Positioning);
        assert!(fault.is_none(), "{name}: {shown:?}");
    }
}

/// The feed enable is back: what X ran on without it, 250²/(2 · 7000) = 4.5 mm, it goes back on its ramp (MP1060), no lag
/// jumps, so that neither MP1410 = 0.5 nor the drive is at its end; the path goes on where X is.
#[test]
fn what_ran_on_without_feed_enable_goes_back_on_the_ramp() {
    let mut host = mill("L X-100 Y+0 Z+100 R0 FMAX\nL X+300 FMAX");
    until(&mut host, "rapid traverse", |control| {
        commanded(control, Axis::X) > 50.0 && control.run_state() == RunState::Running
    });
    let x = |host: &Host| {
        let mut watch = host.control().first().watch();
        watch.find(|axis| axis.axis == Axis::X).unwrap()
    };
    give(&mut host, "switch door open");
    seconds(&mut host, 1.0);
    let ran_on = x(&host).lag.abs();
    assert!(ran_on > 3.0, "{ran_on}");
    give(&mut host, "switch door closed");
    let (mut goes_back, mut greatest, mut fastest) = (false, 0.0_f64, 0.0_f64);
    let mut before = x(&host).actual;
    for _ in 0..500 {
        host.step().unwrap();
        let now = x(&host);
        if !now.halted && now.speed_mm_s == 0.0 {
            goes_back |= (now.actual - now.commanded).abs() > 1.0;
            greatest = greatest.max(now.lag.abs());
            fastest =
                fastest.max((now.actual - before).abs() / (f64::from(host.control().cycle_us()) * 1e-6));
        }
        before = now.actual;
    }
    // The fastest place of the way is its middle: √(a · 4.5 mm), a little more with what the loop adds.
    let bound = (x(&host).acceleration_mm_s2 * ran_on).sqrt();
    assert!(goes_back && greatest < 0.5, "{greatest}");
    assert!(
        fastest > 0.5 * bound && fastest < 1.2 * bound,
        "{fastest} of {bound}"
    );
    assert_eq!(
        host.control()
            .shown()
            .iter()
            .filter(|shown| shown.fault() == FaultId::Positioning)
            .count(),
        0
    );
    give(&mut host, "ce");
    give(&mut host, "key NC_START tap");
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::X), 300.0);
}

/// CE while the path still comes to a standstill after POSITIONING ERROR: X is taken over from where it is, and no
/// nominal position jumps, 250 mm/s is the rapid traverse. After NC start it goes back, and the run goes on.
#[test]
fn ce_on_the_ramp_makes_no_axis_jump() {
    let mut host = mill("L X-100 Y+0 Z+100 R0 FMAX\nL X+300 FMAX\nL X+310 F500");
    until(&mut host, "rapid traverse", |control| {
        commanded(control, Axis::X) > 0.0 && control.run_state() == RunState::Running
    });
    give(&mut host, "fault encoder X stuck");
    let shows = |control: &Control| {
        control
            .shown()
            .iter()
            .any(|shown| shown.fault() == FaultId::Positioning)
    };
    until(&mut host, "POSITIONING ERROR", shows);
    give(&mut host, "repair X");
    give(&mut host, "ce");
    let x = |host: &Host| {
        host.control()
            .first()
            .watch()
            .find(|axis| axis.axis == Axis::X)
            .unwrap()
    };
    for _ in 0..400 {
        host.step().unwrap();
        assert!(x(&host).speed_mm_s.abs() <= 250.0 + 1e-6, "{:?}", x(&host));
    }
    assert_eq!(
        host.control().run_state(),
        RunState::Interrupted,
        "{:?}",
        host.control().shown()
    );
}

/// Digital drives: whatever keeps the motor from the speed that its controller asks for, which then asks for more than
/// MP1910 permits, is GROSS POSITIONING ERROR 3F: the loops are opened, and only power-off helps.
#[test]
fn a_digital_drive_that_does_not_follow_is_3f() {
    for fault in ["fault motor X", "fault drive X dead", "fault clamp X"] {
        let digital = machine("dig425");
        let mut host = host(
            &digital,
            PowerOn::fresh(&digital),
            "L X-100 Y+0 Z+100 R0 FMAX\nL X+200 F6000",
        );
        until(&mut host, "the feed", |control| {
            commanded(control, Axis::X) > 0.0 && control.run_state() == RunState::Running
        });
        give(&mut host, fault);
        seconds(&mut host, 0.5);
        let shown = host.control().shown();
        let first = shown
            .iter()
            .find(|shown| shown.flashing)
            .map(|shown| shown.fault());
        assert_eq!(first, Some(FaultId::SpeedController), "{fault}: {shown:?}");
        assert!(!host.control().loops_closed(), "{fault}");
        give(&mut host, "ce");
        assert!(
            host.control().shown().iter().any(|shown| shown.flashing),
            "{fault}"
        );
    }
}

/// The magazine changes from tool 1 to tool 2 when its arm is stuck, a switch is silent or the chain stands: the PLC says
/// that it does not answer. Repaired, the change goes on where it was, and tool 2 is in the spindle.
#[test]
fn a_magazine_that_is_stuck_goes_on_when_it_is_repaired() {
    for (part, how) in [
        ("arm_turn", "jammed"),
        ("arm_draw", "no-feedback"),
        ("shuttle", "jammed"),
        ("magazine", "jammed"),
        ("magazine", "no-feedback"),
    ] {
        let mut mill = machine("mill");
        for assignment in ["7480.0=3", "4310.0=3"] {
            mill.parameters.assign(assignment).unwrap();
        }
        let power_on = PowerOn::fresh(&mill);
        let mut host = host(
            &mill,
            power_on,
            "TOOL CALL 1 Z S1000\nTOOL CALL 5 Z S1000\nL Z+100 R0 FMAX",
        );
        while host.plant().magazine().unwrap().spindle != 1 {
            assert!(
                host.control().time_us() < 90_000_000,
                "{:?}",
                host.control().shown()
            );
            host.step().unwrap();
        }
        give(&mut host, &format!("fault device {part} {how}"));
        until(&mut host, &format!("the message of {part} {how}"), |control| {
            let mut shown = control.shown().iter();
            shown.any(|shown| control.shown_text(shown) == "TOOL MAGAZINE DOES NOT ANSWER")
        });
        assert!(!host.control().has_ended(), "{part} {how}");
        give(&mut host, &format!("repair {part}"));
        give(&mut host, "ce");
        until(
            &mut host,
            &format!("the end after {part} {how}"),
            Control::has_ended,
        );
        let magazine = host.plant().magazine().unwrap();
        assert_eq!(
            (magazine.spindle, magazine.arm, magazine.shuttle),
            (5, [0, 0], 0),
            "{part} {how}"
        );
        assert_eq!(host.control().remember().tool, 5, "{part} {how}");
    }
}

/// Z of the digital mill weighs. Its brake closes before the torque ends (MP1980 = 0.6 s, the drive goes on for 0.28 s), and
/// at once when the control itself is off, for then nobody gives torque: it never sinks farther than the play of its brake.
/// 100 ms of free fall with (2000 - 150) N on the moved mass would be centimetres.
#[test]
fn no_axis_sinks_between_torque_and_brake() {
    for (away, back) in [
        (&["voltage off"][..], "voltage on"),
        (&["emergency press"], "emergency release"),
        (&["power off"], "power on"),
    ] {
        let machine = machine("dig425");
        let mut host = host(&machine, PowerOn::fresh(&machine), "L Z+100 R0 F2000\nL X+80 F50");
        until(&mut host, "the slow block", |control| {
            control.element().is_some_and(|element| element.block.block == 2)
        });
        seconds(&mut host, 0.5);
        let z = |host: &Host| host.plant().axis('Z').unwrap().position;
        let from = z(&host);
        for what in away {
            give(&mut host, what);
        }
        let mut sunk = 0.0_f64;
        for _ in 0..400 {
            host.step().unwrap();
            sunk = sunk.max((z(&host) - from).abs());
        }
        assert!(sunk < 0.1, "{away:?}: {sunk}");
        give(&mut host, back);
        seconds(&mut host, 0.1);
        assert!((z(&host) - from).abs() < 0.1, "{back}");
    }
}

/// The same when the voltage is off for some milliseconds only: the PLC need not see that, and takes the enable with the
/// loops, which are opened when the shuttle, too, stands.
#[test]
fn no_axis_sinks_after_a_short_emergency_stop() {
    let mut host = shuttle(&[]);
    until(&mut host, "M61", |control| control.waiting().is_some());
    while place(&host) > 400.0 {
        host.step().unwrap();
    }
    let z = |host: &Host| host.plant().axis('Z').unwrap().position;
    let (from, begun) = (z(&host), host.save().unwrap());
    for cycles in 0..7 {
        host.restore(&begun).unwrap();
        for _ in 0..cycles {
            host.step().unwrap();
        }
        give(&mut host, "emergency press");
        seconds(&mut host, 0.021);
        give(&mut host, "emergency release");
        let mut sunk = 0.0_f64;
        for _ in 0..400 {
            host.step().unwrap();
            sunk = sunk.max((z(&host) - from).abs());
        }
        assert!(!host.control().loops_closed() && sunk < 0.1, "{sunk}");
    }
}

/// The door takes the feed enable away while X moves with 50 mm/s: its axes stand, and so does the path, whose speed was
/// said to be what it had been.
#[test]
fn a_path_without_feed_enable_has_no_speed() {
    let mut host = mill("L Z+100 R0 FMAX\nL X-80 F3000\nL X+80");
    let speed = |control: &Control| control.first().observe(&Signal::PathSpeed);
    until(&mut host, "full speed", |control| {
        control.element().is_some_and(|element| element.block.block == 3) && speed(control) > 2999.0
    });
    give(&mut host, "switch door open");
    until(&mut host, "the loss of the enable", |control| {
        control
            .first()
            .watch()
            .any(|axis| axis.axis == Axis::X && axis.halted)
    });
    host.step().unwrap();
    assert_eq!(speed(host.control()), 0.0);
    give(&mut host, "switch door closed");
    seconds(&mut host, 1.0);
    give(&mut host, "key NC_START tap");
    until(&mut host, "the end", |control| control.first().has_ended());
}

/// EMERGENCY STOP while the shuttle of the digital mill passes its marks by order of the PLC (module 9123), which ends the
/// order: it is given anew, and M61 brings its pallet to 50 mm.
#[test]
fn the_shuttle_passes_its_marks_after_an_emergency_stop() {
    let mut host = shuttle(&[]);
    until(&mut host, "the loop of W", Control::loops_closed);
    while place(&host) > 779.0 {
        host.step().unwrap();
    }
    give(&mut host, "emergency press");
    seconds(&mut host, 1.0);
    assert!(place(&host) > 770.0, "no second mark before {}", place(&host));
    give(&mut host, "emergency release");
    seconds(&mut host, 0.5);
    give(&mut host, "ce");
    until(&mut host, "the end", Control::has_ended);
    assert!((place(&host) - 50.0).abs() < 0.05, "{}", place(&host));
}

/// The shuttle is held on its way for a moment: POSITIONING ERROR (MP1720 lies far off here) ends the order, which is no
/// arrival. The order is given anew after CE, and only then M61 is acknowledged.
#[test]
fn a_pallet_that_is_held_on_its_way_has_not_arrived() {
    let mut host = shuttle(&["1720.3=30"]);
    until(&mut host, "M61", |control| control.waiting().is_some());
    while place(&host) > 400.0 {
        host.step().unwrap();
    }
    give(&mut host, "fault clamp W");
    until(&mut host, "POSITIONING ERROR", |control| {
        let mut shown = control.shown().iter();
        shown.any(|shown| shown.fault() == FaultId::Positioning)
    });
    give(&mut host, "repair W");
    seconds(&mut host, 1.0);
    assert!(place(&host) > 300.0 && host.control().waiting().is_some());
    give(&mut host, "ce");
    until(&mut host, "the acknowledgement", |control| {
        control.waiting().is_none()
    });
    assert!((place(&host) - 50.0).abs() < 0.05, "{}", place(&host));
    give(&mut host, "key NC_START tap");
    until(&mut host, "the end", Control::has_ended);
}

/// The digital mill with a program that wants pallet 1.
fn shuttle(assignments: &[&str]) -> Host {
    let mut digital = machine("dig425");
    for assignment in assignments {
        digital.parameters.assign(assignment).unwrap();
    }
    let power_on = PowerOn::fresh(&digital);
    host(&digital, power_on, "L Z+100 R0 FMAX M61\nL X+10 F1000")
}

/// Where the shuttle is, mm.
fn place(host: &Host) -> f64 {
    host.plant().axis('W').unwrap().position
}

/// An EMERGENCY STOP that is over as soon as the control has opened its loops, while the spindle starts up for M13: no scan
/// need see it at I3. The PLC program sees that the control holds no axis, takes its order back, and gives it anew. Its M13
/// is acknowledged, and the run goes on.
#[test]
fn a_short_emergency_stop_does_not_leave_the_spindle_standing() {
    let (_copy, old_mill) = old_mill();
    let shipped = ["mill", "mill-tnc360", "dig425"].map(|name| (name, machine(name)));
    for (name, machine) in shipped.into_iter().chain([("plc355", old_mill)]) {
        let blocks = "TOOL CALL 1 Z S3000\nL Z+100 R0 FMAX\nL X+10 FMAX M13\nL X+20 F1000";
        let mut host = host(&machine, PowerOn::fresh(&machine), blocks);
        until(&mut host, "M13", |control| {
            let third = control.element().is_some_and(|element| element.block.block == 3);
            third && control.waiting().is_some()
        });
        seconds(&mut host, 0.1);
        let begun = host.save().unwrap();
        // Scans are 20 ms apart, contour cycles 3 or 6 ms; relays take 10 ms to pull in.
        for (cycles, more) in (0..7).flat_map(|cycles| [(cycles, 0), (cycles, 1)]) {
            host.restore(&begun).unwrap();
            for _ in 0..cycles {
                host.step().unwrap();
            }
            give(&mut host, "emergency press");
            until(&mut host, "the open loops", |control| !control.loops_closed());
            for _ in 0..more {
                host.step().unwrap();
            }
            give(&mut host, "emergency release");
            seconds(&mut host, 1.0);
            assert_eq!(host.control().run_state(), RunState::Interrupted, "{name}");
            give(&mut host, "ce");
            seconds(&mut host, 0.3);
            give(&mut host, "key NC_START tap");
            until(&mut host, name, Control::has_ended);
        }
    }
}

/// NC start, or a direction key that is held, in the same cycle in which CE closes the loops: the drives of the digital mill
/// have no power yet, and the axis would be GROSS POSITIONING ERROR 3F. Its PLC program waits with the feed enable.
#[test]
fn what_is_held_when_the_loops_close_waits_for_the_drives() {
    let digital = machine("dig425");
    let mut host = host(&digital, PowerOn::fresh(&digital), "L Z+100 R0 FMAX");
    until(&mut host, "the loops", Control::loops_closed);
    give(&mut host, "voltage off");
    seconds(&mut host, 0.5);
    give(&mut host, "voltage on");
    seconds(&mut host, 0.3);
    let begun = host.save().unwrap();
    let keys = ["NC_START", "X-", "X+", "Y-", "Y+", "Z-", "Z+"];
    for (cycles, key) in (0..16).flat_map(|cycles| keys.map(|key| (cycles, key))) {
        host.restore(&begun).unwrap();
        let was: Vec<f64> = host
            .control()
            .first()
            .watch()
            .map(|axis| axis.commanded)
            .collect();
        give(&mut host, &format!("key {key} press"));
        for _ in 0..cycles {
            host.step().unwrap();
        }
        give(&mut host, "ce");
        seconds(&mut host, 0.5);
        let shown = host.control().shown();
        assert!(shown.iter().all(|shown| !shown.flashing), "{key}: {shown:?}");
        let now = host.control().first().watch().map(|axis| axis.commanded);
        assert!(now.ne(was), "{key} moves an axis");
        give(&mut host, &format!("key {key} release"));
        until(&mut host, "the end", |control| {
            key != "NC_START" || control.has_ended()
        });
    }
}

/// The control voltage goes, or the program is stopped, while a tool change by hand begins; MANUAL OPERATION, with a stop X
/// away by hand, and RESTORE POSITION. The new tool is 5 mm shorter: Z stays where it is, at 50 + 60 of the old one, and the
/// block after brings it to 50 + 55.
#[test]
fn the_way_back_to_a_tool_change_leaves_the_tool_axis() {
    let digital = machine("dig425");
    let blocks = "TOOL CALL 1 Z S1600\nL Z+50 R0 FMAX\nL X-25 Y-25 FMAX\nTOOL CALL 2 Z S3000\nL Z+50 R0 FMAX\nL X+50 Y+35 FMAX";
    let z = |host: &Host| {
        let mut axes = host.control().first().watch();
        axes.find(|axis| axis.axis == Axis::Z).unwrap().commanded
    };
    let in_block = |block| {
        move |control: &Control| {
            control
                .element()
                .is_some_and(|element| element.block.block == block)
        }
    };
    let mut host = host(&digital, PowerOn::fresh(&digital), blocks);
    until(&mut host, "the third block", in_block(3));
    until(&mut host, "the second tool change", |control| {
        commanded(control, Axis::Y) == -25.0
    });
    let begun = host.save().unwrap();
    let before = z(&host);
    let stops = [("voltage off", "voltage on"), ("key NC_STOP tap", "key X+ press")];
    for (cycles, (stop, on)) in (0..7).flat_map(|cycles| stops.map(|stop| (cycles, stop))) {
        host.restore(&begun).unwrap();
        for _ in 0..cycles {
            host.step().unwrap();
        }
        give(&mut host, stop);
        seconds(&mut host, 0.5);
        give(&mut host, "manual-operation");
        give(&mut host, on);
        seconds(&mut host, 0.5);
        give(&mut host, "key X+ release");
        give(&mut host, "ce");
        seconds(&mut host, 0.5);
        give(&mut host, "restore-position");
        seconds(&mut host, 0.3);
        give(&mut host, "key NC_START tap");
        let end_us = host.control().time_us() + 4_000_000;
        while host.control().time_us() < end_us {
            host.step().unwrap();
            assert!((z(&host) - before).abs() < 0.001, "{cycles} {stop}: {}", z(&host));
        }
        assert_eq!(commanded(host.control(), Axis::X), -25.0, "{cycles} {stop}");
        give(&mut host, "key NC_START tap");
        until(&mut host, "the block after", in_block(6));
        assert_eq!(z(&host), before - 5.0, "{cycles} {stop}");
        until(&mut host, "the end", Control::has_ended);
    }
}

/// M0 has stopped the program, the control voltage goes, and X is pushed away. NC start leads it back before the program goes
/// on: its next block counts from where it was.
#[test]
fn a_programmed_stop_goes_on_from_where_it_was() {
    let mut host = mill("L X+10 Y+20 Z+100 R0 FMAX\nL X+20 F1000 M0\nL IX+30\nL IX-5");
    until(&mut host, "the stop", |control| {
        control.run_state() == RunState::Stopped
    });
    pushed_away(&mut host);
    give(&mut host, "key NC_START tap");
    until(&mut host, "the block after", |control| {
        control.element().is_some_and(|element| element.block.block == 3) && !control.first().restores()
    });
    let from = commanded(host.control(), Axis::X);
    assert!((20.0..20.2).contains(&from), "{from}");
    until(&mut host, "the end", Control::has_ended);
    assert_eq!(commanded(host.control(), Axis::X), 45.0);
}

/// The control voltage goes while X is on its way back to the contour. After CE it stands until NC start.
#[test]
fn what_was_stopped_on_its_way_back_waits_for_nc_start() {
    for (stop, on) in [("voltage off", "voltage on"), ("key NC_STOP tap", "ce")] {
        let mut host = mill("L X+10 Y+20 Z+100 R0 FMAX\nL X+20 F1000 M0\nL IX+30");
        until(&mut host, "the stop", |control| {
            control.run_state() == RunState::Stopped
        });
        pushed_away(&mut host);
        give(&mut host, "key NC_START tap");
        until(&mut host, "the way back", |control| {
            commanded(control, Axis::X) < 22.0
        });
        give(&mut host, stop);
        seconds(&mut host, 0.5);
        give(&mut host, on);
        seconds(&mut host, 0.5);
        give(&mut host, "ce");
        seconds(&mut host, 0.3);
        let stands = commanded(host.control(), Axis::X);
        assert!(stands > 20.5, "{stop}: {stands}");
        seconds(&mut host, 1.0);
        assert_eq!(commanded(host.control(), Axis::X), stands, "{stop}");
        give(&mut host, "key NC_START tap");
        seconds(&mut host, 1.0);
        assert_eq!(commanded(host.control(), Axis::X), 20.0, "{stop}");
        give(&mut host, "key NC_START tap");
        until(&mut host, "the end", Control::has_ended);
        assert_eq!(commanded(host.control(), Axis::X), 50.0, "{stop}");
    }
}

/// The control voltage goes while a program stands, and X is pushed by more than a millimetre meanwhile.
fn pushed_away(host: &mut Host) {
    give(host, "voltage off");
    seconds(host, 0.5);
    give(host, "force X 4000");
    let at = |host: &Host| host.plant().axis('X').unwrap().position;
    let before = at(host);
    while (at(host) - before).abs() < 1.0 {
        host.step().unwrap();
    }
    give(host, "force X 0");
    give(host, "voltage on");
    seconds(host, 0.5);
    give(host, "ce");
    seconds(host, 0.5);
    let away = (commanded(host.control(), Axis::X) - 20.0).abs();
    assert!(away > 1.0, "{away}");
}

/// The table is pushed when its clamp is released and its loop is still open: in a program that runs its place is lost, which
/// is told like any deviation of that size [000:5289-5293], before a hole is drilled beside its place.
#[test]
fn a_table_that_is_pushed_between_clamp_and_loop_is_reported() {
    let blocks =
        "L C+45 F2000 M11\nL Z+100 R0 FMAX M10\nL Z+60 F3000\nL Z+80 FMAX M11\nL Z+40 F300\nL IC+45 F2000";
    let mut host = mill(blocks);
    let c = |control: &Control| {
        let mut axes = control.first().watch();
        axes.find(|axis| axis.axis == Axis::C).unwrap()
    };
    until(&mut host, "the place above", |control| {
        commanded(control, Axis::Z) > 95.0
    });
    until(&mut host, "the clamp", |control| {
        commanded(control, Axis::Z) < 70.0 && !c(control).closed
    });
    let clamped = |host: &Host| host.control().exchange().plc().bit("I14".parse().unwrap());
    while clamped(&host) {
        host.step().unwrap();
    }
    give(&mut host, "force C 300");
    while (c(host.control()).actual - 45.0).abs() < 0.5 && !c(host.control()).closed {
        host.step().unwrap();
    }
    give(&mut host, "force C 0");
    assert!(!c(host.control()).closed, "{:?}", c(host.control()));
    until(&mut host, "the message", |control| {
        let mut shown = control.shown().iter().map(|shown| control.shown_text(shown));
        shown.any(|text| text.starts_with("GROSS POSITIONING ERROR C"))
    });
    // Z has not gone down below where it was.
    assert!(commanded(host.control(), Axis::Z) > 59.99);
}
