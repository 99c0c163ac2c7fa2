"""What is measured of a film: pure functions over lists of numbers.

Times are milliseconds, lengths millimetres. A track is a pair of lists of equal length, times
(rising) and values; it is read between its times by straight lines.
"""
import bisect
import math

GRID_MS = 5


class Track:
    """A value over time."""

    def __init__(self, times, values):
        if len(times) != len(values) or len(times) < 2:
            raise ValueError("a track needs two moments or more, and a value for each")
        if any(a >= b for a, b in zip(times, times[1:])):
            raise ValueError("the moments of a track do not rise")
        self.times, self.values = list(times), list(values)

    def at(self, time):
        """The value at a time; beyond the ends the first or last."""
        i = bisect.bisect_right(self.times, time)
        if i == 0:
            return self.values[0]
        if i == len(self.times):
            return self.values[-1]
        before, after = self.times[i - 1], self.times[i]
        part = (time - before) / (after - before)
        return self.values[i - 1] * (1 - part) + self.values[i] * part

    def moved(self, by):
        """The same, later by so many ms."""
        return Track([time + by for time in self.times], self.values)

    def between(self, start, end):
        """The values whose times lie within."""
        return [v for t, v in zip(self.times, self.values) if start <= t <= end]


def grid(track, other, start, end):
    """Both at the same times, GRID_MS apart."""
    count = int((end - start) / GRID_MS)
    times = [start + GRID_MS * k for k in range(count + 1)]
    return [track.at(t) for t in times], [other.at(t) for t in times]


def mean(values):
    return sum(values) / len(values)


def correlation(a, b):
    """Pearson's r; 0 where one of both does not change."""
    a_mean, b_mean = mean(a), mean(b)
    ab = sum((x - a_mean) * (y - b_mean) for x, y in zip(a, b))
    aa = sum((x - a_mean) ** 2 for x in a)
    bb = sum((y - b_mean) ** 2 for y in b)
    return ab / math.sqrt(aa * bb) if aa > 1e-12 and bb > 1e-12 else 0.0


def line_through(truth, seen):
    """seen = slope * truth + offset by least squares, and the rms of what is left, in units of truth."""
    truth_mean, seen_mean = mean(truth), mean(seen)
    tt = sum((x - truth_mean) ** 2 for x in truth)
    slope = sum((x - truth_mean) * (y - seen_mean) for x, y in zip(truth, seen)) / tt if tt > 1e-12 else 0.0
    if abs(slope) < 1e-6:
        return 0.0, seen_mean, math.sqrt(tt / len(truth))
    rest = [(y - seen_mean) / slope - (x - truth_mean) for x, y in zip(truth, seen)]
    return slope, seen_mean - slope * truth_mean, math.sqrt(mean([r * r for r in rest]))


def lag(truth, seen, start, end, reach=250):
    """By how many ms `seen` comes after `truth` where both are most alike, and r there."""
    best = []
    for shift in range(-reach, reach + 1, GRID_MS):
        a, b = grid(truth.moved(shift), seen, start + max(shift, 0), end + min(shift, 0))
        best.append((correlation(a, b), shift))
    r, at = max(best)
    k = best.index((r, at))
    if 0 < k < len(best) - 1:  # the top of a parabola through three
        before, after = best[k - 1][0], best[k + 1][0]
        bend = before - 2 * r + after
        if bend < -1e-12:
            at += GRID_MS * 0.5 * (before - after) / bend
    return at, r


def median(values):
    ordered = sorted(values)
    return ordered[len(ordered) // 2]


def percentile(values, part):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(part * len(ordered)))]


# The phonemes of an utterance: (name, start, end).

LIPS_MEET = {"p", "b", "m", "em", "by", "my", "py", "P", "B", "M"}
SILENCES = {"pau", "sil", "ssil", "h#", "_", "-"}


def phoneme_times(phonemes, start):
    """(name, ms) one after the other, from `start` on, as (name, start, end)."""
    spans = []
    for name, duration in phonemes:
        spans.append((name, start, start + duration))
        start += duration
    return spans


def closures(spans):
    """Where lips meet for p, b and m; one after the other of them is one closure."""
    found = []
    for name, start, end in spans:
        if name not in LIPS_MEET:
            continue
        if found and abs(found[-1][1] - start) < 1e-6:
            found[-1] = (found[-1][0], end)
        else:
            found.append((start, end))
    return found


def silences(spans, start, end, least=300, edge=130):
    """Where nothing is said for `least` ms, `edge` ms shorter on either side."""
    said = sorted((a, b) for name, a, b in spans if name not in SILENCES)
    quiet, at = [], start
    for a, b in said + [(end, end)]:
        if a - at >= least:
            quiet.append((at + edge, a - edge))
        at = max(at, b)
    return quiet


def closed_limit(gap, quiet, above=0.6, most=1.5):
    """Below how many mm lips count as closed: a little above what is seen in silence. A mouth that
    stands open in silence does not raise it beyond `most` + `above`."""
    rest = [v for start, end in quiet for v in gap.between(start, end)]
    return min(median(rest), most) + above if rest else most + above


def closures_found(gap, wanted, limit, slack=17):
    """For each closure whether lips are seen closed at any time within it."""
    found = []
    for start, end in wanted:
        seen = gap.between(start - slack, end + slack) or [gap.at((start + end) / 2)]
        found.append(min(seen) < limit)
    return found


def shut_by_mistake(gap, truth, limit, well_open=3.0, around=40):
    """Of the moments at which the true mouth is, and has been, open by `well_open` for `around` ms before and
    after, the share at which lips are seen closed."""
    count = shut = 0
    for time, value in zip(gap.times, gap.values):
        if min(truth.at(time + k) for k in range(-around, around + 1, 10)) < well_open:
            continue
        count += 1
        shut += value < limit
    return shut / count if count else 0.0


def open_in_silence(gap, quiet, limit):
    """The share of silence in which lips are seen open."""
    values = [v for start, end in quiet for v in gap.between(start, end)]
    return sum(v >= limit for v in values) / len(values) if values else 0.0


def blinks(opening, below=0.7, longest=500):
    """When blinks are deepest: dips of the lids' opening below a part of its median, at most `longest` ms long."""
    limit = below * median(opening.values)
    found, begin = [], None
    for k, value in enumerate(opening.values + [limit]):
        if value < limit and begin is None:
            begin = k
        elif value >= limit and begin is not None:
            if opening.times[k - 1] - opening.times[begin] <= longest:
                found.append(opening.times[min(range(begin, k), key=lambda i: opening.values[i])])
            begin = None
    return found


def smoothed(track, half=2):
    """Each value the mean of itself and `half` neighbours to either side."""
    values = track.values
    return Track(track.times, [mean(values[max(0, k - half):k + half + 1]) for k in range(len(values))])


def span(track, outer=0.02):
    """From the 2nd to the 98th percentile."""
    return percentile(track.values, 1 - outer) - percentile(track.values, outer)


def speed(track, part=0.95):
    """The 95th percentile of how fast it changes, a second."""
    steps = [1000 * abs(b - a) / (u - t)
             for t, u, a, b in zip(track.times, track.times[1:], track.values, track.values[1:])]
    return percentile(steps, part)
