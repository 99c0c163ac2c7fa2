"""Modules of the toolkit as child processes: lines out, lines in. Used by the demonstrations here."""

import os
import subprocess
import sys
import threading


class Module:
    """One program. Its clock is virtual, so nothing waits for sound to pass."""

    def __init__(self, folder, name, *options):
        self.name = name
        path = os.path.join(folder, name)
        if not os.access(path, os.X_OK):
            sys.exit(f"there is no program {path}; build it, or name its folder with --bin")
        self.process = subprocess.Popen([path, "--clock", "virtual", *options], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        # A module that says nothing for a minute is ended; the reader then finds the end of input.
        self.guard = threading.Timer(60, self.process.kill)
        self.guard.start()

    def tell(self, *lines):
        for line in lines:
            self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def lines(self, last):
        """Every line up to one that begins with `last`, which is included."""
        for line in self.process.stdout:
            line = line.rstrip("\n")
            yield line
            if line.startswith(last):
                return
        sys.exit(f"{self.name} ended without '{last}'")

    def wait_for(self, beginning):
        for line in self.lines(beginning):
            if line.startswith(beginning):
                return line[len(beginning):].strip()

    def end(self):
        self.guard.cancel()
        self.process.stdin.close()
        self.process.wait(timeout=30)


def speak_to_file(voice, speaker, text, path):
    """What somebody else says, as a recording."""
    voice.tell(f"set Speaker = {speaker}", f"set Text = {text}", f"set#save SaveWAV = {path}")
    answer = voice.wait_for("rep#save ")
    if not answer.startswith("SaveWAV ="):
        sys.exit(f"the customer's speech could not be made: {answer}")
