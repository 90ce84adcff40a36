//! The shipped portal: both programs on the simulated machine, with its PLC program.

use std::path::{Path, PathBuf};

use bahn_host::{
    Action, Attendance, Event, Host, Host900, Job900, Machine900, Operator900, Play, PowerOn900, Stage900,
};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines/portal900")
}

/// The portal that was never on, with the operator who starts its programs, and goes on where one waits.
fn portal() -> Host900 {
    attended(Attendance::Full)
}

fn attended(attendance: Attendance) -> Host900 {
    let machine = Machine900::load(&folder())
        .unwrap()
        .unwrap_or_else(|faults| panic!("{faults:?}"));
    let power_on = PowerOn900::fresh(&machine);
    let plant = machine.plant(&power_on.memory);
    let job = Job900 { single_block: false };
    Host::of_system900(power_on, plant, Operator900::new(attendance, job))
}

fn read(host: &Host900, name: &str) -> f64 {
    let number = host.control().number(name.parse().unwrap()).unwrap();
    number.unwrap_or(f64::NAN)
}

fn messages(host: &Host900) -> Vec<String> {
    host.control()
        .messages()
        .iter()
        .map(ToString::to_string)
        .collect()
}

/// Goes on until something is so, 300 s at most.
fn until(host: &mut Host900, mut so: impl FnMut(&Host900) -> bool) {
    while !so(host) {
        let now = host.control().now_us();
        assert!(
            now < 300_000_000,
            "it never came: {:?}, {}",
            messages(host),
            state(host)
        );
        host.step().unwrap();
    }
}

/// Where both heads are, for whoever looks for a fault.
fn state(host: &Host900) -> String {
    let names = [
        "P8703", "P8685", "P8901", "P12151", "2:P8703", "2:P8685", "2:P8901", "2:P12151", "P8559", "2:P8559",
        "2:P8891",
    ];
    let all = names.map(|name| format!("{name}={}", read(host, name)));
    all.join(" ")
}

fn both_have_ended(host: &Host900) -> bool {
    (1..=2).all(|channel| host.control().run(channel).1)
}

/// The heads share the beam: the second one comes into the part only when the first one has left it; until then its X waits. Head 1
/// ends above its last hole, head 2 has turned the table once.
#[test]
fn both_heads_work_and_share_the_beam() {
    let mut host = portal();
    let (mut waited, mut nearest, mut lag, mut rpm) = (0, f64::INFINITY, 0f64, 0f64);
    until(&mut host, |host| {
        if read(host, "2:P8891") == 1.0 {
            waited += 1;
            assert!(read(host, "2:P12151") > 2599.9, "its X stands at 2600");
        }
        if read(host, "P8685") == 2.0 {
            nearest = nearest.min(read(host, "q2950") - read(host, "q2150"));
        }
        lag = lag.max(read(host, "P12160").abs());
        rpm = rpm.max(read(host, "P11649"));
        both_have_ended(host)
    });
    assert_eq!(messages(&host), Vec::<String>::new());
    // So many cycles of 2 ms.
    assert!(waited > 5000, "{waited}");
    assert!(nearest > 250.0, "{nearest}");
    // 24000 mm/min and Kv 20, 60 % of it taken away by pre-control, leave 24000 / 60 / 20 * 0.4 = 8 mm in rapid traverse.
    assert!((0.7..9.0).contains(&lag), "{lag}");
    assert!((5950.0..6100.0).contains(&rpm), "{rpm}");
    // The zero point of G54 is X250 Y120 of the machine.
    assert!(
        (read(&host, "P12150") - 270.0).abs() < 0.03,
        "{}",
        read(&host, "P12150")
    );
    assert!(
        (read(&host, "P12350") - 300.0).abs() < 0.03,
        "{}",
        read(&host, "P12350")
    );
    // The slave stands where its master does.
    assert!((read(&host, "q2350") - read(&host, "q2150")).abs() < 0.03);
}

