//! NUCLEO-F429ZI: a board to be bought, its STM32F429 (an F427 with a display controller) clocked by the ST-LINK on it. Carriers with
//! bridges, shunt amplifiers and RS-422 stand on its connectors. What the board uses itself is left alone: Ethernet, USB, button, the
//! crystal for time of day. Its LEDs are the lamps, and the command line is the serial port that the ST-LINK has on USB.

board! {
    name: "NUCLEO-F429ZI, STM32F429",
    clock: Bypassed,
    serial: USART3,
    alternate: {
        Pwm1 pwm_1: PE9 e.pe9 as tim1::Ch1, "EN of the bridge of pivot 1, 40 kHz";
        Pwm2 pwm_2: PE11 e.pe11 as tim1::Ch2, "EN of the bridge of pivot 2";
        Pwm3 pwm_3: PE13 e.pe13 as tim1::Ch3, "EN of the bridge of pivot 3";
        EmergencyStop emergency_stop: PE15 e.pe15 as tim1::Bkin, "emergency stop, pulled down; low: stop";
        EncoderClock1 encoder_clock_1: PA5 a.pa5 as spi1::Sck, "encoder 1: MA, through RS-422";
        EncoderData1 encoder_data_1: PA6 a.pa6 as spi1::Miso, "encoder 1: SLO";
        EncoderClock2 encoder_clock_2: PB10 b.pb10 as spi2::Sck, "encoder 2: MA";
        EncoderData2 encoder_data_2: PC2 c.pc2 as spi2::Miso, "encoder 2: SLO";
        EncoderClock3 encoder_clock_3: PC10 c.pc10 as spi3::Sck, "encoder 3: MA";
        EncoderData3 encoder_data_3: PC11 c.pc11 as spi3::Miso, "encoder 3: SLO";
        SerialTransmit serial_transmit: PD8 d.pd8 as usart3::Tx, "command line, 921,600 baud, 8N1: to the host";
        SerialReceive serial_receive: PD9 d.pd9 as usart3::Rx, "command line: from the host";
    }
    plain: {
        Phase1 phase_1: PD0 d.pd0, "PH (direction) of the bridge of pivot 1";
        Phase2 phase_2: PD1 d.pd1, "PH of the bridge of pivot 2";
        Phase3 phase_3: PD2 d.pd2, "PH of the bridge of pivot 3";
        Sleep1 sleep_1: PD4 d.pd4, "nSLEEP of the bridge of pivot 1, low: the motor coasts";
        Sleep2 sleep_2: PD5 d.pd5, "nSLEEP of the bridge of pivot 2";
        Sleep3 sleep_3: PD6 d.pd6, "nSLEEP of the bridge of pivot 3";
        Fault1 fault_1: PD11 d.pd11, "nFAULT of the bridge of pivot 1, pulled up, low: fault";
        Fault2 fault_2: PD12 d.pd12, "nFAULT of the bridge of pivot 2";
        Fault3 fault_3: PD13 d.pd13, "nFAULT of the bridge of pivot 3";
        BrakeResistor brake_resistor: PD3 d.pd3, "switch of the brake resistor, high: on";
        StatusLamp status_lamp: PB0 b.pb0, "status lamp, high: lit";
        DriveLamp drive_lamp: PB7 b.pb7, "drive lamp: the bridges are awake";
        FaultLamp fault_lamp: PB14 b.pb14, "fault lamp: a fault is latched";
        LatchMark latch_mark: PE3 e.pe3, "for a scope: high from the encoders' latch to the end of its handler";
        TickMark tick_mark: PE4 e.pe4, "for a scope: high from the tick's begin until its duties are written";
        Held held: PA12 a.pa12, "driven low, not connected: while it floats, early silicon reads bank 2 of the flash wrongly";
    }
    analog: {
        Current1 current_1: PA3 a.pa3, "shunt amplifier of motor 1, 0.2 V/A around 1.65 V";
        Current2 current_2: PC0 c.pc0, "shunt amplifier of motor 2";
        Current3 current_3: PC3 c.pc3, "shunt amplifier of motor 3";
        Supply supply: PB1 b.pb1, "supply of the bridges through 19 k over 1 k";
    }
}
