#!/usr/bin/env python3
"""The echo-back task: what the agent hears, it says, and it nods while it listens.

Runs without a sound card: what the person says is made by the voice, the ear hears it from a file,
and the answer is spoken on a virtual clock. Usage: echo_back.py --bin FOLDER [SENTENCE...]
"""

import argparse
import tempfile

from modules import Module, speak_to_file

GRAMMAR = ("good morning | what time is it | turn (on | off) the (light | radio) [please] | "
           "my name is (anna | peter)")
SENTENCES = ["Good morning.", "Turn on the light, please.", "My name is Peter."]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True, help="folder of the programs ssm and srm")
    parser.add_argument("sentences", nargs="*", default=SENTENCES)
    options = parser.parse_args()
    voice = Module(options.bin, "ssm", "--sink", "null")
    ear = Module(options.bin, "srm")
    ear.tell(f"set Grammar.load = echo {GRAMMAR}", "set Grammar = echo", "set Run = START")
    right = 0
    with tempfile.TemporaryDirectory() as folder:
        for sentence in options.sentences:
            speak_to_file(voice, "rms", sentence, f"{folder}/said.wav")
            print(f"person: {sentence}")
            ear.tell(f"set Input = wav:{folder}/said.wav")
            heard, nodded = "", False
            for line in ear.lines("rep Input = NONE"):
                if line.startswith("rep Result.partial = ") and not nodded:
                    print("  face: set FaceMot = NOD 1")
                    nodded = True
                if line.startswith("rep Result = "):
                    heard = line[len("rep Result = "):]
            voice.tell("set Speaker = slt", f"set Text = {heard or 'Pardon?'}", "set Speak = NOW")
            said = voice.wait_for("rep Speak.text = ")
            voice.wait_for("rep Speak.len")
            voice.wait_for("rep Speak.stat = IDLE")
            print(f"agent: {said}")
            plain = "".join(c for c in sentence.lower() if c.isalpha() or c == " ")
            right += said == plain
    voice.end()
    ear.end()
    print(f"{right} of {len(options.sentences)} echoed")
    return 0 if right == len(options.sentences) else 1


if __name__ == "__main__":
    raise SystemExit(main())
