"""Drives the simulated stage with PIPython as a lab's script would. Started by `run`, which says where the stage is."""

import argparse
import math
import socket
import time
import unittest

from pipython import GCSDevice, GCSError, datarectools, gcserror, pitools
from pipython.pidevice.interfaces.piserial import PISerial
from pipython.pidevice.interfaces.pisocket import PISocket

from gcs_page import GcsPage
from programs import Programs
from wire import overheard

AXES = ["X", "Y", "Z", "U", "V", "W"]
PLACE_MM = 1e-3
"""How near a settled stage is to its target, mm or deg: a hundred encoder counts, and more than its noise."""

START_S = 60
"""Longest time that an emulated chip is given to start."""

ARGUMENTS = argparse.Namespace()


def recorded(gateway):
    """`gateway`, whose traffic is written to the transcript besides."""
    def write(sign, text):
        with open(ARGUMENTS.transcript, "a", encoding="utf-8") as file:
            file.write(f"{sign} {text!r}\n")
        heard.append((sign, text))

    heard = []
    return overheard(gateway, write), heard


def unanswered(heard):
    """What was asked in what was `heard` and had no answer before the next message."""
    following = [sign for sign, _ in heard[1:]] + [">"]
    asked = [text for (sign, text), after in zip(heard, following) if (sign, after) == (">", ">")]
    return [text for text in asked if b"?" in text]


