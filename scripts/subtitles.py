#!/usr/bin/env python3
"""Subtitles of a conversation's film, out of the hub's log:

    scripts/subtitles.py SESSION.log FILM.mp4       writes FILM.srt and FILM.vtt

What the agent says (Reply.sentence of @CHAT) is shown while its voice sounds, what the user says (Heard) before it was
answered. Times count from when the film began (Record of @FSM).
"""
import pathlib
import re
import sys
import textwrap

COLUMNS, LINES = 42, 2
SHORTEST_MS, PER_SIGN_MS = 1200, 60  # of what the user said, which has no length


def events(log):
    """(ms, sender, receivers, line) of each message."""
    with open(log, encoding="utf-8", errors="replace") as file:
        for row in file:
            fields = row.rstrip("\n").split("\t", 3)
            if not row.startswith("#") and len(fields) == 4:
                yield float(fields[0]), *fields[1:]


def spoken(log):
    """[begin ms, end ms, whether the user says it, text] in order, from the film's beginning."""
    start, sentence, found = None, None, []
    for at, sender, receivers, line in events(log):
        report = re.search(r"\brep (\S+) = (.*)$", line)
        if start is None:
            if "FSM" in receivers and " Record = " in line and not line.endswith("STOP"):
                start = at
            continue
        slot, value = report.groups() if report else ("", "")
        if sender == "CHAT" and slot == "Heard":
            since = found[-1][1] if found else 0
            length = max(SHORTEST_MS, PER_SIGN_MS * len(value))
            found.append([max(at - start - length, min(since, at - start)), at - start, True, value])
        elif sender == "CHAT" and slot == "Reply.sentence":
            sentence = value
        elif sender == "SSM" and slot == "Speak.stat" and value == "SPEAKING" and sentence:
            found.append([at - start, None, False, sentence])
            sentence = None
        elif sender == "SSM" and slot == "Speak.stat" and value == "IDLE" and found and found[-1][1] is None:
            found[-1][1] = at - start
    return [cue for cue in found if cue[1] is not None]


def cues(said):
    """The same in pieces of at most LINES lines, each with its share of the time."""
    for begin, end, user, text in said:
        lines = textwrap.wrap(text, COLUMNS) or [""]
        pieces = ["\n".join(lines[i:i + LINES]) for i in range(0, len(lines), LINES)]
        total = sum(map(len, pieces)) or 1
        for piece in pieces:
            until = begin + (end - begin) * len(piece) / total
            if len(pieces) == 1:
                until = end
            yield begin, until, user, piece
            begin, total, end = until, total - len(piece) or 1, end


def clock(ms, point):
    ms = round(ms)
    return f"{ms // 3600000:02}:{ms // 60000 % 60:02}:{ms // 1000 % 60:02}{point}{ms % 1000:03}"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    log, film = sys.argv[1], pathlib.Path(sys.argv[2])
    shown = list(cues(spoken(log)))
    srt = "".join(f"{i}\n{clock(begin, ',')} --> {clock(end, ',')}\n{f'<i>{text}</i>' if user else text}\n\n"
                  for i, (begin, end, user, text) in enumerate(shown, 1))
    vtt = "WEBVTT\n\n" + "".join(
        f"{clock(begin, '.')} --> {clock(end, '.')}\n<v {'User' if user else 'Agent'}>"
        f"{text.replace('&', '&amp;').replace('<', '&lt;')}\n\n" for begin, end, user, text in shown)
    film.with_suffix(".srt").write_text(srt, encoding="utf-8")
    film.with_suffix(".vtt").write_text(vtt, encoding="utf-8")


if __name__ == "__main__":
    main()
