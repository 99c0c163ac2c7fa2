"""The slots of a module, and everything that can be said to them. No input or output of its own."""
from __future__ import annotations

import os
import stat
import traceback
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from galatea.errors import Refused
from galatea.message import MAX_LINE_BYTES, Message, cut, is_slot_name, parse, printable, rep, set_, tag_of
from galatea.nearest_word import did_you_mean
from galatea.values import Item, ValueGrammar

MAX_FILE_BYTES = 4 << 20
MAX_MACRO_LINES = 1024
MAX_MACRO_DEPTH = 16
MAX_DO_LINES = 16 * 1024
MAX_USER_SLOTS = 1024
MAX_SAVED_SETS = 256
MAX_KEPT_BYTES = 16 << 20
READ_ONLY, READ_WRITE, WRITE_ONLY = "ReadOnly", "ReadWrite", "WriteOnly"

Answer = Callable[[str | Refused], None]


@dataclass
class SetValue:
    """The value of a `set` that fits the slot's grammar: as it came, and taken apart."""

    text: str
    items: list[Item]
    slot: str = ""


@dataclass
class Slot:
    """One slot, declared. `on_set` gives the value to store; with `on_set_later` it is answered when `answer` is called."""

    name: str
    grammar: str
    access: str = READ_WRITE
    initial: str = ""
    auto_output: bool = False
    help: str = ""
    on_set: Callable[[SetValue], str] | None = None
    on_set_later: Callable[[SetValue, Answer], None] | None = None
    on_inq: Callable[[], str] | None = None
    saved: bool = True
    user_made: bool = False
    value: str = field(init=False)
    parsed: ValueGrammar = field(init=False)

    def __post_init__(self) -> None:
        self.parsed = ValueGrammar(self.grammar)
        self.value = self.initial

    def explained(self) -> str:
        return self.help + (" (read only)" if self.access == READ_ONLY else f" Value: {self.grammar}")

    def attributes(self) -> str:
        default = f" default {self.initial}" if self.initial else ""
        return f"{'AutoOutput' if self.auto_output else 'NoAutoOutput'} {self.access}{default}"

    def current(self) -> str:
        return self.on_inq() if self.on_inq else self.value


def read_file(path: str) -> str:
    """The text of a regular file of at most 4 MiB. Raises Refused."""
    try:
        info = os.stat(path)
        if not stat.S_ISREG(info.st_mode):
            raise Refused("ACCESS", f"'{path}' is not a regular file")
        if info.st_size > MAX_FILE_BYTES:
            raise Refused("TOO_LONG", f"file '{path}' holds {info.st_size} bytes, expected at most {MAX_FILE_BYTES}")
        with open(path, "rb") as file:
            return file.read(MAX_FILE_BYTES).decode()
    except UnicodeDecodeError:
        raise Refused("BAD_UTF8", f"file '{path}' is not UTF-8") from None
    except OSError as error:
        raise Refused("UNAVAILABLE", f"cannot read '{path}': {error.strerror}") from None


