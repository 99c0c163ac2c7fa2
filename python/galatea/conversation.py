"""The client's end of the protocol, without input or output: asks, and pairs the answers with the questions."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from galatea.errors import Refused
from galatea.message import LineReader, Message, parse

Heard = Callable[[Message], None]


@dataclass
class Request:
    """A question under way. Once `done`, `answer` is its value, or the Refused it was answered with."""

    message: Message
    members: list[Message]  # of a group, `inq Speak`: what was listed before the answer
    answer: str | Refused | None = None
    on_done: Callable[[], None] = lambda: None

    @property
    def done(self) -> bool:
        return self.answer is not None

    def value(self) -> str:
        if isinstance(self.answer, Refused):
            raise self.answer
        assert self.answer is not None
        return self.answer


class Conversation:
    """What `vm::Client` is in C++. Whoever owns it carries the bytes: `feed` what arrives, send what is given back."""

    def __init__(self, on_message: Heard) -> None:
        self._on_message = on_message
        self._reader = LineReader()
        self._pending: dict[str, Request] = {}
        self._last_tag = 0

    def request(self, message: Message) -> Request:
        """A request to be sent: its message has a tag of its own. Raises Refused if it cannot be written."""
        self._last_tag += 1
        request = Request(replace(message, tag=f"p{self._last_tag}").checked(), [])
        self._pending[request.message.tag] = request
        return request

    def feed(self, data: bytes) -> None:
        for line in self._reader.feed(data):
            try:
                if not isinstance(line, Refused):
                    self._hear(parse(line))
            except Refused:  # no message: nothing for us (a comment, for example)
                continue

    def _hear(self, message: Message) -> None:
        request = self._pending.get(message.tag) if message.command == "rep" and message.tag else None
        if request is None:
            return self._on_message(message)
        asked = request.message.slot or request.message.command
        if message.slot not in (asked, asked + ".error", "Error"):
            request.members.append(message)
            return None
        refused = message.slot != asked
        return self.end(request, Refused.read(message.value) if refused else message.value)

    def end(self, request: Request, answer: str | Refused) -> None:
        self._pending.pop(request.message.tag, None)
        request.answer = answer
        request.on_done()

    def abandon(self, why: Refused) -> None:
        """Nobody will answer any more."""
        for request in list(self._pending.values()):
            self.end(request, why)
