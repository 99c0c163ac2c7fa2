#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/random.h"
#include "fsm/base/spline.h"
#include "fsm/head/hair.h"
#include "fsm/head/hair_parts.h"

namespace fsm {
namespace {

constexpr float kEnd = 1.0f;

// Strands start along the parting, sweep over the skull and hang. Those at the face's edge frame
// the forehead in a round arch, a little off the skin.
class LongHair {
 public:
  LongHair(const Identity& identity, HeadMesh& mesh)
      : style_(identity.long_hair),
        features_(identity.Look()),
        palette_(identity.palette),
        volume_(features_.Vector("long_volume") + style_.full_mm),
        look_(identity),
        scalp_(mesh),
        mesh_(mesh) {}

  void Build() {
    Shade();
    for (const float side : {-1.0f, 1.0f}) {
      Shell(side);
      Lining(side);
      Locks(side);
      Wisps(side);
      Flyaways(side);
    }
  }

  std::vector<SkinHair> Hairline() {
    const auto& n = features_["long_hairline"];
    std::vector<SkinHair> hairs;
    for (int k = 0; k < static_cast<int>(n[0]); ++k) {
      const float side = k % 2 == 0 ? -1.0f : 1.0f;
      const float t = n[1] * (0.5f + 0.5f * NoiseAt(k, 91));
      const glm::vec3 edge = Direction(0, side, t);
      const glm::vec3 along = glm::normalize(Direction(0, side, t + 0.02f) - edge);
      const float off = NoiseAt(k, 92);
      const glm::vec3 before = glm::cross(along, edge) * side;  // away from the hair
      const glm::vec3 root = glm::normalize(edge + before * (n[2] + n[3] * off * std::abs(off)));
      if (scalp_.Over(root, 0).y < n[4]) continue;
      hairs.push_back(
          look_.OnSkin(scalp_, root, along + n[5] * before, std::min(1.0f, 1 - off), k));
    }
    return hairs;
  }

 private:
  // `i` runs from the face's edge (0) to the middle of the back (1), `t` from the parting (0) over
  // the end of the skull (kCap) to the ends (1).
  static constexpr float kCap = 0.58f;

  /// Between the two numbers of that name.
  float Mix(const char* name, float part) const {
    return glm::mix(features_[name][0], features_[name][1], part);
  }
  int Count(const char* name, std::size_t which) const {
    return static_cast<int>(features_[name][which]);
  }
  glm::vec3 OnParting(float degrees) const {
    const float along = degrees * kPi / 180;
    return glm::normalize(glm::vec3(style_.parting, std::sin(along), std::cos(along)));
  }

  glm::vec3 Direction(float i, float side, float t) const {
    const auto& crowd = features_["long_crowd"];
    const glm::vec3 start = OnParting(Mix("long_parting", std::pow(i, crowd[0])));
    const float azimuth = Mix("long_round", std::pow(i, crowd[1]));
    const auto& nearer = features_["long_edge_nearer"];
    const auto& bends = features_["long_bend"];
    const float edge = SmoothStep(0.25f, 0, i);
    // The side away from the parting has the longer way round the forehead.
    const float away = side < 0 ? 1.0f : 0.0f;
    const glm::vec3 bend =
        HairDirection(side * azimuth * glm::mix(1.0f, nearer[0] - nearer[1] * away, edge),
                      glm::mix(bends[0], bends[1] - bends[2] * away, edge));
    const glm::vec3 end = HairDirection(side * azimuth, Mix("long_skull_end", edge));
    return glm::normalize((1 - t) * (1 - t) * start + 2 * t * (1 - t) * bend + t * t * end);
  }

  float EndY(float i, float side) const {
    return glm::mix(style_.front_y, style_.back_y, std::sqrt(SmoothStep(0, 0.8f, i))) +
           features_("long_ends") * std::sin(17 * i + side);
  }

