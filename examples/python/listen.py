"""Listens with the ear that takes typed speech, srm_stub, and prints what was understood:

    python3 examples/python/listen.py 'good morning' 'what is that'

The ear that takes sound, build/bin/srm, is spoken to in the same way (docs/speech.md).
"""
import sys

from galatea import Client

with Client.start(["build/bin/srm_stub", "--clock", "virtual"]) as ear:
    ear.set("Grammar.load", "greet good morning | good night")
    ear.set("Grammar", "greet")
    ear.set("Run", "START")
    for heard in sys.argv[1:]:
        ear.set("Input.text", heard)
    ear.set("Wait", "IDLE")
    for message in ear.messages(0):
        print(message)
