//! Who may come in, and what he may do there.
//!
//! On loopback the page itself and programs of this computer; a page of somebody else's, opened in the same browser,
//! may not: its requests name their origin. DNS rebinding, a name of somebody else's that leads to loopback, is refused
//! by the Host header. Elsewhere everybody needs a token, once in the address, then as a
//! cookie: one is for operating, another for looking.

use std::net::{IpAddr, SocketAddr};
use std::time::{Duration, Instant};

use axum::http::header::{AUTHORIZATION, COOKIE, HOST, ORIGIN};
use axum::http::{HeaderMap, Method};
use bahn_service::{Role, Tokens};

use crate::wrong::Wrong;

/// Name of the cookie that holds a token.
pub(crate) const COOKIE_NAME: &str = "bahn-token";

/// The rules of access to the panel.
#[derive(Debug)]
pub(crate) struct Access {
    address: SocketAddr,
    tokens: Tokens,
    wrong: Wrong,
}

/// Whether a request is let in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Welcome(Role),
    /// The token was in the address: it becomes a cookie.
    WithCookie(Role, String),
    Refused(&'static str),
    /// Too many wrong tokens came from there; none is looked at for so long.
    Later(Duration),
}

impl Access {
    pub fn new(address: SocketAddr, tokens: Tokens) -> Access {
        Access {
            address,
            tokens,
            wrong: Wrong::default(),
        }
    }

