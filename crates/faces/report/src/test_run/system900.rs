//! A machine with a System 900, as far as a program needs it that nobody but the planner executes.
//!
//! Decision: A program runs in the channel whose P8800 holds its number, else in channel 1. Corners of more than 90 degrees are
//! stops, whatever P8851 says; on circles nothing but P8852 and the ramps of the axes limits the feed

use std::sync::Arc;

use bahn_host::Machine900;
use bahn_host::files::NcFolder;
use bahn_interpreter900::Reader900;
use bahn_motion::{Limits, SERVO_WINDOW_S};
use bahn_path::{Axis, PerAxis, Position};
use bahn_program::{DinLanguage, Program};
use bahn_system900::{AxisBlock, ChannelParameter, Memory, slots};

/// What the control is called.
const NAME: &str = "SYSTEM 900";
/// Corners up to it are passed, degrees.
const CORNER_DEG: f64 = 90.0;
/// Radial acceleration where nothing limits a circle, m/s² (inferred).
const RADIAL_M_S2: f64 = 1.0;
/// Interpolation cycle where P11301 does not say it, s.
const CYCLE_S: f64 = 0.004;

/// A machine with a System 900.
pub struct System900 {
    memory: Memory,
}

impl System900 {
    /// That of a folder.
    pub fn of(machine: &Machine900) -> System900 {
        System900 {
            memory: machine.parameters.memory().clone(),
        }
    }

    /// What its reports call the control.
    pub fn name(&self) -> &'static str {
        NAME
    }

    /// Whether it runs a program, by its language.
    pub fn runs(program: &Program) -> bool {
        program.dialect() == Some(DinLanguage::System900)
    }

    /// The channel that a program runs in.
    fn channel(&self, program: &Program) -> u8 {
        let name = program.name().rsplit(['/', '\\']).next().unwrap_or_default();
        let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
        let number = digits.split('.').next().and_then(|digits| digits.parse().ok());
        let has = |channel: &u8| {
            let own = self
                .memory
                .of_channel(*channel, ChannelParameter::Program)
                .whole();
            own.is_some() && own == number
        };
        (1..=self.memory.channels()).find(has).unwrap_or(1)
    }

    /// What reads a program.
    pub fn reader(&self, program: Arc<Program>) -> Reader900 {
        let beside = Arc::new(NcFolder::of(program.name().as_ref()));
        let channel = self.channel(&program);
        let mut reader = Reader900::of_program(program, channel, Position::ZERO, beside);
        reader.give_memory(self.memory.clone());
        reader
    }

    /// How fast a program may be.
    pub fn limits(&self, program: &Program) -> Limits {
        let channel = self.channel(program);
        let slots = slots(&self.memory, channel);
        let block = |axis: Axis| {
            let mut axes = self.memory.axes_of(channel);
            let own = axes.find(|(logical, _)| slots.get(usize::from(*logical) - 1) == Some(&Some(axis)));
            own.map(|(_, physical)| AxisBlock::of(&self.memory, physical))
        };
        let acceleration = |block: AxisBlock| block.max_mm_min / 60.0 / block.ramps_s[1] * 1e-3;
        Limits {
            max_feed_mm_min: PerAxis::from_fn(|axis| block(axis).map_or(0.0, |block| block.max_mm_min)),
            acceleration_m_s2: PerAxis::from_fn(|axis| block(axis).map_or(1.0, acceleration)),
            radial_acceleration_m_s2: RADIAL_M_S2,
            corner_angle_deg: CORNER_DEG,
            servo_lag: true,
            cycle_s: self.memory.cycle_ms().map_or(CYCLE_S, |ms| ms * 1e-3),
            servo_window_s: SERVO_WINDOW_S,
            spindle: Default::default(),
            feed_override_percent: 100.0,
            rapid_override_percent: 100.0,
        }
    }
}
