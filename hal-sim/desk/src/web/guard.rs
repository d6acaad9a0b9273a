//! Who may look and who may drive.
//!
//! A page of somebody else's in the same browser can send requests here, but it cannot forge their `Host` and `Origin`. Its
//! own name made to point at this machine shows in `Host`, which therefore has to be an address, `localhost`, or the name
//! that the page was told to listen at; its script's connection shows in `Origin`, which has to be the page's own. Where a proxy
//! stands in front of the page, the host and origin that browsers know are told by an option. Driving takes the token besides,
//! which only the page's own scripts can read.

use std::io;
use std::net::{IpAddr, SocketAddr};

use super::password::{is_same, random_text};

use axum::http::HeaderMap;
use axum::http::header::{HOST, ORIGIN};

/// What proxies tell of their clients.
const FORWARDED_FOR: &str = "x-forwarded-for";
/// Bytes of randomness in a token.
const TOKEN_BYTES: usize = 16;

/// The rules of one server.
#[derive(Debug)]
pub(super) struct Guard {
    /// The name that it was told to listen at.
    name: String,
    /// Scheme, host and port by which browsers know it besides.
    public_origin: Option<String>,
    token: String,
}

impl Guard {
    /// For a page at `address`, which was asked for as host and port, and known to browsers at `public_url` besides; with a token
    /// of its own.
    pub fn new(address: &str, public_url: Option<&str>) -> io::Result<Self> {
        Ok(Self {
            name: host_name(address).to_ascii_lowercase(),
            public_origin: public_url.map(|url| url.trim_end_matches('/').to_ascii_lowercase()),
            token: random_text(TOKEN_BYTES)?,
        })
    }

    /// Whether browsers know it over TLS.
    pub fn is_secure(&self) -> bool {
        (self.public_origin.as_deref()).is_some_and(|origin| origin.starts_with("https://"))
    }

    /// Where a request comes from: where a proxy on this machine stands in front of the page, the address that the proxy itself
    /// has added, which is the last.
    pub fn client(&self, peer: IpAddr, headers: &HeaderMap) -> IpAddr {
        let told = headers.get_all(FORWARDED_FOR).iter().next_back();
        let last = (told.and_then(|value| value.to_str().ok()))
            .and_then(|value| value.rsplit(',').next()?.trim().parse().ok());
        match last {
            Some(client) if self.public_origin.is_some() && peer.is_loopback() => client,
            _ => peer,
        }
    }

    /// What requests have to bring along.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Whether it is the token.
    pub fn knows(&self, token: &str) -> bool {
        is_same(&self.token, token)
    }

    /// Whether the request names a host that is this one.
    pub fn allows_host(&self, headers: &HeaderMap) -> bool {
        host(headers).is_some_and(|host| {
            let name = host_name(host).to_ascii_lowercase();
            let address = name.trim_start_matches('[').trim_end_matches(']');
            let public =
                (self.public_origin.as_deref()).and_then(|origin| origin.split_once("://"));
            name == "localhost"
                || name == self.name
                || address.parse::<IpAddr>().is_ok()
                || public.is_some_and(|(_, place)| place == host.to_ascii_lowercase())
        })
    }

    /// Whether the request comes from a page of this server.
    pub fn allows_origin(&self, headers: &HeaderMap) -> bool {
        let origin = headers.get(ORIGIN).and_then(|origin| origin.to_str().ok());
        let is_public =
            |origin: &str| (self.public_origin.as_deref()) == Some(&origin.to_ascii_lowercase());
        match (origin, host(headers)) {
            (Some(origin), _) if is_public(origin) => true,
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
        let guard = Guard::new("bench.lab:8080", None).unwrap();
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
        let guard = Guard::new("127.0.0.1:8080", None).unwrap();
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
    fn behind_a_proxy_the_page_is_known_by_its_public_name_too() {
        let guard = Guard::new("127.0.0.1:8080", Some("https://Stage.lab/")).unwrap();
        assert!(guard.is_secure());
        assert!(guard.allows_host(&headers("stage.lab", None)));
        assert!(guard.allows_origin(&headers("stage.lab", Some("https://stage.lab"))));
        assert!(guard.allows_origin(&headers("127.0.0.1:8080", Some("https://stage.lab"))));
        for origin in [
            "http://stage.lab",
            "https://stage.lab.evil",
            "https://evil.lab",
        ] {
            assert!(
                !guard.allows_origin(&headers("127.0.0.1:8080", Some(origin))),
                "{origin}"
            );
        }
        assert!(!guard.allows_host(&headers("evil.lab", None)));
    }

    #[test]
    fn a_proxy_says_whose_request_it_is_and_nobody_else_does() {
        let [local, far, told] = [[127, 0, 0, 1], [192, 0, 2, 1], [192, 0, 2, 9]].map(IpAddr::from);
        let mut headers = headers("stage.lab", None);
        let direct = Guard::new("127.0.0.1:8080", None).unwrap();
        let behind = Guard::new("127.0.0.1:8080", Some("https://stage.lab")).unwrap();
        assert_eq!(behind.client(local, &headers), local);
        // What the client has made up stands before what the proxy knows.
        headers.append(FORWARDED_FOR, "198.51.100.1".parse().unwrap());
        headers.append(FORWARDED_FOR, "198.51.100.2, 192.0.2.9".parse().unwrap());
        assert_eq!(behind.client(local, &headers), told);
        assert_eq!(behind.client(far, &headers), far);
        assert_eq!(direct.client(local, &headers), local);
        headers.append(FORWARDED_FOR, "unknown".parse().unwrap());
        assert_eq!(behind.client(local, &headers), local);
    }

    #[test]
    fn the_token_is_known_whole_and_new_each_time() {
        let guard = Guard::new("127.0.0.1:8080", None).unwrap();
        let token = guard.token().to_owned();
        assert_eq!(token.len(), 2 * TOKEN_BYTES);
        assert!(guard.knows(&token));
        assert!(!guard.knows(""));
        assert!(!guard.knows(&token[1..]));
        assert!(!guard.knows(&format!("{token}0")));
        assert!(!guard.knows(&token.replace(|c: char| c.is_ascii_digit(), "x")));
        assert_ne!(token, Guard::new("127.0.0.1:8080", None).unwrap().token());
    }
}
