"""Coroutines that live on a module's clock instead of the machine's: what `async def` handlers of slots run as."""
from __future__ import annotations

import traceback
from collections.abc import Callable, Coroutine, Generator
from typing import Any

from galatea.errors import Refused

Result = Any


class Waiting:
    """What a coroutine awaits. `begin(resume, fail)` starts the wait and returns how to give it up."""

    def __init__(self, begin: Callable[[Callable[[Result], None], Callable[[Refused], None]], Callable[[], None]]) -> None:
        self._begin = begin

    def __await__(self) -> Generator[Waiting, Result, Result]:
        return (yield self)

    def start(self, task: Task) -> Callable[[], None]:
        return self._begin(lambda result: task.step(result), lambda refusal: task.step(refusal))


class Task:
    """One coroutine under way. `on_end` is called once, with its value or with the Refused it ended by."""

    def __init__(self, coroutine: Coroutine[Any, Any, Result], on_end: Callable[[Task, Result | Refused], None],
                 current: list[Task]) -> None:
        self._coroutine = coroutine
        self._current = current  # the tasks that are running now, the innermost last
        self._on_end = on_end
        self._give_up: Callable[[], None] = lambda: None
        self.running = True

    def step(self, result: Result | Refused = None) -> None:
        """Goes on to the next wait or the end; a Refused is raised where it waits."""
        if not self.running:
            return
        self._give_up = lambda: None
        self._current.append(self)
        try:
            waiting = self._coroutine.throw(result) if isinstance(result, Refused) else self._coroutine.send(result)
        except StopIteration as end:
            return self._finish(end.value)
        except Refused as refusal:
            return self._finish(refusal)
        except Exception as error:
            traceback.print_exception(error)
            return self._finish(Refused("INTERNAL", f"{type(error).__name__}: {error}"))
        finally:
            self._current.pop()
        if isinstance(waiting, Waiting):
            self._give_up = waiting.start(self)
        else:
            self.step(Refused("INTERNAL", "a module's coroutine awaits self.sleep() or self.request(), nothing of asyncio's"))

    def cancel(self) -> None:
        """Ends it where it waits, by Refused("STOPPED"): what it was begun for is answered so."""
        if self.running:
            self._give_up()
            self.step(Refused("STOPPED", "stopped on request"))

    def _finish(self, result: Result | Refused) -> None:
        self.running = False
        self._on_end(self, result)
