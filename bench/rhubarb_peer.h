#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/closures.h"
#include "vm_protocol/core/result.h"

namespace speech_bench {

/// Rhubarb Lip Sync on a sound file whose text is known, for comparison. It is called as
///     rhubarb -q -f json -r pocketSphinx --extendedShapes GHX -d TEXT.txt FILE.wav
/// and answers with mouth shapes: A is the closed mouth of P, B and M, X the closed one of pauses.
struct Peer {
  std::string program = "rhubarb";
  double work_s = 0;  ///< processor time of all calls, its own threads included

  /// The times in which the mouth is closed. Errors: kUnavailable (there is no such program, it
  /// fails), kTimeout, kBadValue (its answer).
  vm::Result<std::vector<Interval>> Closed(const std::string& wav_path,
                                           const std::string& text_path);
};

/// True if the program can be found.
bool IsOnPath(const std::string& program);

/// {"mouthCues": [{"start": 0.25, "end": 0.4, "value": "A"}, ...]}, times in seconds: the closed
/// ones. Error: kBadValue.
vm::Result<std::vector<Interval>> ClosedMouths(std::string_view json);

}  // namespace speech_bench
