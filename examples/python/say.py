"""Starts an agent, has it look happy and say something, and makes a film of it:  python3 examples/python/say.py TEXT FILM.mp4"""
import sys

from galatea import Client

text, film = sys.argv[1:]
# The hub's own console is the stream we speak on; examples/agents/film.json is an agent on the virtual clock.
with Client.start(["build/bin/agent_manager", "--config", "examples/agents/film.json"]) as agent:
    agent.set("Record", film, to="AM-MCL")
    agent.set("Emotion", "HAPPY 80", to="AM-MCL")
    agent.set("Speak", text, to="AM-MCL")  # answered when it has been said
    agent.set("Record", "STOP", to="AM-MCL")
    print("phonemes:", agent.inq("Speak.utt", to="AM-MCL"))
    print("it took", agent.inq("Speak.len", to="AM-MCL"), "ms")
