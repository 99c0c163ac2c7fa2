#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vdm/train/dice.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// One voice of the training; tables/voices.txt.
struct TrainingVoice {
  std::string name;
  std::string engine;    ///< flite, espeak or festival
  std::string language;  ///< en, en-gb, ja, it, fi, cs, ru
  std::size_t sentences = 0;
  std::string variant;  ///< of espeak-ng, empty: none; festival's name of the voice
};
/// kBadValue "NAME:LINE: ...".
vm::Result<std::vector<TrainingVoice>> ReadVoices(const std::string& name, std::string_view text);
const std::vector<TrainingVoice>& BuiltVoices();

/// What is read in one language; tables/reading_en.txt.
struct Reading {
  std::vector<std::string> sentences, words;
  std::string between;  ///< words of a made-up sentence
  std::string stop;     ///< ends it
  /// The n-th text of a voice: every other one is a sentence of the table, in an order of the
  /// voice's own, the others are four to nine words by chance.
  std::string Text(std::size_t n, Dice dice) const;
};
/// kBadValue "NAME:LINE: ...".
vm::Result<Reading> ReadReading(const std::string& name, std::string_view text);
/// REQUIRES: a language of the table of voices.
const Reading& BuiltReading(const std::string& language);

}  // namespace vdm
