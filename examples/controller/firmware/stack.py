#!/usr/bin/env python3
"""Flash and stack usage of a firmware without recursion and indirect calls: `stack.py FIRMWARE`.

A function's stack is what its code pushes and subtracts. The total is that of the deepest call chain from
the reset, plus that of the timer's interrupt. Needs arm-none-eabi-objdump and -size.
"""

import re
import subprocess
import sys

# Stored by the core at an interrupt, including the registers of the floating-point unit.
EXCEPTION_FRAME = 104


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def registers(words):
    """Number of registers in a list as `r4, r5, r7, lr` or `d8-d15`."""
    count = 0
    for word in words.split(","):
        ends = [int(end) for end in re.findall(r"\d+", word)]
        count += ends[1] - ends[0] + 1 if "-" in word else 1
    return count


def functions(program):
    """For each function by name: frame size in bytes, and called functions."""
    found, name = {}, None
    for line in run("arm-none-eabi-objdump", "-d", "--no-show-raw-insn", program).splitlines():
        if head := re.match(r"[0-9a-f]+ <(.+)>:$", line):
            name = head[1]
            found[name] = [0, set()]
        elif name and (code := re.match(r"\s+[0-9a-f]+:\t(\S+)\s*(.*)", line)):
            operation, operands = code[1].split(".")[0], code[2]
            frame = found[name]
            if operation in ("push", "stmdb", "vpush"):
                listed = re.search(r"\{(.+)\}", operands)[1]
                frame[0] += registers(listed) * (8 if listed.startswith("d") else 4)
            elif size := re.match(r"sp, (?:sp, )?#(\d+)", operands) if operation in ("sub", "subw") else None:
                frame[0] += int(size[1])
            elif operation in ("blx", "bx") and not re.match(r"lr", operands):
                raise SystemExit(f"{name} calls through a pointer: {operation} {operands}")
            elif operation.startswith("b") and (target := re.search(r"<([^+>]+)>", operands)):
                if target[1] != name:
                    frame[1].add(target[1])
    return found


def deepest(found, name, above=()):
    if name in above:
        raise SystemExit(f"{name} calls itself: {' -> '.join(above)}")
    if name not in found:
        return 0
    frame, calls = found[name]
    return frame + max((deepest(found, call, (*above, name)) for call in calls), default=0)


def main():
    program = sys.argv[1]
    found = functions(program)
    text, data, bss = map(int, run("arm-none-eabi-size", program).splitlines()[1].split()[:3])
    largest = max(found, key=lambda name: found[name][0])
    stack = deepest(found, "Reset") + EXCEPTION_FRAME + deepest(found, "SysTick")
    print(f"flash {text + data} bytes, static memory {data + bss} bytes, stack {stack} bytes")
    print(f"largest frame: {found[largest][0]} bytes, {largest}")


if __name__ == "__main__":
    main()
