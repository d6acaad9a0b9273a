//! The board around the emulated chip: crystal, supply, and the chips on its pins, as the image's pin table has them.

use super::encoder::EncoderLine;
use super::line::HostLine;
use hal_sim::machine::devices::{BridgeState, MAX_DUTY};
use rigless::cpu::armv7m;
use rigless::device::Level;
use rigless::emulator::Alias;
use rigless::image::Image;
use rigless::machine::armv7m::{Config, Core, Fpu, Variant};
use rigless::machine::{Board, Target};
use rigless::mcu::{Mcu, Operate};
use rigless::snapshot::Store;
use rigless::soc::stm32f427::Stm32f427;
use rigless::soc::stm32f427::peripherals::adc::Channel as AdcChannel;
use rigless::soc::stm32f427::peripherals::gpio::Pin;
use rigless::soc::stm32f427::peripherals::tim::Channel as TimerChannel;
use rigless::soc::{Error, Fault, Width};
use rigless::time::VirtualNanos;
use std::num::{NonZeroU32, NonZeroU64};
use std::path::Path;

const CRYSTAL_HZ: u64 = 8_000_000;
const SUPPLY_MV: u32 = 3300;
/// Instructions in a second: one a cycle.
pub const CORE_HZ: u64 = 168_000_000;

/// The same, as the board runs unless told otherwise.
pub const STAGE_RATE: NonZeroU64 = NonZeroU64::new(CORE_HZ).unwrap();

const ADC1: usize = 0;
const TIM1: usize = 0;
const PORT_D: usize = 3;
const PORT_E: usize = 4;
/// Pins of port D, pivot 1 first.
const DIRECTION: [u8; 3] = [0, 1, 2];
const SLEEP: [u8; 3] = [4, 5, 6];
const BRAKE_RESISTOR: u8 = 3;
/// Pin of port E.
const EMERGENCY_STOP: u8 = 15;
const TIM3_CR1: u64 = 0x4000_0400;
const TIM3_CNT: u64 = 0x4000_0424;
const LATCH_PERIOD_COUNTS: i64 = 4_200;
/// Clock control, and its bit that switches the crystal on.
pub const RCC_CR: u64 = 0x4002_3800;
pub const HSE_ON: u32 = 1 << 16;
/// Where the vectors are, to the emulator from the reset on: on the chip they stand at 0 too until the program says otherwise.
const FLASH_AT: u32 = 0x0800_0000;
/// Where option bytes are changed, and what unlocks that.
const FLASH_OPTKEYR: u64 = 0x4002_3C08;
const FLASH_OPTCR: u64 = 0x4002_3C14;
const OPTION_KEYS: [u64; 2] = [0x0819_2A3B, 0x4C5D_6E7F];
/// What answers at address 0, and the bits of it with SRAM's first block there.
const SYSCFG_MEMRMP: u64 = 0x4001_3800;
const MEM_MODE: u32 = 0b111;
const SRAM1: u32 = 0b011;
/// Of the chip on the board; and where it says so.
const FLASH_KIB: u16 = 2048;
/// What the maker has read of the internal reference at 3.3 V, and where: with the converter's reference below, its millivolts.
const REFERENCE_COUNTS: u16 = 1_210;
const REFERENCE_COUNTS_AT: u64 = 0x1FFF_7A2A;
const FLASH_KIB_AT: u64 = 0x1FFF_7A22;
/// With as many millivolts of reference as there are counts, an input in millivolts is an input in counts.
const ADC_REFERENCE: u32 = 4095;

/// What differs from board to board, as `firmware/PINS.md` has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardKind {
    /// Place of the command line's port among the emulator's.
    usart: usize,
    /// Pins of port D: the bridges' faults.
    bridge_fault: [u8; 3],
    /// Channels of the three currents and the supply.
    adc_channels: [u8; 4],
}

