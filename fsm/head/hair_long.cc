#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/random.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/hair.h"
#include "fsm/head/hair_parts.h"

namespace fsm {
namespace {

constexpr float kEnd = 1.0f;

// Strands start along the parting, sweep over the skull and hang down. Those at the face's edge
// frame the forehead in a round arch, slightly off the skin.
class LongHair {
 public:
  LongHair(const Identity& identity, HeadMesh& mesh)
      : style_(identity.long_hair),
        features_(identity.UsedFeatures()),
        palette_(identity.palette),
        volume_(features_.long_volume + style_.full_mm),
        look_(identity),
        scalp_(mesh),
        mesh_(mesh) {}

  void Build() {
    Shade();
    for (const float side : {-1.0f, 1.0f}) {
      Shell(side);
      Lining(side);
      Locks(side);
      Flyaways(side);
    }
  }

  std::vector<SkinHair> Hairline() {
    std::vector<SkinHair> hairs;
    for (int k = 0; k < static_cast<int>(features_.long_hairline.count); ++k) {
      const float side = k % 2 == 0 ? -1.0f : 1.0f;
      const float t = features_.long_hairline.to * (0.5f + 0.5f * NoiseAt(k, 91));
      const glm::vec3 edge = Direction(0, side, t);
      const glm::vec3 along = glm::normalize(Direction(0, side, t + 0.02f) - edge);
      const float off = NoiseAt(k, 92);
      const glm::vec3 before = glm::cross(along, edge) * side;  // away from the hair
      const float away =
          features_.long_hairline.before + features_.long_hairline.spread * off * std::abs(off);
      const glm::vec3 root = glm::normalize(edge + before * away);
      if (scalp_.Over(root, 0).y < features_.long_hairline.lowest) continue;
      hairs.push_back(look_.OnSkin(scalp_, root, along + features_.long_hairline.turn * before,
                                   std::min(1.0f, 1 - off), k));
    }
    return hairs;
  }

 private:
  // `i` runs from the face's edge (0) to the middle of the back (1); `t` from the parting (0) over
  // the end of the skull (kCap) to the ends (1).
  static constexpr float kCap = 0.58f;

  glm::vec3 OnParting(float degrees) const {
    const float along = degrees * kPi / 180;
    const float wander = std::sin(0.31f * degrees) + 0.7f * std::sin(0.83f * degrees + 1);
    return glm::normalize(glm::vec3(style_.parting + features_.long_parting_wander * wander,
                                    std::sin(along), std::cos(along)));
  }

  glm::vec3 Direction(float i, float side, float t) const {
    const glm::vec3 start =
        OnParting(Lerp(features_.long_parting, std::pow(i, features_.long_crowd.parting)));
    const float azimuth = Lerp(features_.long_round, std::pow(i, features_.long_crowd.round));
    const float edge = SmoothStep(features_.long_edge_nearer.over, i);
    // On the side away from the parting the way around the forehead is longer.
    const float away = side < 0 ? 1.0f : 0.0f;
    const float nearer =
        features_.long_edge_nearer.part - features_.long_edge_nearer.less_away * away;
    const float edge_bend = features_.long_bend.edge - features_.long_bend.less_away * away;
    const glm::vec3 bend = HairDirection(side * azimuth * glm::mix(1.0f, nearer, edge),
                                         glm::mix(features_.long_bend.behind, edge_bend, edge));
    const glm::vec3 end = HairDirection(side * azimuth, Lerp(features_.long_skull_end, edge));
    return glm::normalize((1 - t) * (1 - t) * start + 2 * t * (1 - t) * bend + t * t * end);
  }

  float EndY(float i, float side) const {
    return glm::mix(style_.front_y, style_.back_y,
                    std::sqrt(SmoothStep(features_.long_ends.over, i))) +
           features_.long_ends.uneven * (std::sin(17 * i + side) + features_.long_shape.finer_ends *
                                                                       std::sin(43 * i + 2 * side));
  }

