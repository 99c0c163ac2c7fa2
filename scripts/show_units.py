#!/usr/bin/env python3
"""Films a face that shows the units of FACS that face_track follows, one after the other, to be imitated.

usage: scripts/show_units.py FILM.mp4 PROMPTS.txt [--head NAME]

PROMPTS.txt tells when: who films itself from the film's begin on, as it plays, and does what is shown, learns with
`face_track OWN.mp4 --learn-units PROMPTS.txt --out own.units` how its own face moves (docs/tracking.md). Needs ffmpeg and
the built fsm.
"""
import argparse
import os
import subprocess

BIN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "build", "bin")
NAMES = {
    1: "inner brows up", 2: "outer brows up", 4: "brows down", 5: "eyes wide open", 6: "cheeks up", 7: "lids tight",
    9: "nose wrinkled", 10: "upper lip up", 12: "smile", 14: "dimples", 15: "corners of the mouth down",
    16: "lower lip down", 17: "chin up", 18: "lips puckered", 20: "lips stretched", 22: "lips as a funnel",
    23: "lips tight", 24: "lips pressed", 25: "lips parted", 26: "jaw down", 28: "lips sucked in", 43: "eyes shut",
}
REST_S, SHOWN_S, BETWEEN_S = 2.5, 2.0, 1.0
LATE_S = 0.3  # of who imitates


def main():
    parser = argparse.ArgumentParser(description="Films a face that shows units of FACS, to be imitated.")
    parser.add_argument("film")
    parser.add_argument("prompts")
    parser.add_argument("--head", default="galatea")
    args = parser.parse_args()
    lines = ["set Camera = 1 0 25", "set Record.fps = 25", f"set Record = {os.path.abspath(args.film)}",
             f"set Wait = {REST_S * 1000:.0f}"]
    prompts = ["# When a film shows which unit of FACS (docs/tracking.md): show FROM TO UNIT, seconds"]
    now = REST_S
    for unit, name in NAMES.items():
        lines += [f"set AU = {unit} 1 300", f"set Wait = {SHOWN_S * 1000:.0f}", f"set AU = {unit} 0 300",
                  f"set Wait = {BETWEEN_S * 1000:.0f}"]
        prompts.append(f"show {now + LATE_S:.1f} {now + SHOWN_S + LATE_S:.1f} {unit:<3} # {name}")
        now += SHOWN_S + BETWEEN_S
    lines += ["set Record = STOP", "set Wait = IDLE", ""]
    subprocess.run([f"{BIN}/fsm", "--headless", "--clock", "virtual", "--size", "640x480", "--mask", args.head],
                   input="\n".join(lines), text=True, check=True, stdout=subprocess.DEVNULL)
    with open(args.prompts, "w", encoding="utf-8") as file:
        file.write("\n".join(prompts) + "\n")
    print(f"show_units: wrote {args.film} ({now:.0f} s) and {args.prompts}")


if __name__ == "__main__":
    main()
