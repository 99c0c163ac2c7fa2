#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/motion/base/face_look.h"

namespace fsm {

/// A space of expressions: a network of five layers that maps the strengths of units onto
/// themselves through a middle layer of three (S. Morishima, H. Harashima, Emotion space for
/// analysis and synthesis of facial expression, RO-MAN 1993). The encoder maps an expression to a
/// point, the decoder a point to an expression. Layers have weights and no biases, and are
/// rectified (ReLU) or linear; the origin is therefore the face at rest, and a point twice as far
/// out is the same expression at twice the strength. A plain value.
struct EmotionSpace {
  using Point = std::array<float, 3>;
  struct Layer {
    bool rectified = true;                 ///< ReLU; else linear
    std::vector<std::vector<float>> rows;  ///< per output, a weight for each input
  };

  std::vector<int> units;      ///< unit numbers, in the order of the network's inputs
  std::vector<Layer> encoder;  ///< from strengths to a point
  std::vector<Layer> decoder;  ///< from a point to strengths
  /// The point of each emotion: its first pattern at full strength.
  std::map<std::string, Point, std::less<>> emotions;

  /// Returns the point of an expression. `ratios`: the strengths of `units`, 0 = rest, 1 = full.
  /// REQUIRES: as many ratios as units.
  Point PointOf(std::span<const float> ratios) const;
  /// Returns the strengths of `units` at a point, clamped to 0..2.
  std::vector<float> RatiosAt(const Point& point) const;
  /// Returns the strengths of RatiosAt as action units, the same on both sides.
  FaceLook LookOf(const Point& point) const;
};

/// Reads tables/emotion_space.txt, which the program face_space writes. Rows:
///
///   units NUMBER...
///   encode relu|linear      begins a layer; or decode relu|linear
///   row WEIGHT...           of each output of that layer
///   emotion NAME X Y Z
///
/// Limits: 64 units, 4 layers in encoder and decoder each, 256 outputs per layer. Errors: kBadValue
/// "NAME:LINE: what was expected".
vm::Result<EmotionSpace> ReadEmotionSpace(const std::string& name, std::string_view text,
                                          const UnitNames& names);

}  // namespace fsm
