#!/usr/bin/env python3
"""A small dialogue typed at the terminal: you type, the agent hears, answers and shows how it feels.

It is a client of the hub like any other program: what you type goes to the ear (SRM) as typed
speech, the ear's result comes back, and the answer goes to the hub's Speak macro.
Usage: demo_dialogue.py SOCKET [VOICE MODULE]
"""
import os
import random
import select
import socket
import sys

# What is heard (any of the words) -> how the face looks, and what is said.
RULES = [
    (("bye", "goodbye", "quit", "exit"), "SAD 60", ["Goodbye. It was nice to talk with you."]),
    (("hello", "hi", "hey", "morning"), "HAPPY 90", ["Hello! I am Galatea. How are you today?"]),
    (("name", "who"), "HAPPY 60", ["My name is Galatea. I am a talking agent with a face."]),
    (("fine", "good", "great", "well"), "HAPPY 100", ["I am glad to hear that.", "Wonderful!"]),
    (("sad", "tired", "bad"), "SAD 90", ["Oh, I am sorry. I hope your day gets better."]),
    (("angry", "hate", "stupid"), "ANGRY 70", ["Please, let us stay friendly."]),
    (("ghost", "monster", "afraid"), "FEARED 90", ["A ghost? Where? You scare me."]),
    (("surprise", "wow", "really"), "SURPRISED 90", ["Really? I did not expect that."]),
    (("can", "what", "help"), "NEUTRAL", ["I listen, speak and look at you. Ask me for my name, or tell me how you feel."]),
]
OTHERWISE = ("NEUTRAL", ["I see. Tell me more.", "I did not understand everything, but I like to listen."])


class Hub:
    """Lines to and from the hub."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.rest = b""

    def send(self, line):
        self.socket.sendall(line.encode() + b"\n")

    def lines(self):
        """What has arrived; None at the end."""
        data = self.socket.recv(65536)
        if not data:
            return None
        *lines, self.rest = (self.rest + data).split(b"\n")
        return [line.decode(errors="replace") for line in lines]


class Typed:
    """Lines from the terminal or a pipe. Python's own reader keeps what came at once with the first."""

    def __init__(self):
        self.rest = b""

    def lines(self):
        """What has arrived; None at the end."""
        data = os.read(sys.stdin.fileno(), 65536)
        if not data:
            last, self.rest = self.rest, b""
            return [last.decode(errors="replace")] if last else None
        *lines, self.rest = (self.rest + data).split(b"\n")
        return [line.decode(errors="replace") for line in lines]


def answer(text):
    words = "".join(c if c.isalnum() else " " for c in text.lower()).split()
    for keys, feeling, sentences in RULES:
        if any(key in words for key in keys):
            return feeling, random.choice(sentences)
    return OTHERWISE[0], random.choice(OTHERWISE[1])


def feel(hub, feeling):
    hub.send(f"to @AM-MCL set Emotion = {feeling}")


def main():
    hub = Hub(sys.argv[1])
    hub.send("to @AM set Name = DIALOGUE")
    hub.send("to @AM set Subscribe = SRM AM-MCL")
    hub.send("to @SRM set Run = START")
    for life in ("BLINK 1", "MOVE 1", "GAZE 1"):
        hub.send("to @FSM set Autonomous = " + life)
    hub.send("to @FSM set FaceExp.onset = NATURAL")
    leaving = False
    print("Type to the agent, one line at a time; 'bye' or end of input leaves.", flush=True)
    feel(hub, "HAPPY 90")
    hub.send("to @AM-MCL set#said Speak = Hello! I am Galatea. Please type something to me.")
    print("Galatea: Hello! I am Galatea. Please type something to me.", flush=True)
    watched = [hub.socket, sys.stdin]
    typed = Typed()
    while True:
        ready, _, _ = select.select(watched, [], [])
        if sys.stdin in ready:
            lines = typed.lines()
            if lines is None:
                watched.remove(sys.stdin)
                leaving = True
                hub.send("to @AM-MCL inq#said Speak.stat")  # leave at once if nothing is being said
            for line in lines or []:
                if line.strip():
                    hub.send("to @SRM set Input.text = " + line.strip())
        if hub.socket in ready:
            lines = hub.lines()
            if lines is None:
                sys.exit("demo_dialogue: the hub has gone")
            for line in lines:
                if line.startswith("From @SRM rep Result = "):
                    heard = line.split(" = ", 1)[1]
                    feeling, sentence = answer(heard)
                    print(f"Galatea: {sentence}", flush=True)
                    feel(hub, feeling)
                    hub.send("to @AM-MCL set#said Speak = " + sentence)
                    leaving = leaving or sentence.startswith("Goodbye")
                elif "rep#said " in line:
                    if "Speak.error" in line and "STOPPED" not in line:
                        print("Galatea cannot speak: " + line.split(" = ", 1)[1], file=sys.stderr, flush=True)
                    busy = "Speak.stat" in line and "IDLE" not in line
                    if leaving and not busy:
                        return


if __name__ == "__main__":
    main()
