//! What the tests share: programs, lists and scripts as texts, and questions to the report.
#![allow(dead_code, reason = "every test file uses its part")]

use std::sync::Arc;

use bahn_din::Program;
use bahn_motion::Limits;
use bahn_path::{Axis, PerAxis, Position};
use bahn_technology::{
    Bounds, ChannelList, ChannelSettings, Event, EventKind, NcPrograms, PlcMemory, Report, Run, Script,
};
use bahn_text::MemoryFiles;

/// A cycle, s.
pub const T: f64 = 0.001;
/// Acceleration of all axes, mm/s².
pub const A: f64 = 1000.0;
/// Rapid traverse of an axis, mm/s.
pub const RAPID: f64 = 10_000.0 / 60.0;

/// 10 m/min, 1 m/s², corners that change direction stop.
pub fn limits() -> Limits {
    Limits {
        max_feed_mm_min: PerAxis::splat(RAPID * 60.0),
        acceleration_m_s2: PerAxis::splat(A / 1000.0),
        radial_acceleration_m_s2: 0.5,
        corner_angle_deg: 10.0,
        servo_lag: true,
        cycle_s: T,
        servo_window_s: bahn_motion::SERVO_WINDOW_S,
        spindle: Default::default(),
        feed_override_percent: 100.0,
        rapid_override_percent: 100.0,
    }
}

pub fn settings(list: &str) -> ChannelSettings {
    let list = ChannelList::from_bytes(list.as_bytes());
    assert!(list.errors().is_empty(), "{:?}", list.errors());
    list.settings().clone()
}

/// A run as it is reported.
#[derive(Clone, Debug)]
pub struct Bench {
    pub programs: Vec<String>,
    pub list: String,
    pub script: Option<String>,
    pub start: [f64; 2],
    pub from: Option<String>,
    /// Names and texts.
    pub subroutines: Vec<(String, String)>,
    pub limits: Limits,
    pub bounds: Bounds,
}

impl Bench {
    pub fn new(program: &str, list: &str) -> Bench {
        Bench {
            programs: vec![program.to_owned()],
            list: list.to_owned(),
            script: Some(String::new()),
            start: [0.0, 0.0],
            from: None,
            subroutines: Vec::new(),
            limits: limits(),
            bounds: Bounds::default(),
        }
    }

    pub fn script(mut self, script: &str) -> Bench {
        self.script = Some(script.to_owned());
        self
    }

    /// The virtual PLC with its process times.
    pub fn virtual_plc(mut self) -> Bench {
        self.script = None;
        self
    }

    pub fn and(mut self, program: &str) -> Bench {
        self.programs.push(program.to_owned());
        self
    }

    pub fn from(mut self, block: &str) -> Bench {
        self.from = Some(block.to_owned());
        self
    }

    pub fn subroutine(mut self, name: &str, text: &str) -> Bench {
        self.subroutines.push((name.to_owned(), text.to_owned()));
        self
    }

    pub fn run(&self) -> Report {
        self.execute(None)
    }

    /// Runs it with a PLC that has its bytes.
    pub fn run_beside(&self, plc: &mut dyn PlcMemory) -> Report {
        self.execute(Some(plc))
    }

    fn execute(&self, plc: Option<&mut dyn PlcMemory>) -> Report {
        let files: Vec<_> = self
            .programs
            .iter()
            .zip(1..)
            .map(|(text, number)| Arc::new(Program::from_bytes(&format!("p{number}.nc"), text.as_bytes())))
            .collect();
        let beside: MemoryFiles = self
            .subroutines
            .iter()
            .map(|(name, text)| (name.as_str(), text))
            .collect();
        let programs = NcPrograms::new(&files, Arc::new(beside)).unwrap();
        let settings = settings(&self.list);
        let script: Option<Script> = self.script.as_ref().map(|script| script.parse().unwrap());
        let mut start = Position::UNKNOWN;
        start[Axis::X] = self.start[0];
        start[Axis::Y] = self.start[1];
        let run = Run {
            programs: &programs,
            settings: &settings,
            limits: &self.limits,
            start,
            from: self.from.as_deref(),
            bounds: self.bounds,
            script: script.as_ref(),
        };
        match plc {
            Some(plc) => run.execute_beside(plc),
            None => run.execute(),
        }
    }
}

/// Questions to a report.
pub trait Asked {
    /// Outputs of a function in the channel: time and place.
    fn outputs(&self, function: &str) -> Vec<&Event>;
    fn output(&self, function: &str) -> &Event;
    fn of(&self, kind: EventKind) -> Vec<&Event>;
    fn order(&self) -> Vec<String>;
    fn wait(&self, function: &str) -> (f64, f64, f64);
}

impl Asked for Report {
    fn outputs(&self, function: &str) -> Vec<&Event> {
        let outputs = self
            .events
            .iter()
            .filter(|event| event.kind == EventKind::Output && event.function.as_deref() == Some(function));
        outputs.collect()
    }

    fn output(&self, function: &str) -> &Event {
        let outputs = self.outputs(function);
        assert_eq!(outputs.len(), 1, "{function}: {outputs:?}");
        outputs[0]
    }

    fn of(&self, kind: EventKind) -> Vec<&Event> {
        self.events.iter().filter(|event| event.kind == kind).collect()
    }

    /// All outputs as `target:function`.
    fn order(&self) -> Vec<String> {
        let name = |event: &&Event| {
            format!(
                "{}:{}",
                event.target.as_deref().unwrap(),
                event.function.as_deref().unwrap()
            )
        };
        self.of(EventKind::Output).iter().map(name).collect()
    }

    /// From, to and X of the only wait for a function.
    fn wait(&self, function: &str) -> (f64, f64, f64) {
        let waits: Vec<_> = self
            .waits
            .iter()
            .filter(|wait| wait.function == function)
            .collect();
        assert_eq!(waits.len(), 1, "{function}: {:?}", self.waits);
        let wait = waits[0];
        (
            wait.from_s,
            wait.to_s.unwrap_or(f64::INFINITY),
            wait.position.0[Axis::X],
        )
    }
}

pub fn x(event: &Event) -> f64 {
    event.position.0[Axis::X]
}

pub fn y(event: &Event) -> f64 {
    event.position.0[Axis::Y]
}

/// Asserts a place within 1 µm.
pub fn at(place: f64, expected: f64) {
    assert!((place - expected).abs() < 1e-3, "{place} mm is not {expected} mm");
}

/// Asserts a time within a cycle.
pub fn when(t: f64, expected: f64) {
    assert!((t - expected).abs() <= T * 1.001, "{t} s is not {expected} s");
}

/// Time of a movement from standstill to standstill, s.
pub fn ramp_s(distance: f64, v: f64) -> f64 {
    if v * v / A >= distance {
        2.0 * (distance / A).sqrt()
    } else {
        distance / v + v / A
    }
}
