"""Drives the simulated stage with PIPython as a lab's script would. Started by `run`, which says where the stage is."""

import argparse
import math
import socket
import time
import unittest

from pipython import GCSDevice, GCSError, gcserror, pitools
from pipython.pidevice.interfaces.piserial import PISerial
from pipython.pidevice.interfaces.pisocket import PISocket

AXES = ["X", "Y", "Z", "U", "V", "W"]
PLACE_MM = 1e-3
"""How near a settled stage is to its target, mm or deg: a hundred encoder counts, and more than its noise."""

ARGUMENTS = argparse.Namespace()


def recorded(gateway):
    """`gateway`, whose traffic is written to the transcript besides, and which may be closed twice, as PIPython does."""
    send, read, close = gateway.send, gateway.read, gateway.close

    def write(sign, text):
        if text:
            with open(ARGUMENTS.transcript, "a", encoding="utf-8") as file:
                file.write(f"{sign} {text.encode('latin-1', 'replace')!r}\n")

    def recorded_send(message):
        write(">", message)
        send(message)

    def recorded_read():
        text = read()
        write("<", text)
        return text

    def close_once():
        if gateway.connected:
            close()

    gateway.send, gateway.read, gateway.close = recorded_send, recorded_read, close_once
    return gateway


class Drive:
    """The same tests for each way to the stage."""

    @classmethod
    def open(cls):
        raise NotImplementedError

    @classmethod
    def setUpClass(cls):
        cls.stage = cls.enterClassContext(GCSDevice(gateway=recorded(cls.open())))
        start = time.monotonic()
        pitools.startup(cls.stage, refmodes="FRF")
        cls.startup_s = time.monotonic() - start

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
        # Each time-out of PIPython is 7 s.
        self.assertLess(self.startup_s, 5)

    def test_identity(self):
        identity = self.stage.qIDN().strip().split(", ")
        self.assertEqual(identity[:2], ["(c)2026 Tripivot", "XYT-1 (C-887 compatible)"])
        self.assertEqual(self.stage.axes, AXES)
        self.assertEqual(self.stage.allaxes, AXES)
        self.assertIn("FW:", self.stage.qVER())
        self.assertEqual(self.stage.qSSN().strip(), "SIM")
        self.assertEqual(self.stage.qCSV(), 2.0)

    def test_every_command_that_is_listed_is_known_to_the_client(self):
        own = {"FLC", "qFLT", "WAC"}
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
        self.assertEqual(stage.getparam(0x16000201), 0)
        self.assertEqual(stage.getparam(0x19001900), 0)
        self.assertIsNone(stage.getparam(0x3C))
        stage.SPA(1, 0x54500100, 150)
        self.assertEqual(stage.qSPA(1, 0x54500100)[1][0x54500100], 150)
        stage.SPA(1, 0x54500100, 200)
        self.assert_refused(gcserror.E64_PI_CNTR_READ_ONLY_PARAMETER, stage.SPA, 1, 0x0E000200, 1)
        self.assertGreater(len(stage.qSPA()), 1)

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


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--terminal", required=True)
    parser.add_argument("--transcript", required=True)
    ARGUMENTS, rest = parser.parse_known_args()
    open(ARGUMENTS.transcript, "w", encoding="utf-8").close()
    unittest.main(argv=["drive.py", *rest], verbosity=2)
