//! What happens at the data interfaces.

use std::sync::mpsc::{Receiver, channel};

use super::Station;
use crate::pages::{self, runs};
use crate::texts;
use crate::transfer::{TransferFiles, TransferNews, TransferOrder};

impl Station {
    /// Where what the operator wants of the data interfaces arrives from now on. Who takes it says
    /// [`Input::Transfer`](crate::Input::Transfer) with `connected 0` or `connected 1`, and then what happens.
    pub fn transfer_orders(&mut self) -> Receiver<TransferOrder> {
        let (sender, orders) = channel();
        self.transfers.connect(sender);
        orders
    }

    pub(super) fn transfer_news(&mut self, news: &TransferNews) {
        let backup = self.transfers.files() == Some(TransferFiles::Backup);
        let reads = self.transfers.reads().is_some();
        self.transfers.news(news.clone());
        match news {
            TransferNews::Message(text) => {
                let text = texts::translate(self.language(), text);
                self.console.say(text);
            }
            TransferNews::Received(_) => self.programs.was_written(),
            TransferNews::Ended(complete) if backup => self.backup_ended(*complete && reads),
            // Nobody replaces a program while it runs.
            TransferNews::Overread(name) if runs(name, &self.parts().1) => {
                self.transfers.answer(false);
                let words = texts::words(self.language(), "BACKGROUND PROGRAMMING NOT POSSIBLE");
                self.console.say(format!("{name}: {words}"));
            }
            _ => {}
        }
    }

    /// A backup was read out, or read in: the machine becomes what it was then.
    fn backup_ended(&mut self, restores: bool) {
        let restored = restores.then(|| pages::restored(&self.parts().1));
        pages::backup_ended(&mut self.parts().1);
        match restored {
            Some(Ok(restore)) => {
                // What the control keeps is not written over what is restored.
                self.host.release_state();
                match restore.commit() {
                    Ok(_) => self.load_anew(),
                    Err(error) => self.console.say(error.to_string()),
                }
            }
            Some(Err(why)) => self.console.say(why),
            None => {}
        }
    }
}
