//! Who must not get in, and what must not break it.

use crate::client::{Client, get, parts, post, raw, union_of_balls};
use fusion_studio::{Options, Server};
use serde_json::json;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Command, Stdio};
use tungstenite::Message;

fn studio(folder: &Path) -> Server {
    let mut options = Options::default();
    options.root = Some(folder.to_path_buf());
    Server::start(&options).unwrap()
}

#[test]
fn without_the_token_nothing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (stale, server) = (studio(folder.path()), studio(folder.path()));
    let (host, token) = parts(server.address());
    let (_, old) = parts(stale.address());
    let get = |path: &str| {
        raw(&host, format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes()).0
    };
    for rest in ["/", "/schema", "/socket", "/file?path=a", "/assets/index.js"] {
        for prefix in
            [String::new(), old.clone(), token.to_uppercase() + "x", token[..20].to_string(), format!("/x{token}")]
        {
            assert_eq!(get(&format!("{prefix}{rest}")), 403, "{prefix}{rest}");
        }
    }
    assert_eq!((get(&format!("{token}/")), get(&format!("{token}/schema"))), (200, 200));
    assert_ne!(old, token);
    assert_eq!(token.len(), 33);
}

#[test]
fn other_pages_and_other_names_of_this_machine_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let server = studio(folder.path());
    let address = server.address();
    let (host, _) = parts(address);
    let own = format!("http://{host}");
    assert_eq!(get(address, "/", &[("Origin", &own)]).0, 200);
    for origin in ["http://evil.example", "null", "https://evil.example", "http://127.0.0.1:1", "http://localhost"] {
        assert_eq!(get(address, "/schema", &[("Origin", origin)]).0, 403, "{origin}");
        assert_eq!(Client::try_connect(address, Some(origin), None).err(), Some(403), "{origin}");
    }
    for name in ["evil.example", "127.0.0.1:1", "evil.example:80", "127.0.0.1"] {
        assert_eq!(get(address, "/schema", &[("Host", name)]).0, 403, "{name}");
        assert_eq!(
            Client::try_connect(address, Some(&format!("http://{name}")), Some(name)).err(),
            Some(403),
            "{name}"
        );
    }
    assert_eq!(Client::try_connect(address, None, None).err(), Some(403), "a socket says where it comes from");
    assert!(Client::try_connect(address, Some(&own), None).is_ok());
    // Only this machine is listened to.
    let port = host.rsplit_once(':').unwrap().1;
    let outward =
        std::net::UdpSocket::bind("0.0.0.0:0").and_then(|s| s.connect("192.0.2.1:9").and_then(|()| s.local_addr()));
    if let Ok(outward) = outward
        && !outward.ip().is_loopback()
        && !outward.ip().is_unspecified()
    {
        assert!(TcpStream::connect(format!("{}:{port}", outward.ip())).is_err());
    }
}

