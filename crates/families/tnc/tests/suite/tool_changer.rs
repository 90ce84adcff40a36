//! The magazine of the mill with its double arm: what the control hands to the PLC, and where the tools are then.

use crate::support::*;
use bahn_tnc::Tool;

/// N are tools 1 and 2, M 3 and 5, S 4 and 6; the number of the pocket is that of the tool.
fn mill(output: u8, kind: u8) -> Rig {
    mill_with(output, 0, kind)
}

fn mill_with(output: u8, next: u8, kind: u8) -> Rig {
    let tool = |number: u16| Tool {
        pocket: (!matches!(number, 3 | 5)).then_some(number),
        special: matches!(number, 4 | 6),
        ..Tool::default()
    };
    let mut build = Build::mill()
        .mp("7261=12")
        .mp(&format!("7480.0={output}"))
        .mp(&format!("7480.1={next}"))
        .mp(&format!("4310.0={kind}"));
    build.tools = Some((1..=6).map(|number| (u32::from(number), tool(number))).collect());
    for old in 1..=6 {
        for new in 1..=6 {
            build = build.program(
                &format!("{old}{new}.H"),
                &format!("TOOL CALL {old} Z S0\nTOOL CALL {new} Z S0"),
            );
        }
    }
    build = build
        .program("0.H", "TOOL CALL 0 Z S0")
        .program("D.H", "TOOL DEF 6\nL X+200 R0 FMAX");
    let mut rig = build.rig();
    rig.machine
        .load_magazine([1, 2, 4, 6].into_iter().map(|number| (number, number.into())), 0);
    rig.power_on();
    rig
}

/// MP4310.0: changes by hand confirm themselves, the magazine is in use.
const MAGAZINE: u8 = 0b0011;
/// With fixed pockets.
const FIXED: u8 = 0b0111;
/// The old tool first: M2600 = 0.
const OLD_FIRST: u8 = 0b1011;

/// A strobe of TOOL CALL: W262, W264, M2093.
type Code = (i32, i32, bool);

/// Runs a program; the strobes.
fn strobes(rig: &mut Rig, name: &str) -> Vec<Code> {
    rig.command("mode full");
    rig.command(&format!("select {name}"));
    rig.start();
    let (mut codes, mut before) = (Vec::new(), false);
    let end = rig.control.time_us() + 120_000_000;
    rig.seconds(0.3);
    while !rig.control.snapshot().ended {
        assert!(
            rig.control.time_us() < end,
            "{name}: {codes:?} {:?} step {}",
            rig.messages(),
            rig.number("W112")
        );
        let strobe = rig.bit("M2046");
        if strobe && !before {
            codes.push((rig.number("W262"), rig.number("W264"), rig.bit("M2093")));
        }
        before = strobe;
        rig.cycle();
    }
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0]);
    codes
}

/// The tool in each pocket from 1 to 6 and in the spindle.
fn places(rig: &Rig) -> ([u32; 6], u32) {
    let state = rig
        .machine
        .magazine()
        .unwrap_or_else(|| unreachable!("the mill has a magazine"));
    assert_eq!(
        (state.shuttle, state.arm),
        (0, [0, 0]),
        "nothing is left on the way"
    );
    (std::array::from_fn(|place| state.pockets[place]), state.spindle)
}

