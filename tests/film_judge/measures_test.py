"""The measures of scripts/film_judge, on signals whose answers are known."""
import math
import os
import random
import sys
import tempfile
import unittest
import wave

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
sys.path.insert(0, SCRIPTS)
from film_judge import films, heads, measures, programs, real_clock, sabotage, verdict  # noqa: E402

FRAME_MS = 1000 / 30


def track(f, end=4000, step=FRAME_MS):
    times = [step * k for k in range(int(end / step) + 1)]
    return measures.Track(times, [f(t) for t in times])


def syllables(time):
    """Something like a mouth: never the same twice within seconds."""
    return max(0.0, 4 * math.sin(time / 71) + 3 * math.sin(time / 113 + 1) + 2 * math.sin(time / 37 + 2))


class TrackTest(unittest.TestCase):
    def test_values_between_moments_lie_on_straight_lines(self):
        ramp = measures.Track([0, 100, 300], [0, 10, 0])
        self.assertEqual([ramp.at(t) for t in (-5, 0, 50, 100, 200, 300, 999)], [0, 0, 5, 10, 5, 0, 0])
        self.assertEqual(ramp.moved(50).at(150), 10)

    def test_moments_that_do_not_rise_are_refused(self):
        for times in ([0, 0], [5, 1], [0]):
            with self.assertRaises(ValueError):
                measures.Track(times, [1] * len(times))


class LikenessTest(unittest.TestCase):
    def test_correlation_of_known_numbers(self):
        self.assertAlmostEqual(measures.correlation([1, 2, 3], [2, 4, 6]), 1)
        self.assertAlmostEqual(measures.correlation([1, 2, 3], [3, 2, 1]), -1)
        self.assertAlmostEqual(measures.correlation([1, 2, 3, 4], [1, 3, 2, 4]), 0.8)
        self.assertEqual(measures.correlation([1, 2, 3], [5, 5, 5]), 0)

    def test_a_line_and_what_is_left_beside_it(self):
        truth = [0, 1, 2, 3]
        slope, offset, rms = measures.line_through(truth, [2 * x + 1 for x in truth])
        self.assertAlmostEqual(slope, 2)
        self.assertAlmostEqual(offset, 1)
        self.assertAlmostEqual(rms, 0)
        # 2x + 1 with +1, -1, -1, +1 added, which no line takes away: half of it in units of x.
        _, _, rms = measures.line_through(truth, [2, 2, 4, 8])
        self.assertAlmostEqual(rms, 0.5)

    def test_a_known_lag_is_found_to_a_fraction_of_a_frame(self):
        noise = random.Random(7)
        for late in (-130, -40, 0, 12, 100):
            seen = track(lambda t, late=late: 1.2 * syllables(t - late) + 0.3 + noise.gauss(0, 0.2))
            found, r = measures.lag(track(syllables, step=5), seen, 300, 3700)
            self.assertAlmostEqual(found, late, delta=6)
            self.assertGreater(r, 0.98)


PHONEMES = [("pau", 400), ("m", 80), ("aa", 200), ("b", 70), ("p", 60), ("uw", 200), ("pau", 500), ("m", 90), ("ah", 150),
            ("pau", 400)]


