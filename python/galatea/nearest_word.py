"""Names that were perhaps mistyped."""
from __future__ import annotations

from collections.abc import Iterable


def _changes(a: bytes, b: bytes) -> int:
    """Bytes to be changed, put in or left out, or neighbours exchanged (optimal string alignment)."""
    before: list[int] = []
    above = list(range(len(b) + 1))
    for i in range(1, len(a) + 1):
        row = [i]
        for j in range(1, len(b) + 1):
            least = min(above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1]))
            if i > 1 and j > 1 and a[i - 1] == b[j - 2] and a[i - 2] == b[j - 1]:
                least = min(least, before[j - 2] + 1)
            row.append(least)
        before, above = above, row
    return above[-1]


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """", did you mean 'NAME'?", or "" if none of the known names is near."""
    wanted = word.encode().lower()
    if not 0 < len(wanted) <= 128:
        return ""
    nearest = longer = ""
    least = min(2, (len(wanted) - 1) // 2) + 1
    for candidate in known:
        lower = candidate.encode().lower()
        if not longer and len(lower) > len(wanted) and lower.startswith(wanted):
            longer = candidate
        if abs(len(lower) - len(wanted)) < least and (changes := _changes(wanted, lower)) < least:
            least, nearest = changes, candidate
    guess = nearest or longer
    return f", did you mean '{guess}'?" if guess else ""
