//! A data transfer that the operator has begun: what has come and gone, what is asked, how it ends [003:6880-6930].

use bahn_dialogue::Key;
use bahn_live::TransferNews;
use bahn_parameters::MessageId;
use bahn_screen::{Dialogue, Line, WindowKind};

use crate::page::{Page, Turn, View};
use crate::pages::list;
use crate::pages::order::order;
use crate::site::Site;
use crate::transfer::{TransferAction, TransferFiles};

/// Begins a transfer of programs and shows it.
pub(crate) fn begin(action: TransferAction, site: &mut Site) -> Turn {
    begin_with(TransferFiles::Programs, action, site)
}

/// The same with other files.
pub(crate) fn begin_with(files: TransferFiles, action: TransferAction, site: &mut Site) -> Turn {
    if matches!(&action, TransferAction::Write(names) | TransferAction::WriteOffered(names) if names.is_empty())
    {
        return Turn::Say(site.message(MessageId::ProgramNotFound));
    }
    let begun = order(files, action, site).and_then(|order| site.transfers.begin(order));
    match begun {
        Ok(()) => show(),
        Err(message) => Turn::Say(site.message(message)),
    }
}

/// The transfer that is under way.
pub(crate) fn show() -> Turn {
    Turn::Open(Box::new(Transfer::default()))
}

/// A transfer that is under way, or over: what has come and gone, and what is asked.
#[derive(Default)]
struct Transfer {
    current: usize,
}

impl Transfer {
    /// The name at the cursor, where it is one on the medium of the device.
    fn listed(&self, site: &Site) -> Option<String> {
        match site.transfers.reported.get(self.current) {
            Some(TransferNews::Listed(name, _)) => Some(name.clone()),
            _ => None,
        }
    }
}

impl Page for Transfer {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        let done = |taken: bool| if taken { Turn::Done } else { Turn::Refused };
        if let Some(lines) = list::way_of_key(key) {
            self.current = list::moved(self.current, lines, site.transfers.reported.len());
            return Turn::Done;
        }
        match (key, site.transfers.is_running()) {
            (Key::Ent | Key::NoEnt, true) => done(site.transfers.answer(key == Key::Ent)),
            (Key::End, true) => done(site.transfers.end()),
            // A program of the directory is read in.
            (Key::Ent, false) => match self.listed(site) {
                Some(name) => {
                    let files = site.transfers.last_files();
                    let name = match files {
                        TransferFiles::Programs => site.with_ending(&name),
                        _ => name,
                    };
                    match begin_with(files, TransferAction::Read(name), site) {
                        Turn::Open(page) => Turn::Replace(page),
                        other => other,
                    }
                }
                None => Turn::Close,
            },
            (Key::NoEnt | Key::End | Key::Del | Key::Ext, false) => Turn::Close,
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        let asks = site.transfers.question.is_some();
        let read = !site.transfers.is_running() && self.listed(site).is_some();
        let first = match (asks, read) {
            (true, _) => "ENT".to_owned(),
            (false, true) => site.words("READ-IN"),
            _ => String::new(),
        };
        let second = if asks { "NO ENT" } else { "" };
        vec![vec![first, second.to_owned(), site.words("END")]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        let key = [Key::Ent, Key::NoEnt].get(place).copied();
        self.key(key.unwrap_or(Key::End), site)
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        let reported = &site.transfers.reported;
        let line = |place: usize| Line {
            text: reported
                .get(place)
                .map_or_else(String::new, |news| text_of(news, site)),
            current: place == self.current,
            ..Line::default()
        };
        let prompt = match (&site.transfers.question, site.transfers.is_running()) {
            (Some(question), _) => text_of(question, site),
            (None, true) => site.words("DATA TRANSFER RUNS: END BREAKS IT OFF"),
            (None, false) => site.words("DATA TRANSFER HAS ENDED"),
        };
        let title = site.words("EXTERNAL DATA TRANSFER");
        View {
            window: Some(list::window(
                title,
                WindowKind::List,
                (self.current, reported.len()),
                lines,
                line,
            )),
            dialogue: Dialogue {
                prompt,
                ..Dialogue::default()
            },
        }
    }
}

/// News as a line of the window, or as a question.
fn text_of(news: &TransferNews, site: &Site) -> String {
    let after = |name: &String, words| format!("{name}  {}", site.words(words));
    let asked =
        |words, name: &String, answers| format!("{} {name}: {}", site.words(words), site.words(answers));
    match news {
        TransferNews::Connected(_) => String::new(),
        TransferNews::Listed(name, Some(sectors)) => format!("{name:<20}{sectors:>6}"),
        TransferNews::Listed(name, None) => name.clone(),
        TransferNews::Free(sectors) => format!("FREE: {sectors}"),
        TransferNews::Received(name) => after(name, "READ IN"),
        TransferNews::Sent(name) => after(name, "READ OUT"),
        TransferNews::Overread(name) => asked("ERASE/OVERREAD", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Offered(name) => asked("READ-IN", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Output(name) => asked("READ-OUT", name, "YES = ENT / NO = NO ENT"),
        TransferNews::Protected(name) => asked("PROTECTED PGM", name, "CONTINUE = ENT / END = NO ENT"),
        TransferNews::Message(text) => bahn_screen::texts::translate(site.language(), text),
        TransferNews::Complete => site.words("COMPLETE"),
        TransferNews::Incomplete => site.words("NOT COMPLETE"),
    }
}
