//! The reference board: a carrier for an STM32F427 in a package of 100 pins or more, which is still to be drawn.

board! {
    name: "reference board, STM32F427",
    clock: Crystal,
    serial: USART1,
    alternate: {
        Pwm1 pwm_1: PE9 e.pe9 as tim1::Ch1, "EN of the bridge of pivot 1, 40 kHz";
        Pwm2 pwm_2: PE11 e.pe11 as tim1::Ch2, "EN of the bridge of pivot 2";
        Pwm3 pwm_3: PE13 e.pe13 as tim1::Ch3, "EN of the bridge of pivot 3";
        EmergencyStop emergency_stop: PE15 e.pe15 as tim1::Bkin, "emergency stop, pulled down; low: stop";
        EncoderClock1 encoder_clock_1: PA5 a.pa5 as spi1::Sck, "encoder 1: MA, through RS-422";
        EncoderData1 encoder_data_1: PA6 a.pa6 as spi1::Miso, "encoder 1: SLO";
        EncoderClock2 encoder_clock_2: PB13 b.pb13 as spi2::Sck, "encoder 2: MA";
        EncoderData2 encoder_data_2: PB14 b.pb14 as spi2::Miso, "encoder 2: SLO";
        EncoderClock3 encoder_clock_3: PC10 c.pc10 as spi3::Sck, "encoder 3: MA";
        EncoderData3 encoder_data_3: PC11 c.pc11 as spi3::Miso, "encoder 3: SLO";
        SerialTransmit serial_transmit: PA9 a.pa9 as usart1::Tx, "command line, 921,600 baud, 8N1: to the host";
        SerialReceive serial_receive: PA10 a.pa10 as usart1::Rx, "command line: from the host";
    }
    plain: {
        Phase1 phase_1: PD0 d.pd0, "PH (direction) of the bridge of pivot 1";
        Phase2 phase_2: PD1 d.pd1, "PH of the bridge of pivot 2";
        Phase3 phase_3: PD2 d.pd2, "PH of the bridge of pivot 3";
        Sleep1 sleep_1: PD4 d.pd4, "nSLEEP of the bridge of pivot 1, low: the motor coasts";
        Sleep2 sleep_2: PD5 d.pd5, "nSLEEP of the bridge of pivot 2";
        Sleep3 sleep_3: PD6 d.pd6, "nSLEEP of the bridge of pivot 3";
        Fault1 fault_1: PD8 d.pd8, "nFAULT of the bridge of pivot 1, pulled up, low: fault";
        Fault2 fault_2: PD9 d.pd9, "nFAULT of the bridge of pivot 2";
        Fault3 fault_3: PD10 d.pd10, "nFAULT of the bridge of pivot 3";
        BrakeResistor brake_resistor: PD3 d.pd3, "switch of the brake resistor, high: on";
        StatusLamp status_lamp: PE0 e.pe0, "status lamp, high: lit";
        DriveLamp drive_lamp: PE1 e.pe1, "drive lamp: the bridges are awake";
        FaultLamp fault_lamp: PE2 e.pe2, "fault lamp: a fault is latched";
        LatchMark latch_mark: PE3 e.pe3, "for a scope: high from the encoders' latch to the end of its handler";
        TickMark tick_mark: PE4 e.pe4, "for a scope: high from the tick's begin until its duties are written";
        Held held: PA12 a.pa12, "driven low, not connected: while it floats, early silicon reads bank 2 of the flash wrongly";
    }
    analog: {
        Current1 current_1: PC0 c.pc0, "shunt amplifier of motor 1, 0.2 V/A around 1.65 V";
        Current2 current_2: PC1 c.pc1, "shunt amplifier of motor 2";
        Current3 current_3: PC2 c.pc2, "shunt amplifier of motor 3";
        Supply supply: PC3 c.pc3, "supply of the bridges through 19 k over 1 k";
    }
}
