#!/usr/bin/env python3
"""States how far the lips are from the sound, phoneme by phoneme, with the real programs.

usage: scripts/measure_lip_sync.py [real|virtual] [TEXT]

Starts the hub with the English voice (null sink, so no sound card is needed) and the face (headless),
records the sound and takes a report of every frame. The sound's place is read from its samples, the
mouth's from the frames; both clocks are brought to the session's by the offsets the hub measures.
Printed per phoneme: when its mouth shape was first drawn minus when its sound began. The ideal is
minus LipSync.lead, seen up to one frame late.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import wave

FRAMES_PER_SECOND = 60
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BIN = os.environ.get("GALATEA_BIN", os.path.join(ROOT, "build", "bin"))


def value_of(line):
    return line.split(" = ", 1)[1]


class Hub:
    def __init__(self, clock, folder):
        config = os.path.join(folder, "config.json")
        with open(config, "w") as file:
            json.dump({"clock": clock, "modules": [
                {"name": "SSM", "command": [BIN + "/ssm", "--sink", "null"]},
                {"name": "FSM", "command": [BIN + "/fsm", "--headless", "--size", "160x120"]}]}, file)
        self.process = subprocess.Popen([BIN + "/agent_manager", "--config", config], cwd=folder, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.frames = []
        self.phonemes = []

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def read_until(self, part):
        for line in self.process.stdout:
            line = line.rstrip("\n")
            if line.startswith("From @FSM rep Frame = "):
                number, time_ms, phoneme, *_ = value_of(line).split()
                self.frames.append((float(time_ms), phoneme))
            elif line.startswith("From @SSM rep Text.pho = "):
                items = value_of(line).replace("]", "").split()
                self.phonemes = [(name, float(ms)) for name, ms in (item.split("[") for item in items)]
            if part in line:
                if ".error" in line:
                    sys.exit("measure_lip_sync: " + line)
                return value_of(line) if " = " in line else line
        sys.exit("measure_lip_sync: the hub ended before '" + part + "'")

    def ask(self, receiver, slot):
        self.say(f"to @{receiver} inq#q {slot}")
        return self.read_until(f"rep#q {slot}")


def main():
    clock = sys.argv[1] if len(sys.argv) > 1 else "real"
    text = sys.argv[2] if len(sys.argv) > 2 else "Hello, my name is Galatea. I speak and look at you, and my lips keep in step with my voice."
    with tempfile.TemporaryDirectory() as folder:
        hub = Hub(clock, folder)
        hub.say(f"to @FSM set#f Record.fps = {FRAMES_PER_SECOND}")
        hub.read_until("rep#f ")
        lead = float(hub.ask("FSM", "LipSync.lead"))
        hub.say("to @FSM prop#f Frame = AutoOutput")
        hub.read_until("rep#f ")
        before = float(hub.ask("SSM", "Clock"))
        hub.say("to @SSM set#f Record = voice.wav")
        hub.read_until("rep#f ")
        after = float(hub.ask("SSM", "Clock"))
        hub.say("to @FSM set#f Record = film.mp4")
        hub.read_until("rep#f ")
        hub.say("to @AM-MCL set#f Speak = " + text)
        hub.read_until("rep#f Speak")
        offsets = {part.split()[0]: float(part.split()[1]) for part in hub.ask("AM", "Clocks").split(", ")}
        if clock == "virtual":
            offsets = dict.fromkeys(offsets, 0.0)
        for module in ("SSM", "FSM"):
            hub.say(f"to @{module} set#f Record = STOP")
            hub.read_until("rep#f ")
        hub.process.stdin.close()
        hub.process.stdout.read()
        hub.process.wait()
        with wave.open(os.path.join(folder, "voice.wav")) as sound:
            rate = sound.getframerate()
            samples = memoryview(sound.readframes(sound.getnframes())).cast("h")
    first = next(i for i, sample in enumerate(samples) if sample != 0)
    start = (before + after) / 2 - offsets["SSM"] + 1000 * first / rate
    print(f"{clock} clock, lead {lead:g} ms, {FRAMES_PER_SECOND} frames/s, start of the tape known to +-{(after - before) / 2:.2f} ms")

    frames = [(time_ms - offsets["FSM"], phoneme) for time_ms, phoneme in hub.frames]
    errors = []
    at = start
    for index, (name, duration) in enumerate(hub.phonemes):
        # The first frame of this phoneme near its place; names repeat, so look only around there.
        near = [t for t, phoneme in frames if phoneme == name and at - lead - 100 < t < at - lead + duration + 100]
        previous = hub.phonemes[index - 1][0] if index else None
        # One shorter than a frame may fall between two.
        if near and previous != name and duration > 1000 / FRAMES_PER_SECOND:
            offset = near[0] - at
            errors.append(offset + lead)
            print(f"  {name:4} sound at {at - start:7.1f} ms, mouth {offset:+6.1f} ms")
        at += duration
    absolute = sorted(abs(error) for error in errors)
    p95 = absolute[min(len(absolute) - 1, int(0.95 * len(absolute)))]
    print(f"{len(errors)} phonemes: beyond the lead, median {statistics.median(errors):+.1f} ms, "
          f"95th percentile {p95:.1f} ms, worst {absolute[-1]:.1f} ms (one frame is {1000 / FRAMES_PER_SECOND:.1f} ms)")


if __name__ == "__main__":
    main()
