"""A client of the hub, or of one program alone: `Client` waits, `AsyncClient` (galatea.aio) does the same in asyncio."""
from __future__ import annotations

import os
import select
import socket
import ssl
import subprocess
import time
from collections import deque
from collections.abc import Iterator, Sequence
from types import TracebackType

from galatea.conversation import Conversation, Request
from galatea.endpoint import Credentials, Endpoint, call
from galatea.errors import Ended, Refused
from galatea.message import Message, inq, parse, set_

TIMEOUT_S = 120.0  # the hub itself answers TIMEOUT for a module that is silent for so long


class _Stream:
    """Bytes both ways: a socket, or the pipes of a child. Reads while it writes, so that two full pipes cannot stop both."""

    def __init__(self, read_fd: int, write_fd: int, plain: socket.socket | None = None) -> None:
        self._read_fd = read_fd
        self._write_fd = write_fd
        self._plain = plain
        if plain:
            plain.setblocking(False)
        else:
            os.set_blocking(write_fd, False)

    def read(self, timeout_s: float | None) -> bytes | None:
        """What has arrived; b"" at the end, None if nothing came within the time."""
        held = isinstance(self._plain, ssl.SSLSocket) and self._plain.pending() > 0
        if not held and not select.select([self._read_fd], [], [], timeout_s)[0]:
            return None
        try:
            return self._plain.recv(65536) if self._plain else os.read(self._read_fd, 65536)
        except (ssl.SSLWantReadError, BlockingIOError):
            return None
        except OSError:  # reset, or cut off within TLS: it has gone
            return b""

    def write(self, data: bytes) -> Iterator[bytes]:
        """Writes all; yields what arrives meanwhile."""
        while data:
            readable, writable, _ = select.select([self._read_fd], [self._write_fd], [])
            if writable:
                try:
                    done = self._plain.send(data) if self._plain else os.write(self._write_fd, data)
                    data = data[done:]
                    continue
                except (ssl.SSLWantReadError, ssl.SSLWantWriteError, BlockingIOError):
                    pass
                except OSError as error:
                    raise Ended(f"the other side has gone: {error.strerror}") from None
            if readable:
                more = self.read(0)
                if more == b"":
                    raise Ended("the other side has gone")
                yield more or b""


