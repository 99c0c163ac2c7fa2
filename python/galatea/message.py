"""Lines of the protocol: taken apart, written, and found in a stream of bytes. No input or output of its own."""
from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from galatea.errors import Refused
from galatea.nearest_word import did_you_mean

MAX_LINE_BYTES = 64 * 1024
MAX_NAME_BYTES = 128
MAX_MODULE_NAME_BYTES = 64
MAX_RECEIVERS = 32
MAX_TAG_BYTES = 32
COMMANDS = ("set", "inq", "prop", "save", "rest", "del", "def", "do", "rep", "tell")
_NEEDS_VALUE = ("set", "prop", "rep")
_TAKES_NO_VALUE = ("inq", "del", "rest")
_SHOWN_BYTES = 40

_NAME = r"[A-Za-z0-9_\-\u0080-\U0010FFFF]+"
_SLOT = re.compile(rf"{_NAME}(?:\.{_NAME})*")
_MODULE = re.compile(_NAME)
_TAG = re.compile(r"[A-Za-z0-9_-]+")
_WORD = re.compile(r"[^ \t]*")


def _bytes(text: str) -> int:
    return len(text.encode())


def cut(text: str, most_bytes: int) -> str:
    """The beginning of a text, at most so many bytes of UTF-8 long."""
    return text.encode()[:most_bytes].decode(errors="ignore")


def printable(text: str) -> str:
    """A text as it can stand in a line: each control character is a blank."""
    return "".join(" " if ord(sign) < 32 or 127 <= ord(sign) < 160 else sign for sign in text)


def is_slot_name(name: str) -> bool:
    return _bytes(name) <= MAX_NAME_BYTES and _SLOT.fullmatch(name) is not None


def is_module_name(name: str) -> bool:
    return _bytes(name) <= MAX_MODULE_NAME_BYTES and _MODULE.fullmatch(name) is not None


def is_address(name: str) -> bool:
    """NAME, or AGENT/NAME: a module of another agent."""
    parts = name.split("/", 1)
    return all(is_module_name(part) for part in parts)


def is_tag(tag: str) -> bool:
    return len(tag) <= MAX_TAG_BYTES and _TAG.fullmatch(tag) is not None


@dataclass(frozen=True)
class Message:
    """One line, `[to @NAME,...] [from @NAME] COMMAND[#TAG] SLOT [REL VALUE]` or `... tell TEXT`.

    `str(message)` writes it exactly as the protocol does. `relation` is "=", "<", "<<", or "" where there is no value.
    """

    command: str
    slot: str = ""
    value: str = ""
    relation: str = ""
    tag: str = ""
    to: tuple[str, ...] = ()
    sender: str = ""

    def __str__(self) -> str:
        words = []
        if self.to:
            words += ["to", ",".join("@" + name for name in self.to)]
        if self.sender:
            words += ["From", "@" + self.sender]
        words.append(self.command + ("#" + self.tag if self.tag else ""))
        if self.slot:
            words.append(self.slot)
        if self.relation:
            words += [self.relation, self.value]
        elif self.value:
            words.append(self.value)
        return " ".join(words)

    def addressed(self, to: str | tuple[str, ...]) -> Message:
        """The same to a module, or to several; "" leaves it as it is."""
        names = (to,) if isinstance(to, str) else tuple(to)
        return replace(self, to=tuple(name.removeprefix("@") for name in names)) if to else self

    def checked(self) -> Message:
        """Itself, if it can be written and read back as it is. Raises Refused (SYNTAX, TOO_LONG, LIMIT) otherwise."""
        line = str(self)
        if any(sign in line for sign in "\r\n\0"):
            raise Refused("SYNTAX", f"found a NUL, CR or LF inside {_quoted(printable(line))}, expected one line of text")
        again = parse(line)
        if again != self:
            raise Refused("SYNTAX", f"{_quoted(line)} would not be read back as it was meant")
        return self


def set_(slot: str, value: str) -> Message:
    return Message("set", slot, value, "=")


def inq(slot: str) -> Message:
    return Message("inq", slot)


def rep(slot: str, value: str) -> Message:
    return Message("rep", slot, value, "=")


def tell(text: str) -> Message:
    return Message("tell", "", text)


