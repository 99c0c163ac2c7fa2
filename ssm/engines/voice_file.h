#pragma once

#include <map>
#include <string>

#include "vm_protocol/core/result.h"

namespace ssm {

/// The head of a .htsvoice file (HTS voice format 1.0: lines KEY:VALUE in the sections [GLOBAL],
/// [STREAM] and [POSITION], then [DATA] with bytes). hts_engine ends the program or worse if what
/// the head promises is not there, so it is looked at first.
struct VoiceFileHead {
  std::map<std::string, std::string> values{};  ///< of [GLOBAL] and [STREAM]
};

/// Errors, with the file's name: kUnavailable (cannot be read), kBadValue (no voice file, a value
/// missing, a place in [POSITION] outside the file).
vm::Result<VoiceFileHead> ReadVoiceFileHead(const std::string& path);

/// Two voices can be mixed if rates, frames, states, streams and labels are of one kind. Error:
/// kBadValue that names the first value that differs.
vm::Result<void> CheckVoicesFit(const VoiceFileHead& first, const VoiceFileHead& other,
                                const std::string& other_path);

}  // namespace ssm
