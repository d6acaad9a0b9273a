"""What the controller does by itself, set up and watched through PIPython: macros, command levels, the heartbeat."""

import time

from pipython import GCSError, gcserror, pitools

SILENCE_MS = 1000
"""Longest silence of the host: far longer than PIPython is silent between two commands, on a busy machine too."""
PATIENCE_S = 60
"""Far longer than anything here takes, on a busy machine and on the emulated chip too."""
FLASH_FAILED = 4001


class Programs:
    """Tests for each way to the stage. PIPython has no functions for `WAC`, `JRC` and `HBT`: they are sent as lines."""

    def record(self, name, *commands):
        """A macro of lines, and of PIPython's own functions."""
        self.stage.MAC_BEG(name)
        for command in commands:
            if callable(command):
                command()
            else:
                self.stage.send(command)
        self.keep(self.stage.MAC_END)
        self.addCleanup(self.keep, self.stage.MAC_DEL, name)

    def keep(self, change, *arguments):
        """A change that the controller keeps in flash; without a flash it takes effect, and an error says that it is not kept."""
        if self.KEEPS_SETTINGS:
            change(*arguments)
            return
        self.stage.errcheck = False
        try:
            change(*arguments)
        finally:
            self.stage.errcheck = True
        start = time.monotonic()
        while self.stage.qERR() != FLASH_FAILED:
            self.assertLess(time.monotonic(), start + PATIENCE_S)

    def test_a_macro_with_arguments_and_one_inside_another(self):
        stage = self.stage
        self.record("there", lambda: stage.MOV("X", 5), "WAC ONT? X = 1", lambda: stage.MOV({"Y": "$1"}))
        self.assertEqual(stage.qMOV("X")["X"], 0)
        self.assertEqual(stage.qMAC("there"), "MOV X 5 \nWAC ONT? X = 1 \nMOV Y $1\n")
        self.assertEqual(stage.qMAC().split(), ["there"])
        stage.MAC_START("there", "-3")
        pitools.waitonmacro(stage, timeout=PATIENCE_S)
        pitools.waitontarget(stage)
        self.assert_at(X=5, Y=-3)
        self.record("twice", lambda: stage.MAC_NSTART("there", 2, "4"), lambda: stage.MVR("Y", 0.5))
        self.assertEqual(stage.qMAC().split(), ["there", "twice"])
        stage.MAC_START("twice")
        pitools.waitonmacro(stage, timeout=PATIENCE_S)
        pitools.waitontarget(stage)
        self.assert_at(X=5, Y=4.5)

    def test_a_macro_counts_and_leaves_on_a_condition(self):
        stage = self.stage
        stage.VAR("N", 0)
        self.record("count", lambda: stage.ADD("N", "$N", 1), "JRC -1 VAR? N < 5", lambda: stage.MEX("VAR? N = 5"),
                    lambda: stage.MOV("X", 9))
        stage.MAC_START("count")
        pitools.waitonmacro(stage, timeout=PATIENCE_S)
        self.assertEqual(stage.qVAR("N"), {"N": "5"})
        self.assertEqual(stage.qMOV("X")["X"], 0)
        stage.send("VAR N")
        self.assertNotIn("N", stage.qVAR())

    def test_a_macro_is_seen_to_run_and_stopped(self):
        stage = self.stage
        free = stage.MAC_qFREE()
        self.record("wait", lambda: stage.DEL(600_000), lambda: stage.MOV("X", 9))
        self.assertLess(stage.MAC_qFREE(), free)
        stage.MAC_START("wait")
        self.assertTrue(stage.IsRunningMacro())
        self.assertEqual(stage.qRMC().strip(), "wait")
        self.assert_refused(gcserror.E1008_PI_CNTR_RUNNING_MACRO, stage.MAC_START, "wait")
        stage.MAC_STOP("wait")
        pitools.waitonmacro(stage, timeout=PATIENCE_S)
        self.assertEqual(stage.qMOV("X")["X"], 0)

    def test_what_goes_wrong_in_a_macro_is_told(self):
        stage = self.stage
        self.record("far", lambda: stage.MOV("X", 500))
        stage.MAC_START("far")
        with self.assertRaises(GCSError) as caught:
            pitools.waitonmacro(stage, timeout=PATIENCE_S)
        self.assertEqual(caught.exception.val, gcserror.E1012_PI_CNTR_ERROR_IN_MACRO)
        self.assertEqual(stage.MAC_qERR().strip(), "far 1=7 <MOV X 500>")
        self.assert_refused(gcserror.E20_PI_CNTR_MACRO_NOT_FOUND, stage.MAC_START, "nowhere")
        self.assertEqual(stage.qMOV("X")["X"], 0)

    def test_command_levels(self):
        stage = self.stage
        gain = 0x54500300
        # A number with as many digits as the client writes.
        before = round(stage.qSPA(1, gain)[1][gain], 6)
        self.assert_refused(gcserror.E60_PI_CNTR_PARAM_PROTECTION, stage.SPA, 1, gain, before + 1)
        self.assert_refused(gcserror.E56_PI_CNTR_INVALID_PASSWORD, stage.CCL, 1, "sesame")
        self.assertEqual(stage.qCCL(), 0)
        stage.CCL(1, "ADVANCED")
        self.assertEqual(stage.qCCL(), 1)
        stage.SPA(1, gain, before + 1)
        self.assertEqual(stage.qSPA(1, gain)[1][gain], before + 1)
        stage.SPA(1, gain, before)
        stage.CCL(0)
        self.assertEqual(stage.qCCL(), 0)
        self.assert_refused(gcserror.E60_PI_CNTR_PARAM_PROTECTION, stage.SPA, 1, gain, before)

    def test_a_host_that_falls_silent_has_the_stage_stopped(self):
        stage = self.stage
        stage.VLS(1)
        stage.send(f"HBT {SILENCE_MS}")
        self.assertEqual(float(stage.read("HBT?")), SILENCE_MS)
        stage.MOV("X", 60)
        # As long as it is heard, nothing happens.
        end = time.monotonic() + 2 * SILENCE_MS / 1e3
        while time.monotonic() < end:
            self.assertTrue(stage.IsMoving("X")["X"])
        self.assertEqual(stage.qERR(), 0)
        self.addCleanup(stage.send, "HBT 0")
        # The emulated chip's time is several times slower than the wall clock's, on a busy machine even slower: to ask is to be heard.
        silence_s = (2 if self.KEEPS_TIME else 10) * SILENCE_MS / 1e3
        error = 0
        while not error:
            self.assertLess(silence_s, PATIENCE_S)
            time.sleep(silence_s)
            error = stage.qERR()
            silence_s *= 2
        self.assertEqual(error, gcserror.E10_PI_CNTR_STOP)
        stage.send("HBT 0")
        pitools.waitontarget(stage)
        self.assertLess(stage.qPOS("X")["X"], 50)
        self.assertIn("no host heard", stage.read("EVT?"))
