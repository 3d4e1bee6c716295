//! A client as a browser is one: plain HTTP, and the socket.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// Nothing here takes longer, on a machine that does other work as well.
const PATIENCE: Duration = Duration::from_secs(120);

/// `127.0.0.1:PORT` and `/TOKEN` of an address.
pub fn parts(address: &str) -> (String, String) {
    let rest = address.strip_prefix("http://").unwrap().trim_end_matches('/');
    let (host, token) = rest.split_once('/').unwrap();
    (host.into(), format!("/{token}"))
}

/// Sends bytes as they are, and gives status and body.
pub fn raw(host: &str, request: &[u8]) -> (u16, Vec<u8>) {
    let mut stream = TcpStream::connect(host).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    // The server may refuse before it has read everything.
    let _ = stream.write_all(request);
    let mut answer = vec![];
    let _ = stream.read_to_end(&mut answer);
    let end = answer.windows(4).position(|w| w == b"\r\n\r\n").map_or(answer.len(), |i| i + 4);
    let head = String::from_utf8_lossy(&answer[..end]).into_owned();
    let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or(0);
    (status, answer[end..].to_vec())
}

/// A request with these headers besides the usual ones.
pub fn get(address: &str, path: &str, headers: &[(&str, &str)]) -> (u16, Vec<u8>) {
    let (host, token) = parts(address);
    let more = headers.iter().fold(String::new(), |all, (name, value)| format!("{all}{name}: {value}\r\n"));
    let own = if headers.iter().any(|h| h.0.eq_ignore_ascii_case("host")) {
        String::new()
    } else {
        format!("Host: {host}\r\n")
    };
    raw(&host, format!("GET {token}{path} HTTP/1.1\r\n{own}{more}Connection: close\r\n\r\n").as_bytes())
}

