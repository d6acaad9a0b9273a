//! Settings over a restart of the program, and as a readable file, as a user meets them.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Far longer than anything here takes, on a busy machine too.
const PATIENCE: Duration = Duration::from_secs(60);

fn tripivot(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(arguments)
        .output()
        .unwrap()
}

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("settings")
        .join(name);
    // Not there at the first run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A served stage.
struct Served {
    child: Child,
    address: String,
}

impl Served {
    fn start(settings: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .args([
                "serve",
                "--listen",
                "127.0.0.1:0",
                "--web",
                "off",
                "--settings",
            ])
            .arg(settings)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut line).unwrap();
        // Read on, so that its notices find somebody.
        std::thread::spawn(move || out.lines().count());
        let address = line.trim().strip_prefix("listening at ").unwrap();
        Self {
            child,
            address: address.to_owned(),
        }
    }

    /// What a client is answered up to its own last line, an `ERR?`.
    fn say(&self, lines: &str) -> String {
        let mut port = TcpStream::connect(&self.address).unwrap();
        port.set_read_timeout(Some(PATIENCE)).unwrap();
        port.write_all(format!("{lines}\n*IDN?\n").as_bytes())
            .unwrap();
        let mut text = String::new();
        let mut bytes = [0; 4096];
        while !text.contains("Tripivot") {
            let count = port.read(&mut bytes).unwrap();
            assert_ne!(count, 0, "{text}");
            text += &String::from_utf8_lossy(&bytes[..count]);
        }
        let end = text.rfind("(c)").unwrap();
        text[..end].to_owned()
    }

    fn settings(&self, what: &str, file: &Path) -> Output {
        let file = file.to_str().unwrap();
        tripivot(&["settings", what, file, "--connect", &self.address])
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // As a power cut does.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn said(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn complaint(output: &Output, code: i32) -> String {
    assert_eq!(output.status.code(), Some(code), "{output:?}");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

#[test]
fn a_file_keeps_what_was_kept_over_a_restart_of_the_program() {
    let kept = folder("restart").join("kept.bin");
    let served = Served::start(&kept);
    let lines = "SPA 1 0x54500100 120\nMAC BEG scan\nMOV X 5\nMAC END\nWPA 100\nERR?";
    assert_eq!(served.say(lines), "0\n");
    assert_eq!(served.say("SPA 1 0x54500100 90\nERR?"), "0\n");
    // Started again by command, it has what was kept too.
    assert_eq!(served.say("RBT\nERR?"), "0\n");
    let asked = "DEL 5\nSPA? 1 0x54500100\nERR?";
    assert_eq!(served.say(asked), "1 0x54500100=120\n0\n");
    drop(served);
    let served = Served::start(&kept);
    assert_eq!(served.say("VLS?\nMAC? scan\nERR?"), "120\nMOV X 5\n0\n");

    // Two controllers cannot have it.
    let other = tripivot(&[
        "serve",
        "--listen",
        "127.0.0.1:0",
        "--settings",
        kept.to_str().unwrap(),
    ]);
    assert!(complaint(&other, 2).contains("in use by another controller"));
    drop(served);

    // A script's controller starts with it as well.
    let script = kept.with_file_name("script.gcs");
    fs::write(&script, "VLS?\n").unwrap();
    let out = kept.with_file_name("out");
    let [script, kept, out] = [&script, &kept, &out].map(|path| path.to_str().unwrap());
    let run = tripivot(&["run", script, "--settings", kept, "--out", out, "--quiet"]);
    assert!(said(&run).starts_with("VLS?\n120\n"));

    // Damaged: it says so and does nothing; and nothing else is taken for such a file.
    let mut bytes = fs::read(kept).unwrap();
    let image = bytes.iter().rposition(|&byte| byte == b'5').unwrap();
    bytes[image] ^= 1;
    fs::write(kept, &bytes).unwrap();
    let run = tripivot(&["run", script, "--settings", kept, "--out", out, "--quiet"]);
    assert!(complaint(&run, 1).contains("kept settings are damaged"));
    let run = tripivot(&["run", script, "--settings", script, "--out", out, "--quiet"]);
    assert!(complaint(&run, 2).contains("not such a file"));
}

#[test]
fn what_can_no_longer_be_kept_is_told() {
    let file = folder("unlinked").join("stage.settings");
    let served = Served::start(&file);
    assert_eq!(served.say("WPA 100\nERR?"), "0\n");
    fs::remove_file(&file).unwrap();
    assert_eq!(served.say("WPA 100\nERR?"), "4001\n");
}

#[test]
fn an_endless_file_is_no_settings() {
    let served = Served::start(&folder("endless").join("stage.settings"));
    let output = served.settings("import", Path::new("/dev/zero"));
    assert!(complaint(&output, 2).contains("more than"), "{output:?}");
}

#[test]
fn settings_go_from_one_controller_to_another_as_text() {
    let folder = folder("text");
    let file = folder.join("stage.txt");
    let first = Served::start(&folder.join("first.bin"));
    let lines = "CCL 1 ADVANCED\nSPA 1 0x54500107 100 1 0x54500200 150 1 0x54500300 0.1\nMAC BEG scan\nMOV X $1\nDEL 5\nMAC END\nERR?";
    assert_eq!(first.say(lines), "0\n");
    let exported = said(&first.settings("export", &file));
    assert!(
        exported.contains(" parameters and 1 macros in "),
        "{exported}"
    );
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains("\n0x54500200 = 150 "), "{text}");
    assert!(
        text.contains("# radius of the track, mm, 20 to 1000\n"),
        "{text}"
    );
    assert!(
        text.ends_with("\nmacro scan\n    MOV X $1\n    DEL 5\nend\n"),
        "{text}"
    );
    assert!(!text.contains("0xE000200"), "{text}");

    let second = folder.join("second.bin");
    let served = Served::start(&second);
    let imported = said(&served.settings("import", &file));
    // The gain as each pivot's.
    assert_eq!(imported, "5 parameters and 1 macros changed, and kept\n");
    let again = said(&served.settings("import", &file));
    assert_eq!(again, "0 parameters and 0 macros changed, and kept\n");
    drop(served);
    let served = Served::start(&second);
    let other = folder.join("other.txt");
    said(&served.settings("export", &other));
    assert_eq!(fs::read_to_string(&other).unwrap(), text);

    // What cannot be is told, and nothing of it is kept.
    fs::write(&file, "0x54500100 = 130\n0x54500300 = 1e9\n").unwrap();
    let refused = complaint(&served.settings("import", &file), 1);
    assert!(
        refused.contains("`SPA 1 0x54500300 1e9` with GCS error 17"),
        "{refused}"
    );
    assert_eq!(
        served.say("RPA\nSPA? 1 0x54500100\nERR?"),
        "1 0x54500100=200\n0\n"
    );
    fs::write(&file, "speed = 130\n").unwrap();
    let wrong = complaint(&served.settings("import", &file), 2);
    assert!(wrong.contains("stage.txt:1: "), "{wrong}");
}

