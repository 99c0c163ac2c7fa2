#pragma once

#include <map>
#include <memory>
#include <string>

#include "ssm/engines/open_jtalk_program.h"

namespace ssm {

/// A Japanese speaker with voice files for emotions, in process: labels by the program open_jtalk,
/// durations and sound by hts_engine. An emotion of strength s is spoken by the voice s of the way
/// from the speaker's own voice file to the emotion's (durations, spectrum, intonation and
/// loudness); an emotion without a file changes speed, pitch and loudness as with every voice.
/// Durations are known before there is sound, which is made sentence by sentence while it plays.
struct HtsOptions {
  OpenJtalkOptions analysis{};  ///< its voice_file is the speaker's own voice
  /// Of one kind with it, by the emotion's name in the protocol.
  std::map<std::string, std::string> emotions{};
};
/// There if SSM_HAS_HTS is defined. Errors: those of MakeOpenJtalkEngine and of HtsVoices::Load.
vm::Result<std::unique_ptr<SpeechEngine>> MakeHtsEngine(HtsOptions options);

}  // namespace ssm