def _quoted(text: str) -> str:
    return f"'{text}'" if _bytes(text) <= _SHOWN_BYTES else f"'{cut(text, _SHOWN_BYTES)}...'"


def parse(line: str | bytes) -> Message:
    """Takes a line apart, as loosely as docs/protocol.md says.

    Raises Refused: EMPTY (blank, or a comment), SYNTAX, TOO_LONG, BAD_UTF8, UNKNOWN_COMMAND, LIMIT, with the column.
    """
    raw = line.encode() if isinstance(line, str) else line
    raw = raw.removeprefix(b"\xef\xbb\xbf").removesuffix(b"\n").removesuffix(b"\r")
    if len(raw) > MAX_LINE_BYTES:
        raise Refused("TOO_LONG", f"line of {len(raw)} bytes, expected at most {MAX_LINE_BYTES}")
    try:
        text = raw.decode()
    except UnicodeDecodeError as error:
        raise Refused("BAD_UTF8", "found a byte that is not UTF-8, expected UTF-8 text", error.start + 1) from None
    control = re.search(r"[\0\r\n]", text)
    if control:
        column = _bytes(text[: control.start()]) + 1
        raise Refused("SYNTAX", "found a NUL, CR or LF inside the line, expected text", column)
    return _Parser(text).parse()


