#!/usr/bin/env python3
"""How soon the ear takes an utterance for over, and how often it cuts one in two:

    scripts/ear_endings.py [--bin build/bin] [--complete 0,250] RECORDING.wav...

Each recording is one utterance; it is heard by free dictation on the virtual clock, with half a second of quiet noise before
and 1.5 s behind it, once for each value of Listen.complete (0: Listen.silence alone). Printed are how many recordings were
heard as one, as several, or not at all; how many of those that the first value hears as one a later value cuts; and how
long after the last loud 10 ms the result came, in ms of sound: median and 90th percentile, without the time that decoding takes,
which is printed as seconds of processor time per second of sound.
"""
import argparse
import array
import json
import os
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import wave

RATE = 16000
BEFORE_S, BEHIND_S = 0.5, 1.5
NOISE = 20  # of 32768
LOUD = 0.03  # of the loudest 10 ms: -30 dB


def samples_of(path):
    run = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-ac", "1", "-ar", str(RATE), "-f", "s16le", "-"],
                         stdin=subprocess.DEVNULL, capture_output=True, check=True)
    return array.array("h", run.stdout)


def last_loud_ms(samples):
    size = RATE // 100
    levels = [max(map(abs, samples[at:at + size])) for at in range(0, len(samples) - size + 1, size)]
    most = max(levels)
    return 10 * (1 + max(i for i, level in enumerate(levels) if level > LOUD * most))


def noise(seconds, chance):
    return array.array("h", (chance.randint(-NOISE, NOISE) for _ in range(int(seconds * RATE))))


def prepare(paths, folder):
    """(name, padded file, end of the words in its ms, its seconds)"""
    chance = random.Random(1)
    ready = []
    for number, path in enumerate(paths):
        samples = samples_of(path)
        padded = noise(BEFORE_S, chance) + samples + noise(BEHIND_S, chance)
        name = f"{folder}/{number:04}.wav"
        with wave.open(name, "wb") as file:
            file.setparams((1, 2, RATE, 0, "NONE", ""))
            file.writeframes(padded.tobytes())
        ready.append((os.path.basename(path), name, BEFORE_S * 1000 + last_loud_ms(samples), len(padded) / RATE))
    return ready


def hear(options, ready, complete, folder):
    """Of each recording the ms at which results came, counted from its beginning."""
    config = {"clock": "virtual", "modules": [{"name": "SRM", "command": [os.path.abspath(options.bin) + "/srm"]}]}
    with open(folder + "/hub.json", "w", encoding="utf-8") as file:
        json.dump(config, file)
    script = [f"to @SRM set Listen.complete = {complete}"] if complete else []
    script.append("to @SRM set Run = START")
    for _, name, *_ in ready:
        script += [f"to @SRM set Input = wav:{name}", "set Wait = IDLE"]
    log = folder + "/log"
    subprocess.run([options.bin + "/agent_manager", "--config", folder + "/hub.json", "--log", log], text=True, check=True,
                   input="\n".join(script) + "\n", stdout=subprocess.DEVNULL)
    found = {}
    begun, now = None, ""
    with open(log, encoding="utf-8") as file:
        for row in file:
            fields = row.rstrip("\n").split("\t", 3)
            if len(fields) != 4 or row.startswith("#"):
                continue
            at, line = float(fields[0]), fields[3]
            if "Input = wav:" in line and "SRM" in fields[2]:
                begun, now = at, line.split("wav:")[1]
                found[now] = []
            elif begun is not None and fields[1] == "SRM" and (" rep Result = " in line or " rep NoMatch = " in line):
                found[now].append((at - begun, line.split(" = ", 1)[1]))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("recordings", nargs="+", metavar="RECORDING.wav")
    parser.add_argument("--bin", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/bin"))
    parser.add_argument("--complete", type=lambda text: [int(word) for word in text.split(",")], default=[0, 250], metavar="MS,...")
    parser.add_argument("--list", action="store_true", help="print the recordings that a later value cuts")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        ready = prepare(options.recordings, folder)
        seconds = sum(length for *_, length in ready)
        first = {}
        for complete in options.complete:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            found = hear(options, ready, complete, folder)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            counts = {name: len(found.get(file, [])) for name, file, *_ in ready}
            first = first or counts
            delays = sorted(found[file][-1][0] - end for _, file, end, _ in ready if found.get(file))
            cut = [name for name, count in counts.items() if count > 1 and first[name] == 1]
            busy = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
            print(f"complete {complete:4}: one {sum(c == 1 for c in counts.values())}, several "
                  f"{sum(c > 1 for c in counts.values())}, none {sum(c == 0 for c in counts.values())}; cut now {len(cut)}; "
                  f"after the words {statistics.median(delays):.0f}, {delays[int(0.9 * (len(delays) - 1))]:.0f}; "
                  f"processor {busy / seconds:.3f}")
            if options.list:
                for name, file, *_ in ready:
                    if name in cut:
                        print(f"    {name}: " + " | ".join(text for _, text in found[file]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
