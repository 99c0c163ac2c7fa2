#!/usr/bin/env python3
"""Judges films of our faces by eyes that know nothing of them: MediaPipe's landmark networks.

usage: scripts/judge_film.py [--head NAME]... [--way WAY]...   the table of films
       scripts/judge_film.py --doses [--head NAME]...          what each unit does at 0.33, 0.67 and 1
       scripts/judge_film.py --real                            lips and sound on the machine's own clock
       scripts/judge_film.py --self-test [SABOTAGE]...         good films pass, each sabotaged one fails

Needs the networks (scripts/face_networks.sh), ffmpeg and the built programs. Figures are explained in docs/face.md,
"An outside judge"; their limits stand in scripts/film_judge/limits.txt. Ends with 1 where a figure is beyond
its limit, with 77 where networks are missing.
"""
import argparse
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from film_judge import doses, films, real_clock, sabotage, verdict  # noqa: E402
from film_judge.heads import HEADS, Missing  # noqa: E402
from film_judge.programs import Failed  # noqa: E402

TEXTS = [("slt", "My mother bought five blue apples. Bob may help Pam pump up the big boat."),
         ("female01", "ママはパンを食べて、ピアノの前でボブと飛び上がった。")]
KINDS = ["galatea", "photo-collins", "original", "mesh-ict"]  # one head of each kind


class Judge:
    """Makes films and judges them beside one reference, the built-in head that speaks by the text."""

    def __init__(self, folder, texts):
        self.folder, self.texts = folder, texts
        self.limits = verdict.read_limits()
        self.worn = {}
        self.made = 0
        self.reference = self.film("galatea", "DOMINANCE")
        self.loudness = films.loudness(self.reference.sound)

    def wear(self, head):
        """How fsm wears the head; raises Missing."""
        if head not in self.worn:
            folder = os.path.join(self.folder, head)
            os.mkdir(folder)
            self.worn[head] = (HEADS[head](folder), {"GALATEA_FACES": folder})
        return self.worn[head]

    def film(self, head, way, **more):
        wear, environment = self.wear(head)
        self.made += 1
        folder = os.path.join(self.folder, str(self.made))
        os.mkdir(folder)
        if way == "voice":
            return films.heard(folder, wear, environment, self.reference, **more)
        return films.spoken(folder, wear, environment, self.texts, mode=way, **more)

    def judge(self, film, head, way):
        values = verdict.figures(film, self.reference, (self.loudness, self.reference.begins[0]))
        return values, verdict.faults(values, head, way, self.limits)


def table(judge, heads, ways):
    """Prints a row for each head and way; returns whether all are within the limits."""
    print(verdict.table_head(), flush=True)
    beyond = []
    for head in heads:
        for way in ways:
            try:
                film = judge.reference if (head, way) == ("galatea", "DOMINANCE") else judge.film(head, way)
            except Missing as missing:
                print(f"judge_film: {head} is left out: {missing}", file=sys.stderr)
                break
            values, faults = judge.judge(film, head, way)
            print(verdict.table_row(head, way, values, faults), flush=True)
            beyond += [f"{head}, {way}: {fault}" for fault in faults.values()]
    for fault in beyond:
        print("judge_film: " + fault)
    return not beyond


def self_test(judge, names):
    """Judges good films, then sabotaged ones; returns whether all came out as they should."""
    right = True
    for way in sorted({sabotage.SABOTAGE[name][0] for name in names}):
        _, faults = judge.judge(judge.reference if way == "DOMINANCE" else judge.film("galatea", way), "galatea", way)
        right = right and not faults
        print(f"good, {way}: " + ("; ".join(faults.values()) if faults else "passes"), flush=True)
    for name in names:
        way, expected, changes = sabotage.make(name, judge.folder)
        _, faults = judge.judge(judge.film("galatea", way, **changes), "galatea", way)
        caught = expected in faults
        right = right and caught
        print(f"{name}, {way}: " + ("caught" if caught else f"NOT CAUGHT by {expected}")
              + (" (" + "; ".join(faults.values()) + ")" if faults else ""), flush=True)
    return right


def real(judge):
    """Prints how far lips are from the sound where time does not wait for drawing."""
    folder = os.path.join(judge.folder, "real")
    os.mkdir(folder)
    film, errors = real_clock.spoken(folder, *judge.texts[0])
    for name, error in errors:
        print(f"  {name:4} {error:+6.1f} ms")
    print(real_clock.summary(errors))
    values, _ = judge.judge(film, "galatea", "DOMINANCE")
    print(f"seen: the mouth is {values['ahead']:+.0f} ms ahead of the sound, r {values['gap_r']:.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--head", action="append", choices=HEADS, metavar="NAME", help=", ".join(HEADS) + "; one of each kind where none is named")
    parser.add_argument("--way", action="append", choices=verdict.WAYS, metavar="WAY", help=", ".join(verdict.WAYS))
    parser.add_argument("--doses", action="store_true")
    parser.add_argument("--real", action="store_true")
    parser.add_argument("--self-test", nargs="*", choices=sabotage.KINDS, metavar="SABOTAGE",
                        help=", ".join(sabotage.KINDS))
    options = parser.parse_args()
    heads = options.head or KINDS
    try:
        films.check_eye()
        with tempfile.TemporaryDirectory() as folder:
            if options.doses:
                return 0 if doses.table(folder, heads) else 1
            if options.real:
                real(Judge(folder, TEXTS[:1]))
                return 0
            if options.self_test is not None:
                return 0 if self_test(Judge(folder, TEXTS[:1]), options.self_test or sabotage.KINDS) else 1
            return 0 if table(Judge(folder, TEXTS), heads, options.way or verdict.WAYS) else 1
    except (Failed, OSError, subprocess.CalledProcessError) as failed:
        print(f"judge_film: {failed}", file=sys.stderr)
        return 77 if "networks that find faces are not in" in str(failed) else 2


if __name__ == "__main__":
    sys.exit(main())
