"""Runs the commands of a page as a reader types them, and compares what arrives with what the page shows.

    tutorial_test.py PAGE.md

The page's blocks are taken in order, in a folder that looks like the root of the toolkit:

    ```LANGUAGE FILE        is written to FILE
    ```console              a line that begins with "$ " is a command, and goes on while lines end in a backslash; the lines
                            behind it are all that it prints, on stdout and stderr. It has to end with status 0
    ```console fails        the same, but the commands have to end with another status
    ```console runs         the command goes on in a terminal of its own, until the page ends; its first lines are shown
    ```sh tested            each line is a command, which has to end with status 0 and without an error; what it
                            prints is not shown
    <!-- varies: REGEX -->  in the line before a block: what matches differs from run to run
    <!-- any order -->      likewise: the lines shown may come in any order, and others between them
    <!-- needs: WORD... --> what is below needs these programs, or the data `networks`, `photos`; without them the test is
                            skipped here, by status 77

In what is shown the folder is /home/me/galatea, a line "..." stands for any lines, and "..." within a line for anything on it.
Blanks at the end of a line, which nobody sees, do not count. The ports 8080 to 8083 are replaced by free ones, and run_agent.sh
neither sets up nor builds.
"""
from __future__ import annotations

import contextlib
import dataclasses
import difflib
import os
import pathlib
import queue
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = pathlib.Path(os.environ.get("GALATEA_BIN", ROOT / "build" / "bin")).parent
PHOTOS = pathlib.Path(os.environ.get("GALATEA_PHOTOS", ROOT.parent / "shared" / "data" / "photos"))
NETWORKS = pathlib.Path(os.environ.get("GALATEA_NETWORKS", "/nowhere"))
LIMIT_S = 600
# What a command exports, and the folder it leaves to, hold for the next one.
BEFORE = 'set -o pipefail; [ ! -f ~/exported ] || { . ~/exported; cd "$PWD"; }'
BEHIND = "status=$?; export -p >~/exported; exit $status"


class Wrong(Exception):
    """The page and the programs disagree."""


class Missing(Exception):
    """Something the page needs is not there."""


@dataclasses.dataclass
class Block:
    """What stands between two fences of a page."""

    line: int
    words: list[str]
    text: list[str]
    varies: list[str]
    needs: list[str]
    any_order: bool = False


def blocks(page: str) -> Iterator[Block]:
    lines = page.splitlines()
    varies: list[str] = []
    needs: list[str] = []
    any_order = False
    at = 0
    while at < len(lines):
        if found := re.fullmatch(r"<!-- (varies|needs): (.*) -->", lines[at]):
            if found[1] == "varies":
                varies.append(found[2])
            else:
                needs += found[2].split()
        elif lines[at] == "<!-- any order -->":
            any_order = True
        elif lines[at].startswith("```"):
            end = next((n for n in range(at + 1, len(lines)) if lines[n] == "```"), None)
            if end is None:
                raise Wrong(f"line {at + 1}: the block does not end")
            yield Block(at + 1, lines[at][3:].split(), lines[at + 1:end], varies, needs, any_order)
            at, varies, needs, any_order = end, [], [], False
        at += 1


def steps(block: Block) -> Iterator[tuple[int, str, list[str]]]:
    """The commands of a console with their line, and what is shown behind each."""
    at = 0
    while at < len(block.text):
        line, command = block.line + 1 + at, block.text[at]
        if not command.startswith("$ "):
            raise Wrong(f"line {line}: expected a command, '$ ...'")
        while command.endswith("\\"):
            at += 1
            command += "\n" + block.text[at]
        end = next((n for n in range(at + 1, len(block.text)) if block.text[n].startswith("$ ")), len(block.text))
        yield line, command[2:], block.text[at + 1:end]
        at = end


def pattern(shown: list[str], varies: list[str]) -> re.Pattern[str]:
    """What matches the lines shown, each with a line feed."""
    whole = ""
    for line in shown:
        if line == "...":
            whole += r"(?:[^\n]*\n)*?"
            continue
        for vary in varies:
            line = re.sub(vary, "\0", line)
        whole += re.escape(line).replace(r"\.\.\.", r"[^\n]*") + "\n"
    return re.compile(whole)


def arrives(shown: list[str], said: str, block: Block) -> bool:
    shown, said = [line.rstrip() for line in shown], re.sub(r"[ \t]+$", "", said, flags=re.MULTILINE)
    for vary in block.varies:
        said = re.sub(vary, "\0", said, flags=re.MULTILINE)
    if not block.any_order:
        return bool(pattern(shown, block.varies).fullmatch(said))
    lines = said.splitlines()
    for one in shown:
        found = [line for line in lines if pattern([one], block.varies).fullmatch(line + "\n")]
        if one != "..." and not found:
            return False
        if one != "...":
            lines.remove(found[0])
    return True


def compare(line: int, command: str, shown: list[str], said: str, block: Block) -> None:
    if not arrives(shown, said, block):
        differences = "\n".join(difflib.unified_diff(shown, said.splitlines(), "the page", "what arrives", lineterm="", n=9))
        raise Wrong(f"line {line}: {command}\n{differences}")


