//! Asking for the password: a page without scripts, and the cookie that the right one brings.

use std::time::Instant;

use axum::extract::{Extension, Form, Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{Html, IntoResponse, Redirect, Response};
use serde::Deserialize;

use super::http::Peer;
use super::shared::Shared;

/// Where it is.
pub(super) const PATH: &str = "/login";
/// The page; what became of a try stands where `{said}` is.
const PAGE: &str = include_str!("../../page/login.html");
/// What browsers are to enforce: nothing but the form.
const POLICY: &str =
    "default-src 'none'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'";

/// What the form sends.
#[derive(Deserialize)]
pub(super) struct Try {
    password: String,
}

/// Lets a browser in that has given the password, and shows others where to.
pub(super) async fn check(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    let is_in =
        (shared.password.as_ref()).is_none_or(|password| password.was_given(request.headers()));
    match request.uri().path() {
        PATH => next.run(request).await,
        _ if is_in => next.run(request).await,
        "/" if request.method() == Method::GET => Redirect::to(PATH).into_response(),
        _ => (StatusCode::UNAUTHORIZED, "this page wants its password\n").into_response(),
    }
}

/// The form.
pub(super) async fn form() -> Response {
    page(StatusCode::OK, "")
}

/// A try.
pub(super) async fn enter(
    State(shared): State<Shared>,
    Extension(Peer(peer)): Extension<Peer>,
    headers: HeaderMap,
    Form(Try { password: text }): Form<Try>,
) -> Response {
    if !shared.guard.allows_origin(&headers) {
        return (
            StatusCode::FORBIDDEN,
            "only the page of this server may do that\n",
        )
            .into_response();
    }
    let Some(password) = &shared.password else {
        return Redirect::to("/").into_response();
    };
    let client = shared.guard.client(peer, &headers);
    match password.check(client, &text, Instant::now()) {
        Ok(()) => {
            let cookie = password.cookie(shared.guard.is_secure());
            ([(header::SET_COOKIE, cookie)], Redirect::to("/")).into_response()
        }
        Err(wrong) => page(StatusCode::FORBIDDEN, &wrong.to_string()),
    }
}

fn page(status: StatusCode, said: &str) -> Response {
    let mut response = (status, Html(PAGE.replace("{said}", said))).into_response();
    let policy = HeaderValue::from_static(POLICY);
    response
        .headers_mut()
        .insert(header::CONTENT_SECURITY_POLICY, policy);
    response
}
