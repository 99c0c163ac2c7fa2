"""Drives the face alone, without a hub, to make a film:  python3 examples/python/film.py FILM.mp4

The face is on the virtual clock: `Wait` is exact to the millisecond and takes no longer than drawing does.
"""
import sys

from galatea import Client, Phoneme, format_phonemes

hello = [Phoneme("pau", 100), Phoneme("hh", 60), Phoneme("ax", 60), Phoneme("l", 70), Phoneme("ow", 240), Phoneme("pau", 200)]
with Client.start(["build/bin/fsm", "--headless", "--clock", "virtual"]) as face:
    face.set("Record", sys.argv[1])
    face.set("FaceExp", "HAPPY 1 80 0")
    face.set("LipSync.pho", format_phonemes(hello, "plain"))
    face.set("Speak", "NOW")
    face.set("Wait", "IDLE")
    face.set("FaceMot", "NOD 1")
    face.set("Wait", 1200)
    print("film:", face.set("Record", "STOP"))