class MouthTest(unittest.TestCase):
    def setUp(self):
        self.spans = measures.phoneme_times(PHONEMES, 100)

    def test_phonemes_stand_one_after_the_other(self):
        self.assertEqual(self.spans[1], ("m", 500, 580))
        self.assertEqual(self.spans[-1], ("pau", 1850, 2250))

    def test_closures_next_to_each_other_are_one(self):
        self.assertEqual(measures.closures(self.spans), [(500, 580), (780, 910), (1610, 1700)])

    def test_silences_are_pauses_and_both_ends(self):
        self.assertEqual(measures.silences(self.spans, 0, 2600), [(130, 370), (1240, 1480), (1980, 2470)])

    def gap(self, shut):
        return track(lambda t: 0.1 if any(a <= t <= b for a, b in shut) else 5.0, end=2600)

    def test_closures_that_are_seen_and_one_that_is_not(self):
        wanted = measures.closures(self.spans)
        quiet = [(0, 490), (1120, 1600), (1860, 2600)]
        whole = self.gap(wanted + quiet)
        limit = measures.closed_limit(whole, measures.silences(self.spans, 0, 2600))
        self.assertAlmostEqual(limit, 0.7)
        self.assertEqual(measures.closures_found(whole, wanted, limit), [True, True, True])
        missing = self.gap([wanted[0], wanted[2]] + quiet)
        self.assertEqual(measures.closures_found(missing, wanted, limit), [True, False, True])

    def test_a_mouth_that_stands_open_in_silence_is_no_closed_one(self):
        stands_open = track(lambda t: 5.0, end=2600)
        quiet = measures.silences(self.spans, 0, 2600)
        limit = measures.closed_limit(stands_open, quiet)
        self.assertLess(limit, 2.2)
        self.assertEqual(measures.open_in_silence(stands_open, quiet, limit), 1)
        half = track(lambda t: 5.0 if t < 1000 else 0.1, end=2600)
        self.assertAlmostEqual(measures.open_in_silence(half, [(0, 1990)], 0.7), 0.5, delta=0.03)

    def test_shut_by_mistake_counts_only_well_open_mouths(self):
        truth = track(lambda t: 5.0 if 500 < t < 1500 else 0.0, end=2600)
        self.assertEqual(measures.shut_by_mistake(truth, truth, 0.7), 0)
        quarter = track(lambda t: truth.at(t) if t < 1250 else 0.0, end=2600)
        self.assertAlmostEqual(measures.shut_by_mistake(quarter, truth, 0.7), 0.22, delta=0.05)


class LifeTest(unittest.TestCase):
    def test_blinks_are_short_dips_of_the_lids(self):
        at = (700, 2500, 3300)

        def lids(time):
            return 10 - sum(8 * max(0, 1 - abs(time - t) / 110) for t in at)
        for found, told in zip(measures.blinks(track(lids)), at, strict=True):
            self.assertAlmostEqual(found, told, delta=FRAME_MS)

    def test_eyes_that_stay_shut_do_not_blink(self):
        self.assertEqual(measures.blinks(track(lambda t: 2.0 if 500 < t < 1500 else 10.0)), [])
        self.assertEqual(measures.blinks(track(lambda t: 9.0 if 500 < t < 600 else 10.0)), [])

    def test_range_and_speed_of_a_turning_head(self):
        turn = track(lambda t: 6 * math.sin(t / 500))
        self.assertAlmostEqual(measures.span(turn, 0), 12, delta=0.1)
        self.assertAlmostEqual(measures.speed(turn), 12, delta=0.5)
        inner = measures.smoothed(track(lambda t: round(t / FRAME_MS) % 2)).values[2:-2]
        self.assertAlmostEqual(max(inner) - min(inner), 0.2)


class SoundTest(unittest.TestCase):
    def test_utterances_begin_after_digital_silence_and_can_be_delayed(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.wav")
            with wave.open(path, "w") as sound:
                sound.setparams((1, 2, 16000, 0, "NONE", ""))
                sound.writeframes(bytes(2 * 4000) + b"\x10\x20" * 8000 + bytes(2 * 8000) + b"\x10\x20" * 1600)
            self.assertEqual(films.utterances(path), [250, 1250])
            films.delay(path, 100)
            self.assertEqual(films.utterances(path), [350, 1350])
            level = films.loudness(path)
            self.assertGreater(level.at(700), level.at(1150) + 5)


class VerdictTest(unittest.TestCase):
    def film(self, late=0, shift=0):
        film = films.Film()
        film.spans = [span for k in range(2) for span in measures.phoneme_times(PHONEMES, 1000 + 2300 * k + shift)]
        film.begins = [1000 + shift, 3300 + shift]
        film.frames = film.faces = 195
        gap = track(lambda t: syllables(t - late - shift), end=6460)
        film.told_gap = film.told_width = track(lambda t: syllables(t - shift), end=6460)
        still = track(lambda t: 0.0, end=6460)
        film.seen = {"gap": gap, "width": gap, "eyes": still, "turn_down": still, "turn_left": still, "tilt_left": still}
        return film

    def test_a_mouth_that_is_late_is_said_to_be_by_how_much(self):
        reference = self.film()
        loudness = (track(syllables, end=6460), reference.begins[0])
        for late, shift in ((0, 0), (100, 0), (-60, 0), (100, 440)):
            values = verdict.figures(self.film(late, shift), reference, loudness)
            self.assertAlmostEqual(values["ahead"], 40 - late, delta=6)
            self.assertGreater(values["gap_r"], 0.98)
        self.assertEqual(values["closures"], 6)

    def test_limits_are_read_and_applied_by_way(self):
        limits = [("all", "all", "ahead", 20, 60), ("all", "voice", "gap_r", 0.9, None),
                  ("original", "all", "size", None, 2)]
        values = {"ahead": 90.0, "gap_r": 0.5, "size": 3}
        self.assertEqual(set(verdict.faults(values, "galatea", "LINEAR", limits)), {"ahead"})
        self.assertEqual(set(verdict.faults(values, "original", "voice", limits)), {"ahead", "gap_r", "size"})
        self.assertEqual(verdict.faults({"ahead": 40, "gap_r": 0.95}, "galatea", "voice", limits), {})
        self.assertGreater(len(verdict.read_limits()), 10)

    def test_a_damaged_table_of_limits_is_named_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "limits.txt")
            for line in ("limit all all nonsense 1 2", "limit all some ahead 1 2", "limit nobody all ahead 1 2", "limit all all ahead 1",
                         "limit all all ahead one 2"):
                with open(path, "w", encoding="ascii") as file:
                    file.write("# a comment\n" + line + "\n")
                with self.assertRaisesRegex(programs.Failed, r"limits\.txt:2: expected"):
                    verdict.read_limits(path)


