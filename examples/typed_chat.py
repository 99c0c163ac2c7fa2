#!/usr/bin/env python3
"""A conversation typed at the terminal: you type, the agent hears, answers and shows how it feels.

It is a client of the hub like any other program: what you type goes to the ear (SRM) as typed speech, the module
that talks (CHAT, docs/chat.md) answers it, and what it says is printed here. Type while it speaks and it stops.
Usage: typed_chat.py SOCKET
"""
import os
import select
import socket
import sys
import time


class Lines:
    """Lines of a descriptor. Python's own reader keeps what came at once with the first."""

    def __init__(self, descriptor):
        self.descriptor = descriptor
        self.rest = b""
        self.ended = False

    def read(self):
        data = os.read(self.descriptor, 65536)
        self.ended = not data
        *lines, self.rest = (self.rest + (data or b"\n")).split(b"\n")
        return [line.decode(errors="replace").strip() for line in lines if line.strip()]


class Conversation:
    def __init__(self, path):
        self.hub = socket.socket(socket.AF_UNIX)
        self.hub.connect(path)
        self.said = Lines(self.hub.fileno())
        self.typed = Lines(sys.stdin.fileno())
        self.waiting = []  # typed ahead; from a file or a pipe a line is said when the agent has answered
        self.on_the_way = 0
        self.busy = True
        self.stopping = False
        self.await_start()
        for line in ("to @AM set Name = TYPED", "to @AM set Subscribe = CHAT",
                     "to @FSM set FaceExp.onset = NATURAL", "to @CHAT set#talk Talk = 1000 0",
                     "to @CHAT set#hello Say = [happy 90] Welcome! Please type something to me."):
            self.send(line)

    def send(self, line):
        self.hub.sendall(line.encode() + b"\n")

    def await_start(self):
        """The module starts after those it needs."""
        until = time.monotonic() + 30
        while time.monotonic() < until:
            self.send("to @CHAT inq#start Busy")
            while not (answers := [line for line in self.said.read() if "rep#start " in line]):
                if self.said.ended:
                    sys.exit("typed_chat: the hub has gone")
            if ".error" not in answers[0]:
                return
            time.sleep(0.05)
        sys.exit("typed_chat: " + answers[0].split(" = ", 1)[1])

    def type_next(self):
        while self.waiting and (sys.stdin.isatty() or not (self.busy or self.on_the_way)):
            self.on_the_way += 1
            self.send("to @SRM set#typed Input.text = " + self.waiting.pop(0))
        if self.typed.ended and not (self.waiting or self.on_the_way or self.busy or self.stopping):
            self.stopping = True
            self.send("to @CHAT set Talk = STOP")

    def hear(self, line):
        """False at the end of the conversation."""
        if line.startswith("From @CHAT rep Reply.sentence = "):
            print("Galatea: " + line.split(" = ", 1)[1], flush=True)
        elif line.startswith("From @CHAT rep Busy = "):
            self.busy = not line.endswith("IDLE")
        elif "rep#typed " in line:
            self.on_the_way -= 1
            self.busy = ".error" not in line  # its answer comes
        elif "rep#talk " in line or ("rep#hello Say.error" in line and "STOPPED" not in line):
            if ".error" in line:
                sys.exit("typed_chat: " + line.split(" = ", 1)[1])
            return False
        elif ".error = " in line and "STOPPED" not in line:
            print("typed_chat: " + line.split(" = ", 1)[1], file=sys.stderr, flush=True)
        return True

    def run(self):
        print("Type to the agent, one line at a time; 'bye' or end of input leaves.", flush=True)
        while True:
            ready, _, _ = select.select([self.hub] + ([] if self.typed.ended else [sys.stdin]), [], [])
            if sys.stdin in ready:
                self.waiting += self.typed.read()
            if self.hub in ready:
                for line in self.said.read():
                    if not self.hear(line):
                        return
                if self.said.ended:
                    sys.exit("typed_chat: the hub has gone")
            self.type_next()


if __name__ == "__main__":
    Conversation(sys.argv[1]).run()
