//! Who may come in at the interfaces of a machine, and what he may do there.
//!
//! - a [`Role`] is what somebody may do;
//! - [`Tokens`] are what others must know, and which role each of them gives;
//! - [`is_secret`] compares what somebody says with what he must know.
//!
//! ```
//! use bahn_access::{Role, Tokens};
//!
//! let tokens = Tokens { operate: Some("steel".to_owned()), look: Some("glass".to_owned()) };
//! assert_eq!(tokens.role_of("glass"), Some(Role::Look));
//! assert!(tokens.role_of("steel") > Some(Role::Look) && tokens.role_of("stee").is_none());
//! ```
//!
//! Nothing here knows a protocol or a machine.
//!
//! Decision: How long a token or a password is compared depends on what is said alone, neither on the length of the
//! secret nor on how much of it is right

#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")
)]

use std::hint::black_box;

/// What somebody may do; the greater one may what the lesser one may.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// He sees everything and does nothing.
    Look,
    /// May operate the machine.
    Operate,
}

/// What others must know.
#[derive(Clone, Debug, Default)]
pub struct Tokens {
    /// The token with which one may operate.
    pub operate: Option<String>,
    /// The token with which one may look.
    pub look: Option<String>,
}

impl Tokens {
    /// Whether any token is asked for.
    pub fn any(&self) -> bool {
        self.operate.is_some() || self.look.is_some()
    }

    /// The role of whoever says this.
    pub fn role_of(&self, given: &str) -> Option<Role> {
        // Both are compared, whichever it is.
        let is = |token: &Option<String>| token.as_deref().is_some_and(|token| is_secret(given, token));
        match (is(&self.operate), is(&self.look)) {
            (true, _) => Some(Role::Operate),
            (_, true) => Some(Role::Look),
            _ => None,
        }
    }
}

/// Whether somebody knows a secret. How long that takes depends on what he says alone: neither on the length of the secret
/// nor on how much of it is right.
pub fn is_secret(given: &str, secret: &str) -> bool {
    let secret = secret.as_bytes();
    let compared = given.bytes().enumerate().fold(0, |differences, (place, byte)| {
        let wanted = secret.get(place % secret.len().max(1)).copied().unwrap_or(0);
        // Without this the compiler may leave the loop as soon as the result is known.
        black_box(differences | (byte ^ wanted))
    });
    (compared == 0) & (given.len() == secret.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_secret_is_all_of_it_and_nothing_more() {
        for secret in ["", "a", "ab", "steel", "ünï"] {
            assert!(is_secret(secret, secret), "{secret}");
        }
        // Parts, a repetition of the whole, other letters at either end.
        for given in ["", "s", "stee", "steelsteel", "steel ", "Steel", "steeL"] {
            assert!(!is_secret(given, "steel"), "{given}");
        }
        assert!(!is_secret("a", ""));
    }

    #[test]
    fn no_token_is_no_way_in() {
        let tokens = Tokens::default();
        assert_eq!((tokens.any(), tokens.role_of("")), (false, None));
    }
}
