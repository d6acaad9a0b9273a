#!/usr/bin/env python3
"""A reader for `tripivot calibrate measure --kit xyt --reader 'tests/dotgrid/reader.py setup.json picture.png'`: a camera looks down on a plate of
dots that lies on the platform, and this tells where the platform is.

On standard input comes where the stage was sent: x_mm y_mm theta_deg. It is right to far less than half a pitch, so it tells which dot is which.
On standard output goes x_mm y_mm theta_deg as the picture has it. Take the picture in `picture()`: here it is a file, with a camera of yours
it is `cv2.VideoCapture(0).read()`.

The set-up file: pitch_mm of the dots; camera_mm, the base frame's place under the picture's middle; mm_per_pixel, and k1, the radial distortion
per square pixel (x distorted = x (1 + k1 r^2)), both from `cv2.calibrateCamera` or from the plate itself.
"""

import json
import sys

import cv2
import numpy as np


def picture(path):
    image = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
    if image is None:
        sys.exit(f"no picture in {path}")
    return image


def dots_px(image):
    """Centres of whole dark dots, px from the picture's middle, x to the right and y up."""
    _, dark = cv2.threshold(image, 0, 255, cv2.THRESH_BINARY_INV | cv2.THRESH_OTSU)
    count, _, stats, _ = cv2.connectedComponentsWithStats(dark)
    height, width = image.shape
    usual = np.median(stats[1:, cv2.CC_STAT_AREA])
    centres = []
    for left, top, wide, high, area in stats[1:]:
        # Dots that the picture cuts, and dust.
        is_whole = left > 2 and top > 2 and left + wide < width - 2 and top + high < height - 2
        if not is_whole or not 0.7 * usual < area < 1.4 * usual:
            continue
        # The centre of the darkness around it, not of the threshold: that is steady to hundredths of a pixel.
        part = image[top - 3:top + high + 3, left - 3:left + wide + 3].astype(float)
        bright = np.median(np.concatenate([part[0], part[-1], part[:, 0], part[:, -1]]))
        moments = cv2.moments(np.clip(bright - part, 0, None))
        centres.append((left - 3 + moments["m10"] / moments["m00"], top - 3 + moments["m01"] / moments["m00"]))
    centres = np.array(centres).reshape(-1, 2) - [(width - 1) / 2, (height - 1) / 2]
    return centres * [1, -1]


def straight(places, k1):
    """Without the lens' distortion."""
    camera, none = np.eye(3), np.array([k1, 0.0, 0.0, 0.0])
    return cv2.undistortPoints(places.reshape(-1, 1, 2), camera, none).reshape(-1, 2)


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def pose(image, setup, sent):
    """x_mm, y_mm, theta_deg of the platform, that was sent to about there."""
    seen = straight(dots_px(image), setup["k1"]) * setup["mm_per_pixel"] + setup["camera_mm"]
    pitch = setup["pitch_mm"]
    place, angle = np.array(sent[:2]), np.radians(sent[2])
    # Which dots they are; then where the platform is for these, and which they are from there.
    for _ in range(3):
        on_plate = (seen - place) @ turned(angle)
        drawn = np.round(on_plate / pitch) * pitch
        off = np.hypot(*(on_plate - drawn).T)
        good = off < 0.3 * pitch
        if good.sum() < 6:
            sys.exit(f"{good.sum()} dots where they should be: too few")
        a, b = drawn[good] - drawn[good].mean(0), seen[good] - seen[good].mean(0)
        angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
        # The angle of the turn that was sent, not one of another turn.
        angle += 2 * np.pi * np.round((np.radians(sent[2]) - angle) / (2 * np.pi))
        place = seen[good].mean(0) - turned(angle) @ drawn[good].mean(0)
    return place[0], place[1], np.degrees(angle)


def main():
    setup_path, picture_path = sys.argv[1:]
    with open(setup_path, encoding="utf-8") as file:
        setup = json.load(file)
    sent = [float(word) for word in sys.stdin.read().split()]
    print("{:.7f} {:.7f} {:.8f}".format(*pose(picture(picture_path), setup, sent)))


if __name__ == "__main__":
    main()