def append_file(path: str, text: str) -> None:
    """Appends to a regular file, which may be new. Raises Refused."""
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise Refused("ACCESS", f"'{path}' is not a regular file")
        with open(path, "a", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise Refused("UNAVAILABLE", f"cannot write '{path}': {error.strerror}") from None


class SlotMachine:
    """What `vm::SlotMachine` is in C++ (vm_protocol/core/slot_machine.h), for one peer.

    `output` is given what is to be said, `on_error` every refusal with its line, `on_heard` what others `rep` and
    `tell` to this module.
    """

    def __init__(self, module_name: str, output: Callable[[Message], None],
                 on_error: Callable[[str, Refused], None] | None = None,
                 on_heard: Callable[[Message], None] | None = None) -> None:
        self.module_name = module_name
        self._output = output
        self._on_error = on_error or (lambda line, error: None)
        self._on_heard = on_heard or (lambda message: None)
        self.slots: dict[str, Slot] = {}
        self._saved: dict[str, dict[str, str]] = {}
        self._macros: dict[str, list[str]] = {}
        self._depth = 0
        self._lines_run = 0
        self.declare(Slot("Slots", "<text>", READ_ONLY, on_inq=lambda: " ".join(self.slots), help=(
            "The names of all slots of this module, separated by blanks. `inq NAME.help` explains one, "
            "`inq NAME.prop` tells its attributes.")))
        self.declare(Slot("Slots.files", "<text>", READ_ONLY, on_inq=self._slots_of_files, help=(
            "The slots that take file names, with their grammars: NAME GRAMMAR; NAME GRAMMAR; ... A hub asks for it, "
            "to know who may set them.")))
        self.declare(Slot("Error", "<text>", READ_ONLY, help=(
            "The last error, as CODE and text. `prop Error = AutoOutput` has every refusal reported to you as "
            "`rep SLOT.error = CODE text`, also for lines without a tag.")))

    def _slots_of_files(self) -> str:
        return "; ".join(f"{slot.name} {slot.grammar}" for slot in self.slots.values()
                         if slot.access != READ_ONLY and slot.parsed.has_file)

    def declare(self, slot: Slot) -> Slot:
        if not is_slot_name(slot.name) or slot.name in self.slots:
            raise ValueError(f"'{slot.name}': expected a new slot's name")
        self.slots[slot.name] = slot
        return slot

    # What comes in.

    def handle_line(self, line: str | bytes | Refused) -> None:
        """Deals with one line: parses, checks, acts, answers. Never raises because of bad input."""
        shown = "" if isinstance(line, Refused) else printable(_decoded(line))
        try:
            if isinstance(line, Refused):
                raise line
            message = parse(line)
        except Refused as refusal:
            if refusal.code == "EMPTY":
                return
            self._on_error(cut(shown, 200), refusal)
            tag = tag_of(shown)
            if tag:
                self._answer_refused("Error", tag, refusal)
            else:
                self._report_unread("Error", refusal)
            return
        self.handle(message)

    def handle(self, message: Message) -> None:
        heard = message.command in ("rep", "tell")
        try:
            (self._on_heard if heard else getattr(self, "_do_" + message.command))(message)
        except Refused as refusal:
            self.refuse(message, refusal)
        except Exception as error:  # our own fault: it is that request's error, everything else goes on
            traceback.print_exception(error)
            self.refuse(message, Refused("INTERNAL", f"{type(error).__name__}: {error}"))

    def refuse(self, message: Message, refusal: Refused) -> None:
        self._on_error(cut(printable(str(message)), 200), refusal)
        place = (message.slot or message.command) + ".error"
        if message.tag:
            self._answer_refused(place, message.tag, refusal)
        else:
            self._report_unread(place, refusal)

    def _answer_refused(self, place: str, tag: str, refusal: Refused) -> None:
        self.slots["Error"].value = str(refusal)
        self.say(replace(rep(place, str(refusal)), tag=tag))

    def _report_unread(self, place: str, refusal: Refused) -> None:
        self.slots["Error"].value = str(refusal)
        if self.slots["Error"].auto_output:
            self.say(rep(place, str(refusal)))

    def _answer(self, message: Message, value: str) -> None:
        if message.tag:
            self.say(replace(rep(message.slot or message.command, value), tag=message.tag))

    def _find(self, name: str) -> Slot:
        if name not in self.slots:
            guess = did_you_mean(name, self.slots) or " (inq Slots lists them)"
            raise Refused("UNKNOWN_SLOT", f"module {self.module_name} has no slot '{name}'{guess}")
        return self.slots[name]

    # What goes out.

    def say(self, message: Message) -> None:
        """Says a message, made fit to be one line."""
        value = message.value
        if any(sign in value for sign in "\r\n\0"):
            value = printable(value)
        value = value.lstrip(" \t")
        room = MAX_LINE_BYTES - len(str(replace(message, value="")).encode()) - 136  # behind "From @NAME " too
        self._output(replace(message, value=cut(value, room) if len(value.encode()) > room else value))

    def report(self, name: str, value: str) -> None:
        """Stores a slot's new value and reports it, if the slot has AutoOutput."""
        slot = self.slots[name]
        slot.value = value
        if slot.auto_output:
            self.say(rep(name, value))

    # The commands.

    def _do_set(self, message: Message) -> None:
        slot = self._find(message.slot)
        if slot.access == READ_ONLY:
            raise Refused("ACCESS", f"slot '{message.slot}' can only be asked (inq)")
        text = self._resolved(message, slot.value)
        if not slot.parsed.has_text:
            text = text.rstrip(" \t")
        value = SetValue(text, slot.parsed.match(text), slot.name)
        if slot.on_set_later:
            slot.on_set_later(value, lambda result: self._answer_later(message, result))
            return
        stored = slot.on_set(value) if slot.on_set else text
        if slot.user_made:
            self._keep(len(stored) - len(slot.value))
        if message.slot in self.slots:  # the action may have deleted it
            self.report(message.slot, stored)
        self._answer(message, stored)

    def _answer_later(self, message: Message, result: str | Refused) -> None:
        if isinstance(result, Refused):
            self.refuse(message, result)
        else:
            self._answer(message, result)

    @staticmethod
    def _resolved(message: Message, present: str) -> str:
        if message.relation == "<":
            joined = " ".join(line for line in read_file(message.value).splitlines() if line)
            if len(joined.encode()) > MAX_LINE_BYTES:
                raise Refused("TOO_LONG", f"file '{message.value}' holds more than {MAX_LINE_BYTES} bytes")
            return joined
        if message.relation != "<<" or not present:
            return message.value
        if len((present + message.value).encode()) + 1 > MAX_LINE_BYTES:
            raise Refused("TOO_LONG", f"the value would be over {MAX_LINE_BYTES} bytes")
        return f"{present} {message.value}"

    def _do_inq(self, message: Message) -> None:
        slot = self.slots.get(message.slot)
        if slot:
            if slot.access == WRITE_ONLY:
                raise Refused("ACCESS", f"slot '{message.slot}' can only be set")
            return self.say(replace(rep(message.slot, slot.current()), tag=message.tag))
        parent, _, part = message.slot.rpartition(".")
        if parent in self.slots and part in ("help", "prop"):
            of = self.slots[parent]
            return self.say(replace(rep(message.slot, of.explained() if part == "help" else of.attributes()),
                                    tag=message.tag))
        self._find(message.slot)

    def _do_prop(self, message: Message) -> None:
        if message.value not in ("AutoOutput", "NoAutoOutput"):
            raise Refused("BAD_VALUE", f"found '{message.value}', expected AutoOutput or NoAutoOutput", 1)
        self._find(message.slot).auto_output = message.value == "AutoOutput"
        self._answer(message, message.value)

    def _do_save(self, message: Message) -> None:
        names: Iterable[str] = message.value.split() if message.relation == "=" else [
            slot.name for slot in self.slots.values() if slot.access == READ_WRITE and slot.saved]
        values = {}
        for name in names:
            slot = self._find(name)
            if slot.access != READ_WRITE:
                raise Refused("ACCESS", f"slot '{name}' cannot be both asked and set")
            values[name] = slot.current()
        if message.relation == "<<":
            lines = "".join(f"{set_(name, value)}\n" for name, value in values.items())
            append_file(message.value, f"# saved set {message.slot}\n{lines}")
        elif message.slot not in self._saved and len(self._saved) >= MAX_SAVED_SETS:
            raise Refused("LIMIT", f"more than {MAX_SAVED_SETS} saved sets")
        self._keep(sum(len(value) for value in values.values()))
        self._saved[message.slot] = values
        self._answer(message, f"{len(values)} slots")

    def _do_rest(self, message: Message) -> None:
        if message.slot not in self._saved:
            raise Refused("UNKNOWN_SLOT", f"nothing was saved as '{message.slot}'")
        values = dict(self._saved[message.slot])
        for name, value in values.items():
            if name in self.slots and self.slots[name].current() != value:
                self.handle(set_(name, value))
        self._answer(message, f"{len(values)} slots")

    def _do_def(self, message: Message) -> None:
        if message.relation == "=":
            self._define_slot(message)
        elif message.relation:
            self._define_macro(message)
        else:
            raise Refused("BAD_VALUE", "expected `def NAME = VALUE` (a slot) or `def NAME << LINE` (a macro)")
        self._answer(message, message.value)

    def _define_slot(self, message: Message) -> None:
        slot = self.slots.get(message.slot)
        if slot and not slot.user_made:
            raise Refused("ACCESS", f"slot '{message.slot}' belongs to the module, it cannot be defined anew")
        if not slot and sum(known.user_made for known in self.slots.values()) >= MAX_USER_SLOTS:
            raise Refused("LIMIT", f"more than {MAX_USER_SLOTS} user slots")
        self._keep(len(message.value))
        if slot:
            slot.value = message.value
        else:
            self.declare(Slot(message.slot, "<text>", initial=message.value, help="Made by def.", user_made=True))

    def _define_macro(self, message: Message) -> None:
        more = [message.value] if message.relation == "<<" else read_file(message.value).splitlines()
        for number, line in enumerate(more, 1):
            try:
                parse(line)
            except Refused as refusal:
                if refusal.code != "EMPTY":
                    where = f"line {number} of macro '{message.slot}': "
                    raise Refused(refusal.code, where + refusal.text, refusal.column) from None
        lines = (self._macros.get(message.slot, []) if message.relation == "<<" else []) + more
        if len(lines) > MAX_MACRO_LINES:
            raise Refused("LIMIT", f"macro '{message.slot}' would have more than {MAX_MACRO_LINES} lines")
        self._keep(sum(map(len, more)))
        self._macros[message.slot] = lines

    def _keep(self, more: int) -> None:
        """Refuses (LIMIT) what would make all that is kept for users too large."""
        kept = sum(len(slot.value) for slot in self.slots.values() if slot.user_made)
        kept += sum(len(line) for lines in self._macros.values() for line in lines)
        kept += sum(len(value) for values in self._saved.values() for value in values.values())
        if more > 0 and kept + more > MAX_KEPT_BYTES:
            raise Refused("LIMIT", f"what def and save keep would be over {MAX_KEPT_BYTES} bytes")

    def _do_del(self, message: Message) -> None:
        slot = self.slots.get(message.slot)
        if slot and not slot.user_made:
            raise Refused("ACCESS", f"slot '{message.slot}' belongs to the module, it cannot be deleted")
        removed = [kind.pop(message.slot, None) for kind in (self._macros, self._saved, self.slots)]  # type: ignore[attr-defined]
        if all(one is None for one in removed):
            raise Refused("UNKNOWN_SLOT", f"nothing defined or saved as '{message.slot}'")
        self._answer(message, "deleted")

    def _do_do(self, message: Message) -> None:
        name = message.slot or message.value
        lines = self._macros.get(message.slot)
        if lines is None:
            try:
                lines = read_file(name).splitlines()
            except Refused as refusal:
                raise Refused(refusal.code, f"no macro '{name}', and as a file: {refusal.text}") from None
        if len(lines) > MAX_MACRO_LINES:
            raise Refused("LIMIT", f"file '{name}' has more than {MAX_MACRO_LINES} lines")
        if self._depth >= MAX_MACRO_DEPTH:
            raise Refused("LIMIT", f"`do` within `do` more than {MAX_MACRO_DEPTH} deep")
        if self._depth == 0:
            self._lines_run = 0
        self._depth += 1
        try:
            for line in list(lines):
                if self._lines_run >= MAX_DO_LINES:
                    raise Refused("LIMIT", f"stopped after {MAX_DO_LINES} lines")
                self._lines_run += 1
                self.handle_line(line)
        finally:
            self._depth -= 1
        self._answer(message, f"{len(lines)} lines")


def _decoded(line: str | bytes) -> str:
    return line if isinstance(line, str) else line.decode(errors="replace")

