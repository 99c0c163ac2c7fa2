"""Values: grammars, quoting, numbers, phonemes and start times, compared with what the programs say about them."""
import json
import re
import unittest

import support
from galatea.errors import Refused
from galatea.nearest_word import did_you_mean
from galatea.values import (Phoneme, StartTime, ValueGrammar, format_ms, format_phonemes, parse_phonemes, parse_start_time,
                            quote, read_quoted, words)

VALUES = [
    "", "ON", "on", "ONN", "OFF 5", "NOW", "+250", "+ 250", "@12.5", "12:34:56.789", "-1", "0.5", "5", "201", "1e3", "1e13",
    "nan", "0x10", "1,5", '"two words"', '"a \\u00e4\\n"', '"open', '"a"b', "HAPPY 1 100 0", "NOD 1", "a[80] k[60]",
    "1 2 3", "1 2 3 4", "IDLE", "wait", "x" * 60, "ä ö ü", "  5  ", "STOP", "START now",
]


def table_rows() -> list[tuple[str, str, str, str, str]]:
    """Of each slot in the reference: its program, name, grammar, access and value at the start."""
    rows, owner = [], ""
    for line in (support.ROOT / "docs" / "reference" / "slots.md").read_text().splitlines():
        if line.startswith("## "):
            owner = line[3:]
        cells = [cell.strip().strip("`").replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)]
        if line.startswith("| `"):
            rows.append((owner, cells[1], cells[2], cells[3], cells[5]))
    return rows


class GrammarTest(unittest.TestCase):
    def test_every_grammar_of_the_reference_is_read_and_takes_its_value_at_the_start(self) -> None:
        rows = table_rows()
        self.assertGreater(len(rows), 300)
        for owner, name, grammar, access, initial in rows:
            parsed = ValueGrammar(grammar)
            if initial and access == "ReadWrite" and name != "Capture":  # which says STOPPED where it takes STOP
                self.assertTrue(parsed.match(initial), f"{owner} {name} = {initial}")

    def check_refusals(self, name: str, executable: list[str]) -> None:
        """What does not fit our reading of a slot's grammar is refused by the program in the same words."""
        expected, lines = {}, []
        for _, slot, text, access, _ in (row for row in table_rows() if row[0] == name):
            grammar = ValueGrammar(text)
            for value in VALUES:
                if access == "ReadOnly" or grammar.has_file:
                    continue
                try:
                    grammar.match(value if grammar.has_text else value.strip())
                except Refused as refusal:
                    tag = f"t{len(lines)}"
                    expected[tag] = f"rep#{tag} {slot}.error = {refusal}"
                    lines.append(f"set#{tag} {slot} = {value}")
        said, _ = support.piped(executable, "\n".join(lines))
        answers = {line[4 : line.index(" ")]: line for line in said if line.startswith("rep#")}
        self.assertGreater(len(lines), 100)
        self.assertEqual(answers, expected)

    def test_the_face_refuses_what_does_not_fit_in_our_words(self) -> None:
        self.check_refusals("fsm", [support.program("fsm"), "--headless"])

    def test_the_voice_refuses_what_does_not_fit_in_our_words(self) -> None:
        self.check_refusals("ssm_stub", [support.program("ssm_stub")])

    def test_the_ear_refuses_what_does_not_fit_in_our_words(self) -> None:
        self.check_refusals("srm_stub", [support.program("srm_stub")])

    def test_parts_have_the_types_of_the_grammar(self) -> None:
        for grammar, value, parts in (
                ("ON [ <ms> ] | OFF", "on 250", ["ON", 250.0]), ("<int 1..5> <number>", " 3 0.5 ", [3, 0.5]),
                ("( A | B ) <word>...", 'b x "y z" "\\u3042"', ["B", "x", "y z", "あ"]), ("<text>", "", [""]),
                ("<time>", "+ 500", [StartTime("after", 500.0)]), ("<file>", '"a b.txt"  ', ["a b.txt"]), ("<file>", "a b.txt  ", ["a b.txt"]),
                ("A... B", "A A B", ["A", "A", "B"])):
            self.assertEqual([part.typed for part in ValueGrammar(grammar).match(value)], parts, value)

    def test_a_grammar_that_is_none_is_refused_with_its_place(self) -> None:
        for grammar, column in (("A | ", 5), ("[ A", 4), ("<nothing>", 1), ("<int 1-5>", 1), ("A ; B", 3), ("( " * 33 + "A", 65)):
            with self.assertRaises(Refused) as refused:
                ValueGrammar(grammar)
            self.assertEqual(refused.exception.column, column, grammar)

    def test_an_ambiguous_grammar_ends_in_a_limit_and_not_in_an_endless_search(self) -> None:
        with self.assertRaises(Refused) as refused:
            ValueGrammar("[ A ] " * 40 + "B").match("A " * 30 + "C")
        self.assertEqual(refused.exception.code, "LIMIT")

    def test_mistyped_names_are_guessed_as_the_programs_guess(self) -> None:
        names = [row[1] for row in table_rows() if row[0] == "fsm"]
        typed = ["HeadRotAbs", "FaceEx", "Gaz", "facexp", "Lipsync.poh", "Zzzzz", "A", "Recrod", "Speak.stats", "Autnomous"]
        said, _ = support.piped([support.program("fsm"), "--headless"], "\n".join(f"inq#t {name}" for name in typed))
        for line, name in zip((line for line in said if line.startswith("rep#t")), typed, strict=True):
            self.assertTrue(line.endswith(did_you_mean(name, names) or "(inq Slots lists them)"), line)


