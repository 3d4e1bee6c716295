//! Addresses below the token.

use crate::bundle;
use crate::gate::{Gate, Kind};
use crate::socket;
use crate::studio::Studio;
use crate::upload::{UploadError, upload};
use axum::Router;
use axum::body::Body;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::{FromRequestParts, Query, Request, State};
use axum::http::{HeaderValue, Method, Response, StatusCode, header};
use axum::response::IntoResponse;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// What every request is answered from.
#[derive(Clone, Debug)]
pub struct Site {
    /// Who is let in.
    pub gate: Arc<Gate>,
    /// What they come to.
    pub studio: Arc<Studio>,
}

/// Everything that the server answers.
pub fn router(site: Site) -> Router {
    Router::new().fallback(respond).with_state(site)
}

async fn respond(State(site): State<Site>, request: Request) -> Response<Body> {
    let mut response = route(&site, request).await;
    let headers = response.headers_mut();
    // The token must not leave in a `Referer`, nor stay on a disk.
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert("cross-origin-resource-policy", HeaderValue::from_static("same-origin"));
    response
}

async fn route(site: &Site, request: Request) -> Response<Body> {
    let path = request.uri().path().to_string();
    let Some(rest) = site.gate.rest(&path) else {
        return plain(StatusCode::FORBIDDEN, "this address needs the token that the program printed when it started");
    };
    let kind = if rest == "socket" { Kind::Socket } else { Kind::Plain };
    if !site.gate.admits(request.headers(), kind) {
        return plain(StatusCode::FORBIDDEN, "requests from other pages or to other hosts are refused");
    }
    match (request.method().clone(), rest) {
        (Method::GET, "socket") => connect(site, request).await,
        (Method::GET, "schema") => told(StatusCode::OK, &fusion::document::schema()),
        (Method::GET, "file") => download(site, argument(&request, "path")).await,
        (Method::POST, "upload") => receive(site, request).await,
        (Method::GET | Method::HEAD, rest) => bundle::serve(rest),
        _ => plain(StatusCode::METHOD_NOT_ALLOWED, "this address takes no such request"),
    }
}

async fn connect(site: &Site, request: Request) -> Response<Body> {
    let (mut parts, _) = request.into_parts();
    match WebSocketUpgrade::from_request_parts(&mut parts, &()).await {
        Ok(upgrade) => {
            let studio = Arc::clone(&site.studio);
            let upgrade = upgrade.max_message_size(socket::LONGEST).max_frame_size(socket::LONGEST);
            upgrade.on_upgrade(move |socket| socket::serve(studio, socket))
        }
        Err(refused) => refused.into_response(),
    }
}

async fn receive(site: &Site, request: Request) -> Response<Body> {
    let Some(name) = argument(&request, "name") else {
        return plain(StatusCode::BAD_REQUEST, "an upload needs `?name=FILE`");
    };
    let length = request.headers().get(header::CONTENT_LENGTH);
    let length = length.and_then(|value| value.to_str().ok()?.parse().ok());
    match upload(&site.studio.root, &name, length, request.into_body()).await {
        Ok(path) => told(StatusCode::OK, &json!({ "path": path })),
        Err(error) => {
            let status = match error {
                UploadError::TooLong => StatusCode::PAYLOAD_TOO_LARGE,
                UploadError::Io(_) => StatusCode::INTERNAL_SERVER_ERROR,
                _ => StatusCode::BAD_REQUEST,
            };
            told(status, &json!({ "error": { "sentence": error.to_string() } }))
        }
    }
}

async fn download(site: &Site, path: Option<String>) -> Response<Body> {
    let Some(path) = path else {
        return plain(StatusCode::BAD_REQUEST, "a file needs `?path=FILE`");
    };
    let file = match site.studio.root.existing("", Path::new(&path)) {
        Ok(file) => file,
        Err(error) => return plain(StatusCode::NOT_FOUND, &error.to_string()),
    };
    let name = file.file_name().unwrap_or_default().to_string_lossy().replace(['"', '\\'], "");
    match tokio::fs::read(&file).await {
        // As a download and no page: what is in it must not run here.
        Ok(bytes) => {
            let response = Response::builder()
                .header(header::CONTENT_TYPE, "application/octet-stream")
                .header(header::CONTENT_SECURITY_POLICY, "sandbox; default-src 'none'");
            let quoted = HeaderValue::from_str(&format!("attachment; filename=\"{name}\""));
            let quoted = quoted.unwrap_or(HeaderValue::from_static("attachment"));
            response.header(header::CONTENT_DISPOSITION, quoted).body(bytes.into()).unwrap_or_default()
        }
        Err(error) => plain(StatusCode::NOT_FOUND, &error.to_string()),
    }
}

fn argument(request: &Request, name: &str) -> Option<String> {
    let Query(mut all) = Query::<HashMap<String, String>>::try_from_uri(request.uri()).ok()?;
    all.remove(name)
}

fn plain(status: StatusCode, text: &str) -> Response<Body> {
    (status, [(header::CONTENT_TYPE, "text/plain; charset=utf-8")], text.to_string()).into_response()
}

fn told(status: StatusCode, json: &Value) -> Response<Body> {
    (status, [(header::CONTENT_TYPE, "application/json")], json.to_string()).into_response()
}