  glm::vec3 Point(float i, float side, float t, float out_mm) const {
    const float cap = std::min(1.0f, t / kCap);
    const glm::vec3 d = Direction(i, side, cap);
    const glm::vec3 scaled = d / volume_;
    const float volume = 1 / std::sqrt(glm::dot(scaled, scaled));
    const float skin = scalp_.Distance(d);
    const float part =
        SmoothStep(features_.long_shape.volume_over_edge, i) *
        Linear(features_.long_shape.volume_on_cap, SmoothStep(features_.long_shape.cap_over, cap));
    const float off = features_.long_fringe_off.ends;
    const float fringe =
        off + features_.long_fringe_off.middle * std::sin(kPi * SmoothStep(0, 1, cap));
    const float least = skin + glm::mix(fringe, features_.long_least_off.mm,
                                        SmoothStep(features_.long_least_off.over, i));
    float radius =
        std::max(least, glm::mix(skin + off +
                                     features_.long_fringe_off.temples *
                                         SmoothStep(features_.long_shape.temples_over, cap),
                                 volume, part));
    // The parting is a furrow in the hair.
    radius = glm::mix(skin + features_.long_furrow.part * (radius - skin), radius,
                      SmoothStep(features_.long_furrow.over, cap));
    glm::vec3 p = kHairCentre + d * (radius + out_mm);
    p.x += side * OverEar(i, p.y);
    if (t > kCap) {
      const float hang = (t - kCap) / (kEnd - kCap);
      const glm::vec3 out = glm::normalize(glm::vec3(d.x, 0, d.z));
      const float front = SmoothStep(features_.long_shape.front_over, i);
      p.y = glm::mix(p.y, EndY(i, side), hang);
      // It continues around the skull for a little, so that it has no kink where that ends.
      const glm::vec3 on = (d - Direction(i, side, 1 - features_.long_shape.no_kink_step)) *
                           radius * (1 - kCap) / (kCap * features_.long_shape.no_kink_step);
      p += glm::vec3(on.x, 0, on.z) * hang * std::exp(-hang / features_.long_goes_on);
      const float full = Lerp(features_.long_full, front) *
                         std::sin(std::min(1.0f, features_.long_shape.fullest_at * hang) * kPi);
      p += out * (full -
                  Lerp(features_.long_inward, SmoothStep(features_.long_shape.inward_over, i)) *
                      hang * hang * hang) +
           Wave(i, side, hang, out);
      p.z += front * features_.long_forward * hang * (1 - features_.long_shape.forward_ends * hang);
      // Beside the face it follows the cheek.
      p.x -= side * front * features_.long_cheek *
             std::sin(std::min(1.0f, features_.long_shape.cheek_at * hang) * kPi * 0.5f);
    }
    return p;
  }

  // Returns the wave of hanging hair: around the head and, less, off it; neighbours move alike.
  glm::vec3 Wave(float i, float side, float hang, glm::vec3 out) const {
    const float phase = 2 * kPi * features_.long_waves.count * hang +
                        features_.long_waves.round * i + features_.long_waves.sides * side;
    const float swing = style_.wave_mm * SmoothStep(features_.long_waves.over, hang);
    return swing * (std::sin(phase) * glm::vec3(out.z, 0, -out.x) * side +
                    features_.long_waves.off * std::cos(phase) * out);
  }

  // Returns how far the ear lifts the hair that hangs over it.
  float OverEar(float i, float y) const {
    const float round = (i - features_.long_over_ear.round) / features_.long_over_ear.half_width;
    const float up = (y - features_.long_over_ear.y) / features_.long_over_ear.half_height;
    return features_.long_over_ear.lift * std::exp(-round * round - up * up);
  }

  glm::vec3 Along(float i, float side, float t) const {
    const glm::vec3 along = glm::normalize(Point(i, side, t + 0.02f, 0) -
                                           Point(i, side, t - 0.02f, 0) + glm::vec3(0, -1e-3f, 0));
    // At the parting the hairs of both sides rise alike, or the shading would have an edge there.
    const float off = SmoothStep(0, features_.long_parting_soft, t);
    return glm::normalize(glm::mix(features_.long_parting_along, along, off));
  }

