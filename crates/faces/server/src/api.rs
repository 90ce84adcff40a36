//! What programs ask for: docs/panel-api.md.

use std::sync::Arc;

use axum::Json;
use axum::extract::{Extension, Query, State};
use axum::http::StatusCode;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use bahn_service::{
    Input, InputText, Operated, Refusal, Role, ServiceError, Stepped, language_code, language_of_code,
    texts_around,
};
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::pictures::{PIXELS, SIDE};
use crate::shared::Shared;

/// `GET /api/station`: what does not change while the station is on.
pub(crate) async fn station(State(shared): State<Shared>) -> Response {
    Json(shared.about.as_ref()).into_response()
}

/// The language of a request.
#[derive(Deserialize)]
pub(crate) struct Spoken {
    language: Option<String>,
}

/// `GET /api/texts`: what stands around the screen, in the language of the control or in another one.
pub(crate) async fn texts(State(shared): State<Shared>, Query(spoken): Query<Spoken>) -> Response {
    let language = match &spoken.language {
        None => Some(shared.machine.screen().look.language),
        Some(code) => language_of_code(code),
    };
    match language {
        Some(language) => Json(json!({"language": language_code(language), "texts": texts_around(language)}))
            .into_response(),
        None => (StatusCode::NOT_FOUND, "languages are en and de").into_response(),
    }
}

/// `GET /api/screen`: what the screen shows now.
pub(crate) async fn screen(State(shared): State<Shared>) -> Response {
    Json(shared.machine.screen().as_ref()).into_response()
}

/// `GET /api/snapshot`: the numbers behind the screen.
pub(crate) async fn snapshot(State(shared): State<Shared>) -> Response {
    let machine = shared.machine;
    match tokio::task::spawn_blocking(move || machine.state_json()).await {
        Ok(Ok(state)) => ([(CONTENT_TYPE, "application/json")], state).into_response(),
        Ok(Err(error)) => refused(&error),
        Err(_) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
    }
}

/// `GET /api/drawer`: what can be broken.
pub(crate) async fn drawer(State(shared): State<Shared>) -> Response {
    asked(shared, |machine| machine.drawer()).await
}

/// `GET /api/lessons`: the lessons of the machine.
pub(crate) async fn lessons(State(shared): State<Shared>) -> Response {
    asked(shared, |machine| {
        let lessons = machine.lessons()?;
        let named = |(name, title)| json!({"name": name, "title": title});
        Ok(lessons.into_iter().map(named).collect::<Vec<_>>())
    })
    .await
}

/// What the machine says.
async fn asked<T: Serialize + Send + 'static>(
    shared: Shared,
    what: impl FnOnce(&dyn Operated) -> Result<T, ServiceError> + Send + 'static,
) -> Response {
    let machine = shared.machine;
    match tokio::task::spawn_blocking(move || what(machine.as_ref())).await {
        Ok(Ok(said)) => Json(said).into_response(),
        Ok(Err(error)) => refused(&error),
        Err(_) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
    }
}

/// How large a picture is wanted, pixels.
#[derive(Deserialize)]
pub(crate) struct Size {
    #[serde(default = "Size::width")]
    width: u32,
    #[serde(default = "Size::height")]
    height: u32,
}

impl Size {
    fn width() -> u32 {
        800
    }

    fn height() -> u32 {
        600
    }

    fn is_drawn(&self) -> bool {
        let pixels = u64::from(self.width) * u64::from(self.height);
        self.width.max(self.height) <= SIDE && pixels <= PIXELS
    }
}

/// `GET /api/graphics.png`: what the graphics show.
pub(crate) async fn graphics(State(shared): State<Shared>, Query(size): Query<Size>) -> Response {
    if !size.is_drawn() {
        let why = format!("a picture has {PIXELS} pixels at most, and {SIDE} along a side");
        return (StatusCode::BAD_REQUEST, why).into_response();
    }
    let machine = Arc::clone(&shared.machine);
    let drawn = shared.pictures.draw(move || {
        let picture = machine.picture()?;
        Ok::<_, ServiceError>(picture.map(|picture| picture.png(size.width, size.height)))
    });
    match drawn.await {
        Some(Ok(Some(Ok(Some(png))))) => {
            ([(CONTENT_TYPE, "image/png"), (CACHE_CONTROL, "no-store")], png).into_response()
        }
        Some(Ok(Some(Err(error)))) => (StatusCode::BAD_REQUEST, error.to_string()).into_response(),
        // There is nothing to be seen, which is no fault of who asks.
        Some(Ok(None | Some(Ok(None)))) => StatusCode::NO_CONTENT.into_response(),
        Some(Err(error)) => refused(&error),
        None => (StatusCode::TOO_MANY_REQUESTS, "too many wait for pictures").into_response(),
    }
}

/// `POST /api/key` and `POST /api/command`: an input; the answer has the screen after it, and what became of contour
/// cycles that were asked for.
pub(crate) async fn input(
    State(shared): State<Shared>,
    Extension(role): Extension<Role>,
    body: String,
) -> Response {
    let machine = shared.machine.for_role(role);
    let input = serde_json::from_str::<InputText>(&body)
        .map_err(|error| Refusal(error.to_string()))
        .and_then(Input::try_from);
    let input = match input {
        Ok(input) => input,
        Err(refusal) => {
            return (
                StatusCode::BAD_REQUEST,
                Json(json!({"ok": false, "error": refusal.0})),
            )
                .into_response();
        }
    };
    let done = tokio::task::spawn_blocking(move || match input {
        Input::Cycles(cycles) => machine.steps(cycles).map(Some),
        other => machine.input(other).map(|()| None),
    });
    match done.await {
        Ok(Ok(stepped)) => Json(Done {
            ok: true,
            serial: shared.machine.screen().serial,
            stepped,
        })
        .into_response(),
        Ok(Err(error)) => refused(&error),
        Err(_) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
    }
}

/// An input was taken.
#[derive(Serialize)]
struct Done {
    ok: bool,
    /// Number of the screen.
    serial: u64,
    /// What has become of cycles that were asked for.
    #[serde(flatten)]
    stepped: Option<Stepped>,
}

fn refused(error: &ServiceError) -> Response {
    let status = match error {
        ServiceError::OnlyLooks => StatusCode::FORBIDDEN,
        _ => StatusCode::CONFLICT,
    };
    let body = Json(json!({"ok": false, "error": error.to_string()}));
    (status, body).into_response()
}
