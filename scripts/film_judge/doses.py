"""What units of the face do at three strengths, as the networks see it."""
import os

from film_judge import films
from film_judge.heads import HEADS, Missing
from film_judge.measures import median

STRENGTHS = (0.33, 0.67, 1.0)
HOLD_MS = 400  # of which the last 200 are measured

# What is set; its full strength; the measure that should follow (both sides' mean), and which way.
DOSES = [
    ("AU 1", "AU = 1 {:g} 60", 1, "brow_inner", +1), ("AU 2", "AU = 2 {:g} 60", 1, "brow_outer", +1),
    ("AU 4", "AU = 4 {:g} 60", 1, "brow_inner", -1), ("AU 5", "AU = 5 {:g} 60", 1, "eye", +1),
    ("AU 7", "AU = 7 {:g} 60", 1, "eye", -1), ("AU 43", "AU = 43 {:g} 60", 1, "eye", -1),
    ("AU 12", "AU = 12 {:g} 60", 1, "corner_up", +1), ("AU 15", "AU = 15 {:g} 60", 1, "corner_up", -1),
    ("AU 18", "AU = 18 {:g} 60", 1, "width", -1), ("AU 20", "AU = 20 {:g} 60", 1, "width", +1),
    ("AU 25", "AU = 25 {:g} 60", 1, "gap", +1), ("AU 26", "AU = 26 {:g} 60", 1, "gap", +1),
    ("head down 12", "HeadRotAbs.1 = {:g} 0 0", 12, "turn_down", +1),
    ("head left 12", "HeadRotAbs.1 = 0 {:g} 0", 12, "turn_left", +1),
    ("tilt left 12", "HeadRotAbs.1 = 0 0 {:g}", 12, "tilt_left", +1),
    ("eyes left 20", "EyeRot = 0 {:g} 0", 20, "gaze_across", +1),
]

AGAINST = {("original", "tilt left 12")}  # a configuration of the original tilts to the other side (docs/face.md)


def frames_of(wear, folder, environment):
    """The face at rest, then each unit at each strength, as face_watch saw it: Tracks by name, and the moments
    that each dose was held."""
    lines, held, at = [], [], HOLD_MS
    for _, command, full, _, _ in DOSES:
        for strength in (*STRENGTHS, 0):
            lines += ["to @FSM set " + command.format(full * strength), f"set Wait = {HOLD_MS}"]
            held.append((at + HOLD_MS / 2, at + HOLD_MS - 20))
            at += HOLD_MS
    film = films.posed(folder, wear, environment, [f"set Wait = {HOLD_MS}", *lines])
    return film, held


def values_of(film, name, start, end):
    """The median of a measure over some time; of both sides their mean."""
    tracks = [film.seen[key] for key in film.seen if key in (name, name + "_right", name + "_left")]
    return sum(median(track.between(start, end)) for track in tracks) / len(tracks)


def table(folder, heads):
    """Prints a row for each unit and a column for each head: the change at the three strengths, mm or degrees.
    Returns whether every dose was followed: more is more, and in the right direction."""
    columns = {}
    for head in heads:
        own = os.path.join(folder, head)
        os.mkdir(own)
        try:
            film, held = frames_of(HEADS[head](own), own, {"GALATEA_FACES": own})
        except Missing as missing:
            print(f"judge_film: {head} is left out: {missing}")
            continue
        columns[head] = []
        for k, (told, _, _, name, sign) in enumerate(DOSES):
            sign = -sign if (head, told) in AGAINST else sign
            *doses, rest = held[4 * k:4 * k + 4]
            before = values_of(film, name, *rest)
            columns[head].append([(values_of(film, name, *dose) - before) * sign for dose in doses])
    print("| told | seen in | " + " | ".join(columns) + " |\n| --- | --- |" + " --- |" * len(columns))
    right = True
    for k, (told, _, _, name, sign) in enumerate(DOSES):
        cells = []
        for head in columns:
            low, middle, high = columns[head][k]
            follows = high > middle > low > 0
            right = right and follows
            digits = 2 if name.startswith("gaze") else 1
            cells.append(" ".join(f"{value:.{digits}f}" for value in (low, middle, high)) + ("" if follows else "*"))
        print(f"| {told} | {name}{' less' if sign < 0 else ''} | " + " | ".join(cells) + " |")
    return right