#[test]
fn no_path_leads_out_of_the_root() {
    let outer = tempfile::tempdir().unwrap();
    let folder = outer.path().join("root");
    fs::create_dir(&folder).unwrap();
    let secret = outer.path().join("secret.obj");
    fs::write(&secret, "v 0 0 0\n").unwrap();
    fs::write(folder.join("in.obj"), "v 0 0 0\n").unwrap();
    let mut ways = vec![
        "../secret.obj".to_string(),
        secret.display().to_string(),
        "a/../../secret.obj".into(),
        String::new(),
        ".".into(),
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, folder.join("link.obj")).unwrap();
        std::os::unix::fs::symlink(outer.path(), folder.join("up")).unwrap();
        ways.extend(["link.obj".into(), "up/secret.obj".into()]);
    }
    let server = studio(&folder);
    let mut page = Client::connect(server.address());
    page.ok(json!({ "do": "add_part", "mesh": "in.obj" }));
    let escaped = |path: &str| path.replace('/', "%2F");
    for path in &ways {
        assert_eq!(get(server.address(), &format!("/file?path={}", escaped(path)), &[]).0, 404, "{path}");
        assert_ne!(post(server.address(), &format!("/upload?name={}", escaped(path)), b"x").0, 200, "{path}");
        page.refused(json!({ "do": "open", "path": path }));
        page.refused(json!({ "do": "save", "path": path }));
        page.refused(json!({ "do": "add_part", "mesh": path }));
        page.refused(json!({ "do": "export", "of": "in", "file": path }));
    }
    for path in ["/../secret.obj", "/..%2fsecret.obj", "/assets/../../secret.obj", "/assets/..%2f..%2fsecret.obj"] {
        assert_ne!(get(server.address(), path, &[]).0, 200, "{path}");
    }
    // A document may say anything; it is read, and its files are not.
    for path in ways.iter().filter(|path| !path.is_empty()) {
        let text = format!("version = 2\n[[part]]\nname = \"a\"\nmesh = {path:?}\n");
        let version = page.ok(json!({ "do": "text", "text": text }))["version"].clone();
        let failed = page.wait(|e| e["event"] == "failed" && e["version"] == version);
        let sentence = failed["sentence"].as_str().unwrap();
        assert!(
            sentence.contains("not below the studio's root") || sentence.contains("there is no file"),
            "{sentence}"
        );
    }
    assert_eq!(fs::read_to_string(&secret).unwrap(), "v 0 0 0\n");
    let names: Vec<_> = fs::read_dir(outer.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
}

#[test]
fn garbage_is_answered_or_the_client_is_dropped_and_the_next_one_served() {
    let folder = tempfile::tempdir().unwrap();
    let server = studio(folder.path());
    let address = server.address();
    let mut page = Client::connect(address);
    let texts = [
        "",
        "{",
        "[]",
        "null",
        "7",
        "\"x\"",
        "{\"id\":1}",
        "{\"id\":-1,\"do\":\"undo\"}",
        "{\"id\":1,\"do\":7}",
        "{\"id\":1,\"do\":\"nothing\"}",
        "{\"id\":1,\"do\":\"set\"}",
        "{\"id\":1,\"do\":\"set\",\"table\":\"step\",\"index\":1e99,\"key\":\"a\"}",
        "{\"id\":1,\"do\":\"set\",\"table\":\"part\",\"index\":0,\"key\":\"\",\"value\":1}",
        "{\"id\":1,\"do\":\"move\",\"table\":\"part\",\"index\":5,\"to\":9}",
        "{\"id\":1,\"do\":\"pick\",\"shape\":\"x\",\"face\":0,\"bary\":[1,2]}",
        "{\"id\":1,\"do\":\"text\",\"text\":\"version = 3\"}",
        "{\"id\":1,\"do\":\"add_step\",\"verb\":\"explode\"}",
    ];
    for text in texts {
        page.socket.send(Message::text(text)).unwrap();
        let answer = loop {
            if let Message::Text(text) = page.socket.read().unwrap()
                && !text.contains("\"event\"")
            {
                break text;
            }
        };
        assert!(answer.contains("\"sentence\""), "{text}: {answer}");
    }
    let deep = "[".repeat(100_000);
    page.socket.send(Message::text(format!("{{\"id\":1,\"do\":{deep}"))).unwrap();
    page.socket.send(Message::binary(vec![0u8; 100])).unwrap();
    page.ok(json!({ "do": "undo" }));
    // Frames that are none, and ends in the middle of one.
    let (host, token) = parts(address);
    let hello = format!(
        "GET {token}/socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    let long = [&[0x81, 0xff, 0x7f][..], &[0xff; 7], &[0; 4]].concat();
    let frames: [&[u8]; 6] = [
        &[0xff; 64],
        &[0x81],
        &[0x81, 0x85, 1, 2, 3, 4, 9],
        &long,
        &[0x01, 0x80, 0, 0, 0, 0],
        &[0x83, 0x80, 0, 0, 0, 0],
    ];
    for frame in frames {
        let mut stream = TcpStream::connect(&host).unwrap();
        stream.write_all(hello.as_bytes()).unwrap();
        let mut answer = [0; 12];
        stream.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"HTTP/1.1 101");
        stream.write_all(frame).unwrap();
        drop(stream);
        page.ok(json!({ "do": "undo" }));
    }
    // A message that is too long ends that client alone.
    let mut other = Client::connect(address);
    let _ = other.socket.send(Message::text("x".repeat(9 << 20)));
    loop {
        match other.socket.read() {
            Ok(Message::Close(_)) | Err(_) => break,
            Ok(_) => {}
        }
    }
    page.ok(json!({ "do": "undo" }));
}

