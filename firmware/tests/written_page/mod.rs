//! A page that a test writes, and holds to what it would write.

use std::path::Path;

/// Fails when the page of this name is not this text; with `UPDATE` set, writes it.
pub fn hold(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, text).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == text,
        "{name} is not what the tables say: UPDATE=1 in front of this test's command writes it"
    );
}
