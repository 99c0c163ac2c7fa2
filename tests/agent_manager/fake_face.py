"""A face of 16 x 16 pixels, all red: sends one picture after another to where Picture.to says; after `set Frames = OFF`
none, and what `Say` says (text with the escapes of Python) byte for byte. Clock and pictures have the time since its start.
A slot that was given AutoOutput is reported when it is set.
"""
import base64
import codecs
import socket
import sys
import threading
import time

# ffmpeg -f lavfi -i color=red:s=16x16 -frames:v 1 -q:v 5 -f mjpeg
PICTURE = base64.b64decode(
    "/9j/4AAQSkZJRgABAgAAAQABAAD//gAQTGF2YzU5LjM3LjEwMAD/2wBDAAgKCgsKCw0NDQ0NDRAPEBAQEBAQEBAQEBASEhIVFRUSEhIQEBISFBQVFRcX"
    "FxUVFRUXFxkZGR4eHBwjIyQrKzP/xABMAAEBAAAAAAAAAAAAAAAAAAAABgEBAQAAAAAAAAAAAAAAAAAABgcQAQAAAAAAAAAAAAAAAAAAAAARAQAAAAAA"
    "AAAAAAAAAAAAAAD/wAARCAAQABADASIAAhEAAxEA/9oADAMBAAIRAxEA/wCLAFF/f//Z")
connection, stop, began = None, threading.Event(), time.monotonic()
values = {"Picture.to": "NONE", "Record": "STOP", "Run": "LIVE", "Frames": "ON",
          "MaskSet": "galatea,pygmalion", "NowMask": "galatea", "FaceExp": "ANGRY 1 60 0"}
reported = set()


def now_ms():
    return int((time.monotonic() - began) * 1000)


def send_pictures(to):
    try:
        while connection is to:
            if values["Frames"] == "ON":
                to.sendall(b"picture %d %d\n" % (now_ms(), len(PICTURE)) + PICTURE)
            stop.wait(0.02)
    except OSError:
        pass


for line in sys.stdin:
    words = line.rstrip("\n").split(" ", 3)
    command, _, tag = words[0].partition("#")
    slot = words[1] if len(words) > 1 else ""
    value = words[3] if len(words) > 3 else ""
    if command == "set" and slot == "Run":
        connection = None
        stop.set()
        break
    if command == "prop":
        reported.add(slot)
    if command == "set" and slot == "Say" and connection:
        connection.sendall(codecs.escape_decode(value.encode())[0])
    elif command == "set":
        values[slot] = value
        if slot in reported:
            print(f"rep {slot} = {value}", flush=True)
        if slot == "Mask":
            values["NowMask"] = value
            print("tell wears " + value, flush=True)
        if slot == "Picture.to":
            before, connection = connection, None
            if before:
                before.close()
            if value.startswith("unix:"):
                connection = socket.socket(socket.AF_UNIX)
                connection.connect(value[5:])
                threading.Thread(target=send_pictures, args=(connection,), daemon=True).start()
            print("tell pictures to " + value.split("/")[0], flush=True)
    if tag and slot == "Clock":
        print(f"rep#{tag} Clock = {now_ms()}", flush=True)
    elif tag and slot in values:
        print(f"rep#{tag} {slot} = {values[slot]}", flush=True)
    elif tag:
        print(f"rep#{tag} {slot}.error = UNKNOWN_SLOT no such slot", flush=True)
