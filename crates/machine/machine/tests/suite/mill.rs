//! The PLC program of `machines/mill` moves the plant beside it, with a stand-in for the NC: inputs and
//! outputs of both fit each other, and every wait of the program ends.

use bahn_exchange::{Bit, BitArea, Exchange, Number};
use bahn_machine::Machine;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_plc::{Compilation, MemoryFiles, Options, Start, TestNc, mirror_parameters};
use bahn_servo::{INPUTS, OUTPUTS};

/// The machine, its PLC, and as much of an NC as the test plays.
struct Mill {
    machine: Machine,
    plc: bahn_plc::Machine,
    exchange: Exchange,
    nc: TestNc,
    /// Voltage for M03.
    volts: f64,
    cycle: u32,
}

/// A file of the shipped mill.
fn file(path: &str) -> &'static str {
    bahn_machines::MILL.file(path).unwrap()
}

impl Mill {
    fn new() -> Mill {
        let files = MemoryFiles::from([("MAIN.PLC", file("plc/MAIN.PLC"))]);
        let compilation = Compilation::compile(&files, "MAIN.PLC", Options::default());
        assert_eq!(compilation.errors, []);
        let mut parameters = ParameterList::reference(ControlModel::Tnc415b);
        let faults = parameters.read(file("parameters.mp").as_bytes());
        assert!(faults.is_empty(), "{faults:?}");
        let plant = file("plant.toml");
        let mut mill = Mill {
            machine: Machine::from_toml(plant).unwrap(),
            plc: bahn_plc::Machine::new(compilation.program.unwrap().into(), Start::PowerOn),
            exchange: Exchange::default(),
            nc: TestNc::new(parameters),
            volts: 0.0,
            cycle: 0,
        };
        mirror_parameters(&mill.nc.parameters, &mut mill.exchange);
        mill.machine.set_control_ready(true);
        mill.set_word("W272", 1);
        mill.set_word("W494", 100);
        mill
    }

    /// Switched on and ready, full sequence.
    fn ready() -> Mill {
        let mut mill = Mill::new();
        mill.cycles(100);
        mill.set_word("W272", 5);
        mill
    }

    fn set(&mut self, bit: &str, on: bool) {
        self.exchange.nc_set(bit.parse().unwrap(), on);
    }

    fn set_word(&mut self, number: &str, value: i32) {
        self.exchange
            .nc_set_number(number.parse::<Number>().unwrap(), value);
    }

    fn is_on(&self, bit: &str) -> bool {
        self.exchange.nc().bit(bit.parse().unwrap())
    }

    /// A PLC cycle of 20 ms. The NC closes the loops with the control voltage and puts out the spindle
    /// voltage that the PLC asks for.
    fn cycles(&mut self, count: u32) {
        for _ in 0..count {
            self.cycle += 1;
            self.set("M2180", self.cycle == 1);
            let mut inputs = [false; INPUTS];
            self.machine.inputs(&mut inputs);
            for (number, on) in (0..).zip(inputs) {
                if let Some(bit) = Bit::new(BitArea::I, number) {
                    self.exchange.nc_set(bit, on);
                }
            }
            let voltage = self.machine.control_ready();
            for (enabled, open) in [
                ("M2000", "M2544"),
                ("M2001", "M2545"),
                ("M2002", "M2546"),
                ("M2003", "M2547"),
            ] {
                let closed = voltage && !self.is_on(open);
                self.set(enabled, closed);
            }
            self.plc.scan(&mut self.exchange, &mut self.nc).unwrap();
            let mut outputs = [false; OUTPUTS];
            for (number, on) in (0..).zip(&mut outputs) {
                *on = Bit::new(BitArea::O, number).is_some_and(|bit| self.exchange.nc().bit(bit));
            }
            self.machine.set_outputs(&outputs);
            let jog = 0.1;
            let volts = match ["M2490", "M2491", "M2485", "M2486"].map(|bit| self.is_on(bit)) {
                [true, ..] => -jog,
                [_, true, ..] => jog,
                [_, _, true, _] => self.volts,
                [.., true] => -self.volts,
                _ => 0.0,
            };
            self.machine.set_nominal(5, volts);
            self.machine.advance(20_000);
        }
    }

    /// Sets a strobe until the PLC acknowledges; the cycles that took.
    fn strobe(&mut self, strobe: &str, acknowledge: &str) -> u32 {
        self.set(strobe, true);
        let start = self.cycle;
        while !self.is_on(acknowledge) {
            self.cycles(1);
            assert!(
                self.cycle - start < 1000,
                "{strobe} is not acknowledged with {acknowledge}"
            );
        }
        let taken = self.cycle - start;
        self.set(strobe, false);
        self.cycles(2);
        assert!(!self.is_on(acknowledge), "{acknowledge} falls with {strobe}");
        taken
    }