/// All nine transitions with both orders of codes, on the machine: number and order of strobes, W262, W264, M2093
/// [000:9287-9410], and where the tools are in the end.
#[test]
fn nine_transitions_on_the_mill() {
    let nine: [(u32, u32, &[Code]); 9] = [
        (1, 2, &[(2, 2, false)]),
        (3, 5, &[(255, 5, false)]),
        (4, 6, &[(6, 6, false)]),
        (4, 1, &[(4, 0, true), (1, 1, false)]),
        (1, 4, &[(1, 0, true), (4, 4, false)]),
        (3, 1, &[(255, 0, true), (1, 1, false)]),
        (3, 4, &[(255, 0, true), (4, 4, false)]),
        (1, 3, &[(1, 0, true), (255, 3, false)]),
        (4, 3, &[(4, 0, true), (255, 3, false)]),
    ];
    for kind in [OLD_FIRST, MAGAZINE] {
        for (old, new, expected) in nine {
            let mut rig = mill(3, kind);
            let codes = strobes(&mut rig, &format!("{old}{new}.H"));
            let (first, codes) = codes
                .split_first()
                .unwrap_or_else(|| unreachable!("the old tool is called"));
            let pocket = |tool: u32| if matches!(tool, 3 | 5) { 255 } else { tool as i32 };
            assert_eq!(*first, (pocket(old), old as i32, false));
            let swapped: Vec<Code> = match expected {
                // The new tool first, unless one is changed by hand.
                [(p, t, _), (q, u, _)] if kind == MAGAZINE && *p != 255 && *q != 255 => {
                    vec![(*q, *u, true), (*p, *t, false)]
                }
                _ => expected.to_vec(),
            };
            assert_eq!(codes, swapped, "{old} -> {new}, {kind:b}");
            assert_eq!(rig.number("W100"), new as i32);
            // Under variable coding the old tool of a single code takes the pocket of the new one.
            let mut pockets = [1, 2, 0, 4, 0, 6];
            let of = |tool: u32| tool as usize - 1;
            let by_hand = |tool: u32| matches!(tool, 3 | 5);
            if !by_hand(new) {
                pockets[of(new)] = if expected.len() == 1 { old } else { 0 };
            }
            if expected.len() == 1 && !by_hand(old) {
                pockets[of(old)] = 0;
            }
            let (found, spindle) = places(&rig);
            assert_eq!(found, pockets, "{old} -> {new}, {kind:b}");
            if !by_hand(new) {
                assert_eq!(spindle, new);
            }
            // The pocket table agrees with the machine.
            for moved in rig.control.remember().pockets {
                if moved.tool != new {
                    let place = usize::from(moved.pocket.unwrap_or_default()) - 1;
                    assert_eq!(found[place], moved.tool);
                }
            }
        }
    }
}

/// MP7480.0 = 5: every tool returns to its own pocket, the pocket table stays; M2601 does the same for special tools.
#[test]
fn fixed_pockets_on_the_mill() {
    let mut rig = mill(5, FIXED);
    assert_eq!(strobes(&mut rig, "12.H"), [(1, 1, false), (2, 2, false)]);
    assert_eq!(places(&rig), ([1, 0, 0, 4, 0, 6], 2));
    assert_eq!(
        strobes(&mut rig, "21.H"),
        [(1, 1, false)],
        "tool 2 is in the spindle"
    );
    assert_eq!(places(&rig), ([0, 2, 0, 4, 0, 6], 1));
    assert_eq!(rig.control.remember().pockets, []);
    // T 0 empties the spindle.
    assert_eq!(strobes(&mut rig, "0.H"), [(1, 0, false)]);
    assert_eq!(places(&rig), ([1, 2, 0, 4, 0, 6], 0));
}

/// TOOL DEF turns the chain to the next tool by the shortest way: from pocket 1 to 6 forward, five pockets of 0.4 s.
#[test]
fn the_next_tool_is_looked_for() {
    let mut rig = mill_with(3, 3, MAGAZINE);
    assert_eq!(rig.machine.magazine().map(|state| state.pocket), Some(1));
    rig.command("mode full");
    rig.command("select D.H");
    rig.start();
    rig.until(1.0, "the chain turns", |rig| rig.bit("O32"));
    let begin = rig.control.time_us();
    rig.until(5.0, "it stands", |rig| !rig.bit("O32"));
    let seconds = (rig.control.time_us() - begin) as f64 / 1e6;
    assert!((4.8 * 0.4..5.0 * 0.4).contains(&seconds), "{seconds}");
    rig.until(5.0, "the program ends", |rig| rig.control.snapshot().ended);
    assert_eq!(rig.machine.magazine().map(|state| state.pocket), Some(6));
}

/// An arm that is stuck half way holds the program, with a message of the machine; repaired, the change goes on.
#[test]
fn an_arm_that_is_stuck() {
    let mut rig = mill(3, MAGAZINE);
    rig.command("mode full");
    rig.command("select 12.H");
    rig.start();
    rig.until(20.0, "the arm is on its way out", |rig| rig.bit("O36"));
    rig.seconds(0.1);
    rig.event("fault device arm_draw jammed");
    rig.until(15.0, "the PLC says so", |rig| rig.bit("M2934"));
    assert!(!rig.control.snapshot().ended && rig.bit("M2046"));
    rig.event("repair arm_draw");
    rig.until(60.0, "the program ends", |rig| rig.control.snapshot().ended);
    assert_eq!(places(&rig), ([0, 1, 0, 4, 0, 6], 2));
}

