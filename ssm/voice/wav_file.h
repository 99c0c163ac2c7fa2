#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ssm/voice/samples.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// Writes a WAV file in our format piece by piece. The file is complete after Close or at the end
/// of the object. Errors: kUnavailable with the path and the reason.
class WavWriter {
 public:
  static vm::Result<std::unique_ptr<WavWriter>> Open(const std::string& path);
  ~WavWriter();
  WavWriter(const WavWriter&) = delete;

  vm::Result<void> Write(std::span<const std::int16_t> samples);
  vm::Result<void> WriteSilence(std::size_t frames);
  /// Puts the length so far into the header, so that a reader at this moment finds a whole file.
  void Flush();
  std::size_t frames() const { return frames_; }

 private:
  struct File;
  explicit WavWriter(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
  std::size_t frames_ = 0;
};

/// A file that could not be finished, as on a full disk, is removed, which the error says.
vm::Result<void> WriteWav(const std::string& path, std::span<const std::int16_t> samples);
/// Whether a file can be read as sound, of any kind libsndfile knows.
bool IsSoundFile(const std::string& path);
/// 16 bit big endian without a header, as the original's SaveRAW.
vm::Result<void> WriteRaw(const std::string& path, std::span<const std::int16_t> samples);
/// At most kMaxLoadedFrames. Errors: kUnavailable (cannot be read), kBadValue (not 16 kHz mono),
/// kTooLong.
vm::Result<std::vector<std::int16_t>> ReadWav(const std::string& path);
vm::Result<std::vector<std::int16_t>> ReadRaw(const std::string& path);

inline constexpr std::size_t kMaxLoadedFrames = 3600u * kSampleRateHz;  // an hour

}  // namespace ssm
