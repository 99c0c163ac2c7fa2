"""Every link of every Markdown file leads somewhere, and every page of docs/ is reached from the README.

    links_test.py [FOLDER]     the root of the toolkit by default
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else __file__).resolve()
ROOT = ROOT if ROOT.is_dir() else ROOT.parent.parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^()\s]+(?:\([^()\s]*\))?)\)|\[[^\]]+\]: (\S+)|<(?:img|a) [^>]*(?:src|href)=\"([^\"]+)\"")


def pages() -> list[pathlib.Path]:
    return sorted(page for page in ROOT.rglob("*.md")
                  if not any(part.startswith((".", "build")) for part in page.relative_to(ROOT).parts))


def prose(page: pathlib.Path) -> list[tuple[int, str]]:
    """The numbered lines of a page without its code."""
    lines, fence = [], ""
    for number, line in enumerate(page.read_text().splitlines(), 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and not fence:
            fence = mark[1]
        elif mark and mark[1].startswith(fence):
            fence = ""
        elif not fence and not line.startswith("    "):
            lines.append((number, re.sub(r"`[^`]*`", "", line)))
    return lines


def anchors(page: pathlib.Path) -> set[str]:
    """The headings of a page as GitHub names them in addresses."""
    found: set[str] = set()
    for _, line in prose_with_code(page):
        heading = re.match(r"#{1,6} +(.*?)[ #]*$", line)
        if heading:
            name = re.sub(r"[^\w\- ]", "", heading[1].lower()).replace(" ", "-")
            found.add(next(one for one in (name, *(f"{name}-{n}" for n in range(1, 1000))) if one not in found))
    return found


def prose_with_code(page: pathlib.Path) -> list[tuple[int, str]]:
    numbers = {number for number, _ in prose(page)}
    return [(number, line) for number, line in enumerate(page.read_text().splitlines(), 1) if number in numbers]


def links(page: pathlib.Path) -> list[tuple[int, str]]:
    lines = dict(prose(page))
    text = "\n".join(lines.get(number, "") for number in range(1, max(lines, default=0) + 1))
    return [(text.count("\n", 0, found.start()) + 1, next(filter(None, found.groups()))) for found in LINK.finditer(text)]


class LinksTest(unittest.TestCase):
    def test_every_link_leads_somewhere(self) -> None:
        broken, seen = [], 0
        for page in pages():
            for number, link in links(page):
                if re.match(r"[a-z]+:", link):
                    continue  # outside of the toolkit
                seen += 1
                path, _, anchor = link.partition("#")
                target = (page.parent / path).resolve() if path else page
                if not target.exists():
                    broken.append(f"{page.relative_to(ROOT)}:{number}: there is no '{path}'")
                elif anchor and anchor not in anchors(target):
                    broken.append(f"{page.relative_to(ROOT)}:{number}: '{path or page.name}' has no heading '#{anchor}'")
        self.assertGreater(seen, 50)
        self.assertEqual(broken, [], "\n".join(broken))

    def test_every_page_of_the_documentation_is_reached_from_the_readme(self) -> None:
        reached, waiting = set(), [ROOT / "README.md"]
        while waiting:
            page = waiting.pop()
            if page in reached or not page.exists():
                continue
            reached.add(page)
            waiting += [(page.parent / link.partition("#")[0]).resolve() for _, link in links(page)
                        if link.partition("#")[0].endswith(".md")]
        lost = [str(page.relative_to(ROOT)) for page in pages() if page not in reached
                and (ROOT / "docs" in page.parents or page.parent == ROOT)]
        self.assertEqual(lost, [])


if __name__ == "__main__":
    unittest.main()