#[test]
fn an_upload_that_is_too_long_or_ends_early_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let server = studio(folder.path());
    let (host, token) = parts(server.address());
    let head = |length: &str| {
        format!("POST {token}/upload?name=a.obj HTTP/1.1\r\nHost: {host}\r\n{length}\r\nConnection: close\r\n\r\n")
    };
    assert_eq!(raw(&host, head("Content-Length: 2147483648").as_bytes()).0, 413);
    // One that says nothing of its length, and does not end.
    let mut stream = TcpStream::connect(&host).unwrap();
    stream.write_all(head("Transfer-Encoding: chunked").as_bytes()).unwrap();
    let chunk = [&b"400000\r\n"[..], &vec![b'#'; 4 << 20], b"\r\n"].concat();
    let sent = (0..200).take_while(|_| stream.write_all(&chunk).is_ok()).count();
    let mut answer = String::new();
    let _ = stream.read_to_string(&mut answer);
    assert!(sent < 200 && (answer.is_empty() || answer.starts_with("HTTP/1.1 413")), "{sent} {answer}");
    // One that ends early.
    let mut stream = TcpStream::connect(&host).unwrap();
    stream.write_all([head("Content-Length: 1000").as_bytes(), b"v 0 0 0"].concat().as_slice()).unwrap();
    drop(stream);
    for _ in 0..200 {
        if fs::read_dir(folder.path()).unwrap().count() == 0 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    assert_eq!(post(server.address(), "/upload?name=a.obj", b"v 0 0 0\n").1, json!({ "path": "a.obj" }));
    assert_eq!(post(server.address(), "/upload?name=a.obj", b"v 0 0 0\n").1, json!({ "path": "a.obj" }));
    assert_eq!(post(server.address(), "/upload?name=a.obj", b"v 0 0 1\n").1, json!({ "path": "a-2.obj" }));
}

#[test]
fn a_client_that_goes_amid_an_evaluation_stops_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let (server, mut page) = union_of_balls(folder.path());
    for n in 0..5 {
        let mut other = Client::connect(server.address());
        other.send(
            json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": 0.1 + 0.01 * f64::from(n) }),
        );
        other.send(json!({ "do": "max_radius", "step": 0 }));
        drop(other);
    }
    // What those clients sent may be heard after what the page sends: each of them at most once.
    let radius = (0..6).map(|_| {
        let set = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": 0.17 });
        let version = page.ok(set)["version"].clone();
        page.evaluated(&version)["steps"][0]["report"]["figures"]["radius"].as_f64().unwrap()
    });
    assert!(radius.into_iter().any(|radius| (radius - 0.17).abs() < 1e-12));
}

/// Whatever the moment: the page hears that it was stopped, or that it was done before.
#[test]
fn a_cancelled_evaluation_says_so_and_the_next_one_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let (_server, mut page) = union_of_balls(folder.path());
    for n in 0..6 {
        let radius = 0.11 + 0.01 * f64::from(n);
        page.events.clear();
        let set = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": radius });
        let version = page.ok(set)["version"].clone();
        std::thread::sleep(std::time::Duration::from_millis(7 * n as u64));
        page.ok(json!({ "do": "cancel" }));
        page.wait(|e| (e["event"] == "cancelled" || e["event"] == "evaluated") && e["version"] == version);
    }
    let version = page.ok(json!({ "do": "undo" }))["version"].clone();
    page.evaluated(&version);
}

