"""Films of an agent on the virtual clock, watched by face_watch while they are made.

The frames go through a named pipe, so no film is kept; nothing between the renderer and the eye
loses detail.
"""
import csv
import io
import json
import math
import os
import subprocess
import threading
import wave

from film_judge.measures import Track, phoneme_times
from film_judge.programs import BIN, Failed, program

SIZE = 256
RATE = 30
CAMERA = "0.66 5 15"  # the face fills the picture
LEAD_MS = 40  # LipSync.lead as it is at the start
VOICE_DELAY_MS = 100  # Delay of vdm
BEFORE_MS = 1000


class Film:
    """What was told and what is seen. All times are those of the film."""

    def __init__(self):
        self.seen = {}  # name of a measure -> Track
        self.told_gap = self.told_width = None  # Tracks of what the face says of its own mesh
        self.begins = []  # when each utterance sounds first
        self.spans = []  # phonemes: (name, start, end), when they sound
        self.faces = self.frames = 0  # frames with a face, all frames
        self.sound = ""  # the recording's path

    @property
    def end(self):
        return 1000 * (self.frames - 1) / RATE


class Watcher:
    """face_watch at the reading end of a pipe."""

    def __init__(self, pipe, rate=RATE):
        os.mkfifo(pipe)
        self.pipe = pipe
        self.keeper = os.open(pipe, os.O_RDWR)  # so that neither end waits for the other
        self.process = subprocess.Popen([program("face_watch"), "--size", f"{SIZE}x{SIZE}", "--rate", str(rate)],
                                        stdin=os.open(pipe, os.O_RDONLY), stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.output = ["", ""]
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        self.output = self.process.communicate()

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        os.close(self.keeper)
        self.reader.join()
        os.remove(self.pipe)

    def rows(self):
        """What it printed, after the last frame."""
        os.close(self.keeper)
        self.keeper = os.open(os.devnull, os.O_RDONLY)
        self.reader.join()
        if self.process.returncode != 0:
            raise Failed("face_watch: " + self.output[1].strip())
        return list(csv.DictReader(io.StringIO(self.output[0])))


def rows_of(pixels):
    """What face_watch says of frames that are all there."""
    done = subprocess.run([program("face_watch"), "--size", f"{SIZE}x{SIZE}", "--rate", str(RATE)], input=pixels,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode != 0:
        raise Failed("face_watch: " + done.stderr.decode().strip())
    return list(csv.DictReader(io.StringIO(done.stdout.decode())))


def check_eye():
    """Raises Failed where face_watch cannot look, with its reason."""
    rows_of(bytes(SIZE * SIZE * 4))


def hub(modules, lines, folder, environment):
    """Runs the hub with a script; returns what it says."""
    config = os.path.join(folder, "config.json")
    with open(config, "w", encoding="ascii") as file:
        json.dump({"clock": "virtual",
                   "modules": [{"name": name, "command": command} for name, command in modules]}, file)
    done = subprocess.run([program("agent_manager"), "--config", config], input="\n".join(lines) + "\n", text=True,
                          cwd=folder, env={**os.environ, **environment}, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)
    said = done.stdout.splitlines()
    errors = [line for line in said if ".error = " in line]
    if done.returncode != 0 or errors:
        raise Failed("the hub: " + ("; ".join(errors) or done.stderr.strip()[-600:]))
    return said


def utterances(path, gap_ms=400):
    """When sound begins after the recording's silence of digital zeros, each time, in ms."""
    with wave.open(path) as sound:
        rate = sound.getframerate()
        samples = memoryview(sound.readframes(sound.getnframes())).cast("h")
    begins, last = [], None
    for k, sample in enumerate(samples):
        if sample == 0:
            continue
        if last is None or k - last > gap_ms * rate / 1000:
            begins.append(1000 * k / rate)
        last = k
    return begins


def delay(path, by_ms):
    """Puts silence before a recording."""
    with wave.open(path) as sound:
        form, samples = sound.getparams(), sound.readframes(sound.getnframes())
    with wave.open(path, "w") as sound:
        sound.setparams(form)
        sound.writeframes(bytes(form.sampwidth * form.nchannels * int(by_ms * form.framerate / 1000)) + samples)


def loudness(path):
    """The level of a recording over time, dB, from 10 dB below its median upwards."""
    with wave.open(path) as sound:
        rate = sound.getframerate()
        samples = memoryview(sound.readframes(sound.getnframes())).cast("h")
    hop = rate * 20 // 1000
    levels = []
    for at in range(0, len(samples) - hop, hop):
        power = sum(s * s for s in samples[at:at + hop:2]) / (hop / 2)
        levels.append(10 * math.log10(power + 1))
    loud = sorted(level for level in levels if level > 0)
    least = loud[len(loud) // 2] - 10 if loud else 0
    return Track([20 * k + 10 for k in range(len(levels))], [max(level, least) for level in levels])


def value_of(line):
    return line.split(" = ", 1)[1]


def parse_phonemes(text):
    items = text.replace("]", "").split()
    return [(name, float(ms)) for name, ms in (item.split("[") for item in items)]


def watched(film, rows):
    """Puts what face_watch printed into the film."""
    film.frames = len(rows)
    with_face = [row for row in rows if row["gap"]]
    film.faces = len(with_face)
    if film.faces < 10:
        raise Failed(f"a face is seen in {film.faces} of {film.frames} frames only")
    times = [float(row["ms"]) for row in with_face]
    for name in rows[0]:
        if name != "ms":
            film.seen[name] = Track(times, [float(row[name]) for row in with_face])
    film.seen["eyes"] = Track(times, [(a + b) / 2 for a, b in zip(film.seen["eye_right"].values,
                                                                 film.seen["eye_left"].values)])


def told(film, said):
    """What the face said of its own mouth, frame by frame."""
    frames = [value_of(line).split() for line in said if line.startswith("From @FSM rep Frame = ")]
    times = [1000 * k / RATE for k in range(len(frames))]
    film.told_gap = Track(times, [float(f[4]) for f in frames])
    film.told_width = Track(times, [float(f[5]) for f in frames])


def face_command(wear, more=()):
    return ("FSM", [BIN + "/fsm", "--headless", "--size", f"{SIZE}x{SIZE}", *wear, *more])


def setting_up(life, mode, extra):
    return [f"to @FSM set Camera = {CAMERA}", f"to @FSM set Life = {life}", f"to @FSM set LipSync.mode = {mode}", *extra,
            "to @FSM prop Frame = AutoOutput"]


def spoken(folder, wear, environment, texts, mode="DOMINANCE", life="LIVELY", extra=(), more=(),
           sound_late_ms=0):
    """The agent speaks texts, (speaker, text) each: voice and face in step by the hub. `extra`: lines typed before;
    `more`: options of fsm; `sound_late_ms`: sabotage, by how much the recording is delayed afterwards."""
    film = Film()
    film.sound = os.path.join(folder, "voice.wav")
    pipe = os.path.join(folder, "film.rgba")
    with Watcher(pipe) as watcher:
        said = hub([("SSM", [BIN + "/ssm", "--sink", "null"]), face_command(wear, more)],
                   [*setting_up(life, mode, extra), f"to @SSM set Record = {film.sound}",
                    f"to @FSM set Record = {pipe}", f"set Wait = {BEFORE_MS}",
                    *(line for speaker, text in texts for line in (
                        f"to @SSM set Speaker = {speaker}", f"to @AM-MCL set#said Speak = {text}", "set Wait = IDLE",
                        f"set Wait = {BEFORE_MS}")),
                    "to @SSM set Record = STOP", "to @FSM set#done Record = STOP", "set Wait = IDLE"],
                   folder, environment)
        watched(film, watcher.rows())
    told(film, said)
    phonemes = [parse_phonemes(value_of(line)) for line in said if line.startswith("From @SSM rep Text.pho = ")]
    if sound_late_ms:
        delay(film.sound, sound_late_ms)
    film.begins = utterances(film.sound)
    if len(film.begins) != len(texts) or len(phonemes) != len(texts):
        raise Failed(f"{len(texts)} texts were spoken, {len(film.begins)} are heard, {len(phonemes)} have phonemes")
    for said_phonemes, begin in zip(phonemes, film.begins):
        film.spans += phoneme_times(said_phonemes, begin)
    return film


def heard(folder, wear, environment, voice, mode="DOMINANCE", life="LIVELY", extra=(), more=()):
    """The face speaks with the sound of another film (`voice`), without being told the text. The sound is played
    as scripts/run_agent.sh does: as late as vdm is, and LEAD_MS later."""
    film = Film()
    film.sound = voice.sound
    pipe = os.path.join(folder, "film.rgba")
    with Watcher(pipe) as watcher:
        said = hub([("VDM", [BIN + "/vdm"]), face_command(wear, more)],
                   [*setting_up(life, mode, extra), f"to @VDM set#input Input = wav:{voice.sound}",
                    f"to @FSM set Record = {pipe}", "set Wait = 300", "to @VDM set#said Run = START",
                    "set Wait = IDLE", "set Wait = 300", "to @FSM set#done Record = STOP", "set Wait = IDLE"],
                   folder, environment)
        watched(film, watcher.rows())
    told(film, said)
    later = 300 + VOICE_DELAY_MS + LEAD_MS
    film.begins = [begin + later for begin in voice.begins]
    film.spans = [(name, start + later, end + later) for name, start, end in voice.spans]
    return film


def posed(folder, wear, environment, lines, rate=10):
    """The face alone, doing what `lines` of the hub's console say, at few frames a second."""
    film = Film()
    pipe = os.path.join(folder, "film.rgba")
    with Watcher(pipe, rate) as watcher:
        hub([face_command(wear)],
            [*setting_up("OFF", "DOMINANCE", []), f"to @FSM set Record.fps = {rate}", f"to @FSM set Record = {pipe}",
             *lines, "to @FSM set#done Record = STOP", "set Wait = IDLE"], folder, environment)
        watched(film, watcher.rows())
    return film