  glm::vec3 Point(float i, float side, float t, float out_mm) const {
    const float cap = std::min(1.0f, t / kCap);
    const glm::vec3 d = Direction(i, side, cap);
    const glm::vec3 scaled = d / volume_;
    const float volume = 1 / std::sqrt(glm::dot(scaled, scaled));
    const float skin = scalp_.Distance(d);
    const float part = SmoothStep(0, 0.17f, i) * (0.8f + 0.2f * SmoothStep(0, 0.3f, cap));
    const auto& off = features_["long_fringe_off"];
    const float fringe = off[0] + off[1] * std::sin(kPi * SmoothStep(0, 1, cap));
    const float least =
        skin + glm::mix(fringe, features_("long_least_off"), SmoothStep(0, 0.12f, i));
    float radius =
        std::max(least, glm::mix(skin + off[0] + off[2] * SmoothStep(0.3f, 1, cap), volume, part));
    // The parting is a furrow in the hair.
    radius = glm::mix(skin + features_("long_furrow") * (radius - skin), radius,
                      SmoothStep(-0.1f, 0.28f, cap));
    glm::vec3 p = kHairCentre + d * (radius + out_mm);
    p.x += side * OverEar(i, p.y);
    if (t > kCap) {
      const float hang = (t - kCap) / (kEnd - kCap);
      const glm::vec3 out = glm::normalize(glm::vec3(d.x, 0, d.z));
      const float front = SmoothStep(0.35f, 0, i);
      p.y = glm::mix(p.y, EndY(i, side), hang);
      const float full = Mix("long_full", front) * std::sin(std::min(1.0f, 1.2f * hang) * kPi);
      p += out * (full - Mix("long_inward", SmoothStep(0, 0.6f, i)) * hang * hang * hang) +
           Wave(i, side, hang, out);
      p.z += front * features_("long_forward") * hang * (1 - 0.4f * hang);
      // At the face it follows the cheek.
      p.x -= side * front * features_("long_cheek") *
             std::sin(std::min(1.0f, 1.5f * hang) * kPi * 0.5f);
    }
    return p;
  }

  // What hangs swings round the head and, less, off it; neighbours swing nearly alike.
  glm::vec3 Wave(float i, float side, float hang, glm::vec3 out) const {
    const auto& waves = features_["long_waves"];
    const float phase = 2 * kPi * waves[0] * hang + waves[1] * i + waves[2] * side;
    const float swing = style_.wave_mm * SmoothStep(-0.1f, 0.5f, hang);
    return swing * (std::sin(phase) * glm::vec3(out.z, 0, -out.x) * side +
                    waves[3] * std::cos(phase) * out);
  }

  // By how much the ear lifts what hangs over it.
  float OverEar(float i, float y) const {
    const auto& ear = features_["long_over_ear"];
    const float round = (i - ear[1]) / ear[2];
    const float up = (y - ear[3]) / ear[4];
    return ear[0] * std::exp(-round * round - up * up);
  }

  glm::vec3 Along(float i, float side, float t) const {
    const glm::vec3 along = glm::normalize(Point(i, side, t + 0.02f, 0) -
                                           Point(i, side, t - 0.02f, 0) + glm::vec3(0, -1e-3f, 0));
    // At the parting hairs of both sides rise alike, or light would break off there.
    const float off = SmoothStep(0, features_("long_parting_soft"), t);
    return glm::normalize(glm::mix(features_.Vector("long_parting_along"), along, off));
  }

  float Ridge(float i, float t) const {
    const auto& deep = features_["long_ridges"];
    const float phase = deep[2] * i + 2.0f * std::sin(3 * t + 9 * i);
    return (deep[0] * std::sin(phase) + deep[1] * std::sin(deep[3] * phase + 1)) *
           SmoothStep(0.02f, 0.3f, t) * (0.6f + 0.7f * t) * SmoothStep(0, 0.08f, i);
  }

  /// By how much a column ends higher than its neighbours.
  float Pointed(int column, float t) const {
    return column % 2 == 0 ? 0.0f : features_("long_points") * SmoothStep(0.8f, kEnd, t);
  }

  void Shade() {
    std::vector<glm::vec3> edge;
    for (const float side : {-1.0f, 1.0f}) {
      for (int k = 0; k <= 48; ++k)
        edge.push_back(Point(0, side, 0.02f * static_cast<float>(k), 0));
    }
    look_.ShadeSkin(edge, features_("long_shade"), mesh_);
    for (std::size_t i = 0; i < mesh_.position.size(); ++i) {
      const glm::vec3 p = mesh_.position[i];
      if (mesh_.bone[i] != Bone::kSkin) continue;
      const float behind = SmoothStep(25, -20, p.z) * SmoothStep(-40, -70, p.y) *
                           SmoothStep(style_.back_y - 30, style_.back_y + 10, p.y);
      mesh_.openness[i] *= 1 - features_("long_neck_shade") * behind;
    }
  }

