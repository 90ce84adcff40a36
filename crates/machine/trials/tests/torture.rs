//! The fault campaign over the shipped machines: a fixed set of seeds, and that it would find something.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

#[path = "../../host/tests/support/mod.rs"]
mod support;

use std::path::Path;

use bahn_trials::torture::{Campaign, Happening, Kind, Plan, Rule};

use support::Copy;

/// The programs and the plant of the days on which seeds were found: another list, or a probe, makes other seeds.
fn as_found(machine: &str) -> Campaign {
    let programs: &[&str] = match machine {
        "mill" => &["BRACKET.H", "CIRCLE.H", "INDEX.H", "SADDLE.H"],
        "mill-tnc360" => &["COVER.H"],
        "dig425" => &["CIRCLE.H", "COVER.H", "PALLETS.H"],
        "gantry" => &["NOSE.H", "ROOF.H"],
        _ => &["LEFT.H"],
    };
    if !["mill-tnc360", "dig425", "twin"].contains(&machine) {
        return of_programs(support::machine(machine), programs);
    }
    let mut loaded = support::machine(machine);
    let text = std::fs::read_to_string(loaded.root.join("plant.toml")).unwrap();
    let (without, _) = text.split_once("\n# The touch probe").unwrap();
    loaded.plant = Some(bahn_machine::Machine::from_toml(without).unwrap());
    of_programs(loaded, programs)
}

fn of_programs(machine: bahn_host::LoadedMachine, programs: &[&str]) -> Campaign {
    let programs: Vec<String> = programs.iter().map(|name| (*name).to_owned()).collect();
    Campaign::new(machine, &programs).unwrap()
}

/// All programs of a machine.
fn campaign(machine: &str) -> Campaign {
    of_programs(support::machine(machine), &[])
}

fn load(folder: &Path) -> Campaign {
    Campaign::load(folder, &[])
        .unwrap()
        .map_err(|faults| faults.len())
        .unwrap()
}

/// A seed that was red holds every rule; it is still the one of this program in which these things happen.
fn holds(campaign: &Campaign, program: &str, seed: u64, happenings: &[&str]) {
    let mut worker = campaign.worker().unwrap();
    let plan = worker.plan(seed);
    let happens = |what: &&str| plan.happenings.iter().any(|happening| happening.what == *what);
    assert!(
        happenings.iter().all(happens) && campaign.programs()[plan.program] == program,
        "seed {seed} is another one now: {plan:?}"
    );
    assert_eq!(worker.run(&plan).violation, None, "seed {seed}");
}

/// Tries seeds of a machine: every rule holds, and every kind of thing happens in them.
fn try_seeds(machine: &str, seeds: std::ops::Range<u64>) {
    try_campaign(machine, &campaign(machine), seeds, 6);
}

/// The same with a campaign; what can happen to a machine is of so many kinds at least.
fn try_campaign(machine: &str, campaign: &Campaign, seeds: std::ops::Range<u64>, least: usize) {
    let mut worker = campaign.worker().unwrap();
    let (mut went_on, mut messages, mut kinds) = (0, 0, std::collections::BTreeSet::new());
    for seed in seeds.clone() {
        let plan = worker.plan(seed);
        let trial = worker.run(&plan);
        if let Some(violation) = &trial.violation {
            let few = worker.shrink(&plan, violation.rule);
            panic!("seed {seed} on {machine}: {violation:?}\n{:#?}", few.happenings);
        }
        went_on += usize::from(trial.went_on);
        messages += trial.messages.len();
        kinds.extend(plan.happenings.iter().map(|happening| happening.kind));
    }
    // Every tenth run at least is stopped and goes on again.
    let count = usize::try_from(seeds.end - seeds.start).unwrap();
    assert!(
        went_on > count / 10 && messages > count / 6,
        "{went_on} {messages}"
    );
    // What the operator moves by hand not every machine has.
    assert!(kinds.len() >= least, "{kinds:?}");
}

#[test]
fn the_mill_keeps_every_rule() {
    try_seeds("mill", 0..800);
}

#[test]
fn the_mill_of_a_tnc_360_keeps_every_rule() {
    try_seeds("mill-tnc360", 0..700);
}

#[test]
fn the_twin_keeps_every_rule() {
    try_seeds("twin", 0..500);
}

#[test]
fn the_knee_mill_keeps_every_rule() {
    try_seeds("mill-tnc155", 0..500);
}

