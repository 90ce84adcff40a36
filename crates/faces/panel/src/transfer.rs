//! The data interfaces as the panel has them: what the operator wants of them goes out as orders, what happens comes back
//! as inputs. Whoever has the lines knows the protocols; nothing here does.

use std::sync::mpsc::Sender;

use bahn_live::TransferNews;
use bahn_parameters::MessageId;
use bahn_parameters::interfaces::Mode;

/// Lines of what has happened that are kept at most.
const REPORTED_MAX: usize = 1000;

/// What the operator wants of an interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TransferOrder {
    /// RS-232-C/V.24 is 0, RS-422/V.11 is 1.
    pub port: usize,
    /// The device that MOD says is connected.
    pub mode: Mode,
    /// Data transfer rate of the interface, baud.
    pub baud: u32,
    /// Which programs are read in where no name says it, by their ending: `H` or `I`, as PROGRAM INPUT says.
    pub kind: &'static str,
    /// The kind of files that are transferred.
    pub files: TransferFiles,
    /// What is to be done.
    pub action: TransferAction,
}

/// The files that are transferred.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransferFiles {
    /// Programs and tables, of PROGRAMMING AND EDITING.
    #[default]
    Programs,
    /// Lists of machine parameters, of their editor [000:10011].
    Lists,
    /// Files of the PLC, of PLC PROGRAMMING [000:3867-3869] [000:11386-11390].
    Plc,
    /// The one file with everything, of BACKUP DATA and RESTORE DATA [000:465-467].
    Backup,
}

impl TransferFiles {
    /// The types of these files by their endings, where they are in a folder in which there are others, too
    /// [000:16895-16913].
    pub fn extensions(self) -> Option<&'static [&'static str]> {
        match self {
            TransferFiles::Programs | TransferFiles::Backup => None,
            TransferFiles::Lists => Some(&["MP"]),
            TransferFiles::Plc => Some(&["PLC", "CMA", "COM", "HLP", "A", "ER1", "ERE", "DI1", "DIE"]),
        }
    }

    /// The type of a file where its name says none.
    pub(crate) fn usual(self, iso: bool) -> &'static str {
        match self {
            TransferFiles::Programs if iso => "I",
            TransferFiles::Programs => "H",
            TransferFiles::Lists => "MP",
            TransferFiles::Plc => "PLC",
            TransferFiles::Backup => "A",
        }
    }
}

/// What is to be done at an interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TransferAction {
    /// PROGRAM DIRECTORY: the names on the medium.
    Directory,
    /// READ-IN ALL PROGRAMS: every program of the medium.
    ReadAll,
    /// READ-IN PROGRAM OFFERED: each after a question.
    ReadOffered,
    /// READ-IN SELECTED PROGRAM, by its name.
    Read(String),
    /// READ-OUT, one or several.
    Write(Vec<String>),
    /// The same, each after a question.
    WriteOffered(Vec<String>),
    /// ENT or NO ENT to a question.
    Answer(bool),
    /// END breaks it off.
    End,
}

/// What stands between the panel and the interfaces.
#[derive(Default)]
pub(crate) struct Transfers {
    /// Where orders go. In a session that is shown again nobody takes them, and its news come all the same.
    orders: Option<Sender<TransferOrder>>,
    connected: [bool; 2],
    /// The order that is being carried out.
    running: Option<TransferOrder>,
    /// The files of the order that was carried out last.
    last: TransferFiles,
    /// What waits for an answer.
    pub question: Option<TransferNews>,
    /// What has happened since the transfer began.
    pub reported: Vec<TransferNews>,
}

impl Transfers {
    /// Orders go there from now on.
    pub fn connect(&mut self, orders: Sender<TransferOrder>) {
        self.orders = Some(orders);
    }