  void Shell(float side) {
    constexpr int kStrands = 27;
    constexpr int kCapRows = 15;  // the skull is round, what hangs nearly straight
    constexpr int kRows = 24;
    const auto& thin = features_["long_thin"];
    const auto& light = features_["long_light"];
    const auto& tile = features_["long_tile"];
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Closer together at the face, where the edge is seen.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(u * u, u, 0.45f);
      for (int row = 0; row <= kRows; ++row) {
        // The first two rows are the parting, where the scalp is seen.
        const float t =
            row == 1 ? features_("long_parting_line")
            : row <= kCapRows
                ? kCap * static_cast<float>(std::max(row - 1, 0)) / (kCapRows - 1)
                : glm::mix(kCap, kEnd, static_cast<float>(row - kCapRows) / (kRows - kCapRows));
        glm::vec3 p = Point(i, side, t, Ridge(i, t));
        p.y += Pointed(k, t);
        const float open = std::min(1.0f, glm::mix(light[0], 1.0f, SmoothStep(0, 0.12f, t)) *
                                              glm::mix(light[1], 1.0f, SmoothStep(0, 0.1f, i)) *
                                              (1 + light[3] * Ridge(i, t)));
        const glm::vec3 colour = look_.StrandColour(k * 3, row) * Mix("long_fade", t);
        mesh_.Add(
            p, row > 0 ? colour : glm::mix(colour, palette_.skin, features_("long_parting_scalp")),
            open, Bone::kSkull);
        const float edge = k == 0 ? 0.1f : k == 1 ? 0.8f : 1.0f;
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = edge * SmoothStep(thin[0], thin[1], t),
                                .tile_mm = {side * tile[0] * i, tile[1] * t}};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side > 0);
  }

  // The dark inside of the hair, seen beside the neck and beyond the far temple.
  void Lining(float side) {
    constexpr int kStrands = 11;
    constexpr int kRows = 6;
    const auto& insets = features_["long_lining"];
    const auto& thin = features_["long_thin"];
    const auto& tile = features_["long_tile"];
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Beside the face it reaches up to the forehead: there one looks under the hair.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(0.005f, 1.0f, glm::mix(u * u, u, 0.4f));
      const float behind = SmoothStep(0.06f, 0.3f, i);
      for (int row = 0; row <= kRows; ++row) {
        const float t =
            glm::mix(kCap * glm::mix(0.1f, 0.6f, behind), kEnd, static_cast<float>(row) / kRows);
        const float inset = glm::mix(insets.back(), insets[static_cast<std::size_t>(row)], behind);
        const glm::vec3 p = Point(i, side, t, inset) + glm::vec3(0, Pointed(k, t), 0);
        mesh_.Add(p, palette_.hair, features_["long_light"][2], Bone::kSkull);
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = SmoothStep(thin[0], thin[1], t),
                                .tile_mm = {tile[0] * i, tile[1] * t}};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side < 0);
  }

