#!/usr/bin/env python3
"""How long a talking agent takes to answer:

    scripts/chat_latency.py [--turns 20] [--ear typed|live] [--no-face] [--bin build/bin]

The real hub, voice (flite), face and conversation on the real clock, with a stand-in for the language model that answers at
once (tests/chat/stub_model.py), so what is measured is ours. The voice's sound goes through a pipe (ssm --sink raw), and the
first sound is the first sample that is loud when it comes out of it. The user's words are typed into the ear's stand-in, or,
--ear live, sound at its own pace in the real ear, spoken by the voice rms: then their end is the last loud sample that
went in, and the silence the ear waits for (Listen.silence, 500 ms) is part of the answer.

Prints for each stage the median and the worst in ms. The goals: 700 from the words' end to the first sound, 300 from the first
whole sentence to it.
"""
import argparse
import array
import json
import os
import pathlib
import socket
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import wave

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))
import galatea  # noqa: E402

WORDS = ["good morning", "what is your name", "how are you today", "i would like a cup of tea", "where is the station",
         "can you hear me", "tell me about the weather", "thank you very much", "what time is it", "see you tomorrow"]
LOUD = 300  # of 32768: -41 dB
PIECE_S = 0.02
GOALS_MS = {"words to sound": 700, "sentence to sound": 300}