    fn m_function(&mut self, function: u32) -> u32 {
        let decoded = format!("M{}", 1900 + function);
        self.set(&decoded, true);
        let taken = self.strobe("M2045", "M2482");
        self.set(&decoded, false);
        taken
    }

    fn device(&self, name: &str) -> Option<&str> {
        self.machine.device(name).unwrap().state
    }
}

#[test]
fn after_power_on_drives_are_enabled_and_the_table_is_released() {
    let mut mill = Mill::new();
    assert_eq!(mill.device("table_clamp"), Some("clamped"));
    mill.cycles(100);
    assert!(mill.machine.axes().all(|axis| axis.powered && !axis.clamped));
    assert!(mill.is_on("M2451") && !mill.is_on("M2467"));
    assert!(!mill.is_on("M2547"));
    // No message.
    for number in 2924..3024 {
        assert!(!mill.is_on(&format!("M{number}")), "message {}", number - 2924);
    }
}

#[test]
fn m03_is_acknowledged_at_speed() {
    let mut mill = Mill::ready();
    mill.set_word("D356", 750_000);
    mill.volts = 4.5;
    let taken = mill.m_function(3);
    let rpm = mill.machine.spindle().unwrap().rpm;
    assert!((rpm - 750.0).abs() <= 0.05 * 750.0, "{rpm}");
    // 3000 rpm of the motor at 9000 rpm/s and 60 ms: between 0.3 and 0.8 s.
    assert!((15..40).contains(&taken), "{taken}");
    // M04: through zero.
    let taken = mill.m_function(4);
    let rpm = mill.machine.spindle().unwrap().rpm;
    assert!((rpm + 750.0).abs() <= 0.05 * 750.0, "{rpm}");
    assert!((30..60).contains(&taken), "{taken}");
    mill.m_function(5);
    assert!(mill.machine.spindle().unwrap().rpm.abs() < 3.0);
}

#[test]
fn the_gear_changes_while_the_spindle_turns_and_turns_again() {
    let mut mill = Mill::ready();
    mill.set_word("D356", 750_000);
    mill.volts = 4.5;
    mill.m_function(3);
    mill.set_word("W256", 1);
    mill.strobe("M2043", "M2480");
    let spindle = mill.machine.spindle().unwrap();
    assert_eq!(spindle.gear, Some(2));
    mill.cycles(50);
    assert!((mill.machine.spindle().unwrap().rpm - 3000.0).abs() < 10.0);
    // The same range again: at once.
    assert!(mill.strobe("M2043", "M2480") <= 2);
}

#[test]
fn a_gear_that_jams_gives_a_message_and_goes_on_when_repaired() {
    let mut mill = Mill::ready();
    mill.machine.apply("fault device gear jammed").unwrap();
    mill.set_word("W256", 1);
    mill.set("M2043", true);
    mill.cycles(600);
    assert!(mill.is_on("M2932") && !mill.is_on("M2480"));
    mill.machine.apply("repair gear").unwrap();
    mill.strobe("M2043", "M2480");
    assert!(!mill.is_on("M2932"));
}

#[test]
fn tools_change_without_operator_or_with_one() {
    let mut mill = Mill::ready();
    mill.set_word("W262", 3);
    mill.strobe("M2046", "M2483");
    assert_eq!(mill.exchange.nc().number("W100".parse().unwrap()), 3);
    assert_eq!(mill.device("tool_clamp"), Some("clamped"));
    // MP4310.0 = 0: the operator opens, changes, closes, confirms.
    mill.set("M2192", false);
    mill.set_word("W262", 4);
    mill.set("M2046", true);
    mill.cycles(100);
    assert!(mill.is_on("M2924") && !mill.is_on("M2483"));
    assert_eq!(mill.machine.lamp("TOOL_CHANGE"), Some(true));
    for action in ["key TOOL_RELEASE tap", "key TOOL_RELEASE tap", "key CONFIRM tap"] {
        assert!(!mill.is_on("M2483"));
        mill.machine.apply(action).unwrap();
        mill.cycles(5);
        if action.contains("RELEASE") {
            mill.cycles(45);
        }
    }
    assert!(mill.is_on("M2483"));
    mill.strobe("M2046", "M2483");
    assert!(!mill.is_on("M2924"));
}

#[test]
fn m10_clamps_the_table_and_a_movement_releases_it() {
    let mut mill = Mill::ready();
    mill.set("M2011", true);
    mill.m_function(10);
    assert!(mill.machine.axis('C').unwrap().clamped);
    assert!(mill.is_on("M2547") && !mill.is_on("M2003"));
    // The NC wants to move: in position falls, the PLC releases and closes the loop.
    mill.set("M2011", false);
    mill.cycles(30);
    assert!(!mill.machine.axis('C').unwrap().clamped);
    assert!(!mill.is_on("M2547") && mill.is_on("M2003"));
    mill.set("M2011", true);
    mill.cycles(30);
    assert!(mill.machine.axis('C').unwrap().clamped && mill.is_on("M2547"));
    mill.m_function(11);
    assert!(!mill.machine.axis('C').unwrap().clamped && !mill.is_on("M2547"));
}

