//! What pages see and may touch.

use bahn_control900::Control900;
use bahn_host::{Action, Answer, By, Command900, Host900, Machine900, Source};
use bahn_live::Refusal;
use bahn_screen::texts::{Language, words};
use bahn_system900::{
    AxisParameter, ChannelAxis, ChannelParameter, Memory, Name, Part, Place, Writer, refusing,
};

/// What is seen of a machine, from one of its channels.
#[derive(Clone, Copy)]
pub(crate) struct Sight<'a> {
    pub machine: &'a Machine900,
    pub host: &'a Host900,
    /// The channel that is shown, from 1 on.
    pub channel: u8,
    pub language: Language,
}

impl<'a> Sight<'a> {
    pub fn control(&self) -> &'a Control900 {
        self.host.control()
    }

    pub fn memory(&self) -> &'a Memory {
        self.control().memory()
    }

    /// A text in the language of the panel.
    pub fn words(&self, english: &'static str) -> &'static str {
        words(self.language, english)
    }

    /// What a parameter of the channel holds, when it is a whole number.
    pub fn whole(&self, parameter: ChannelParameter) -> Option<i64> {
        self.memory().of_channel(self.channel, parameter).whole()
    }

    pub fn number(&self, parameter: ChannelParameter) -> Option<f64> {
        self.memory().of_channel(self.channel, parameter).number()
    }

    /// A parameter of the channel by its name.
    pub fn name(&self, parameter: ChannelParameter) -> Option<Name> {
        let place = self.memory().channel_place(self.channel, parameter)?;
        Some(self.memory().name_of(place))
    }

    /// The axes of the channel that have names.
    pub fn axes(&self) -> impl Iterator<Item = &'a ChannelAxis> + use<'a> {
        let channels = self.machine.checked.channels.iter();
        let own = self.channel;
        let of = channels.filter(move |channel| channel.channel == own);
        of.flat_map(|channel| &channel.axes)
            .filter(|axis| !axis.name.is_empty())
    }

    /// What a parameter of one of these axes holds.
    pub fn of_axis(&self, axis: &ChannelAxis, parameter: AxisParameter) -> Option<f64> {
        let place = Memory::axis_place(axis.physical, parameter)
            .unwrap_or_else(|| Memory::own_place(self.channel, axis.logical, parameter));
        self.at(place)
    }

    fn at(&self, place: Place) -> Option<f64> {
        self.memory().at(place).number()
    }

    /// The axis has passed its reference point.
    pub fn is_referenced(&self, axis: &ChannelAxis) -> bool {
        let state = self
            .memory()
            .of_axis(axis.physical, AxisParameter::ReferenceState);
        state.bits().unwrap_or(0) & 0xFF == 1
    }

    /// Its positions are degrees.
    pub fn turns(&self, axis: &ChannelAxis) -> bool {
        let rotary = self.memory().of_axis(axis.physical, AxisParameter::Rotary);
        rotary.whole().unwrap_or(0) != 0
    }

    /// A position, with the decimals of the channel.
    pub fn position(&self, value: Option<f64>) -> String {
        let decimals = usize::from(self.memory().position_decimals(self.channel));
        value.map_or_else(|| "--".to_owned(), |value| format!("{value:+.decimals$}"))
    }
}

/// What is done to a machine.
pub(crate) struct Desk<'a> {
    pub machine: &'a Machine900,
    pub host: &'a mut Host900,
    pub channel: u8,
    pub language: Language,
}

impl Desk<'_> {
    pub fn sight(&self) -> Sight<'_> {
        Sight {
            machine: self.machine,
            host: self.host,
            channel: self.channel,
            language: self.language,
        }
    }

    /// The operator gives a parameter of the channel a value with a key.
    ///
    /// # Errors
    /// What holds him back.
    pub fn press(&mut self, parameter: ChannelParameter, value: &str) -> Result<(), Refusal> {
        let name = self.sight().name(parameter);
        let name = name.ok_or_else(|| Refusal(format!("there is no channel {}", self.channel)))?;
        self.write(name, value)
    }

    /// The same of any parameter.
    ///
    /// # Errors
    /// What holds him back, or why the value is none.
    pub fn write(&mut self, name: Name, value: &str) -> Result<(), Refusal> {
        let command = Command900::at_the_panel(name, value).map_err(Refusal)?;
        self.give(command)
    }

    /// Gives a command.
    ///
    /// # Errors
    /// What holds it back.
    pub fn give(&mut self, command: Command900) -> Result<(), Refusal> {
        // Why it is refused is asked before: the answer says that it is, and no more.
        let writer = match command.by {
            By::Operator => Writer::Editor,
            By::Panel => Writer::Page,
            By::Plc => Writer::Plc,
        };
        let lock = refusing(self.sight().memory(), writer, Part::Value, command.name);
        let held = lock
            .ok()
            .flatten()
            .map(|lock| format!("{} is locked by {lock}", command.name));
        match self.act(Action::Command(0, command))? {
            Answer::Done => Ok(()),
            Answer::Refused => Err(Refusal(held.unwrap_or_default())),
            Answer::Impossible(why) => Err(Refusal(why)),
        }
    }

    /// Lets something happen.
    ///
    /// # Errors
    /// When it cannot be written down.
    pub fn act(&mut self, action: Action<Command900>) -> Result<Answer, Refusal> {
        let answer = self.host.act(Source::Client("panel".to_owned()), action);
        answer.map_err(|error| Refusal(error.to_string()))
    }
}
