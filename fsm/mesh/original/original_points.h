#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <utility>

#include "fsm/base/side.h"
#include "fsm/mesh/original/pnt_file.h"

namespace fsm {

/// Named points of the original's wireframe, identified by inspecting fheadv2.pnt and .lnk: the rim
/// of the mouth is the open edge of groups 1 and 2, the rims of the lids are those of 4 and 5.
inline constexpr PointName kChin{18, 20}, kLipMiddle{1, 36};
inline constexpr Sided<PointName> kLipCorners{{1, 33}, {2, 33}};

/// The rim of the mouth from the agent's right corner over the upper lip and back over the lower.
inline constexpr std::array<PointName, 20> kLipRim{
    {{1, 33}, {1, 14}, {1, 13}, {1, 12}, {1, 11}, {1, 36}, {2, 11}, {2, 12}, {2, 13}, {2, 14},
     {2, 33}, {2, 18}, {2, 17}, {2, 16}, {2, 15}, {1, 37}, {1, 15}, {1, 16}, {1, 17}, {1, 18}}};
/// Points that bound the teeth: the jaw on both sides, the front of the upper lip above its edge,
/// and for each row its top, its bottom and its front.
inline constexpr Sided<PointName> kJawAtTeeth{{12, 15}, {13, 15}};
inline constexpr PointName kUpperLipFront{1, 35};
struct TeethPoints {
  PointName top, bottom, front;
};
inline constexpr TeethPoints kUpperTeeth{{12, 17}, kLipMiddle, {1, 10}};
inline constexpr TeethPoints kLowerTeeth{{1, 37}, {1, 40}, {1, 22}};

/// Points of upper and lower lip that meet, from the agent's right corner to the left.
inline constexpr std::array<std::pair<PointName, PointName>, 11> kLipPairs{{{{1, 33}, {1, 33}},
                                                                            {{1, 14}, {1, 18}},
                                                                            {{1, 13}, {1, 17}},
                                                                            {{1, 12}, {1, 16}},
                                                                            {{1, 11}, {1, 15}},
                                                                            {{1, 36}, {1, 37}},
                                                                            {{2, 11}, {2, 15}},
                                                                            {{2, 12}, {2, 16}},
                                                                            {{2, 13}, {2, 17}},
                                                                            {{2, 14}, {2, 18}},
                                                                            {{2, 33}, {2, 33}}}};
/// The rim of the lids, inner corner first.
std::span<const PointName> LidRim(Side side);

/// Points with the names of Head::Landmark.
inline constexpr std::pair<const char*, PointName> kNamedPoints[] = {
    {"pronasale", {3, 15}},
    {"subnasale", {3, 25}},
    {"gnathion", kChin},
    {"cheilion_right", {1, 33}},
    {"cheilion_left", {2, 33}},
    {"endocanthion_right", {4, 17}},
    {"endocanthion_left", {5, 17}},
    {"exocanthion_right", {4, 23}},
    {"exocanthion_left", {5, 23}},
    {"nasion", {3, 1}},
    {"alare_right", {3, 18}},
    {"alare_left", {3, 22}}};

/// Tells whether a group is drawn: face, surrounding hair, throat and shoulders are. The others,
/// the back of the head and the inside of eyes and mouth, are in the original's data but not drawn
/// by it either.
constexpr bool IsDrawn(int group) {
  return (group >= 1 && group <= 19) || group == 30 || group == 31;
}

/// Transforms a wireframe to our frame, so that its eye openings coincide with those of the
/// built-in heads.
class OriginalSpace {
 public:
  /// REQUIRES: `wireframe` has the points of both LidRim.
  explicit OriginalSpace(const PntFile& wireframe);
  glm::vec3 ToMm(glm::vec3 p) const { return (p - middle_) * mm_ + kOpening; }
  glm::vec3 PositionMm(const PntFile& file, PointName name) const {
    return ToMm(file.positions[file.index.at(name)]);
  }
  glm::vec3 EyeOpening(const PntFile& file, Side side) const;
  float mm() const { return mm_; }

 private:
  /// The midpoint between the centres of the built-in heads' lid rims.
  static constexpr glm::vec3 kOpening{0, 21.5f, 74};
  static constexpr float kOpeningsApart = 59.8f;
  glm::vec3 middle_{0};
  float mm_ = 1;
};

/// Checks that `file` has all points above. Error: kBadValue naming the first that is missing.
vm::Result<void> CheckPoints(const std::string& name, const PntFile& file);

}  // namespace fsm
