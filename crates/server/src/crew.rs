//! Who looks at a station, and who of them operates.

use std::collections::HashMap;
use std::sync::Arc;

/// A name that a viewer gave himself.
pub(crate) type Name = String;

/// The viewers of a station.
#[derive(Debug, Default)]
pub(crate) struct Crew {
    viewers: HashMap<Name, Viewer>,
    operator: Option<Name>,
    /// Who wants to operate.
    asks: Option<Name>,
    /// Counts the connections that went.
    gone: u64,
}

#[derive(Debug, Default)]
struct Viewer {
    /// Connections of this name: a page that reconnects may have two for a moment.
    connections: u32,
    /// The last of his inputs that was taken.
    taken: u64,
    /// When his last connection went: the count of those that had gone then.
    went: u64,
    /// Held while one of his inputs is done: what his old connection brought comes before what his new one brings.
    order: Arc<tokio::sync::Mutex<()>>,
}

/// Names that are remembered, so that inputs are taken once: with a connection all, without one those that went last.
const REMEMBERED: usize = 64;

impl Crew {
    /// Somebody has come; he operates when nobody else is there who does. The number of his last input that was taken.
    pub fn come(&mut self, name: &str) -> u64 {
        if self.viewers.len() >= REMEMBERED && !self.viewers.contains_key(name) {
            self.forget_one();
        }
        let viewer = self.viewers.entry(name.to_owned()).or_default();
        viewer.connections += 1;
        let taken = viewer.taken;
        let operator = self.operator.as_deref();
        if !operator.is_some_and(|operator| self.is_there(operator)) {
            self.operator = Some(name.to_owned());
        }
        taken
    }

    /// Forgets who has been away longest.
    fn forget_one(&mut self) {
        let away = self.viewers.iter().filter(|(_, viewer)| viewer.connections == 0);
        let longest = away.min_by_key(|(_, viewer)| viewer.went);
        if let Some(name) = longest.map(|(name, _)| name.clone()) {
            self.viewers.remove(&name);
        }
    }

    /// A connection has gone. Whoever operates keeps the keys until somebody else comes or wants them.
    pub fn go(&mut self, name: &str) {
        if let Some(viewer) = self.viewers.get_mut(name) {
            viewer.connections = viewer.connections.saturating_sub(1);
            self.gone += 1;
            viewer.went = self.gone;
        }
        if self.asks.as_deref() == Some(name) && !self.is_there(name) {
            self.asks = None;
        }
    }

    /// What is held while an input of somebody is judged and done.
    pub fn order(&mut self, name: &str) -> Arc<tokio::sync::Mutex<()>> {
        Arc::clone(&self.viewers.entry(name.to_owned()).or_default().order)
    }

    /// An input with its number: whether it is new, and his to give.
    pub fn takes(&mut self, name: &str, number: u64) -> Taking {
        let Some(viewer) = self.viewers.get_mut(name) else {
            return Taking::NotOperator;
        };
        if number <= viewer.taken {
            return Taking::Twice;
        }
        viewer.taken = number;
        match self.operator.as_deref() == Some(name) {
            true => Taking::New,
            false => Taking::NotOperator,
        }
    }

    /// Somebody wants to operate: he does at once when the operator has gone.
    pub fn ask(&mut self, name: &str) {
        let there = self
            .operator
            .as_deref()
            .is_some_and(|operator| self.is_there(operator));
        match there && self.operator.as_deref() != Some(name) {
            true => self.asks = Some(name.to_owned()),
            false => self.operator = Some(name.to_owned()),
        }
    }

    /// The operator hands over to whoever asks, or refuses him.
    pub fn answer(&mut self, name: &str, yes: bool) {
        if self.operator.as_deref() == Some(name)
            && let Some(next) = self.asks.take()
            && yes
        {
            self.operator = Some(next);
        }
    }

    /// Who operates, and who asks.
    pub fn roles(&self) -> (Option<&str>, Option<&str>) {
        (self.operator.as_deref(), self.asks.as_deref())
    }

    fn is_there(&self, name: &str) -> bool {
        self.viewers
            .get(name)
            .is_some_and(|viewer| viewer.connections > 0)
    }
}

/// What becomes of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Taking {
    /// It is done.
    New,
    /// It was done before its connection broke.
    Twice,
    /// Somebody else operates.
    NotOperator,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_operates_and_hands_over() {
        let mut crew = Crew::default();
        assert_eq!((crew.come("anna"), crew.come("ben")), (0, 0));
        assert_eq!(crew.takes("anna", 1), Taking::New);
        assert_eq!(crew.takes("ben", 1), Taking::NotOperator);
        crew.ask("ben");
        assert_eq!(crew.roles(), (Some("anna"), Some("ben")));
        crew.answer("ben", true);
        assert_eq!(crew.roles().0, Some("anna"), "nobody helps himself");
        crew.answer("anna", true);
        assert_eq!(crew.roles(), (Some("ben"), None));
        assert_eq!(crew.takes("ben", 2), Taking::New);
    }

    #[test]
    fn whoever_went_last_is_remembered_however_many_names_there_are() {
        let mut crew = Crew::default();
        let visit = |crew: &mut Crew, name: &str, number: u64| {
            let taken = crew.come(name);
            crew.takes(name, number);
            crew.go(name);
            taken
        };
        for number in 0..500 {
            visit(&mut crew, &format!("viewer-{number}"), 3);
        }
        visit(&mut crew, "anna", 7);
        // Her connection is lost; before it comes back others look on, by half of all names.
        for number in 0..REMEMBERED / 2 {
            visit(&mut crew, &format!("other-{number}"), 3);
            assert!(crew.viewers.len() <= REMEMBERED, "{}", crew.viewers.len());
        }
        assert_eq!(crew.come("anna"), 7);
        assert_eq!(crew.takes("anna", 7), Taking::Twice);
        // Who is there is never forgotten.
        for number in 0..500 {
            visit(&mut crew, &format!("more-{number}"), 3);
        }
        assert_eq!(crew.takes("anna", 7), Taking::Twice);
        assert_eq!(visit(&mut crew, "viewer-0", 3), 0, "long ago");
    }

    #[test]
    fn no_input_is_taken_twice_or_lost_when_a_connection_breaks() {
        let mut crew = Crew::default();
        crew.come("anna");
        assert_eq!(crew.takes("anna", 1), Taking::New);
        crew.go("anna");
        // She does not know whether 1 arrived, and sends it again.
        assert_eq!(crew.come("anna"), 1);
        assert_eq!(crew.takes("anna", 1), Taking::Twice);
        assert_eq!(crew.takes("anna", 2), Taking::New);
        // Who looks on while she loads the page anew does not get the keys; who comes when she is away does.
        crew.come("ben");
        crew.go("anna");
        crew.come("anna");
        assert_eq!(crew.roles().0, Some("anna"));
        crew.go("anna");
        crew.come("carl");
        assert_eq!(crew.roles().0, Some("carl"));
    }
}
