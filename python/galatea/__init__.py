"""Galatea, the toolkit of talking agents, from Python: clients of the hub, and modules. docs/python.md shows both."""
from galatea.aio import AsyncClient
from galatea.client import Client
from galatea.clock import Clock
from galatea.endpoint import Credentials, Endpoint
from galatea.errors import Ended, Refused
from galatea.message import Message, inq, parse, rep, set_, tell
from galatea.module import Module, Slot
from galatea.slots import READ_ONLY, READ_WRITE, WRITE_ONLY
from galatea.values import Phoneme, StartTime, ValueGrammar, format_phonemes, parse_phonemes, quote, words

__all__ = [
    "AsyncClient", "Client", "Clock", "Credentials", "Ended", "Endpoint", "Message", "Module", "Phoneme",
    "READ_ONLY", "READ_WRITE", "Refused", "Slot", "StartTime", "ValueGrammar", "WRITE_ONLY",
    "format_phonemes", "inq", "parse", "parse_phonemes", "quote", "rep", "set_", "tell", "words",
]
