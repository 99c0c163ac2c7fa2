#!/usr/bin/env python3
"""Faults on purpose while counted messages flow through the hub:

    scripts/fault_rounds.py [--rounds 1000] [--seed 1] [--bin build/bin]

Each round does something bad: kills or stops a module, sends garbage, floods, reads slowly, cuts a
connection in the middle of a line, delays one, lets a clock jump or the hub itself stand still, asks
for more than there is, reads the configuration again. Then numbered messages must still arrive at another client, none lost, doubled or out of order; every
module must answer again; and what the hub says about the round must explain it. At the end the
hub's memory must be what it was after the first tenth of the rounds, within a tenth and 4 MiB.
The session log is on a full disk (/dev/full) all the time. Needs the test_module of the tests.
"""
import argparse
import json
import os
import random
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

PATIENCE_S = 30
MODULES = ["M0", "M1", "M2"]


class Client:
    def __init__(self, path, name=None):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.socket.settimeout(PATIENCE_S)
        self.buffer = b""
        if name:
            self.say(f"to @AM set#n Name = {name}")
            self.expect("rep#n Name = ")

    def say(self, line):
        self.socket.sendall(line.encode() + b"\n")

    def line(self):
        while b"\n" not in self.buffer:
            more = self.socket.recv(1 << 16)
            if not more:
                raise EOFError("the hub has closed the connection")
            self.buffer += more
        line, self.buffer = self.buffer.split(b"\n", 1)
        return line.decode(errors="replace")  # garbage may have been taken for EUC-JP, and is answered in it

    def expect(self, part):
        while True:
            line = self.line()
            if part in line:
                return line

    def close(self):
        self.socket.close()


class Jumper:
    """A module whose clock jumps when it is told to."""

    def __init__(self, path):
        self.client = Client(path, "JUMPS")
        self.jump_ms = 0.0
        self.client.say("rep Run = LIVE")
        threading.Thread(target=self.answer, daemon=True).start()

    def answer(self):
        try:
            while True:
                line = self.client.line()
                asked = re.match(r"(?:inq|set)(#\S+) (\S+)", line)
                if asked:
                    value = f"{time.monotonic() * 1000 + self.jump_ms:.3f}" if asked[2] == "Clock" else "0"
                    self.client.say(f"rep{asked[1]} {asked[2]} = {value}")
        except (OSError, EOFError):
            pass


class DelayedLine:
    """Between a client and the hub: bytes pass late, in odd pieces, and in their order."""

    def __init__(self, folder, path):
        self.path = os.path.join(folder, f"late{random.getrandbits(40)}")
        self.listener = socket.socket(socket.AF_UNIX)
        self.listener.bind(self.path)
        self.listener.listen(1)
        threading.Thread(target=self.serve, args=(path,), daemon=True).start()

    def serve(self, path):
        near, _ = self.listener.accept()
        far = socket.socket(socket.AF_UNIX)
        far.connect(path)
        self.ends = (near, far)
        for read, write in ((near, far), (far, near)):
            threading.Thread(target=self.pump, args=(read, write), daemon=True).start()

    @staticmethod
    def pump(read, write):
        try:
            while True:
                piece = read.recv(random.choice((1, 7, 64, 4096)))
                if not piece:
                    return write.shutdown(socket.SHUT_WR)
                time.sleep(random.uniform(0, 0.003))
                write.sendall(piece)
        except OSError:
            pass

    def close(self):
        self.listener.close()
        for end in self.ends:
            try:
                end.shutdown(socket.SHUT_RDWR)  # a thread that reads keeps what is only closed
            except OSError:
                pass
            end.close()
        os.unlink(self.path)


class Flow:
    """Numbered messages from one client to another, checked as they come."""

    def __init__(self, path):
        self.sender, self.receiver = Client(path, "COUNTS"), Client(path, "HEARS")
        self.sent = self.heard = 0
        self.fault = None
        self.changed = threading.Condition()
        self.ending = False
        self.threads = [threading.Thread(target=run, daemon=True) for run in (self.send, self.hear)]
        for thread in self.threads:
            thread.start()

    def send(self):
        while not self.ending and not self.fault:
            with self.changed:
                if self.sent - self.heard > 500:
                    self.changed.wait(0.05)
                    continue
                first = self.sent
                self.sent += 10
            try:
                self.sender.socket.sendall(
                    "".join(f"to @HEARS set N = {i}\n" for i in range(first, first + 10)).encode())
            except OSError as error:
                self.fail(f"the sender: {error}")
            time.sleep(0.002)

    def hear(self):
        while not self.fault:
            try:
                line = self.receiver.line()
            except (OSError, EOFError) as error:
                return self.fail(f"the receiver: {error}")
            if line != f"set N = {self.heard}":
                return self.fail(f"heard '{line[:80]}', expected number {self.heard}")
            with self.changed:
                self.heard += 1
                self.changed.notify_all()

    def fail(self, text):
        if not self.ending:
            self.fault = self.fault or text
        with self.changed:
            self.changed.notify_all()

    def wait_for_more(self, count):
        with self.changed:
            wanted = self.heard + count
            self.changed.wait_for(lambda: self.heard >= wanted or self.fault, PATIENCE_S)
            if self.fault:
                raise AssertionError(self.fault)
            if self.heard < wanted:
                raise AssertionError(f"messages have stopped at number {self.heard}")


