#include "agent_manager/session/error_stream.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "vm_protocol/core/utf8.h"

namespace am {

namespace {

/// After lines were lost, others come again when so much is free: a few in one piece, and not each
/// that happens to fit.
constexpr std::size_t kRoomToGoOn = ErrorStream::kBurstBytes / 8;

}  // namespace

void ErrorStream::Refill() {
  const auto passed = std::chrono::duration_cast<std::chrono::milliseconds>(now_() - filled_);
  const auto bytes = static_cast<std::size_t>(passed.count()) * kBytesPerSecond / 1000;
  if (bytes == 0) return;
  room_ = std::min(room_ + bytes, kBurstBytes);
  filled_ += passed;
}

bool ErrorStream::Put(std::string_view text) {
  constexpr std::string_view kName = "agent_manager: ", kCut = "...\n";
  const std::string shown = vm::ShownUtf8(text);
  const std::size_t most = kMaxBytes - kName.size() - kCut.size();
  std::string line(kName);
  line += vm::CutUtf8(shown, most);
  line += shown.size() > most ? kCut : "\n";
  if (line.size() > room_) return false;
  pollfd ready{fd_, POLLOUT, 0};
  if (poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0 ||
      write(fd_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    return false;
  room_ -= line.size();
  return true;
}

void ErrorStream::Write(std::string_view text) {
  Refill();
  if (lost_ > 0 && room_ >= kRoomToGoOn &&
      Put(std::to_string(lost_) + " lines were lost: stderr was full, or they came too fast"))
    lost_ = 0;
  if (lost_ > 0 || !Put(text)) ++lost_;
}

}  // namespace am
