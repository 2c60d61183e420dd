"""Runs a command on files and detects faults."""

import json
import pathlib
import re
import resource
import shutil
import signal
import subprocess

# Time limits of a command (processor and wall clock, s) and memory limit (bytes).
LONGEST, CLOCK, MEMORY = 120, 1200, 4 << 30
KEPT = b"what stood here before\n"


class Run:
    """A command on files in an empty folder."""

    def __init__(self, words: list, files: dict[str, bytes], folder: pathlib.Path):
        self.words, self.files, self.folder = words, files, folder
        for name, content in files.items():
            (folder / name).write_bytes(content)
        named = [word for word in map(str, words) if word.startswith("kept")]
        self.output = folder / (named[0] if named else "kept")
        self.output.write_bytes(KEPT)
        begin = used()
        self.code, self.result, self.complaint = run(words, folder)
        self.took = used() - begin

    @property
    def kept(self) -> bytes:
        return self.output.read_bytes() if self.output.exists() else b""

    def faults(self) -> list[str]:
        """All faults of the run."""
        is_right = self.code == 0
        is_python = "-c" in self.words
        said = self.result + self.complaint
        left = [file.name for file in self.folder.iterdir() if file.name not in {*self.files, self.output.name}]
        owned = [name for name in left if name == "c" or name.startswith("kept")]
        wrong = {
            "the time is up": self.code in (None, -signal.SIGXCPU),
            "it ended by a signal or a defect": self.code not in (None, -signal.SIGXCPU, 0, 1, 2),
            "it panicked": "panicked" in said or "Traceback" in said or "internal error" in said,
            "an input is touched": any((self.folder / name).read_bytes() != content for name, content in self.files.items()),
            "an output is touched": not is_right and (self.kept != KEPT or bool(owned)),
            "files are left": left != owned,
            "an output is empty": is_right and any((self.folder / name).stat().st_size == 0 for name in [self.output.name, *owned]),
            "an error has no code": self.code in (1, 2) and not is_python and not re.search(r"OA\d{3}", said),
            "a result is no document": is_right and "--json" in self.words and not is_document(self.result),
            "an error is no document": self.code in (1, 2) and "--json" in self.words and not is_document(self.complaint.splitlines()[-1]),
            "a report is no page": is_right and "--report" in self.words and not self.kept.rstrip().endswith(b"</html>"),
        }
        return [what for what, is_so in wrong.items() if is_so]

    def clear(self) -> None:
        for file in self.folder.iterdir():
            shutil.rmtree(file) if file.is_dir() else file.unlink()


def used() -> float:
    """Processor time of all commands so far, s."""
    own = resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime


def limited() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 5))


def run(words: list, folder: pathlib.Path) -> tuple[int | None, str, str]:
    """Exit code (None after a timeout), standard output and standard error."""
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, timeout=CLOCK, preexec_fn=limited, stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        return None, "", ""


def is_document(text: str) -> bool:
    try:
        json.loads(text)
        return True
    except ValueError:
        return False


def compiles(source: bytes, rlib: str, folder: pathlib.Path) -> str:
    """Messages of the compiler on a generated module."""
    (folder / "module.rs").write_bytes(b"#![no_std]\n" + source)
    externs = [f"--extern=overact={rlib}", f"-Ldependency={pathlib.Path(rlib).parent}"]
    words = ["rustc", "--edition=2024", "--crate-type=rlib", "--emit=metadata", *externs, "module.rs"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    return done.stderr if done.returncode else ""


def compiles_as_c(folder: pathlib.Path) -> str:
    """Messages of the C compiler on the files in a folder."""
    sources = sorted(folder.glob("*.c"))
    words = ["cc", "-std=c99", "-fsyntax-only", "-Wall", "-Werror", *sources]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    return done.stderr if done.returncode or not sources else ""