#[test]
fn coolant_flows_or_is_missed() {
    let mut mill = Mill::ready();
    mill.m_function(8);
    assert_eq!(mill.device("flood"), Some("on"));
    mill.m_function(9);
    mill.cycles(50);
    assert_eq!(mill.device("flood"), Some("off"));
    mill.machine.apply("fault device flood jammed").unwrap();
    mill.set("M1908", true);
    mill.set("M2045", true);
    mill.cycles(200);
    assert!(mill.is_on("M2927") && !mill.is_on("M2482"));
}

#[test]
fn lubrication_builds_up_pressure_or_tells() {
    for (fault, message) in [(false, false), (true, true)] {
        let mut mill = Mill::ready();
        if fault {
            mill.machine
                .apply("fault device lubrication no-feedback")
                .unwrap();
        }
        mill.set("M2012", true);
        mill.cycles(1);
        assert!(mill.is_on("M2548"));
        mill.set("M2012", false);
        mill.cycles(200);
        assert_eq!(mill.device("lubrication"), Some("pressure"));
        assert_eq!(mill.is_on("M2926"), message);
    }
}

#[test]
fn panel_door_and_emergency_stop() {
    let mut mill = Mill::ready();
    mill.machine.press("NC_START").unwrap();
    mill.cycles(2);
    assert!(mill.is_on("M2448") && !mill.is_on("M2464"));
    mill.machine.release("NC_START").unwrap();
    mill.machine.press("IV-").unwrap();
    mill.cycles(2);
    assert!(mill.is_on("M2463") && !mill.is_on("M2479"));
    assert!(!mill.is_on("M2448") && mill.is_on("M2464"));
    mill.set("M2184", true);
    mill.machine.apply("switch door open").unwrap();
    mill.cycles(50);
    assert!(!mill.is_on("M2488"), "NC stop");
    mill.machine.apply("emergency press").unwrap();
    mill.cycles(5);
    assert!(mill.machine.axes().all(|axis| !axis.powered));
    assert!(!mill.is_on("M2451") && mill.is_on("M2467"));
}

#[test]
fn a_contact_of_nc_start_that_sticks_breaks_the_complement() {
    let mut mill = Mill::ready();
    mill.machine.apply("fault input I149 1").unwrap();
    mill.cycles(2);
    assert!(!mill.is_on("M2448") && !mill.is_on("M2464"), "error 1A of the NC");
}

#[test]
fn a_dead_drive_takes_the_feed_away() {
    let mut mill = Mill::ready();
    mill.machine.apply("fault drive Y dead").unwrap();
    mill.cycles(2);
    assert!(mill.is_on("M2925") && !mill.is_on("M2451"));
    mill.machine.apply("repair all").unwrap();
    mill.cycles(2);
    assert!(!mill.is_on("M2925") && mill.is_on("M2451"));
}

/// A position loop as simple as can be, every 3 ms: lag times kv is the nominal speed.
#[test]
fn a_position_loop_holds_the_axes_and_lags_as_the_formula_says() {
    let mut mill = Mill::ready();
    // Rapid traverse (mm/min), 9 V, kv 2 (m/min)/mm, 20 µm signal period.
    for (letter, output, rapid) in [('X', 0, 15_000.0), ('Y', 1, 15_000.0), ('Z', 2, 12_000.0)] {
        let kv = 2000.0;
        let mm = |count: i64| count as f64 / 1024.0 * 0.02;
        let start = mm(mill.machine.encoder(output).count);
        let mut nominal = start;
        let mut lag = 0.0;
        let mut run = |speed: f64, cycles: u32| {
            for _ in 0..cycles {
                nominal += speed / 60.0 * 0.003;
                lag = nominal - mm(mill.machine.encoder(output).count);
                mill.machine.set_nominal(output, lag * kv / rapid * 9.0);
                mill.machine.advance(3000);
            }
            lag
        };
        // Standing, against offset and weight: within the positioning window.
        let standing = run(0.0, 300);
        assert!(standing.abs() < 0.01, "{letter} {standing}");
        // 5000 mm/min / 2000 = 2.5 mm [000:4881-4891], but for the offset: 3 mV are 5 mm/min, 0.0025 mm.
        let moving = run(5000.0, 200);
        assert!((moving - 2.5).abs() < 0.003, "{letter} {moving}");
        run(0.0, 300);
        let state = mill.machine.axis(letter).unwrap();
        assert!(state.speed_per_min.abs() < 10.0, "{state:?}");
    }
}
