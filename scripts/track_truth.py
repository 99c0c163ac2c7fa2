#!/usr/bin/env python3
"""Films heads that turn, blink and move as told, follows them with face_track, and prints how far off it is.

usage: scripts/track_truth.py [--spoil noise|blur|dark|squeezed] [--careful] [--shown] [HEAD]...     baucis, from which the table learned nothing

--shown: another film, spoiled alike, shows each unit first, and the head is followed as it moves there (scripts/show_units.py).

Needs the networks (scripts/face_networks.sh), ffmpeg and the built programs; ends with 77 without networks. Angles and
doses are medians of the last 400 ms of each second they are held; lids are counted in each picture that is not within
120 ms of their moving.
"""
import argparse
import csv
import os
import subprocess
import sys
import tempfile

BIN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "build", "bin")
TURNS = [(0, y, 0) for y in (-30, -20, -10, 10, 20, 30)] + [(x, 0, 0) for x in (-20, -10, 10, 20)] + [(0, 0, 15), (8, 12, 5)]
UNITS = ["1", "2", "4", "5", "6", "7", "9", "10", "12", "14", "15", "16", "17", "18", "20", "22", "23", "24", "25", "26", "28", "43"]
BOTH = {"16", "17", "18", "22", "23", "24", "25", "26", "28"}
DOSE = 0.7
BLINKS = 10
SHUT = 0.4  # of the lids' usual opening
SPOILS = {
    "noise": ["-vf", "noise=alls=25:allf=t"],
    "blur": ["-vf", "gblur=sigma=2"],
    "dark": ["-vf", "eq=brightness=-0.2:contrast=0.5"],
    "squeezed": ["-b:v", "120k"],
}


def median(values):
    return sorted(values)[len(values) // 2]


def spoiled(film, spoil):
    if not spoil:
        return film
    made = film.removesuffix(".mp4") + "_spoiled.mp4"
    subprocess.run(["ffmpeg", "-v", "error", "-i", film, *SPOILS[spoil], made], check=True)
    return made


def track(*words):
    """What face_track prints."""
    done = subprocess.run([f"{BIN}/face_track", *words, "--field", "25", "--quiet"], text=True, capture_output=True)
    if done.returncode != 0:
        print(done.stderr.strip(), file=sys.stderr)
        sys.exit(77 if "face_networks.sh" in done.stderr else 1)
    return done.stdout


def follow(head, folder, spoil, careful, shown):
    more = ["--careful"] * careful
    if shown:
        film, prompts, person = (os.path.join(folder, name) for name in ("shown.mp4", "prompts.txt", "person.units"))
        subprocess.run([os.path.join(os.path.dirname(os.path.abspath(__file__)), "show_units.py"), film, prompts, "--head", head],
                       check=True, capture_output=True)
        track(spoiled(film, spoil), "--learn-units", prompts, "--out", person, *more)
        more += ["--person", person]
    film = os.path.join(folder, "film.mp4")
    lines = ["set Camera = 1 0 25", "set Record.fps = 25", f"set Record = {film}", "set Wait = 1500"]
    for turn in TURNS:
        lines += ["set HeadRotAbs.1 = {} {} {}".format(*turn), "set Wait = 1000"]
    lines += ["set HeadRotAbs.1 = 0 0 0", "set Wait = 1000"]
    for unit in UNITS:
        lines += [f"set AU = {unit} {DOSE} 60", "set Wait = 1000", f"set AU = {unit} 0 60", "set Wait = 500"]
    for _ in range(BLINKS):
        lines += ["set AU = 43 1 60", "set Wait = 400", "set AU = 43 0 60", "set Wait = 600"]
    lines += ["set Record = STOP", "set Wait = IDLE", ""]
    subprocess.run([f"{BIN}/fsm", "--headless", "--clock", "virtual", "--size", "640x480", "--mask", head],
                   input="\n".join(lines), text=True, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return list(csv.DictReader(track(spoiled(film, spoil), *more).splitlines()))


def report(head, rows):
    """Prints what was found of one head and returns the angles' errors."""
    def at(end_ms, name):
        values = [float(r[name]) for r in rows if end_ms - 400 < float(r["ms"]) < end_ms - 20 and r[name]]
        return median(values) if values else float("nan")
    names = ("down", "right", "tilt")
    rest = [at(1400, name) for name in names]
    print(f"{head}: at rest {rest[0]:+.2f} {rest[1]:+.2f} {rest[2]:+.2f} degrees; "
          f"a face in {sum(r['person'] != '0' for r in rows)} of {len(rows)} pictures")
    errors, doses, end = [], [], 1500
    for turn in TURNS:
        end += 1000
        off = [at(end, name) - told - still for name, told, still in zip(names, turn, rest)]
        errors += off
        print(f"  told {turn}: off {off[0]:+.2f} {off[1]:+.2f} {off[2]:+.2f} from rest")
    end += 1000
    for unit in UNITS:
        end += 1000
        seen = [at(end, f"au{unit}{side}") for side in ([""] if unit in BOTH else "RL")]
        doses += [abs(v - DOSE) / DOSE for v in seen] * (2 if unit in BOTH else 1)
        print(f"  AU {unit} at {DOSE}: " + " ".join(f"{v:.2f}" for v in seen))
        end += 500
    print(f"  doses off by {100 * sum(doses) / len(doses):.0f} %, "
          f"{sum(max(doses[k:k + 2]) <= 0.15 for k in range(0, len(doses), 2))} of {len(UNITS)} within 15 %")
    right = all_lids = 0
    for r in rows:
        since = (float(r["ms"]) - end) % 1000
        if float(r["ms"]) < end or not r["lidR"]:
            continue
        if 120 < since < 390 or 520 < since < 980:
            for side in "RL":
                right += (float(r["lid" + side]) < SHUT) == (since < 400)
                all_lids += 1
    print(f"  lids right in {right} of {all_lids}")
    return errors


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spoil", choices=sorted(SPOILS))
    parser.add_argument("--careful", action="store_true")
    parser.add_argument("--shown", action="store_true")
    parser.add_argument("heads", nargs="*", default=["baucis"])
    wanted = parser.parse_args()
    errors = []
    for head in wanted.heads:
        with tempfile.TemporaryDirectory() as folder:
            errors += report(head, follow(head, folder, wanted.spoil, wanted.careful, wanted.shown))
    print(f"angles off: rms {(sum(e * e for e in errors) / len(errors)) ** 0.5:.2f}, worst {max(map(abs, errors)):.2f} degrees")


if __name__ == "__main__":
    main()