/// Uploads a file.
pub fn post(address: &str, path: &str, body: &[u8]) -> (u16, Value) {
    let (host, token) = parts(address);
    let head = format!(
        "POST {token}{path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    let (status, body) = raw(&host, &[head.as_bytes(), body].concat());
    (status, serde_json::from_slice(&body).unwrap_or_default())
}

/// A mesh frame, or another.
#[derive(Clone, Debug)]
pub struct Frame {
    pub header: Value,
    pub arrays: BTreeMap<String, Vec<[u8; 4]>>,
}

impl Frame {
    pub fn read(bytes: &[u8]) -> Self {
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
        let mut at = 4 + length;
        assert_eq!(at % 8, 0);
        let mut arrays = BTreeMap::new();
        for array in header["arrays"].as_array().unwrap() {
            let count = array["length"].as_u64().unwrap() as usize;
            let numbers = bytes[at..at + 4 * count].chunks_exact(4).map(|c| c.try_into().unwrap()).collect();
            arrays.insert(array["name"].as_str().unwrap().to_string(), numbers);
            at += 4 * count;
        }
        assert_eq!(at, bytes.len());
        Self { header, arrays }
    }

    pub fn f32(&self, name: &str) -> Vec<f32> {
        self.arrays[name].iter().map(|&b| f32::from_le_bytes(b)).collect()
    }

    pub fn u32(&self, name: &str) -> Vec<u32> {
        self.arrays[name].iter().map(|&b| u32::from_le_bytes(b)).collect()
    }
}

/// A page.
pub struct Client {
    pub socket: WebSocket<TcpStream>,
    next: u64,
    /// What came by itself and was not looked at yet.
    pub events: Vec<Value>,
    /// The newest frame of every shape.
    pub shapes: BTreeMap<String, Frame>,
    /// Frames that came, in all.
    pub frames: usize,
}

impl Client {
    pub fn connect(address: &str) -> Self {
        let (host, _) = parts(address);
        Self::try_connect(address, Some(&format!("http://{host}")), None).unwrap()
    }

    /// With an origin and another host, or the status that refuses it.
    pub fn try_connect(address: &str, origin: Option<&str>, other_host: Option<&str>) -> Result<Self, u16> {
        let (host, token) = parts(address);
        let mut request = format!("ws://{host}{token}/socket").into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("Origin", origin.parse().unwrap());
        }
        if let Some(host) = other_host {
            request.headers_mut().insert("Host", host.parse().unwrap());
        }
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Self { socket, next: 1, events: vec![], shapes: BTreeMap::new(), frames: 0 }),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(answer))) => {
                Err(answer.status().as_u16())
            }
            Err(e) => panic!("{e}"),
        }
    }

    /// Sends a request and gives its number.
    pub fn send(&mut self, mut request: Value) -> u64 {
        let id = self.next;
        self.next += 1;
        request["id"] = id.into();
        self.socket.send(Message::text(request.to_string())).unwrap();
        id
    }

    /// Reads one message: an answer, or `None` for what was put aside.
    fn read(&mut self) -> Option<Value> {
        match self.socket.read().unwrap() {
            Message::Text(text) => {
                let json: Value = serde_json::from_str(&text).unwrap();
                if json.get("event").is_some() {
                    self.events.push(json);
                    return None;
                }
                Some(json)
            }
            Message::Binary(bytes) => {
                let frame = Frame::read(&bytes);
                self.frames += 1;
                if frame.header["frame"] == "mesh" {
                    self.shapes.insert(frame.header["shape"].as_str().unwrap().into(), frame);
                } else {
                    self.shapes.insert(frame.header["what"].as_str().unwrap().into(), frame);
                }
                None
            }
            _ => None,
        }
    }

    /// Asks, and gives the whole answer.
    pub fn ask(&mut self, request: Value) -> Value {
        let id = self.send(request);
        loop {
            if let Some(answer) = self.read()
                && answer["re"] == id
            {
                return answer;
            }
        }
    }

    /// Asks for what is granted.
    pub fn ok(&mut self, request: impl Into<Value>) -> Value {
        let request = request.into();
        let answer = self.ask(request.clone());
        assert!(answer.get("ok").is_some(), "{request}: {answer}");
        answer["ok"].clone()
    }

    /// Asks for what is refused, and gives the sentence.
    pub fn refused(&mut self, request: impl Into<Value>) -> String {
        let request = request.into();
        let answer = self.ask(request.clone());
        answer["error"]["sentence"].as_str().unwrap_or_else(|| panic!("{request}: {answer}")).into()
    }

    /// The next event that is wanted; what came before it is dropped.
    pub fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            if let Some(i) = self.events.iter().position(&wanted) {
                return self.events.drain(..=i).next_back().unwrap();
            }
            assert!(start.elapsed() < PATIENCE, "no such event");
            let _ = self.read();
        }
    }

    /// The evaluation of a version, or of a later one.
    pub fn evaluated(&mut self, version: &Value) -> Value {
        let version = version.as_u64().unwrap();
        self.wait(|e| e["event"] == "evaluated" && e["version"].as_u64() >= Some(version))
    }
}

/// Two balls that cross, as files.
pub fn two_balls(folder: &Path, subdivisions: u32) {
    use fusion::mesh_core::shapes;
    let ball = shapes::icosphere(1.0, subdivisions);
    let other = shapes::posed(ball.clone(), glam::DQuat::from_rotation_x(0.3), glam::DVec3::new(0.9, 0.31, 0.17));
    mesh_io::write(&ball.into(), &folder.join("one.obj")).unwrap();
    mesh_io::write(&other.into(), &folder.join("two.obj")).unwrap();
}

/// A server with those two on its desk, their union and its seam's fillet.
pub fn union_of_balls(folder: &Path) -> (fusion_studio::Server, Client) {
    two_balls(folder, 3);
    let mut options = fusion_studio::Options::default();
    options.root = Some(folder.to_path_buf());
    options.files = ["one.obj", "two.obj"].map(|name| folder.join(name)).to_vec();
    let server = fusion_studio::Server::start(&options).unwrap();
    let mut client = Client::connect(server.address());
    let step =
        json!({ "do": "add_step", "verb": "union", "of": ["one", "two"], "as": "both", "options": { "radius": 0.1 } });
    let version = client.ok(step)["version"].clone();
    client.evaluated(&version);
    (server, client)
}
