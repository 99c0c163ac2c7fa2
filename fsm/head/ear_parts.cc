#include "fsm/head/ear_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

float Bump(glm::vec2 at, glm::vec2 middle, glm::vec2 size) {
  const glm::vec2 d = (at - middle) / size;
  return Gaussian(glm::dot(d, d));
}

float DistanceToLine(glm::vec2 p, const std::vector<glm::vec2>& line) {
  float least = 1e9f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const glm::vec2 d = line[i + 1] - line[i];
    const float t = std::clamp(glm::dot(p - line[i], d) / glm::dot(d, d), 0.0f, 1.0f);
    least = std::min(least, glm::length(p - line[i] - t * d));
  }
  return least;
}

float Ridge(float distance, float width) { return Gaussian(distance * distance / (width * width)); }

/// The outer ear in its own plane, seen from the agent's left: u backward and v upward from the
/// tragus, in millimetres. Heights are measured outward from the side of the head.
class Ear {
 public:
  explicit Ear(const Features& features) : features_(features) {
    std::vector<float> at;
    for (std::size_t i = 0; i < outline_.size() + 6; ++i) at.push_back(static_cast<float>(i));
    around_ = SplineBasis(at);
  }

  struct Relief {
    float height, open;
  };
  Relief ReliefAt(glm::vec2 p) const {
    const float lobe = features_.ear_lobe.begins.Ramp(p.y);
    const float helix = RidgeAt(features_.ear_helix, p) * (1 - lobe);
    const float anti = RidgeAt(features_.ear_antihelix, p);
    const float fork = RidgeAt(features_.ear_fork, p);
    const float bowl = BumpAt(features_.ear_bowl, p) +
                       features_.ear_upper_bowl.part * BumpAt(features_.ear_upper_bowl, p);
    const float tragus = BumpAt(features_.ear_tragus, p);
    const float notch = BumpAt(features_.ear_notch, p);
    const float height = Flare(features_.ear_flare.front, p) + features_.ear_helix.height * helix +
                         features_.ear_antihelix.height * anti + features_.ear_fork.height * fork -
                         features_.ear_bowl.depth * bowl + features_.ear_tragus.height * tragus -
                         features_.ear_notch.depth * notch + features_.ear_lobe.height * lobe;
    const float groove = (1 - helix) * (1 - anti) * (1 - fork) * (1 - lobe);
    return {height, 1 - features_.ear_dark.bowl * std::min(1.0f, bowl) -
                        features_.ear_dark.grooves * groove * (1 - tragus)};
  }
  float BackAt(glm::vec2 p) const {
    return Flare(features_.ear_flare.back, p) + features_.ear_thick;
  }

  glm::vec2 middle() const { return middle_; }
  /// Maps a point into the head: the ear leans back at the top; its front lies in the cheek.
  glm::vec3 PointAbove(glm::vec2 p, float height) const {
    return {features_.ear_place.aside + height,
            features_.ear_place.height * p.y + features_.ear_place.back_higher * p.x,
            features_.ear_place.forward - p.x - features_.ear_place.top_back * p.y};
  }
  /// Returns the outline at fraction `turn` of the way around.
  glm::vec2 Outline(float turn) const {
    std::vector<float> weights(outline_.size() + 6);
    around_.Weights(3 + turn * static_cast<float>(outline_.size()), weights);
    glm::vec2 p(0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      p += weights[i] * outline_[(i + outline_.size() - 3) % outline_.size()];
    }
    return p;
  }
  const std::vector<glm::vec2>& corners() const { return outline_; }

 private:
  float Flare(float at_tragus, glm::vec2 p) const {
    const auto& sink = features_.ear_sink;
    return at_tragus + features_.ear_flare.backwards * std::max(p.x, 0.0f) -
           features_.ear_flare.square * p.x * p.x -
           sink.per_mm * std::max(sink.before - p.x, 0.0f) -
           sink.lobe_per_mm * std::max(sink.lobe_below - p.y, 0.0f);
  }
  static float RidgeAt(const auto& row, glm::vec2 p) {
    return Ridge(DistanceToLine(p, PairsOf(row.line)), row.half_width);
  }
  static float BumpAt(const auto& row, glm::vec2 p) { return Bump(p, row.middle, row.half_size); }

