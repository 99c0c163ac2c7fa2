#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/head/face_state.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// What speech does to the mouth at one instant: the speech part of FaceState, same units.
struct MouthPose {
  std::array<float, kMouthParameters> mouth{};
  float seal = 0;
  float tongue = 0;
};
MouthPose Mix(const MouthPose& a, const MouthPose& b, double share_of_b);

/// One key shape of the mouth, at full articulation.
struct MouthShape {
  std::string name;
  MouthPose pose;
  double hold = 0;  ///< share of a phoneme for which the shape stands before it moves on
};

/// The 14 shapes by their numbers; 0 is the mouth at rest.
using MouthShapes = std::vector<MouthShape>;
inline constexpr std::size_t kMouthShapes = 14;
vm::Result<MouthShapes> ReadMouthShapes(const std::string& name, std::string_view text);

/// What a phoneme looks like: one shape, or two for a diphthong.
struct PhonemeLook {
  static constexpr int kNext = -1;  ///< takes the shape of what follows
  struct Part {
    int shape = 0;  ///< index into MouthShapes, or kNext
    double strength = 1;
  };
  std::vector<Part> parts;  ///< one or two
};
/// By phoneme name; names differ in case (N is not n).
using PhonemeTable = std::map<std::string, PhonemeLook, std::less<>>;
vm::Result<PhonemeTable> ReadPhonemeTable(const std::string& name, std::string_view text,
                                          const MouthShapes& shapes);

}  // namespace fsm