/// What fails in the relay cabinet of a knee mill before the reference run, in it and in the program: end cams and pulse inhibit that
/// are missing or bridged, E8 and E17 that stick; power that goes within the change of a gear.
#[test]
fn faults_of_a_relay_cabinet_break_no_rule() {
    let campaign = campaign("mill-tnc155");
    let mut worker = campaign.worker().unwrap();
    let mut plan = worker.plan(0);
    plan.program = campaign
        .programs()
        .iter()
        .position(|name| name == "BLOCK.H")
        .unwrap();
    plan.moment = 0;
    let mut said = |kind: Kind, what: &str, time_ms: u64| {
        let time_us = 1000 * time_ms;
        plan.end_us = time_us + 30_000_000;
        plan.happenings = vec![Happening {
            time_us,
            kind,
            what: what.to_owned(),
        }];
        let trial = worker.run(&plan);
        assert_eq!(trial.violation, None, "{what} at {time_ms} ms");
        trial.messages
    };
    // Without its end cam an axis passes its mark, with a bridged one it is backed off without end, with a closed pulse inhibit no
    // pulse counts: all end at a limit switch. E8 is looked at by the test of the EMERGENCY STOP circuit [001:927-933].
    for (what, message) in [
        ("fault input I0 0", "EMERGENCY STOP"),
        ("fault input I0 1", "EMERGENCY STOP"),
        ("fault input I2 0", "EMERGENCY STOP"),
        ("fault input I2 1", "EMERGENCY STOP"),
        ("fault input I6 1", "EMERGENCY STOP"),
        ("fault input I8 0", "RELAY EXT-DC VOLTAGE MISSING"),
        ("fault input I8 1", "EMERGENCY STOP DEFECTIVE"),
    ] {
        let shown = said(Kind::Fault, what, 100);
        assert!(shown.iter().any(|shown| shown == message), "{what}: {shown:?}");
        said(Kind::Fault, what, 10_000);
    }
    for level in [0, 1] {
        said(Kind::Fault, &format!("fault input I17 {level}"), 32_000);
    }
    // MP124 and MP125 swing the spindle for more than a second until the teeth meet.
    let strobe_ms = second_gear_ms();
    for later_ms in [0, 30, 100, 200, 400, 700, 1000, 1300] {
        said(Kind::Power, "power off", strobe_ms + later_ms);
    }
}

/// When BLOCK.H changes to the second gear, undisturbed: A8 with the S strobe A20, ms since power-on.
fn second_gear_ms() -> u64 {
    let machine = support::machine("mill-tnc155");
    let text = std::fs::read_to_string(machine.root.join("programs/BLOCK.H")).unwrap();
    let blocks: Vec<&str> = text
        .lines()
        .filter(|line| !line.contains(" PGM BLOCK "))
        .collect();
    let power_on = bahn_host::PowerOn::fresh(&machine);
    let mut host = support::host(&machine, power_on, &blocks.join("\n"));
    let on = |host: &bahn_host::Host, name: &str| host.control().exchange().plc().bit(name.parse().unwrap());
    while !(on(&host, "A8") && on(&host, "A20")) {
        assert!(!host.control().snapshot().ended);
        host.step().unwrap();
    }
    host.control().time_us() / 1000
}

/// The mill whose tools come from the magazine: MP4310.0 bit 1, any pocket.
fn magazine() -> Campaign {
    let mut machine = support::machine("mill");
    for assignment in ["7480.0=3", "4310.0=3"] {
        machine.parameters.assign(assignment).unwrap();
    }
    Campaign::new(machine, &["BRACKET.H".to_owned()]).unwrap()
}

#[test]
fn the_mill_with_its_magazine_keeps_every_rule() {
    try_campaign("mill with its magazine", &magazine(), 0..250, 6);
}

/// Power-off in a tool change, and another mode before the reference run: the PLC holds START until the tool is clamped, and the
/// operator presses it again.
#[test]
fn a_start_that_the_plc_holds_is_pressed_again() {
    holds(&magazine(), "BRACKET.H", 9_650_325, &["power off", "mode single"]);
}

#[test]
fn the_gantry_keeps_every_rule() {
    try_seeds("gantry", 0..250);
}

#[test]
fn the_mill_with_digital_drives_keeps_every_rule() {
    try_seeds("dig425", 0..350);
}

