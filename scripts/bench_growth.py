#!/usr/bin/env python3
"""How the hub grows: memory and the time a message takes with 2, 10, 100, 1000 modules.

    scripts/bench_growth.py [--bin build/bin] [--modules 2 10 100 1000]

Modules come over a Unix socket, say they live, answer the hub's question about their clock and are
idle but for that. Two clients pass a message back and forth 3000 times; printed is half of a there
and back, in microseconds, which includes this script's own share.
"""
import argparse
import json
import os
import re
import selectors
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time


def connect(path):
    while True:  # the hub may still be starting
        try:
            one = socket.socket(socket.AF_UNIX)
            one.connect(path)
            return one
        except OSError:
            one.close()
            time.sleep(0.01)


def read_line(one):
    text = b""
    while not text.endswith(b"\n"):
        more = one.recv(65536)
        if not more:
            sys.exit("the hub has closed a connection")
        text += more
    return text


class Idle:
    """Modules that only answer the hub."""

    def __init__(self, path, count):
        self.selector = selectors.DefaultSelector()
        self.began = time.monotonic()
        self.answered = 0
        for i in range(count):
            one = connect(path)
            one.sendall(f"to @AM set Name = IDLE{i}\nrep Run = LIVE\n".encode())
            self.selector.register(one, selectors.EVENT_READ)
        self.thread = threading.Thread(target=self.answer, daemon=True)
        self.thread.start()

    def answer(self):
        while True:
            for key, _ in self.selector.select():
                for line in key.fileobj.recv(65536).split(b"\n"):
                    asked = re.match(rb"(set|inq)#(\S+) Clock(\.mode)?", line)
                    if not asked:
                        continue
                    ms = (time.monotonic() - self.began) * 1000
                    key.fileobj.sendall(b"rep#%s Clock%s = %.3f\n" % (
                        asked.group(2), asked.group(3) or b"", ms))
                    self.answered += 1


def rss_mib(pid):
    with open(f"/proc/{pid}/status") as file:
        return int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1)) / 1024


def cpu_s(pid):
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure(program, count):
    with tempfile.TemporaryDirectory() as folder:
        path, config = os.path.join(folder, "hub"), os.path.join(folder, "hub.json")
        with open(config, "w") as file:
            json.dump({"listen": ["unix:" + path], "limits": {"peers": 10000}}, file)
        hub = subprocess.Popen([program, "--config", config, "--no-console"],
                               stderr=subprocess.DEVNULL)
        try:
            a, b = connect(path), connect(path)
            for one, name in ((a, b"A"), (b, b"B")):
                one.sendall(b"to @AM set#n Name = " + name + b"\n")
                read_line(one)
            empty = rss_mib(hub.pid)
            idle = Idle(path, count)
            while idle.answered < 6 * count:  # asked what they are, and for their clocks
                time.sleep(0.01)
            full = rss_mib(hub.pid)
            used, began = cpu_s(hub.pid), time.monotonic()
            time.sleep(6)
            busy = (cpu_s(hub.pid) - used) / (time.monotonic() - began)
            times = []
            for _ in range(3000):
                start = time.perf_counter()
                a.sendall(b"to @B set Load = " + b"x" * 47 + b"\n")
                read_line(b)
                b.sendall(b"to @A set Load = " + b"x" * 47 + b"\n")
                read_line(a)
                times.append((time.perf_counter() - start) / 2 * 1e6)
            times.sort()
            return {"modules": count, "memory_mib": round(full, 1),
                    "kib_per_module": round((full - empty) * 1024 / count, 1),
                    "idle_cpu_percent": round(busy * 100, 2),
                    "p50_us": round(statistics.median(times), 1),
                    "p99_us": round(times[int(len(times) * 0.99)], 1)}
        finally:
            hub.kill()
            hub.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bin", default="build/bin")
    parser.add_argument("--modules", type=int, nargs="+", default=[2, 10, 100, 1000])
    options = parser.parse_args()
    for count in options.modules:
        print(json.dumps(measure(os.path.join(options.bin, "agent_manager"), count)), flush=True)


main()
