"""From a film to its figures, and from figures to faults by the table of limits."""
import os

from film_judge import measures
from film_judge.films import LEAD_MS
from film_judge.heads import HEADS
from film_judge.programs import Failed

FIGURES = [  # name, heading, how it is printed
    ("seen", "face seen %", "{:.0f}"),
    ("told_gap_r", "r gap, own mesh", "{:.2f}"),
    ("told_gap_rms", "rms mm", "{:.1f}"),
    ("told_width_r", "r width, own mesh", "{:.2f}"),
    ("gap_r", "r gap, text", "{:.2f}"),
    ("width_r", "r width, text", "{:.2f}"),
    ("size", "size", "{:.2f}"),
    ("ahead", "mouth ahead ms", "{:+.0f}"),
    ("loudness_r", "r loudness", "{:.2f}"),
    ("closed", "p b m closed %", "{:.0f}"),
    ("mistakes", "shut by mistake %", "{:.1f}"),
    ("silence", "open in silence %", "{:.0f}"),
    ("blinks", "blinks a minute", "{:.0f}"),
    ("nod", "nod deg", "{:.1f}"),
    ("turn", "turn deg", "{:.1f}"),
    ("speed", "deg/s", "{:.0f}"),
]


def aligned(reference, film):
    """The gap and the width that the text asks for, on the film's clock. `reference`: a film of the same texts, whose
    face is trusted to do as it is told. Each utterance is moved to where it sounds."""
    def moved(track):
        ends = [(a + b) / 2 for a, b in zip(reference.begins, reference.begins[1:])] + [float("inf")]
        times, values = [], []
        for time, value in zip(track.times, track.values):
            k = next(i for i, end in enumerate(ends) if time < end)
            at = time + film.begins[k] - reference.begins[k]
            if not times or at > times[-1]:
                times.append(at)
                values.append(value)
        return measures.Track(times, values)
    return moved(reference.told_gap), moved(reference.told_width)


def figures(film, reference, loudness):
    """All figures of a film by name. `loudness`: of the recording, on its own clock, and when its first utterance
    begins there."""
    gap, width = film.seen["gap"], film.seen["width"]
    truth, true_width = aligned(reference, film)
    speech = min(film.begins) - 300, min(film.spans[-1][2] + 300, film.end)
    quiet = [(a, b) for a, b in measures.silences(film.spans, 0, film.end)]
    limit = measures.closed_limit(gap, quiet)
    wanted = [(a - LEAD_MS, b - LEAD_MS) for a, b in measures.closures(film.spans)]
    told, seen = measures.grid(film.told_gap, gap, *speech)
    late, _ = measures.lag(truth, gap, *speech)
    true_in_step = truth.moved(late)
    text, _ = measures.grid(true_in_step, gap, *speech)
    level, begin = loudness
    turns = [measures.smoothed(film.seen[name]) for name in ("turn_down", "turn_left", "tilt_left")]
    found = measures.closures_found(gap, wanted, limit)
    heard, opened = measures.grid(level.moved(film.begins[0] - begin - LEAD_MS), gap, *speech)
    return {
        "seen": 100 * film.faces / film.frames,
        "told_gap_r": measures.correlation(told, seen),
        "told_gap_rms": measures.line_through(told, seen)[2],
        "told_width_r": measures.correlation(*measures.grid(film.told_width, width, *speech)),
        "gap_r": measures.correlation(text, seen),
        "width_r": measures.correlation(*measures.grid(true_width.moved(late), width, *speech)),
        "size": measures.line_through(text, seen)[0],
        "ahead": LEAD_MS - late,
        "loudness_r": measures.correlation(heard, opened),
        "closed": 100 * sum(found) / len(found) if found else 0,
        "closures": len(found),
        "mistakes": 100 * measures.shut_by_mistake(gap, true_in_step, limit),
        "silence": 100 * measures.open_in_silence(gap, quiet, limit),
        "blinks": 60000 * len(measures.blinks(film.seen["eyes"])) / film.end,
        "nod": measures.span(turns[0]),
        "turn": measures.span(turns[1]),
        "speed": max(measures.speed(turn) for turn in turns),
    }


WAYS = ("DOMINANCE", "SINUSOID", "LINEAR", "voice")


def read_limits(path=os.path.join(os.path.dirname(os.path.abspath(__file__)), "limits.txt")):
    """The lines of the table as (head, way, figure, least, most). Raises Failed with file and line."""
    known = {name for name, _, _ in FIGURES}
    limits = []
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            words = line.split("#")[0].split()
            if not words:
                continue
            try:
                word, head, way, name, *ends = words
                least, most = (None if end == "-" else float(end) for end in ends)
                if word != "limit" or head not in ("all", *HEADS) or way not in ("all", *WAYS) or name not in known:
                    raise ValueError
            except ValueError:
                raise Failed(f"{path}:{number}: expected 'limit HEAD WAY FIGURE LEAST MOST', HEAD all or one of "
                             f"{' '.join(HEADS)}, WAY all or one of {' '.join(WAYS)}, FIGURE one of "
                             f"{' '.join(sorted(known))}") from None
            limits.append((head, way, name, least, most))
    return limits


def faults(values, head, way, limits):
    """The figures beyond their limits: name -> sentence."""
    found = {}
    for of_head, of_way, name, least, most in limits:
        if of_head not in ("all", head) or of_way not in ("all", way):
            continue
        value = values[name]
        if least is not None and value < least:
            found[name] = f"{name} {value:.2f}, at least {least:g} expected"
        if most is not None and value > most:
            found[name] = f"{name} {value:.2f}, at most {most:g} expected"
    return found


def table_head():
    return ("| head | way | " + " | ".join(heading for _, heading, _ in FIGURES) + " |\n"
            "| --- | --- |" + " --- |" * len(FIGURES))


def table_row(head, way, values, beyond):
    cells = [form.format(values[name]) + ("*" if name in beyond else "") for name, _, form in FIGURES]
    return f"| {head} | {way} | " + " | ".join(cells) + " |"
