"""A module's time: timers on a clock that is the machine's, virtual, or moved by the hub. In milliseconds."""
from __future__ import annotations

import heapq
import itertools
import time
from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass(order=True)
class Timer:
    """What `Clock.at` gives: it can be cancelled. One that has run, or is cancelled, is no longer `pending`."""

    due_us: int
    number: int
    action: Callable[[], object] = field(compare=False)
    busy: bool = field(compare=False, default=True)
    pending: bool = field(compare=False, default=True)

    def cancel(self) -> None:
        self.pending = False


class Clock:
    """Modes REAL, VIRTUAL and HUB, as docs/protocol.md, Time. Instants are kept in whole microseconds."""

    def __init__(self, mode: str = "REAL") -> None:
        self.mode = mode
        self._virtual_us = 0
        self._base = time.monotonic()
        self._timers: list[Timer] = []
        self._numbers = itertools.count()

    def now(self) -> float:
        return self._now_us() / 1000

    def _now_us(self) -> int:
        return int((time.monotonic() - self._base) * 1e6) if self.mode == "REAL" else self._virtual_us

    def at(self, when_ms: float, action: Callable[[], object], busy: bool = True) -> Timer:
        """Calls `action` once at that instant, or soon if it has passed; `busy` = it is the end of something going on."""
        timer = Timer(max(round(when_ms * 1000), self._now_us()), next(self._numbers), action, busy)
        heapq.heappush(self._timers, timer)
        return timer

    def after(self, delay_ms: float, action: Callable[[], object], busy: bool = True) -> Timer:
        return self.at(self.now() + delay_ms, action, busy)

    def next(self) -> float | None:
        """When the next timer is due; None if none is pending."""
        while self._timers and not self._timers[0].pending:
            heapq.heappop(self._timers)
        return self._timers[0].due_us / 1000 if self._timers else None

    def busy(self) -> bool:
        return any(timer.pending and timer.busy for timer in self._timers)

    def set_mode(self, mode: str) -> None:
        if (mode == "REAL") != (self.mode == "REAL"):
            now_us = self._now_us()
            if mode == "REAL":
                self._base = time.monotonic() - now_us / 1e6
            else:
                self.run_due()  # what was due by now has happened
                self._virtual_us = now_us
        self.mode = mode

    def advance(self, until_ms: float) -> None:
        """On a clock that is not REAL: runs all that is due until then, in order, and stands there."""
        while (due := self.next()) is not None and due <= until_ms:
            self._virtual_us = max(self._virtual_us, round(due * 1000))
            self._run_first()
        self._virtual_us = max(self._virtual_us, round(until_ms * 1000))

    def advance_to_next(self) -> bool:
        """On the VIRTUAL clock: jumps to the next timer and runs what is due then. False if there is none."""
        due = self.next()
        if due is not None:
            self.advance(due)
        return due is not None

    def run_due(self) -> None:
        """On the REAL clock: runs what is due."""
        while (due := self.next()) is not None and due <= self.now():
            self._run_first()

    def _run_first(self) -> None:
        timer = heapq.heappop(self._timers)
        timer.pending = False
        timer.action()
