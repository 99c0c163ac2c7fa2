#!/usr/bin/env python3
"""Checks scripts/subtitles.py by a log made here."""
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts/subtitles.py"
LOG = """# galatea session log 1: ms, sender, receivers, line
400\tCHAT\t-\tFrom @CHAT rep Heard = before the film
1000\tAM-MCL\tFSM\tto @FSM set Record = a.mp4
2500\tCHAT\t-\tFrom @CHAT rep Heard = hello <there>
2600\tCHAT\t-\tFrom @CHAT rep Reply.sentence = Hello! This sentence is so long that it needs more than the two lines there are.
2700\tSSM\t-\tFrom @SSM rep Speak.stat = SPEAKING
6000\tSSM\t-\tFrom @SSM rep Speak.stat = IDLE
"""

with tempfile.TemporaryDirectory() as folder:
    log, film = pathlib.Path(folder, "log"), pathlib.Path(folder, "a.mp4")
    log.write_text(LOG, encoding="utf-8")
    subprocess.run([sys.executable, SCRIPT, log, film], check=True)
    srt, vtt = film.with_suffix(".srt").read_text(), film.with_suffix(".vtt").read_text()
for text, part in ((srt, "1\n00:00:00,300 --> 00:00:01,500\n<i>hello <there></i>\n"), (srt, "2\n00:00:01,700 --> "),
                   (srt, " --> 00:00:05,000\n"), (vtt, "<v User>hello &lt;there>\n"), (vtt, "WEBVTT\n\n00:00:00.300 --> ")):
    if part not in text:
        sys.exit(f"subtitles_test: '{part}' expected in:\n{text}")
if "before" in srt or max(map(len, srt.splitlines())) > 50:
    sys.exit(f"subtitles_test: wrong:\n{srt}")
