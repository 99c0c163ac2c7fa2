#!/usr/bin/env python3
"""Days of dialogue on the virtual clock, each utterance checked:

    scripts/soak.py [--days 7] [--minutes 70] [--dense] [--bin build/bin] [--seed 1]

The hub in lockstep with the stub voice, the stub ear and the face (no pictures are drawn): somebody
says something to the ear, the agent answers, and some seconds pass. As in a museum: visitors of 3 to
12 exchanges come every now and then for eight hours, and at night nobody does; with --dense they come
one after the other day and night. Everything that passes through the hub is seen, and for each
exchange
 - voice and face begin at one and the same instant, and both end;
 - every message is there, once, in its order: for one sentence what each party says, with times
   counted from the beginning, is the same to the microsecond each time it is said, days apart;
 - what was said to the ear is its result.
In the end no process uses more memory than after the first tenth, but for a tenth and 4 MiB. Stops
after so many days of the session's clock, or minutes of ours, whichever comes first, and says which.
"""
import argparse
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import threading
import time

WORDS = """good morning how may I help you the museum closes at six would like to see map it is on
second floor please wait moment do not touch paintings thank for your visit today we have an
exhibition of old instruments from north""".split()
AHEAD = 40  # exchanges said to the hub before they are done
OPEN_MS, NIGHT_MS = 8 * 3_600_000, 16 * 3_600_000
EXCHANGE_MS = 8_000  # about what one takes, to know when the museum closes
DAY_MS = 86_400_000


def sentences(count):
    return [" ".join(random.choice(WORDS) for _ in range(random.randint(2, 12))) + "."
            for _ in range(count)]


class Hub:
    def __init__(self, folder, programs):
        config = os.path.join(folder, "soak.json")
        path = lambda name: os.path.join(os.path.abspath(programs), name)
        with open(config, "w") as file:
            json.dump({"clock": "virtual", "modules": [
                {"name": "SSM", "command": [path("ssm_stub")], "restart": "never"},
                {"name": "SRM", "command": [path("srm_stub")], "restart": "never"},
                {"name": "FSM", "command": [path("fsm"), "--headless"], "restart": "never"}]}, file)
        self.said = open(os.path.join(folder, "said"), "w+")
        self.process = subprocess.Popen([path("agent_manager"), "--config", config],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.said)

    def memory_mib(self):
        with open(f"/proc/{self.process.pid}/task/{self.process.pid}/children") as file:
            pids = [self.process.pid] + [int(word) for word in file.read().split()]
        sizes = {}
        for pid in pids:
            with open(f"/proc/{pid}/status") as file:
                text = file.read()
            sizes[re.search(r"Name:\s+(\S+)", text)[1]] = int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1024
        return sizes


def pauses(dense):
    """After each exchange, in ms."""
    while True:
        day = 0
        while dense or day < OPEN_MS:
            visit = [random.randint(2_000, 10_000) for _ in range(random.randint(3, 12))]
            if not dense:
                visit[-1] = random.randint(20_000, 300_000)
            day += sum(visit) + EXCHANGE_MS * len(visit)
            if not dense and day >= OPEN_MS:
                visit[-1] = NIGHT_MS
            yield from visit


class Speaker(threading.Thread):
    """Says the exchanges to the hub, not too far ahead of what is done."""

    def __init__(self, hub, choice, dense):
        super().__init__(daemon=True)
        self.hub, self.choice, self.pauses = hub, choice, pauses(dense)
        self.room = threading.Semaphore(AHEAD)
        self.ending = False
        self.said = []  # (sentence, pause) by number

    def run(self):
        pipe = self.hub.process.stdin
        try:
            pipe.write(b"set Flow = ON\nto @SRM set#pace Input.wordtime = 120\nto @SRM set#listen Listen = START\nset Wait = IDLE\n")
            while True:
                self.room.acquire()
                if self.ending:
                    break
                number, sentence = len(self.said), random.choice(self.choice)
                self.said.append(sentence)
                pipe.write((f"to @AM inq#begin{number} Clock\n"
                            f"to @SRM set#heard{number} Input.text = {sentence}\nset Wait = IDLE\n"
                            f"to @AM-MCL set#spoken{number} Speak = {sentence}\nset Wait = IDLE\n"
                            f"to @AM inq#end{number} Clock\n"
                            f"set Wait = {next(self.pauses)}\n").encode())
                pipe.flush()
            pipe.close()
        except BrokenPipeError:
            pass