impl BoardKind {
    /// The reference board.
    pub const REFERENCE: Self = Self {
        usart: 0,
        bridge_fault: [8, 9, 10],
        adc_channels: [10, 11, 12, 13],
    };
    /// NUCLEO-F429ZI.
    pub const NUCLEO: Self = Self {
        usart: 2,
        bridge_fault: [11, 12, 13],
        adc_channels: [3, 10, 13, 9],
    };
}

/// The board.
#[derive(Debug)]
pub struct ChipBoard {
    kind: BoardKind,
    mcu: Stm32f427,
    emergency_stop: Level,
    instructions_per_second: NonZeroU64,
    has_crystal: bool,
    flash_kib: u16,
    reference_counts: u16,
}

impl ChipBoard {
    /// The board, powered, its emergency stop released.
    pub fn new(kind: BoardKind) -> Result<Self, Error> {
        let mut mcu = Stm32f427::new()?;
        mcu.rcc.attach_crystals(CRYSTAL_HZ, 0);
        mcu.set_supply(SUPPLY_MV);
        mcu.adc[ADC1].set_reference(ADC_REFERENCE);
        for port in &mut mcu.spi[..3] {
            port.attach(EncoderLine::default());
        }
        mcu.usart[kind.usart].attach(HostLine::default());
        let mut board = Self {
            kind,
            mcu,
            emergency_stop: Level::High,
            instructions_per_second: STAGE_RATE,
            has_crystal: true,
            flash_kib: FLASH_KIB,
            reference_counts: REFERENCE_COUNTS,
        };
        board.drive_again(VirtualNanos(0), [false; 3]);
        Ok(board)
    }

    /// The same with other instructions in a second of virtual time.
    pub fn at_rate(self, instructions_per_second: NonZeroU64) -> Self {
        Self {
            instructions_per_second,
            ..self
        }
    }

    /// The same, its crystal broken: it never gets ready.
    pub fn without_crystal(self) -> Self {
        Self {
            has_crystal: false,
            ..self
        }
    }

    /// The same with a chip of which the manufacturer says that it has so much flash.
    pub fn with_flash_kib(self, flash_kib: u16) -> Self {
        Self { flash_kib, ..self }
    }

    /// The same with a converter supplied with so much of 3.3 V. Of a higher supply its reference is a smaller share: here the
    /// maker's reading is the greater instead.
    pub fn with_converter_supply(self, share: f64) -> Self {
        Self {
            reference_counts: (f64::from(REFERENCE_COUNTS) * share).round() as u16,
            ..self
        }
    }

    /// The same with a watchdog's oscillator of so many Hz: 17,000 to 47,000, as the data sheet has it.
    pub fn with_watchdog_hz(mut self, hz: u64) -> Self {
        self.mcu.rcc.calibrate_lsi(hz);
        self
    }

    /// The same with these option bytes, as the chip's register shows them.
    ///
    /// # Errors
    /// None, unless the emulator's part has no such registers.
    pub fn with_options(mut self, options: u32) -> Result<Self, Fault> {
        for key in OPTION_KEYS {
            (self.mcu).write(VirtualNanos(0), FLASH_OPTKEYR, Width::W32, key)?;
        }
        (self.mcu).write(VirtualNanos(0), FLASH_OPTCR, Width::W32, options.into())?;
        Ok(self)
    }

    /// Sets the supply of the chip itself, mV.
    pub fn set_chip_supply(&mut self, millivolts: u32) {
        self.mcu.set_supply(millivolts);
    }

    /// The program has switched the crystal on.
    pub fn crystal_switched_on(&mut self, now: VirtualNanos) {
        if !self.has_crystal
            && let Some(control) = self.register(now, RCC_CR)
        {
            // Switched off before it could get ready. The register exists: the program has written to it.
            let off = u64::from(control & !HSE_ON);
            drop(self.mcu.write(now, RCC_CR, Width::W32, off));
        }
    }

