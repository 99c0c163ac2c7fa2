#!/usr/bin/env python3
"""Makes a small copy of a face that face_fit has made, for tests that need no photo and no network.

    scripts/small_face.py FACE_FOLDER OUT_FOLDER

The photo is scaled to 512 pixels wide with 64 levels a channel, and of the sheet of hair and clothes
every fourth vertex of each direction is kept; the rest of face.txt stays as it is. Needs ffmpeg.
"""
import pathlib
import subprocess
import sys

WIDTH, LEVEL, STEP = 512, 4, 4


def coarse_sheet(vertices, quads):
    """Lines of the sheet's grid with only every STEP-th vertex."""
    if not quads:
        return []
    across = quads[0][1] - quads[0][0]  # corners: here, one row down, beside that, beside here
    cells = {}
    for a, *_ in quads:
        cell = (a % across // STEP, a // across // STEP)
        cells.setdefault(cell)  # in the order of the quads, the farther ones first
    rows = len(vertices) // across
    number, lines, corners = {}, [], []
    for x, y in cells:
        right, down = min((x + 1) * STEP, across - 1), min((y + 1) * STEP, rows - 1)
        quad = []
        for i, j in ((x * STEP, y * STEP), (x * STEP, down), (right, down), (right, y * STEP)):
            at = j * across + i
            if at not in number:
                place = vertices[at]
                # As far back as any around it: a coarse sheet must not come before the open mouth.
                depth = min(float(vertices[b * across + a][2])
                            for a in range(max(i - STEP, 0), min(i + STEP + 1, across))
                            for b in range(max(j - STEP, 0), min(j + STEP + 1, rows)))
                number[at] = len(number)
                lines.append(" ".join(("vertex", *place[:2], f"{depth:.2f}", *place[3:])))
            quad.append(number[at])
        corners.append("quad " + " ".join(map(str, quad)))
    return lines + corners


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, out = map(pathlib.Path, sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    kept, vertices, quads = [], [], []
    for line in (source / "face.txt").read_text().splitlines():
        word = line.split(" ", 1)[0]
        if word == "vertex":
            vertices.append(line.split()[1:])
        elif word == "quad":
            quads.append([int(w) for w in line.split()[1:]])
        else:
            kept.append(line)
    (out / "face.txt").write_text("\n".join(kept + coarse_sheet(vertices, quads)) + "\n")
    coarse = f"trunc(val/{LEVEL})*{LEVEL}+{LEVEL // 2}"
    alpha = "if(lt(val,8),0,if(gt(val,247),255,val))"
    subprocess.run(
        ["ffmpeg", "-loglevel", "error", "-y", "-i", source / "photo.png", "-compression_level", "9",
         "-pred", "mixed", "-vf",
         f"scale={WIDTH}:-1:flags=area,lutrgb=r='{coarse}':g='{coarse}':b='{coarse}':a='{alpha}'",
         "-bitexact", out / "photo.png"], check=True)


if __name__ == "__main__":
    main()
