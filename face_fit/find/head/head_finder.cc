#include "face_fit/find/head/head_finder.h"

#include <algorithm>
#include <cmath>
#include <expected>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <utility>

#include "face_fit/find/head/lid_edges.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/head/point_pairs.h"
#include "face_fit/image/median.h"
#include "fsm/base/box.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/transferred_rig.h"

namespace facefit {
namespace {

/// Rotations that set the head of a file upright, facing the viewer.
constexpr glm::mat3 kTurns[] = {{1, 0, 0, 0, 1, 0, 0, 0, 1},    // y up, towards z
                                {-1, 0, 0, 0, 1, 0, 0, 0, -1},  // towards -z
                                {1, 0, 0, 0, 0, -1, 0, 1, 0},   // z up, towards -y
                                {0, 0, 1, 0, 1, 0, -1, 0, 0},   // towards x
                                {0, 0, -1, 0, 1, 0, 1, 0, 0}};  // towards -x

/// Share of the file's height, from the top, that may be the head: head, bust, whole figures.
constexpr float kHeadShares[] = {1, 0.8F, 0.28F, 0.15F};

/// Returns the transform of that upper part of the file to the base head's size and position.
fsm::Similarity InitialPlacement(const fsm::ImportedHead& file, const glm::mat3& turn,
                                 float share) {
  fsm::Box box;
  for (const glm::vec3& p : file.position) box.Add(turn * p);
  constexpr float kHeightMm = 290, kCrownYMm = 140;  // height of the base head, y of its crown
  fsm::Similarity guess;
  guess.rotation = turn;
  guess.scale = kHeightMm / std::max(box.size().y * share, 1e-6F);
  guess.translation = -guess.scale * glm::vec3(box.centre().x, box.high.y, box.centre().z);
  guess.translation.y += kCrownYMm;
  return guess;
}

fsm::FaceFeature FeatureOf(PointIndex i) {
  // Inner lips are kNone: where the lips meet, the nearest vertex may be the other lip's.
  if (Contains(point::kUpperOuterLip, i)) return fsm::FaceFeature::kUpperLip;
  if (Contains(point::kLowerOuterLip, i)) return fsm::FaceFeature::kLowerLip;
  for (const fsm::Side side : fsm::kSides) {
    const std::span outline(point::kEyeOutline[side]);
    if (Contains(outline.subspan(1, kInnerCorner - 1), i)) return fsm::FaceFeature::kUpperLid;
    if (Contains(outline.subspan(kInnerCorner + 1), i)) return fsm::FaceFeature::kLowerLid;
  }
  return fsm::FaceFeature::kNone;
}

/// Moves the points of the inner lips onto a lip seam, at equal steps.
void SpreadAlongLipSeam(const LipSeam& seam, PerPoint<MeshPoint>& points) {
  points[point::kInnerMouthRight] = seam.EdgesAt(0).upper;
  points[point::kInnerMouthLeft] = seam.EdgesAt(1).upper;
  const std::size_t count = point::kLowerInnerLip.size();
  for (std::size_t k = 0; k < count; ++k) {
    const LipSeam::Edges& edges =
        seam.EdgesAt(static_cast<float>(k + 1) / static_cast<float>(count + 1));
    points[point::kUpperInnerLip[k]] = edges.upper;
    points[point::kLowerInnerLip[k]] = edges.lower;
  }
}

/// The edges of the lids of the eyes that a head shows.
using LidEdgesOfEyes = fsm::Sided<std::optional<LidEdges>>;

/// `is_eye`: as for FindLidEdges.
LidEdgesOfEyes FindLidEdgesOfEyes(const ObservedHead& observed, const std::vector<bool>& is_eye) {
  const auto find = [&](fsm::Side side) {
    return FindLidEdges(observed.head(), observed.rest().position, is_eye, side);
  };
  return {find(fsm::Side::kRight), find(fsm::Side::kLeft)};
}

/// Moves the points of an eye's outline onto the edges of its lids.
void MoveToLidEdges(const LidEdges& edges, fsm::Side side, PerPoint<MeshPoint>& points) {
  const auto& outline = point::kEyeOutline[side];
  points[outline[kOuterCorner]] = edges.outer;
  points[outline[kInnerCorner]] = edges.inner;
  for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
    points[outline[1 + k]] = edges.upper[k];
    points[outline[outline.size() - 1 - k]] = edges.lower[k];
  }
}

/// Observes a head and pairs its points with those of the built-in one.
class HeadMatcher {
 public:
  HeadMatcher(FaceNetworks& networks, const fsm::ImportedHead& file, std::string name,
              ObservedHead base)
      : networks_(networks),
        file_(file),
        name_(std::move(name)),
        base_(std::move(base)),
        base_lid_edges_(FindLidEdgesOfEyes(base_, EyeVertices(base_.surface()))) {}
  /// Returns none if no face is seen on the head when `to_base` is applied.
  std::vector<fsm::PointPair> PairsAt(const fsm::Similarity& to_base) {
    fsm::UnriggedHead model = fsm::AlignImportedHead(file_, to_base, fsm::kUsualMouthY);
    std::vector<bool> is_eye;
    for (const fsm::Bone bone : model.mesh.bone) {
      is_eye.push_back(bone == fsm::Bone::kEyeRight || bone == fsm::Bone::kEyeLeft);
    }
    const ObservedHead::Skin skin{model.FleshTriangles(), model.has_uv_seams};
    const auto other =
        ObservedHead::Observe(networks_, fsm::RigUnriggedHead(std::move(model)), name_, skin);
    if (!other) return {};
    PerPoint<MeshPoint> on_base = base_.mesh_points(), on_other = other->mesh_points();
    const LidEdgesOfEyes lid_edges = FindLidEdgesOfEyes(*other, is_eye);
    for (const fsm::Side side : fsm::kSides) {
      if (!base_lid_edges_[side] || !lid_edges[side]) continue;  // only where both heads show them
      MoveToLidEdges(*base_lid_edges_[side], side, on_base);
      MoveToLidEdges(*lid_edges[side], side, on_other);
    }
    const bool both = base_.lip_seam() && other->lip_seam();
    if (both) {
      SpreadAlongLipSeam(*base_.lip_seam(), on_base);
      SpreadAlongLipSeam(*other->lip_seam(), on_other);
    }
    std::vector<fsm::PointPair> found;
    for (const PointIndex i : point::kReliable) {
      // A point where the lips meet may lie on either lip.
      const bool corner = Contains(point::kMouthCorners, i);
      if (OnInnerLips(i) ? !both : both && corner) continue;
      const glm::vec3 raw = to_base.Inverse(on_other[i].On(other->rest().position));
      found.push_back({on_base[i].On(base_.rest().position), raw, FeatureOf(i)});
    }
    return found;
  }