class Loudspeaker(threading.Thread):
    """Reads what the voice plays, and notes when it is loud."""

    def __init__(self, path):
        super().__init__(daemon=True)
        self.path, self.loud_at, self.heard = path, 0.0, threading.Condition()

    def run(self):
        with open(self.path, "rb", buffering=0) as pipe:
            while piece := pipe.read(4096):
                now = time.monotonic()
                samples = array.array("h", piece[:len(piece) // 2 * 2])
                if samples and max(map(abs, samples)) > LOUD:
                    with self.heard:
                        self.loud_at = now
                        self.heard.notify()


class Microphone:
    """Plays recordings into the real ear at their own pace, and silence between them."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.sound, self.lock, self.end_of_words = b"", threading.Lock(), 0.0
        threading.Thread(target=self.run, daemon=True).start()

    def say(self, samples, rate):
        last = max(i for i, value in enumerate(samples) if abs(value) > LOUD)
        with self.lock:
            self.sound += samples.tobytes()
            self.end_of_words = time.monotonic() + last / rate

    def run(self):
        size, at = int(16000 * PIECE_S) * 2, time.monotonic()
        while True:
            with self.lock:
                piece, self.sound = self.sound[:size], self.sound[size:]
            try:
                self.socket.sendall(piece.ljust(size, b"\0"))
            except BrokenPipeError:  # the ear has ended
                return
            at += PIECE_S
            time.sleep(max(0, at - time.monotonic()))


def recording(program, words, folder):
    """The samples of those words, 16 kHz."""
    path = os.path.join(folder, "words.wav")
    lines = f"set Text = {words}\nset Speak = NOW\n"
    subprocess.run([program, "--speaker", "rms", "--sink", "file:" + path], input=lines, text=True, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with wave.open(path) as file:
        if file.getframerate() != 16000:
            raise SystemExit(f"chat_latency: {program}: 16 kHz expected, found {file.getframerate()} Hz")
        return array.array("h", file.readframes(file.getnframes()))


def configuration(options, folder, url):
    bin_folder = os.path.abspath(options.bin)
    ear = ["srm_stub"] if options.ear == "typed" else ["srm", "--live"]
    modules = [("SSM", ["ssm", "--sink", "raw:" + folder + "/sound"]), ("SRM", ear),
               ("CHAT", ["chat", "--model-url", url, "--model", "echo"])]
    if not options.no_face:
        modules.append(("FSM", ["fsm", "--headless", "--life", "LIVELY"]))
    after = {"CHAT": ["SSM", "SRM"]}
    return {"listen": [{"role": "owner", "at": f"unix:{folder}/hub"}],
            "modules": [{"name": name, "command": [bin_folder + "/" + command[0], *command[1:]], "after": after.get(name, [])}
                        for name, command in modules]}


def one_turn(hub, loudspeaker, say):
    """Milliseconds of each stage, from the end of the words on."""
    while next(hub.messages(0), None):  # what is left of the turn before
        pass
    end_of_words = say()
    times = {}
    until = time.monotonic() + 30
    wanted = {("SRM", "Result"): "result", ("SRM", "NoMatch"): "result", ("CHAT", "Reply.sentence"): "sentence",
              ("SSM", "Speak.stat"): "speaking"}
    while "speaking" not in times and time.monotonic() < until:
        for message in hub.messages(0.5):
            name = wanted.get((message.sender, message.slot))
            if name and (name != "speaking" or message.value == "SPEAKING"):
                times.setdefault(name, time.monotonic())
            if "speaking" in times:
                break
    if len(times) < 3:
        raise SystemExit(f"chat_latency: no answer within 30 s; seen: {', '.join(times) or 'nothing'}")
    with loudspeaker.heard:
        if not loudspeaker.heard.wait_for(lambda: loudspeaker.loud_at > times["sentence"], 10):
            raise SystemExit("chat_latency: the voice said that it speaks, and no sound came")
        times["sound"] = loudspeaker.loud_at
    hub.wait_for("Busy", "IDLE", "CHAT", 60)
    words = times["result"] if end_of_words is None else end_of_words()
    return {"words to result": times["result"] - words, "result to sentence": times["sentence"] - times["result"],
            "sentence to voice": times["speaking"] - times["sentence"],
            "voice to loud sample": times["sound"] - times["speaking"],
            "sentence to sound": times["sound"] - times["sentence"], "words to sound": times["sound"] - words}


def measure(options, folder):
    os.mkfifo(folder + "/sound")
    loudspeaker = Loudspeaker(folder + "/sound")
    loudspeaker.start()
    with subprocess.Popen([sys.executable, str(ROOT / "tests/chat/stub_model.py")], stdout=subprocess.PIPE, text=True) as model:
        port = model.stdout.readline().strip()
        threading.Thread(target=model.stdout.read, daemon=True).start()
        with open(folder + "/hub.json", "w", encoding="utf-8") as file:
            json.dump(configuration(options, folder, "http://127.0.0.1:" + port), file)
        program = subprocess.Popen([options.bin + "/agent_manager", "--config", folder + "/hub.json", "--no-console"])
        try:
            return turns(options, folder, loudspeaker)
        finally:
            program.terminate()
            program.wait()
            model.terminate()


def turns(options, folder, loudspeaker):
    until = time.monotonic() + 30
    while not os.path.exists(folder + "/hub"):
        if time.monotonic() > until:
            raise SystemExit("chat_latency: the hub did not start")
        time.sleep(0.05)
    found = []
    with galatea.Client.connect(f"unix:{folder}/hub") as hub:
        hub.subscribe("SRM", "CHAT", "SSM")
        hub.wait_for("Listen.stat", "LISTENING", "SRM", 30)
        microphone = None
        if options.ear == "live":
            hub.set("Input", f"unix:{folder}/ear", to="SRM")
            microphone = Microphone(folder + "/ear")
            time.sleep(1)  # the ear learns how loud silence is
        for number in range(options.turns + 1):
            words = WORDS[number % len(WORDS)]

            def say():
                if microphone is None:
                    hub.send(f"set Input.text = {words}", to="SRM")
                    return None
                microphone.say(recording(options.bin + "/ssm", words, folder), 16000)
                return lambda: microphone.end_of_words

            found.append(one_turn(hub, loudspeaker, say))
            time.sleep(0.3)
    return found[1:]  # the first wakes everybody


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--turns", type=int, default=20)
    options.add_argument("--ear", choices=["typed", "live"], default="typed")
    options.add_argument("--no-face", action="store_true")
    options.add_argument("--bin", default=str(ROOT / "build/bin"))
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = measure(given, folder)
    print(f"{given.turns} turns, ear {given.ear}, {'without' if given.no_face else 'with'} face, ms    median   worst")
    for stage in found[0]:
        values = [turn[stage] * 1000 for turn in found]
        goal = GOALS_MS.get(stage)
        print(f"{stage:<44}{statistics.median(values):8.0f}{max(values):8.0f}" + (f"   goal {goal}" if goal else ""))


if __name__ == "__main__":
    main()
