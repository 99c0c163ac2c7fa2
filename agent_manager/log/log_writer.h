#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

#include "agent_manager/log/log_config.h"

namespace am {

/// Writes lines to a file that is put aside and compressed when it has grown too large. The
/// compressing is done along with the writing, a piece for each line, so no line waits long for it.
/// A full disk loses lines, never the session: it is said once, and the log says how many. A file
/// that cannot be put aside grows on; that is said once, too.
/// Thread: one.
class LogWriter {
 public:
  using OnTrouble = std::function<void(const std::string& text)>;
  /// Throws std::runtime_error with a sentence if the file cannot be made.
  LogWriter(const LogConfig& config, OnTrouble on_trouble);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;

  void Write(std::string_view line);
  /// Hands what was written to the system.
  void Flush();
  std::uint64_t lost() const { return lost_; }

 private:
  bool Open(const char* mode = "we");
  void Put();
  void Rotate();
  bool PutAside();
  bool ShiftOld();
  void CompressSome(std::size_t bytes);
  void EndCompressing();
  std::string Aside() const { return config_.file + ".1"; }
  std::string Packed(unsigned number) const {
    return config_.file + "." + std::to_string(number) + ".gz";
  }

  LogConfig config_;
  OnTrouble on_trouble_;
  std::FILE* file_ = nullptr;
  std::string buffer_;
  std::uint64_t size_ = 0;  // of the file
  std::uint64_t lost_ = 0, lost_since_ = 0;
  bool stuck_ = false;          // the file could not be put aside the last time
  std::FILE* aside_ = nullptr;  // being compressed
  gzFile packed_ = nullptr;
};

/// The whole content of a log, compressed or not. Throws std::runtime_error with a sentence.
std::string ReadLog(const std::string& path);

}  // namespace am
