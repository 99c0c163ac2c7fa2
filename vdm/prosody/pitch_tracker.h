#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace vdm {

/// The fundamental frequency of a voice over a stream, each 10 ms: candidates by the normalised
/// cross-correlation of sound below 1 kHz, and the best way through them by dynamic programming
/// (D. Talkin, A robust algorithm for pitch tracking, in Speech Coding and Synthesis, 1995). The
/// way is decided kDecideAfter frames later, so the lookahead is bounded.
/// Sound: 16 kHz mono, in pieces of any size; the frames are the same.
/// Thread: none of its own; one instance, one thread.
class PitchTracker {
 public:
  static constexpr std::size_t kHop = 160;  ///< samples from one frame to the next
  static constexpr float kLowestHz = 60, kHighestHz = 500;
  static constexpr std::size_t kDecideAfter = 2;
  static constexpr std::size_t kReach = 168;  ///< samples at 8 kHz on either side of a frame
  static constexpr std::size_t kTaps = 33;    ///< of the low-pass filter at 16 kHz
  /// Samples after a frame's instant on which it depends.
  static constexpr std::size_t kAhead = kDecideAfter * kHop + 2 * kReach + kTaps / 2;

  struct Frame {
    float hz = 0;       ///< 0: no voice
    float voicing = 0;  ///< the correlation of neighbouring periods, at most 1
  };
  PitchTracker();
  /// Appends the frames that became complete; frame k stands for sample k * kHop.
  void Add(std::span<const std::int16_t> samples, std::vector<Frame>& frames);

 private:
  static constexpr std::size_t kMostCandidates = 6;

  /// One thing a frame may be: a period, or no voice (hz 0).
  struct Candidate {
    float hz = 0, voicing = 0;
    float cost = 0;            // of the best way that ends here
    std::size_t previous = 0;  // the candidate before on that way
  };
  using Column = std::vector<Candidate>;

  void Halve(std::span<const std::int16_t> samples);
  Column Candidates(std::size_t centre) const;
  void Extend(Column column);
  Frame Decided() const;

  std::array<float, kTaps> filter_;
  std::vector<float> sound_;      // at 16 kHz, as far back as the filter needs
  std::vector<float> half_;       // low-passed, at 8 kHz
  std::size_t half_begin_ = 0;    // the number of half_'s first sample since the start
  std::size_t next_frame_ = 0;    // whose candidates are found next
  std::deque<Column> columns_{};  // the last kDecideAfter + 1
};

}  // namespace vdm