/// PALLET.H orders a job of the positioning module and waits until it is done: without the module nobody acknowledges M66. A
/// campaign over the folder tries the others and says so; one that names it does not begin.
#[test]
fn a_program_that_waits_for_a_module_is_left_out() {
    let copy = Copy::of("mill", "torture-module");
    for entry in std::fs::read_dir(copy.path().join("programs")).unwrap() {
        let path = entry.unwrap().path();
        if !(path.ends_with("PALLET.H") || path.ends_with("CIRCLE.H")) {
            let _ = std::fs::remove_file(&path).or_else(|_| std::fs::remove_dir_all(&path));
        }
    }
    let campaign = load(copy.path());
    let mut worker = campaign.worker().unwrap();
    let [left] = campaign.left_out() else {
        panic!("{:?}", campaign.left_out());
    };
    assert_eq!(left.program, "PALLET.H");
    assert!(left.why.starts_with("waits for strobe M2045"), "{}", left.why);
    for seed in 0..8 {
        let plan = worker.plan(seed);
        assert_eq!(campaign.programs()[plan.program], "CIRCLE.H");
        assert_eq!(worker.run(&plan).violation, None, "seed {seed}");
    }
    let named = of_programs(support::machine("mill"), &["PALLET.H"]);
    let error = named.worker().err().unwrap().to_string();
    assert!(error.contains("PALLET.H") && error.contains("M2045"), "{error}");
}

/// A PLC program that hangs in a loop (M198: time out, error 53 [000:11249]) or calls itself (M199: nesting too deep, error
/// 50): both stop PLC and machine with a flashing message. Power-off resets the markers; after it the messages can be
/// cleared, the reference run ends, and the program, begun anew, moves the axes.
#[test]
fn a_plc_program_that_fails_breaks_no_rule() {
    const OF_EACH: usize = 4;
    let copy = Copy::of("mill-tnc360", "torture-plc");
    let program = copy.path().join("plc/MAIN.PLC");
    let text = std::fs::read_to_string(&program).unwrap();
    let begin = "       L     M198\n       CMT   HANGS\n       L     M199\n       CMT   DEEPER\n";
    let end = "LBL HANGS\n       JP    HANGS\nLBL DEEPER\n       CM    DEEPER\n       EM\n";
    std::fs::write(&program, format!("{begin}{text}\n{end}")).unwrap();
    let mut campaign = load(copy.path());
    assert!(campaign.also("M198").is_err(), "no event");
    campaign.also("M198=1").unwrap();
    campaign.also("M199=1").unwrap();
    let mut worker = campaign.worker().unwrap();
    for (event, text) in [
        ("M198=1", "ERROR IN PLC-PROGRAM 53"),
        ("M199=1", "ERROR IN PLC-PROGRAM 50"),
    ] {
        // Only trials in which nothing else fails: what the PLC does is all that may stop them.
        let alone = |plan: &Plan| {
            let happenings = || plan.happenings.iter();
            happenings().any(|happening| happening.what == event)
                && happenings().all(|happening| happening.what == event || happening.kind == Kind::Use)
        };
        let plans: Vec<Plan> = (0..)
            .map(|seed| worker.plan(seed))
            .filter(alone)
            .take(OF_EACH)
            .collect();
        for plan in plans {
            let seed = plan.seed;
            let trial = worker.run(&plan);
            assert_eq!(trial.violation, None, "{event}, seed {seed}");
            let said = |what: &str| trial.messages.iter().any(|message| message == what);
            assert!(said(text), "{event}, seed {seed}: {:?}", trial.messages);
            assert!(
                said("POWER INTERRUPTED"),
                "{event}, seed {seed}: {:?}",
                trial.messages
            );
            assert!(trial.went_on, "{event}, seed {seed}: {:?}", trial.messages);
        }
    }
}

