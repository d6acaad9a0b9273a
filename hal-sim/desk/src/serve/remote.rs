//! Addresses that other machines can reach.

use std::net::ToSocketAddrs;

use super::ServeError;

/// What listening at an address that others reach means.
pub const REMOTE_MEANS: &str = "anybody who reaches this address can drive the stage: the command language knows no password and is not encrypted";

/// What a page at such an address means.
pub const REMOTE_PAGE_MEANS: &str = "other machines can reach the page, which asks them for its password; nothing is encrypted unless a proxy with TLS stands in front (--public-url)";

/// Whether other machines can reach it. An address that names nothing is for whoever listens there to refuse.
#[must_use]
pub fn is_remote(address: &str) -> bool {
    (address.to_socket_addrs())
        .is_ok_and(|mut places| places.any(|place| !place.ip().is_loopback()))
}

/// Whether other machines can reach `address`; only if that is allowed.
///
/// # Errors
/// [`ServeError::Remote`].
pub fn check_address(address: &str, is_allowed: bool) -> Result<bool, ServeError> {
    match is_remote(address) {
        true if !is_allowed => Err(ServeError::Remote(address.to_owned())),
        is_remote => Ok(is_remote),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_reaches_its_own_addresses() {
        for own in [
            "127.0.0.1:50000",
            "127.1.2.3:0",
            "[::1]:8080",
            "localhost:1",
            "nowhere.invalid:1",
            "",
        ] {
            assert!(
                check_address(own, false).is_ok_and(|remote| !remote),
                "{own}"
            );
        }
        for remote in ["0.0.0.0:50000", "[::]:0", "192.0.2.1:8080"] {
            let refused = check_address(remote, false).unwrap_err().to_string();
            assert!(refused.contains("--allow-remote"), "{refused}");
            assert!(check_address(remote, true).unwrap(), "{remote}");
        }
    }
}
