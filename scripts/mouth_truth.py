#!/usr/bin/env python3
"""Films heads that say a recording by the voice-driven mouth, follows them with face_track --mouth, and prints how far off it is.

usage: scripts/mouth_truth.py [--head NAME]... [--spoil noise|blur|dark|squeezed] [--nod] FILE.wav...

What `vdm FILE.wav` prints is what the mouth does, so it is the truth; the heads are baucis, from which no table learned,
where none is named. --nod moves the head meanwhile. Needs the networks (scripts/face_networks.sh), ffmpeg and the built
programs; ends with 77 without networks. Gaps are those the parameters give (vdm/net/mouth_frame.cc), in mm. A closure is
a run of sealed lips within speech; it is found where the track has lips nearer than 1 mm in one of its pictures.
"""
import argparse
import csv
import os
import subprocess
import sys
import tempfile

from track_truth import BIN, SPOILS

REST_MS = 1500
RATE = 25
NUMBERS = [f"m{k}" for k in range(1, 18)]


def gap(row):
    return max(row["m3"] - row["m5"] + 1.4 * row["m12"], 0) * (1 - row["seal"])


MEASURES = [("gap", gap), ("corner out", lambda row: row["m9"]), ("jaw", lambda row: row["m12"]),
            ("upper lip", lambda row: row["m3"]), ("lower lip", lambda row: row["m5"]), ("forward", lambda row: row["m2"]),
            ("corner up", lambda row: row["m10"])]


def rows_of(text):
    """The rows of a track as numbers; those without a face are left out."""
    rows = csv.DictReader(text.splitlines())
    return [{name: float(row[name]) for name in ["ms", "seal", *NUMBERS]} for row in rows if row["m1"]]


def run(words, text=None):
    done = subprocess.run(words, input=text, text=True, capture_output=True)
    if done.returncode != 0:
        print(done.stderr.strip(), file=sys.stderr)
        sys.exit(77 if "face_networks.sh" in done.stderr else 1)
    return done.stdout


def follow(head, sound, wanted, folder):
    """Returns what the mouth does and what was seen of it, a row a picture each, in the same order."""
    truth = rows_of(run([f"{BIN}/vdm", sound]))
    film = os.path.join(folder, "film.mp4")
    nods = [f"set HeadRotAbs.1 = {x} {y} {z}\nset Wait = 700" for x, y, z in [(6, 3, 2), (-4, 8, 0), (3, -9, -3), (0, 0, 0)]]
    lines = ["set Camera = 1 0 25", f"set Record.fps = {RATE}", f"set Record = {film}", f"set Wait = {REST_MS}",
             run([f"{BIN}/vdm", "--print", "lines", sound])]
    if wanted.nod:
        lines += nods * int(truth[-1]["ms"] / 2800 + 1)
    lines += ["set Wait = IDLE", "set Wait = 300", "set Record = STOP", "set Wait = IDLE", ""]
    run([f"{BIN}/fsm", "--headless", "--clock", "virtual", "--size", "640x480", "--mask", head], "\n".join(lines))
    if wanted.spoil:
        spoiled = os.path.join(folder, "spoiled.mp4")
        run(["ffmpeg", "-v", "error", "-y", "-i", film, *SPOILS[wanted.spoil], spoiled])
        film = spoiled
    pairs = []
    for seen in rows_of(run([f"{BIN}/face_track", film, "--field", "25", "--mouth", "--quiet"])):
        at = round((seen["ms"] - REST_MS) / 10)  # the truth's rows are 10 ms apart
        if 0 <= at < len(truth):
            pairs.append((truth[at], seen))
    return pairs


def compare(told, seen):
    """Correlation, rms of the difference and size beside the true one."""
    count = len(told)
    mean = sum(told) / count, sum(seen) / count
    told_off, seen_off = [v - mean[0] for v in told], [v - mean[1] for v in seen]
    squares = sum(v * v for v in told_off), sum(v * v for v in seen_off)
    both = sum(a * b for a, b in zip(told_off, seen_off))
    return (both / max((squares[0] * squares[1]) ** 0.5, 1e-9),
            (sum((a - b) ** 2 for a, b in zip(told, seen)) / count) ** 0.5, (squares[1] / max(squares[0], 1e-9)) ** 0.5)


def closures(pairs):
    """Runs of sealed lips between open ones: found, all."""
    found = count = 0
    run_of = None  # rows of the present run, None before the mouth has opened
    for told, seen in pairs:
        if told["seal"] > 0.5:
            if run_of is not None:
                run_of.append(seen)
        elif gap(told) > 1:
            if run_of:
                count += 1
                found += any(gap(row) < 1 for row in run_of)
            run_of = []
    return found, count


def report(name, pairs):
    print(f"{name}: {len(pairs)} pictures")
    for measure, value in MEASURES:
        r, rms, size = compare([value(told) for told, _ in pairs], [value(seen) for _, seen in pairs])
        print(f"  {measure:10} r {r:5.2f}  rms {rms:.2f}  size {size:.2f}")
    found, count = closures(pairs)
    wide = [gap(seen) < 1 for told, seen in pairs if gap(told) > 3]
    print(f"  closures found {found} of {count}; shut by mistake {100 * sum(wide) / max(len(wide), 1):.1f} % of {len(wide)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--head", action="append")
    parser.add_argument("--spoil", choices=sorted(SPOILS))
    parser.add_argument("--nod", action="store_true")
    parser.add_argument("sounds", nargs="+", metavar="FILE.wav")
    wanted = parser.parse_args()
    for head in wanted.head or ["baucis"]:
        pairs = []
        for sound in wanted.sounds:
            with tempfile.TemporaryDirectory() as folder:
                pairs += follow(head, sound, wanted, folder)
        report(head, pairs)


if __name__ == "__main__":
    main()
