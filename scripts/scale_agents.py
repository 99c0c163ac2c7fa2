#!/usr/bin/env python3
"""Many agents through one broker on this machine: what they cost and how quick they are.

    scripts/scale_agents.py [--agents 100] [--seconds 20] [--rate 10] [--bin build/bin]

Each agent is a hub with the stub modules SSM and SRM; all are joined by one Mosquitto (Debian
package mosquitto). Prints, in this order: how long until all are there; memory and processor time
while nothing goes on; the time there and back of one question to another agent's module; and the
same while every agent asks RATE questions a second of agents taken at random.
"""
import argparse
import json
import os
import random
import re
import selectors
import shutil
import socket
import subprocess
import sys
import tempfile
import time

PATIENCE_S = 180
TICKS = os.sysconf("SC_CLK_TCK")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def children(pid):
    with open(f"/proc/{pid}/task/{pid}/children") as file:
        return [int(word) for word in file.read().split()]


def cpu_s(pid):
    with open(f"/proc/{pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def memory_mib(pid):
    """Its share of what it uses (shared pages divided among those who share them)."""
    with open(f"/proc/{pid}/smaps_rollup") as file:
        return int(re.search(r"^Pss:\s+(\d+)", file.read(), re.M)[1]) / 1024


class Agent:
    def __init__(self, number, folder, broker_port, programs):
        self.name = f"A{number}"
        self.path = os.path.join(folder, self.name)
        config = self.path + ".json"
        modules = [{"name": name, "command": [os.path.join(programs, program)]}
                   for name, program in (("SSM", "ssm_stub"), ("SRM", "srm_stub"))]
        with open(config, "w") as file:
            json.dump({"listen": [{"at": "unix:" + self.path, "role": "owner"}], "modules": modules,
                       "mqtt": {"broker": f"tcp:127.0.0.1:{broker_port}", "agent": self.name}}, file)
        self.said = open(self.path + ".said", "wb")
        self.process = subprocess.Popen(
            [os.path.join(programs, "agent_manager"), "--config", config, "--no-console"],
            stderr=self.said)
        self.buffer = b""
        self.sent = {}

    def connect(self, limit):
        while True:
            self.socket = socket.socket(socket.AF_UNIX)
            try:
                return self.socket.connect(self.path)
            except OSError:
                self.socket.close()
                if time.monotonic() > limit or self.process.poll() is not None:
                    raise
                time.sleep(0.02)

    def ask(self, other, number):
        tag = f"q{number}"
        self.sent[tag] = time.perf_counter()
        self.socket.sendall(f"to @{other.name}/SSM inq#{tag} Speak.stat\n".encode())

    def read(self, times, faults):
        more = self.socket.recv(1 << 16)
        if not more:
            sys.exit(f"{self.name} has closed its connection")
        now = time.perf_counter()
        *lines, self.buffer = (self.buffer + more).split(b"\n")
        for line in lines:
            answer = re.search(rb"rep#(\S+) (\S+) = (.*)", line)
            if answer and answer[1].decode() in self.sent:
                times.append(now - self.sent.pop(answer[1].decode()))
                if answer[2].endswith(b".error"):
                    faults.append((answer[1].decode(), answer[3].decode(errors="replace")))


class Stage:
    """All processes, asked together."""

    def __init__(self, agents, broker):
        self.agents, self.broker = agents, broker
        self.selector = selectors.DefaultSelector()
        for agent in agents:
            self.selector.register(agent.socket, selectors.EVENT_READ, agent)

    def pids(self):
        hubs = [agent.process.pid for agent in self.agents]
        return {"broker": [self.broker.pid], "hubs": hubs,
                "modules": [child for hub in hubs for child in children(hub)]}

    def measure_cpu(self, run):
        pids = self.pids()
        before = {name: sum(map(cpu_s, group)) for name, group in pids.items()}
        start = time.monotonic()
        run()
        seconds = time.monotonic() - start
        return {name: 100 * (sum(map(cpu_s, group)) - before[name]) / seconds
                for name, group in pids.items()}

    def take(self, wait_s, times, faults):
        for key, _ in self.selector.select(wait_s):
            key.data.read(times, faults)

    def wait_for_all(self, times, faults):
        limit = time.monotonic() + PATIENCE_S
        while any(agent.sent for agent in self.agents):
            if time.monotonic() > limit:
                sys.exit(f"{sum(len(agent.sent) for agent in self.agents)} questions are unanswered")
            self.take(0.5, times, faults)


def shown(times):
    times = sorted(times)
    pick = lambda share: times[min(len(times) - 1, int(share * len(times)))] * 1000
    return f"p50 {pick(0.5):.2f} ms, p99 {pick(0.99):.2f} ms, worst {times[-1] * 1000:.1f} ms"


def shown_cpu(cpu):
    return ", ".join(f"{name} {share:.1f} %" for name, share in cpu.items()) + " of one processor"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--agents", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--rate", type=float, default=10)
    parser.add_argument("--bin", default="build/bin")
    options = parser.parse_args()
    mosquitto = shutil.which("mosquitto", path=os.environ["PATH"] + ":/usr/sbin")
    if not mosquitto:
        sys.exit("install the Debian package mosquitto")
    programs = os.path.abspath(options.bin)
    with tempfile.TemporaryDirectory() as folder:
        port = free_port()
        with open(os.path.join(folder, "mosquitto.conf"), "w") as file:
            file.write(f"listener {port} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\nlog_type error\n"
                       "max_inflight_messages 1000\nmax_queued_messages 100000\n")
        broker = subprocess.Popen([mosquitto, "-c", file.name])
        started = time.monotonic()
        agents = []
        try:
            for number in range(options.agents):
                agents.append(Agent(number, folder, port, programs))
            for agent in agents:
                agent.connect(started + PATIENCE_S)
            stage = Stage(agents, broker)
            times, faults = [], []
            # Each is there once its right neighbour's voice answers it.
            waiting = set(range(len(agents)))
            while waiting:
                for number in waiting:
                    agents[number].ask(agents[(number + 1) % len(agents)], number)
                stage.wait_for_all(times, faults)
                waiting = {int(tag[1:]) for tag, text in faults}
                if waiting and time.monotonic() > started + PATIENCE_S:
                    sys.exit(f"{len(waiting)} agents are not reached: {faults[0][1]}")
                faults.clear()
                time.sleep(0.2 if waiting else 0)
            print(f"{len(agents)} agents, {sum(map(len, stage.pids().values()))} processes, "
                  f"there after {time.monotonic() - started:.1f} s")
            time.sleep(3)
            memory = {name: [memory_mib(pid) for pid in group] for name, group in stage.pids().items()}
            print("memory:   " + ", ".join(f"{name} {sum(each):.0f} MiB ({sum(each) / len(each):.1f} each)"
                                           for name, each in memory.items()))
            print("idle:     " + shown_cpu(stage.measure_cpu(lambda: time.sleep(options.seconds))))
            times, faults = [], []
            for number in range(10 * len(agents)):
                agents[0].ask(agents[1 + number % (len(agents) - 1)], number)
                stage.wait_for_all(times, faults)
            # The first one to each agent also subscribes to it.
            print(f"one question at a time: {shown(times[len(agents):])} there and back")
            times, faults, asked = [], [], 0

            def load():
                nonlocal asked
                start = time.monotonic()
                while (now := time.monotonic() - start) < options.seconds:
                    while asked < now * options.rate * len(agents):
                        one, other = random.sample(agents, 2)
                        one.ask(other, asked)
                        asked += 1
                    stage.take(0.002, times, faults)
                stage.wait_for_all(times, faults)

            cpu = stage.measure_cpu(load)
            print(f"{options.rate * len(agents):.0f} questions a second: {shown(times)}; {asked} asked, "
                  f"{len(times)} answered, {len(faults)} refused {faults[:1] if faults else ''}\n          {shown_cpu(cpu)}")
        finally:
            for agent in agents:
                agent.process.terminate()
            for agent in agents:
                agent.process.wait(30)
            broker.terminate()
            broker.wait(30)


main()
