#include "agent_manager/session/error_stream.h"

#include <poll.h>
#include <unistd.h>

#include <string>

#include "vm_protocol/core/utf8.h"

namespace am {

bool ErrorStream::Put(std::string_view text) const {
  constexpr std::string_view kName = "agent_manager: ", kCut = "...\n";
  const std::string shown = vm::ShownUtf8(text);
  const std::size_t room = kMaxBytes - kName.size() - kCut.size();
  std::string line(kName);
  line += vm::CutUtf8(shown, room);
  line += shown.size() > room ? kCut : "\n";
  pollfd ready{fd_, POLLOUT, 0};
  return poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT) != 0 &&
         write(fd_, line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

void ErrorStream::Write(std::string_view text) {
  if (lost_ > 0 && Put("stderr was full, " + std::to_string(lost_) + " lines were lost")) lost_ = 0;
  if (lost_ > 0 || !Put(text)) ++lost_;
}

}  // namespace am