class Round:
    """What can go wrong. Each returns what the hub must say about it, as a pattern, or None."""

    def __init__(self, hub):
        self.hub = hub

    def pid(self, name):
        self.hub.admin.say(f"inq#p Module.{name}.pid")
        return int(self.hub.admin.expect("rep#p ").rsplit(" ", 1)[1])

    def signal(self, name, what):
        pid = self.pid(name)
        if pid > 0:
            try:
                os.kill(pid, what)
            except ProcessLookupError:
                pass
        return pid > 0

    def kill(self):
        name = random.choice(MODULES)
        return self.signal(name, signal.SIGKILL) and f"@{name} killed by signal 9"

    def terminate(self):
        name = random.choice(MODULES)
        self.signal(name, signal.SIGTERM)  # an orderly end: it is only started again

    def stop_for_a_moment(self):
        name = random.choice(MODULES)
        if self.signal(name, signal.SIGSTOP):
            time.sleep(random.uniform(0, 0.1))
            self.signal(name, signal.SIGCONT)

    def stop_for_good(self):
        name = random.choice(MODULES)
        return self.signal(name, signal.SIGSTOP) and f"@{name} killed by signal 9.*inq Run"

    def garbage(self):
        client = Client(self.hub.path)
        client.socket.sendall(random.randbytes(random.randint(1, 5000)) + b"\n")
        client.say("inq#g Clock")
        client.expect("rep#g Clock")
        client.close()
        return r"@CLIENT\d+: "

    def flood(self):
        client = Client(self.hub.path)
        client.socket.sendall(b"to @M1 inq X\n" * random.randint(1, 3000))
        client.close()

    def slow_reader(self):
        slow, loud = Client(self.hub.path), Client(self.hub.path)
        name = f"LOUD{random.getrandbits(40)}"
        loud.say(f"to @AM set#n Name = {name}")
        loud.expect("rep#n Name = ")
        slow.say(f"to @AM set#s Subscribe = {name}")
        slow.expect("rep#s Subscribe")
        for _ in range(90):  # more than the hub keeps for one reader
            loud.say("rep Big = " + "x" * 60000)
        loud.say("inq#l Clock")
        loud.expect("rep#l Clock")
        loud.close()
        slow.close()
        return "the reader is too slow"

    def cut(self):
        client = Client(self.hub.path)
        client.socket.sendall(b"to @M2 set X = 1\nto @M2 set#x X ="[:random.randint(1, 34)])
        client.close()

    def delayed(self):
        line = DelayedLine(self.hub.folder, self.hub.path)
        name = f"LATE{random.getrandbits(40)}"
        client = Client(line.path, name)
        for i in range(50):
            client.say(f"to @{name} set N = {i}")
        for i in range(50):
            heard = client.line()
            if heard != f"set N = {i}":
                raise AssertionError(f"over a delayed line: heard '{heard}', expected number {i}")
        client.socket.sendall(b"to @M0 set#x X ="[:random.randint(1, 16)])
        line.close()
        client.close()

    def clock_jump(self):
        jump_ms = random.choice((-1, 1)) * random.uniform(100, 3_600_000)
        before = self.hub.clock_offset("JUMPS")
        self.hub.jumper.jump_ms += jump_ms
        limit = time.monotonic() + PATIENCE_S
        while abs(self.hub.clock_offset("JUMPS") - before - jump_ms) > 20:
            if time.monotonic() > limit:
                raise AssertionError(f"the hub has not followed a clock that has jumped by {jump_ms} ms")
            time.sleep(0.05)

    def hub_stands_still(self):
        self.hub.process.send_signal(signal.SIGSTOP)
        time.sleep(random.uniform(0.1, 1))
        self.hub.process.send_signal(signal.SIGCONT)

    def oversized(self):
        client = Client(self.hub.path)
        client.socket.sendall(b"x" * 100000 + b"\n")
        client.expect("TOO_LONG")
        client.close()
        return "TOO_LONG"

    def nobody(self):
        self.hub.admin.say("to @NOBODY set#u X = 1")
        self.hub.admin.expect("rep#u X.error = UNKNOWN_MODULE")

    def reload(self):
        self.hub.admin.say("set#l Reload = NOW")
        self.hub.admin.expect("rep#l Reload")
        return "the configuration was read again"


