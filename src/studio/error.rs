//! What can go wrong, in the words that the page shows.

use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use std::path::Path;

/// Why the studio did not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// The request is wrong, or asks for what is not there.
    #[error("{0}")]
    Refused(String),
    /// There is no such thing.
    #[error("{0}")]
    Missing(String),
    /// The request comes from elsewhere.
    #[error("{0}")]
    Forbidden(String),
    /// A file or a process failed.
    #[error("{0}")]
    Failed(String),
}

impl StudioError {
    /// The error of a file.
    pub(super) fn about(file: &Path) -> impl Fn(std::io::Error) -> Self {
        move |error| Self::Failed(format!("{}: {error}", file.display()))
    }

    fn status(&self) -> StatusCode {
        match self {
            Self::Refused(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Self::Missing(_) => StatusCode::NOT_FOUND,
            Self::Forbidden(_) => StatusCode::FORBIDDEN,
            Self::Failed(_) => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }
}

impl IntoResponse for StudioError {
    fn into_response(self) -> Response {
        let body = serde_json::json!({ "error": self.to_string() });
        (self.status(), [("content-type", "application/json")], body.to_string()).into_response()
    }
}
