"""Instructions and misses of the instruction cache per call, counted by callgrind.

They do not depend on other work of the machine. Only for default builds, because valgrind does not know every
instruction of a native one.
"""

import re
import subprocess

from . import timing

#: Numbers of passes through all states; the difference of two runs belongs to the functions.
FEW, MANY = 1, 5
#: 32 kB in 8 ways with lines of 64 bytes, as in most cores.
CACHE = ["--cache-sim=yes", "--I1=32768,8,64", "--D1=32768,8,64", "--LL=8388608,16,64"]


def counted(program, states, turns):
    """Instructions and misses of a run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *CACHE]
    done = subprocess.run(
        [*command, program.path, states, str(turns)], capture_output=True, text=True, check=True
    )
    found = [re.search(rf"{name}:\s+([\d,]+)", done.stderr) for name in (r"I\s+refs", r"I1\s+misses")]
    return [int(match[1].replace(",", "")) for match in found]


def per_call(program, states):
    """Instructions and misses of the instruction cache of one call."""
    few, many = (counted(program, states, turns) for turns in (FEW, MANY))
    calls = (MANY - FEW) * timing.STATES
    return [(b - a) / calls for a, b in zip(few, many, strict=True)]