class QuotingTest(unittest.TestCase):
    def test_what_is_quoted_is_read_back(self) -> None:
        for word in ("plain", "", "two words", 'say "hi"', "a\tb", "a\\b", "ä\n", '"', "日本 語", "😀 x"):
            self.assertEqual(words(quote(word)), [word])
            self.assertEqual([part.text for part in ValueGrammar("<word>").match(quote(word))], [word])

    def test_escapes_are_those_of_json(self) -> None:
        for text in ('"\\ud83d\\ude00"', '"\\/\\b\\f\\r\\t"', '"tab\there"'):
            self.assertEqual(read_quoted(text), (json.loads(text, strict=False), len(text)))
        for text in ('"\\ud83d"', '"\\x"', '"\\u12"', '"open'):
            self.assertIsNone(read_quoted(text))

    def test_the_ear_understands_quoted_words_as_we_do(self) -> None:
        name = '"gr\\u0065et"'
        self.assertEqual(words(name), ["greet"])
        said, _ = support.piped([support.program("srm_stub")],
                                f"set Grammar.load = {name} hello | hi\nset#1 Grammar = {quote('greet')}\n")
        self.assertIn("rep#1 Grammar = greet", said)


class TimesAndPhonemesTest(unittest.TestCase):
    def test_phonemes_are_read_in_every_spelling_and_written_in_three(self) -> None:
        phonemes = [Phoneme("a", 80), Phoneme("k", 60)]
        for text in ("a[80] k[60]", "a [80] k [60] ", "a 80 k 60", "a[ 80 ]k 59.5", "a 80 k 60 phoneme_end"):
            self.assertEqual(parse_phonemes(text), phonemes, text)
        forms = [format_phonemes(phonemes, form) for form in ("voice", "face", "plain")]
        self.assertEqual(forms, ["a[80] k[60]", "a [80] k [60] ", "a 80 k 60"])
        for text in ("a", "a[", "a[x]", "a[60001]", "[80]", "a -5", "a 5x", "a 1 " * 8193):
            self.assertRaises(Refused, parse_phonemes, text)

    def test_what_the_voice_says_of_a_text_is_read(self) -> None:
        said, _ = support.piped([support.program("ssm_stub")], "set Text = Good morning.\ninq Text.pho\n")
        phonemes = parse_phonemes(next(line for line in said if line.startswith("rep Text.pho")).split(" = ")[1])
        self.assertGreater(len(phonemes), 5)

    def test_start_times_are_instants_on_the_clock(self) -> None:
        for text, shown, instant in (("now", "NOW", 1000), ("+ 250", "+250", 1250), ("@12.5", "@12.5", 12.5),
                                     ("+00:00:01", "+1000", 2000), ("12:00:00.5", "12:00:00.500", 4600.0)):
            start = parse_start_time(text)
            self.assertEqual((str(start), start.resolve(1000, wall_ms=43196900)), (shown, instant), text)
        for text in ("", "+", "+-5", "25:00:00", "1:2:3", "+90000000", "@x"):
            self.assertRaises(Refused, parse_start_time, text)

    def test_milliseconds_have_three_decimals_at_most(self) -> None:
        self.assertEqual([format_ms(ms) for ms in (0, 1000, 12.5, 0.0004, 1234.5678)], ["0", "1000", "12.5", "0", "1234.568"])


if __name__ == "__main__":
    unittest.main()
