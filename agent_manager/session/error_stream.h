#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>
#include <utility>

namespace am {

/// Lines for people on stderr. A stderr that nobody reads holds nobody up, and peers that cause
/// errors without end fill no disk: a line that does not fit, or is too many, is lost, and the next
/// one that is written says how many were.
/// Thread: one. Limits: kMaxBytes of a line (a pipe takes as many at once, PIPE_BUF); what is
/// longer is cut. kBytesPerSecond in the long run, kBurstBytes at once.
class ErrorStream {
 public:
  static constexpr std::size_t kMaxBytes = 4096;
  static constexpr std::size_t kBytesPerSecond = 8u << 10;
  static constexpr std::size_t kBurstBytes = 256u << 10;
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  explicit ErrorStream(int fd, Clock now = std::chrono::steady_clock::now)
      : fd_(fd), now_(std::move(now)), filled_(now_()) {}
  /// Without newline; control characters are shown as such.
  void Write(std::string_view text);

 private:
  void Refill();
  bool Put(std::string_view text);

  const int fd_;
  const Clock now_;
  std::size_t room_ = kBurstBytes;
  std::chrono::steady_clock::time_point filled_;
  unsigned long lost_ = 0;
};

}  // namespace am
