"""Lines: what is read, what is refused and how, and that it is as the programs of the toolkit do it."""
import unittest

import support
from galatea.errors import Refused
from galatea.message import LineReader, Message, parse, tag_of

LOOSE = {
    "set X = 5": Message("set", "X", "5", "="),
    "set X=5": Message("set", "X", "5", "="),
    "\ufeffset\tX\t=\t5 ": Message("set", "X", "5 ", "="),
    "TO @A,B from @C set#1 X.y < file.txt": Message("set", "X.y", "file.txt", "<", "1", ("A", "B"), "C"),
    "to @LOBBY/SSM inq Speak": Message("inq", "Speak", to=("LOBBY/SSM",)),
    "inq Speak and whatever": Message("inq", "Speak"),
    "tell  a = b": Message("tell", "", "a = b"),
    "do path/to/file.txt": Message("do", "", "path/to/file.txt"),
    "do Greet": Message("do", "Greet"),
    "def Greet << to @FSM set FaceMot = NOD 1": Message("def", "Greet", "to @FSM set FaceMot = NOD 1", "<<"),
    "set 名前 = こんにちは": Message("set", "名前", "こんにちは", "="),
}
# Lines that are no messages. What is said about them is compared with what lamp_module says.
BAD = [
    "sett#1 Lamp = ON", "set#1 Lamp ON", "set#1 Lamp", "set#1 La mp = ON", "set#1 .Lamp = ON", "set#1 Lamp. = ON",
    "set#1 = ON", "inq#1 Lamp=", "rest#1 A = 5", "del#1 A B", "set#", "set## Lamp = ON", "set#12345678901234567890123456789012x X = 1",
    "to @ set#1 X = 1", "to LAMP set#1 X = 1", "to @A to @B set#1 X = 1", "to @A,,B set#1 X = 1", "to @A! set#1 X = 1",
    "from @A", "from @A,B set#1 X = 1", "tell#1", "do#1", "set#1 X\x01 = 1", "set#1 Ünïcode!sign and more than forty bytes of it = 1",
    "to " + ",".join(f"@M{n}" for n in range(40)) + " set#1 X = 1", "frobnicate#7 X = 1", "to @A frobnicate#8 X",
    "prop#1 Lamp", "prop#1 Lamp = Loud", "set#1 " + "x" * 129 + " = 1",
]


class MessageTest(unittest.TestCase):
    def test_lines_are_read_loosely_and_written_exactly(self) -> None:
        for line, message in LOOSE.items():
            self.assertEqual(parse(line), message, line)
            self.assertEqual(parse(str(message)), message, line)

    def test_what_cannot_be_written_as_one_line_is_refused_before_it_is_sent(self) -> None:
        for message in (Message("set", "X", "a\nb", "="), Message("set", "X", " a", "="), Message("set", "a b", "1", "="),
                        Message("set", "X", "", "="), Message("tell", "", ""), Message("set", "X", "y" * 70000, "=")):
            if message.value == "" and message.command == "set":
                self.assertEqual(message.checked(), message)  # an empty value is one
            else:
                self.assertRaises(Refused, message.checked)

    def test_bytes_that_are_no_text_are_refused_with_their_place(self) -> None:
        for line, code, column in ((b"set X = \xff", "BAD_UTF8", 9), ("ä set".encode(), "UNKNOWN_COMMAND", 1),
                                   ("set ä = \0".encode(), "SYNTAX", 10), (b"set X = " + b"x" * 65536, "TOO_LONG", 0)):
            with self.assertRaises(Refused) as refused:
                parse(line)
            self.assertEqual((refused.exception.code, refused.exception.column), (code, column))

    def test_blank_lines_and_comments_are_nothing(self) -> None:
        for line in ("", "  \t", "# set X = 1", " // set X = 1"):
            with self.assertRaises(Refused) as refused:
                parse(line)
            self.assertEqual(refused.exception.code, "EMPTY")

    def test_bad_lines_are_refused_in_the_words_of_the_programs(self) -> None:
        said, complaints = support.piped([support.program("lamp_module")], "\n".join(BAD))
        ours, our_complaints = support.piped(support.LAMP, "\n".join(BAD))
        self.assertEqual(ours, said)
        self.assertEqual(our_complaints, complaints)

    def test_lines_of_recorded_sessions_are_read_and_written_as_they_are(self) -> None:
        count = 0
        for session in (support.ROOT / "tests" / "original_sessions").glob("*.session"):
            for line in session.read_text().splitlines():
                if line.startswith("< ") and "*" not in line:
                    self.assertEqual(str(parse(line[2:])), line[2:])
                    count += 1
        self.assertGreater(count, 20)

    def test_the_tag_of_a_line_that_is_no_message_is_found(self) -> None:
        for line, tag in (("set#7 X", "7"), ("frob#8 X", "8"), ("to @A frob#9 X", "9"), ("x y#1", ""), ("a b set#2 X", "2"),
                          ("#3", ""), ("set#!! X", "")):
            self.assertEqual(tag_of(line), tag, line)


class LineReaderTest(unittest.TestCase):
    def test_lines_come_whole_in_whatever_pieces_they_arrive(self) -> None:
        stream = "rep X = ä\r\n\nrep Y = 2\nrep Z".encode()
        for size in (1, 2, 3, 7, len(stream)):
            reader = LineReader()
            lines = [line for at in range(0, len(stream), size) for line in reader.feed(stream[at : at + size])]
            self.assertEqual(lines + list(reader.end()), ["rep X = ä".encode(), b"", b"rep Y = 2", b"rep Z"])

    def test_an_overlong_line_is_reported_once_and_the_next_is_read_well(self) -> None:
        for size in (1000, 65536, 200_000):
            reader = LineReader()
            stream = b"a" * 150_000 + b"\nrep X = 1\n"
            lines = [line for at in range(0, len(stream), size) for line in reader.feed(stream[at : at + size])]
            self.assertEqual([getattr(line, "code", line) for line in lines], ["TOO_LONG", b"rep X = 1"])


if __name__ == "__main__":
    unittest.main()
