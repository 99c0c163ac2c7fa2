#include "face_fit/find/head/point_pairs.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <iterator>
#include <span>

#include "face_fit/image/median.h"

namespace facefit {
namespace {

constexpr glm::vec3 kMirror(-1, 1, 1);

/// Returns the mirrored pair on the other side of our face, or nullptr.
const fsm::PointPair* MirroredPair(const fsm::PointPair& pair,
                                   std::span<const fsm::PointPair> pairs) {
  constexpr float kSameMm = 5;
  const auto nearest = std::ranges::min_element(pairs, {}, [&](const fsm::PointPair& other) {
    return other.feature == pair.feature ? glm::distance(kMirror * other.from, pair.from) : 1e9F;
  });
  return glm::distance(kMirror * nearest->from, pair.from) > kSameMm ? nullptr : &*nearest;
}

/// The plane of symmetry of a head.
struct MirrorPlane {
  glm::vec3 at, normal;
  glm::vec3 Mirrored(glm::vec3 p) const { return p - 2 * glm::dot(p - at, normal) * normal; }
};

/// Uses medians of the directions from side to side and of their middles, which a few outliers do
/// not change.
MirrorPlane FindMirrorPlane(std::span<const fsm::PointPair> pairs) {
  constexpr float kApartMm = 20;
  std::vector<float> up, ahead, middles;
  for (const auto& pair : pairs) {
    const auto* other = MirroredPair(pair, pairs);
    if (!other || pair.to.x - other->to.x < kApartMm) continue;
    const glm::vec3 across = pair.to - other->to;
    up.push_back(across.y / across.x);
    ahead.push_back(across.z / across.x);
  }
  if (up.empty()) return {glm::vec3(0), {1, 0, 0}};
  const glm::vec3 normal = glm::normalize(glm::vec3(1, Median(up), Median(ahead)));
  for (const auto& pair : pairs) {
    const auto* other = MirroredPair(pair, pairs);
    if (other) middles.push_back(0.5F * glm::dot(pair.to + other->to, normal));
  }
  return {Median(middles) * normal, normal};
}

}  // namespace

std::vector<fsm::PointPair> RejectOutliers(std::span<const fsm::PointPair> pairs) {
  constexpr float kMinLimitMm = 8,
                  kLimitByMedian = 3;  // the second is a multiple of the median distance
  constexpr int kRounds = 6;
  std::vector<fsm::PointPair> kept(pairs.begin(), pairs.end());
  for (int round = 0; round < kRounds; ++round) {
    const auto to_base = fsm::FitSimilarity(kept);
    const auto gap_mm = [&to_base](const fsm::PointPair& pair) {
      return glm::distance(to_base(pair.to), pair.from);
    };
    std::vector<float> distances;
    for (const auto& pair : pairs) distances.push_back(gap_mm(pair));
    const float limit = std::max(kMinLimitMm, kLimitByMedian * Median(std::move(distances)));
    kept.clear();
    std::ranges::copy_if(pairs, std::back_inserter(kept),
                         [&](const auto& pair) { return gap_mm(pair) <= limit; });
  }
  return kept;
}

std::vector<fsm::PointPair> Symmetrise(const fsm::Similarity& to_base,
                                       std::vector<fsm::PointPair> pairs) {
  constexpr float kNearMm = 7;
  std::vector<fsm::PointPair> aligned = pairs;
  for (auto& pair : aligned) pair.to = to_base(pair.to);
  const MirrorPlane mirror = FindMirrorPlane(aligned);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto* mirrored = MirroredPair(aligned[i], aligned);
    if (!mirrored) continue;
    const glm::vec3 opposite = mirror.Mirrored(mirrored->to);
    if (glm::distance(opposite, aligned[i].to) > kNearMm) continue;
    pairs[i].from = 0.5F * (aligned[i].from + kMirror * mirrored->from);
    const glm::vec3 to = 0.5F * (aligned[i].to + opposite);
    pairs[i].to = to_base.Inverse(to);
  }
  return pairs;
}

}  // namespace facefit