class Client:
    """Speaks to a hub or a program and hears it. A context manager; one thread at a time.

        with Client.connect("unix:/tmp/hub", name="ME") as hub:
            hub.set("Speak", "Hello.", to="AM-MCL")

    Requests wait for their answer and raise Refused where it is a refusal, TimeoutError, or Ended. What arrives
    meanwhile is kept for `messages()`.
    """

    def __init__(self, stream: _Stream, process: subprocess.Popen[bytes] | None = None,
                 plain: socket.socket | None = None) -> None:
        self._stream = stream
        self._process = process
        self._plain = plain
        self._heard: deque[Message] = deque()
        self._conversation = Conversation(self._heard.append)
        self._ended = False

    @staticmethod
    def connect(endpoint: str, *, name: str = "", token_file: str = "", certificate: str = "", key: str = "",
                authority: str = "") -> Client:
        """To `unix:PATH`, `tcp:HOST:PORT` or `tls:HOST:PORT`. With a name, `to @NAME` reaches you from then on."""
        plain = call(Endpoint.read(endpoint), Credentials(token_file, certificate, key, authority))
        client = Client(_Stream(plain.fileno(), plain.fileno(), plain), plain=plain)
        if name:
            try:
                client.set("Name", name, to="AM")
            except BaseException:
                client.close()
                raise
        return client

    @staticmethod
    def start(command: Sequence[str], *, cwd: str | None = None, env: dict[str, str] | None = None) -> Client:
        """Starts a program and speaks to it over its stdin and stdout; its stderr is ours."""
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=cwd, env=env, bufsize=0)
        assert process.stdin and process.stdout
        return Client(_Stream(process.stdout.fileno(), process.stdin.fileno()), process)

    def send(self, message: Message | str, to: str | tuple[str, ...] = "") -> None:
        """Says something and does not wait for an answer. A str is a whole line."""
        whole = parse(message) if isinstance(message, str) else message
        self._write(whole.addressed(to).checked())

    def request(self, message: Message, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        """Asks, waits, and returns the value of the answer."""
        return self._ask(message, to, timeout_s).value()

    def set(self, slot: str, value: object, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        return self.request(set_(slot, str(value)), to, timeout_s)

    def inq(self, slot: str, to: str = "", timeout_s: float = TIMEOUT_S) -> str:
        return self.request(inq(slot), to, timeout_s)

    def inq_group(self, slot: str, to: str = "", timeout_s: float = TIMEOUT_S) -> dict[str, str]:
        """The members of a group (`inq Speak`) with their values."""
        asked = self._ask(inq(slot), to, timeout_s)
        asked.value()
        return {member.slot: member.value for member in asked.members}

    def auto_output(self, slot: str, to: str = "", on: bool = True) -> None:
        """Whether changes of a slot are reported unasked."""
        self.request(Message("prop", slot, "AutoOutput" if on else "NoAutoOutput", "="), to)

    def subscribe(self, *modules: str) -> None:
        """Hear what these modules report to nobody in particular: names, "*" for all; none = nobody."""
        self.set("Subscribe", " ".join(name.removeprefix("@") for name in modules) or "NONE", to="AM")

    def messages(self, timeout_s: float | None = None) -> Iterator[Message]:
        """What arrives that is no answer to a request: until nothing came for `timeout_s` (None: for ever) or the end."""
        while True:
            while self._heard:
                yield self._heard.popleft()
            if self._ended or not self._read(timeout_s):
                if not self._heard:
                    return

    def wait_for(self, slot: str, value: str | None = None, sender: str = "", timeout_s: float = TIMEOUT_S) -> Message:
        """The next report of a slot (with that value, from that module); what comes before it is dropped."""
        deadline = time.monotonic() + timeout_s
        while True:
            for message in self.messages(max(0.0, deadline - time.monotonic())):
                fits = message.command == "rep" and message.slot == slot and value in (None, message.value)
                if fits and sender.removeprefix("@") in ("", message.sender):
                    return message
                if time.monotonic() > deadline:
                    break
            if self._ended:
                raise Ended(f"the other side ended before it reported {slot}")
            if time.monotonic() >= deadline:
                raise TimeoutError(f"no report of {slot} within {timeout_s} s")

    def finish(self) -> list[Message]:
        """Says no more, and returns what still comes until the other side ends too."""
        self._say_no_more()
        return list(self.messages())

    def close(self) -> None:
        """Lets go; a program that was started ends once it has done what it was told."""
        if self._process:
            self._say_no_more()
            for _ in self.messages():  # a pipe that nobody reads would hold it
                pass
            self._process.wait()
            if self._process.stdout:
                self._process.stdout.close()
        if self._plain:
            self._plain.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def _say_no_more(self) -> None:
        if self._process and self._process.stdin:
            self._process.stdin.close()
        elif self._plain and not isinstance(self._plain, ssl.SSLSocket):
            try:
                self._plain.shutdown(socket.SHUT_WR)
            except OSError:  # it has gone already
                pass

    def _ask(self, message: Message, to: str, timeout_s: float) -> Request:
        asked = self._conversation.request(message.addressed(to))
        self._write(asked.message)
        deadline = time.monotonic() + timeout_s
        while not asked.done:
            left = deadline - time.monotonic()
            if left <= 0:
                self._conversation.end(asked, Refused("TIMEOUT", "no answer"))
                raise TimeoutError(f"no answer to '{asked.message}' within {timeout_s} s")
            if not self._read(left) and self._ended:
                raise Ended(f"the other side ended before it answered '{asked.message}'")
        return asked

    def _write(self, message: Message) -> None:
        for data in self._stream.write(str(message).encode() + b"\n"):
            self._conversation.feed(data)

    def _read(self, timeout_s: float | None) -> bool:
        data = self._stream.read(timeout_s)
        if data is None:
            return False
        if data == b"":
            self._ended = True
            return False
        self._conversation.feed(data)
        return True
