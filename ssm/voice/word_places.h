#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Where the words of an utterance stand in its text. Engines tell words as they read them
/// ("twenty" for "20", "doctor" for "Dr."): those found in the text (without case, wide forms as
/// narrow ones) are put there, and the others share what is written between them.
class WordPlaces {
 public:
  WordPlaces(std::string_view text, const std::vector<WordTime>& words);

  /// When what is written from byte `at` on begins: inside of a word a part of it, between words
  /// the next one's begin. None behind the last word.
  std::optional<Millis> Begin(std::size_t at) const;
  /// When what is written up to byte `at` ends. None before the first word.
  std::optional<Millis> End(std::size_t at) const;

 private:
  struct Place {
    std::size_t begin, end;  ///< bytes of the text
    Millis start, stop;
    Millis At(std::size_t byte) const;
  };
  std::vector<Place> places_;  ///< in order, none over another
};

}  // namespace ssm
