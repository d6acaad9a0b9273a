"""The reader against pictures of a plate whose pose is known: rendered with a lens' distortion, uneven light and noise."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import cv2
import numpy as np

SETUP = {"pitch_mm": 1.0, "camera_mm": [45.0, 10.0], "mm_per_pixel": 0.01, "k1": 1.5e-8}
PIXELS = 800
DOT_MM = 0.5
NOISE = 3.0
# Root mean squares of what was measured over the poses below (0.189 um under the camera, a fiftieth of a pixel, and 3.21 urad), and a tenth more.
MOST_UM = 0.208
MOST_URAD = 3.54


def rendered(x_mm, y_mm, theta_deg, random):
    """What the camera sees: for each pixel the place on the plate, and how much of it is dark."""
    axis = np.arange(PIXELS) - (PIXELS - 1) / 2
    bent_x, bent_y = np.meshgrid(axis, -axis)
    true_x, true_y = bent_x.copy(), bent_y.copy()
    for _ in range(6):
        scale = 1 + SETUP["k1"] * (true_x**2 + true_y**2)
        true_x, true_y = bent_x / scale, bent_y / scale
    right = true_x * SETUP["mm_per_pixel"] + SETUP["camera_mm"][0] - x_mm
    up = true_y * SETUP["mm_per_pixel"] + SETUP["camera_mm"][1] - y_mm
    angle = np.radians(theta_deg)
    plate_x = np.cos(angle) * right + np.sin(angle) * up
    plate_y = np.cos(angle) * up - np.sin(angle) * right
    pitch = SETUP["pitch_mm"]
    off = np.hypot(plate_x - pitch * np.round(plate_x / pitch), plate_y - pitch * np.round(plate_y / pitch))
    # A rim of two pixels, as the lens leaves it.
    dark = np.clip((DOT_MM / 2 - off) / (2 * SETUP["mm_per_pixel"]) + 0.5, 0, 1)
    light = 200 + 15 * axis[None, :] / PIXELS
    image = light * (1 - 0.85 * dark) + random.normal(0, NOISE, off.shape)
    return np.clip(np.round(image), 0, 255).astype(np.uint8)


def read(setup, path, sent):
    reader = os.path.join(os.path.dirname(__file__), "reader.py")
    return subprocess.run([sys.executable, reader, setup, path], input=" ".join(map(str, sent)), capture_output=True, text=True)


class Reader(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.setup, self.path = (os.path.join(folder.name, name) for name in ("setup.json", "picture.png"))
        with open(self.setup, "w", encoding="utf-8") as file:
            json.dump(SETUP, file)

    def test_poses_come_back_from_pictures(self):
        random = np.random.default_rng(1)
        errors = []
        for theta_deg in (0.0, 3.7, 45.0, 90.2, -133.0, 179.99, 725.0, -361.5):
            x_mm, y_mm = random.uniform(-40, 40, 2)
            cv2.imwrite(self.path, rendered(x_mm, y_mm, theta_deg, random))
            # The stage is off where it was sent, as before any calibration.
            sent = (x_mm + 0.15, y_mm - 0.1, theta_deg + 0.1)
            answer = read(self.setup, self.path, sent)
            self.assertEqual(answer.returncode, 0, answer.stderr)
            got = [float(word) for word in answer.stdout.split()]
            turn = np.radians(got[2] - theta_deg)
            # The platform's middle is up to 90 mm from the dots that are seen, where theta's error moves it: judged under the camera.
            arm = np.array(SETUP["camera_mm"]) - [x_mm, y_mm]
            off = np.array(got[:2]) - [x_mm, y_mm] + turn * np.array([-arm[1], arm[0]])
            errors.append([1e3 * off[0], 1e3 * off[1], 1e6 * turn])
        errors = np.array(errors)
        urad = np.sqrt((errors[:, 2] ** 2).mean())
        um = np.sqrt((errors[:, :2] ** 2).sum(1).mean())
        print(f"{um:.4f} um under the camera, {urad:.2f} urad rms over {len(errors)} pictures")
        self.assertLess(um, MOST_UM)
        self.assertLess(urad, MOST_URAD)

    def test_no_plate_is_no_reading(self):
        cv2.imwrite(self.path, np.full((PIXELS, PIXELS), 200, np.uint8))
        self.assertNotEqual(read(self.setup, self.path, (0, 0, 0)).returncode, 0)


if __name__ == "__main__":
    unittest.main()
