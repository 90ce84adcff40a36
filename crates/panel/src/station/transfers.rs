//! What happens at the data interfaces.

use crate::console::Console;
use crate::pages::runs;
use crate::site::Site;
use crate::texts::{self, Language};
use crate::transfer::TransferNews;

/// Takes what has happened, and says what the operator is to know of it.
pub(super) fn take(news: &TransferNews, language: Language, console: &mut Console, site: &mut Site<'_>) {
    site.transfers.news(news.clone());
    match news {
        TransferNews::Message(text) => console.say(texts::translate(language, text)),
        TransferNews::Received(_) => site.programs.was_written(),
        // Nobody replaces a program while it runs.
        TransferNews::Overread(name) if runs(name, site) => {
            site.transfers.answer(false);
            let words = texts::words(language, "BACKGROUND PROGRAMMING NOT POSSIBLE");
            console.say(format!("{name}: {words}"));
        }
        _ => {}
    }
}
