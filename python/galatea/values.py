"""Values: what a slot accepts, quoted words, phonemes, start times, milliseconds; as docs/protocol.md, Values."""
from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime

from galatea.errors import Refused
from galatea.message import cut, printable
from galatea.nearest_word import did_you_mean

_BLANKS = " \t"
_MAX_NUMBER = 1e12
_MAX_PHONEMES = 8192
_MAX_PHONEME_MS = 60_000


# Words and numbers.

def quote(word: str) -> str:
    """A word as a `<word>` of a value: in "..." with JSON escapes if it is empty, holds a blank, or begins with a quote."""
    plain = word != "" and not word.startswith('"') and not re.search(r"[\s\0-\x1f\x7f]", word)
    return word if plain else json.dumps(word, ensure_ascii=False)


def read_quoted(text: str, at: int = 0) -> tuple[str, int] | None:
    """The content of the "quoted string" that begins at `at`, and the place behind it; None if it is none."""
    end = re.compile(r'"(?:[^"\\]|\\["\\/bfnrt]|\\u[0-9a-fA-F]{4})*"').match(text, at)
    if end is None:
        return None
    content: str = json.loads(end.group(), strict=False)
    if any("\ud800" <= sign <= "\udfff" for sign in content):  # half of a pair
        return None
    return content, end.end()


def words(value: str) -> list[str]:
    """A value's words, "quoted strings" without their quotes."""
    found, at = [], 0
    while (at := _skip_blanks(value, at)) < len(value):
        quoted = read_quoted(value, at) if value[at] == '"' else None
        end = quoted[1] if quoted else _word_end(value, at)
        found.append(quoted[0] if quoted else value[at:end])
        at = end
    return found


