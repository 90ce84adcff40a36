//! Who looks at a station, and who of them operates.
//!
//! Decision: A viewer is who knows his key, which his page makes; a name is shown and proves nothing

use std::collections::HashMap;
use std::sync::Arc;

use bahn_service::Role;

/// Who somebody is: the key that his page made and tells nobody else; a name is no proof.
pub(crate) type Id = String;

/// The viewers of a station.
#[derive(Debug, Default)]
pub(crate) struct Crew {
    viewers: HashMap<Id, Viewer>,
    operator: Option<Id>,
    /// Who wants to operate.
    asks: Option<Id>,
    /// Counts the connections that went.
    gone: u64,
}

#[derive(Debug)]
struct Viewer {
    /// What he calls himself.
    name: String,
    role: Role,
    /// Connections of his: a page that reconnects may have two for a moment.
    connections: u32,
    /// The last of his inputs that was taken.
    taken: u64,
    /// When his last connection went: the count of those that had gone then.
    went: u64,
    /// Held while one of his inputs is done: what his old connection brought comes before what his new one brings.
    order: Arc<tokio::sync::Mutex<()>>,
}

/// Who is remembered, so that inputs are taken once: with a connection all, without one those that went last.
const REMEMBERED: usize = 64;

impl Crew {
    /// Somebody has come; he operates when he may and nobody else is there who does. The number of his last input that
    /// was taken.
    pub fn come(&mut self, id: &str, name: &str, role: Role) -> u64 {
        if self.viewers.len() >= REMEMBERED && !self.viewers.contains_key(id) {
            self.forget_one();
        }
        let viewer = self.viewers.entry(id.to_owned()).or_insert_with(|| Viewer {
            name: String::new(),
            role,
            connections: 0,
            taken: 0,
            went: 0,
            order: Arc::default(),
        });
        name.clone_into(&mut viewer.name);
        viewer.role = role;
        viewer.connections += 1;
        let taken = viewer.taken;
        if self.may(id) && !self.somebody_operates() {
            self.operator = Some(id.to_owned());
        }
        taken
    }

    /// Forgets who has been away longest.
    fn forget_one(&mut self) {
        let away = self.viewers.iter().filter(|(_, viewer)| viewer.connections == 0);
        let longest = away.min_by_key(|(_, viewer)| viewer.went);
        if let Some(id) = longest.map(|(id, _)| id.clone()) {
            self.forget(&id);
        }
    }

    /// He is nobody who was here before when he comes again.
    pub fn forget(&mut self, id: &str) {
        if !self.is_there(id) {
            self.viewers.remove(id);
        }
    }

    /// A connection has gone. Whoever operates keeps the keys until somebody else comes or wants them.
    pub fn go(&mut self, id: &str) {
        if let Some(viewer) = self.viewers.get_mut(id) {
            viewer.connections = viewer.connections.saturating_sub(1);
            self.gone += 1;
            viewer.went = self.gone;
        }
        if self.asks.as_deref() == Some(id) && !self.is_there(id) {
            self.asks = None;
        }
    }

    /// What is held while an input of somebody is judged and done.
    pub fn order(&self, id: &str) -> Arc<tokio::sync::Mutex<()>> {
        let viewer = self.viewers.get(id);
        viewer.map(|viewer| Arc::clone(&viewer.order)).unwrap_or_default()
    }

    /// An input with its number: whether it is new, and his to give.
    pub fn takes(&mut self, id: &str, number: u64) -> Taking {
        let Some(viewer) = self.viewers.get_mut(id) else {
            return Taking::NotOperator;
        };
        if number <= viewer.taken {
            return Taking::Twice;
        }
        viewer.taken = number;
        match (viewer.role, self.operator.as_deref() == Some(id)) {
            (Role::Look, _) => Taking::Looks,
            (Role::Operate, true) => Taking::New,
            (Role::Operate, false) => Taking::NotOperator,
        }
    }

    /// Somebody wants to operate: he does at once when the operator has gone.
    pub fn ask(&mut self, id: &str) {
        if !self.may(id) {
            return;
        }
        match self.somebody_operates() && self.operator.as_deref() != Some(id) {
            true => self.asks = Some(id.to_owned()),
            false => self.operator = Some(id.to_owned()),
        }
    }

    /// The operator hands over to whoever asks, or refuses him.
    pub fn answer(&mut self, id: &str, yes: bool) {
        if self.operator.as_deref() == Some(id)
            && self.may(id)
            && let Some(next) = self.asks.take()
            && yes
        {
            self.operator = Some(next);
        }
    }