#[test]
fn two_clients_edit_one_document_without_losing_an_edit() {
    let folder = tempfile::tempdir().unwrap();
    let server = studio(folder.path());
    let address = server.address().to_string();
    let write = |who: &'static str| {
        let address = address.clone();
        std::thread::spawn(move || {
            let mut page = Client::connect(&address);
            for n in 0..25 {
                page.ok(json!({ "do": "set", "table": "parameters", "key": format!("{who}{n}"), "value": n }));
            }
        })
    };
    let [a, b] = ["a", "b"].map(write);
    a.join().unwrap();
    b.join().unwrap();
    let mut page = Client::connect(&address);
    let document = page.wait(|e| e["event"] == "document");
    assert_eq!(document["parameters"].as_object().unwrap().len(), 50);
    assert_eq!(document["version"], 50);
}

/// The program itself is ended without grace, again and again, while it saves.
#[cfg(unix)]
#[test]
fn whoever_is_killed_while_saving_leaves_a_whole_document() {
    let folder = tempfile::tempdir().unwrap();
    let padding = "# padding\n".repeat(20_000);
    for round in 0..4 {
        let mut child = Command::new(env!("CARGO_BIN_EXE_fusion-studio"))
            .args(["--no-open", "--root"])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = vec![];
        let mut out = child.stdout.take().unwrap();
        let mut byte = [0];
        while out.read(&mut byte).unwrap() == 1 && byte[0] != b'\n' {
            line.push(byte[0]);
        }
        let mut page = Client::connect(&String::from_utf8(line).unwrap());
        for n in 0..20 + 3 * round {
            let text = format!("version = 2\n{padding}[parameters]\nn = {n}\n");
            page.ok(json!({ "do": "text", "text": text }));
            page.send(json!({ "do": "save", "path": "a.toml" }));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        for file in ["a.toml", ".fusion-studio/autosave.toml"] {
            let Ok(text) = fs::read_to_string(folder.path().join(file)) else { continue };
            assert!(text.starts_with("version = 2\n") && text.contains("\nn = "), "{file} is whole");
            assert!(fusion::Document::parse(&text).is_ok());
        }
        assert!(folder.path().join("a.toml").exists());
    }
}

#[test]
fn an_unsaved_document_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    crate::client::two_balls(&folder.path().join("sub"), 1);
    {
        let server = studio(folder.path());
        let mut page = Client::connect(server.address());
        page.ok(json!({ "do": "add_part", "mesh": "sub/one.obj" }));
        let kept = folder.path().join(".fusion-studio/autosave.toml");
        for _ in 0..200 {
            if kept.exists() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let text = fs::read_to_string(&kept).unwrap();
        assert!(text.contains("mesh = \"../sub/one.obj\""), "{text}");
    }
    let server = studio(folder.path());
    let mut page = Client::connect(server.address());
    let offer = page.wait(|e| e["event"] == "autosave");
    let version = page.ok(json!({ "do": "open", "path": offer["path"] }))["version"].clone();
    let document = page.wait(|e| e["event"] == "document" && e["version"] == version);
    assert_eq!((&document["parts"][0]["mesh"], &document["path"]), (&json!("sub/one.obj"), &json!(null)));
    page.evaluated(&version);
    page.ok(json!({ "do": "save", "path": "sub/model.toml" }));
    assert!(fs::read_to_string(folder.path().join("sub/model.toml")).unwrap().contains("mesh = \"one.obj\""));
    for _ in 0..200 {
        if !folder.path().join(".fusion-studio/autosave.toml").exists() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("what is saved is not kept twice");
}
