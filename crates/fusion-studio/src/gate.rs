//! Who is let in: requests with the token, to this host, from this page.
//!
//! A browser sends any page's requests to this machine, and does not apply its same-origin rules to WebSockets, so the server
//! decides itself. The token is in the path; pages of other origins cannot read it. `Host` is checked against names that are made to
//! lead here.

use axum::http::{HeaderMap, header};
use std::fmt::Write;

/// Hex digits of a token.
const DIGITS: usize = 32;

/// What a request must bring.
#[derive(Clone, Debug)]
pub struct Gate {
    token: String,
    hosts: [String; 2],
}

/// What a request is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A page or a file.
    Plain,
    /// A socket, which must say where it comes from.
    Socket,
}

impl Gate {
    /// A gate with a new token.
    ///
    /// # Errors
    /// Where the system has no random numbers.
    pub fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; DIGITS / 2];
        getrandom::fill(&mut bytes)?;
        let token = bytes.iter().fold(String::new(), |mut text, byte| {
            // Writing to a string does not fail.
            let _ = write!(text, "{byte:02x}");
            text
        });
        Ok(Self { token, hosts: ["127.0.0.1", "localhost"].map(|host| format!("{host}:{port}")) })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://{}/{}/", self.hosts[0], self.token)
    }

    /// What is behind the token of a path, `/TOKEN/REST`; `None` for another token.
    pub fn rest<'a>(&self, path: &'a str) -> Option<&'a str> {
        let (token, rest) = path.strip_prefix('/')?.split_at_checked(DIGITS)?;
        // All digits are compared whatever the first ones are.
        let differ = token.bytes().zip(self.token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        (differ == 0).then(|| rest.strip_prefix('/')).flatten()
    }

    /// Whether a request is to this host, and from its page where it says so.
    pub fn admits(&self, headers: &HeaderMap, kind: Kind) -> bool {
        let one = |name| {
            let mut all = headers.get_all(name).iter();
            let first = all.next().map(|value| value.to_str().unwrap_or_default());
            // Two of a kind are a trick.
            if all.next().is_some() { Some("") } else { first }
        };
        let Some(host) = one(header::HOST).filter(|host| self.hosts.iter().any(|own| own == host)) else {
            return false;
        };
        match one(header::ORIGIN) {
            Some(origin) => origin.strip_prefix("http://") == Some(host),
            None => kind == Kind::Plain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderName;

    fn admits(kind: Kind, pairs: &[(HeaderName, &str)]) -> bool {
        let gate = Gate::new(80).unwrap();
        let headers = pairs.iter().map(|(name, value)| (name.clone(), value.parse().unwrap()));
        let mut all = HeaderMap::new();
        for (name, value) in headers {
            all.append(name, value);
        }
        gate.admits(&all, kind)
    }

    #[test]
    fn only_this_host_and_its_own_page_are_let_in() {
        let (host, origin) = (header::HOST, header::ORIGIN);
        let own = (host.clone(), "127.0.0.1:80");
        assert!(admits(Kind::Plain, std::slice::from_ref(&own)));
        assert!(admits(Kind::Plain, &[(host.clone(), "localhost:80")]));
        assert!(!admits(Kind::Socket, std::slice::from_ref(&own)));
        assert!(admits(Kind::Socket, &[own.clone(), (origin.clone(), "http://127.0.0.1:80")]));
        for foreign in [
            "http://evil.example",
            "https://127.0.0.1:80",
            "http://localhost:80",
            "null",
            "",
            "http://127.0.0.1:80.evil.example",
        ] {
            assert!(!admits(Kind::Plain, &[own.clone(), (origin.clone(), foreign)]), "{foreign}");
        }
        for foreign in ["evil.example:80", "127.0.0.1", "127.0.0.1:81", ""] {
            assert!(!admits(Kind::Plain, &[(host.clone(), foreign)]), "{foreign}");
        }
        assert!(!admits(Kind::Plain, &[]));
        assert!(!admits(Kind::Plain, &[own.clone(), (host, "evil.example")]));
        assert!(!admits(
            Kind::Socket,
            &[own, (origin.clone(), "http://127.0.0.1:80"), (origin, "http://evil.example")]
        ));
    }

    #[test]
    fn tokens_differ_and_are_compared_whole() {
        let [one, other] = [(); 2].map(|()| Gate::new(80).unwrap());
        let path = one.address()["http://127.0.0.1:80".len()..].to_string() + "assets/a.js";
        assert_eq!(one.rest(&path), Some("assets/a.js"));
        assert_eq!(other.rest(&path), None);
        for bad in ["/", "", "//", "/assets", &path[1..], &path[..20], &path.replace("/assets", "assets")] {
            assert_eq!(one.rest(bad), None, "{bad}");
        }
    }
}