def read_number(word: str) -> float | None:
    """A decimal number within +-1e12; None for anything else (also nan, inf, 0x10)."""
    if not re.fullmatch(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", word, re.ASCII):
        return None
    number = float(word)
    return number if math.isfinite(number) and abs(number) <= _MAX_NUMBER else None


def format_number(number: float) -> str:
    """A number as short as it can be read back."""
    return str(int(number)) if float(number).is_integer() else repr(float(number))


def format_ms(ms: float) -> str:
    """Milliseconds with at most three decimals, as on the wire."""
    return f"{ms:.3f}".rstrip("0").rstrip(".") if round(ms, 3) != 0 else "0"


# Phonemes.

@dataclass(frozen=True)
class Phoneme:
    name: str
    ms: int


def parse_phonemes(text: str) -> list[Phoneme]:
    """Reads `a[80] k[60]`, `a [80] k [60]`, `a 80 k 60`, mixed. Raises Refused (BAD_VALUE, LIMIT)."""
    phonemes: list[Phoneme] = []
    at = 0
    item = re.compile(r"(?P<name>[^\[\] \t]+)[ \t]*(?:\[[ \t]*(?P<inside>[0-9.]+)[ \t]*\]|(?P<plain>[0-9.]+)(?=[ \t]|$))")
    while (at := _skip_blanks(text, at)) < len(text):
        if text[at:].rstrip(_BLANKS) == "phoneme_end":  # ends a list in the original's socket mode
            break
        found = item.match(text, at)
        ms = read_number(found["inside"] or found["plain"]) if found else None
        if found is None or ms is None or ms > _MAX_PHONEME_MS:
            raise Refused("BAD_VALUE", f"found '{cut(text[at:], 40)}', expected a phoneme's name and its duration in ms, "
                          f"0 to {_MAX_PHONEME_MS}", len(text[:at].encode()) + 1)
        if len(phonemes) == _MAX_PHONEMES:
            raise Refused("LIMIT", f"more than {_MAX_PHONEMES} phonemes", len(text[:at].encode()) + 1)
        phonemes.append(Phoneme(found["name"], math.floor(ms + 0.5)))
        at = found.end()
    return phonemes


def format_phonemes(phonemes: Iterable[Phoneme], form: str = "voice") -> str:
    """`a[80] k[60]` ("voice"), `a [80] k [60] ` ("face"), or `a 80 k 60` ("plain", as LipSync.pho takes it)."""
    if form == "face":
        return "".join(f"{phoneme.name} [{phoneme.ms}] " for phoneme in phonemes)
    one = "{}[{}]" if form == "voice" else "{} {}"
    return " ".join(one.format(phoneme.name, phoneme.ms) for phoneme in phonemes)


# Start times.

@dataclass(frozen=True)
class StartTime:
    """`kind` is "now", "after" (ms from receipt), "at" (ms on the receiver's clock) or "wall" (ms since midnight)."""

    kind: str
    ms: float = 0.0

    def __str__(self) -> str:
        if self.kind == "now":
            return "NOW"
        if self.kind != "wall":
            return ("+" if self.kind == "after" else "@") + format_ms(self.ms)
        whole = int(self.ms)
        return f"{whole // 3_600_000:02}:{whole // 60_000 % 60:02}:{whole // 1000 % 60:02}.{whole % 1000:03}"

    def resolve(self, now_ms: float, wall_ms: float | None = None) -> float:
        """The instant on the clock that reads `now_ms`; `wall_ms` is the local wall time at that moment."""
        if self.kind != "wall":
            return {"now": now_ms, "after": now_ms + self.ms}.get(self.kind, self.ms)
        day, minute = 86_400_000.0, 60_000.0
        delay = self.ms - (_wall_ms() if wall_ms is None else wall_ms)
        if delay < -day / 2:
            delay += day  # just after midnight, seen from just before it
        if delay < 0:
            delay = 0.0 if delay >= -minute else delay + day
        return now_ms + delay


def _wall_ms() -> float:
    now = datetime.now()
    return (now - now.replace(hour=0, minute=0, second=0, microsecond=0)).total_seconds() * 1000


def parse_start_time(text: str) -> StartTime:
    """Reads `NOW`, `+MS`, `@MS`, `+HH:MM:SS.mmm`, `HH:MM:SS.mmm`. Raises Refused (BAD_VALUE)."""
    whole = text.strip(_BLANKS)
    if whole.upper() == "NOW":
        return StartTime("now")
    sign, rest = (whole[0], whole[1:].strip(_BLANKS)) if whole[:1] in ("+", "@") else ("", whole)
    clock = re.fullmatch(r"(\d\d):(\d\d):(\d\d)(?:\.(\d{1,6}))?", rest, re.ASCII)
    if clock and sign != "@" and int(clock[1]) < 24 and int(clock[2]) < 60 and int(clock[3]) < 60:
        fraction_ms = int((clock[4] or "").ljust(6, "0")) / 1000
        ms = (int(clock[1]) * 3600 + int(clock[2]) * 60 + int(clock[3])) * 1000 + fraction_ms
        return StartTime("after" if sign else "wall", ms)
    number = read_number(rest) if sign and not rest.startswith(("+", "-")) else None
    if number is None:
        raise Refused("BAD_VALUE", f"found '{whole}', expected NOW, +MS, @MS, +HH:MM:SS.mmm or HH:MM:SS.mmm")
    if sign == "+" and number > 86_400_000:
        raise Refused("BAD_VALUE", f"found '{whole}', expected at most 24 hours")
    return StartTime("after" if sign == "+" else "at", round(number, 3))


# Grammars.

@dataclass
class Item:
    """A part of a value that fits: a word as the grammar writes it, a number, the content of a quoted string, ..."""

    text: str
    kind: str
    number: float = 0.0

    @property
    def typed(self) -> str | int | float | StartTime:
        """An int for <int>, a float for <number> and <ms>, a StartTime for <time>, else the text."""
        if self.kind == "time":
            return parse_start_time(self.text)
        return int(self.number) if self.kind == "int" else self.number if self.kind in ("number", "ms") else self.text


@dataclass
class _Node:
    kind: str  # sequence, alternatives, optional, repeat, literal, or the name of a placeholder
    literal: str = ""
    low: float = -_MAX_NUMBER
    high: float = _MAX_NUMBER
    children: list[_Node] = field(default_factory=list)

    def literals(self) -> list[str]:
        return ([self.literal] if self.kind == "literal" else []) + [w for c in reversed(self.children) for w in c.literals()]


_PLACEHOLDERS = ("number", "int", "ms", "time", "word", "text", "markup", "file")
_REST = ("text", "markup")
_MAX_GRAMMAR_BYTES = 4096
_MAX_DEPTH = 32


def _skip_blanks(text: str, at: int) -> int:
    while at < len(text) and text[at] in _BLANKS:
        at += 1
    return at


def _word_end(text: str, at: int) -> int:
    while at < len(text) and text[at] not in _BLANKS:
        at += 1
    return at


class ValueGrammar:
    """What a slot accepts, written beside it: `ON [ <ms> ] | OFF`, `<number 0..200>`, `<word> <int 1..>`, `<text>`."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.root = _GrammarReader(text).read()
        self.has_file = "<file>" in text or "<markup>" in text
        self.has_text = "<text>" in text or "<markup>" in text

    def match(self, value: str) -> list[Item]:
        """The value's parts. Raises Refused: BAD_VALUE with the column, LIMIT where finding out would take too long."""
        matcher = _Matcher(value)
        try:
            if matcher.match(self.root, 0, matcher.is_end):
                return matcher.items
        except RecursionError:  # a sequence of more parts than Python can hold in each other
            matcher.exhausted = True
        if matcher.exhausted:
            raise Refused("LIMIT", f"the value takes too many steps to be compared with {self.text}")
        at = _skip_blanks(value, matcher.farthest)
        word = value[at : _word_end(value, at)]
        found = f"'{printable(cut(word, 40))}'" if word else "the end of the value"
        guess = did_you_mean(word, self.root.literals()) if word else ""
        raise Refused("BAD_VALUE", f"found {found}, expected {self.text}{guess}", len(value[:at].encode()) + 1)


class _GrammarReader:
    """Reads the grammar's own text. Raises Refused (BAD_VALUE)."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.depth = 0

    def read(self) -> _Node:
        if len(self.text.encode()) > _MAX_GRAMMAR_BYTES:
            raise Refused("BAD_VALUE", f"a value grammar of more than {_MAX_GRAMMAR_BYTES} bytes")
        bad = re.search(r"[;\0-\x1f\x7f]", self.text)
        if bad:
            raise self.fault("words without ';'", bad.start())
        root = self.alternatives()
        if self.at != len(self.text):
            raise self.fault("the end of the grammar")
        return root

    def fault(self, expected: str, at: int | None = None) -> Refused:
        at = self.at if at is None else at
        found = f"'{cut(self.text[at:], 40)}'" if at < len(self.text) else "the end"
        return Refused("BAD_VALUE", f"value grammar: found {found}, expected {expected}", len(self.text[:at].encode()) + 1)

    def peek(self) -> str:
        self.at = _skip_blanks(self.text, self.at)
        return self.text[self.at : self.at + 1]

    def alternatives(self) -> _Node:
        children = [self.sequence()]
        while self.peek() == "|":
            self.at += 1
            children.append(self.sequence())
        return children[0] if len(children) == 1 else _Node("alternatives", children=children)

    def sequence(self) -> _Node:
        node = _Node("sequence")
        while self.peek() not in ("", "|", ")", "]"):
            term = self.term()
            if self.text.startswith("...", self.at):
                self.at += 3
                term = _Node("repeat", children=[term])
            node.children.append(term)
        if not node.children:
            raise self.fault("a word, a placeholder or a bracket")
        return node

    def term(self) -> _Node:
        sign = self.peek()
        if sign in "[(":
            self.depth += 1
            if self.depth > _MAX_DEPTH:
                raise self.fault(f"at most {_MAX_DEPTH} brackets in each other")
            self.at += 1
            inner = self.alternatives()
            closing = "]" if sign == "[" else ")"
            if self.peek() != closing:
                raise self.fault(f"'{closing}'")
            self.at += 1
            self.depth -= 1
            return inner if sign == "(" else _Node("optional", children=[inner])
        if sign == "<":
            return self.placeholder()
        word = re.compile(r"[^ \t|()\[\]<]*").match(self.text, self.at)
        assert word is not None
        literal = word.group()
        if len(literal) > 3:
            literal = literal.removesuffix("...")
        self.at += len(literal)
        return _Node("literal", literal)

    def placeholder(self) -> _Node:
        found = re.compile(r"<(\w+)(?: ([0-9.eE+-]*?)\.\.([0-9.eE+-]*))?>").match(self.text, self.at)
        if found is None or found[1] not in _PLACEHOLDERS:
            raise self.fault(", ".join(f"<{name}>" for name in _PLACEHOLDERS) + ", or with a range, <int LOW..HIGH>")
        node = _Node(found[1])
        if found[1] == "ms":
            node.low, node.high = 0, 86_400_000
        for bound, text in (("low", found[2]), ("high", found[3])):
            if text:
                number = read_number(text)
                if number is None:
                    raise self.fault("a range of numbers, LOW..HIGH")
                setattr(node, bound, number)
        self.at = found.end()
        return node


_Next = Callable[[int], bool]


class _Matcher:
    """Matches by continuation: a part calls `next_` with the place behind it, and tries its next possibility if that fails."""

    MAX_STEPS = 200_000

    def __init__(self, value: str) -> None:
        self.value = value
        self.items: list[Item] = []
        self.farthest = 0
        self.steps = 0
        self.exhausted = False

    def is_end(self, at: int) -> bool:
        at = _skip_blanks(self.value, at)
        self.farthest = max(self.farthest, at)
        return at == len(self.value)

    def match(self, node: _Node, at: int, next_: _Next) -> bool:
        self.steps += 1
        self.exhausted = self.exhausted or self.steps > self.MAX_STEPS
        if self.exhausted:
            return False
        at = _skip_blanks(self.value, at)
        if node.kind == "sequence":
            return self.match_sequence(node.children, 0, at, next_)
        if node.kind == "alternatives":
            return any(self.attempt(child, at, next_) for child in node.children)
        if node.kind == "optional":
            return self.attempt(node.children[0], at, next_) or next_(at)
        if node.kind == "repeat":
            return self.match_repeat(node.children[0], at, next_)
        return self.match_part(node, at, next_)

    def attempt(self, node: _Node, at: int, next_: _Next) -> bool:
        kept = len(self.items)
        if self.match(node, at, next_):
            return True
        del self.items[kept:]
        return False

    def match_sequence(self, nodes: list[_Node], index: int, at: int, next_: _Next) -> bool:
        if index == len(nodes):
            return next_(at)
        return self.match(nodes[index], at, lambda end: self.match_sequence(nodes, index + 1, end, next_))

    def match_repeat(self, node: _Node, at: int, next_: _Next) -> bool:
        """Greedy and without going back into earlier rounds, so that a long list takes no deep recursion."""
        kept = len(self.items)
        behind: list[int] = []
        while True:
            before, ends = len(self.items), list[int]()
            fits = self.match(node, at, lambda end, ends=ends: ends.append(end) is None)  # type: ignore[misc]
            if not fits or ends[-1] == at:
                del self.items[before:]
                break
            at = ends[-1]
            behind.append(at)
        if behind and next_(at):
            return True
        del self.items[kept:]
        return False

    def take(self, item: Item, end: int, next_: _Next) -> bool:
        self.items.append(item)
        self.farthest = max(self.farthest, _skip_blanks(self.value, end))
        if next_(end):
            return True
        self.items.pop()
        return False

    def match_part(self, node: _Node, at: int, next_: _Next) -> bool:
        value, kind = self.value, node.kind
        if kind in _REST:
            return self.take(Item(value[at:], kind), len(value), next_)
        if at == len(value):
            return False
        if kind == "time":
            one = _word_end(value, at)
            two = _word_end(value, _skip_blanks(value, one))  # "+ 500" is one time in two words
            return any(self.match_time(at, end, next_) for end in (two, one))
        if kind == "file":
            name = value[at:].rstrip(_BLANKS)
            quoted = read_quoted(name) if name.startswith('"') else (name, len(name))
            fits = quoted is not None and quoted[0] != "" and quoted[1] == len(name)
            return quoted is not None and fits and self.take(Item(quoted[0], kind), len(value), next_)
        if kind == "word" and value[at] == '"':
            quoted = read_quoted(value, at)
            return quoted is not None and self.take(Item(quoted[0], kind), quoted[1], next_)
        end = _word_end(value, at)
        word = value[at:end]
        if kind == "word":
            return self.take(Item(word, kind), end, next_)
        if kind == "literal":
            same = word.encode().lower() == node.literal.encode().lower()
            return same and self.take(Item(node.literal, kind), end, next_)
        number = read_number(word)
        if number is None or not node.low <= number <= node.high or (kind == "int" and not number.is_integer()):
            return False
        return self.take(Item(word, kind, number), end, next_)

    def match_time(self, at: int, end: int, next_: _Next) -> bool:
        try:
            start = parse_start_time(self.value[at:end])
        except Refused:
            return False
        return self.take(Item(str(start), "time"), end, next_)
