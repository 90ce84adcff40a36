//! Lets requests in by the rules of `access`, and in time.

use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, to_bytes};
use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::header::{CONNECTION, LOCATION, RETRY_AFTER, SET_COOKIE};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::access::{COOKIE_NAME, Verdict};
use crate::places::Place;
use crate::shared::Shared;

/// Largest body of a request, bytes.
const BODY: usize = 64 << 10;
/// Within this time it is there.
pub(crate) const BODY_TIME: Duration = Duration::from_secs(5);

/// Lets requests in, or not.
pub(crate) async fn guard(State(shared): State<Shared>, mut request: Request, next: Next) -> Response {
    let Some(place) = request.extensions().get::<Arc<Place>>().cloned() else {
        return StatusCode::INTERNAL_SERVER_ERROR.into_response();
    };
    let query = request.uri().query().unwrap_or_default();
    let verdict = shared
        .access
        .judge(place.address(), request.method(), query, request.headers());
    let role = match verdict {
        Verdict::Welcome(role) => role,
        Verdict::WithCookie(_, token) if request.uri().path() == "/" => return with_cookie(&token),
        Verdict::WithCookie(role, _) => role,
        Verdict::Refused(why) => return (StatusCode::FORBIDDEN, why).into_response(),
        Verdict::Later(wait) => {
            let seconds = wait.as_secs() + 1;
            let why = format!("too many wrong tokens came from there: none is looked at for {seconds} s");
            let after = [(RETRY_AFTER, seconds.to_string())];
            return (StatusCode::TOO_MANY_REQUESTS, after, why).into_response();
        }
    };
    let (parts, body) = request.into_parts();
    let whole = match tokio::time::timeout(BODY_TIME, to_bytes(body, BODY)).await {
        Ok(Ok(whole)) => whole,
        // What is left of it is not waited for.
        Ok(Err(_)) => return ([(CONNECTION, "close")], StatusCode::PAYLOAD_TOO_LARGE).into_response(),
        Err(_) => return ([(CONNECTION, "close")], StatusCode::REQUEST_TIMEOUT).into_response(),
    };
    request = Request::from_parts(parts, Body::from(whole));
    request.extensions_mut().insert(role);
    place.begin(role);
    let answer = next.run(request).await;
    place.end();
    answer
}

/// The token does not stay in the address.
fn with_cookie(token: &str) -> Response {
    let cookie = format!("{COOKIE_NAME}={token}; HttpOnly; SameSite=Strict; Path=/");
    let headers = [(SET_COOKIE, cookie), (LOCATION, "/".to_owned())];
    (StatusCode::SEE_OTHER, headers).into_response()
}
