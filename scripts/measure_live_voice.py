#!/usr/bin/env python3
"""A voice that speaks for minutes into a pipe, and how constantly the mouth follows:

    scripts/measure_live_voice.py FILE.wav [--minutes 10] [--bin build/bin]

A recording (16 kHz, mono, 16 bit) is said again and again, with a second of silence between, at its
own pace into a pipe that vdm hears. Each minute: by how much the mouth that the face is told moves
behind the sound (the lag at which the openings are most like those of `vdm FILE.wav --no-words`, which should be
the slot Delay), how alike they are, frames that were told after their time, and vdm's memory. Fails
if the lag of a minute differs from that of another by more than 20 ms, or memory grows by more than
a tenth and 4 MiB from the first minute to the last.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import threading
import time
import wave

RATE, PIECE_S, PAUSE_S, MINUTE_S = 16000, 0.02, 1.0, 60
GRID_MS = 10
FURTHEST_MS = 400
MOST_DRIFT_MS = 20


def openings_of(program, path):
    """What `vdm FILE.wav --no-words` says, an opening each 10 ms."""
    lines = subprocess.run([program, path, "--no-words"], capture_output=True, text=True, check=True).stdout
    return [float(line.split(",")[2]) for line in lines.splitlines()[1:]]


def opening_of(numbers):
    """The opening of a frame in mm, as the column opening_mm has it (vdm/net/mouth_frame.cc)."""
    mouth, seal = numbers[:17], numbers[17]
    return max(mouth[2] - mouth[4] + 1.4 * mouth[11], 0) * (1 - seal)


def correlation(a, b):
    n = len(a)
    mean_a, mean_b = sum(a) / n, sum(b) / n
    ab = sum((x - mean_a) * (y - mean_b) for x, y in zip(a, b))
    aa, bb = sum((x - mean_a) ** 2 for x in a), sum((y - mean_b) ** 2 for y in b)
    return ab / (aa * bb) ** 0.5 if aa > 0 and bb > 0 else 0


class Listener(threading.Thread):
    """Reads what vdm tells the face: (the instant a frame is for, its opening)."""

    def __init__(self, stream):
        super().__init__(daemon=True)
        self.stream, self.frames, self.late, self.errors = stream, [], 0, []

    def run(self):
        start = 0
        for line in self.stream:
            now = time.monotonic()
            words = line.split()
            if "MouthFrame.start" in words:
                value = words[-1]
                start = now + (float(value[1:]) / 1000 if value.startswith("+") else 0)
            elif "MouthFrame" in words:
                numbers = [float(word) for word in words[words.index("=") + 1:]]
                at = start + numbers[0] / 1000
                self.late += now > at
                self.frames.append((at, opening_of(numbers[1:])))
            elif ".error" in line:
                self.errors.append(line.strip())


def memory_mib(pid):
    with open(f"/proc/{pid}/status") as file:
        return next(int(line.split()[1]) / 1024 for line in file if line.startswith("VmRSS"))


def speak(pipe, samples, until, begins):
    """Writes sound at its own pace; notes when each saying begins."""
    piece = int(RATE * PIECE_S) * 2
    sound = samples + bytes(2 * int(RATE * PAUSE_S))
    begin, written = time.monotonic(), 0
    while time.monotonic() < until:
        at = written % len(sound)
        if at == 0:
            begins.append(begin + written / 2 / RATE)
        ready = begin + (written + piece) / 2 / RATE  # as from a microphone: when it has sounded
        time.sleep(max(0, ready - time.monotonic()))
        written += pipe.write(sound[at:at + piece])


def judge(begins, frames, truth, since, until):
    """(lag in ms, correlation) of the sayings that begin in [since, until)."""
    best = (0, -1)
    sayings = [begin for begin in begins if since <= begin < until]
    for lag in range(-FURTHEST_MS, FURTHEST_MS + 1, GRID_MS):
        ours, theirs = [], []
        for begin in sayings:
            for at, opening in frames:
                hop = round((at - begin - lag / 1000) * 1000 / GRID_MS)
                if 0 <= hop < len(truth):
                    ours.append(opening)
                    theirs.append(truth[hop])
        if ours and (r := correlation(ours, theirs)) > best[1]:
            best = (lag, r)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wav")
    parser.add_argument("--minutes", type=int, default=10)
    parser.add_argument("--bin", default="build/bin")
    options = parser.parse_args()
    program = os.path.join(options.bin, "vdm")
    with wave.open(options.wav) as file:
        if (file.getframerate(), file.getnchannels(), file.getsampwidth()) != (RATE, 1, 2):
            sys.exit(f"{options.wav}: 16 kHz, mono, 16 bit expected")
        samples = file.readframes(file.getnframes())
    truth = openings_of(program, options.wav)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "pipe")
        os.mkfifo(path)
        vdm = subprocess.Popen([program, "--live"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               text=True, bufsize=1)
        listener = Listener(vdm.stdout)
        listener.start()
        vdm.stdin.write(f"set Input = raw:{path}\nset Run = START\n")
        begins, minutes = [], []
        with open(path, "wb", buffering=0) as pipe:
            first = time.monotonic()
            speaker = threading.Thread(target=speak, args=(
                pipe, samples, first + options.minutes * MINUTE_S, begins))
            speaker.start()
            for minute in range(options.minutes):
                time.sleep(max(0, first + (minute + 1) * MINUTE_S - time.monotonic()))
                frames = [f for f in listener.frames if f[0] >= first + minute * MINUTE_S]
                lag, r = judge(begins, frames, truth, first + minute * MINUTE_S,
                               first + (minute + 1) * MINUTE_S - len(truth) * GRID_MS / 1000)
                minutes.append((lag, memory_mib(vdm.pid)))
                print(f"minute {minute + 1}: mouth {lag} ms behind the sound, r {r:.3f}, "
                      f"{len(frames)} frames, {listener.late} told late so far, "
                      f"{minutes[-1][1]:.1f} MiB", flush=True)
            speaker.join()
        vdm.stdin.close()
        vdm.wait(timeout=10)
    faults = list(listener.errors)
    lags = [lag for lag, _ in minutes]
    if max(lags) - min(lags) > MOST_DRIFT_MS:
        faults.append(f"the lag drifts from {min(lags)} to {max(lags)} ms")
    if minutes[-1][1] > 1.1 * minutes[0][1] + 4:
        faults.append(f"memory grows from {minutes[0][1]:.1f} to {minutes[-1][1]:.1f} MiB")
    print("\n".join(faults) if faults else "constant")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
