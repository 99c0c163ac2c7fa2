#include "ssm/voice/voice_log.h"

#include <cerrno>
#include <cstring>
#include <iostream>
#include <utility>

#include "vm_protocol/core/file_kind.h"

namespace ssm {

vm::Result<void> VoiceLog::Open(const std::string& where) {
  std::ofstream file;
  if (where != "NO" && where != "CONSOLE") {
    if (auto fit = vm::CheckWritable(where); !fit) return fit;
    file.open(where, std::ios::app);
    if (!file) {
      return vm::Fail(vm::Errc::kUnavailable,
                      "cannot write '" + where + "': " + std::strerror(errno));
    }
  }
  file_ = std::move(file);
  console_ = where == "CONSOLE";
  return {};
}

void VoiceLog::Choose(std::string kind, bool wanted) {
  if (wanted) {
    wanted_.insert(std::move(kind));
  } else {
    wanted_.erase(kind);
  }
}

void VoiceLog::Write(std::string_view kind, std::string_view value) {
  if (!wanted_.contains(kind)) return;
  if (console_) std::cerr << kind << ": " << value << '\n';
  if (file_.is_open()) file_ << kind << ": " << value << std::endl;
}

}  // namespace ssm