class _Parser:
    """Walks one line from left to right; `at` is behind what has been read."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.to: tuple[str, ...] = ()
        self.sender = ""

    def parse(self) -> Message:
        self.skip_blanks()
        if self.at == len(self.text) or self.text.startswith(("#", "//"), self.at):
            raise Refused("EMPTY", "nothing but blanks or a comment")
        self.identifiers()
        command, tag = self.command()
        if command == "tell":
            if self.at == len(self.text):
                raise self.fault(self.at, "the text to tell", syntax_of="the end of the line")
            return Message("tell", "", self.text[self.at :], "", tag, self.to, self.sender)
        slot = self.slot(command)
        if command == "do" and not slot:  # a file: there the word may be a path
            return Message("do", "", self.text[self.at :], "", tag, self.to, self.sender)
        relation, value = self.value(command, slot)
        return Message(command, slot, value, relation, tag, self.to, self.sender)

    def skip_blanks(self) -> None:
        while self.at < len(self.text) and self.text[self.at] in " \t":
            self.at += 1

    def word(self) -> str:
        found = _WORD.match(self.text, self.at)
        assert found is not None
        return found.group()

    def found(self, at: int) -> str:
        if at >= len(self.text):
            return "the end of the line"
        found = _WORD.match(self.text, at)
        assert found is not None
        return _quoted(found.group() or self.text[at])

    def fault(self, at: int, expected: str, code: str = "SYNTAX", syntax_of: str = "") -> Refused:
        found = syntax_of or self.found(at)
        return Refused(code, f"found {found}, expected {expected}", _bytes(self.text[:at]) + 1)

    def identifiers(self) -> None:
        seen = set()
        while (word := self.word().lower()) in ("to", "from"):
            start = self.at
            if word in seen:
                raise self.fault(start, "a command", syntax_of=f"a second '{self.word()}'")
            seen.add(word)
            self.at += len(word)
            self.skip_blanks()
            names = self.names(word == "from")
            if word == "from":
                self.sender = names[0]
            else:
                self.to = names
            self.skip_blanks()

    def names(self, only_one: bool) -> tuple[str, ...]:
        names: list[str] = []
        while True:
            start = self.at
            if self.text.startswith("@", self.at):
                self.at += 1
            elif not names:
                raise self.fault(start, "'@' and a module's name")
            found = re.compile(rf"(?:{_NAME}|/)*").match(self.text, self.at)
            assert found is not None
            if not is_address(found.group()):
                raise self.fault(
                    start, f"a module's name: letters, digits, '_' or '-', at most {MAX_MODULE_NAME_BYTES} bytes")
            names.append(found.group())
            if len(names) > MAX_RECEIVERS:
                raise Refused("LIMIT", f"more than {MAX_RECEIVERS} receivers", _bytes(self.text[:start]) + 1)
            self.at = found.end()
            if only_one or not self.text.startswith(",", self.at):
                break
            self.at += 1
            self.skip_blanks()
        if self.at < len(self.text) and self.text[self.at] not in " \t":
            raise self.fault(self.at, "a blank after the module's name")
        return tuple(names)

    def command(self) -> tuple[str, str]:
        start = self.at
        word = re.compile(r"[A-Za-z0-9]*").match(self.text, start)
        assert word is not None
        end = word.end()
        if word.group() not in COMMANDS or not (end == len(self.text) or self.text[end] in " \t#"):
            if start == len(self.text):
                raise self.fault(start, "a command")
            raise self.fault(start, "one of " + " ".join(COMMANDS) + did_you_mean(word.group(), COMMANDS), "UNKNOWN_COMMAND")
        self.at = end
        tag = ""
        if self.text.startswith("#", self.at):
            tag = self.word()[1:]
            if not is_tag(tag):
                raise self.fault(self.at, f"1 to {MAX_TAG_BYTES} letters, digits, '_' or '-' after '#'",
                                 syntax_of=f"tag {_quoted(tag)}")
            self.at += 1 + len(tag)
        self.skip_blanks()
        return word.group(), tag

    def slot(self, command: str) -> str:
        start = self.at
        if command == "do" and not is_slot_name(self.word()):
            if start == len(self.text):
                raise self.fault(start, "a macro or a file")
            return ""
        found = re.compile(rf"(?:{_NAME}|\.)*").match(self.text, start)
        assert found is not None
        if not is_slot_name(found.group()):
            raise self.fault(
                start, f"a slot name: letters, digits, '_' '-' and single dots, at most {MAX_NAME_BYTES} bytes")
        self.at = found.end()
        return found.group()

    def value(self, command: str, slot: str) -> tuple[str, str]:
        after_slot = self.at
        self.skip_blanks()
        if command == "inq" and self.at > after_slot:  # the original answers whatever comes after the slot's name
            return "", ""
        if self.at == len(self.text):
            if command in _NEEDS_VALUE:
                raise self.fault(self.at, f"'= VALUE' after {_quoted(slot)}")
            return "", ""
        relation = next((sign for sign in ("=", "<<", "<") if self.text.startswith(sign, self.at)), "")
        if not relation:
            raise self.fault(self.at, "the slot's name to end there" if self.at == after_slot
                             else "the end of the line" if command in _TAKES_NO_VALUE else "'=', '<' or '<<'")
        if command in _TAKES_NO_VALUE:
            raise self.fault(self.at, f"the end of the line: '{command}' takes no value")
        self.at += len(relation)
        self.skip_blanks()
        return relation, self.text[self.at :]


def tag_of(line: str) -> str:
    """The request tag of a line that is no message, so that whoever asked hears why; "" if none can be read."""
    line = line.removeprefix("\ufeff")
    for hit in re.finditer(r"(?:(?<=[ \t])|^)([A-Za-z0-9]*)#([^ \t\r\n]*)", line):
        before = line[: hit.start()].strip(" \t")
        stands_first = hit[1] and re.fullmatch(r"(?i:(?:to|from)(?:[ \t]+[^ \t]+)?)?", before) is not None
        if (hit[1] in COMMANDS or stands_first) and is_tag(hit[2]):
            return hit[2]
    return ""


class LineReader:
    """Splits a stream of bytes into lines. An overlong one comes once, as what was refused; the next is read well."""

    def __init__(self) -> None:
        self._partial = b""
        self._skipping = False

    def feed(self, data: bytes) -> Iterator[bytes | Refused]:
        *lines, self._partial = (self._partial + data).split(b"\n")
        for line in lines:
            if self._skipping:
                self._skipping = False
            elif len(line.removesuffix(b"\r")) > MAX_LINE_BYTES:
                yield self._too_long()
            else:
                yield line.removesuffix(b"\r")
        if len(self._partial) > MAX_LINE_BYTES + 1:
            if not self._skipping:
                yield self._too_long()
            self._skipping = True
            self._partial = b""

    def end(self) -> Iterator[bytes | Refused]:
        """A last line without its LF counts as a line."""
        if self._partial:
            yield from self.feed(b"\n")

    @staticmethod
    def _too_long() -> Refused:
        return Refused("TOO_LONG", f"line of more than {MAX_LINE_BYTES} bytes, the rest of it is skipped")