    /// Drives every input as the board has it: the chip's restart lets go of them.
    pub fn drive_again(&mut self, now: VirtualNanos, bridge_faults: [bool; 3]) {
        self.set_emergency_stop(now, self.emergency_stop == Level::Low);
        self.set_bridge_faults(now, bridge_faults);
    }

    /// Latches the encoders' frames.
    pub fn set_frames(&mut self, frames: [[u8; 8]; 3]) {
        for (port, frame) in self.mcu.spi.iter_mut().zip(frames) {
            if let Some(line) = port.chip_mut::<EncoderLine>(0) {
                line.latch(frame);
            }
        }
    }

    /// When the first byte of each encoder's last frame crossed its line, and the last, ns.
    pub fn frames_ns(&mut self) -> [[u64; 2]; 3] {
        [0, 1, 2].map(|port| {
            let line = self.mcu.spi[port].chip_mut::<EncoderLine>(0);
            line.map_or([0; 2], |line| line.crossed_ns())
        })
    }

    /// Puts counts on the ADC's inputs.
    pub fn set_analog(&mut self, (currents, supply): ([u16; 3], u16)) {
        let [first, second, third] = currents;
        for (channel, counts) in self
            .kind
            .adc_channels
            .into_iter()
            .zip([first, second, third, supply])
        {
            if let Some(channel) = AdcChannel::new(channel) {
                self.mcu.adc[ADC1].set_input(channel, u32::from(counts));
            }
        }
    }

    /// Presses or releases the emergency stop: the pin's level, and the break input behind it.
    pub fn set_emergency_stop(&mut self, now: VirtualNanos, pressed: bool) {
        self.emergency_stop = if pressed { Level::Low } else { Level::High };
        self.drive_pin(now, PORT_E, EMERGENCY_STOP, self.emergency_stop);
        self.settle_pwm(now);
    }

    /// Lets bridges pull their fault pins low.
    pub fn set_bridge_faults(&mut self, now: VirtualNanos, faults: [bool; 3]) {
        for (pin, fault) in self.kind.bridge_fault.into_iter().zip(faults) {
            let level = if fault { Level::Low } else { Level::High };
            self.drive_pin(now, PORT_D, pin, level);
        }
    }

    /// What the pins of the bridges say now; the PWM as the period under way has it.
    pub fn bridges(&mut self, now: VirtualNanos, faults: [bool; 3]) -> [BridgeState; 3] {
        let duty = self.duty(now).unwrap_or([0; 3]);
        let (port, registers) = self.mcu.port(PORT_D);
        let level =
            |pin: u8| Pin::new(pin).is_some_and(|pin| port.level(pin, registers) == Level::High);
        [0, 1, 2].map(|axis| BridgeState {
            pulse: f64::from(duty[axis]) / f64::from(MAX_DUTY),
            forward: level(DIRECTION[axis]),
            awake: level(SLEEP[axis]),
            fault: faults[axis],
        })
    }

    /// Whether the brake resistor is switched on.
    pub fn brake_resistor(&mut self) -> bool {
        let (port, registers) = self.mcu.port(PORT_D);
        Pin::new(BRAKE_RESISTOR).is_some_and(|pin| port.level(pin, registers) == Level::High)
    }

    /// Counts of the PWM pulses of the period under way, or `None` while the outputs are cut.
    pub fn duty(&mut self, now: VirtualNanos) -> Option<[u16; 3]> {
        self.settle_pwm(now);
        let (timer, registers) = self.mcu.advanced_timer(TIM1);
        let counts = |number: u8| {
            let pulse = timer.pulse(TimerChannel::new(number)?, registers)?;
            // The width was rounded down to nanoseconds, so rounding up gives the counts back.
            let counts = (pulse.width.0 * (CORE_HZ / 1_000_000)).div_ceil(1000);
            u16::try_from(counts).ok()
        };
        Some([counts(1)?, counts(2)?, counts(3)?])
    }