/// Seeds that broke rules once: Z of the digital mill sank between torque and brake and was 3F, the slave of the gantry lost
/// its drive while the spindle was on its ramp (its PLC program asked M2004 for the 5th axis, which is M2016), the path of
/// `twin` began from where its table had been before the other channel had it. EMERGENCY STOP while the pallet shuttle passed its
/// marks, or while a spindle started up, too short for a scan; a start before the drives had power; the door while a head swivels;
/// programs that do not meet; an operator who chose his mode while the marks were to be passed; a tool change that waits, whose
/// new length RESTORE POSITION took for a way; a table that is pushed between its clamp and its loop.
#[test]
fn what_was_found_stays_mended() {
    for (machine, seed, what) in [
        ("dig425", 54_043, "power off"),
        ("dig425", 54_771, "voltage off"),
        ("gantry", 50_468, "override spindle 60"),
        ("twin", 50_163, "voltage off"),
        ("dig425", 510_706, "emergency press"),
        ("dig425", 613_165, "mode single"),
        ("dig425", 641_666, "voltage off"),
        ("dig425", 646_728, "emergency press"),
        ("dig425", 653_417, "emergency press"),
        ("dig425", 658_234, "voltage off"),
        ("dig425", 722_266, "voltage off"),
        ("gantry", 603_496, "switch door open"),
        ("mill", 1_000_171, "force C 4000"),
        ("mill-tnc360", 655_214, "fault input I3 bouncing"),
        ("twin", 651_458, "M2482=1"),
        ("twin", 2_016_504, "key Z+ press"),
    ] {
        let campaign = as_found(machine);
        let mut worker = campaign.worker().unwrap();
        let plan = worker.plan(seed);
        let happens = plan.happenings.iter().any(|happening| happening.what == what);
        assert!(happens, "seed {seed} on {machine} is another one now: {plan:?}");
        assert_eq!(worker.run(&plan).violation, None, "seed {seed} on {machine}");
    }
}

/// Another mode is chosen before the reference run: no program starts unreferenced, whose Z ran onto its limit switch or to the
/// end of its travel.
#[test]
fn no_program_runs_without_its_reference_marks() {
    let campaign = as_found("dig425");
    let mut worker = campaign.worker().unwrap();
    for seed in [100_389, 100_396, 100_858] {
        let plan = worker.plan(seed);
        assert_eq!(worker.run(&plan).violation, None, "seed {seed}: {plan:#?}");
    }
}

/// What is left of a seed without its events holds every rule, in threads and while a probe leads the axes, too, from every
/// moment of these programs.
#[test]
fn a_seed_without_events_keeps_every_rule() {
    for (machine, program) in [
        ("mill", "FLANGE.H"),
        ("mill", "KNOB.H"),
        ("mill", "DATUM.H"),
        ("mill", "MEASURE.H"),
        ("mill-tnc360", "PLATE.H"),
        ("gantry", "THREADS.H"),
        ("dig425", "MODEL.H"),
    ] {
        let campaign = of_programs(support::machine(machine), &[program]);
        let mut worker = campaign.worker().unwrap();
        for seed in 0..60 {
            let plan = Plan {
                happenings: Vec::new(),
                ..worker.plan(seed)
            };
            assert_eq!(worker.run(&plan).violation, None, "{program}, seed {seed}");
        }
    }
}

/// The operator turns the handwheel where a program lets him lead an axis beside its path (M118), and nowhere else: neither path nor
/// wheel accelerates more than alone, and no limit is passed.
#[test]
fn the_handwheel_turns_under_m118() {
    let turns = |plan: &Plan| {
        let mut happenings = plan.happenings.iter();
        happenings.any(|happening| happening.what.starts_with("handwheel"))
    };
    let campaign = of_programs(support::machine("mill"), &["CIRCLE.H", "KNOB.H"]);
    let mut worker = campaign.worker().unwrap();
    let knob = campaign.programs().iter().position(|name| name == "KNOB.H");
    let plans: Vec<Plan> = (0..500).map(|seed| worker.plan(seed)).filter(turns).collect();
    assert!(plans.iter().all(|plan| Some(plan.program) == knob));
    assert!(plans.len() > 50, "{}", plans.len());
    for plan in plans {
        let violation = worker.run(&plan).violation;
        assert_eq!(violation, None, "seed {}: {plan:#?}", plan.seed);
    }
}

/// The operator of the campaign and its rules: START that came under a message is pressed again before the reference marks; an
/// encoder whose fault another one replaces within a millisecond need not be seen by the monitoring of the first.
#[test]
fn the_operator_starts_again_and_a_replaced_fault_need_not_be_seen() {
    holds(
        &campaign("mill-tnc360"),
        "PLATE.H",
        11_106_380,
        &["fault drive X reversed", "mode full"],
    );
    holds(
        &campaign("dig425"),
        "PALLETS.H",
        11_800_246,
        &["fault encoder X edges", "fault encoder X no-marks"],
    );
}

