//! MESSAGES: what is pending and what was, with the Info text of the one at the cursor [002:3330-3420].

use bahn_control900::Message;
use bahn_live::Refusal;
use bahn_screen::texts::filled;
use bahn_screen::{Line, Mark, Window, WindowKind};
use bahn_system900::{ChannelParameter, Message as Held, MessageKind, named_message};

use super::{Arrow, LINES, Page};
use crate::sight::{Desk, Sight};

/// Where the cursor is, and whether the Info text is shown.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Messages {
    row: usize,
    info: bool,
}

/// Pending ones first, the newest first among each.
fn all<'a>(sight: &Sight<'a>) -> Vec<&'a Message> {
    let newest = || sight.control().messages().iter().rev();
    let pending = newest().filter(|message| message.acknowledged_us.is_none());
    pending
        .chain(newest().filter(|message| message.acknowledged_us.is_some()))
        .collect()
}

/// As it stands in the header.
pub(crate) fn in_words(message: &Message) -> String {
    message.to_string()
}

impl Messages {
    fn at<'a>(self, sight: &Sight<'a>) -> Option<&'a Message> {
        let all = all(sight);
        all.get(self.row.min(all.len().saturating_sub(1))).copied()
    }

    fn info(self, sight: &Sight<'_>) -> Vec<String> {
        let Some(message) = self.at(sight) else {
            return vec![sight.words("There was no message.").to_owned()];
        };
        let mut lines = vec![in_words(message)];
        let kinds = MessageKind::ALL.into_iter();
        if let Some(kind) = kinds.clone().find(|kind| kind.id() == message.kind.id()) {
            lines.push(kind.words().to_owned());
        }
        if let Some(named) = named_message(&message.number.to_string()) {
            lines.extend([named.title, named.cause, named.remedy, named.source].map(str::to_owned));
        }
        // The parameters of the channel are those of the message that came last.
        let held = kinds.filter_map(|kind| Held::of(sight.memory(), message.channel, kind));
        let held = held.filter(|held| u32::from(held.number) == message.number);
        for (place, number) in held.flat_map(|held| (1..).zip(held.information)) {
            lines.extend(number.map(|number| format!("Info{place}: {number}")));
        }
        lines
    }
}

impl Page for Messages {
    fn window(&self, sight: &Sight<'_>) -> Window {
        if self.info {
            return super::text_window(sight.words("INFO").to_owned(), self.info(sight));
        }
        let all = all(sight);
        let row = self.row.min(all.len().saturating_sub(1));
        let first = row.saturating_sub(LINES / 2).min(all.len().saturating_sub(LINES));
        let line = |(place, message): (usize, &&Message)| {
            let text = format!(
                "{:>9.2} s  {:<7} {message}",
                message.time_us as f64 / 1e6,
                message.kind.id()
            );
            let length = text.chars().count();
            let quiet = message.acknowledged_us.is_some();
            Line {
                text,
                current: place == row,
                marks: if quiet {
                    vec![(0, length, Mark::Quiet)]
                } else {
                    Vec::new()
                },
            }
        };
        let pending = all
            .iter()
            .filter(|message| message.acknowledged_us.is_none())
            .count();
        let counts = [pending, all.len() - pending].map(|count| count.to_string());
        let [pending, past] = counts.each_ref().map(String::as_str);
        Window {
            title: filled(
                sight.words("MESSAGES, {1} PENDING, {2} ACKNOWLEDGED"),
                &[pending, past],
            ),
            kind: WindowKind::List,
            lines: all.iter().enumerate().skip(first).take(LINES).map(line).collect(),
            first,
            total: all.len(),
        }
    }

    fn prompt(&self, _: &Sight<'_>) -> String {
        String::new()
    }

    fn soft_keys(&self, sight: &Sight<'_>) -> [&'static str; 2] {
        let info = match self.info {
            true => sight.words("LIST"),
            false => sight.words("INFO"),
        };
        [sight.words("ACKNOWLEDGE"), info]
    }

    fn soft_key(&mut self, which: usize, desk: &mut Desk<'_>) -> Result<(), Refusal> {
        if which == 1 {
            self.info = !self.info;
            return Ok(());
        }
        // Of the channel of the message, wherever it is looked at.
        let channel = self.at(&desk.sight()).map(|message| message.channel);
        let own = desk.channel;
        desk.channel = channel.unwrap_or(own);
        let done = desk.press(ChannelParameter::Acknowledge, "1");
        desk.channel = own;
        done
    }

    fn go(&mut self, arrow: Arrow, sight: &Sight<'_>) {
        let last = all(sight).len().saturating_sub(1);
        match arrow {
            Arrow::Up => self.row = self.row.min(last).saturating_sub(1),
            Arrow::Down => self.row = (self.row + 1).min(last),
            Arrow::Left | Arrow::Right => {}
        }
    }

    fn enter(&mut self, _: &str, _: &mut Desk<'_>) -> Result<(), Refusal> {
        self.info = !self.info;
        Ok(())
    }
}
