"""The command line, which is part of the package: ``overact`` or ``python -m overact``."""

from __future__ import annotations

import signal
import sys

from ._overact import command


def main() -> int:
    """Runs the command line with the arguments of the process; returns its exit code."""
    # The work is done outside of Python, which would handle Ctrl-C only at its end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["overact", *sys.argv[1:]])