  void Locks(float side) {
    const int locks = Count("long_locks", 0), at_edge = Count("long_locks", 1);
    const auto& wide = features_["long_lock_width"];
    const auto& lifts = features_["long_lock_lift"];
    const auto& starts = features_["long_lock_from"];
    const auto& ends = features_["long_lock_to"];
    const auto& drifts = features_["long_lock_drift"];
    const auto& taper = features_["long_lock_taper"];
    for (int k = 0; k < locks; ++k) {
      const int seed = k + (side > 0 ? 500 : 0);
      const float u = (static_cast<float>(k - at_edge) + 0.5f + 0.4f * NoiseAt(seed, 1)) /
                      static_cast<float>(locks - at_edge);
      const bool edge = k < at_edge;
      const float i = edge ? 0.005f * static_cast<float>(k) : u;
      const float from = edge ? starts[0] + starts[1] * static_cast<float>(k)
                              : starts[2] + starts[3] * (NoiseAt(seed, 2) + 1);
      const float to = edge ? ends[0] + ends[1] * static_cast<float>(k % 5)
                            : ends[2] + ends[3] * NoiseAt(seed, 3);
      const float lift = edge ? lifts[0] : lifts[1] + lifts[2] * NoiseAt(seed, 4);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 8;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float t = glm::mix(from, to, v);
        const float drift = edge ? drifts[0] * v * v * (1 + 0.4f * NoiseAt(seed, 5))
                                 : drifts[1] * std::sin(4 * v + static_cast<float>(k));
        path.push_back(Point(std::clamp(i + drift, 0.0f, 1.0f), side, t,
                             lift * std::sin(kPi * (0.12f + 0.8f * v))));
      }
      look_.AddLock(path,
                    {.width_mm = edge ? wide[0] : wide[1] + wide[2] * NoiseAt(seed, 6),
                     .root_part = edge ? taper[0] : taper[1],
                     .tip_part = taper[2],
                     .fray_from = taper[3],
                     .open = edge ? taper[4] : 1},
                    seed, mesh_);
    }
  }

  // Thin locks that leave the edge of the hair towards the face and end there, so that the edge is
  // no drawn line.
  void Wisps(float side) {
    const int wisps = Count("long_wisps", 0);
    const auto& reaches = features_["long_wisp_reach"];
    const auto& wide = features_["long_wisp_width"];
    const auto& along = features_["long_wisp_from"];
    const auto& lengths = features_["long_wisp_length"];
    const auto& taper = features_["long_wisp_taper"];
    for (int k = 0; k < wisps; ++k) {
      const int seed = k + (side > 0 ? 900 : 700);
      const float from = along[0] + along[1] * (static_cast<float>(k) + 0.4f * NoiseAt(seed, 1)) /
                                        static_cast<float>(wisps);
      const float long_part = lengths[0] * (1 + lengths[1] * NoiseAt(seed, 3));
      const float reach = (reaches[0] + reaches[1] * NoiseAt(seed, 2)) *
                          (1 + reaches[2] * SmoothStep(0.45f, 0.25f, from));
      std::vector<glm::vec3> path;
      constexpr int kSteps = 3;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float t = from + long_part * v;
        const float i = 0.05f * (1 - v);
        const glm::vec3 p = Point(i, side, t, 1.2f - 1.2f * v);
        const glm::vec3 down = glm::normalize(Point(i, side, t + 0.02f, 0) - p);
        const glm::vec3 outward = glm::normalize(p - kHairCentre);
        const glm::vec3 face = glm::cross(down, outward) * side;  // away from the hair
        path.push_back(p + face * (reach * v * v) - outward * (1.0f * v * v));
      }
      look_.AddLock(path,
                    {.width_mm = wide[0] + wide[1] * NoiseAt(seed, 4),
                     .root_part = taper[0],
                     .fray_from = taper[1],
                     .open = taper[2]},
                    seed, mesh_);
    }
  }

  // Single hairs that stand off the others.
  void Flyaways(float side) {
    const auto& fly = features_["long_flyaways"];
    for (int k = 0; k < static_cast<int>(fly[0]); ++k) {
      const int seed = k + (side > 0 ? 1700 : 1500);
      const float i = 0.5f + 0.5f * NoiseAt(seed, 1);
      const float from = fly[1] * (0.5f + 0.5f * NoiseAt(seed, 2));
      const float length = fly[2] * (1 + 0.5f * NoiseAt(seed, 3));
      const float drift = fly[3] * NoiseAt(seed, 4);
      const float off = fly[4] * (1 + 0.6f * NoiseAt(seed, 5));
      std::vector<glm::vec3> path;
      constexpr int kSteps = 3;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        path.push_back(Point(std::clamp(i + drift * v * v, 0.0f, 1.0f), side, from + length * v,
                             off * std::sin(kPi * (0.1f + 0.75f * v))));
      }
      look_.AddLock(path, {.width_mm = fly[5], .tip_part = 0.3f, .fray_from = 0.9f}, seed, mesh_);
    }
  }

  const LongStyle& style_;
  const Features& features_;
  const Palette& palette_;
  const glm::vec3 volume_;
  const HairLook look_;
  Scalp scalp_;
  HeadMesh& mesh_;
};

}  // namespace

void BuildLongHair(const Identity& identity, HeadMesh& mesh) { LongHair(identity, mesh).Build(); }

std::vector<SkinHair> LongHairline(const Identity& identity, HeadMesh& mesh) {
  return LongHair(identity, mesh).Hairline();
}

}  // namespace fsm
