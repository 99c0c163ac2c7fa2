#!/usr/bin/env python3
"""Many clients at one hub, and one that floods it:

    scripts/crowd.py [--connections 20000] [--clients 1000] [--seconds 5] [--bin build/bin]

1. CONNECTIONS clients come over the Unix socket, ask one question and go, 200 at a time: every one must
   be answered; afterwards the hub must hold no more descriptors than before, and no more memory than after the
   first tenth, within a tenth and 4 MiB.
2. CLIENTS clients are there at once; each sends numbered messages to its neighbour for a while: none
   may be lost, doubled or reordered. Prints the time a message takes.
3. Two clients talk to each other while a third sends to a fourth, who reads, as fast as it can. Prints
   the time of the two without and with the flood: p50 and p99.
Ends with 1 if anything was lost. Needs no other program.
"""
import argparse
import json
import os
import resource
import selectors
import socket
import subprocess
import sys
import tempfile
import time


class Client:
    def __init__(self, path, name=None):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.buffer = b""
        if name:
            self.socket.sendall(f"set Subscribe = NONE\nto @AM set#n Name = {name}\n".encode())
            while b"rep#n Name" not in self.line():
                pass

    def line(self):
        while b"\n" not in self.buffer:
            more = self.socket.recv(1 << 16)
            if not more:
                raise EOFError("the hub has closed the connection")
            self.buffer += more
        line, self.buffer = self.buffer.split(b"\n", 1)
        return line


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(len(values) * share))] if values else float("nan")


def memory_mib(pid):
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmRSS:"))


def descriptors(pid):
    return len(os.listdir(f"/proc/{pid}/fd"))


def wait_until(true, what):
    end = time.monotonic() + 30
    while not true():
        if time.monotonic() > end:
            sys.exit(f"crowd: {what}")
        time.sleep(0.02)


def come_and_go(path, pid, connections):
    at_once = 200
    memory, before = memory_mib(pid), descriptors(pid)
    started = time.monotonic()
    for first in range(0, connections, at_once):
        clients = [Client(path) for _ in range(min(at_once, connections - first))]
        for client in clients:
            client.socket.sendall(b"set Subscribe = NONE\ninq#1 Run\n")
        for client in clients:
            while b"rep#1 Run = LIVE" not in client.line():
                pass
            client.socket.close()
        if first <= connections // 10:
            memory = max(memory, memory_mib(pid))
    took = time.monotonic() - started
    wait_until(lambda: descriptors(pid) <= before, "descriptors were not given back")
    grown = memory_mib(pid) - memory
    print(f"{connections} connections in {took:.1f} s, all answered; memory since the first tenth: "
          f"{grown:+.1f} MiB")
    if grown > 4 + memory / 10:
        sys.exit("crowd: the hub has grown")


def all_talk(path, count, seconds):
    clients = [Client(path, f"C{i}") for i in range(count)]
    selector = selectors.DefaultSelector()
    for i, client in enumerate(clients):
        client.socket.setblocking(False)
        selector.register(client.socket, selectors.EVENT_READ, i)
    sent, heard, times = [0] * count, [0] * count, []

    def say(i):
        line = f"to @C{(i + 1) % count} tell {sent[i]} {time.monotonic():.6f}\n"
        sent[i] += 1
        clients[i].socket.sendall(line.encode())

    end = time.monotonic() + seconds
    for i in range(count):
        say(i)
    while sum(heard) < sum(sent):
        ready = selector.select(timeout=20)
        if not ready:
            sys.exit(f"crowd: {sum(sent) - sum(heard)} of {sum(sent)} messages were lost")
        for key, _ in ready:
            client = clients[key.data]
            client.buffer += client.socket.recv(1 << 16)
            *lines, client.buffer = client.buffer.split(b"\n")
            for line in lines:
                _, sender, _, number, at = line.split()
                if int(sender[2:]) != (key.data - 1) % count or int(number) != heard[key.data]:
                    sys.exit(f"crowd: lost, doubled or out of order: {line.decode()}")
                heard[key.data] += 1
                times.append(time.monotonic() - float(at))
                if time.monotonic() < end:
                    say(key.data)
    for client in clients:
        client.socket.close()
    print(f"{count} clients, each with a message on its way: {sum(heard) / seconds:,.0f} messages/s (this "
          f"script's pace), none lost; p50 {percentile(times, 0.5) * 1e3:.2f} ms, p99 "
          f"{percentile(times, 0.99) * 1e3:.2f} ms")


def ping(one, other, seconds):
    times, end = [], time.monotonic() + seconds
    while time.monotonic() < end:
        began = time.perf_counter()
        one.socket.sendall(b"to @OTHER tell ping\n")
        other.line()
        times.append(time.perf_counter() - began)
    return f"p50 {percentile(times, 0.5) * 1e3:.3f} ms, p99 {percentile(times, 0.99) * 1e3:.3f} ms"


FLOOD = """
import socket, sys
flood = socket.socket(socket.AF_UNIX)
flood.connect(sys.argv[1])
piece = b"to @SINK tell of no use to anybody\\n" * 1000
while True:
    flood.sendall(piece)
"""
SINK = """
import socket, sys
sink = socket.socket(socket.AF_UNIX)
sink.connect(sys.argv[1])
sink.sendall(b"set Subscribe = NONE\\nto @AM set#n Name = SINK\\n")
while sink.recv(1 << 20):
    pass
"""


def flooded(path, seconds):
    one, other = Client(path, "ONE"), Client(path, "OTHER")
    print("two talk, quiet:  ", ping(one, other, seconds))
    sink = subprocess.Popen([sys.executable, "-c", SINK, path])
    wait_until(lambda: is_there(one, "SINK"), "the one who reads the flood did not come")
    flood = subprocess.Popen([sys.executable, "-c", FLOOD, path])
    time.sleep(0.5)
    print("two talk, flooded:", ping(one, other, seconds))
    for process in (flood, sink):
        process.kill()
        process.wait()


def is_there(client, name):
    client.socket.sendall(f"to @{name} tell hello\ninq#m Run\n".encode())
    there = True
    while True:
        line = client.line()
        if b"#m" in line:
            return there
        there = there and b"UNKNOWN_MODULE" not in line


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--connections", type=int, default=20000)
    parser.add_argument("--clients", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--bin", default="build/bin")
    options = parser.parse_args()
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "hub")
        config = os.path.join(folder, "hub.json")
        with open(config, "w") as file:
            json.dump({"listen": [f"unix:{path}"], "modules": [],
                       "limits": {"peers": options.clients + 300}}, file)
        hub = subprocess.Popen([os.path.join(options.bin, "agent_manager"), "--config", config, "--no-console"])
        try:
            wait_until(lambda: os.path.exists(path), "the hub did not open its socket")
            come_and_go(path, hub.pid, options.connections)
            all_talk(path, options.clients, options.seconds)
            flooded(path, options.seconds)
            if hub.poll() is not None:
                sys.exit("crowd: the hub has ended")
        finally:
            hub.terminate()
            hub.wait()


if __name__ == "__main__":
    main()
