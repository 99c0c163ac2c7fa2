#!/usr/bin/env python3
"""The fresh-food order: the shopkeeper says "yes" and nods in the middle of the customer's sentence,
as soon as an item can be understood from the partial result, and repeats the order at the end.

Runs without a sound card; see echo_back.py. Usage: fresh_food.py --bin FOLDER
"""

import argparse
import tempfile

from modules import Module, speak_to_file

GRAMMAR = """$count = one {1} | two {2} | three {3} | four {4}
$food = (apple | apples) {apples} | (fish) {fish} | (tomato | tomatoes) {tomatoes} | (egg | eggs) {eggs}
$item = $count [pounds of] $food
(i want | give me) $item [and] $item [[and] $item] [please]
"""
FOODS = ("apples", "fish", "tomatoes", "eggs")
ORDER = "I want two apples and three pounds of fish and four eggs please."


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True, help="folder of the programs ssm and srm")
    options = parser.parse_args()
    voice = Module(options.bin, "ssm", "--sink", "null")
    ear = Module(options.bin, "srm")
    acknowledged, meaning = [], ""
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/order.gram", "w", encoding="utf-8") as grammar:
            grammar.write(GRAMMAR)
        speak_to_file(voice, "rms", ORDER, f"{folder}/order.wav")
        print(f"customer: {ORDER}")
        ear.tell(f"set Grammar.file = order {folder}/order.gram", "set Grammar = order",
                 f"set Input = wav:{folder}/order.wav", "set Run = START")
        for line in ear.lines("rep Input = NONE"):
            if line.startswith("rep Result.partial = "):
                words = line[len("rep Result.partial = "):].split()
                for food in FOODS:
                    # The last word may still change, so an item counts when another word follows.
                    if food in words[:-1] and food not in acknowledged:
                        acknowledged.append(food)
                        print(f"  after '{' '.join(words)}'\n  shopkeeper: yes (set FaceMot = NOD 1)")
            if line.startswith("rep Result.tag = "):
                meaning = line[len("rep Result.tag = "):]
    parts = meaning.split(";")
    order = [f"{count} {food}" for count, food in zip(parts[::2], parts[1::2])]
    voice.tell("set Speaker = slt", f"set Text = That is {', '.join(order)}.", "set Speak = NOW")
    print(f"shopkeeper: {voice.wait_for('rep Speak.text = ')}")
    voice.wait_for("rep Speak.len")
    voice.end()
    ear.end()
    good = order == ["2 apples", "3 fish", "4 eggs"] and acknowledged[:2] == ["apples", "fish"]
    print("order understood, two items acknowledged in mid-sentence" if good else "not as ordered")
    return 0 if good else 1


if __name__ == "__main__":
    raise SystemExit(main())
