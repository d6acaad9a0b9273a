"""What `run` says: where the program is, and where pictures go. Filled before the tests begin."""

import argparse

ARGUMENTS = argparse.Namespace()
