//! What a page may touch.
//!
//! Decision: What is captured is what the display shows, with the tool length in the tool axis, in input steps and in
//! the unit of the program; by hand CAPTURE writes a block after the selected one only while no block is open there;
//! its axes stand in the order of the machine (also `panel/src/pages/editing.rs`, `dialogue/src/capture.rs`)

use std::sync::Arc;

use bahn_graphics::Graphics;
use bahn_host::{Action, Answer, AnyPlant, Host, LoadedMachine, Source};
use bahn_parameters::{MessageId, ParameterList};
use bahn_path::Axis;
use bahn_screen::programs::ProgramMemory;
use bahn_screen::texts::{self, Language};
use bahn_tnc::{AxisState, ChannelView, Command, Control, Mode, RunState, Shown};

use crate::plc_mode::PlcMode;
use crate::settings::Settings;
use crate::status;
use crate::transfer::Transfers;

/// The station as a page sees it: the machine that is on, its folder, the program memory and what the operator chose.
pub(crate) struct Site<'a> {
    pub host: &'a mut Host<AnyPlant>,
    pub machine: &'a LoadedMachine,
    pub programs: &'a Arc<ProgramMemory>,
    pub settings: &'a mut Settings,
    pub plc: &'a mut PlcMode,
    pub graphics: &'a mut Graphics,
    pub transfers: &'a mut Transfers,
}

/// Endings of programs in plain language and in DIN/ISO, of which PROGRAM INPUT chooses one.
const ENDINGS: [&str; 2] = ["H", "I"];

impl Site<'_> {
    /// A program whose name says no type is the one that is there; where both are, or none is, it is in the language of
    /// PROGRAM INPUT [003:7104-7110].
    pub fn with_ending(&self, name: &str) -> String {
        if name.contains('.') {
            return name.to_owned();
        }
        let [plain, iso] = ENDINGS.map(|ending| format!("{name}.{ending}"));
        let (chosen, other) = if self.writes_iso() {
            (iso, plain)
        } else {
            (plain, iso)
        };
        match !self.programs.has(&chosen) && self.programs.has(&other) {
            true => other,
            false => chosen,
        }
    }

    /// New programs are in DIN/ISO: as the operator has chosen by PROGRAM INPUT, or MP217 says [001:1653].
    pub fn writes_iso(&self) -> bool {
        let said = self.parameters().operation_parameters().iso_programs;
        said.unwrap_or(self.settings.iso)
    }

    /// Asks the control for something; `false` when it refuses.
    pub fn command(&mut self, command: Command) -> bool {
        self.act(Action::Command(0, command))
    }

    /// Does something; `false` when it is refused or cannot be done.
    pub fn act(&mut self, action: Action) -> bool {
        let answer = self.host.act(Source::Client("panel".to_owned()), action);
        matches!(answer, Ok(Answer::Done))
    }

    /// The control of the machine, to be looked at.
    pub fn control(&self) -> &Control {
        self.host.control()
    }

    /// No program runs or is interrupted, in any channel.
    pub fn is_idle(&self) -> bool {
        let control = self.control();
        let channels = (0..control.channels()).filter_map(|number| control.channel(number));
        let rests = |channel: ChannelView<'_>| channel.run_state() == RunState::Idle && !channel.is_active();
        channels.into_iter().all(rests)
    }

    /// The machine parameters as they are edited.
    pub fn parameters(&self) -> &ParameterList {
        self.control().first().edited_list()
    }

    /// The machine operating mode.
    pub fn mode(&self) -> Mode {
        self.control().mode()
    }

    /// The language of the dialogue.
    pub fn language(&self) -> Language {
        let english = self.parameters().operation_parameters().english;
        self.settings.language(english)
    }

    /// A text of the panel in the language of the dialogue.
    pub fn words(&self, english: &'static str) -> String {
        texts::words(self.language(), english).to_owned()
    }

    /// A message of the control.
    pub fn message(&self, id: MessageId) -> String {
        texts::translate(self.language(), id.text(self.control().model()))
    }

    /// A message of the control that is shown, as it stands on the screen.
    pub fn translated(&self, shown: &Shown) -> String {
        texts::translate(self.language(), &self.control().shown_text(shown))
    }

    /// The actual position of an axis as the display shows it, mm or degrees: what is captured [003:2260-2321].
    pub fn captured(&self, letter: char) -> Option<f64> {
        self.position_of(letter, |axis| axis.actual)
    }

    /// The same in coordinates of the scale datum.
    pub fn captured_reference(&self, letter: char) -> Option<f64> {
        self.position_of(letter, |axis| axis.machine)
    }

    /// The axis of the tool that was called.
    pub fn tool_axis(&self) -> Option<Axis> {
        self.control().first().in_force().map(|own| own.tool_axis)
    }

    fn position_of(&self, letter: char, value: impl Fn(&AxisState) -> f64) -> Option<f64> {
        let snapshot = self.control().snapshot();
        let axis = snapshot.axes.iter().find(|axis| axis.letter == letter)?;
        Some(status::shown(value(axis), axis, self.parameters(), self.settings))
    }

    /// The axis of a channel's key `X`, `Y`, `Z`, `IV` or `V`, by its place from 0.
    pub fn axis_of_key(&self, place: usize) -> Option<Axis> {
        let snapshot = self.control().snapshot();
        let letter = snapshot.axes.iter().find(|axis| axis.index == place)?.letter;
        Axis::from_letter(u8::try_from(letter).ok()?)
    }
}
