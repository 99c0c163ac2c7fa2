#!/usr/bin/env python3
"""Fetches recordings of people with their text for `vdm_train --people`:

    scripts/people_speech.py FOLDER

They are what people of eight languages say of the stamps of Tux Paint (Debian's tuxpaint-stamps-default, 180 MB; their
licence is GPL-2, and nothing of them is in this repository). FOLDER/list has a line for each of some 3200: its file, its
language and its text. What lies in FOLDER already is not fetched again.
"""
import argparse
import pathlib
import subprocess
import sys

PACKAGE = "tuxpaint-stamps-default"
LANGUAGES = "bg ca el en es fr ro ru".split()
MOST = 450  # of one language, spread over all there are


def fetch(folder):
    """The folder with the stamps, from the package."""
    stamps = folder / "usr/share/tuxpaint/stamps"
    if not stamps.is_dir():
        print(f"people_speech: fetching {PACKAGE}", file=sys.stderr)
        subprocess.run(["apt-get", "download", "-q", PACKAGE], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        package = next(folder.glob(f"{PACKAGE}_*.deb"))
        subprocess.run(["dpkg-deb", "-x", package, folder], check=True)
        package.unlink()
    return stamps


def text_of(lines, language):
    """What is said: the first line in English, a line LANGUAGE.utf8=TEXT in others."""
    if language == "en":
        return lines[0].strip()
    key = f"{language}.utf8="
    return next((line[len(key):].strip() for line in lines if line.startswith(key)), "")


def recordings(stamps, language):
    """Path and text of each recording of a language, by name."""
    ending = "_desc.ogg" if language == "en" else f"_desc_{language}.ogg"
    for sound in sorted(stamps.rglob(f"*{ending}")):
        description = sound.with_name(sound.name.removesuffix(ending) + ".txt")
        if description.exists():
            text = text_of(description.read_text("utf-8", "replace").splitlines(), language)
            if text:
                yield sound, text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    stamps = fetch(folder)
    lines = []
    for language in LANGUAGES:
        found = list(recordings(stamps, language))
        count = min(len(found), MOST)
        chosen = [found[i * len(found) // count] for i in range(count)]
        lines += [f"{sound.relative_to(folder)}\t{language}\t{text}\n" for sound, text in chosen]
        print(f"people_speech: {language}: {count} of {len(found)} recordings", file=sys.stderr)
    (folder / "list").write_text("".join(lines), "utf-8")


if __name__ == "__main__":
    main()
