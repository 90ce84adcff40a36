//! What happens at the data interfaces.

use std::sync::mpsc::{Receiver, channel};

use super::Station;
use crate::pages::runs;
use crate::texts;
use crate::transfer::{TransferNews, TransferOrder};

impl Station {
    /// Where what the operator wants of the data interfaces arrives from now on. Who takes it says
    /// [`Input::Transfer`](crate::Input::Transfer) with `connected 0` or `connected 1`, and then what happens.
    pub fn transfer_orders(&mut self) -> Receiver<TransferOrder> {
        let (sender, orders) = channel();
        self.transfers.connect(sender);
        orders
    }

    pub(super) fn transfer_news(&mut self, news: &TransferNews) {
        self.transfers.news(news.clone());
        match news {
            TransferNews::Message(text) => {
                let text = texts::translate(self.language(), text);
                self.console.say(text);
            }
            TransferNews::Received(_) => self.programs.was_written(),
            // Nobody replaces a program while it runs.
            TransferNews::Overread(name) if runs(name, &self.parts().1) => {
                self.transfers.answer(false);
                let words = texts::words(self.language(), "BACKGROUND PROGRAMMING NOT POSSIBLE");
                self.console.say(format!("{name}: {words}"));
            }
            _ => {}
        }
    }
}
