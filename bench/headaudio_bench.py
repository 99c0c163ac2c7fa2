#!/usr/bin/env python3
"""HeadAudio beside vdm: how near both come to the text-driven mouth, in mm on the built-in head.

usage: bench/headaudio_bench.py

vdm hears each recording twice: as it would live, and whole, its words recognised first. Fetches the npm package
@met4citizen/headaudio (MIT), runs its modules in node over the people of Debian's pocketsphinx-testdata (phonemes by our
aligner, with the text) and a voice of flite (phonemes known), and measures what bench/vdm_bench.cc measures. Needs node, npm, ffmpeg, and align, fsm, ssm and vdm built.

HeadAudio says visemes and no millimetres: each of its 15 values gets the gap that fits the true ones best by least
squares over all recordings here, which favours it; lips count as shut where that gap is below 1 mm or viseme_PP stands
above half its greatest value. Each is compared at its own best lag.
"""
import csv
import glob
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from film_judge import films, measures  # noqa: E402
from film_judge.programs import Failed, program, run  # noqa: E402

PACKAGE = "@met4citizen/headaudio@0.1.0"
PEOPLE = "/usr/share/pocketsphinx/test/data/"
READ = ["My mother bought five blue apples from the shop by the pier.",
        "Please give Bob a map before the bus moves off, and wave.",
        "The weather was warm, so we sat down near the water and ate our lunch.",
        "Some people believe that a happy man may never be rich."]
STEP_MS, SHUT_MM, OPEN_MM = 10, 1.0, 3.0
PP_SHUT = 0.375  # half of what viseme_PP reaches


def gaps(folder, lines):
    """The gap each 10 ms as the built-in head moves by these lines."""
    picture = os.path.join(folder, "frames.rgba")
    said = run([program("fsm"), "--headless", "--clock", "virtual", "--size", "32x24"],
               "\n".join(["set LipSync.lead = 0", "set Record.fps = 100", "prop Frame = AutoOutput", "set Record = " + picture,
                          *lines, "set Wait = IDLE", "set Record = STOP", "set Wait = IDLE"]) + "\n")
    os.remove(picture)
    return [float(films.value_of(line).split()[4]) for line in said.splitlines() if line.startswith("rep Frame = ")]


def peer(folder, package, sound, mended):
    """HeadAudio's values each 10 ms."""
    raw = os.path.join(folder, "sound.f32")
    run(["ffmpeg", "-v", "error", "-y", "-i", sound, "-ar", "48000", "-ac", "1", "-f", "f32le", raw])
    said = run(["node", os.path.join(ROOT, "bench", "headaudio_peer.mjs"), package, raw] + (["mended"] if mended else []))
    return [{name: float(v) for name, v in row.items() if name != "ms"} for row in csv.DictReader(said.splitlines())]


def recordings(folder):
    """(who, sound, phonemes with their ms)."""
    for who, file in (("librivox", "transcription"), ("cards", "cards.transcription")):
        if not os.path.isdir(PEOPLE + who):
            raise Failed(f"{PEOPLE}{who} is not there (Debian package pocketsphinx-testdata)")
        with open(os.path.join(PEOPLE, who, file), encoding="ascii") as lines:
            for text, name in re.findall(r"<s>(.*?)</s>\s*\((.*?)\)", lines.read()):
                sound = os.path.join(PEOPLE, who, name + ".wav")
                yield who, sound, films.parse_phonemes(run([program("align"), "--text", text.strip(), sound]))
    for k, text in enumerate(READ):
        sound = os.path.join(folder, f"read{k}.wav")
        said = run([program("ssm"), "--sink", "null"], f"set Speaker = rms\nset Text = {text}\nset SaveWAV = {sound}\n"
                   "set Wait = IDLE\n")
        yield "flite rms", sound, [films.parse_phonemes(films.value_of(line)) for line in said.splitlines()
                                   if line.startswith("rep Text.pho = ")][0]


def solved(matrix, right):
    """Gauss with pivots; a column of nothing gets 0."""
    n = len(right)
    rows = [list(row) + [b] for row, b in zip(matrix, right)]
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        if abs(rows[k][k]) < 1e-9:
            continue
        for i in range(n):
            if i != k:
                by = rows[i][k] / rows[k][k]
                rows[i] = [a - by * b for a, b in zip(rows[i], rows[k])]
    return [rows[k][n] / rows[k][k] if abs(rows[k][k]) >= 1e-9 else 0.0 for k in range(n)]


