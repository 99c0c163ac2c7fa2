#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace chat {

/// Server-sent events (HTML standard, 9.2): gives the data of each event of a stream that comes in
/// pieces. Fields other than data, and comments, are passed over. Pure.
/// Limits: kMaxEventBytes for an event and for a line.
class SseReader {
 public:
  static constexpr std::size_t kMaxEventBytes = std::size_t{256} << 10;

  /// The events that are complete. Error: kTooLong, after which the reader gives nothing more.
  vm::Result<std::vector<std::string>> Feed(std::string_view bytes);

 private:
  void TakeLine(std::string_view line, std::vector<std::string>& events);

  std::string line_;
  std::string data_;
  bool has_data_ = false;
  bool after_cr_ = false;  // a LF now belongs to it
  bool begun_ = false;     // a byte order mark may no longer come
  bool failed_ = false;
};

}  // namespace chat
