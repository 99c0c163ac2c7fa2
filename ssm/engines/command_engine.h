#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ssm/engines/aligner.h"

namespace ssm {

/// Any program as a voice. It gets one sentence on its standard input and, in its arguments,
///   {wav}      a path to write the sound to (any rate; without it the WAV comes on stdout)
///   {labels}   a path to write the phonemes to (without it they come on stdout, if the WAV does
///              not)
///   {rate} {pitch} {language} {voice}     factors, 1 = normal; the names below
/// Phonemes are `name[ms]` with blanks or line ends between. If there are none, the aligner finds
/// them. They may be mapped to a set by a table (see PhonemeMap).
/// Errors: kUnavailable (cannot be started, fails, no sound), kTimeout (it is killed), kBadValue.
struct CommandOptions {
  std::string name{};
  std::string language = "en";
  bool female = false;
  std::vector<std::string> argv{};
  std::string table{};                      ///< text of a phoneme table; empty = names as they come
  std::string table_name{};                 ///< for its errors
  std::chrono::milliseconds limit{20'000};  ///< for one sentence
  std::string aligner{};                    ///< path of align; empty = phonemes must come
};
vm::Result<std::unique_ptr<SpeechEngine>> MakeCommandEngine(CommandOptions options);

/// One recording.
struct Recording {
  std::string text{};  ///< what is said in it
  std::string wav{};   ///< path
};
/// A voice that is a list of recordings: a sentence that is among them (letters and digits count,
/// case does not) is played with its phonemes found by the aligner; any other is refused
/// (kUnavailable, naming it). FILE.info of SaveWAV beside the sound is used instead if it is there.
struct RecordedOptions {
  std::string name{};
  std::string language = "en";
  bool female = false;
  std::vector<Recording> recordings{};
  std::string aligner{};
};
std::unique_ptr<SpeechEngine> MakeRecordedEngine(RecordedOptions options);

}  // namespace ssm
