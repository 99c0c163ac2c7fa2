#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/result.h"

namespace filmdub {

/// What is said in place of what the film says.
struct SpeechWanted {
  std::string text;                       ///< one of text and
  std::string sound;                      ///< any sound file
  std::string voice;                      ///< of a text: a speaker of ssm; "" = its first
  std::vector<std::string> voice_module;  ///< the command that starts ssm
};

/// New words: their sound, and a face that says them.
struct NewSpeech {
  std::string sound_file{};  ///< what the film is to sound of
  double length_s = 0;
  /// The mouth at a time since the sound's beginning. Everything but the mouth is at rest.
  std::unique_ptr<fsm::FaceMotion> motion{};
};

/// A text is spoken by a voice module, whose sound is `kept` as a WAV file and whose phonemes move
/// the mouth; the mouth of a sound is what the network of vdm hears in it. Errors: the voice's or
/// the file's own.
vm::Result<NewSpeech> Prepare(const SpeechWanted& wanted, const std::string& kept);

}  // namespace filmdub
