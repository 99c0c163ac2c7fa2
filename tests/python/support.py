"""What the tests of the Python package share: the programs of the build, and hubs of their own."""
from __future__ import annotations

import contextlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterator, Sequence

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ.get("GALATEA_BIN", ROOT / "build" / "bin"))
sys.path.insert(0, str(ROOT / "python"))
LAMP = [sys.executable, str(ROOT / "examples" / "lamp_module.py")]


def program(name: str) -> str:
    """A program of the build; a test without it is skipped."""
    path = BIN / name
    if not path.exists():
        raise unittest.SkipTest(f"{name} is not built")
    return str(path)


def piped(command: list[str], lines: str) -> tuple[list[str], list[str]]:
    """What a program says to lines piped in: on stdout and on stderr."""
    done = subprocess.run(command, input=lines.encode(), capture_output=True, timeout=120, check=False)
    return done.stdout.decode().splitlines(), done.stderr.decode().splitlines()


@contextlib.contextmanager
def hub(*modules: dict[str, object], listen: Sequence[dict[str, str]] = (), **more: object) -> Iterator[list[str]]:
    """A hub with these modules. Gives the endpoints it listens on: a Unix socket, then those of `listen`."""
    with tempfile.TemporaryDirectory() as folder:
        places = [{"at": f"unix:{folder}/hub", "role": "owner"}, *listen]
        pathlib.Path(folder, "agent.json").write_text(json.dumps({"modules": modules, "listen": places, **more}))
        with subprocess.Popen([program("agent_manager"), "--config", f"{folder}/agent.json", "--no-console"],
                              stderr=subprocess.PIPE, text=True) as process:
            assert process.stderr
            said, endpoints = "", []
            try:
                while len(endpoints) < len(places):
                    line = process.stderr.readline()
                    if not line:
                        raise AssertionError(f"the hub did not start: {said}")
                    said += line
                    if "listening on " in line:
                        endpoints.append(line.split("listening on ")[1].strip())
                yield endpoints
            finally:
                process.terminate()
                process.stderr.read()


@contextlib.contextmanager
def workspace() -> Iterator[pathlib.Path]:
    """A folder that looks like the root of the toolkit, with the programs of this build under build/bin, to run commands in."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("docs", "examples", "python", "scripts", "vm_protocol"):
            (root / name).symlink_to(ROOT / name)
        (root / "build").mkdir()
        (root / "build" / "bin").symlink_to(BIN)
        yield root