    /// A transfer is under way.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Begins a transfer.
    ///
    /// # Errors
    /// The message of the control: one is under way already, or nothing is connected.
    pub fn begin(&mut self, order: TransferOrder) -> Result<(), MessageId> {
        if self.is_running() {
            return Err(MessageId::InterfaceAlreadyAssigned);
        }
        if self.connected.get(order.port) != Some(&true) || !self.send(&order) {
            return Err(MessageId::ExtInOutputNotReady);
        }
        self.reported.clear();
        self.question = None;
        self.last = order.files;
        self.running = Some(order);
        Ok(())
    }

    /// The operator answers; `false` when nothing is asked.
    pub fn answer(&mut self, yes: bool) -> bool {
        self.question.take().is_some() && self.goes_on(TransferAction::Answer(yes))
    }

    /// END breaks it off; what is said of it comes as news.
    pub fn end(&mut self) -> bool {
        self.goes_on(TransferAction::End)
    }

    fn goes_on(&mut self, action: TransferAction) -> bool {
        let Some(running) = self.running.clone() else {
            return false;
        };
        self.send(&TransferOrder { action, ..running })
    }

    /// `false` when whoever took the orders is not there any more.
    fn send(&self, order: &TransferOrder) -> bool {
        let orders = self.orders.as_ref();
        orders.is_none_or(|orders| orders.send(order.clone()).is_ok())
    }

    /// The files of the order that was carried out last.
    pub fn last_files(&self) -> TransferFiles {
        self.last
    }

    /// The files of the order that is being carried out.
    pub fn files(&self) -> Option<TransferFiles> {
        self.running.as_ref().map(|order| order.files)
    }

    /// What the order that is being carried out reads.
    pub fn reads(&self) -> Option<&str> {
        match &self.running.as_ref()?.action {
            TransferAction::Read(name) => Some(name),
            _ => None,
        }
    }

    /// Takes what has come of the transfer.
    pub fn news(&mut self, news: TransferNews) {
        match news {
            TransferNews::Connected(port) => {
                if let Some(connected) = self.connected.get_mut(port) {
                    *connected = true;
                }
                return;
            }
            TransferNews::Complete | TransferNews::Incomplete => {
                self.running = None;
                self.question = None;
            }
            TransferNews::Overread(_)
            | TransferNews::Offered(_)
            | TransferNews::Output(_)
            | TransferNews::Protected(_) => {
                self.question = Some(news);
                return;
            }
            _ => {}
        }
        if self.reported.len() < REPORTED_MAX {
            self.reported.push(news);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_transfer_at_a_time_and_only_where_something_is_connected() {
        let (sender, orders) = std::sync::mpsc::channel();
        let mut transfers = Transfers::default();
        transfers.connect(sender);
        let order = |port| TransferOrder {
            port,
            mode: Mode::Fe1,
            baud: 9600,
            kind: "H",
            files: TransferFiles::Programs,
            action: TransferAction::ReadAll,
        };
        assert_eq!(transfers.begin(order(0)), Err(MessageId::ExtInOutputNotReady));
        transfers.news(TransferNews::Connected(0));
        assert_eq!(transfers.begin(order(1)), Err(MessageId::ExtInOutputNotReady));
        assert!(!transfers.answer(true) && !transfers.end());
        assert_eq!(transfers.begin(order(0)), Ok(()));
        assert_eq!(
            transfers.begin(order(0)),
            Err(MessageId::InterfaceAlreadyAssigned)
        );
        transfers.news(TransferNews::Overread("1.H".to_owned()));
        assert!(transfers.answer(false) && !transfers.answer(false) && transfers.end());
        transfers.news(TransferNews::Incomplete);
        assert!(!transfers.is_running());
        let actions: Vec<_> = orders.try_iter().map(|order| order.action).collect();
        let ordered = [
            TransferAction::ReadAll,
            TransferAction::Answer(false),
            TransferAction::End,
        ];
        assert_eq!(actions, ordered);
        // Whoever had the lines has gone.
        drop(orders);
        assert_eq!(transfers.begin(order(0)), Err(MessageId::ExtInOutputNotReady));
    }
}