/// The supply goes in each step of the change (W112), and at any place in it. For the control the change did not happen until it
/// has taken the acknowledgement: after power-on shuttle and arm bring the tools back to where it has them, and then another
/// tool is called: it is in the spindle, and all others are where the control has them, in any pocket or fixed ones.
#[test]
fn a_change_that_power_off_breaks_off() {
    for (mp, kind, depths) in [(3, MAGAZINE, [0.0, 0.15].as_slice()), (5, FIXED, &[0.1])] {
        let mut begun = mill(mp, kind);
        begun.run("11.H", 60.0);
        begun.command("select 12.H");
        begun.start();
        for step in (10..=130).step_by(10) {
            begun.until(60.0, &format!("step {step}"), |rig| rig.number("W112") == step);
            // In the cycle after the scan that gives it the control has taken the acknowledgement.
            let taken = begun.control.tool();
            assert_eq!(taken == 2, step == 130, "step {step}");
            for depth_s in depths {
                let mut rig = begun.clone();
                rig.seconds(*depth_s);
                let at = format!("MP7480.0 = {mp}, step {step} and {depth_s} s");
                switch_off_and_on(&mut rig, &at);
                rig.power_on();
                // Of the normal tools the other one, then a special one: two codes.
                let next = if rig.control.tool() == 1 { "26.H" } else { "16.H" };
                change_to_6(&mut rig, next, &at);
            }
        }
    }
}

/// The arm is stuck when it is to draw, and repaired while the supply is off: its valve stands at out, but the clamp has closed,
/// and holds the arm until the PLC opens it again. The change is taken back.
#[test]
fn a_closed_clamp_holds_the_arm_until_it_opens() {
    let mut rig = mill(3, MAGAZINE);
    rig.run("11.H", 60.0);
    rig.command("select 12.H");
    rig.start();
    rig.until(60.0, "the clamp opens", |rig| rig.number("W112") == 40);
    rig.event("fault device arm_draw jammed");
    rig.until(60.0, "the arm is to draw", |rig| rig.bit("O36"));
    rig.seconds(0.5);
    rig.command("power off");
    rig.seconds(1.0);
    rig.event("repair arm_draw");
    rig.seconds(1.0);
    assert_eq!(
        rig.machine.magazine().map(|state| (state.spindle, state.arm)),
        Some((1, [0, 0]))
    );
    rig.command("power on");
    rig.command("ce");
    rig.until(60.0, "the way back", |rig| {
        rig.number("W112") == 0 && rig.control.mode() == bahn_tnc::Mode::Reference
    });
    agree(&rig, "taken back");
    rig.power_on();
    change_to_6(&mut rig, "26.H", "the next change");
}

/// A change with two codes, a special tool against a normal one. For the control the old tool is in the spindle until the
/// second code is acknowledged. The supply goes whenever step or strobe change, some time after that, and in each cycle
/// between the codes: after power-on all tools are where the control has them.
#[test]
fn two_codes_that_power_off_breaks_off() {
    for kind in [MAGAZINE, OLD_FIRST] {
        let mut begun = mill(3, kind);
        begun.run("44.H", 60.0);
        begun.seconds(0.2);
        begun.command("select 41.H");
        begun.start();
        begun.until(10.0, "the first code", |rig| rig.bit("M2046"));
        let (mut before, mut between) = ([0; 3], 0);
        while !begun.control.snapshot().ended {
            let now = [
                begun.number("W112"),
                i32::from(begun.bit("M2046")),
                i32::from(begun.bit("M2093")),
            ];
            let passes = matches!(now[0], 130 | 140);
            between += usize::from(passes);
            for depth_s in [0.0, 0.15] {
                if now == before && !(passes && depth_s == 0.0) {
                    continue;
                }
                let mut rig = begun.clone();
                rig.seconds(depth_s);
                let at = format!("{kind:b}, W112 M2046 M2093 {now:?} and {depth_s} s");
                switch_off_and_on(&mut rig, &at);
                if now != before && depth_s == 0.0 {
                    rig.power_on();
                    let next = if rig.control.tool() == 4 { "26.H" } else { "16.H" };
                    change_to_6(&mut rig, next, &at);
                }
            }
            before = now;
            begun.cycle();
        }
        assert!(between > 10, "{between}");
        assert_eq!(begun.control.tool(), 1);
        agree(&begun, "undisturbed");
    }
}

