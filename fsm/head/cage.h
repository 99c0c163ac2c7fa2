#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "fsm/base/table_reader.h"
#include "fsm/head/anatomy.h"

namespace fsm {

/// The kind of a part of the skin, which determines its paint or material.
enum class SkinKind : std::uint8_t { kSkin, kRim, kLip, kInside };

/// The relation of a cage point to the openings (lids, lips, nostrils) around it. Tags are
/// interpolated when the cage is subdivided.
struct CageTag {
  float eye = 0;        ///< 1 on the lids, 0 from the edge of the socket outward
  float lid_upper = 0;  ///< part in the rotation of each lid
  float lid_lower = 0;
  float margin = -1;     ///< distance from the lid's margin, mm; < 0: not on a lid
  float lip_hold = 0;    ///< part in closing the lips
  float upper_lip = 0;   ///< 1 on the upper lip, -1 on the lower, 0 at the corners
  float lip_column = 0;  ///< 0 at the median .. kLipColumns at the corner
  float red = -1;        ///< 0 at the seam .. 1 at the vermilion border; < 0: not on the red
  float deep = 0;        ///< depth in the bag of the mouth, 0..1
  float hole = 0;        ///< depth in a nostril, 0..1
  float seam = 0;        ///< 1 on the line where the lips meet
};
inline constexpr int kLipColumns = 6;
inline constexpr int kLidPoints = 18;

/// A polygon mesh of the left half of the skin.
struct Cage {
  struct Polygon {
    std::vector<std::uint32_t> corner;
    SkinKind kind;
    bool fine;
  };
  std::vector<glm::vec3> position;
  std::vector<CageTag> tag;
  std::vector<Polygon> polygons;
  std::map<std::string, std::vector<std::uint32_t>, std::less<>> curves;
};

/// Reads curves.txt and patches.txt; the curves of lids and mouth are made from their anatomies.
/// Polygons are oriented to face outward. Throws std::runtime_error naming file and line.
Cage ReadCage(const Table& curves, const Table& patches, const EyeAnatomy& eye,
              const MouthAnatomy& mouth);

/// Returns the point that "CURVE.i" names; throws naming the line of `row` if there is none.
std::uint32_t CagePoint(const Cage& cage, const TableRow& row, std::string_view word);

/// Number of rings of mouth curves, and index of the seam among them.
inline constexpr int kMouthRings = 10;
inline constexpr int kSeamRing = 6;

}  // namespace fsm
