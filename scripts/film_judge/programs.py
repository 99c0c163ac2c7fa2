"""Where the programs are, and running one."""
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("GALATEA_BIN", os.path.join(ROOT, "build", "bin"))


class Failed(Exception):
    """A program did not do what it should; says which and what it said."""


def program(name):
    path = os.path.join(BIN, name)
    if not os.access(path, os.X_OK):
        raise Failed(f"{path} is not there: scripts/build.sh builds it")
    return path


def run(command, typed="", environment=None):
    done = subprocess.run(command, input=typed, text=True, env={**os.environ, **(environment or {})}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        raise Failed(f"{os.path.basename(command[0])} ended with {done.returncode}: {done.stderr.strip()[-600:]}")
    return done.stdout