  float Ridge(float i, float t) const {
    const float phase = features_.long_ridges.close * i + 2.0f * std::sin(3 * t + 9 * i);
    return (features_.long_ridges.broad * std::sin(phase) +
            features_.long_ridges.narrow * std::sin(features_.long_ridges.closer * phase + 1)) *
           SmoothStep(features_.long_ridges.over, t) * Linear(features_.long_ridges.deep, t) *
           SmoothStep(features_.long_ridges.round, i);
  }

  /// Returns how much higher a column ends than the longest ones; neighbours differ.
  float Pointed(int column, float t) const {
    const float part = 0.5f + 0.5f * NoiseAt(column, 17);
    return features_.long_points * (column % 2 == 0 ? 0.4f * part : 0.6f + 0.4f * part) *
           SmoothStep(features_.long_shape.pointed_over, t);
  }

  void Shade() {
    std::vector<glm::vec3> edge;
    for (const float side : {-1.0f, 1.0f}) {
      for (int k = 0; k <= 48; ++k)
        edge.push_back(Point(0, side, 0.02f * static_cast<float>(k), 0));
    }
    look_.ShadeSkin(edge, features_.long_shade, mesh_);
    for (std::size_t i = 0; i < mesh_.position.size(); ++i) {
      const glm::vec3 p = mesh_.position[i];
      if (mesh_.bone[i] != Bone::kSkin) continue;
      const float behind = SmoothStep(features_.long_shape.neck_shade_z, p.z) *
                           SmoothStep(features_.long_shape.neck_shade_y, p.y) *
                           SmoothStep(style_.back_y + features_.long_shape.neck_shade_end, p.y);
      mesh_.openness[i] *= 1 - features_.long_neck_shade * behind;
    }
  }

  void Shell(float side) {
    constexpr int kStrands = 22;
    constexpr int kCapRows = 19;  // the skull is round; hanging hair is nearly straight
    constexpr int kRows = 27;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Strands are denser at the face, where the edge is visible.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(u * u, u, features_.long_shape.shell_crowd);
      for (int row = 0; row <= kRows; ++row) {
        // The first two rows are the parting, where the scalp is visible.
        const float t =
            row == 1 ? features_.long_parting_line
            : row <= kCapRows
                ? kCap * static_cast<float>(std::max(row - 1, 0)) / (kCapRows - 1)
                : glm::mix(kCap, kEnd, static_cast<float>(row - kCapRows) / (kRows - kCapRows));
        glm::vec3 p = Point(i, side, t, Ridge(i, t));
        p.y += Pointed(k, t);
        const float open =
            std::min(1.0f, glm::mix(features_.long_light.parting, 1.0f,
                                    SmoothStep(features_.long_light.parting_over, t)) *
                               glm::mix(features_.long_light.edge, 1.0f,
                                        SmoothStep(features_.long_light.edge_over, i)) *
                               (1 + features_.long_light.ridges * Ridge(i, t)));
        const glm::vec3 colour = look_.StrandColour(k * 3, row) * Lerp(features_.long_fade, t);
        mesh_.Add(p,
                  row > 0 ? colour : glm::mix(colour, palette_.skin, features_.long_parting_scalp),
                  open, Bone::kSkull);
        const float edge =
            glm::mix(features_.long_thin.edge, 1.0f, SmoothStep(features_.long_thin.edge_over, i));
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = edge * SmoothStep(features_.long_thin.ends, t),
                                .tile_mm = features_.long_tile * glm::vec2(side * i, t)};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side > 0);
  }