@contextlib.contextmanager
def workspace() -> Iterator[pathlib.Path]:
    """A folder that looks like the root of the toolkit, in which what a command writes stays."""
    # A browser that was told to end may still write its profile.
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        root = pathlib.Path(folder, "galatea")
        (root / "scripts").mkdir(parents=True)
        for name in ("docs", "examples", "fsm", "python", "ssm", "tests", "vm_protocol"):
            (root / name).symlink_to(ROOT / name)
        for script in (ROOT / "scripts").iterdir():
            if script.name in ("setup.sh", "build.sh"):
                (root / "scripts" / script.name).write_text("#!/bin/sh\n")
                (root / "scripts" / script.name).chmod(0o755)
            else:
                (root / "scripts" / script.name).symlink_to(script)
        (root / "build").symlink_to(BUILD)
        if (PHOTOS / "hopper_usnavy.jpg").exists():
            shutil.copy(PHOTOS / "hopper_usnavy.jpg", root / "me.jpg")
        yield root


def free_ports(text: str) -> dict[str, str]:
    """A free port for each of those a page names."""
    ports = {}
    with contextlib.ExitStack() as held:
        for port in sorted(set(re.findall(r"\b808[0-3]\b", text))):
            place = held.enter_context(socket.socket())
            place.bind(("127.0.0.1", 0))
            ports[port] = str(place.getsockname()[1])
    return ports


def need(words: list[str]) -> None:
    for word in words:
        there = {"networks": (NETWORKS / "face_mesh").is_dir(), "photos": PHOTOS.is_dir()}.get(word, bool(shutil.which(word)))
        if not there:
            raise Missing(word)


class Reader:
    """Follows a page in a folder."""

    def __init__(self, root: pathlib.Path) -> None:
        self.root = root
        self.environment = {**os.environ, "HOME": str(root.parent)}
        self.running: list[subprocess.Popen[str]] = []

    def named(self, said: str) -> str:
        return said.replace(str(self.root.parent), "/home/me")

    def start(self, command: str, output: object) -> subprocess.Popen[str]:
        return subprocess.Popen(["bash", "-c", f"{BEFORE}\n{command}\n{BEHIND}"], cwd=self.root, env=self.environment, text=True,
                                stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, start_new_session=True)

    def end(self, process: subprocess.Popen[str]) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(10)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)

    def run(self, line: int, command: str) -> tuple[int, str]:
        with tempfile.TemporaryFile("w+") as output:
            process = self.start(command, output)
            try:
                status = process.wait(LIMIT_S)
            except subprocess.TimeoutExpired:
                self.end(process)
                status = -1
            output.seek(0)
            said = self.named(output.read())
        if status == -1:
            raise Wrong(f"line {line}: {command}\ndid not end within {LIMIT_S} s; it said\n{said}")
        return status, said

    def begin(self, line: int, command: str, shown: list[str], block: Block) -> None:
        """Starts what goes on, and reads until it has said what is shown."""
        process = self.start(command, subprocess.PIPE)
        self.running.append(process)
        said = queue.Queue[str]()
        threading.Thread(target=lambda: [*map(said.put, process.stdout or ()), said.put("")], daemon=True).start()
        heard, until = "", time.monotonic() + LIMIT_S
        while True:
            try:
                return compare(line, command, [*shown, "..."], heard, block)
            except Wrong:
                try:
                    more = self.named(said.get(timeout=max(until - time.monotonic(), 0)))
                except queue.Empty:
                    more = ""
                if not more:
                    raise
                heard += more

    def follow(self, block: Block) -> int:
        """Returns how many commands were run."""
        need(block.needs)
        language, *words = block.words or [""]
        if language == "sh" and words == ["tested"]:
            for number, command in enumerate(block.text, block.line + 1):
                status, said = self.run(number, command)
                if status or re.search(r"\berror: |\.error = ", said):
                    raise Wrong(f"line {number}: {command}\nended with {status}: {said}")
            return len(block.text)
        if language != "console":
            if words:
                (self.root / words[0]).parent.mkdir(parents=True, exist_ok=True)
                (self.root / words[0]).write_text("\n".join(block.text) + "\n")
            return 0
        if words not in ([], ["fails"], ["runs"]):
            raise Wrong(f"line {block.line}: expected fails or runs, found '{' '.join(words)}'")
        done = 0
        for line, command, shown in steps(block):
            done += 1
            if words == ["runs"]:
                self.begin(line, command, shown, block)
                continue
            status, said = self.run(line, command)
            compare(line, command, shown, said, block)
            if (status != 0) != (words == ["fails"]):
                raise Wrong(f"line {line}: {command}\nended with {status}")
        return done


def main() -> int:
    page = pathlib.Path(sys.argv[1]).read_text()
    for port, free in free_ports(page).items():
        page = re.sub(rf"\b{port}\b", free, page)
    done = 0
    with workspace() as root:
        reader = Reader(root)
        try:
            for block in blocks(page):
                done += reader.follow(block)
        except Missing as missing:
            print(f"needs {missing} for what is left of its page")
            return 77
        except Wrong as wrong:
            print(f"{sys.argv[1]}: {wrong}")
            return 1
        finally:
            for process in reader.running:
                reader.end(process)
    print(f"{done} commands run")
    return 0 if done else 1


if __name__ == "__main__":
    sys.exit(main())