/// The same without power-off: NC stop and internal stop about the change of the codes, in each cycle there. M2093 falls with
/// what is broken off, and the first code is taken back before anything can be started.
#[test]
fn two_codes_that_a_stop_breaks_off() {
    for kind in [MAGAZINE, OLD_FIRST] {
        let mut begun = mill(3, kind);
        begun.run("44.H", 60.0);
        begun.seconds(0.2);
        begun.command("select 41.H");
        begun.start();
        begun.until(60.0, "the first code is done", |rig| rig.number("W112") == 120);
        let (mut tried, mut at_once) = (0, 0);
        while !begun.bit("M2046") || begun.bit("M2093") {
            let mut rig = begun.clone();
            let at = format!("{kind:b}, {tried} cycles after");
            rig.event("key NC_STOP tap");
            rig.until(1.0, "the interruption", |rig| {
                rig.control.run_state() == bahn_tnc::RunState::Interrupted
            });
            at_once += usize::from(matches!(rig.number("W112"), 130 | 140));
            rig.command("stop");
            rig.seconds(0.1);
            rig.until(60.0, &format!("{at}: the way back"), |rig| {
                rig.number("W112") == 0
            });
            assert_eq!(rig.control.tool(), 4, "{at}");
            agree(&rig, &at);
            change_to_6(&mut rig, "26.H", &at);
            tried += 1;
            begun.cycle();
        }
        assert!(tried > 10 && at_once > 3, "{tried} {at_once}");
    }
}

/// Tool 3 has no pocket: the arm takes tool 1 away, and the second code is done by hand. Broken off between the codes the first
/// one is taken back; in the second one no arm moves: the PLC tells the control that the spindle is empty (M2717), and the next
/// TOOL CALL of any tool is a change.
#[test]
fn a_second_code_by_hand_that_is_broken_off() {
    let mut begun = mill(3, MAGAZINE);
    begun.run("11.H", 60.0);
    begun.seconds(0.2);
    begun.command("select 13.H");
    begun.start();
    begun.until(60.0, "the first code is done", |rig| rig.number("W112") == 120);
    let mut found = std::collections::BTreeMap::from([(0, 0), (1, 0), (3, 0)]);
    while !begun.control.snapshot().ended {
        let by_hand = begun.bit("M2046") && !begun.bit("M2093");
        let mut rig = begun.clone();
        rig.command("power off");
        rig.seconds(0.2);
        rig.command("power on");
        rig.command("ce");
        rig.until(60.0, "the way back", |rig| {
            rig.number("W112") == 0 && rig.control.mode() == bahn_tnc::Mode::Reference
        });
        rig.seconds(0.1);
        rig.power_on();
        let tool = rig.control.tool();
        let at = format!("by hand {by_hand}: tool {tool}");
        match tool {
            0 | 1 => agree(&rig, &at),
            other => assert!(other == 3 && by_hand, "{at}"),
        }
        let times = found.get_mut(&tool).unwrap();
        *times += 1;
        if *times % 8 == 1 {
            change_to_6(&mut rig, "16.H", &at);
        }
        (0..3).for_each(|_| begun.cycle());
    }
    assert!(found.values().all(|times| *times > 0), "{found:?}");
}

/// Off and on: shuttle and arm bring the tools to where the control has them, which remembers the one in the spindle.
fn switch_off_and_on(rig: &mut Rig, at: &str) {
    let remembered = rig.control.tool();
    rig.command("power off");
    rig.seconds(0.2);
    rig.command("power on");
    rig.command("ce");
    // Arm and shuttle wait for the control voltage; no axis moves before they are back.
    rig.until(60.0, &format!("{at}: the way back"), |rig| {
        rig.number("W112") == 0 && rig.control.mode() == bahn_tnc::Mode::Reference
    });
    rig.seconds(0.1);
    assert_eq!(rig.control.tool(), remembered, "{at}");
    agree(rig, at);
}

/// The next changes work, and leave every tool where the control has it.
fn change_to_6(rig: &mut Rig, name: &str, at: &str) {
    rig.run(name, 240.0);
    rig.seconds(0.2);
    assert_eq!(rig.messages(), [""; 0], "{at}");
    assert_eq!(rig.control.tool(), 6, "{at}");
    agree(rig, at);
}

/// Every tool is where the control has it: one in the spindle, the others in their pockets of the table as it is now.
fn agree(rig: &Rig, at: &str) {
    let remembered = rig.control.remember();
    let mut pockets = [1, 2, 0, 4, 0, 6];
    for moved in &remembered.pockets {
        pockets
            .iter_mut()
            .filter(|tool| **tool == moved.tool)
            .for_each(|tool| *tool = 0);
    }
    for moved in &remembered.pockets {
        if let Some(pocket) = moved.pocket {
            pockets[usize::from(pocket) - 1] = moved.tool;
        }
    }
    pockets
        .iter_mut()
        .filter(|tool| **tool == remembered.tool)
        .for_each(|tool| *tool = 0);
    assert_eq!(places(rig), (pockets, remembered.tool), "{at}");
}
