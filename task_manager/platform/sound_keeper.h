#pragma once

#include <map>
#include <string>

#include "vm_protocol/core/result.h"

namespace vxml {

/// Keeps sounds that came over the net in files of a folder of its own, for the voice to play. The
/// voice has to see the same disk. Limits: kMaxBytes and kMaxFiles; over them all kept so far
/// go. The folder goes with it. Thread: the session's.
class SoundKeeper {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
  static constexpr std::size_t kMaxFiles = 64;

  SoundKeeper() = default;
  ~SoundKeeper();
  SoundKeeper(const SoundKeeper&) = delete;
  SoundKeeper& operator=(const SoundKeeper&) = delete;

  /// Its folder, made when first needed. Other files in it are not counted, and go with it.
  vm::Result<std::string> Folder();
  /// The file that holds `bytes`, written now unless `uri` brought the same before.
  vm::Result<std::string> FileOf(const std::string& uri, const std::string& bytes);

 private:
  void Clear();

  std::string folder_;
  std::map<std::string, std::pair<std::string, std::size_t>> kept_;  ///< by URI: file, its hash
  std::size_t bytes_ = 0;
  std::size_t count_ = 0;
};

}  // namespace vxml
