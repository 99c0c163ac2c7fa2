#!/usr/bin/env python3
"""A dialogue for the hub's page: the module @DIALOG, which holds it as often as a page asks for it.

It starts when the first page asks, so that nobody misses its beginning, and can be started again when it is over.
Usage: web_dialog.py --connect ENDPOINT --name DIALOG -- PROGRAM ARGUMENT...   (task_manager and what it is told)
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "python"))
from galatea import Module, Refused, Slot

LOOK_EVERY_MS = 100
command: list[str] = []


class Dialog(Module):
    """Runs the program, one at a time."""

    name = "DIALOG"
    dialog = Slot(str, "START", name="Dialog", initial="WAITING", auto_output=True,
                  help="START holds the dialogue. It is WAITING for that, RUNNING, OVER, or FAILED: ended by an error.")
    program: subprocess.Popen[bytes] | None = None

    @dialog.on_set
    def begin(self, _: str) -> str:
        if self.program:
            raise Refused("BUSY", "the dialogue goes on")
        self.program = subprocess.Popen(command)
        self.after(LOOK_EVERY_MS, self.look, busy=False)
        return "RUNNING"

    def look(self) -> None:
        if not self.program:
            return
        if self.program.poll() is None:
            self.after(LOOK_EVERY_MS, self.look, busy=False)
            return
        failed = self.program.returncode != 0
        self.program = None
        self.dialog = "FAILED" if failed else "OVER"
        print("run_agent: the dialogue " + ("has ended by an error" if failed else "is over") +
              "; the page can start it again, ^C ends", flush=True)

    def shutdown(self) -> None:
        if self.program:
            self.program.terminate()
            self.program.wait()


if __name__ == "__main__":
    at = sys.argv.index("--")
    command = sys.argv[at + 1:]
    Dialog.main(sys.argv[1:at])
