"""The same agent on the machine's own clock: how far lips are from the sound, phoneme by phoneme and as it is seen.

The sound's place is read from its samples, the mouth's from what the face reports and from the film; both clocks are
brought to the session's by the offsets that the hub measures.
"""
import json
import os
import statistics
import subprocess

from film_judge import films
from film_judge.measures import phoneme_times
from film_judge.programs import BIN, Failed, program


class LiveHub:
    """A hub that is typed at, and what comes back meanwhile."""

    def __init__(self, folder):
        config = os.path.join(folder, "config.json")
        with open(config, "w", encoding="ascii") as file:
            json.dump({"clock": "real", "modules": [
                {"name": "SSM", "command": [BIN + "/ssm", "--sink", "null"]},
                {"name": "FSM", "command": [BIN + "/fsm", "--headless", "--size", f"{films.SIZE}x{films.SIZE}"]}]}, file)
        self.process = subprocess.Popen([program("agent_manager"), "--config", config], cwd=folder, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.lines = []

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self.process.stdin.close()
        self.process.stdout.read()
        self.process.wait()

    def do(self, line, until="rep#f "):
        """Says a line and reads until its answer, which is returned."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        for answer in self.process.stdout:
            answer = answer.rstrip("\n")
            self.lines.append(answer)
            if until in answer:
                if ".error" in answer:
                    raise Failed("the hub: " + answer)
                return answer.partition(" = ")[2]
        raise Failed(f"the hub ended before it answered '{line}'")

    def ask(self, receiver, slot):
        return self.do(f"to @{receiver} inq#q {slot}", f"rep#q {slot}")


def spoken(folder, speaker, text):
    """The film, and for each phoneme by how many ms its mouth was drawn later than its sound began, beyond the lead:
    (name, ms)."""
    film = films.Film()
    film.sound = os.path.join(folder, "voice.wav")
    picture = os.path.join(folder, "film.mp4")
    with LiveHub(folder) as hub:
        for line in (f"to @FSM set#f Camera = {films.CAMERA}", f"to @SSM set#f Speaker = {speaker}",
                     "to @FSM prop#f Frame = AutoOutput"):
            hub.do(line)
        lead = float(hub.ask("FSM", "LipSync.lead"))
        before = float(hub.ask("SSM", "Clock"))
        hub.do(f"to @SSM set#f Record = {film.sound}")
        tape = (before + float(hub.ask("SSM", "Clock"))) / 2
        hub.do(f"to @FSM set#f Record = {picture}")
        hub.do("to @AM-MCL set#f Speak = " + text, "rep#f Speak")
        offsets = {part.split()[0]: float(part.split()[1]) for part in hub.ask("AM", "Clocks").split(", ")}
        for module in ("SSM", "FSM"):
            hub.do(f"to @{module} set#f Record = STOP")
        lines = hub.lines
    frames = [films.value_of(line).split() for line in lines if line.startswith("From @FSM rep Frame = ")]
    drawn = [(int(f[0]), float(f[1]) - offsets["FSM"], f[2]) for f in frames]
    first = next(k for k, frame in enumerate(drawn) if frame[0] == 0)  # earlier ones are of no film
    film_start = drawn[first][1]
    sound_start = tape - offsets["SSM"] + films.utterances(film.sound)[0] - film_start
    phonemes = [films.parse_phonemes(films.value_of(line)) for line in lines
                if line.startswith("From @SSM rep Text.pho = ")][0]
    film.begins, film.spans = [sound_start], phoneme_times(phonemes, sound_start)
    pixels = subprocess.run(["ffmpeg", "-v", "error", "-i", picture, "-f", "rawvideo", "-pix_fmt", "rgba", "-"],
                            check=True, stdout=subprocess.PIPE).stdout
    films.watched(film, films.rows_of(pixels))
    films.told(film, lines)
    return film, errors(film.spans, [(t - film_start, name) for _, t, name in drawn[first:]], lead)


def errors(spans, frames, lead):
    """When each phoneme's mouth was first drawn minus when its sound began, beyond the lead. One as short as a frame may
    fall between two, one after another of the same name cannot be told from it: these are left out."""
    found = []
    for k, (name, start, end) in enumerate(spans):
        near = [t for t, drawn in frames if drawn == name and start - lead - 100 < t < end - lead + 100]
        if near and (k == 0 or spans[k - 1][0] != name) and end - start > 1000 / films.RATE:
            found.append((name, near[0] - start + lead))
    return found


def summary(found):
    sizes = sorted(abs(error) for _, error in found)
    return (f"{len(found)} phonemes: beyond the lead, median {statistics.median(e for _, e in found):+.1f} ms, 95th "
            f"percentile {sizes[min(len(sizes) - 1, int(0.95 * len(sizes)))]:.1f} ms, worst {sizes[-1]:.1f} ms "
            f"(one frame is {1000 / films.RATE:.1f} ms)")
