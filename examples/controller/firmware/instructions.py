#!/usr/bin/env python3
"""Instructions per call on a Cortex-M7: `instructions.py PROGRAM`.

Runs the program `instructions` in the emulator Unicorn (`pip install unicorn`) and counts the instructions from the
entry of each function of `src/instructions.rs` to its return. The emulator's Cortex-M7 has no double precision, so a
processor with the same Thumb instructions executes the machine code from `main` on. Needs arm-none-eabi-nm and
-objcopy.
"""

import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_MODE_THUMB, Uc, UcError
from unicorn.arm_const import (
    UC_ARM_REG_C1_C0_2,
    UC_ARM_REG_FPEXC,
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_SP,
    UC_CPU_ARM_MAX,
)

FUNCTIONS = ["controller_step", "observer_step", "filter_10_no_forgetting_64", "filter_10_update_block_64"]
FUNCTIONS += ["filter_10_update_block_32", "filter_49_no_forgetting_64", "filter_49_update_block_64", "payload_update_64"]
FUNCTIONS += ["payload_update_32", "payload_body_64", "payload_body_32"]
FLASH, RAM = (0x08000000, 0x200000), (0x20000000, 0x20000)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def addresses(program):
    """Addresses of the functions and of the end."""
    found = {}
    for line in run("arm-none-eabi-nm", program).splitlines():
        address, _, symbol = line.split(maxsplit=2)
        name = re.search(r"instructions\d+(\w+)17h[0-9a-f]{16}E$", symbol)
        if name and name[1] in [*FUNCTIONS, "finished", "__cortex_m_rt_main"]:
            found[int(address, 16) & ~1] = name[1]
    return found


def instructions(code):
    """Number of Thumb instructions; those that begin with 0b11101 to 0b11111 have two halfwords."""
    at = number = 0
    while at < len(code):
        at += 4 if code[at + 1] >> 3 >= 0b11101 else 2
        number += 1
    return number


class Counter:
    """Instructions of each call, block by block. Functions do not call each other."""

    def __init__(self, places):
        self.places, self.count, self.open, self.lengths = places, 0, None, {}
        self.calls = {name: [] for name in FUNCTIONS}

    def __call__(self, emulator, address, size, _):
        if self.open and address == self.open[1] and emulator.reg_read(UC_ARM_REG_SP) == self.open[2]:
            self.calls[self.open[0]].append(self.count - self.open[3])
            self.open = None
        name = self.places.get(address)
        if name == "finished":
            emulator.emu_stop()
        elif name:
            back = emulator.reg_read(UC_ARM_REG_LR) & ~1
            self.open = name, back, emulator.reg_read(UC_ARM_REG_SP), self.count
        length = self.lengths.get((address, size))
        if length is None:
            length = self.lengths[address, size] = instructions(emulator.mem_read(address, size))
        self.count += length


def counts(program):
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "image"
        run("arm-none-eabi-objcopy", "-O", "binary", program, image)
        flash = image.read_bytes()
    emulator = Uc(UC_ARCH_ARM, UC_MODE_THUMB)
    emulator.ctl_set_cpu_model(UC_CPU_ARM_MAX)
    for start, size in (FLASH, RAM):
        emulator.mem_map(start, size)
    emulator.mem_write(FLASH[0], flash)
    emulator.reg_write(UC_ARM_REG_SP, sum(RAM))
    # Enable the floating-point unit.
    emulator.reg_write(UC_ARM_REG_C1_C0_2, emulator.reg_read(UC_ARM_REG_C1_C0_2) | 0xF << 20)
    emulator.reg_write(UC_ARM_REG_FPEXC, 1 << 30)
    places = addresses(program)
    (start,) = [address for address, name in places.items() if name == "__cortex_m_rt_main"]
    counter = Counter({address: name for address, name in places.items() if address != start})
    emulator.hook_add(UC_HOOK_BLOCK, counter)
    try:
        emulator.emu_start(start | 1, 0)
    except UcError as error:
        raise SystemExit(f"stopped at {emulator.reg_read(UC_ARM_REG_PC):#x}: {error}") from error
    return counter.calls


def main():
    for name, calls in counts(sys.argv[1]).items():
        if not calls:
            raise SystemExit(f"{name} was not called")
        print(f"{name}: {len(calls)} calls, median {statistics.median_low(calls)}, largest {max(calls)} instructions")


if __name__ == "__main__":
    main()
