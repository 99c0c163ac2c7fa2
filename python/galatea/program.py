"""The life of a module's program: options, one stream, the clock, and an orderly end."""
from __future__ import annotations

import argparse
import os
import select
import signal
import socket
import ssl
import sys
import time
from collections import deque
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING

from galatea.clock import Clock
from galatea.endpoint import Credentials, Endpoint, call
from galatea.errors import Ended, Refused
from galatea.message import LineReader, Message, is_module_name, printable, rep, set_
from galatea.slots import READ_ONLY, WRITE_ONLY, Answer, SetValue, Slot

if TYPE_CHECKING:
    from galatea.module import Module

_BATCH_WAIT_S = 0.06  # how long a batch piped in has to end before it is taken for somebody who talks back and forth
_IDLE_CHECK_S = 0.02  # a module may become idle without a timer or a line


class _Pipes:
    """stdin and stdout."""

    def fileno(self) -> int:
        return sys.stdin.fileno()

    def pending(self) -> bool:
        return False

    def read(self) -> bytes:
        return os.read(sys.stdin.fileno(), 65536)

    def write(self, data: bytes) -> None:
        while data:
            data = data[os.write(sys.stdout.fileno(), data) :]


class _Socket:
    """A connection to the hub."""

    def __init__(self, plain: socket.socket) -> None:
        self._plain = plain

    def fileno(self) -> int:
        return self._plain.fileno()

    def pending(self) -> bool:
        return isinstance(self._plain, ssl.SSLSocket) and self._plain.pending() > 0

    def read(self) -> bytes:
        return self._plain.recv(65536)

    def write(self, data: bytes) -> None:
        self._plain.sendall(data)


class Program:
    """Joins a module to its stream and to time. What `vm::ModuleServer` is in C++, for one peer."""

    def __init__(self, module: Module, stream: _Pipes | _Socket, name: str) -> None:
        self.module = module
        self.clock = module.clock
        self.stream = stream
        self.name = name
        self.errors = 0
        self.failed = False
        self._reader = LineReader()
        self._lines: deque[bytes | Refused] = deque()
        self._ended = False
        self._stop = False
        self._waiting = False
        self._on_idle: Callable[[], None] | None = None
        self._held_exits: list[Callable[[], None]] = []
        self._wake, self._waker = os.pipe()
        os.set_blocking(self._waker, False)
        module.output = self._write
        module.complain = self._complain
        module.exit_gate = self._gate
        self._declare()

    # The slots of time.

    def _declare(self) -> None:
        declare = self.module.slots.declare
        declare(Slot("Clock", "<number 0..>", initial="0", on_set=self._set_clock, saved=False,
                     on_inq=lambda: self.module.clock_text().split(" ")[0], help=(
                         "This process's clock, in ms since its start. Setting it moves the clock on where Clock.mode is "
                         "HUB: everything due until then is done first; the answer is the time reached and the time of the "
                         "next thing to do, or - for nothing, and BUSY or IDLE.")))
        declare(Slot("Clock.mode", "REAL | VIRTUAL | HUB", on_set=self._set_mode, on_inq=lambda: self.clock.mode, saved=False,
                     help=("REAL: the machine's clock. VIRTUAL: time stands while nothing goes on and jumps from event to "
                           "event otherwise. HUB: time moves only by set Clock.")))
        declare(Slot("Clock.busy", "<text>", READ_ONLY, on_inq=lambda: "BUSY" if self.module.busy() else "IDLE",
                     help="BUSY while something with an end is going on, else IDLE."))
        declare(Slot("Wait", "IDLE | <ms>", WRITE_ONLY, on_set_later=self._set_wait, help=(
            "Holds the lines that follow from the same peer for so many ms, or until nothing is going on (IDLE).")))

    def _set_clock(self, value: SetValue) -> str:
        if self.clock.mode != "HUB":
            raise Refused("ACCESS", "the clock can be set only where Clock.mode is HUB")
        self.clock.advance(value.items[0].number)
        return self.module.clock_text()

    def _set_mode(self, value: SetValue) -> str:
        self.clock.set_mode(value.items[0].text)
        return value.items[0].text

    def _set_wait(self, value: SetValue, answer: Answer) -> None:
        def end() -> None:
            answer("0")
            self._waiting = False
            self._on_idle = None
        self._waiting = True
        if value.items[0].text == "IDLE":
            self._on_idle = end
        else:
            self.clock.after(value.items[0].number, end, busy=False)

    def _gate(self, leave: Callable[[], None]) -> None:
        """EXIT comes after what was said before it; said again, it comes at once."""
        self._held_exits.append(leave)
        if not self.module.busy() or len(self._held_exits) > 1:
            self._leave()

    def _leave(self) -> None:
        held, self._held_exits = self._held_exits, []
        for leave in held:
            leave()

    # Lines out and in.

    def _write(self, message: Message) -> None:
        try:
            self.stream.write(str(message).encode() + b"\n")
        except OSError:  # the reader has gone
            self.failed = self._stop = True

    def _complain(self, text: str) -> None:
        self.errors += text.startswith("error: ")
        print(f"{self.name}: {printable(text)}", file=sys.stderr, flush=True)

    def feed(self, data: bytes) -> None:
        """Bytes that were read; none = the end of input."""
        self._lines.extend(self._reader.feed(data) if data else self._reader.end())
        self._ended = self._ended or not data

    def _read(self, timeout_s: float | None) -> bool:
        """Waits for input; True if some (or its end) was there."""
        watched = [self._wake] if self._ended else [self._wake, self.stream]
        ready = [self.stream] if not self._ended and self.stream.pending() else select.select(watched, [], [], timeout_s)[0]
        if self._wake in ready:
            self._stop = True
        if self.stream not in ready:
            return self._stop
        try:
            self.feed(self.stream.read())
        except OSError as error:
            self._complain(f"the hub: {error.strerror or error}")
            self.failed = True
            self.feed(b"")
        return True

    # The loop.

    def _settle(self) -> bool:
        """Ends waits for IDLE and held EXITs; True when all is over."""
        if self._stop or self.module.exits:
            return True
        busy = self.module.busy()
        if not busy and self._held_exits:
            self._leave()
            return self.module.exits
        if not busy and self._on_idle:
            self._on_idle()
            return False
        return self._ended and not self._lines and not self._waiting and not busy

    def _step(self) -> None:
        if self._lines and not self._waiting:
            return self.module.slots.handle_line(self._lines.popleft())
        if self._ended and not self._lines:
            self.module.abandon_requests()
        if self.clock.mode == "VIRTUAL":  # input first, then time, then wait for input
            wanted = self._waiting or self.module.busy()
            if not self._read(0) and not (wanted and self.clock.advance_to_next()):
                self._read(_IDLE_CHECK_S if wanted or self._ended else None)
            return
        awaited = self._ended or self._held_exits or self._on_idle
        timeout = _IDLE_CHECK_S if awaited else None
        due = self.clock.next() if self.clock.mode == "REAL" else None
        if due is not None:
            wait = max(0.0, (due - self.clock.now()) / 1000)
            timeout = wait if timeout is None else min(timeout, wait)
        self._read(timeout)
        if self.clock.mode == "REAL":
            self.clock.run_due()

    def run(self) -> None:
        signal.set_wakeup_fd(self._waker, warn_on_full_buffer=False)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda number, frame: None)
        self._write(rep("Run", "LIVE"))
        self.module.started()
        while not self._settle():
            self._step()
        self.module.shutdown()


