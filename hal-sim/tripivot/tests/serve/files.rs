//! Files that are written or read: whole or not at all, and what cannot be written is found out before the work, not after it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use crate::served::Served;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("tripivot-files-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str) -> String {
        self.0.join(name).to_str().unwrap().to_owned()
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn tripivot(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(arguments)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn a_settings_file_that_could_not_be_made_is_in_nobodys_way() {
    let folder = Folder::new("half");
    let file = folder.file("settings");
    let limited = format!(
        "trap '' XFSZ; ulimit -f 8; exec {} serve --listen 127.0.0.1:0 --web off --settings {file}",
        env!("CARGO_BIN_EXE_tripivot")
    );
    let output = Command::new("sh").args(["-c", &limited]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(folder.names(), Vec::<String>::new());
}

#[test]
fn what_keeps_nothing_is_no_settings_file() {
    let folder = Folder::new("kinds");
    let fifo = folder.file("fifo");
    let made = Command::new("mkfifo").arg(&fifo).status().unwrap();
    assert!(made.success());
    for place in ["/dev/null", folder.0.to_str().unwrap(), &fifo] {
        let output = tripivot(&[
            "serve",
            "--listen",
            "127.0.0.1:0",
            "--web",
            "off",
            "--settings",
            place,
        ]);
        assert_eq!(output.status.code(), Some(2), "{place}");
        assert!(
            said(&output).contains("no file that keeps anything"),
            "{}",
            said(&output)
        );
    }
}

/// A file of settings, and what importing it comes to.
fn import(served: &Served, folder: &Folder, text: &str) -> Output {
    let file = folder.file("import");
    fs::write(&file, text).unwrap();
    tripivot(&[
        "settings",
        "import",
        &file,
        "--connect",
        &served.address.to_string(),
    ])
}

#[test]
fn an_import_is_taken_whole_or_not_at_all() {
    let served = Served::start(1.0, false);
    let folder = Folder::new("import");
    let mut client = served.ready();
    client.ask("MAC BEG keep\nMOV X 1\nMAC END\nERR?\n");
    for text in [
        // A single byte that stops the machine, a line too long, a value out of range, a macro that is none.
        "0x54500100 = 77\nmacro m\nMOV X 1\u{18}\nend\n",
        &format!("0x54500100 = 77\nmacro m\nMOV X {}\nend\n", "1".repeat(300)),
        "0x54500100 = 77\n0x54500101 = 999999\n",
        "0x54500100 = 77\nmacro keep\nMOV X 2\nend\nmacro m\nMOV X 3\nend\nmacro n\nNONSENSE\nend\n",
    ] {
        let output = import(&served, &folder, text);
        assert!(!output.status.success(), "{text}");
        assert_eq!(
            client.ask("SPA? 1 0x54500100\n"),
            "1 0x54500100=200\n",
            "{}",
            said(&output)
        );
        assert_eq!(client.ask("MAC?\n"), "keep\n", "{}", said(&output));
        assert_eq!(client.ask("MAC? keep\n"), "MOV X 1\n", "{}", said(&output));
    }
    let output = import(
        &served,
        &folder,
        "# \u{b5}m\n0x54500100 = 77 # \u{b5}m\nmacro m\nMOV X 3\nend\n",
    );
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(client.ask("SPA? 1 0x54500100\n"), "1 0x54500100=77\n");
    assert_eq!(client.ask("MAC? m\n"), "MOV X 3\n");
}

#[test]
fn an_export_that_fails_leaves_the_old_file() {
    let served = Served::start(1.0, false);
    let folder = Folder::new("export");
    let file = folder.file("settings");
    fs::write(&file, "old").unwrap();
    let limited = format!(
        "trap '' XFSZ; ulimit -f 1; exec {} settings export {file} --connect {}",
        env!("CARGO_BIN_EXE_tripivot"),
        served.address
    );
    let output = Command::new("sh").args(["-c", &limited]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");
    assert_eq!(folder.names(), ["settings"]);
}

#[test]
fn a_table_that_cannot_be_written_is_found_out_before_the_runs() {
    let begun = Instant::now();
    let output = tripivot(&[
        "faults",
        "--quiet",
        "--runs",
        "1000000",
        "--out",
        "/nowhere/x.csv",
    ]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said(&output).contains("/nowhere/x.csv: cannot be written"),
        "{}",
        said(&output)
    );
    assert!(begun.elapsed() < Duration::from_secs(60));
}

#[cfg(target_os = "linux")]
#[test]
fn results_are_printed_though_their_table_finds_no_room() {
    let output = tripivot(&["faults", "--quiet", "--runs", "2", "--out", "/dev/full"]);
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(told.contains("runs"), "{told}");
    assert!(
        said(&output).contains("/dev/full: cannot be written"),
        "{}",
        said(&output)
    );
}

#[test]
fn a_campaign_that_is_interrupted_tells_what_it_has_run() {
    let child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(["faults", "--quiet", "--runs", "1000000"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(2));
    let interrupted = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupted.unwrap().success());
    let output = child.wait_with_output().unwrap();
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("runs"), "{told}");
}

#[test]
fn an_endless_file_is_no_script() {
    let output = tripivot(&["run", "/dev/zero"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("more than"), "{}", said(&output));
    assert!(!Path::new("tripivot-demonstration").join("zero").exists());
}