 private:
  FaceNetworks& networks_;
  const fsm::ImportedHead& file_;
  std::string name_;
  ObservedHead base_;
  LidEdgesOfEyes base_lid_edges_;
};

/// The pairs found with one rotation of the head.
struct HeadMatch {
  std::vector<fsm::PointPair> pairs;
  float gap_mm;  ///< median distance of the pairs after alignment
};

/// Returns the median distance of the pairs' positions after `to_base` is applied, millimetres.
float MedianDistanceMm(const fsm::Similarity& to_base, std::span<const fsm::PointPair> pairs) {
  std::vector<float> gaps;
  for (const auto& pair : pairs) gaps.push_back(glm::distance(to_base(pair.to), pair.from));
  return Median(std::move(gaps));
}

float DegreesBetween(const glm::mat3& a, const glm::mat3& b) {
  const glm::mat3 turn = a * glm::transpose(b);
  const float cosine = 0.5F * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
  return glm::degrees(std::acos(std::clamp(cosine, -1.0F, 1.0F)));
}

enum class NoMatch { kNoFace, kNotFromFront };
/// Observes the head as guessed, and again scaled and turned as the base head was. A face is
/// matched only if it is seen from the front: the networks find faces in profiles, too, but
/// misplace their points, so that the second pass turns the head again. Measured on two heads, and
/// on one of them made wider, taller, deeper and flatter: from the front the second pass turns the
/// head by at most 1 degree and leaves 3.7 to 7.4 mm, from elsewhere by 8 degrees or more, with 7.3
/// to 40 mm.
std::expected<HeadMatch, NoMatch> ObserveAs(HeadMatcher& matcher, const fsm::Similarity& guess) {
  constexpr float kStraightDeg = 5, kMaxGapMm = 12;
  const auto first = matcher.PairsAt(guess);
  if (first.empty()) return std::unexpected(NoMatch::kNoFace);
  const fsm::Similarity first_fit = fsm::FitSimilarity(RejectOutliers(first));
  const auto pairs = matcher.PairsAt(first_fit);
  if (pairs.empty()) return std::unexpected(NoMatch::kNotFromFront);
  std::vector<fsm::PointPair> kept = RejectOutliers(pairs);
  const fsm::Similarity fit = fsm::FitSimilarity(kept);
  const float gap_mm = MedianDistanceMm(fit, pairs);
  if (DegreesBetween(fit.rotation, first_fit.rotation) > kStraightDeg || gap_mm > kMaxGapMm)
    return std::unexpected(NoMatch::kNotFromFront);
  return HeadMatch{std::move(kept), gap_mm};
}

}  // namespace

vm::Result<fsm::HeadPoints> FindHeadPoints(FaceNetworks& networks, const fsm::ImportedHead& file,
                                           const std::string& name, const std::string& base_name) {
  auto base = ObservedHead::BuiltIn(networks, base_name);
  if (!base) return std::unexpected(base.error());
  HeadMatcher matcher(networks, file, name, std::move(*base));
  bool face_seen = false;
  for (const float share : kHeadShares) {
    std::optional<HeadMatch> best;
    for (const glm::mat3& turn : kTurns) {
      auto match = ObserveAs(matcher, InitialPlacement(file, turn, share));
      face_seen = face_seen || match || match.error() == NoMatch::kNotFromFront;
      if (match && (!best || match->gap_mm < best->gap_mm)) best = std::move(*match);
    }
    if (!best) continue;
    const fsm::Similarity to_base = fsm::FitSimilarity(best->pairs);
    return fsm::HeadPoints{base_name, Symmetrise(to_base, std::move(best->pairs))};
  }
  return vm::Fail(
      vm::Errc::kBadValue,
      (face_seen ? "the face of '" + name +
                       "' is not seen from the front however it is turned: it should face z with y "
                       "up; points"
                 : "no face is seen on '" + name + "' from any side; points") +
          " can also be written by hand (docs/heads.md)");
}

}  // namespace facefit