class Drive(Programs):
    """The same tests for each way to the stage."""

    SERIAL = "SIM"
    KEEPS_TIME = True
    KEEPS_SETTINGS = True

    @classmethod
    def open(cls):
        raise NotImplementedError

    @classmethod
    def setUpClass(cls):
        gateway, heard = recorded(cls.open())
        cls.stage = cls.enterClassContext(GCSDevice(gateway=gateway))
        pitools.startup(cls.stage, refmodes="FRF")
        cls.startup = list(heard)

    def setUp(self):
        # What a test that failed may have left.
        self.stage.SVO("X", True)
        self.stage.VLS(200)
        pitools.moveandwait(self.stage, {"X": 0, "Y": 0, "W": 0}, timeout=60)

    def tearDown(self):
        self.assertEqual(self.stage.qERR(), 0)

    def assert_at(self, **places):
        measured = self.stage.qPOS(list(places))
        for axis, place in places.items():
            self.assertAlmostEqual(measured[axis], place, delta=PLACE_MM, msg=axis)

    def assert_refused(self, number, action, *arguments):
        with self.assertRaises(GCSError) as caught:
            action(*arguments)
        self.assertEqual(caught.exception.val, number)

    def test_startup_probes_nothing_that_is_not_answered(self):
        # PIPython waits 7 s for each answer.
        self.assertGreater(len(self.startup), 10)
        self.assertEqual(unanswered(self.startup), [])

    def test_identity(self):
        identity = self.stage.qIDN().strip().split(", ")
        self.assertEqual(identity[:2], ["(c)2026 Tripivot", "XYT-1 (C-887 compatible)"])
        self.assertEqual(self.stage.axes, AXES)
        self.assertEqual(self.stage.allaxes, AXES)
        self.assertIn("FW:", self.stage.qVER())
        self.assertEqual(self.stage.qSSN().strip(), self.SERIAL)
        self.assertEqual(self.stage.qCSV(), 2.0)

    def test_every_command_that_is_listed_is_known_to_the_client(self):
        # `WAV` has a function for each of its types.
        own = {"APP", "CAL", "CMS", "EXC", "FLC", "HBT", "ILC", "JRC", "JTM", "LST", "OWN", "RCV", "TMP", "WAC", "WAV"}
        own |= {"qAPP", "qCAL", "qCMS", "qEVT", "qEXC", "qFLR", "qFLT", "qHBT", "qILC", "qJTM", "qMON", "qOWN", "qRCV", "qTMP", "qTST"}
        missing = [name for name in self.stage.funcs if not hasattr(self.stage, name)]
        self.assertEqual(set(missing), own)

    def test_queries_of_axes(self):
        stage = self.stage
        self.assertEqual(list(stage.qTMN().values()), [-80, -80, 0, 0, 0, -3_600_000])
        self.assertEqual(list(stage.qTMX().values()), [80, 80, 0, 0, 0, 3_600_000])
        for query in (stage.qONT, stage.qSVO, stage.qFRF):
            self.assertTrue(all(query().values()), query)
        self.assertEqual(list(stage.qPUN().values()), ["mm"] * 3 + ["deg"] * 3)
        self.assertEqual(set(stage.qCST().values()), {"XYT-1"})
        self.assertFalse(any(stage.qLIM().values()) or any(stage.qTRS().values()))
        self.assertEqual(stage.qCCL(), 0)
        self.assertTrue(stage.IsControllerReady())
        # PIPython's GetStatus reads it as hexadecimal; EPICS, for which it is as it is, as decimal.
        self.assertEqual(stage.read(chr(4)), "65536\n")

    def test_one_axis(self):
        for target in (10, -1e-6, 1 / 3):
            pitools.moveandwait(self.stage, "X", target)
            self.assertEqual(self.stage.qMOV("X")["X"], float(f"{target:.12g}"))
            self.assert_at(X=target, Y=0, W=0)

    def test_several_axes(self):
        pitools.moveandwait(self.stage, ["X", "Y", "W"], [30, -20, 45])
        self.assert_at(X=30, Y=-20, Z=0, U=0, V=0, W=45)
        self.stage.MOV({"X": -5, "W": 720})
        self.assertTrue(self.stage.IsMoving("X")["X"])
        self.assertFalse(self.stage.IsMoving("Z")["Z"])
        pitools.waitontarget(self.stage)
        self.assertFalse(any(self.stage.IsMoving().values()))
        self.assert_at(X=-5, Y=-20, W=720)

    def test_relative(self):
        for _ in range(3):
            self.stage.MVR(["X", "W"], [2.5, -100])
            pitools.waitontarget(self.stage)
        self.assert_at(X=7.5, W=-300)

    def test_a_move_in_motion_goes_to_the_last_target(self):
        self.stage.MOV("X", 60)
        time.sleep(0.1)
        self.stage.MOV("X", -10)
        pitools.waitontarget(self.stage)
        self.assert_at(X=-10)

    def test_velocity(self):
        self.stage.VLS(20)
        self.assertEqual(self.stage.qVLS(), 20)
        start = time.monotonic()
        pitools.moveandwait(self.stage, "X", 20)
        self.assertGreater(time.monotonic() - start, 0.9)
        self.assert_refused(gcserror.E8_PI_CNTR_VEL_OUT_OF_LIMITS, self.stage.VLS, 201)
        self.assertEqual(self.stage.qVLS(), 20)

    def test_stops(self):
        def halt():
            self.stage.HLT()

        def stop_all():
            self.stage.StopAll()

        def stop():
            self.stage.STP()

        for action in (halt, stop, stop_all):
            with self.subTest(action.__name__):
                self.stage.VLS(50)
                self.stage.MOV("X", -70 if self.stage.qPOS("X")["X"] > 0 else 70)
                time.sleep(0.4)
                self.assert_refused(gcserror.E10_PI_CNTR_STOP, action)
                pitools.waitontarget(self.stage)
                target = self.stage.qMOV("X")["X"]
                self.assertLess(abs(target), 60)
                self.assert_at(X=target)
        self.stage.StopAll(noraise=True)
        pitools.stopall(self.stage)

    def test_out_of_range(self):
        limit = gcserror.E7_PI_CNTR_POS_OUT_OF_LIMITS
        for target in ({"X": 80.1}, {"X": 60, "Y": 60}, {"Z": 0.1}, {"W": 4e6}, {"X": 1, "U": 1}):
            with self.subTest(target):
                self.assertFalse(self.stage.qVMO(target))
                self.assert_refused(limit, self.stage.MOV, target)
        self.assert_refused(limit, self.stage.MVR, "Y", -81)
        self.assertFalse(any(self.stage.IsMoving().values()))
        self.assert_at(X=0, Y=0, W=0)
        self.assert_refused(gcserror.E15_PI_CNTR_INVALID_AXIS_IDENTIFIER, self.stage.MOV, "Q", 1)

    def test_reach(self):
        self.assertTrue(self.stage.qVMO({"X": 48, "Y": 64}))
        end = self.stage.qTRA({"X": 1, "Y": 1})
        self.assertAlmostEqual(math.hypot(end["X"], end["Y"]), 80)
        pitools.moveandwait(self.stage, end)
        self.assert_at(**end)

    def test_soft_limits(self):
        stage = self.stage
        stage.NLM("X", -10)
        stage.PLM({"X": 10, "Y": 20})
        self.assertEqual(stage.qNLM("X")["X"], -10)
        self.assertEqual(stage.qPLM(["X", "Y"]), {"X": 10, "Y": 20})
        self.assert_refused(gcserror.E7_PI_CNTR_POS_OUT_OF_LIMITS, stage.MOV, "X", 11)
        stage.SSL("X", False)
        self.assertFalse(stage.qSSL("X")["X"])
        stage.MOV("X", 11)
        pitools.waitontarget(stage)
        stage.NLM("X", -80)
        stage.PLM({"X": 80, "Y": 80})
        stage.SSL("X", True)

    def test_servo(self):
        self.stage.SVO("X", False)
        self.assertFalse(self.stage.qSVO("X")["X"])
        self.assert_refused(gcserror.E5_PI_CNTR_MOVE_WITHOUT_REF_OR_NO_SERVO, self.stage.MOV, "X", 1)
        pitools.setservo(self.stage, self.stage.axes, [True] * 6)
        self.assertTrue(all(self.stage.qSVO().values()))
        pitools.waitontarget(self.stage)

    def test_parameters(self):
        stage = self.stage
        self.assertEqual(stage.qSPA("W", 0x07000601)["W"][0x07000601], "deg")
        self.assertEqual(stage.getparam(0x0E000200), 5e-5)
        self.assertEqual(stage.getparam(0x16000201), 2048)
        self.assertEqual(stage.getparam(0x19001900), 0)
        self.assertIsNone(stage.getparam(0x3C))
        stage.SPA(1, 0x54500100, 150)
        self.assertEqual(stage.qSPA(1, 0x54500100)[1][0x54500100], 150)
        stage.SPA(1, 0x54500100, 200)
        self.assert_refused(gcserror.E64_PI_CNTR_READ_ONLY_PARAMETER, stage.SPA, 1, 0x0E000200, 1)
        self.assertGreater(len(stage.qSPA()), 1)

    def test_settings_are_kept_and_come_back(self):
        stage = self.stage
        self.assert_refused(gcserror.E56_PI_CNTR_INVALID_PASSWORD, stage.WPA, "101")
        if not self.KEEPS_SETTINGS:
            self.assert_refused(4001, stage.WPA, "100")
            return
        stage.WPA("100")
        stage.SPA(1, 0x54500100, 150)
        self.assertEqual(stage.qSPA(1, 0x54500100)[1][0x54500100], 150)
        stage.RPA(1, 0x54500100)
        self.assertEqual(stage.qSPA(1, 0x54500100)[1][0x54500100], 200)

    def test_work_and_tool_frames(self):
        stage = self.stage
        stage.KSW("TABLE", {"X": 10, "Y": 20, "W": 90})
        stage.KSW("SAMPLE", ["X", "Y"], [1, 2])
        stage.KLN("SAMPLE", "TABLE")
        stage.KST("PROBE", "X", 5)
        stage.KEN("SAMPLE")
        stage.KEN("PROBE")
        try:
            self.assertEqual(stage.qKEN(), {"SAMPLE": "KSW", "PROBE": "KST"})
            self.assertEqual(stage.qKET(["KSW"]), {"KSW": "SAMPLE"})
            self.assertEqual(stage.qKLN()["SAMPLE"], ["TABLE", "ZERO"])
            self.assertIn("SAMPLE PARENT=TABLE", stage.qKLS("SAMPLE"))
            # A quarter of a turn: the table's y is the base frame's -x.
            self.assertIn("SAMPLE X=8", stage.qKLT("SAMPLE"))
            self.assertIn("SAMPLE Y=21", stage.qKLT("SAMPLE"))
            # The probe is at (5, 0) in the base frame.
            self.assert_at(X=-21, Y=3, W=-90)
            pitools.moveandwait(stage, {"X": -10, "Y": 0, "W": -90})
            self.assert_at(X=-10, Y=0, W=-90)
            stage.MRT({"X": 2})
            pitools.waitontarget(stage)
            self.assert_at(X=-10, Y=-2, W=-90)
            stage.MRW({"X": 1, "Y": 2})
            pitools.waitontarget(stage)
            self.assert_at(X=-9, Y=0, W=-90)
            self.assert_refused(gcserror.E34_PI_CNTR_CMD_NOT_ALLOWED_FOR_STAGE, stage.KRM, "TABLE")
        finally:
            stage.KEN("ZERO")
        self.assertEqual(stage.qKEN(), {"ZERO": "KSD"})
        # Base frame: TABLE turns (-9, 0) + (1, 2) into (-2, -8), and the probe is 5 ahead.
        self.assert_at(X=3, Y=12, W=0)
        for name in ("SAMPLE", "TABLE", "PROBE"):
            stage.KRM(name)

    def test_frame_at_the_current_position(self):
        pitools.moveandwait(self.stage, {"X": 5, "Y": 6, "W": 30})
        self.stage.KSF("HERE")
        self.stage.KEN("HERE")
        self.assert_at(X=0, Y=0, W=0)
        self.stage.KEN(0)
        self.stage.KRM("HERE")
        self.assert_at(X=5, Y=6, W=30)

    def test_centre_of_rotation(self):
        self.stage.SPI({"R": 20, "S": 10})
        self.assertEqual(self.stage.qSPI(), {"R": 20, "S": 10, "T": 0})
        pitools.moveandwait(self.stage, "W", 90)
        self.assert_at(X=0, Y=0, W=90)
        # The point is the platform's own: it can be another one at any W, and X and Y are those of that point.
        self.stage.SPI(["R", "S"], [0, 0])
        self.assert_at(X=30, Y=-10, W=90)
        self.stage.SPI({"R": 20, "S": 10})
        self.assert_at(X=0, Y=0, W=90)
        pitools.moveandwait(self.stage, "W", 0)
        self.stage.SPI(["R", "S"], [0, 0])
        self.stage.KSW("TABLE", {"X": 1})
        self.stage.KEN("TABLE")
        self.assert_refused(gcserror.E9_PI_CNTR_SET_PIVOT_NOT_POSSIBLE, self.stage.SPI, "R", 0)
        self.stage.KEN(0)
        self.stage.KRM("TABLE")

    def test_jog(self):
        self.stage.JOG("W", 90)
        self.assertEqual(self.stage.qJOG("W"), {"W": 90})
        time.sleep(0.5)
        self.stage.JOG({"X": 5, "W": -90})
        start = time.monotonic()
        while self.stage.qPOS("X")["X"] < 0.6 and time.monotonic() < start + 30:
            time.sleep(0.05)
        self.assertTrue(self.stage.IsMoving("W")["W"])
        self.stage.JOG({"X": 0, "W": 0})
        pitools.waitontarget(self.stage)
        self.assertGreater(self.stage.qPOS("X")["X"], 0.5)
        self.assert_refused(gcserror.E8_PI_CNTR_VEL_OUT_OF_LIMITS, self.stage.JOG, "X", 201)

    def test_velocities_of_axes(self):
        self.stage.VEL("X", 20)
        self.assertEqual(self.stage.qVEL("X")["X"], 20)
        start = time.monotonic()
        pitools.moveandwait(self.stage, {"X": 20, "Y": 1})
        self.assertGreater(time.monotonic() - start, 0.9)
        self.stage.VEL("X", 200)

    def test_waveforms(self):
        stage = self.stage
        self.assertEqual(stage.qTWG(), 6)
        stage.WAV_SIN_P(1, firstpoint=0, numpoints=200, append="X", center=100, amplitude=4, offset=0, seglength=200)
        stage.WAV_RAMP(2, firstpoint=0, numpoints=200, append="X", center=100, speedupdown=40, amplitude=20, offset=0, seglength=200)
        pitools.writewavepoints(stage, 3, [0, 0.01, 0.02, 0.03], bunchsize=2)
        self.assertEqual(stage.qWAV([1, 2, 3], [1, 1, 1]), {1: {1: 200}, 2: {1: 200}, 3: {1: 4}})
        stage.WSL([1, 6], [1, 2])
        self.assertEqual(stage.qWSL([1, 6]), {1: 1, 6: 2})
        stage.WGC([1, 6], [3, 3])
        self.assertEqual(stage.qWGC([1]), {1: 3})
        stage.WTR(0, 40, 1)
        stage.WGO([1, 6], [1, 1])
        self.assertTrue(stage.IsGeneratorRunning(1)[1])
        self.assert_refused(gcserror.E73_PI_CNTR_WAVE_GENERATOR_ACTIVE, stage.MOV, "X", 1)
        pitools.waitonwavegen(stage)
        pitools.waitontarget(stage)
        self.assertLess(stage.qPOS("X")["X"], 0.01)
        stage.WCL([1, 2, 3])
        self.assert_refused(gcserror.E75_PI_CNTR_NO_WAVE_SELECTED, stage.WGO, 1, 1)

    def test_streamed_targets(self):
        if not self.KEEPS_TIME:
            self.skipTest("targets come by the wall clock")
        stage = self.stage
        stage.SCT(50)
        self.assertEqual(stage.qSCT(), 50)
        stage.SPA(1, 0x19001900, 1)
        try:
            start = time.monotonic()
            for i in range(60):
                part = min(i / 40, 1)
                stage.MOV("X", 5 * part**3 * (10 - 15 * part + 6 * part**2))
                time.sleep(max(0, start + 0.05 * (i + 1) - time.monotonic()))
            pitools.waitontarget(stage)
            self.assert_at(X=5)
        finally:
            stage.SPA(1, 0x19001900, 0)
            stage.SCT(10)

    def test_data_recorder(self):
        with datarectools.Datarecorder(self.stage) as recorder:
            self.assertEqual(recorder.maxnumvalues, 2048)
            self.assertEqual(recorder.servotime, 5e-5)
            self.assertIn(datarectools.RecordOptions.ACTUAL_POSITION_2, recorder.recopts)
            self.assertIn(datarectools.TriggerSources.NEXT_COMMAND_WITH_RESET_2, recorder.trigopts)
            recorder.options = [1, 2, 3, 73]
            recorder.sources = ["X", "X", "X", "2"]
            recorder.numvalues = 1500
            recorder.samplefreq = 5000
            recorder.trigsources = datarectools.TriggerSources.NEXT_COMMAND_WITH_RESET_2
            recorder.arm()
            self.assertEqual(self.stage.qDRL(1)[1], 0)
            self.stage.MOV("X", 8)
            header, data = recorder.getdata(timeout=60)
            self.assertEqual((header["DIM"], header["NDATA"], header["SAMPLE_TIME"]), (4, 1500, 2e-4))
            self.assertEqual(header["NAME2"], "position error of X, mm")
            self.assertEqual([len(column) for column in data], [1500] * 4)
            commanded, real, error, duty = data
            self.assertAlmostEqual(commanded[0], 0, delta=1e-6)
            self.assertAlmostEqual(commanded[-1], 8, delta=1e-6)
            for wanted, measured, difference in zip(commanded, real, error):
                self.assertAlmostEqual(measured - wanted, difference, delta=3e-9)
                self.assertAlmostEqual(difference, 0, delta=0.02)
            self.assertGreater(max(duty), 0.001)
            self.assertEqual(self.stage.qDRT(1)[1][0], 0)
        pitools.waitontarget(self.stage)
        self.stage.RTR(1)

    def test_step_response(self):
        self.stage.DRC([1, 2], ["X", "X"], [1, 2])
        self.assertEqual(self.stage.qDRC([1, 2]), {1: ["X", 1], 2: ["X", 2]})
        self.assertEqual(self.stage.qTNR(), 8)
        self.stage.RTR(2)
        self.assertEqual(self.stage.qRTR(), 2)
        self.stage.STE("X", 0.5)
        while self.stage.qDRL(1)[1] < 2000:
            pass
        header = self.stage.qDRR([1, 2], 1, 2000)
        while self.stage.bufstate is not True:
            time.sleep(0.01)
        commanded, real = self.stage.bufdata
        self.assertEqual(header["NAME0"], "commanded position of X, mm")
        self.assertAlmostEqual(commanded[0], 0, delta=1e-6)
        self.assertAlmostEqual(commanded[-1], 0.5, delta=1e-6)
        self.assertAlmostEqual(real[-1], 0.5, delta=PLACE_MM)
        self.assertTrue(all(later >= sooner for sooner, later in zip(commanded, commanded[1:])))
        self.stage.RTR(1)
        self.assert_refused(57, self.stage.DRC, 9, "X", 1)
        self.assert_refused(58, self.stage.DRC, 1, "X", 99)
        self.assert_refused(gcserror.E7_PI_CNTR_POS_OUT_OF_LIMITS, self.stage.STE, "X", 100)
        pitools.waitontarget(self.stage)

    def test_travel_helpers(self):
        self.assertEqual(pitools.getmaxtravelrange(self.stage, "X")["X"], 80)
        self.assertEqual(pitools.getmintravelrange(self.stage, "X")["X"], -80)
        pitools.movetomiddle(self.stage)
        pitools.waitontarget(self.stage)


