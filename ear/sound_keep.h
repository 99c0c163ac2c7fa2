#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <utility>

#include "vm_protocol/core/slot_machine.h"

namespace ear {

/// Keeps what is said as WAV files (16 kHz, 16 bit, mono) in a folder: the slots Listen.keep and
/// Result.sound. The folder is there already and stays; only files written here are ever removed.
/// Limits: kMaxFiles and kMaxBytes together; beyond them the oldest go.
/// Errors: kBadValue at Listen.keep (no such folder), reports of Listen.keep's error (not written).
class SoundKeep {
 public:
  static constexpr std::size_t kMaxFiles = 256;
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20;
  static constexpr std::size_t kRateHz = 16000;

  /// `slots` outlives it.
  explicit SoundKeep(vm::SlotMachine& slots) : slots_(slots) {}
  void Declare();
  bool on() const { return !folder_.empty(); }
  /// An utterance, before its result is reported. `longest`: it was ended by Listen.longest.
  void Keep(std::span<const std::int16_t> samples, bool longest);

 private:
  vm::Result<std::string> Choose(const std::string& folder);

  vm::SlotMachine& slots_;
  std::string folder_;
  std::deque<std::pair<std::string, std::size_t>> files_;  // oldest first, with their bytes
  std::size_t bytes_ = 0;
  std::size_t count_ = 0;
};

}  // namespace ear