    /// Judges a request by where it comes from, its method, query and headers.
    pub fn judge(&self, peer: IpAddr, method: &Method, query: &str, headers: &HeaderMap) -> Verdict {
        let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
        let host = text(HOST).unwrap_or_default();
        if self.address.ip().is_loopback() && !is_loopback_name(host) {
            return Verdict::Refused("this name does not lead here");
        }
        let origin = text(ORIGIN);
        let foreign = origin.is_some_and(|origin| {
            let named = origin.split_once("://").map(|(_, named)| named);
            named != Some(host)
        });
        let upgrades = headers.contains_key("upgrade");
        if foreign && (upgrades || !matches!(*method, Method::GET | Method::HEAD)) {
            return Verdict::Refused("this page is not of this server");
        }
        let bearer = text(AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
        let mut cookies = text(COOKIE).unwrap_or_default().split(';');
        let cookie = cookies.find_map(|cookie| cookie.trim().strip_prefix(COOKIE_NAME)?.strip_prefix('='));
        let mut parts = query.split('&');
        let named = parts.find_map(|part| part.strip_prefix("token="));
        self.judge_tokens(peer, named, [bearer, cookie])
    }

    /// By the tokens in the address and in the headers.
    fn judge_tokens(&self, peer: IpAddr, named: Option<&str>, others: [Option<&str>; 2]) -> Verdict {
        // On loopback everybody operates who does not say otherwise, when no token is asked for that.
        let free = self.address.ip().is_loopback() && self.tokens.operate.is_none();
        if !free && named.is_none() && others == [None; 2] {
            return Verdict::Refused("the token is missing");
        }
        let now = Instant::now();
        if let Some(wait) = self.wrong.wait(peer, now).filter(|_| !free) {
            return Verdict::Later(wait);
        }
        if let Some(token) = named
            && let Some(role) = self.tokens.role_of(token)
        {
            return Verdict::WithCookie(role, token.to_owned());
        }
        let mut roles = others
            .into_iter()
            .flatten()
            .map(|token| self.tokens.role_of(token));
        match roles.find_map(|role| role) {
            Some(role) => Verdict::Welcome(role),
            None if free => Verdict::Welcome(Role::Operate),
            None => {
                self.wrong.note(peer, now);
                Verdict::Refused("the token is wrong")
            }
        }
    }
}

/// `localhost`, an address of loopback, each with a port or without.
fn is_loopback_name(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or_default(),
        None => host.split(':').next().unwrap_or_default(),
    };
    name.eq_ignore_ascii_case("localhost")
        || name
            .parse::<std::net::IpAddr>()
            .is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(&'static str, &'static str)]) -> HeaderMap {
        let pairs = pairs
            .iter()
            .map(|(name, value)| (name.parse().unwrap(), value.parse().unwrap()));
        pairs.collect()
    }

    fn tokens(operate: &str, look: &str) -> Tokens {
        let token = |text: &str| (!text.is_empty()).then(|| text.to_owned());
        Tokens {
            operate: token(operate),
            look: token(look),
        }
    }

    /// What somebody may do at a server with these tokens; on loopback, or elsewhere.
    fn judged(
        (operate, look): (&str, &str),
        method: Method,
        query: &str,
        pairs: &[(&'static str, &'static str)],
    ) -> Option<Role> {
        let host = pairs.iter().find(|(name, _)| *name == "host").unwrap().1;
        let address = match host {
            "192.168.0.5:8155" => host,
            _ => "127.0.0.1:8155",
        };
        let access = Access::new(address.parse().unwrap(), tokens(operate, look));
        let peer = "192.168.0.9".parse().unwrap();
        match access.judge(peer, &method, query, &headers(pairs)) {
            Verdict::Welcome(role) | Verdict::WithCookie(role, _) => Some(role),
            Verdict::Refused(_) | Verdict::Later(_) => None,
        }
    }

    const NONE: (&str, &str) = ("", "");
    const BOTH: (&str, &str) = ("secret", "shown1");

    #[test]
    fn on_loopback_the_page_itself_and_programs_come_in() {
        let own = [("host", "127.0.0.1:8155"), ("origin", "http://127.0.0.1:8155")];
        let operate = Some(Role::Operate);
        assert_eq!(judged(NONE, Method::POST, "", &own), operate);
        assert_eq!(
            judged(NONE, Method::POST, "", &[("host", "localhost:8155")]),
            operate
        );
        assert_eq!(judged(NONE, Method::GET, "", &[("host", "[::1]:8155")]), operate);
        let foreign = [("host", "127.0.0.1:8155"), ("origin", "http://example.com")];
        assert_eq!(judged(NONE, Method::POST, "", &foreign), None);
        let socket = [
            ("host", "127.0.0.1:8155"),
            ("origin", "http://example.com"),
            ("upgrade", "websocket"),
        ];
        assert_eq!(judged(NONE, Method::GET, "", &socket), None);
        // A name that was made to lead to loopback.
        assert_eq!(
            judged(NONE, Method::GET, "", &[("host", "evil.example:8155")]),
            None
        );
        // A cookie of another panel that was here is no token; who says that he looks looks.
        let old = [("host", "127.0.0.1:8155"), ("cookie", "bahn-token=before")];
        assert_eq!(judged(("", "shown1"), Method::GET, "", &old), operate);
        assert_eq!(
            judged(("", "shown1"), Method::GET, "token=shown1", &own),
            Some(Role::Look)
        );
        assert_eq!(
            judged(("secret", ""), Method::GET, "", &own),
            None,
            "a token that is given counts"
        );
    }

    #[test]
    fn elsewhere_a_token_is_needed_and_says_what_one_may() {
        let host = ("host", "192.168.0.5:8155");
        let (look, operate) = (Some(Role::Look), Some(Role::Operate));
        assert_eq!(judged(BOTH, Method::GET, "", &[host]), None);
        assert_eq!(judged(BOTH, Method::GET, "token=secret", &[host]), operate);
        assert_eq!(judged(BOTH, Method::GET, "token=shown1", &[host]), look);
        assert_eq!(judged(BOTH, Method::GET, "token=secre", &[host]), None);
        assert_eq!(
            judged(("", "shown1"), Method::GET, "token=", &[host]),
            None,
            "no token is none"
        );
        let bearer = [host, ("authorization", "Bearer secret")];
        assert_eq!(judged(BOTH, Method::POST, "", &bearer), operate);
        let cookie = [host, ("cookie", "a=b; bahn-token=shown1")];
        assert_eq!(judged(BOTH, Method::POST, "", &cookie), look);
        // Who follows the address of those who look does so, also when he may more.
        let both = [host, ("cookie", "bahn-token=secret")];
        assert_eq!(judged(BOTH, Method::GET, "token=shown1", &both), look);
    }

    #[test]
    fn who_guesses_is_slowed_and_nobody_else() {
        let access = Access::new("192.168.0.5:8155".parse().unwrap(), tokens("secret", ""));
        let [guesser, other] = ["192.168.0.66", "192.168.0.7"].map(|text| text.parse().unwrap());
        let judge = |peer, token: &str| {
            let host = [("host", "192.168.0.5:8155")];
            access.judge(peer, &Method::GET, &format!("token={token}"), &headers(&host))
        };
        for _ in 0..crate::wrong::AT_ONCE {
            assert_eq!(judge(guesser, "guessed"), Verdict::Refused("the token is wrong"));
        }
        assert!(matches!(judge(guesser, "guessed"), Verdict::Later(_)));
        assert!(
            matches!(judge(guesser, "secret"), Verdict::Later(_)),
            "he does not learn whether it is right"
        );
        assert!(matches!(
            judge(other, "secret"),
            Verdict::WithCookie(Role::Operate, _)
        ));
    }
}
