"""The heads that are filmed: for each kind how fsm is called to wear it, or why it cannot be had."""
import os
import shutil
import subprocess

from film_judge.programs import ROOT, program, run


class Missing(Exception):
    """What a head needs is not there; says what."""


def data(variable, name):
    """A folder of data of others (tests/README.md)."""
    folder = os.environ.get(variable) or os.path.join(ROOT, "..", "shared", "data", name)
    if not os.path.isdir(folder):
        raise Missing(f"{os.path.normpath(folder)} is not there (tests/README.md: {variable})")
    return os.path.abspath(folder)


def existing(path):
    if not os.path.exists(path):
        raise Missing(f"{path} is not there")
    return path


def built_in(name):
    return lambda folder: ["--mask", name]


def photo(file):
    def make(folder):
        run([program("face_fit"), existing(os.path.join(data("GALATEA_PHOTOS", "photos"), file)), "--name", "judged",
             "--quiet"], environment={"GALATEA_FACES": folder})
        return ["--mask", "judged"]
    return make


def any_mesh(name):
    """A head of another maker, moved by our rig laid on it."""
    def make(folder):
        copy = os.path.join(folder, "head.obj")
        shutil.copy(existing(os.path.join(data("GALATEA_HEADS", "heads"), name, "neutral.obj")), copy)
        run([program("face_fit"), "--quiet", "--head", copy])
        return ["--head", copy]
    return make


# Places of the original's wireframe (group, number) and the points of the network that lie there.
NAMED = {"eye_right": ((4, 23), 33), "eye_left": ((5, 23), 263), "mouth_right": ((1, 33), 61),
         "mouth_left": ((2, 33), 291), "nasion": ((3, 1), 168), "below_nose": ((3, 25), 2),
         "lips": ((1, 36), 13), "chin": ((18, 20), 152)}
HEIGHTS = ("chin", "lips", "below_nose", "nasion")  # upwards


def between(x, xs, ys):
    """Through points, by straight lines that go on beyond the ends."""
    k = max(0, min(len(xs) - 2, sum(x > at for at in xs) - 1))
    return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k])


def fitted_wireframe(lines, points, size):
    """The lines of a .pnt, moved so that eyes, nose, mouth and chin lie where a picture of size x size
    pixels shows them: heights by pieces, widths by those of eyes and mouth."""
    rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    at = {(int(r[1]), int(r[2])): [float(v) for v in r[3:6]] for r in rows}
    seen = {name: (2 * points[i][0] / size - 1, 1 - 2 * points[i][1] / size) for name, (_, i) in NAMED.items()}
    own = {name: at[place] for name, (place, _) in NAMED.items()}
    own_y = [own[name][1] for name in HEIGHTS]
    seen_y = [seen[name][1] for name in HEIGHTS]
    def width(pair):
        return (seen[pair + "_left"][0] - seen[pair + "_right"][0]) / (own[pair + "_left"][0] - own[pair + "_right"][0])
    def middle(places, pair):
        return (places[pair + "_left"][0] + places[pair + "_right"][0]) / 2
    levels = [own["mouth_right"][1], own["eye_right"][1]]
    out = [f"#{len(rows) + 1}"]
    for r in rows:
        x, y, z = (float(v) for v in r[3:6])
        level = max(levels[0], min(levels[1], y))
        scale = between(level, levels, [width("mouth"), width("eye")])
        own_x = between(level, levels, [middle(own, "mouth"), middle(own, "eye")])
        seen_x = between(level, levels, [middle(seen, "mouth"), middle(seen, "eye")])
        out.append(" ".join(r[:3] + [f"{seen_x + scale * (x - own_x):.8f}", f"{between(y, own_y, seen_y):.8f}",
                                     f"{z * width('eye'):.8f}"]))
    return out


def original(folder):
    """The original's wireframe fitted to a portrait of the built-in head, since its own photos are not free."""
    home = os.path.join(data("GALATEA_ORIGINAL", "galatea_fsm"), "data")
    size = 512
    picture = os.path.join(folder, "portrait.png")
    run([program("fsm"), "--headless", "--size", f"{size}x{size}"], f"set SaveImage = {picture}\nset Wait = IDLE\n")
    pixels = subprocess.run(["ffmpeg", "-v", "error", "-i", picture, "-f", "rawvideo", "-pix_fmt", "rgba", "-"],
                            check=True, stdout=subprocess.PIPE).stdout
    seen = subprocess.run([program("face_watch"), "--size", f"{size}x{size}", "--points"], input=pixels, check=True,
                          stdout=subprocess.PIPE).stdout.decode().split(",")
    points = [(float(x), float(y)) for x, y in zip(seen[::2], seen[1::2])]
    with open(existing(os.path.join(home, "fheadv2.pnt")), encoding="latin-1") as file:
        wireframe = fitted_wireframe(file.read().splitlines(), points, size)
    with open(os.path.join(folder, "portrait.pnt"), "w", encoding="ascii") as file:
        file.write("\n".join(wireframe) + "\n")
    with open(os.path.join(folder, "config.txt"), "w", encoding="ascii") as file:
        file.write(f"MaskFile portrait {picture} {folder}/portrait.pnt\n"
                   f"DEF_WFM_PNT {home}/fheadv2.pnt\nDEF_WFM_LNK {home}/fheadv2.lnk\n"
                   f"U_TEETH_OBJ_NAME {home}/teethUpper.obj\nL_TEETH_OBJ_NAME {home}/teethLower.obj\n"
                   f"EYE_OBJ_NAME {home}/eye.obj\nM_WALL_TEXTURE {home}/mouthwall.bmp\n")
    return ["-C", os.path.join(folder, "config.txt")]


HEADS = {
    "galatea": built_in("galatea"),
    "pygmalion": built_in("pygmalion"),
    "photo-collins": photo("collins_nasa.png"),
    "photo-hopper": photo("hopper_usnavy.jpg"),
    "original": original,
    "mesh-ict": any_mesh("ict"),
    "mesh-makehuman": any_mesh("makehuman"),
}