/// Axes that were led by a spindle or a handwheel when their drives were taken away go on with no jump: from a thread whose end was
/// reached in nominal values alone, from beside a thread in a tilted plane, from a handwheel that was still being followed.
#[test]
fn what_was_led_goes_on_without_a_jump() {
    for (machine, program, seed, what) in [
        ("mill", "FLANGE.H", 3_008_073, "voltage off"),
        ("mill", "KNOB.H", 3_006_369, "switch door open"),
        ("gantry", "THREADS.H", 3_000_060, "fault brake Z"),
        ("gantry", "THREADS.H", 3_007_544, "fault drive Z runaway"),
    ] {
        let campaign = campaign(machine);
        let mut worker = campaign.worker().unwrap();
        let plan = worker.plan(seed);
        let happens = plan.happenings.iter().any(|happening| happening.what == what);
        assert!(
            happens && campaign.programs()[plan.program] == program,
            "seed {seed} is another one now: {plan:?}"
        );
        let violation = worker.run(&plan).violation;
        let jumps = |rule| matches!(rule, Rule::Speed | Rule::Acceleration | Rule::Travel);
        assert!(
            !violation.as_ref().is_some_and(|violation| jumps(violation.rule)),
            "seed {seed}: {violation:?}"
        );
    }
}

/// What a thread and a probe were led to after faults: a drive of Z that ran away beyond the end of a thread, a feed enable that bounces, a
/// spindle that runs away, turns the wrong way round, has no power for a moment, or whose encoder is stuck or loses its signal; axes that go back to a thread
/// after POSITIONING ERROR and EMERGENCY STOP; a stylus that says that it is deflected, and MANUAL OPERATION while it scans.
#[test]
fn threads_and_scans_stay_where_they_are_led() {
    let threads = [
        (5_000_331, "fault drive Z runaway"),
        (5_003_494, "fault input I19 bouncing"),
        (5_000_689, "fault encoder S amplitude"),
        (5_001_672, "fault drive S reversed"),
        (5_000_937, "fault encoder Z stuck"),
        (3_004_393, "force Y 4000"),
        (3_001_357, "fault drive S runaway"),
        (3_005_981, "fault encoder S stuck"),
        (7_110_097, "fault drive Z runaway"),
        (7_110_156, "fault drive S runaway"),
        (7_110_633, "fault drive S dead"),
    ];
    let scans = [
        (5_004_658, "fault probe early"),
        (3_002_660, "manual-operation"),
        (3_005_973, "fault probe early"),
    ];
    let found = [
        ("gantry", "THREADS.H", &threads[..]),
        ("dig425", "MODEL.H", &scans[..]),
    ];
    for (machine, program, seeds) in found {
        let campaign = of_programs(support::machine(machine), &[program]);
        for (seed, what) in seeds {
            holds(&campaign, program, *seed, &[what]);
        }
    }
}

/// Of a campaign of a million seconds: a handwheel that had been given the rapid traverse in the cycle before the path took it, a
/// direction key that is held while the loops close, an encoder that sticks while its axis is pushed.
#[test]
fn what_the_long_campaign_found_stays_mended() {
    for (machine, program, seed, what) in [
        ("mill", "KNOB.H", 8_500_962, "handwheel Z 0, handwheel -100"),
        ("mill", "KNOB.H", 8_800_267, "handwheel Z 0, handwheel -500"),
        ("dig425", "CIRCLE.H", 8_400_916, "key X- press"),
        ("mill-tnc360", "PLATE.H", 8_700_335, "force Y 4000"),
    ] {
        let campaign = campaign(machine);
        holds(&campaign, program, seed, &[what]);
    }
}

/// An axis that stood for a moment while its spindle ran on, at the end of a thread: the thread ended before the axis, and the next
/// block began with a jump. A speed controller with a fault that braked again in an EMERGENCY STOP.
#[test]
fn what_stands_off_its_spindle_goes_after_it() {
    for (machine, program, seed, what) in [
        ("gantry", "THREADS.H", 9_000_253, "switch door open"),
        ("gantry", "THREADS.H", 9_001_371, "fault input I8 bouncing"),
        ("gantry", "THREADS.H", 9_100_453, "fault input I7 bouncing"),
        ("mill", "FLANGE.H", 9_401_131, "switch door open"),
        ("dig425", "MODEL.H", 9_100_007, "fault motor X"),
    ] {
        let campaign = campaign(machine);
        holds(&campaign, program, seed, &[what]);
    }
}