/// The tool change takes its time: disk there and back 2 * 0.7 s, draw bar 2 * 0.25 s, and for place 5 four strokes of 2 * 0.12 s.
#[test]
fn the_tool_is_changed_by_the_plc() {
    let mut host = portal();
    until(&mut host, |host| host.control().run(1).1);
    let transfers = host.control().transfers();
    let own = transfers.filter(|transfer| (transfer.m, transfer.channel) == (66, 1));
    let waited = own.map(|transfer| (transfer.ack_us.unwrap() - transfer.time_us) as f64 * 1e-6);
    let changes: Vec<f64> = waited.collect();
    assert_eq!(changes.len(), 2);
    assert!((1.9..2.3).contains(&changes[0]), "{changes:?}");
    assert!((0.9..1.3).contains(&(changes[1] - changes[0])), "{changes:?}");
    assert_eq!(["P8100", "P8102", "P510"].map(|name| read(&host, name)), [5.0; 3]);
}

/// EMERGENCY STOP while both are at work: everything stands, and after RESET the programs can be started again.
#[test]
fn emergency_stop_stops_both() {
    let mut host = portal();
    until(&mut host, |host| read(host, "P8901") == 190.0);
    act(&mut host, "emergency press");
    spend(&mut host, 1.0);
    let off = ["P8685", "2:P8685", "P8700", "P8701", "2:P8701", "P8938"].map(|name| read(&host, name));
    assert_eq!(off, [0.0; 6], "{}", state(&host));
    assert!(
        host.control()
            .pending_messages(1)
            .any(|message| message.text == "EMERGENCY STOP")
    );
    act(&mut host, "emergency release");
    spend(&mut host, 0.5);
    act(&mut host, "key RESET tap");
    spend(&mut host, 1.0);
    assert_eq!(
        ["P8700", "P8701", "2:P8701"].map(|name| read(&host, name)),
        [1.0; 3],
        "{}",
        state(&host)
    );
    assert_eq!(host.control().pending_messages(1).count(), 0);
}

/// The door holds both on their ramps; they go on when it is closed.
#[test]
fn the_door_holds_the_heads() {
    let mut host = portal();
    until(&mut host, |host| read(host, "P8901") == 190.0);
    act(&mut host, "switch door open");
    spend(&mut host, 2.0);
    assert_eq!(
        (read(&host, "P8702"), read(&host, "P8938")),
        (1.0, 0.0),
        "{}",
        state(&host)
    );
    act(&mut host, "switch door closed");
    spend(&mut host, 1.5);
    assert!(
        read(&host, "P8702") == 0.0 && read(&host, "P8938") > 0.0,
        "{}",
        state(&host)
    );
}

/// Each script that is shipped comes to its end as it says.
#[test]
fn the_shipped_scripts_are_right() {
    for name in ["stop", "again", "emergency", "lock"] {
        let path = folder().join(format!("scripts/{name}.txt"));
        let machine = Machine900::load(&folder())
            .unwrap()
            .unwrap_or_else(|faults| panic!("{faults:?}"));
        let plant = machine.plant(machine.parameters.memory());
        let stage = Stage900::new(machine.parameters.memory(), &plant);
        let script = stage.script(&path, &std::fs::read(&path).unwrap());
        let mut play = Play::new(script.unwrap_or_else(|faults| panic!("{name}: {faults:?}")));
        // Beside a script the operator does no more than the first start.
        let mut host = attended(Attendance::Start);
        let mut started = false;
        let mut rests = 0;
        while !started || rests < 1000 {
            let now = host.control().now_us();
            assert!(
                now < 300_000_000,
                "{name}: {:?}, {}",
                messages(&host),
                state(&host)
            );
            play.follow900(&mut host).unwrap();
            host.step().unwrap();
            let runs = (1..=2).any(|channel| host.control().is_on_its_way(channel));
            // For 2 s no program is on its way: none is started any more.
            rests = if runs { 0 } else { rests + 1 };
            if !started && host.control().is_on_its_way(1) {
                started = true;
                play.start(now);
            }
        }
        play.follow900(&mut host).unwrap();
        play.finish(host.control().now_us() as f64 * 1e-6);
        assert!(
            play.failed.is_empty(),
            "{name}: {:?}, {}",
            play.failed,
            state(&host)
        );
    }
}

fn act(host: &mut Host900, event: &str) {
    host.act(
        bahn_host::Source::Operator,
        Action::Event(Event::parse(event).unwrap(), event.to_owned()),
    )
    .unwrap();
}

fn spend(host: &mut Host900, seconds: f64) {
    let end = host.control().now_us() + (seconds * 1e6) as u64;
    while host.control().now_us() < end {
        host.step().unwrap();
    }
}
