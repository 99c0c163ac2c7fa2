#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "face_space/app/commands.h"

namespace facespace {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(2) != 0) {}

void Progress::At(double share) {
  const int percent = static_cast<int>(100 * share);
  if (quiet_ || percent / (terminal_ ? 1 : 10) == shown_) return;
  shown_ = percent / (terminal_ ? 1 : 10);
  std::cerr << fmt::format("{}face_space: {}, {} %{}", terminal_ ? "\r\033[K" : "", what_, percent,
                           terminal_ ? "" : "\n")
            << std::flush;
}

Progress::~Progress() {
  if (terminal_ && shown_ >= 0) std::cerr << "\r\033[K" << std::flush;
}

void NotTheInput(const std::string& out, const std::string& input) {
  std::error_code code;
  if (out == input || std::filesystem::equivalent(out, input, code)) {
    throw std::runtime_error(
        fmt::format("'{}' is read and would be overwritten; another place for what is "
                    "written expected",
                    out));
  }
}

}  // namespace facespace
