#!/usr/bin/env python3
"""A whole module in Python: a lamp that can be switched and fades out by itself, as lamp_module.cc is in C++.

Try it:  printf 'set Lamp = ON 2000\nset Wait = IDLE\ninq Lamp\n' | python3 examples/lamp_module.py
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "python"))  # needless after: pip install ./python
from galatea import Module, Slot


class Lamp(Module):
    """A lamp with a slot."""

    name = "LAMP"
    light = Slot(str, "ON [ <ms> ] | OFF", name="Lamp", initial="OFF", auto_output=True,
                 help="The light: ON, for so many ms or until OFF.")
    fading = None

    @light.on_set
    def switch(self, state: str, ms: float | None = None) -> str:
        if self.fading:
            self.fading.cancel()
        self.fading = self.after(ms, self.fade) if ms is not None else None
        return state

    def fade(self) -> None:
        self.light = "OFF"


if __name__ == "__main__":
    Lamp.main()