class RealClockTest(unittest.TestCase):
    def test_each_phoneme_is_found_in_the_frames_near_its_place(self):
        spans = [("pau", 0, 200), ("m", 200, 300), ("aa", 300, 500), ("aa", 500, 600), ("t", 600, 620), ("m", 620, 800)]
        frames = [(10.0 * k, next(n for n, a, b in spans if a <= 10 * k + 40 - 7 < b)) for k in range(70)]
        found = real_clock.errors(spans, frames, 40)
        self.assertEqual([name for name, _ in found], ["pau", "m", "aa", "m"], "the second aa and the t are left out")
        for _, error in found[1:]:
            self.assertTrue(7 <= error < 17, error)
        self.assertIn("4 phonemes", real_clock.summary(found))


class SabotageTest(unittest.TestCase):
    def test_shapes_are_swapped_in_pairs(self):
        with tempfile.TemporaryDirectory() as folder:
            sabotage.swapped_shapes(folder)
            def rows(path):
                with open(path, encoding="utf-8") as file:
                    return {r[0]: r[1:] for r in (line.split("#")[0].split() for line in file) if r}
            before = rows(os.path.join(sabotage.TABLES, "mouth_shapes_28.txt"))
            after = rows(os.path.join(folder, "mouth_shapes_28.txt"))
            self.assertEqual(set(before), set(after))
            self.assertEqual(after["aa"], before["uw"])
            self.assertEqual(after["uw"], before["aa"])
            self.assertEqual(after["b"], before["b"])


class WireframeTest(unittest.TestCase):
    def test_eyes_nose_mouth_and_chin_come_to_where_the_picture_shows_them(self):
        own = {"eye_right": (-0.5, 0.5), "eye_left": (0.5, 0.5), "mouth_right": (-0.3, -0.2), "mouth_left": (0.3, -0.2),
               "nasion": (0, 0.4), "below_nose": (0, 0), "lips": (0, -0.2), "chin": (0, -0.6)}
        lines = ["#9"] + [f"{k} {heads.NAMED[name][0][0]} {heads.NAMED[name][0][1]} {x} {y} 0.5"
                          for k, (name, (x, y)) in enumerate(own.items(), 1)]
        points = {heads.NAMED[name][1]: (256 + 100 * x, 250 - 120 * y) for name, (x, y) in own.items()}
        moved = heads.fitted_wireframe(lines, points, 512)
        self.assertEqual(moved[0], "#9")
        for line, (name, (x, y)) in zip(moved[1:], own.items(), strict=True):
            words = [float(w) for w in line.split()]
            self.assertAlmostEqual(256 + 256 * words[3], 256 + 100 * x, places=3, msg=name)
            self.assertAlmostEqual(256 - 256 * words[4], 250 - 120 * y, places=3, msg=name)


if __name__ == "__main__":
    unittest.main()