    /// Whether this viewer operates.
    pub fn is_operator(&self, id: &str) -> bool {
        self.operator.as_deref() == Some(id) && self.may(id)
    }

    /// Names of who operates and who asks.
    pub fn names(&self) -> (Option<&str>, Option<&str>) {
        let name = |id: &Option<Id>| Some(self.viewers.get(id.as_ref()?)?.name.as_str());
        (name(&self.operator), name(&self.asks))
    }

    /// He is known, and may operate.
    fn may(&self, id: &str) -> bool {
        self.viewers
            .get(id)
            .is_some_and(|viewer| viewer.role == Role::Operate)
    }

    /// The operator is there, and still may.
    fn somebody_operates(&self) -> bool {
        let operator = self.operator.as_deref();
        operator.is_some_and(|operator| self.is_there(operator) && self.may(operator))
    }

    fn is_there(&self, id: &str) -> bool {
        self.viewers.get(id).is_some_and(|viewer| viewer.connections > 0)
    }
}

/// What becomes of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Taking {
    /// The input is new: it is done.
    New,
    /// It was done before its connection broke.
    Twice,
    /// Another viewer has the operating panel.
    NotOperator,
    /// He may only look.
    Looks,
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Crew {
        /// Somebody who may operate, with a key that is his name.
        fn comes(&mut self, name: &str) -> u64 {
            self.come(name, name, Role::Operate)
        }
    }

    #[test]
    fn who_may_only_look_never_operates() {
        let mut crew = Crew::default();
        crew.come("1", "anna", Role::Look);
        assert_eq!(crew.names(), (None, None), "also when nobody else is there");
        crew.ask("1");
        crew.answer("1", true);
        assert_eq!(crew.takes("1", 1), Taking::Looks);
        assert_eq!(crew.names(), (None, None));
        // Who operates may lose that: his page was opened again with the other token.
        crew.come("2", "ben", Role::Operate);
        assert!(crew.is_operator("2"));
        crew.go("2");
        crew.come("2", "ben", Role::Look);
        assert_eq!(
            (crew.is_operator("2"), crew.takes("2", 1)),
            (false, Taking::Looks)
        );
        crew.come("3", "carl", Role::Operate);
        assert!(crew.is_operator("3"));
    }

    #[test]
    fn a_name_is_no_key() {
        let mut crew = Crew::default();
        crew.come("1", "anna", Role::Operate);
        assert_eq!(crew.takes("1", 7), Taking::New);
        // Somebody else says that she is Anna.
        assert_eq!(crew.come("2", "anna", Role::Operate), 0);
        assert!(crew.is_operator("1") && !crew.is_operator("2"));
        assert_eq!(crew.takes("2", 8), Taking::NotOperator);
        crew.answer("2", true);
        assert!(crew.is_operator("1"));
    }

    #[test]
    fn one_operates_and_hands_over() {
        let mut crew = Crew::default();
        assert_eq!((crew.comes("anna"), crew.comes("ben")), (0, 0));
        assert_eq!(crew.takes("anna", 1), Taking::New);
        assert_eq!(crew.takes("ben", 1), Taking::NotOperator);
        crew.ask("ben");
        assert_eq!(crew.names(), (Some("anna"), Some("ben")));
        crew.answer("ben", true);
        assert_eq!(crew.names().0, Some("anna"), "nobody helps himself");
        crew.answer("anna", true);
        assert_eq!(crew.names(), (Some("ben"), None));
        assert_eq!(crew.takes("ben", 2), Taking::New);
    }

    #[test]
    fn whoever_went_last_is_remembered_however_many_names_there_are() {
        let mut crew = Crew::default();
        let visit = |crew: &mut Crew, name: &str, number: u64| {
            let taken = crew.comes(name);
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
        assert_eq!(crew.comes("anna"), 7);
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
        crew.comes("anna");
        assert_eq!(crew.takes("anna", 1), Taking::New);
        crew.go("anna");
        // She does not know whether 1 arrived, and sends it again.
        assert_eq!(crew.comes("anna"), 1);
        assert_eq!(crew.takes("anna", 1), Taking::Twice);
        assert_eq!(crew.takes("anna", 2), Taking::New);
        // Who looks on while she loads the page anew does not get the keys; who comes when she is away does.
        crew.comes("ben");
        crew.go("anna");
        crew.comes("anna");
        assert_eq!(crew.names().0, Some("anna"));
        crew.go("anna");
        crew.comes("carl");
        assert_eq!(crew.names().0, Some("carl"));
    }
}
