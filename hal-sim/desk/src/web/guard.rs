//! Who may look and who may drive.
//!
//! A page of somebody else's in the same browser can send requests here, but it cannot forge their `Host` and `Origin`. Its
//! own name made to point at this machine shows in `Host`, which therefore has to be an address, `localhost`, or the name
//! that the page was told to listen at; its script's connection shows in `Origin`, which has to be the page's own. Driving
//! takes the token besides, which only the page's own scripts can read.

use std::io;
use std::net::{IpAddr, SocketAddr};

use axum::http::HeaderMap;
use axum::http::header::{HOST, ORIGIN};

/// Bytes of randomness in a token.
const TOKEN_BYTES: usize = 16;

/// The rules of one server.
#[derive(Debug)]
pub(super) struct Guard {
    /// The name that it was told to listen at.
    name: String,
    token: String,
}

impl Guard {
    /// For a page at `address`, which was asked for as host and port; with a token of its own.
    pub fn new(address: &str) -> io::Result<Self> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes).map_err(io::Error::other)?;
        Ok(Self {
            name: host_name(address).to_ascii_lowercase(),
            token: bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }

    /// What requests have to bring along.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Whether it is the token. Takes as long for a wrong one as for the right one.
    pub fn knows(&self, token: &str) -> bool {
        let (own, other) = (self.token.as_bytes(), token.as_bytes());
        let pairs = own.iter().zip(other);
        let same = pairs.fold(0, |difference, (a, b)| difference | (a ^ b)) == 0;
        same && own.len() == other.len()
    }

    /// Whether the request names a host that is this one.
    pub fn allows_host(&self, headers: &HeaderMap) -> bool {
        host(headers).is_some_and(|host| {
            let name = host_name(host).to_ascii_lowercase();
            let address = name.trim_start_matches('[').trim_end_matches(']');
            name == "localhost" || name == self.name || address.parse::<IpAddr>().is_ok()
        })
    }

    /// Whether the request comes from a page of this server.
    pub fn allows_origin(&self, headers: &HeaderMap) -> bool {
        let origin = headers.get(ORIGIN).and_then(|origin| origin.to_str().ok());
        match (origin, host(headers)) {
            (Some(origin), Some(host)) => origin
                .strip_prefix("http://")
                .is_some_and(|place| place.eq_ignore_ascii_case(host)),
            _ => false,
        }
    }
}

fn host(headers: &HeaderMap) -> Option<&str> {
    headers.get(HOST)?.to_str().ok()
}

/// Host and port without the port.
fn host_name(place: &str) -> &str {
    if place.parse::<SocketAddr>().is_err() && place.ends_with(']') {
        return place;
    }
    place.rsplit_once(':').map_or(place, |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(ORIGIN, origin.parse().unwrap());
        }
        headers
    }

    #[test]
    fn a_name_of_somebody_else_that_points_here_is_not_this_host() {
        let guard = Guard::new("bench.lab:8080").unwrap();
        for host in [
            "127.0.0.1:8080",
            "127.0.0.1",
            "[::1]:8080",
            "[::1]",
            "localhost:9",
            "Bench.lab:8080",
        ] {
            assert!(guard.allows_host(&headers(host, None)), "{host}");
        }
        for host in [
            "evil.example:8080",
            "127.0.0.1.evil.example",
            "bench.lab.evil:8080",
            "",
        ] {
            assert!(!guard.allows_host(&headers(host, None)), "{host}");
        }
    }

    #[test]
    fn only_the_own_page_may_connect() {
        let guard = Guard::new("127.0.0.1:8080").unwrap();
        let own = "127.0.0.1:8080";
        assert!(guard.allows_origin(&headers(own, Some("http://127.0.0.1:8080"))));
        for origin in [
            None,
            Some("null"),
            Some("http://127.0.0.1:8081"),
            Some("http://localhost:8080"),
            Some("https://127.0.0.1:8080"),
            Some("http://evil.example"),
        ] {
            assert!(!guard.allows_origin(&headers(own, origin)), "{origin:?}");
        }
    }

    #[test]
    fn the_token_is_known_whole_and_new_each_time() {
        let guard = Guard::new("127.0.0.1:8080").unwrap();
        let token = guard.token().to_owned();
        assert_eq!(token.len(), 2 * TOKEN_BYTES);
        assert!(guard.knows(&token));
        assert!(!guard.knows(""));
        assert!(!guard.knows(&token[1..]));
        assert!(!guard.knows(&format!("{token}0")));
        assert!(!guard.knows(&token.replace(|c: char| c.is_ascii_digit(), "x")));
        assert_ne!(token, Guard::new("127.0.0.1:8080").unwrap().token());
    }
}
