//! Who may speak to the server: only the page that it served, from this computer.

use super::error::StudioError;
use super::session::Studio;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderValue, Uri, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

/// The header in which the page gives the token.
const TOKEN: &str = "x-drypoint-token";
/// The page may load from its own server alone.
const POLICY: &str = "default-src 'none'; script-src 'self'; worker-src 'self'; style-src 'self' 'unsafe-inline'; \
    img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// What the page is made of; these files say nothing of the user's work.
const OPEN: [&str; 3] = ["/studio.js", "/studio.css", "/worker.js"];

/// Refuses requests from other pages and hosts, and those without the token.
pub(super) async fn guard(State(studio): State<Arc<Studio>>, request: Request, next: Next) -> Response {
    let mut response = match check(&studio, request.headers(), request.uri()) {
        Ok(()) => next.run(request).await,
        Err(refusal) => refusal.into_response(),
    };
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert("cross-origin-resource-policy", HeaderValue::from_static("same-origin"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}

fn check(studio: &Studio, headers: &HeaderMap, uri: &Uri) -> Result<(), StudioError> {
    let forbidden = |why: &str| Err(StudioError::Forbidden(why.to_owned()));
    let text = |name: header::HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    if !text(header::HOST).is_some_and(|host| is_own(host, studio.port)) {
        return forbidden("the studio answers only under its own address");
    }
    if text(header::ORIGIN).is_some_and(|origin| !origin.strip_prefix("http://").is_some_and(|host| is_own(host, studio.port))) {
        return forbidden("another page may not speak to the studio");
    }
    if OPEN.contains(&uri.path()) {
        return Ok(());
    }
    let of_query = || uri.query()?.split('&').find_map(|pair| pair.strip_prefix("token="));
    let given = headers.get(TOKEN).and_then(|value| value.to_str().ok()).or_else(of_query);
    if given.is_some_and(|given| is_same(given, &studio.token)) {
        return Ok(());
    }
    forbidden("open the whole address that the studio printed; the part after token= is missing or from an earlier start")
}

fn is_own(host: &str, port: u16) -> bool {
    ["127.0.0.1", "localhost"].iter().any(|name| host == format!("{name}:{port}"))
}

/// Compares in a time that does not tell how many characters are right.
fn is_same(given: &str, token: &str) -> bool {
    given.len() == token.len() && given.bytes().zip(token.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}