/// What a seed did is a script that a run repeats: each command has a line of its own.
#[test]
fn a_script_has_a_line_for_each_command() {
    let campaign = campaign("mill");
    let mut worker = campaign.worker().unwrap();
    let plan = worker.plan(3_006_369);
    let trial = worker.run(&plan);
    let script = campaign.script(&plan, &trial, "mill");
    let mut turned = script.lines().filter(|line| line.contains("handwheel"));
    let [axis, steps] = [turned.next().unwrap(), turned.next().unwrap()];
    assert!(
        axis.ends_with(": handwheel Z 0") && steps.ends_with(": handwheel -500"),
        "{script}"
    );
}

/// The voltage goes while the pallet shuttle passes its marks at power-on, and the shuttle is elsewhere than undisturbed when
/// the model is digitized. An axis of the PLC is none that a probe leads.
#[test]
fn a_probe_leads_no_axis_of_the_plc() {
    let campaign = of_programs(support::machine("dig425"), &["MODEL.H"]);
    let mut worker = campaign.worker().unwrap();
    let plan = worker.plan(0);
    let happens = plan
        .happenings
        .iter()
        .any(|happening| happening.what == "voltage off");
    assert!(happens, "seed 0 is another one now: {plan:?}");
    assert_eq!(worker.run(&plan).violation, None);
}

/// A seed is the same run every time, and whatever came before it.
#[test]
fn a_seed_says_everything() {
    let campaign = campaign("mill-tnc360");
    let (mut one, mut other) = (campaign.worker().unwrap(), campaign.worker().unwrap());
    for seed in 5000..5010 {
        let plan = other.plan(seed);
        drop(other.run(&plan));
    }
    for seed in [5007, 5003] {
        let plan = one.plan(seed);
        let (a, b) = (one.run(&plan), other.run(&plan));
        assert_eq!(
            (a.done, a.machine_us, a.messages),
            (b.done, b.machine_us, b.messages),
            "{seed}"
        );
    }
}

/// A PLC program that withholds the feed enable for good once an EMERGENCY STOP was shown (M2191): the run hangs without
/// a word. The campaign finds it, and of all that happened in the seed the EMERGENCY STOP is left.
#[test]
fn a_plc_program_that_lets_a_run_hang_is_found_out() {
    let copy = Copy::of("mill-tnc360", "torture-hangs");
    let program = copy.path().join("plc/MAIN.PLC");
    let text = std::fs::read_to_string(&program).unwrap();
    let enable = "       L     I3\n       = M2451\n";
    let hangs = "       L     M2191\n       S     M199\n       L     I3\n       AN    M199\n       = M2451\n";
    assert!(text.contains(enable));
    std::fs::write(&program, text.replacen(enable, hangs, 1)).unwrap();
    let campaign = load(copy.path());
    let mut worker = campaign.worker().unwrap();
    let broken = (0..300).find_map(|seed| {
        let plan = worker.plan(seed);
        let trial = worker.run(&plan);
        let is_stop = |kind| kind == Kind::Emergency;
        let stopped = plan.happenings.iter().any(|happening| is_stop(happening.kind));
        let violation = trial.violation.clone().filter(|_| stopped)?;
        Some((plan, trial, violation))
    });
    let (plan, trial, violation) = broken.unwrap();
    assert_eq!(violation.rule, Rule::Recovery, "{violation:?}");
    let few = worker.shrink(&plan, violation.rule);
    assert_eq!(few.happenings.len(), 1, "{:#?}", few.happenings);
    assert_eq!(worker.run(&few).violation.unwrap().rule, Rule::Recovery);
    let script = campaign.script(&plan, &trial, "machines/broken");
    assert!(
        script.contains("--machine machines/broken") && script.contains("NC_START tap"),
        "{script}"
    );
}

/// Both heads of the portal with a System 900, on an ideal machine: it has neither EMERGENCY STOP nor things.
#[test]
fn the_portal_holds_every_rule() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900");
    let copy = Copy::of_folder(&shipped, "ideal-portal");
    let ideal =
        "name = 'Portal'\ncontrol = 'system900'\nparameters = 'parameters.q'\nprograms = 'programs'\n";
    std::fs::write(copy.path().join("machine.toml"), ideal).unwrap();
    // The standard answers change tools.
    std::fs::remove_file(copy.path().join("programs/Z6.900")).unwrap();
    try_campaign("portal900", &load(copy.path()), 0..500, 4);
}
