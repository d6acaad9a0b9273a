//! Whoever is no client of the command language does nothing at its port: a page of somebody else's, a browser, TLS.

use std::io::{Read, Write};

use crate::served::Served;
use desk::serve::Notice;

/// What a page of another origin has a browser send without asking: `fetch` with `no-cors`, a form, an image.
const FOREIGN: [&str; 6] = [
    "POST / HTTP/1.1\r\nHost: 127.0.0.1:50000\r\nOrigin: http://evil.example\r\nContent-Type: text/plain\r\nContent-Length: 40\r\n\r\n\nFRF X\nVLS 7\nMOV X 30\n",
    "POST /?VLS=7 HTTP/1.1\r\n\r\nFRF X\nVLS 7=\r\nVLS 7\n",
    "GET /x.png HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n\nVLS 7\n",
    "\r\nPOST / HTTP/1.1\nVLS 7\n",
    "FROB /very/long HTTP/1.1\r\nHost: here\r\n\r\nVLS 7\n",
    "CSV?\nHost: here\nVLS 7\n",
];

#[test]
fn what_a_browser_sends_is_cut_off_before_any_line_of_it_is_carried_out() {
    let served = Served::start(1.0, false);
    let mut client = served.connect();
    for request in FOREIGN {
        // Whole, and in pieces that arrive one by one.
        for piece in [request.len(), 1, 7] {
            let mut browser = served.connect();
            for bytes in request.as_bytes().chunks(piece) {
                // It may be cut off meanwhile.
                let _ = browser.port.write_all(bytes);
            }
            served.notice(|notice| matches!(notice, Notice::NoClient(_)));
            let mut rest = Vec::new();
            // Closed or reset, as the system has it.
            let _ = browser.port.read_to_end(&mut rest);
            assert_eq!(client.ask("VLS?\n"), "200\n", "{request:?}");
            assert_eq!(client.ask("FRF? X\n"), "X=0\n", "{request:?}");
        }
    }
}

#[test]
fn other_protocols_are_cut_off_at_their_first_byte() {
    let served = Served::start(1.0, false);
    // TLS, and what a page can make a browser send to a relay of calls.
    for first in [
        b"\x16\x03\x01\nVLS 7\n".as_slice(),
        b"\x00\x03\nVLS 7\n",
        b"\xc3\nVLS 7\n",
    ] {
        let mut other = served.connect();
        other.port.write_all(first).unwrap();
        served.notice(|notice| matches!(notice, Notice::NoClient(_)));
        assert_eq!(served.connect().ask("VLS?\n"), "200\n");
    }
}

#[test]
fn lines_of_clients_are_not_taken_for_a_browser() {
    let served = Served::start(1.0, false);
    let mut client = served.connect();
    for line in ["GET\n", "POST?\n", "VAR HOST 1\n", "DELETE X\n", "HOST\n"] {
        client.send(line);
    }
    client.ask("ERR?\n");
    assert_eq!(client.ask("\x05"), "0\n");
    assert_eq!(client.ask("CSV?\n"), "2.0\n");
}
