#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ssm {

/// How a voice changes in an emotion at full strength; factors, 1 = as ever.
struct Manner {
  double rate = 1;  ///< of speed
  double pitch = 1;
  double volume = 1;  ///< of amplitude
};

/// The emotion something is said with. What it does by its manner is part of a span's stretch,
/// pitch and volume already; a voice that has the emotion itself takes `manner` out of them again.
struct Feeling {
  std::string name{};     ///< empty or NEUTRAL: none
  double strength01 = 0;  ///< 1 = full
  Manner manner{};
};

/// The manner of an emotion by its name in the protocol (NEUTRAL HAPPY ANGRY DISGUSTED SAD
/// SURPRISED FEARED), `strength` from 0 to 100 %; none for another name. Between, factors are the
/// full ones to the power of strength/100, so that half twice is the whole.
std::optional<Manner> MannerOf(std::string_view emotion, double strength);

}  // namespace ssm