  // Adds the dark inside of the hair, visible beside the neck and beyond the far temple.
  void Lining(float side) {
    constexpr int kStrands = 11;
    constexpr int kRows = 6;
    const auto& insets = features_.long_lining.inset;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Beside the face it reaches up to the forehead, where one looks under the hair.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(features_.long_shape.lining_edge, 1.0f,
                               glm::mix(u * u, u, features_.long_shape.lining_crowd));
      const float behind = SmoothStep(features_.long_shape.lining_behind, i);
      for (int row = 0; row <= kRows; ++row) {
        const float t = glm::mix(kCap * features_.long_shape.lining_top * behind, kEnd,
                                 static_cast<float>(row) / kRows);
        const float inset =
            glm::mix(features_.long_lining.face, insets[static_cast<std::size_t>(row)], behind);
        const glm::vec3 p = Point(i, side, t, inset) + glm::vec3(0, Pointed(k, t), 0);
        mesh_.Add(p, palette_.hair, features_.long_light.lining, Bone::kSkull);
        // It thins out less at its outline than the shell, which surrounds it.
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = SmoothStep(features_.long_thin.ends, t) *
                                           SmoothStep(features_.long_thin.edge_over, i),
                                .across = features_.long_shape.lining_whole,
                                .tile_mm = features_.long_tile * glm::vec2(i, t)};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side < 0);
  }

  void Locks(float side) {
    const int locks = static_cast<int>(features_.long_locks.count);
    for (int k = 0; k < locks; ++k) {
      const int seed = k + (side > 0 ? 500 : 0);
      const float i =
          (static_cast<float>(k) + 0.5f + 0.4f * NoiseAt(seed, 1)) / static_cast<float>(locks);
      const float from = Linear(features_.long_locks.from, NoiseAt(seed, 2) + 1);
      const float to = Linear(features_.long_locks.to, NoiseAt(seed, 3));
      const float lift = Linear(features_.long_locks.lift, NoiseAt(seed, 4));
      std::vector<glm::vec3> path;
      constexpr int kSteps = 10;
      for (int s = 0; s <= kSteps; ++s) {
        // Steps are shorter over the skull, which is round.
        const float v = std::pow(static_cast<float>(s) / kSteps, features_.long_shape.lock_crowd);
        const float drift = features_.long_locks.drift * std::sin(4 * v + static_cast<float>(k));
        path.push_back(Point(std::clamp(i + drift, 0.0f, 1.0f), side, glm::mix(from, to, v),
                             lift * std::sin(kPi * Linear(features_.long_shape.lock_arch, v))));
      }
      look_.AddLock(path,
                    {.width_mm = Linear(features_.long_locks.width, NoiseAt(seed, 6)),
                     .root_part = features_.long_locks.root,
                     .tip_part = features_.long_locks.tip,
                     .fray_from = features_.long_locks.fray_from},
                    seed, mesh_);
    }
  }

  // Adds single hairs that stand off the others.
  void Flyaways(float side) {
    for (int k = 0; k < static_cast<int>(features_.long_flyaways.count); ++k) {
      const int seed = k + (side > 0 ? 1700 : 1500);
      const float i = Linear(features_.long_shape.flyaway_round, NoiseAt(seed, 1));
      const float from = features_.long_flyaways.from * (0.5f + 0.5f * NoiseAt(seed, 2));
      const float length = features_.long_flyaways.length * (1 + 0.5f * NoiseAt(seed, 3));
      const float drift = features_.long_flyaways.drift * NoiseAt(seed, 4);
      // Most lie close to the others, above all on the skull; few stand far off.
      const float far = 0.5f + 0.5f * NoiseAt(seed, 5);
      const float off = features_.long_flyaways.off * (0.3f + 1.4f * far * far) *
                        SmoothStep(features_.long_shape.flyaway_off_over, from);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 6;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        path.push_back(Point(std::clamp(i + drift * v * v, 0.0f, 1.0f), side, from + length * v,
                             off * std::sin(kPi * Linear(features_.long_shape.flyaway_arch, v))));
      }
      look_.AddLock(path,
                    {.width_mm = features_.long_flyaways.width,
                     .tip_part = features_.long_flyaways.tip,
                     .fray_from = features_.long_flyaways.fray_from,
                     .single = true},
                    seed, mesh_);
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