class Hub:
    def __init__(self, folder, programs):
        self.folder = folder
        self.path = os.path.join(folder, "hub")
        module = os.path.abspath(os.path.join(programs, "test_module"))
        config = os.path.join(folder, "hub.json")
        with open(config, "w") as file:
            json.dump({
                "listen": [{"at": "unix:" + self.path, "role": "owner"}], "log": "/dev/full",
                "modules": [{"name": name, "command": [module],
                             "restart": {"when": "always", "first_ms": 1, "longest_ms": 50,
                                         "tries": 1000000, "within_ms": 1000},
                             "health": {"every_ms": 100, "within_ms": 300, "misses": 2}}
                            for name in MODULES]}, file)
        self.said_path = os.path.join(folder, "said")
        self.process = subprocess.Popen(
            [os.path.join(programs, "agent_manager"), "--config", config, "--no-console"],
            stderr=open(self.said_path, "wb"))
        limit = time.monotonic() + PATIENCE_S
        while True:
            try:
                self.admin = Client(self.path, "ADMIN")
                break
            except OSError as error:
                if time.monotonic() > limit:
                    sys.exit(f"the hub did not start: {error}")
                time.sleep(0.02)
        self.read_to = 0
        self.jumper = Jumper(self.path)
        self.clock_offset("JUMPS")

    def clock_offset(self, name):
        limit = time.monotonic() + PATIENCE_S
        while True:
            self.admin.say("inq#c Clocks")
            found = re.search(rf"\b{name} (-?[\d.]+) ", self.admin.expect("rep#c Clocks"))
            if found:
                return float(found[1])
            if time.monotonic() > limit:
                raise AssertionError(f"the hub does not know the clock of @{name}")
            time.sleep(0.02)

    def said(self):
        """What it has said since the round began."""
        with open(self.said_path, errors="replace") as file:
            file.seek(self.read_to)
            return file.read()

    def mark(self):
        self.read_to = os.path.getsize(self.said_path)

    def wait_until_well(self):
        limit = time.monotonic() + PATIENCE_S
        for name in MODULES:
            while True:
                self.admin.say(f"to @{name} inq#w X")
                if ".error" not in self.admin.expect("rep#w X"):
                    break
                if time.monotonic() > limit:
                    raise AssertionError(f"@{name} does not come back")
                time.sleep(0.005)

    def wait_until_said(self, pattern):
        limit = time.monotonic() + PATIENCE_S
        while not re.search(pattern, self.said()):
            if time.monotonic() > limit:
                raise AssertionError(f"the hub has not said '{pattern}' but:\n{self.said()}")
            time.sleep(0.005)

    def memory_mib(self):
        with open(f"/proc/{self.process.pid}/status") as file:
            return int(re.search(r"VmRSS:\s+(\d+)", file.read()).group(1)) / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bin", default="build/bin")
    options = parser.parse_args()
    random.seed(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        hub = Hub(folder, options.bin)
        hub.wait_until_well()
        flow = Flow(hub.path)
        faults = [getattr(Round, name) for name in vars(Round)
                  if not name.startswith("_") and name not in ("pid", "signal")]
        counts, memory = {}, []
        start = time.monotonic()
        try:
            for number in range(options.rounds):
                fault = random.choice(faults)
                counts[fault.__name__] = counts.get(fault.__name__, 0) + 1
                hub.mark()
                try:
                    explained = fault(Round(hub))
                    flow.wait_for_more(50)
                    if explained:
                        hub.wait_until_said(explained)
                    hub.wait_until_well()
                except (AssertionError, OSError, EOFError) as error:
                    sys.exit(f"round {number}, {fault.__name__}: {error}\n{hub.said()}")
                if hub.process.poll() is not None:
                    sys.exit(f"round {number}, {fault.__name__}: the hub has ended\n{hub.said()}")
                memory.append(hub.memory_mib())
        finally:
            flow.ending = True
            hub.process.terminate()
        code = hub.process.wait(PATIENCE_S)
        early, late = max(memory[:max(1, len(memory) // 10)]), memory[-1]
        print(f"{options.rounds} rounds in {time.monotonic() - start:.0f} s, {flow.heard} messages in order, "
              f"memory {early:.1f} -> {late:.1f} MiB (by tenths " +
              " ".join(f"{mib:.1f}" for mib in memory[len(memory) // 20::max(1, len(memory) // 10)]) +
              f"), exit code {code}; " +
              ", ".join(f"{name} {count}" for name, count in sorted(counts.items())))
        if code != 0 or late > early * 1.1 + 4:
            sys.exit("memory has grown, or the hub ended badly")


main()
