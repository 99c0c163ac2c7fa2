"""A module of one's own: slots declared with types, time that follows the hub, and the program around them."""
from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar, overload

from galatea.clock import Clock, Timer
from galatea.errors import Refused
from galatea.message import Message, inq, set_, tell
from galatea.slots import READ_ONLY, READ_WRITE, WRITE_ONLY, Answer, SetValue, SlotMachine
from galatea.slots import Slot as SlotSpec
from galatea.tasks import Task, Waiting
from galatea.values import format_ms, format_number

T = TypeVar("T", str, int, float, bool)
Handler = Callable[..., Any]
_GRAMMARS = {str: "<text>", int: "<int>", float: "<number>", bool: "ON | OFF"}


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "ON" if value else "OFF"
    return format_number(value) if isinstance(value, (int, float)) else str(value)


class Slot(Generic[T]):
    """One slot of a module, declared as a member of its class: `brightness = Slot(float, "<number 0..1>")`.

    The type is that of `self.brightness`; assigning to it stores the value and, with `auto_output`, reports it to
    everybody. The grammar (docs/protocol.md, Values) may be left out: `<text>`, `<int>`, `<number>`, or `ON | OFF` for
    bool. The name on the wire is the member's unless `name` is given.
    """

    def __init__(self, type_: type[T], grammar: str = "", *, name: str = "", initial: T | None = None,
                 access: str = READ_WRITE, auto_output: bool = False, saved: bool = True, help: str = "") -> None:
        self.type = type_
        self.grammar = grammar or _GRAMMARS[type_]
        self.name = name
        self.initial = "" if initial is None else _text(initial)
        self.access = access
        self.auto_output = auto_output
        self.saved = saved
        self.help = help
        self.setter: Handler | None = None
        self.getter: Handler | None = None

    def __set_name__(self, owner: type, member: str) -> None:
        self.name = self.name or member

    @overload
    def __get__(self, module: None, owner: type) -> Slot[T]: ...
    @overload
    def __get__(self, module: Module, owner: type) -> T: ...
    def __get__(self, module: Module | None, owner: type) -> Slot[T] | T:
        if module is None:
            return self
        text = module.slots.slots[self.name].current()
        if self.type is bool:
            return self.type(text.upper() in ("ON", "TRUE", "1"))
        return self.type(text or 0) if self.type in (int, float) else self.type(text)

    def __set__(self, module: Module, value: T) -> None:
        module.slots.report(self.name, _text(value))

    def on_set(self, handler: Handler) -> Handler:
        """Decorates the method that is given a value's parts (words as str, numbers as float or int) when one comes.

        What it returns is stored, reported and answered; None = the value as it came. It raises Refused for what it
        does not take. One that is `async` may wait (`self.sleep`, `self.request`); it is answered when it ends, and
        unless the slot is WRITE_ONLY what it returned is stored and reported then.
        """
        self.setter = handler
        return handler

    def on_inq(self, handler: Handler) -> Handler:
        """Decorates the method that says the present value when somebody asks."""
        self.getter = handler
        return handler


@dataclass(frozen=True)
class _Bound:
    """A declared slot with the module it belongs to: what the slot machine calls."""

    module: Module
    slot: Slot[Any]

    def spec(self) -> SlotSpec:
        slot = self.slot
        later = slot.setter is not None
        return SlotSpec(slot.name, slot.grammar, slot.access, slot.initial, slot.auto_output, slot.help,
                        on_set_later=self.set if later else None, on_inq=self.current if slot.getter else None,
                        saved=slot.saved)

    def current(self) -> str:
        assert self.slot.getter is not None
        return _text(self.slot.getter(self.module))

    def set(self, value: SetValue, answer: Answer) -> None:
        assert self.slot.setter is not None
        parts = [part.typed for part in value.items]
        if self.slot.type is bool:
            parts = [part == "ON" if part in ("ON", "OFF") else part for part in parts]
        result = self.slot.setter(self.module, *parts)
        if isinstance(result, Coroutine):
            self.module.start(result, lambda ended: self.done(value, answer, ended, told=self.slot.access != WRITE_ONLY))
        else:
            self.done(value, answer, result, told=True)

    def done(self, value: SetValue, answer: Answer, result: Any, told: bool) -> None:
        if isinstance(result, Refused):
            return answer(result)
        text = value.text if result is None else _text(result)
        if told:
            self.module.slots.report(self.slot.name, text)
        answer(text)