def fitted(values, truths, lag):
    """For each name the gap that its value 1 stands for, and the gap where all are 0."""
    names = list(values[0][0]) + [""]
    products, right = [[0.0] * len(names) for _ in names], [0.0] * len(names)
    for one, truth in zip(values, truths):
        for k, row in enumerate(one):
            if not 0 <= k - lag < len(truth):
                continue
            x = [row.get(name, 1.0) for name in names]
            for i, xi in enumerate(x):
                if xi:
                    right[i] += xi * truth[k - lag]
                    for j, xj in enumerate(x):
                        products[i][j] += xi * xj
    return dict(zip(names, solved(products, right)))


class Score:
    """As vdm/train/score.h says."""

    def __init__(self):
        self.ours, self.truth = [], []
        self.seen = self.closures = self.open = self.mistakes = 0

    def add(self, ours, shut, truth, phonemes, lag):
        """`ours` and `shut` come `lag` steps after the truth."""
        count = min(len(truth), len(ours) - lag)
        if lag < 0:
            ours, shut = [0.0] * -lag + ours, [True] * -lag + shut
        ours, shut, truth = ours[max(lag, 0):][:count], shut[max(lag, 0):][:count], truth[:count]
        self.ours += ours
        self.truth += truth
        for name, start, end in measures.phoneme_times(phonemes, 0):
            first, last = (-int(-t // STEP_MS) for t in (start, end))
            if name in measures.LIPS_MEET and min(truth[first:last] or [9]) < SHUT_MM:
                self.closures += 1
                self.seen += any(shut[max(0, first - 2):last + 2])
        for k in range(3, count - 3):
            if min(truth[k - 3:k + 4]) >= OPEN_MM:
                self.open += 1
                self.mistakes += shut[k]

    def r(self):
        return measures.correlation(self.ours, self.truth)

    def row(self):
        rms = measures.mean([(a - b) ** 2 for a, b in zip(self.ours, self.truth)]) ** 0.5
        spread = [measures.mean([(v - measures.mean(x)) ** 2 for v in x]) ** 0.5 for x in (self.ours, self.truth)]
        return (f"{self.r():.3f} | {rms:.2f} | {spread[0] / spread[1]:.2f} | {100 * self.seen / max(self.closures, 1):.0f} % of "
                f"{self.closures} | {100 * self.mistakes / max(self.open, 1):.1f} %")


def scored(tracks, material, lag):
    """(all, by who) of tracks of (gaps, shut)."""
    scores = {}
    for (gap, shut), (who, _, phonemes, truth) in zip(tracks, material):
        for key in ("all", who):
            scores.setdefault(key, Score()).add(gap, shut, truth, phonemes, lag)
    return scores


def best(make, material):
    """The lag in steps at which the tracks that `make(lag)` gives are most like the truth, and their scores."""
    at = max(range(0, 31), key=lambda lag: scored(make(lag), material, lag)["all"].r())
    return at, scored(make(at), material, at)


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["npm", "pack", "--silent", PACKAGE], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        run(["tar", "xzf", *glob.glob(folder + "/*.tgz"), "-C", folder])
        material = []
        for who, sound, phonemes in recordings(folder):
            listed = " ".join(f"{name} {ms:g}" for name, ms in phonemes)
            material.append((who, sound, phonemes, gaps(folder, ["set LipSync.pho = " + listed, "set Speak = NOW"])))
        rows = []
        for name, options in (("vdm, as live", ["--no-words"]), ("vdm, whole recordings", [])):
            ours = [gaps(folder, run([program("vdm"), "--print", "lines", *options, sound]).splitlines())
                    for _, sound, _, _ in material]
            rows.append((name, best(lambda lag, ours=ours: [(gap, [g < SHUT_MM for g in gap]) for gap in ours], material)))
        for name, mended in (("HeadAudio", False), ("HeadAudio, `aa` mended", True)):
            values = [peer(folder, os.path.join(folder, "package"), sound, mended) for _, sound, _, _ in material]

            def tracks(lag, values=values):
                weight = fitted(values, [truth for _, _, _, truth in material], lag)
                made = []
                for one in values:
                    gap = [max(0.0, weight[""] + sum(weight[k] * v for k, v in row.items())) for row in one]
                    made.append((gap, [g < SHUT_MM or row["viseme_PP"] > PP_SHUT for g, row in zip(gap, one)]))
                return made
            rows.append((name, best(tracks, material)))
    print("| who | by | r of the gap | rms mm | size | closures seen | shut by mistake | lag ms |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |")
    for who in ("librivox", "cards", "flite rms", "all"):
        for name, (lag, scores) in rows:
            print(f"| {who} | {name} | {scores[who].row()} | {lag * STEP_MS:+d} |")


if __name__ == "__main__":
    try:
        main()
    except (Failed, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"headaudio_bench: {error}")