    /// Stops the timer that starts every control period, as if its clock had died.
    ///
    /// # Errors
    /// None, unless the emulator's part has no such register.
    pub fn stop_latch_timer(&mut self, now: VirtualNanos) -> Result<(), Fault> {
        self.mcu.write(now, TIM3_CR1, Width::W32, 0)
    }

    /// A register of a peripheral.
    pub fn register(&mut self, now: VirtualNanos, address: u64) -> Option<u32> {
        self.mcu
            .read(now, address, Width::W32)
            .ok()
            .map(|word| word as u32)
    }

    /// Whether the program has mapped SRAM to address 0, where its loop runs.
    pub fn has_sram_at_zero(&mut self, now: VirtualNanos) -> bool {
        let mapped = self.register(now, SYSCFG_MEMRMP);
        mapped.is_some_and(|mapped| mapped & MEM_MODE == SRAM1)
    }

    /// Sets the timer that starts every control period back by so many counts, or forward.
    ///
    /// # Errors
    /// None, unless the emulator's part has no such register.
    pub fn delay_latch(&mut self, now: VirtualNanos, counts: i32) -> Result<(), Fault> {
        let count = self.mcu.read(now, TIM3_CNT, Width::W32)? as i64;
        let moved = (count - i64::from(counts)).rem_euclid(LATCH_PERIOD_COUNTS);
        self.mcu.write(now, TIM3_CNT, Width::W32, moved as u64)
    }

    /// The host's end of the command interface.
    pub fn line(&mut self) -> Option<&mut HostLine> {
        self.mcu.usart[self.kind.usart].chip_mut::<HostLine>()
    }

    fn drive_pin(&mut self, now: VirtualNanos, port: usize, pin: u8, level: Level) {
        if let Some(pin) = Pin::new(pin) {
            self.mcu.drive_port(now, port, |gpio, registers, context| {
                gpio.drive(pin, Some(level), registers, context);
            });
        }
    }

    /// Drives the break input, which also brings the timer's model up to now.
    fn settle_pwm(&mut self, now: VirtualNanos) {
        let level = self.emergency_stop;
        self.mcu
            .drive_advanced_timer(now, TIM1, |timer, registers, context| {
                timer.drive_break(level, registers, context);
            });
    }
}

impl Store for ChipBoard {}

impl Board for ChipBoard {
    fn name(&self) -> &'static str {
        "tripivot"
    }

    fn target_names(&self) -> Vec<&'static str> {
        vec!["stm32f427"]
    }

    fn mcu(&mut self, target: usize) -> Option<&mut dyn Mcu> {
        (target == 0).then_some(&mut self.mcu)
    }

    fn targets(&mut self) -> Vec<Target<'_>> {
        let lines = u32::from(Operate::cpu(&self.mcu).interrupt_lines);
        let core = Core {
            variant: Variant::M4,
            clock_hz: STAGE_RATE,
            interrupt_lines: NonZeroU32::new(lines).unwrap_or(NonZeroU32::MIN),
            priority_bits: 4,
            refclk_divider: const { NonZeroU32::new(8).unwrap() },
            instructions_per_second: self.instructions_per_second,
            boot: "flash",
        };
        let windows = armv7m::windows(Mcu::bus(&self.mcu));
        let mut config = Config::new(core, &windows);
        config.fpu = Fpu::FpV4Sp;
        config.vector_table = Some(FLASH_AT);
        let mut core = config.spec();
        // The emulator maps nothing anew while it runs: what the program maps to address 0 is there from the start, and that the
        // program does so before its loop runs is looked at then.
        core.aliases = vec![Alias {
            region: "sram",
            at: 0,
        }];
        for (word, at) in [
            (self.flash_kib, FLASH_KIB_AT),
            (self.reference_counts, REFERENCE_COUNTS_AT),
        ] {
            let bytes = word.to_le_bytes().to_vec();
            (core.factory_images).extend(Image::new(Path::new("factory"), bytes, Some(at)));
        }
        vec![Target::new("stm32f427", &mut self.mcu, core)]
    }
}
