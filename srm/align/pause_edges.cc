#include "srm/align/pause_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace srm {
namespace {

constexpr Millis kHop{5};
constexpr std::size_t kHopSamples = 5 * kFramesPerMs;
constexpr std::size_t kWindow = 2 * kHopSamples;

/// The level of 10 ms of sound around each multiple of kHop, in dB.
std::vector<double> Levels(std::span<const std::int16_t> samples) {
  std::vector<double> levels;
  for (std::size_t at = 0; at + kWindow <= samples.size(); at += kHopSamples) {
    double power = 0;
    for (const std::int16_t s : samples.subspan(at, kWindow)) power += static_cast<double>(s) * s;
    levels.push_back(10 * std::log10(power / kWindow + 1));
  }
  return levels;
}

std::size_t Frame(Millis at, std::size_t frames) {
  return std::min(static_cast<std::size_t>(std::max<std::int64_t>(at / kHop, 0)), frames);
}

/// Where the sound of a phoneme from `start` ends before the pause up to `end`; `edge` if that
/// cannot be told.
Millis SoundEnd(const std::vector<double>& levels, Millis start, Millis edge, Millis end) {
  const std::size_t first = Frame(start, levels.size());
  const std::size_t border = Frame(edge, levels.size());
  const std::size_t last =
      Frame(std::min(edge + PauseEdges::kLongest, end - PauseEdges::kLeast), levels.size());
  const std::size_t over = Frame(end, levels.size());
  if (first >= border || border >= over || last <= first) return edge;
  const auto at = [&](std::size_t i) { return levels.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto loudest = std::max_element(at(first), at(border));
  std::vector<double> rest(at(border), at(over));
  const auto tenth = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 10);
  std::nth_element(rest.begin(), tenth, rest.end());
  if (*loudest - *tenth < PauseEdges::kClear) return edge;
  const double ended = std::max(*loudest - PauseEdges::kBelow, *tenth + PauseEdges::kAbove);
  auto found = static_cast<std::size_t>(loudest - levels.begin());
  for (std::size_t i = found; i < last; ++i) {
    if (levels[i] > ended) found = i;
  }
  // The window's middle lies one hop behind its beginning.
  const Millis placed = kHop * static_cast<std::int64_t>(found + 2);
  return std::clamp(placed, std::min(start + PauseEdges::kLeast, edge),
                    std::max(end - PauseEdges::kLeast, edge));
}

}  // namespace

void PlacePauses(Alignment& alignment, std::span<const std::int16_t> samples) {
  const std::vector<double> levels = Levels(samples);
  auto& phonemes = alignment.phonemes;
  Millis start{0};
  for (std::size_t i = 0; i + 1 < phonemes.size(); ++i) {
    const Millis edge = start + phonemes[i].duration;
    const Millis end = edge + phonemes[i + 1].duration;
    if (phonemes[i].name != "pau" && phonemes[i + 1].name == "pau") {
      const Millis placed = SoundEnd(levels, start, edge, end);
      phonemes[i].duration += placed - edge;
      phonemes[i + 1].duration -= placed - edge;
      for (HeardWord& word : alignment.words) {
        if (word.end == edge) word.end = placed;
      }
      start = placed;
      continue;
    }
    start = edge;
  }
}

}  // namespace srm
