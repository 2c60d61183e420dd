"""Shared test fixtures."""

import json
import pathlib
import subprocess
import sys

import pytest

import overact

ROBOTS = pathlib.Path(__file__).resolve().parents[2] / "robots"


@pytest.fixture(scope="session")
def dualv():
    return overact.Robot(ROBOTS / "dualv.toml")


@pytest.fixture(scope="session")
def emps():
    return overact.Robot(ROBOTS / "emps.toml")


@pytest.fixture
def command(tmp_path):
    """The package's command line, in a separate folder."""

    def run(*arguments, code=0):
        whole = [sys.executable, "-m", "overact", *map(str, arguments)]
        done = subprocess.run(whole, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert done.returncode == code, done.stderr
        return done.stdout

    run.json = lambda *arguments: json.loads(run(*arguments, "--json"))
    return run
