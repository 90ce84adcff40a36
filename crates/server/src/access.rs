//! Who may come in.
//!
//! On loopback the page itself and programs of this computer; a page of somebody else's, opened in the same browser,
//! may not: its requests name their origin. Names that lead to loopback by a false answer of the name service are
//! refused by the host that requests name. Elsewhere everybody needs the token, once in the address, then as a
//! cookie.

use std::net::SocketAddr;

use axum::http::header::{AUTHORIZATION, COOKIE, HOST, ORIGIN};
use axum::http::{HeaderMap, Method};

/// Name of the cookie that holds the token.
pub(crate) const COOKIE_NAME: &str = "bahn-token";

/// The rules.
#[derive(Debug)]
pub(crate) struct Access {
    address: SocketAddr,
    token: Option<String>,
}

/// Whether a request is let in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Welcome,
    /// The token was in the address: it becomes a cookie.
    WithCookie,
    Refused(&'static str),
}

impl Access {
    pub fn new(address: SocketAddr, token: Option<String>) -> Access {
        Access { address, token }
    }

    /// What everybody must know.
    pub fn token(&self) -> &str {
        self.token.as_deref().unwrap_or_default()
    }

    /// Judges a request by its method, query and headers.
    pub fn judge(&self, method: &Method, query: &str, headers: &HeaderMap) -> Verdict {
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
        let Some(token) = &self.token else {
            return Verdict::Welcome;
        };
        let bearer = text(AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
        let mut cookies = text(COOKIE).unwrap_or_default().split(';');
        let cookie = cookies.find_map(|cookie| cookie.trim().strip_prefix(COOKIE_NAME)?.strip_prefix('='));
        if [bearer, cookie]
            .into_iter()
            .flatten()
            .any(|given| same(given, token))
        {
            return Verdict::Welcome;
        }
        let mut parts = query.split('&');
        match parts.find_map(|part| part.strip_prefix("token=")) {
            Some(given) if same(given, token) => Verdict::WithCookie,
            _ => Verdict::Refused("the token is missing"),
        }
    }
}

/// Compares without telling by its time how much is right.
fn same(given: &str, token: &str) -> bool {
    let differences = given
        .bytes()
        .zip(token.bytes())
        .filter(|(one, other)| one != other);
    given.len() == token.len() && differences.count() == 0
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

    fn judged(
        token: Option<&str>,
        method: Method,
        query: &str,
        pairs: &[(&'static str, &'static str)],
    ) -> bool {
        let address = if token.is_some() {
            "192.168.0.5:8155"
        } else {
            "127.0.0.1:8155"
        };
        let access = Access::new(address.parse().unwrap(), token.map(str::to_owned));
        let verdict = access.judge(&method, query, &headers(pairs));
        !matches!(verdict, Verdict::Refused(_))
    }

    #[test]
    fn on_loopback_the_page_itself_and_programs_come_in() {
        let own = [("host", "127.0.0.1:8155"), ("origin", "http://127.0.0.1:8155")];
        assert!(judged(None, Method::POST, "", &own));
        assert!(judged(None, Method::POST, "", &[("host", "localhost:8155")]));
        assert!(judged(None, Method::GET, "", &[("host", "[::1]:8155")]));
        let foreign = [("host", "127.0.0.1:8155"), ("origin", "http://example.com")];
        assert!(!judged(None, Method::POST, "", &foreign));
        let socket = [
            ("host", "127.0.0.1:8155"),
            ("origin", "http://example.com"),
            ("upgrade", "websocket"),
        ];
        assert!(!judged(None, Method::GET, "", &socket));
        // A name that was made to lead to loopback.
        assert!(!judged(None, Method::GET, "", &[("host", "evil.example:8155")]));
    }

    #[test]
    fn elsewhere_the_token_is_needed() {
        let host = ("host", "192.168.0.5:8155");
        assert!(!judged(Some("secret"), Method::GET, "", &[host]));
        assert!(judged(Some("secret"), Method::GET, "token=secret", &[host]));
        assert!(!judged(Some("secret"), Method::GET, "token=secre", &[host]));
        let bearer = [host, ("authorization", "Bearer secret")];
        assert!(judged(Some("secret"), Method::POST, "", &bearer));
        let cookie = [host, ("cookie", "a=b; bahn-token=secret")];
        assert!(judged(Some("secret"), Method::POST, "", &cookie));
    }
}
