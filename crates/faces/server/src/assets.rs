//! The page and its modules, embedded: there is no way to any other file.

use std::sync::LazyLock;

use axum::extract::Path;
use axum::http::StatusCode;
use axum::http::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, X_CONTENT_TYPE_OPTIONS};
use axum::response::{IntoResponse, Response};
use bahn_viewer::{STAGE, STAGE_PLACE};

/// The page, with the stage of the viewer in it.
static PAGE: LazyLock<String> =
    LazyLock::new(|| include_str!("../web/index.html").replace(STAGE_PLACE, STAGE));

macro_rules! modules {
    ($($name:literal),+ $(,)?) => {
        [$(($name, include_str!(concat!("../web/", $name)))),+]
    };
}

/// The modules by name.
const MODULES: &[(&str, &str)] = &modules![
    "style.css",
    "part.css",
    "scheme.css",
    "main.js",
    "connection.js",
    "messagepack.js",
    "screen.js",
    "keyboard.js",
    "machine.js",
    "part.js",
    "scheme.js",
    "timeline.js",
    "teacher.js",
    "texts.js",
];

/// Only what this server serves, nothing inline.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// `GET /`: the page.
pub(crate) async fn page() -> Response {
    served("text/html; charset=utf-8", &PAGE)
}

/// One of its modules.
pub(crate) async fn module(Path(name): Path<String>) -> Response {
    let Some((name, text)) = MODULES.iter().find(|(known, _)| *known == name) else {
        return StatusCode::NOT_FOUND.into_response();
    };
    let kind = match name.ends_with(".css") {
        true => "text/css; charset=utf-8",
        false => "text/javascript; charset=utf-8",
    };
    served(kind, text)
}

/// One of the modules of the viewer.
pub(crate) async fn viewer(Path(name): Path<String>) -> Response {
    let modules = bahn_viewer::FILES
        .iter()
        .filter(|file| file.mime == "text/javascript");
    match modules.into_iter().find(|file| file.name == name) {
        Some(file) => served("text/javascript; charset=utf-8", file.text),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

fn served(kind: &'static str, text: &'static str) -> Response {
    let headers = [
        (CONTENT_TYPE, kind),
        (CACHE_CONTROL, "no-cache"),
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
    ];
    (headers, text).into_response()
}
