#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "vdm/recording/recorded_mouth.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// Recognises the English words of recordings, 16 kHz mono, by Debian's pocketsphinx-en-us, in
/// about a third of their time. Thread: one.
class RecordingReader {
 public:
  /// Error: kUnavailable (no model, or a program that was built without the recogniser).
  static vm::Result<std::unique_ptr<RecordingReader>> Open();
  virtual ~RecordingReader() = default;
  virtual RecordedMouth Read(const std::vector<std::int16_t>& samples) = 0;
};

/// The words of one recording; none where no reader can be opened, or in more than 20 minutes,
/// which it says on standard error in the name of `program`. So it does where it takes long.
RecordedMouth ReadWords(const std::vector<std::int16_t>& samples, std::string_view program);

}  // namespace vdm
