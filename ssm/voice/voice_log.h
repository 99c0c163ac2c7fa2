#pragma once

#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace ssm {

/// The original's log of how a text became speech: `Log` says where to, `Log.text` and its like
/// what of it. Each entry is one line, "KIND: VALUE".
class VoiceLog {
 public:
  /// A file (appended to), CONSOLE (stderr) or NO. Error: kUnavailable; then it stays as it was.
  vm::Result<void> Open(const std::string& where);
  void Choose(std::string kind, bool wanted);
  void Write(std::string_view kind, std::string_view value);

 private:
  bool console_ = false;
  std::ofstream file_;
  std::set<std::string, std::less<>> wanted_;
};

}  // namespace ssm
