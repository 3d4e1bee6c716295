//! The page, as `cargo xtask studio` built it.

use axum::body::Body;
use axum::http::{Response, StatusCode, header};

/// The built page. In a development build its files are read when they are asked for.
#[derive(rust_embed::RustEmbed)]
#[folder = "$FUSION_STUDIO_PAGE"]
#[allow_missing = true]
struct Bundle;

/// The page's scripts come from here and nowhere else; it talks to this server alone.
const POLICY: &str = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; \
    img-src 'self' data: blob:; worker-src 'self' blob:; connect-src 'self' ws://127.0.0.1:* ws://localhost:* blob: data:; object-src 'none'; base-uri 'none'; \
    form-action 'none'";

/// What is served where there is no bundle.
const UNBUILT: &str = "<!doctype html><meta charset=utf-8><title>fusion-studio</title>\
    <body style=\"font-family:system-ui;max-width:40em;margin:4em auto;line-height:1.5\">\
    <h1>The studio&rsquo;s page is not built</h1>\
    <p>The server runs, but it was compiled without its page. In a checkout, with Node&nbsp;20 or later:</p>\
    <pre>cargo xtask studio\ncargo run -p fusion-studio</pre>\
    <p>The Python wheel <code>fusion-mesh</code> and the released programs carry the page.</p>";

/// A file of the page; its front page for an empty path.
pub fn serve(path: &str) -> Response<Body> {
    let path = if path.is_empty() { "index.html" } else { path };
    match Bundle::get(path) {
        Some(file) => respond(StatusCode::OK, kind(path), file.data.into_owned()),
        None if path == "index.html" => respond(StatusCode::OK, "text/html; charset=utf-8", UNBUILT.into()),
        None => respond(StatusCode::NOT_FOUND, "text/plain; charset=utf-8", b"file not found".to_vec()),
    }
}

fn respond(status: StatusCode, kind: &str, bytes: Vec<u8>) -> Response<Body> {
    let response = Response::builder()
        .status(status)
        .header(header::CONTENT_TYPE, kind)
        .header(header::CONTENT_SECURITY_POLICY, POLICY);
    response.body(bytes.into()).unwrap_or_default()
}

fn kind(path: &str) -> &'static str {
    match path.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" => "application/json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "wasm" => "application/wasm",
        _ => "application/octet-stream",
    }
}