class Module:
    """The base of a module; docs/python.md shows whole ones. `Lamp.main()` makes a program of the class Lamp.

    A module has the slots of its class and those every module has (Slots, Error, Run, ModuleVersion, ProtocolVersion;
    in a program also Clock, Clock.mode, Clock.busy and Wait). It lives on `clock`: it does not sleep and reads no other
    time, so that it goes in step with the hub on either clock. One thread; nothing here blocks.
    """

    name = "MODULE"  # what it is called where nothing else is said
    version = "1.0"
    virtual_by_default = True  # lines piped in at once are dealt with on the virtual clock

    def __init__(self, clock: Clock | None = None) -> None:
        self.clock = clock or Clock("VIRTUAL")
        self.output: Callable[[Message], None] = lambda message: None
        self.complain: Callable[[str], None] = lambda text: None
        self.exit_gate: Callable[[Callable[[], None]], None] = lambda leave: leave()
        self.exits = False
        self._tasks: list[Task] = []
        self._current: list[Task] = []
        self._asked: dict[str, tuple[str, Callable[[str], None], Callable[[Refused], None]]] = {}
        self._last_tag = 0
        self.slots = SlotMachine(self.name, lambda message: self.output(message), self._on_error, self._on_heard)
        self._declare_common()
        for member in dict.fromkeys(name for kind in reversed(type(self).__mro__) for name in vars(kind)):
            slot = getattr(type(self), member)
            if isinstance(slot, Slot):
                self.slots.declare(_Bound(self, slot).spec())

    # For subclasses to have their own of.

    def started(self) -> None:
        """Called once when it can speak: to subscribe, for example."""

    def heard(self, message: Message) -> None:
        """Told what others `rep` and `tell` to this module, except answers to what it has requested."""

    def init(self) -> None:
        """`set Run = INIT`: back to the state at the start. A subclass that has one takes INIT."""

    def shutdown(self) -> None:
        """Called once at the end: finish files."""

    def busy(self) -> bool:
        """True while something with an end goes on: a coroutine, or a timer that is not `busy=False`."""
        return bool(self._tasks) or self.clock.busy()

    # To say things.

    def say(self, message: Message, to: str | tuple[str, ...] = "") -> None:
        """A message of its own: `self.say(set_("FaceMot", "NOD 1"), to="FSM")`. Without `to`: for all who subscribed."""
        self.slots.say(message.addressed(to))

    def tell(self, text: str) -> None:
        """An event, told to all who subscribed."""
        self.say(tell(text))

    def set(self, slot: str, value: object, to: str) -> Waiting:
        return self.request(set_(slot, _text(value)), to)

    def inq(self, slot: str, to: str) -> Waiting:
        return self.request(inq(slot), to)

    def request(self, message: Message, to: str) -> Waiting:
        """In a coroutine: `value = await self.inq("Speaker", to="SSM")`. Raises Refused where it is refused."""
        def begin(resume: Callable[[str], None], fail: Callable[[Refused], None]) -> Callable[[], None]:
            self._last_tag += 1
            tag = f"m{self._last_tag}"
            self._asked[tag] = (message.slot or message.command, resume, fail)
            self.say(replace(message, tag=tag), to)
            return lambda: self._asked.pop(tag, None) and None
        return Waiting(begin)

    # Time.

    def sleep(self, ms: float) -> Waiting:
        """In a coroutine: `await self.sleep(300)`."""
        def begin(resume: Callable[[None], None], fail: Callable[[Refused], None]) -> Callable[[], None]:
            return self.clock.after(ms, lambda: resume(None), busy=False).cancel  # the coroutine itself is what is busy
        return Waiting(begin)

    def after(self, ms: float, action: Callable[[], object], busy: bool = True) -> Timer:
        """Calls `action` in so many ms; the timer can be cancelled. `busy=False`: not something people wait for."""
        return self.clock.after(ms, lambda: self._guarded(action), busy)

    def start(self, coroutine: Coroutine[Any, Any, Any], on_end: Callable[[Any], None] | None = None) -> Task:
        """Runs a coroutine on the module's clock; `on_end` gets its value or the Refused it ended by."""
        def ended(task: Task, result: Any) -> None:
            if task in self._tasks:
                self._tasks.remove(task)
            if on_end:
                on_end(result)
            elif isinstance(result, Refused):
                self.complain(f"error: {result}")
        task = Task(coroutine, ended, self._current)
        self._tasks.append(task)
        task.step()
        return task

    def current_task(self) -> Task:
        """The coroutine that is running now: to be cancelled later."""
        return self._current[-1]

    # Inside.

    def _guarded(self, action: Callable[[], Any]) -> None:
        """Nobody asked for it now, so what it raises is told on stderr."""
        try:
            action()
        except Refused as refusal:
            self.complain(f"error: {refusal}")
        except Exception as error:
            traceback.print_exception(error)
            self.complain(f"error: INTERNAL {type(error).__name__}: {error}")

    def _on_error(self, line: str, error: Refused) -> None:
        self.complain(f"error: {error}" + (f" (in: {line})" if line else ""))

    def _on_heard(self, message: Message) -> None:
        asked = self._asked.get(message.tag) if message.command == "rep" else None
        if asked and message.slot in (asked[0], asked[0] + ".error", "Error"):
            del self._asked[message.tag]
            if message.slot == asked[0]:
                asked[1](message.value)
            else:
                asked[2](Refused.read(message.value))
        else:
            self.heard(message)

    def abandon_requests(self) -> None:
        """Nobody will answer any more: what waits for an answer is refused."""
        for _, _, fail in list(self._asked.values()):
            fail(Refused("UNAVAILABLE", "the hub has gone"))
        self._asked.clear()

    def _declare_common(self) -> None:
        has_init = type(self).init is not Module.init
        run = "LIVE | INIT | SLEEP | EXIT" if has_init else "LIVE | SLEEP | EXIT"
        init = ", INIT resets everything to its state at start" if has_init else ""
        self.slots.declare(SlotSpec(
            "Run", run, initial="LIVE", on_set_later=self._set_run, saved=False,
            help=f"LIVE while the module runs. EXIT ends it{init}. SLEEP, which scripts of the original have, does nothing."))
        for name, value, meaning in (("ModuleVersion", self.version, "The version of this program."),
                                     ("ProtocolVersion", "1.0", "The version of the protocol it speaks.")):
            self.slots.declare(SlotSpec(name, "<text>", READ_ONLY, value, help=meaning))

    def _set_run(self, value: SetValue, answer: Answer) -> None:
        word = value.items[0].text
        if word == "EXIT":
            self.exit_gate(lambda: self._leave(answer))
            return
        if word == "INIT":
            self.init()
        elif word == "LIVE":
            self.slots.report("Run", "LIVE")
        answer("LIVE")

    def _leave(self, answer: Answer) -> None:
        self.slots.report("Run", "EXIT")
        answer("EXIT")
        self.exits = True

    def clock_text(self) -> str:
        """What `set#TAG Clock = T` is answered where the hub moves the clock."""
        due = self.clock.next()
        busy = "BUSY" if self.busy() else "IDLE"
        return f"{format_ms(self.clock.now())} {'-' if due is None else format_ms(due)} {busy}"

    @classmethod
    def main(cls, arguments: list[str] | None = None) -> None:
        """The program: on stdin and stdout, or `--connect` to a hub; does not return. `--help` tells the options."""
        from galatea.program import run_program

        sys.exit(run_program(cls, arguments))
