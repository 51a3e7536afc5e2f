//! The files of the page, which are part of the binary.

use axum::http::header;
use axum::response::{Html, IntoResponse};

/// `GET /`.
pub(super) async fn index() -> Html<&'static str> {
    Html(include_str!("page/built/index.html"))
}

/// `GET /studio.js`.
pub(super) async fn script() -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "text/javascript; charset=utf-8")], include_str!("page/built/studio.js"))
}

/// `GET /worker.js`.
pub(super) async fn worker() -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "text/javascript; charset=utf-8")], include_str!("page/built/worker.js"))
}

/// `GET /studio.css`.
pub(super) async fn style() -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "text/css; charset=utf-8")], include_str!("page/built/studio.css"))
}
