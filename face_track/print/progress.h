#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace facetrack {

/// Says on standard error how far one is with a film: at a terminal in one line that changes, else
/// every ten seconds.
class Progress {
 public:
  /// `what` is being done: "face_track: followed".
  Progress(std::string what, bool quiet, std::optional<double> length_ms)
      : what_(std::move(what)), quiet_(quiet), length_ms_(length_ms) {}
  ~Progress();
  Progress(const Progress&) = delete;
  void At(std::size_t pictures, double ms);

 private:
  using Clock = std::chrono::steady_clock;
  const std::string what_;
  bool quiet_, open_line_ = false;
  std::optional<double> length_ms_;
  Clock::time_point begun_ = Clock::now(), shown_ = begun_;
};

}  // namespace facetrack
