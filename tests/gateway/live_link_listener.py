#!/usr/bin/env python3
"""Reads what Live Link Face sends, as a receiver that knows nothing of us does.

Prints its port, then a line of JSON for each packet. A packet is: version 6; the device's id and the subject's name, each with
its length before it; frame number, part of a frame, rate and divisor; a count of 61, and as many floats. All big-endian.
Ends after --packets N of them, or with 1 and a sentence at what is wrong.
"""
import argparse
import json
import socket
import struct
import sys


def parse(packet):
    version, length = struct.unpack_from("!Bi", packet)
    at = 5
    device = packet[at:at + length].decode()
    at += length
    (length,) = struct.unpack_from("!i", packet, at)
    at += 4
    subject = packet[at:at + length].decode()
    at += length
    frame, part, rate, divisor, count = struct.unpack_from("!IfIIB", packet, at)
    values = struct.unpack_from(f"!{count}f", packet, at + 17)
    if version != 6 or len(device) != 36 or count != 61 or len(packet) != at + 17 + 4 * count or not 0 <= part < 1:
        sys.exit(f"live_link_listener: wrong: version {version}, id {device!r}, {count} values, {len(packet)} bytes, part {part}")
    return {"subject": subject, "seconds": (frame + part) * divisor / rate, "values": values}


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--packets", type=int, required=True)
    given = options.parse_args()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as place:
        place.bind(("127.0.0.1", 0))
        place.settimeout(60)
        print(place.getsockname()[1], flush=True)
        for _ in range(given.packets):
            print(json.dumps(parse(place.recv(65536))), flush=True)


if __name__ == "__main__":
    main()
