#include "chat/model/sse_reader.h"

#include <algorithm>
#include <utility>

namespace chat {

void SseReader::TakeLine(std::string_view line, std::vector<std::string>& events) {
  if (!std::exchange(begun_, true) && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  if (line.empty()) {
    if (std::exchange(has_data_, false)) events.push_back(std::exchange(data_, {}));
    return;
  }
  const std::size_t colon = std::min(line.find(':'), line.size());
  if (line.substr(0, colon) != "data") return;
  line.remove_prefix(std::min(colon + 1, line.size()));
  if (line.starts_with(' ')) line.remove_prefix(1);
  if (has_data_) data_ += '\n';
  data_ += line;
  has_data_ = true;
}

vm::Result<std::vector<std::string>> SseReader::Feed(std::string_view bytes) {
  std::vector<std::string> events;
  while (!bytes.empty() && !failed_) {
    if (std::exchange(after_cr_, false) && bytes.front() == '\n') {
      bytes.remove_prefix(1);
      continue;
    }
    const std::size_t end = bytes.find_first_of("\r\n");
    line_ += bytes.substr(0, end);
    failed_ = line_.size() > kMaxEventBytes;
    if (end == std::string_view::npos) break;
    after_cr_ = bytes[end] == '\r';
    bytes.remove_prefix(end + 1);
    TakeLine(line_, events);
    line_.clear();
    failed_ = failed_ || data_.size() > kMaxEventBytes;
  }
  if (!failed_) return events;
  line_ = data_ = "";
  return vm::Fail(vm::Errc::kTooLong, "an event of the stream has more than " +
                                          std::to_string(kMaxEventBytes) + " bytes");
}

}  // namespace chat
