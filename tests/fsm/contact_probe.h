#pragma once

#include <utility>
#include <vector>

#include "tests/fsm/head_fixture.h"

namespace fsm::testing {

/// How deep parts of a face lie in each other, in millimetres; 0 = not at all.
struct Contacts {
  float lips = 0;             ///< the lower lip above the upper at the seam
  float lids = 0;             ///< the lower lid's rim above the upper's
  float ball_in_lids = 0;     ///< eyeball or cornea before a lid's skin
  float teeth_in_lips = 0;    ///< a tooth's front before a lip that is seen
  float tongue_in_lips = 0;   ///< the tongue above the upper or below the lower lip, in the seam
  float tongue_in_teeth = 0;  ///< likewise at the edges of the incisors
};

/// Measures contacts of the generic head. Vertices that belong together are found once, by what
/// they do in plain states, so no knowledge of how the mesh is made is needed.
class ContactProbe {
 public:
  ContactProbe();
  /// `v` belongs to `state`.
  Contacts Measure(const FaceState& state, const HeadVertices& v) const;
  /// How far the eye comes before the skin that should cover it, seen from the front; 0 = covered.
  float Uncovered(const FaceState& state, const HeadVertices& v) const;

  /// Upper and lower vertices that meet, ordered by x.
  using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const Pairs& seam() const { return seam_; }
  const Pairs& rims(Side side) const { return rims_[side]; }
  /// Edges of the incisors, from -x to +x.
  const std::vector<std::uint32_t>& upper_edge() const { return upper_edge_; }
  const std::vector<std::uint32_t>& lower_edge() const { return lower_edge_; }

  std::size_t seam_pairs() const { return seam_.size(); }
  std::size_t rim_pairs() const { return rims_.right.size() + rims_.left.size(); }

 private:
  float TeethInLips(const HeadVertices& v) const;
  /// How far the tongue comes beyond a line, by x, upwards (up 1) or downwards (up -1).
  float TongueAcross(const std::vector<glm::vec3>& line, float up, const HeadVertices& v) const;

  Pairs seam_;  // by x
  Sided<Pairs> rims_;
  Sided<std::vector<std::uint32_t>> lids_, lid_triangles_;
  std::vector<std::uint32_t> lips_, teeth_, tongue_;
  std::vector<std::uint32_t> upper_edge_, lower_edge_;  // of the incisors, by x
};

}  // namespace fsm::testing
