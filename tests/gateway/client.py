#!/usr/bin/env python3
"""A client of the gateway: client.py ws://HOST:PORT/PATH STEP...   or   client.py http://HOST:PORT/PATH BODY [HEADER: VALUE]...

Over a WebSocket a step is
    sound:FILE[:BYTES]   the file's bytes as binary messages of so many bytes (3200)
    text:TEXT            a text message
    until:TYPE           prints what comes until a message of that type, which is printed, too
    flood:BYTES          so many bytes of sound, without reading anything; `cut off` is printed if the other end closes meanwhile
    end                  prints what comes until the connection ends
A picture is printed as {"type": "picture", "sound", "t", ...}, and kept as SOUND_MS.jpg in the folder that PICTURES names, if it does.
A status other than 101 is printed as `status CODE` and ends it. Over HTTP the body is posted: `status CODE TYPE` is printed, then
the answer (its length where it is no text).
"""
import base64
import contextlib
import json
import os
import socket
import struct
import sys
import urllib.error
import urllib.parse
import urllib.request

LIMIT_S = 60
FOLDER = os.environ.get("PICTURES")
CUT_OFF = (ConnectionResetError, BrokenPipeError)


class WebSocket:
    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((parts.hostname, parts.port), LIMIT_S)
        key = base64.b64encode(os.urandom(16)).decode()
        path = parts.path + ("?" + parts.query if parts.query else "")
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n").encode())
        self.buffer = b""
        head = b""
        while b"\r\n\r\n" not in head:
            more = self.socket.recv(65536)
            if not more:
                break
            head += more
        head, _, self.buffer = head.partition(b"\r\n\r\n")
        self.status = int(head.split(b" ")[1])

    def send(self, opcode, payload):
        mask = os.urandom(4)
        length = len(payload)
        head = bytes([0x80 | opcode])
        if length < 126:
            head += bytes([0x80 | length])
        elif length < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", length)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", length)
        pad = mask * (length // 4 + 1)
        masked = (int.from_bytes(payload, "big") ^ int.from_bytes(pad[:length], "big")).to_bytes(length, "big")
        self.socket.sendall(head + mask + masked)

    def take(self, count):
        while len(self.buffer) < count:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.buffer += more
        taken, self.buffer = self.buffer[:count], self.buffer[count:]
        return taken

    def read(self):
        """The next message, a picture as text about it; None at the end."""
        whole, kind = b"", 0
        while True:
            try:
                first, second = self.take(2)
                length = second & 127
                if length == 126:
                    length = struct.unpack(">H", self.take(2))[0]
                elif length == 127:
                    length = struct.unpack(">Q", self.take(8))[0]
                payload = self.take(length)
            except (EOFError, *CUT_OFF):
                return None
            opcode = first & 15
            if opcode == 8:
                return None
            if opcode == 9:
                self.send(10, payload)
            if opcode > 2:
                continue
            whole, kind = whole + payload, opcode or kind  # 0 goes on with the message
            if not first & 128:
                continue
            payload, whole = whole, b""
            if kind == 1:
                return payload.decode()
            if kind == 2:
                kind, sound, ms = struct.unpack("<B3xId", payload[:16])
                if FOLDER:
                    with open(f"{FOLDER}/{sound}_{round(ms):06}.jpg", "wb") as file:
                        file.write(payload[16:])
                return json.dumps({"type": "picture", "kind": kind, "sound": sound, "t": ms / 1000, "bytes": len(payload) - 16,
                                   "jpeg": payload[16:19] == b"\xff\xd8\xff" and payload[-2:] == b"\xff\xd9"})


def follow(url, steps):
    web = WebSocket(url)
    if web.status != 101:
        print("status", web.status)
        return
    for step in steps:
        kind, _, rest = step.partition(":")
        if kind == "sound":
            name, _, size = rest.partition(":")
            size = int(size or 3200)
            with open(name, "rb") as file, contextlib.suppress(*CUT_OFF):
                while piece := file.read(size):
                    web.send(2, piece)
        elif kind == "text":
            web.send(1, rest.encode())
        elif kind == "flood":
            try:
                for _ in range(int(rest) // 65536):
                    web.send(2, bytes(65536))
            except CUT_OFF:
                print("cut off")
        else:
            while (text := web.read()) is not None:
                print(text, flush=True)
                if kind == "until" and json.loads(text)["type"] == rest:
                    break
            else:
                print("closed", flush=True)


def post(url, body, headers):
    request = urllib.request.Request(url, body.encode(), dict(line.split(": ", 1) for line in headers))
    try:
        answer = urllib.request.urlopen(request, timeout=LIMIT_S)
    except urllib.error.HTTPError as error:
        answer = error
    content = answer.read()
    kind = answer.headers.get("Content-Type", "-")
    print("status", answer.status, kind)
    print(content.decode() if kind == "application/json" else f"{len(content)} {content[:4]!r}")


if __name__ == "__main__":
    if sys.argv[1].startswith("ws:"):
        follow(sys.argv[1], sys.argv[2:])
    else:
        post(sys.argv[1], sys.argv[2], sys.argv[3:])