class OverTcp(Drive, unittest.TestCase):
    """Over TCP."""

    @classmethod
    def open(cls):
        return PISocket(host="127.0.0.1", port=ARGUMENTS.port)

    def test_errors_are_each_clients_own(self):
        with socket.create_connection(("127.0.0.1", ARGUMENTS.port)) as other:
            other.sendall(b"MOV X 500\nERR?\n")
            self.assertEqual(other.recv(100), b"7\n")
        self.assertEqual(self.stage.qERR(), 0)


class OverTerminal(Drive, unittest.TestCase):
    """Over the pseudo-terminal."""

    @classmethod
    def open(cls):
        return PISerial(port=ARGUMENTS.terminal, baudrate=115200)


class OverChip(Drive, unittest.TestCase):
    """Over the serial line of the emulated chip, which is several times slower than the real one."""

    # What the emulator gives as the identity of the chip: "emulated F42".
    SERIAL = "656D756C6174656420463432"
    KEEPS_TIME = False
    # The emulator has no model of what is in flash.
    KEEPS_SETTINGS = False

    @classmethod
    def open(cls):
        # It starts for as long as PIPython waits for an answer, on a busy machine for longer.
        with socket.create_connection(("127.0.0.1", ARGUMENTS.chip), timeout=START_S) as starting:
            starting.sendall(b"*IDN?\n")
            with starting.makefile("rb") as answers:
                answers.readline()
        return PISocket(host="127.0.0.1", port=ARGUMENTS.chip)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int)
    parser.add_argument("--terminal")
    parser.add_argument("--chip", type=int)
    parser.add_argument("--transcript", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    GcsPage.port = ARGUMENTS.port
    open(ARGUMENTS.transcript, "w", encoding="utf-8").close()
    unittest.main(argv=["drive.py", *rest], verbosity=2)
