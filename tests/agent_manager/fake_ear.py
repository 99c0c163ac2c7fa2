#!/usr/bin/env python3
"""An ear that says which tone it hears: a stand-in for srm where only the sound's way matters.

Slots: Input (unix@RATE:PATH, or NONE), Listen, Deaf (YES: it answers no question for Input), Slow (YES: it takes 1.5 s to
open one). It tells of each new Input, as  tell input to VALUE. Once it has half a second of sound that is not silence, it
reports  Result = FREQUENCY  in Hz, from the crossings of zero.
"""
import array
import os
import re
import select
import socket
import sys
import time

slots = {"Run": "LIVE", "Input": "NONE", "Listen": "STOP", "Listen.stat": "OFF", "Listen.languages": "en", "Slots": "Input Listen", "Clock.busy": "IDLE"}
listener, talkers, sound, rate = None, [], array.array("h"), 16000


def say(line):
    print(line, flush=True)


def open_input(value):
    global listener, talkers, rate
    for connection in talkers + ([listener] if listener else []):
        connection.close()
    listener, talkers = None, []
    named = re.fullmatch(r"unix@(\d+):(.*)", value)
    if named:
        rate = int(named[1])
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(named[2])
        listener.listen(1)
    say(f"tell input to {value}")


def hear(connection):
    global sound
    more = connection.recv(1 << 16)
    if not more:
        talkers.remove(connection)
        return connection.close()
    sound.frombytes(more[:len(more) // 2 * 2])
    while sound and max(abs(sample) for sample in sound[:100]) < 1000:
        del sound[:100]
    while len(sound) >= rate // 2 and slots["Listen"] == "START":
        piece, sound = sound[:rate // 2], sound[rate // 2:]
        crossings = sum(1 for a, b in zip(piece, piece[1:]) if a < 0 <= b)
        say(f"rep Result = {crossings * 2}")


def obey(line):
    found = re.match(r"(set|inq|prop)(#\S+)? (\S+)(?: = (.*))?$", line)
    if not found:
        return
    command, tag, slot, value = found[1], found[2] or "", found[3], found[4] or ""
    if slot == "Run" and value == "EXIT":
        sys.exit(0)
    if slot == "Clock":
        return say(f"rep{tag} Clock = 0")
    if command == "set":
        slots[slot] = value
        if slot == "Input":
            time.sleep(1.5 if slots.get("Slow") == "YES" else 0)
            open_input(value)
    if slot == "Input" and slots.get("Deaf") == "YES":
        return
    if tag or command == "inq":
        say(f"rep{tag} {slot} = {slots.get(slot, value)}")


say("rep Run = LIVE")
lines = b""
while True:
    ready, _, _ = select.select([0, *talkers] + ([listener] if listener else []), [], [])
    for source in ready:
        if source is listener:
            talkers.append(listener.accept()[0])
        elif source == 0:
            more = os.read(0, 1 << 16)
            if not more:
                sys.exit(0)
            *whole, lines = (lines + more).split(b"\n")
            for line in whole:
                obey(line.decode())
        elif source in talkers:
            hear(source)
