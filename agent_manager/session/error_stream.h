#pragma once

#include <string_view>

namespace am {

/// Lines for people on stderr. A stderr that nobody reads holds nobody up: a line that does not fit
/// is lost, and the next one that fits says how many were.
/// Thread: one. Limits: kMaxBytes of a line (a pipe takes as many at once, PIPE_BUF); what is
/// longer is cut.
class ErrorStream {
 public:
  static constexpr std::size_t kMaxBytes = 4096;
  explicit ErrorStream(int fd) : fd_(fd) {}
  /// Without newline; control characters are shown as such.
  void Write(std::string_view text);

 private:
  bool Put(std::string_view text) const;

  int fd_;
  unsigned long lost_ = 0;
};

}  // namespace am