  const Features& features_;
  const std::vector<glm::vec2> outline_ = PairsOf(features_.ear_outline);
  const glm::vec2 middle_ = features_.ear_middle;
  SplineBasis around_{{0, 1}};
};

}  // namespace

std::array<std::pair<const char*, glm::vec3>, 4> EarLandmarks(const Features& features) {
  const Ear ear(features);
  const auto at = [&ear](glm::vec2 p) { return ear.PointAbove(p, 0); };
  const auto by_height = [](glm::vec2 p) { return p.y; };
  const auto by_depth = [](glm::vec2 p) { return p.x; };
  return {{{"superaurale", at(std::ranges::max(ear.corners(), {}, by_height))},
           {"subaurale", at(std::ranges::min(ear.corners(), {}, by_height))},
           {"preaurale", at(features.ear_front)},
           {"postaurale", at(std::ranges::max(ear.corners(), {}, by_depth))}}};
}

namespace {

/// One ear as rings of vertices from its middle to the rim, then around its back into the head.
class EarBuilder {
 public:
  EarBuilder(const Identity& identity, Side side, MeshBuilder& mesh)
      : features_(*identity.features),
        blush_(identity.palette.blush * features_.ear_blush.dark),
        colour_(glm::mix(identity.palette.skin, identity.palette.blush, features_.ear_blush.part)),
        ear_(features_),
        side_(side),
        mesh_(mesh) {}

  void Build() {
    const glm::vec2 centre = ear_.middle();
    const Ear::Relief deep = ear_.ReliefAt(centre);
    const std::uint32_t middle = Add(ear_.PointAbove(centre, deep.height), deep.open);
    AddFront();
    AddBack();
    const std::uint32_t inside =
        Add(ear_.PointAbove(centre, features_.ear_inside.aside), features_.ear_inside.light);
    for (std::size_t a = 0; a < kAround; ++a) {
      const std::size_t b = (a + 1) % kAround;
      Face(middle, rings_.front()[b], rings_.front()[a]);
      for (std::size_t r = 0; r + 1 < rings_.size(); ++r) {
        Face(rings_[r][a], rings_[r][b], rings_[r + 1][b]);
        Face(rings_[r][a], rings_[r + 1][b], rings_[r + 1][a]);
      }
      Face(inside, rings_.back()[a], rings_.back()[b]);
    }
  }

 private:
  static constexpr std::size_t kAround = 24;
  using Ring = std::array<std::uint32_t, kAround>;

  /// Returns the point at fraction `share` of the way from the middle to the outline.
  glm::vec2 On(std::size_t k, float share) const {
    return glm::mix(ear_.middle(), ear_.Outline(static_cast<float>(k) / kAround), share);
  }
  void AddFront() {
    for (const float share : {0.16f, 0.34f, 0.50f, 0.64f, 0.76f, 0.86f, 0.94f, 1.0f}) {
      Ring& ring = rings_.emplace_back();
      for (std::size_t k = 0; k < kAround; ++k) {
        const glm::vec2 p = On(k, share);
        const Ear::Relief relief = ear_.ReliefAt(p);
        const float in = share == 1.0f ? features_.ear_edge : 0;
        ring[k] = Add(ear_.PointAbove(p, relief.height - in), relief.open);
      }
    }
  }
  void AddBack() {
    const auto& rim = features_.ear_rim;
    for (std::size_t i = 0; i + 2 < rim.size(); i += 3) {
      Ring& ring = rings_.emplace_back();
      for (std::size_t k = 0; k < kAround; ++k) {
        const glm::vec2 p = On(k, rim[i]);
        ring[k] = Add(ear_.PointAbove(p, ear_.BackAt(p) - rim[i + 1]), rim[i + 2]);
      }
    }
  }
  std::uint32_t Add(glm::vec3 p, float open) {
    p.x *= SignOf(side_);
    return mesh_.Add(p, glm::mix(blush_, colour_, open), features_.ear_light.At(open),
                     Bone::kSkull);
  }
  void Face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.Triangle(Material::kSkin, a, b, c, side_ == Side::kRight);
  }

  const Features& features_;
  glm::vec3 blush_, colour_;
  Ear ear_;
  Side side_;
  MeshBuilder& mesh_;
  std::vector<Ring> rings_;
};

}  // namespace

void BuildEars(const Identity& identity, MeshBuilder& mesh) {
  for (const Side side : kSides) EarBuilder(identity, side, mesh).Build();
}

}  // namespace fsm