def _options(module: type[Module]) -> argparse.ArgumentParser:
    first = (module.__doc__ or module.name).strip().splitlines()[0]
    parser = argparse.ArgumentParser(description=first)
    add = parser.add_argument
    add("--connect", metavar="ENDPOINT", help="go to a hub on unix:PATH, tcp:HOST:PORT or tls:HOST:PORT")
    add("--name", default=module.name, help="the name to have at the hub (default: %(default)s)")
    add("--token-file", default="", metavar="FILE", help="the token both sides know (mode 600)")
    add("--certificate", default="", metavar="FILE", help="tls: what we show (PEM)")
    add("--key", default="", metavar="FILE", help="tls: its key (PEM)")
    add("--authority", default="", metavar="FILE", help="tls: who signs for the others (PEM)")
    add("--clock", choices=("auto", "real", "virtual"), default="auto",
        help="auto: virtual for lines piped in at once, else real")
    add("--strict", action="store_true", help="end with exit code 1 if any error was seen")
    add("--slots-markdown", action="store_true", help="print the table of slots and end")
    try:
        package = version("galatea")
    except PackageNotFoundError:  # run from the source tree
        package = "not installed"
    add("--version", action="version", version=f"{module.name} {module.version} (Galatea for Python, {package})")
    return parser


def _read_ahead() -> tuple[bytes, bool]:
    """What is on stdin, and whether it has ended, within the time a batch has."""
    data, deadline = b"", time.monotonic() + _BATCH_WAIT_S
    while (left := deadline - time.monotonic()) > 0 and select.select([sys.stdin], [], [], left)[0]:
        more = os.read(sys.stdin.fileno(), 65536)
        if not more:
            return data, True
        data += more
    return data, False


def slots_markdown(module: Module) -> str:
    """The table of slots, as `--slots-markdown` of the other programs prints it."""
    lines = ["| slot | value | access | AutoOutput | at start | meaning |", "| --- | --- | --- | --- | --- | --- |"]
    for slot in module.slots.slots.values():
        cells = [f"`{text}`" if text else "" for text in (slot.name, slot.grammar, slot.initial)]
        name, grammar, initial, meaning = (cell.replace("|", "\\|") for cell in (*cells, slot.help))
        lines.append(f"| {name} | {grammar} | {slot.access} | {'on' if slot.auto_output else 'off'} | {initial} | {meaning} |")
    return "\n".join(lines)


def run_program(kind: type[Module], arguments: list[str] | None = None) -> int:
    """Everything between the command line and the exit code."""
    options = _options(kind).parse_args(arguments)
    name = os.path.basename(sys.argv[0]).removesuffix(".py") or kind.name.lower()
    try:
        ahead, batch = b"", False
        if options.clock == "auto" and kind.virtual_by_default and not options.connect and not sys.stdin.isatty():
            ahead, batch = _read_ahead()
        module = kind(Clock("VIRTUAL" if options.clock == "virtual" or batch else "REAL"))
        stream: _Pipes | _Socket = _Pipes()
        if options.connect:
            if not is_module_name(options.name):
                raise ValueError(f"'{options.name}' is not a module's name")
            credentials = Credentials(options.token_file, options.certificate, options.key, options.authority)
            stream = _Socket(call(Endpoint.read(options.connect), credentials))
            stream.write(str(set_("Name", options.name).addressed("AM")).encode() + b"\n")
        program = Program(module, stream, name)
        if options.slots_markdown:
            print(slots_markdown(module))
            return 0
        module.slots.slots["Error"].auto_output = not options.connect and sys.stdin.isatty()
        if ahead:
            program.feed(ahead)
        if batch:
            program.feed(b"")
        program.run()
    except (OSError, ValueError, Refused, Ended) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    return 1 if program.failed or (options.strict and program.errors) else 0
