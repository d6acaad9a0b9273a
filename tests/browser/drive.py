"""Drives page and report in headless Chromium as a person would. Started by `run`, which says where everything is."""

import argparse
import unittest

from calibration import Calibration
from commissioning import Commissioning
from foreign import Foreign
from live import Live
from owners import Owners
from panels import Panels
from real import Real
from remote import Remote
from report import Report
from sequence import Sequence
from settings import ARGUMENTS
from silent import Silent
from view import OnChip, OnTerminal

__all__ = ["Calibration", "Commissioning", "Foreign", "Live", "OnChip", "OnTerminal", "Owners", "Panels", "Real", "Remote", "Report", "Sequence", "Silent"]

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("program", "report", "pictures", "image", "axe"):
        parser.add_argument(f"--{name}", required=True)
    rest = parser.parse_known_args(namespace=ARGUMENTS)[1]
    unittest.main(argv=["drive.py", *rest])
