#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Voices beside flite's, from a JSON file (docs/speech.md):
///   {"voices": [{"name": "mei", "engine": "open_jtalk", "voice": "mei_normal.htsvoice"},
///               {"name": "bell", "engine": "command", "language": "en", "argv": ["say", "{wav}"]},
///               {"name": "tape", "engine": "recorded",
///                "recordings": [{"text": "Hello.", "wav": "hello.wav"}]}],
///    "languages": {"ja": "mei"}}
/// Paths in it are relative to the file's folder.
struct VoicesConfig {
  std::vector<std::unique_ptr<SpeechEngine>> engines;
  std::map<std::string, std::string> languages;  ///< which voice takes a language
};

/// What engines need from the program's surroundings.
struct VoicesSetting {
  std::string folder = ".";  ///< of the file
  std::string aligner{};     ///< path of align; may be missing
  std::function<vm::Result<std::string>(const std::string& path)> read_file{};
};

/// Errors: kSyntax (no JSON, with the place), kBadValue (an unknown key, a missing one, a wrong
/// kind: names the voice and the key), and those of the engines.
vm::Result<VoicesConfig> ParseVoicesConfig(std::string_view json, const VoicesSetting& setting);

}  // namespace ssm
