#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/action_units.h"

namespace fsm {

/// A space of expressions: a network of five layers that maps the strengths of units onto
/// themselves through a middle of three (S. Morishima, H. Harashima, Emotion space for analysis and
/// synthesis of facial expression, RO-MAN 1993). What leads into the middle makes a point of an
/// expression, what leads out of it an expression of a point. Layers have weights and no biases,
/// and cut at zero or not at all; so the middle of the space is the face at rest, and a point twice
/// as far out is the same expression at twice the strength. A plain value.
struct EmotionSpace {
  using Point = std::array<float, 3>;
  struct Layer {
    bool rectified = true;                 ///< cuts at zero
    std::vector<std::vector<float>> rows;  ///< of each output a weight for each input
  };

  std::vector<int> units;      ///< numbers of the units, in the order of the network's ratios
  std::vector<Layer> encoder;  ///< from ratios to a point
  std::vector<Layer> decoder;  ///< from a point to ratios
  /// Where the first pattern of each emotion lies at full strength.
  std::map<std::string, Point, std::less<>> emotions;

  /// REQUIRES: as many ratios as units; the strengths of units, 0 = rest, 1 = full.
  Point PointOf(std::span<const float> ratios) const;
  /// The strengths of `units` there, 0 to 2: the network's, cut to those limits.
  std::vector<float> RatiosAt(const Point& point) const;
  /// The same as a look, alike on both sides.
  ActionUnits LookAt(const Point& point) const;
};

/// Reads tables/emotion_space.txt, which face_space makes. Rows:
///
///   units NUMBER...
///   encode relu|linear      begins a layer; or decode relu|linear
///   row WEIGHT...           of each output of that layer
///   emotion NAME X Y Z
///
/// Limits: 64 units, 4 layers each way, 256 outputs of a layer. Errors: kBadValue "NAME:LINE: what
/// was expected".
vm::Result<EmotionSpace> ReadEmotionSpace(const std::string& name, std::string_view text,
                                          const UnitNames& names);

}  // namespace fsm
