//! What programs ask for: docs/panel-api.md.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use bahn_panel::{Input, InputText, Key, Refusal, Station};
use serde::Serialize;
use serde_json::json;

use crate::server::Shared;

/// What does not change while a station is on.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct About {
    /// Name of the machine.
    machine: String,
    /// Its control model.
    model: String,
    /// The keyboard.
    keys: Vec<KeyText>,
    /// Keys of the machine operating panel.
    machine_keys: Vec<String>,
    /// Axes that a handwheel can move.
    axes: String,
    /// The version of this program.
    version: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct KeyText {
    name: &'static str,
    group: String,
    label: &'static str,
}

impl About {
    /// Of a station.
    pub fn of(station: &Station) -> About {
        let key = |key: &Key| KeyText {
            name: key.name(),
            group: format!("{:?}", key.group()).to_lowercase(),
            label: key.label(),
        };
        About {
            machine: station.machine().folder.name.clone(),
            model: station.control().model().name().to_owned(),
            keys: Key::ALL.iter().map(key).collect(),
            machine_keys: station.machine_keys(),
            axes: station.control().axis_letters().collect(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}

/// `GET /api/station`.
pub(crate) async fn station(State(shared): State<Shared>) -> Response {
    Json(shared.about.as_ref()).into_response()
}

/// `GET /api/screen`.
pub(crate) async fn screen(State(shared): State<Shared>) -> Response {
    Json(shared.link.screen().as_ref()).into_response()
}

/// `GET /api/snapshot`: the numbers behind the screen.
pub(crate) async fn snapshot(State(shared): State<Shared>) -> Response {
    let asked = tokio::task::spawn_blocking(move || shared.link.with(|station| station.numbers()));
    match asked.await {
        Ok(Ok(numbers)) => Json(numbers).into_response(),
        Ok(Err(refusal)) => refused(&refusal),
        Err(_) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
    }
}

/// `POST /api/key` and `POST /api/command`: an input; the answer has the screen behind it.
pub(crate) async fn input(State(shared): State<Shared>, body: String) -> Response {
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
    let link = shared.link.clone();
    match tokio::task::spawn_blocking(move || link.input(input)).await {
        Ok(Ok(())) => Json(json!({"ok": true, "serial": shared.link.screen().serial})).into_response(),
        Ok(Err(refusal)) => refused(&refusal),
        Err(_) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
    }
}

fn refused(refusal: &Refusal) -> Response {
    let body = Json(json!({"ok": false, "error": refusal.0}));
    (StatusCode::CONFLICT, body).into_response()
}
