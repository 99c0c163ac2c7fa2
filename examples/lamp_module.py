#!/usr/bin/env python3
"""A whole module in Python: a lamp with one slot, over stdin and stdout."""
import sys

lamp = "OFF"


def say(line):
    print(line, flush=True)


say("rep Run = LIVE")
for line in sys.stdin:
    command, _, value = line.strip().partition(" = ")
    word, _, slot = command.partition(" ")
    word, _, tag = word.partition("#")
    tag = "#" + tag if tag else ""
    if word == "set" and slot == "Lamp" and value in ("ON", "OFF"):
        lamp = value
        say(f"rep{tag} Lamp = {lamp}")
    elif word == "inq" and slot == "Lamp":
        say(f"rep{tag} Lamp = {lamp}")
    elif (word, slot, value) == ("set", "Run", "EXIT"):
        break
    elif tag:
        say(f"rep{tag} {slot}.error = BAD_VALUE expected set Lamp = ON or OFF, or inq Lamp")
