"""Damages files: text is lost, doubled, moved or replaced; numbers become invalid or change magnitude."""

import random
import re

NUMBERS = ["0", "-1", "1e400", "nan", "inf", "1e-320", "9" * 40, "true", '"1 m"', '"1 kg"', "[]", "{}", "1.5.2", "0x", '"-0 deg"']
WORDS = ["revolute", "prismatic", "spatial", "point", "base", "leg", "é", "\u202e", "\x00", "'", '"""', "]]", "[[", "= =", "#", "\\u0000"]
MARKS = ["<", "/>", "<!--", "&amp;", "&x;", "<body>", "</joint>", '="', "<![CDATA[", "(*", ",,", "{", "**"]
#: Every text contains one of these.
NUMBER, WORD = r"-?\d+(\.\d+)?(e-?\d+)?", r"[A-Za-z_]+"


def damaged(content: bytes, draw: random.Random, is_text: bool = True) -> bytes:
    """The file with one to four faults."""
    for _ in range(draw.choice([1, 1, 1, 2, 4])):
        content = in_text(content.decode(errors="replace"), draw).encode(errors="replace") if is_text else in_bytes(content, draw)
    return content


def in_text(text: str, draw: random.Random) -> str:
    """Applies one fault to a text."""
    lines = text.splitlines(keepends=True) or [""]
    # Numbers of another magnitude pass most checks and reach far into the commands.
    kind = draw.choice([0, 1, 2, 3, 4, 5, 6, 6, 6, 7, 8])
    if kind in (2, 6) and (numbers := list(re.finditer(NUMBER, text))):
        one = draw.choice(numbers)
        other = draw.choice(NUMBERS) if kind == 2 else f"{float(one.group()) * 10.0 ** draw.randint(-9, 9):.17g}"
        return text[: one.start()] + other + text[one.end() :]
    if kind == 3 and (words := list(re.finditer(WORD, text))):
        one, other = draw.choice(words), draw.choice(words).group()
        return text[: one.start()] + draw.choice([other, *WORDS, *MARKS]) + text[one.end() :]
    if kind == 4:
        return text[: draw.randrange(len(text) + 1)]
    if kind == 5:
        place = draw.randrange(len(text) + 1)
        return text[:place] + draw.choice(WORDS + NUMBERS + MARKS) + text[place:]
    if kind in (0, 1, 7):
        at, other = draw.randrange(len(lines)), draw.randrange(len(lines))
        if kind == 0:
            del lines[at]
        elif kind == 1:
            lines.insert(other, lines[at])
        else:
            lines[at], lines[other] = lines[other], lines[at]
        return "".join(lines)
    first, last = sorted([draw.randrange(len(text) + 1), draw.randrange(len(text) + 1)])
    return text[:first] + text[min(last, first + 40) :]


def in_bytes(content: bytes, draw: random.Random) -> bytes:
    """Applies one fault to a binary file, half of the time in its header."""
    near = min(len(content), 200)
    at = draw.choice([draw.randrange(near + 1), draw.randrange(len(content) + 1), len(content) - draw.randrange(near + 1)])
    width = draw.choice([1, 1, 2, 4, 8, 40])
    kind = draw.randrange(5)
    if kind == 0:
        return content[:at]
    if kind == 1:
        return content[:at] + content[at + width :]
    if kind == 2:
        return content[:at] + content[at : at + width] * 2 + content[at + width :]
    filling = draw.randbytes(width) if kind == 3 else draw.choice([b"\x00", b"\xff", b"\x7f"]) * width
    return content[:at] + filling + content[at + width :]
