//! What happens at the data interfaces.

use bahn_host::backup::Restore;
use bahn_live::TransferNews;
use bahn_screen::texts::{self, Language};

use crate::console::Console;
use crate::pages::{self, runs};
use crate::site::Site;
use crate::transfer::TransferFiles;

/// Takes what has happened, and says what the operator is to know of it. A backup that was read in is what the machine
/// becomes again.
pub(super) fn take(
    news: &TransferNews,
    language: Language,
    console: &mut Console,
    site: &mut Site<'_>,
) -> Option<Restore> {
    let backup = site.transfers.files() == Some(TransferFiles::Backup);
    let reads = site.transfers.reads().is_some();
    site.transfers.news(news.clone());
    match news {
        TransferNews::Message(text) => console.say(texts::translate(language, text)),
        TransferNews::Received(_) => site.programs.was_written(),
        TransferNews::Complete | TransferNews::Incomplete if backup => {
            let restored = (*news == TransferNews::Complete && reads).then(|| pages::restored(site));
            pages::backup_ended(site);
            return restored?.map_err(|why| console.say(why)).ok();
        }
        // Nobody replaces a program while it runs.
        TransferNews::Overread(name) if runs(name, site.control()) => {
            site.transfers.answer(false);
            let words = texts::words(language, "BACKGROUND PROGRAMMING NOT POSSIBLE");
            console.say(format!("{name}: {words}"));
        }
        _ => {}
    }
    None
}