#[test]
fn parameters_that_go_together_come_back_in_any_order() {
    let folder = folder("together");
    let file = folder.join("stage.txt");
    let served = Served::start(&folder.join("kept.bin"));
    // Points before the trigger need more points, which come later in the file; and the other way round.
    for (before, points) in [(1800, 1900), (10, 20)] {
        let text = format!("0x54500900 = {before}\n0x16000201 = {points}\n");
        fs::write(&file, text).unwrap();
        said(&served.settings("import", &file));
    }
    fs::write(&file, "0x54500900 = 100\n0x16000201 = 200\n").unwrap();
    said(&served.settings("import", &file));
    let asked = "SPA? 1 0x54500900\nSPA? 1 0x16000201\nERR?";
    assert_eq!(served.say(asked), "1 0x54500900=100\n1 0x16000201=200\n0\n");
}

#[test]
fn a_number_for_all_pivots_comes_before_those_of_single_ones() {
    let folder = folder("pivots");
    let [file, before] = ["stage.txt", "before.txt"].map(|name| folder.join(name));
    let served = Served::start(&folder.join("kept.bin"));
    assert_eq!(
        served.say("CCL 1 ADVANCED\nSPA 1 0x54500310 100 1 0x54500320 200 1 0x54500330 300\nERR?"),
        "0\n"
    );
    let three = |[one, two, three]: [u16; 3]| {
        assert_eq!(
            served.say("SPA? 1 0x54500310 1 0x54500320 1 0x54500330\nERR?"),
            format!("1 0x54500310={one} \n1 0x54500320={two} \n1 0x54500330={three}\n0\n")
        );
    };
    three([100, 200, 300]);
    said(&served.settings("export", &before));

    // Pivot 2 has its number already, until that for all is set.
    fs::write(&file, "0x54500320 = 200\n0x54500300 = 50\n").unwrap();
    said(&served.settings("import", &file));
    three([50, 200, 50]);
    said(&served.settings("import", &before));
    three([100, 200, 300]);
    // Pivot 1 has it already.
    fs::write(&file, "0x54500300 = 100\n").unwrap();
    said(&served.settings("import", &file));
    three([100, 100, 100]);
    said(&served.settings("import", &before));

    // What is refused leaves those of single pivots as they were.
    fs::write(&file, "0x54500300 = 50\n0x54500320 = 1e9\n").unwrap();
    complaint(&served.settings("import", &file), 1);
    three([100, 200, 300]);
}