class Checker:
    """Takes the flow exchange by exchange."""

    def __init__(self, speaker):
        self.speaker = speaker
        self.known = {}  # sentence -> its flow
        self.flow, self.number, self.clock = None, 0, 0.0
        self.messages = 0

    def take(self, line):
        if not line.startswith("# flow "):
            return
        time_ms, sender, receivers, text = line[7:].split("\t", 3)
        self.clock = float(time_ms)
        self.messages += 1
        if text.startswith(f"From @AM rep#begin{self.number} "):
            self.flow, self.begin = [], self.clock
        elif text.startswith(f"From @AM rep#end{self.number} "):
            self.check(self.speaker.said[self.number])
            self.flow = None
            self.number += 1
            self.speaker.room.release()
        elif self.flow is not None:
            relative = lambda found: f"@{float(found[1]) - self.begin:.3f}"
            plain = re.sub(r"(#[a-z]+)\d+", r"\1", re.sub(r"@(\d+(?:\.\d+)?)$", relative, text))
            self.flow.append((round(self.clock - self.begin, 3), sender, receivers, plain))

    def check(self, sentence):
        flow = self.flow
        where = f"exchange {self.number}, '{sentence}', at {self.begin:.0f} ms: "
        starts = {receiver: text.rsplit("@", 1)[1] for _, _, receiver, text in flow
                  if re.fullmatch(r"to @(SSM|FSM) set(#\S+)? Speak = @[\d.-]+", text)}
        if len(starts) != 2 or len(set(starts.values())) != 1:
            raise AssertionError(where + f"voice and face begin at {starts}")
        begin = float(next(iter(starts.values())))
        for module in ("SSM", "FSM"):
            states = [(at, text.rsplit(" ", 1)[1]) for at, sender, _, text in flow
                      if sender == module and "rep Speak.stat = " in text]
            speaking = [at for at, state in states if state == "SPEAKING"]
            if speaking != [begin] or states[-1][1] != "IDLE":
                raise AssertionError(where + f"@{module}, to begin at {begin}, says {states}")
        if not any(sender == "SRM" and text.endswith("Result = " + sentence.rstrip(".").lower())
                   or sender == "SRM" and "Result = " in text and sentence.rstrip(".") in text
                   for _, sender, _, text in flow):
            raise AssertionError(where + "the ear has not heard it")
        # Which of two parties comes first within one instant is left to the system.
        parties = {}
        for at, sender, receivers, text in flow:
            parties.setdefault(sender, []).append((at, receivers, text))
        for party, said in self.known.setdefault(sentence, parties).items():
            if said != parties.get(party):
                differs = next((pair for pair in zip(said, parties.get(party, [])) if pair[0] != pair[1]),
                               (len(said), len(parties.get(party, []))))
                raise AssertionError(where + f"@{party}, not as the first time: {differs}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--days", type=float, default=7)
    parser.add_argument("--minutes", type=float, default=70)
    parser.add_argument("--dense", action="store_true")
    parser.add_argument("--bin", default="build/bin")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random.seed(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        hub = Hub(folder, options.bin)
        speaker = Speaker(hub, sentences(60), options.dense)
        checker = Checker(speaker)
        memory = []
        start = said_at = time.monotonic()
        speaker.start()
        try:
            for line in hub.process.stdout:
                checker.take(line.decode().rstrip("\n"))
                now = time.monotonic()
                if now - said_at > 10 and checker.number:
                    memory.append((checker.number, hub.memory_mib()))
                    said_at = now
                    print(f"{(now - start) / 60:5.1f} min: {checker.clock / DAY_MS:.3f} days, "
                          f"{checker.number} exchanges, {checker.messages} messages, " +
                          ", ".join(f"{name} {mib:.1f} MiB" for name, mib in memory[-1][1].items()), flush=True)
                if checker.clock > options.days * DAY_MS or now - start > options.minutes * 60:
                    speaker.ending = True
                    speaker.room.release()
        except AssertionError as error:
            hub.process.kill()
            sys.exit(str(error))
        code = hub.process.wait()
        hub.said.seek(0)
        said = hub.said.read()
        minutes = (time.monotonic() - start) / 60
        days = checker.clock / DAY_MS
        print(f"{days:.3f} days in {minutes:.1f} minutes ({days / minutes * 60:.2f} days an hour): {checker.number} of "
              f"{len(speaker.said)} exchanges in step, {checker.messages} messages, exit code {code}")
        if code != 0 or checker.number != len(speaker.said):
            sys.exit(f"the hub ended badly:\n{said[-2000:]}")
        tenth = [sizes for number, sizes in memory if number >= checker.number / 10]
        for name in tenth[0] if tenth else []:
            if max(sizes[name] for sizes in tenth) > tenth[0][name] * 1.1 + 4:
                sys.exit(f"the memory of {name} has grown: {[round(sizes[name], 1) for sizes in tenth]}")
        print("stopped " + ("by its days" if days >= options.days else "by its minutes, short of its days"))


main()
