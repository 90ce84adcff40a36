//! A machine with a System 900, as far as a program needs it that nobody but the planner executes.
//!
//! Decision: A program is planned in the channel whose P8800 holds its number, else in channel 1

use std::sync::Arc;

use bahn_control900::path_limits;
use bahn_host::Machine900;
use bahn_host::files::NcFolder;
use bahn_interpreter900::Reader900;
use bahn_motion::Limits;
use bahn_path::Position;
use bahn_program::{DinLanguage, Program};
use bahn_system900::{ChannelParameter, Memory};

/// What the control is called.
const NAME: &str = "SYSTEM 900";

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

    /// How fast a program may be, at the overrides that are asked for.
    pub fn limits(&self, program: &Program, asked: &Limits) -> Limits {
        Limits {
            feed_override_percent: asked.feed_override_percent,
            rapid_override_percent: asked.rapid_override_percent,
            ..path_limits(&self.memory, self.channel(program))
        }
    }
}
