//! The password of a page that others than this machine may reach: asked for once a browser, remembered in a cookie, slower with
//! every wrong try.

use std::collections::HashMap;
use std::io;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use axum::http::HeaderMap;
use axum::http::header::COOKIE;

/// Bytes of randomness in a cookie.
const COOKIE_BYTES: usize = 16;
/// Bytes of randomness in a password that is made.
const PASSWORD_BYTES: usize = 8;
/// Name of the cookie.
const NAME: &str = "tripivot";
/// The wait after the first wrong try; it doubles with every other.
const FIRST_WAIT: Duration = Duration::from_secs(1);
/// The longest wait.
const LONGEST_WAIT: Duration = Duration::from_secs(60);
/// Addresses that are remembered for their wrong tries.
const ADDRESSES: usize = 1024;

/// So many bytes of randomness in hexadecimal.
pub(super) fn random_text(bytes: usize) -> io::Result<String> {
    let mut random = vec![0; bytes];
    getrandom::fill(&mut random).map_err(io::Error::other)?;
    Ok(random.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// A password that nobody guesses.
///
/// # Errors
/// There is no randomness to be had.
pub fn new_password() -> io::Result<String> {
    random_text(PASSWORD_BYTES)
}

/// Whether two texts are the same. Takes as long for a wrong one as for the right one.
pub(super) fn is_same(own: &str, other: &str) -> bool {
    let pairs = own.bytes().zip(other.bytes());
    let same = pairs.fold(0, |difference, (a, b)| difference | (a ^ b)) == 0;
    same && own.len() == other.len()
}

/// A password, and who has failed to give it.
pub(super) struct Password {
    text: String,
    cookie: String,
    wrong: Mutex<HashMap<IpAddr, WrongTries>>,
}

/// Wrong tries from an address.
#[derive(Clone, Copy)]
struct WrongTries {
    wait: Duration,
    until: Instant,
}

/// Why a try is not the password.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum WrongPassword {
    #[error("that is not the password")]
    Wrong,
    #[error("too soon after a wrong password: try again in {} s", .0.as_secs() + 1)]
    TooSoon(Duration),
}

impl Password {
    pub fn new(text: String) -> io::Result<Self> {
        Ok(Self {
            text,
            cookie: random_text(COOKIE_BYTES)?,
            wrong: Mutex::default(),
        })
    }

    /// Whether a browser has given it before.
    pub fn was_given(&self, headers: &HeaderMap) -> bool {
        (headers.get_all(COOKIE).iter())
            .filter_map(|value| value.to_str().ok())
            .flat_map(|value| value.split(';'))
            .filter_map(|cookie| cookie.trim().strip_prefix(NAME)?.strip_prefix('='))
            .any(|cookie| is_same(&self.cookie, cookie))
    }

    /// What a browser is to send from now on; over TLS alone where the page is reached so.
    pub fn cookie(&self, is_secure: bool) -> String {
        let secure = if is_secure { "; Secure" } else { "" };
        format!(
            "{NAME}={}; Path=/; HttpOnly; SameSite=Strict{secure}",
            self.cookie
        )
    }

    /// A try from an address.
    pub fn check(&self, from: IpAddr, text: &str, now: Instant) -> Result<(), WrongPassword> {
        let mut wrong = self.wrong.lock().unwrap_or_else(PoisonError::into_inner);
        let before = wrong.get(&from).copied();
        if let Some(WrongTries { until, .. }) = before
            && now < until
        {
            return Err(WrongPassword::TooSoon(until - now));
        }
        if is_same(&self.text, text) {
            wrong.remove(&from);
            return Ok(());
        }
        if wrong.len() >= ADDRESSES {
            wrong.retain(|_, tries| now < tries.until);
        }
        let wait = before.map_or(FIRST_WAIT, |tries| (tries.wait * 2).min(LONGEST_WAIT));
        let until = now + wait;
        wrong.insert(from, WrongTries { wait, until });
        Err(WrongPassword::Wrong)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_tries_make_an_address_wait_longer_each_time_and_no_other() {
        let password = Password::new("a good one".to_owned()).unwrap();
        let (one, other) = (IpAddr::from([192, 0, 2, 1]), IpAddr::from([192, 0, 2, 2]));
        let mut now = Instant::now();
        for wait_s in [1, 2, 4, 8, 16, 32, 60, 60] {
            assert_eq!(
                password.check(one, "a bad one", now),
                Err(WrongPassword::Wrong)
            );
            now += Duration::from_secs(wait_s) - Duration::from_millis(1);
            let soon = password.check(one, "a good one", now);
            assert_eq!(soon, Err(WrongPassword::TooSoon(Duration::from_millis(1))));
            assert_eq!(password.check(other, "a good one", now), Ok(()));
            now += Duration::from_millis(1);
        }
        assert_eq!(password.check(one, "a good one", now), Ok(()));
        assert_eq!(
            password.check(one, "a good one ", now),
            Err(WrongPassword::Wrong)
        );
    }

    #[test]
    fn a_browser_is_known_by_its_cookie() {
        let password = Password::new("a good one".to_owned()).unwrap();
        let cookie = password.cookie(true);
        let (pair, rest) = cookie.split_once("; ").unwrap();
        assert_eq!(rest, "Path=/; HttpOnly; SameSite=Strict; Secure");
        let knows = |text: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(COOKIE, text.parse().unwrap());
            password.was_given(&headers)
        };
        assert!(knows(pair));
        assert!(knows(&format!("a=b; {pair}; c=d")));
        assert!(!knows(&pair[..pair.len() - 1]));
        assert!(!knows("tripivot="));
        assert!(!knows(&format!("x{pair}")));
    }
}
