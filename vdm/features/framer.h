#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vdm {

/// Cuts sound into overlapping windows: window k is centred on sample k * hop; before the start
/// there is silence. Pieces of any size give the same windows.
class Framer {
 public:
  /// `early`: windows are centred so many samples before. REQUIRES: `hop` <= `window`, `window`
  /// even.
  Framer(std::size_t window, std::size_t hop, std::size_t early = 0)
      : window_(window), hop_(hop), kept_(window / 2 + early) {}

  /// Calls `take(std::span<const std::int16_t>)` for each window that became complete.
  template <typename Take>
  void Add(std::span<const std::int16_t> samples, Take take) {
    kept_.insert(kept_.end(), samples.begin(), samples.end());
    std::size_t at = 0;
    for (; kept_.size() - at >= window_; at += hop_) {
      take(std::span<const std::int16_t>(kept_).subspan(at, window_));
    }
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(at));
  }

 private:
  const std::size_t window_, hop_;
  std::vector<std::int16_t> kept_;
};

}  // namespace vdm
