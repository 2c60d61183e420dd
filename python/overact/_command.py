"""The command line, which the package brings along: ``overact`` or ``python -m overact``."""

from __future__ import annotations

import signal
import sys

from ._overact import command


def main() -> int:
    """Runs the command line with the arguments of the process; returns its exit code."""
    # The work is done outside of Python, which would hear of Ctrl-C at its end only.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["overact", *sys.argv[1:]])
