"""A voice with no words: connects to where Sound.to says and sends there what `Say` says, byte for byte.

Sound.to (unix:PATH or NONE), Say (text with the escapes of Python), Tell (a line it says to the hub), Clock, Sink,
Speaker and Speaker.all.
"""
import codecs
import re
import socket
import sys

to, connection = "NONE", None
values = {"Clock": "0", "Sink": "null", "Speaker": "anna", "Speaker.all": "anna ben carl", "Speaker.languages": "en anna; ja ben; de carl"}
for line in sys.stdin:
    found = re.match(r"(set|inq|prop)(#\S+)? (\S+)(?: = (.*))?$", line.rstrip("\n"))
    if not found:
        continue
    command, tag, slot, value = found[1], found[2] or "", found[3], found[4] or ""
    if slot == "Run" and value == "EXIT":
        break
    if slot == "Speaker" and command == "set":
        values[slot] = value
        print("tell speaks as " + value, flush=True)
    if slot in values:
        value = values[slot]
    elif slot == "Tell":
        print(value, flush=True)
    elif slot == "Sound.to" and command == "set":
        if connection:
            connection.close()
        to, connection = value, None
        if to.startswith("unix:"):
            connection = socket.socket(socket.AF_UNIX)
            connection.connect(to[5:])
        print("tell sound to " + to.split("/")[0], flush=True)
    elif slot == "Sound.to":
        value = to
    elif slot == "Say" and connection:
        connection.sendall(codecs.escape_decode(value.encode())[0])
    if tag or command == "inq":
        print(f"rep{tag} {slot} = {value}", flush=True)
