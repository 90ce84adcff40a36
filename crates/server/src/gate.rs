//! Lets requests in by the rules of `access`.

use axum::extract::{Request, State};
use axum::http::StatusCode;
use axum::http::header::{LOCATION, SET_COOKIE};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::access::{COOKIE_NAME, Verdict};
use crate::shared::Shared;

/// Lets requests in, or not.
pub(crate) async fn guard(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    let query = request.uri().query().unwrap_or_default().to_owned();
    match shared.access.judge(request.method(), &query, request.headers()) {
        Verdict::Welcome => next.run(request).await,
        Verdict::WithCookie if request.uri().path() == "/" => {
            let cookie = format!(
                "{COOKIE_NAME}={}; HttpOnly; SameSite=Strict; Path=/",
                shared.access.token()
            );
            // The token does not stay in the address.
            (
                StatusCode::SEE_OTHER,
                [(SET_COOKIE, cookie), (LOCATION, "/".to_owned())],
            )
                .into_response()
        }
        Verdict::WithCookie => next.run(request).await,
        Verdict::Refused(why) => (StatusCode::FORBIDDEN, why).into_response(),
    }
}
