#include "face_track/print/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <string>

namespace facetrack {

void Progress::At(std::size_t pictures, double ms) {
  const auto now = Clock::now();
  const bool terminal = isatty(2) != 0;
  const std::chrono::duration<double> since = now - shown_;
  if (quiet_ || since.count() < (terminal ? 0.5 : 10)) return;
  shown_ = now;
  const std::chrono::duration<double> all = now - begun_;
  std::string text = fmt::format("{} {} pictures, {:.1f} s", what_, pictures, ms / 1000);
  if (length_ms_ && *length_ms_ > 0) text += fmt::format(" of {:.1f}", *length_ms_ / 1000);
  text += fmt::format(", {:.1f} pictures a second", static_cast<double>(pictures) / all.count());
  std::cerr << (terminal ? "\r\033[K" + text : text + "\n") << std::flush;
  open_line_ = terminal;
}

Progress::~Progress() {
  if (open_line_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace facetrack
