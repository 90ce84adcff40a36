//! Which channel and which page are shown, and the line in which is entered.

use bahn_live::Refusal;
use bahn_screen::{Dialogue, SoftKeys, Window};

use crate::blocks::Text;
use crate::keys::{self, CHANNELS};
use crate::pages::{
    Arrow, LINES, Messages, Page, Parameters, PositionsPage, ProgramsPage, ToolsPage, ZeroPage,
};
use crate::sight::{Desk, Sight};

/// Characters of an entry at most.
const ENTRY_MAX: usize = 40;

/// The pages in the order of their soft keys.
const PAGES: usize = 6;

/// What the operator has chosen and typed.
pub(crate) struct Console {
    /// From 1 on.
    pub channel: u8,
    front: usize,
    entry: String,
    /// Why the last entry or key did nothing.
    pub note: Option<String>,
    pub positions: PositionsPage,
    programs: ProgramsPage,
    parameters: Parameters,
    zero: ZeroPage,
    tools: ToolsPage,
    messages: Messages,
    text: Text,
}

impl Default for Console {
    fn default() -> Console {
        Console {
            channel: 1,
            front: 0,
            entry: String::new(),
            note: None,
            positions: PositionsPage::default(),
            programs: ProgramsPage::default(),
            parameters: Parameters::default(),
            zero: ZeroPage::default(),
            tools: ToolsPage::default(),
            messages: Messages::default(),
            text: Text::default(),
        }
    }
}

impl Console {
    fn page(&self) -> &dyn Page {
        match self.front {
            1 => &self.programs,
            2 => &self.parameters,
            3 => &self.zero,
            4 => &self.tools,
            5 => &self.messages,
            _ => &self.positions,
        }
    }

    fn page_mut(&mut self) -> &mut dyn Page {
        match self.front {
            1 => &mut self.programs,
            2 => &mut self.parameters,
            3 => &mut self.zero,
            4 => &mut self.tools,
            5 => &mut self.messages,
            _ => &mut self.positions,
        }
    }

    /// The windows: the page, and the program beside it where there is room.
    pub fn windows(&mut self, sight: &Sight<'_>) -> (Window, Option<Window>) {
        self.text.follow(sight);
        let beside = self.page().has_program().then(|| self.text.window(sight, LINES));
        (self.page().window(sight), beside)
    }

    pub fn dialogue(&self, sight: &Sight<'_>) -> Dialogue {
        let prompt = self.page().prompt(sight);
        Dialogue {
            open: !prompt.is_empty(),
            entry: self.entry.clone(),
            prompt,
        }
    }

    pub fn soft_keys(&self, sight: &Sight<'_>) -> SoftKeys {
        let pages = [
            sight.words("POSITIONS"),
            sight.words("PROGRAM"),
            sight.words("PARAMETERS"),
            sight.words("ZERO POINTS"),
            sight.words("TOOLS"),
            sight.words("MESSAGES"),
        ];
        let keys = pages.into_iter().chain(self.page().soft_keys(sight));
        SoftKeys {
            keys: keys.map(str::to_owned).collect(),
            row: 0,
            rows: 1,
        }
    }

    /// A key of the keyboard; `None` when it has no such key.
    pub fn key(&mut self, name: &str, desk: &mut Desk<'_>) -> Option<Result<(), Refusal>> {
        let arrow = match name {
            "UP" => Some(Arrow::Up),
            "DOWN" => Some(Arrow::Down),
            "LEFT" => Some(Arrow::Left),
            "RIGHT" => Some(Arrow::Right),
            _ => None,
        };
        let done = if let Some(arrow) = arrow {
            self.page_mut().go(arrow, &desk.sight());
            Ok(())
        } else if let Some(typed) = keys::character(name) {
            self.type_in(typed, &desk.sight())
        } else {
            self.other_key(name, desk)?
        };
        self.note = done.as_ref().err().map(|refusal| refusal.0.clone());
        Some(done)
    }

    fn other_key(&mut self, name: &str, desk: &mut Desk<'_>) -> Option<Result<(), Refusal>> {
        let soft = name
            .strip_prefix("SK")
            .and_then(|number| number.parse::<usize>().ok());
        Some(match (name, soft) {
            (_, Some(number @ 1..=PAGES)) => {
                self.front = number - 1;
                self.entry.clear();
                Ok(())
            }
            (_, Some(number @ 7..=8)) => self.page_mut().soft_key(number - 7, desk),
            ("ENT", _) => self.enter(desk),
            ("CE", _) => {
                self.entry.clear();
                Ok(())
            }
            ("BACK", _) => {
                self.entry.pop();
                Ok(())
            }
            ("CHANNEL", _) => {
                self.show(self.channel % desk.host.control().channels() + 1);
                Ok(())
            }
            _ => {
                let number = (1..).zip(CHANNELS).find(|(_, channel)| *channel == name)?.0;
                if number > desk.host.control().channels() {
                    return Some(Err(Refusal(format!("there is no channel {number}"))));
                }
                self.show(number);
                Ok(())
            }
        })
    }

    /// Another channel is shown.
    fn show(&mut self, channel: u8) {
        self.channel = channel;
        self.entry.clear();
    }

    /// A line of text at once.
    pub fn text(&mut self, text: &str, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let typed = self.type_in(text.trim_end_matches(['\n', '\r']), &desk.sight());
        self.note = typed.as_ref().err().map(|refusal| refusal.0.clone());
        typed
    }

    fn type_in(&mut self, typed: &str, sight: &Sight<'_>) -> Result<(), Refusal> {
        if self.page().prompt(sight).is_empty() {
            return Err(Refusal(sight.words("nothing is entered here").to_owned()));
        }
        if self.entry.chars().count() + typed.chars().count() > ENTRY_MAX || typed.contains(char::is_control)
        {
            return Err(Refusal(sight.words("the line takes no more").to_owned()));
        }
        self.entry += typed;
        Ok(())
    }

    /// What was typed is taken; a faulty entry stays.
    fn enter(&mut self, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        let entry = std::mem::take(&mut self.entry);
        let done = self.page_mut().enter(&entry, desk);
        if done.is_err() {
            self.entry = entry;
        }
        done
    }
}
