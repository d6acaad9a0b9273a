//! Whether what comes in is the command language. A page of somebody else's can make a browser connect to any port and send
//! requests whose bodies are lines of GCS, so who speaks another protocol is not a client.

/// Beginnings of HTTP's request lines.
const METHODS: [&[u8]; 9] = [
    b"GET /",
    b"POST /",
    b"HEAD /",
    b"PUT /",
    b"PATCH /",
    b"DELETE /",
    b"OPTIONS /",
    b"CONNECT /",
    b"TRACE /",
];
/// Beginnings of HTTP's header lines, in small letters, as they reach a connection whose request line was not known.
const HEADERS: [&[u8]; 2] = [b"host:", b"origin:"];
/// What every request line has before its version.
const VERSION: &[u8; 6] = b" HTTP/";
/// Bytes of a line that its beginning is known by.
const HEAD_BYTES: usize = 9;

/// Looks at all bytes of a connection, in the order in which they come, before any of them is carried out.
#[derive(Clone, Debug, Default)]
pub struct ProtocolCheck {
    started: bool,
    /// The beginning of the line under way.
    head: [u8; HEAD_BYTES],
    head_bytes: usize,
    /// The latest bytes of the line under way.
    tail: [u8; VERSION.len()],
}

impl ProtocolCheck {
    /// Whether these bytes, after those before them, can be a client's. A line of another protocol is known before its end.
    pub fn accepts(&mut self, bytes: &[u8]) -> bool {
        bytes.iter().all(|&byte| self.accepts_byte(byte))
    }

    fn accepts_byte(&mut self, byte: u8) -> bool {
        if !self.started {
            self.started = true;
            if !begins_gcs(byte) {
                return false;
            }
        }
        if byte == b'\n' || byte == b'\r' {
            *self = Self {
                started: true,
                ..Self::default()
            };
            return true;
        }
        if let Some(place) = self.head.get_mut(self.head_bytes) {
            *place = byte;
            self.head_bytes += 1;
        }
        self.tail.rotate_left(1);
        self.tail[VERSION.len() - 1] = byte;
        &self.tail != VERSION && !self.begins_http()
    }

    fn begins_http(&self) -> bool {
        let head = &self.head[..self.head_bytes];
        METHODS.iter().any(|method| head.starts_with(method))
            || (HEADERS.iter()).any(|header| head.to_ascii_lowercase().starts_with(header))
    }
}

/// What a client's first byte may be: printable, the end of a line, or a single-byte command. TLS and binary protocols begin
/// with others.
const fn begins_gcs(byte: u8) -> bool {
    matches!(byte, b' '..=b'~' | b'\n' | b'\r' | 3..=9 | 24)
}
