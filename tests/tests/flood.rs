//! All clients send as much as is taken of them, at every tick, while the stage moves: the motion is the same to the bit, and a
//! stop is obeyed as soon as ever.

use firmware::mode::Mode;
use firmware::recorder::Sample;
use hal_sim::random::Random;
use tests::ideal::Ideal;

const FLOODING: usize = 3;
/// The client that moves the stage.
const DRIVER: usize = FLOODING;
/// As many bytes as a connection takes in a tick, and more.
const BURST: usize = 600;
const STOP: u8 = 24;

/// Lines that ask for the longest answers, lines that are wrong, and what is no line at all.
fn flood(random: &mut Random) -> Vec<u8> {
    let mut bytes = Vec::new();
    while bytes.len() < BURST {
        match random.index(6) {
            0 => bytes.extend(b"HLP?\n"),
            1 => bytes.extend(b"POS?\nSPA?\nHPA?\nEVT?\n"),
            2 => bytes.extend([3, 4, 5, 6, 7, 8, 9]),
            3 => bytes.extend(b"MOV X 1000\nMOV\nSVO Q 1\nJOG X 99999\nVLS -1\n"),
            4 => bytes.extend(std::iter::repeat_n(b'?', random.index(BURST))),
            _ => {
                // Never a command: no line begins with it.
                bytes.push(b'?');
                let noise = (0..random.index(300)).map(|_| random.bits() as u8);
                bytes.extend(noise.filter(|&byte| byte != STOP && byte != b'\n'));
                bytes.push(b'\n');
            }
        }
    }
    bytes
}

/// The state of the stage at each tick of a motion, flooded or not.
fn motion(seed: u64, is_flooded: bool, ticks: u32) -> Vec<Sample> {
    let mut random = Random::new(seed);
    let mut stage = Ideal::new(FLOODING + 1);
    stage.run(10);
    stage.ask(DRIVER, b"FRF\n");
    stage.run(100);
    stage.ask(DRIVER, b"MOV X 50 Y -30 W 120\n");
    (0..ticks)
        .map(|_| {
            for connection in &mut stage.connections[..FLOODING] {
                if is_flooded && connection.input.len() < BURST {
                    connection.input.extend(flood(&mut random));
                }
                connection.output.clear();
            }
            stage.tick();
            stage.sample().expect("a tick has run").clone()
        })
        .collect()
}

#[test]
fn a_flood_of_lines_and_noise_changes_no_tick_of_a_motion() {
    for seed in [1, 2] {
        println!("seed {seed}");
        let quiet = motion(seed, false, 3_000);
        let flooded = motion(seed, true, 3_000);
        assert_eq!(quiet[100].mode, Mode::Moving);
        for (quiet, flooded) in quiet.iter().zip(&flooded) {
            assert_eq!(format!("{quiet:?}"), format!("{flooded:?}"));
        }
    }
}

#[test]
fn a_stop_in_a_flood_acts_as_soon_as_in_silence() {
    let stopped_after = |is_flooded: bool| {
        let mut random = Random::new(3);
        let mut stage = Ideal::new(FLOODING + 1);
        stage.run(10);
        stage.ask(DRIVER, b"FRF\n");
        stage.run(100);
        stage.ask(DRIVER, b"JOG W 90\n");
        for tick in 0..5_000 {
            for connection in &mut stage.connections[..FLOODING] {
                if is_flooded && connection.input.len() < BURST {
                    connection.input.extend(flood(&mut random));
                }
                connection.output.clear();
            }
            if tick == 1_000 {
                stage.connections[DRIVER].input.push(STOP);
            }
            stage.tick();
            let is_moving = stage.sample().is_some_and(|now| now.mode == Mode::Moving);
            if tick > 1_000 && !is_moving {
                return tick;
            }
        }
        panic!("never stopped");
    };
    assert_eq!(stopped_after(true), stopped_after(false));
}
