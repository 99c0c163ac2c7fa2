#!/usr/bin/env python3
"""Manual pages and what programs say of themselves:  scripts/man_pages.py BIN_FOLDER [--check]

Pages of docs/man whose second line is `.\\" options from --help` get their OPTIONS from the program's --help; of the others
it is checked that they name every option the program has (those that all modules have may stand in galatea-module.7).
With --check nothing is written; ends with 1 and a sentence for each difference. Programs that are not in the folder are
passed over.
"""
import pathlib
import re
import subprocess
import sys

bin_folder = pathlib.Path(sys.argv[1])
check = "--check" in sys.argv
man = pathlib.Path(__file__).resolve().parent.parent / "docs/man"
MARK = '.\\" options from --help'


def options_of(program):
    """[(names, value, text)] of a --help as CLI11 writes it; positionals have no dash."""
    said = subprocess.run([program, "--help"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True).stdout
    found, inside = [], False
    for line in said.splitlines():
        if re.match(r"(Options|Positionals):$", line):
            inside = True
        elif inside and (entry := re.match(r"  (\S.*?)(?:  +(\S.*))?$", line)) and not line.startswith("    "):
            words = entry[1].split(" ", 1)
            found.append([re.sub(r"\{.*?\}", "", words[0]), value_of(words[1] if len(words) > 1 else ""), entry[2] or ""])
        elif inside and line.startswith("      ") and found:
            found[-1][2] = (found[-1][2] + " " + line.strip()).strip()
        elif line and not line.startswith(" "):
            inside = False
    return found


def value_of(text):
    if choices := re.search(r"\{(.*?)\}", text):
        return choices[1].replace(",", "|")
    value = re.sub(r"\(Env:.*?\)|REQUIRED|Needs:.*|Excludes:.*|:\S.*|=\S+", "", text).strip()
    return {"TEXT": "VALUE", "INT": "N", "UINT": "N", "FLOAT": "N", "INT x 2": "N N"}.get(value, value.replace("TEXT", "VALUE"))


def roff(text):
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", "\\e").replace("-", "\\-"))


def section(options):
    lines = []
    for names, value, text in options:
        if names.startswith("-"):
            head = ".BR " + ' ", " '.join(roff(name) for name in names.split(","))
            lines += [".TP", head + (f' " \\fI{roff(value)}\\fR"' if value else "")]
        else:
            lines += [".TP", ".I " + roff(names)]
        lines.append(roff(text) or "\\&")
    return "\n".join(lines) + "\n"


wrong = []
common = {name for names, _, _ in options_of(bin_folder / "srm_stub") for name in names.split(",")}
common_page = (man / "galatea-module.7").read_text().replace("\\-", "-")
wrong += [f"galatea-module.7 does not name {name}" for name in common if name.startswith("--") and name not in common_page]
for page in sorted(man.glob("*.1")):
    program = bin_folder / page.stem
    if not program.exists():
        continue
    text = page.read_text()
    options = options_of(program)
    if MARK in text:
        made = re.sub(r"(?<=\.SH OPTIONS\n)(?:(?!\.SH ).*\n)*", lambda _: section(options), text)
        if made != text and check:
            wrong.append(f"{page.name} is not what {page.stem} --help says: run scripts/man_pages.py {bin_folder}")
        elif made != text:
            page.write_text(made)
        continue
    plain = text.replace("\\-", "-")
    passed = {"--help", "--version"} | (common if "galatea-module" in plain else set())
    for names, _, _ in options:
        for name in names.split(","):
            if name.startswith("--") and name not in plain and name not in passed:
                wrong.append(f"{page.name} does not name {name}")
for sentence in wrong:
    print(f"man_pages: {sentence}", file=sys.stderr)
sys.exit(bool(wrong))
