#pragma once

#include <chrono>
#include <optional>

namespace facetrack {

/// Says on standard error how far a film is followed: at a terminal in one line that changes, else
/// every ten seconds.
class Progress {
 public:
  Progress(bool quiet, std::optional<double> length_ms) : quiet_(quiet), length_ms_(length_ms) {}
  ~Progress();
  Progress(const Progress&) = delete;
  void At(std::size_t pictures, double ms);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, open_line_ = false;
  std::optional<double> length_ms_;
  Clock::time_point begun_ = Clock::now(), shown_ = begun_;
};

}  // namespace facetrack
