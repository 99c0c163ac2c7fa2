"""Films made wrong on purpose, and the figure that has to show it."""
import os

from film_judge.programs import ROOT

TABLES = os.path.join(ROOT, "fsm", "motion", "tables")


def changed_table(folder, name, change):
    """A copy of a table in `folder`, each row of words through `change`."""
    with open(os.path.join(TABLES, name), encoding="utf-8") as file:
        rows = [line if line.startswith("#") or not line.strip() else " ".join(change(line.split("#")[0].split())) + "\n"
                for line in file]
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.writelines(rows)


SWAPPED = {"aa": "uw", "ae": "oh", "ah": "uh", "eh": "er", "ja_a": "ja_u", "ja_e": "ja_o"}
SWAPPED |= {to: name for name, to in SWAPPED.items()}


def swapped_shapes(folder):
    """Open vowels show the shapes of round ones and the other way round."""
    changed_table(folder, "mouth_shapes_28.txt", lambda row: [SWAPPED.get(row[0], row[0]), *row[1:]])


def no_closures(folder):
    """p, b and m show the shape of a neutral vowel, and nothing seals the lips."""
    with open(os.path.join(TABLES, "mouth_shapes_28.txt"), encoding="utf-8") as file:
        neutral = next(line.split("#")[0].split() for line in file if line.startswith("ah "))
    changed_table(folder, "mouth_shapes_28.txt", lambda row: ["b", *neutral[1:]] if row[0] == "b" else row)
    changed_table(folder, "dominance.txt",
                  lambda row: [*row[:-1], "0"] if row[:3] == ["shape", "28", "b"] else row)


def tables(change):
    def make(folder):
        change(folder)
        return {"more": ["--tables", folder]}
    return make


# name: (way, figure that must be beyond its limit, what makes the arguments of the film)
SABOTAGE = {
    "mouth-late": ("DOMINANCE", "ahead", lambda folder: {"extra": ["to @FSM set LipSync.lead = -60"]}),
    "sound-late": ("DOMINANCE", "ahead", lambda folder: {"sound_late_ms": 100}),
    "voice-late": ("voice", "ahead", lambda folder: {"extra": ["to @VDM set Delay = 200"]}),
    "shapes-swapped": ("DOMINANCE", "gap_r", tables(swapped_shapes)),
    "closures-off": ("DOMINANCE", "closed", tables(no_closures)),
    "blinks-off": ("DOMINANCE", "blinks", lambda folder: {
        "extra": [f"to @FSM set Autonomous = {part} 0" for part in ("BLINK", "GAZEBLINK", "ENDBLINK")]}),
    "head-still": ("DOMINANCE", "turn", lambda folder: {
        "extra": [f"to @FSM set Autonomous = {part} 0" for part in ("MOVE", "BREATH", "SPEECH", "NODS")]}),
    "mumbled": ("DOMINANCE", "size", lambda folder: {"extra": ["to @FSM set LipSync.scale = 40"]}),
}
KINDS = list(SABOTAGE)


def make(name, folder):
    """(way, figure, arguments of the film)."""
    way, figure, changes = SABOTAGE[name]
    own = os.path.join(folder, name)
    os.mkdir(own)
    return way, figure, changes(own)
