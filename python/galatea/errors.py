"""What can go wrong, in the words of the protocol (docs/protocol.md, Errors)."""
from __future__ import annotations


class Refused(Exception):
    """A request that was refused: by a module or the hub, or by a slot of ours.

    `code` is a word of the protocol (BAD_VALUE, UNKNOWN_SLOT, ...); `column` is the byte, counted from 1, in the
    line or value where the fault was found, 0 if it has no place.
    """

    def __init__(self, code: str, text: str, column: int = 0) -> None:
        super().__init__(code, text, column)
        self.code = code
        self.text = text
        self.column = column

    def __str__(self) -> str:
        """As the wire writes it: CODE [column N:] text."""
        place = f" column {self.column}:" if self.column else ""
        return f"{self.code}{place} {self.text}".replace("\n", " ").replace("\r", " ")

    @staticmethod
    def read(text: str) -> Refused:
        """The refusal that `rep#TAG SLOT.error = TEXT` tells of."""
        code, _, rest = text.partition(" ")
        words = rest.split(" ", 2)
        if len(words) == 3 and words[0] == "column" and words[1][:-1].isdecimal() and words[1].endswith(":"):
            return Refused(code, words[2], int(words[1][:-1]))
        return Refused(code, rest)


class Ended(ConnectionError):
    """The other side has gone, or let us go."""
