#include <algorithm>
#include <array>
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

class CroppedHair {
 public:
  CroppedHair(const Identity& identity, HeadMesh& mesh)
      : style_(*identity.crop),
        features_(identity.UsedFeatures()),
        palette_(identity.palette),
        look_(identity),
        scalp_(mesh),
        mesh_(mesh) {}

  void Build() {
    std::vector<glm::vec3> edge;
    for (int k = -22; k <= 22; ++k) {
      edge.push_back(scalp_.Over(Direction(3 * static_cast<float>(k), 0.03f), 0));
    }
    look_.ShadeSkin(edge, features_.crop_shade, mesh_);
    Shell();
    for (int k = 0; k < style_.locks; ++k) Lock(k);
  }

  std::vector<SkinHair> Hairline() {
    std::vector<SkinHair> hairs;
    for (int k = 0; k < static_cast<int>(features_.crop_hairline.count); ++k) {
      const float azimuth = features_.crop_hairline.azimuth * NoiseAt(k, 91);
      // Most hairs grow close to the line, few in front of it.
      const float off = NoiseAt(k, 92);
      const float up =
          features_.crop_hairline.up + features_.crop_hairline.spread * off * std::abs(off);
      const glm::vec3 root = Direction(azimuth, up);
      if (scalp_.Over(root, 0).y < features_.crop_hairline.lowest) continue;
      SkinHair hair = look_.OnSkin(scalp_, root, Flow(root, Forehead(azimuth, 0.1f)),
                                   std::min(1.0f, 1 + off), k);
      // Curled hair reaches less far.
      const float reach = 1 - features_.crop_curl_shorter * style_.curl;
      hair.middle = glm::mix(hair.root, hair.middle, reach);
      hair.tip = glm::mix(hair.root, hair.tip, reach);
      hairs.push_back(hair);
    }
    return hairs;
  }

 private:
  // Azimuth -180..180; `up` 0 at the hairline .. 1 at the crown, which lies behind the top.
  glm::vec3 Direction(float azimuth, float up) const {
    const float recede = style_.recede *
                         SmoothStep(features_.crop_recess.begins, std::abs(azimuth)) *
                         SmoothStep(features_.crop_recess.ends, std::abs(azimuth));
    // Whole numbers of waves around the head, so that both ends of the shell meet behind.
    const float round = glm::radians(azimuth);
    const float wander = features_.crop_wander.wide * std::sin(13 * round + 1) +
                         features_.crop_wander.narrow * std::sin(35 * round);
    const float line = look_.HairlineElevation(azimuth) + recede + wander;
    const glm::vec3 low = HairDirection(azimuth, line);
    // Interpolates along the great circle from the hairline to the crown.
    const float angle = std::acos(std::clamp(glm::dot(low, crown_), -1.0f, 1.0f));
    return (std::sin((1 - up) * angle) * low + std::sin(up * angle) * crown_) /
           std::max(std::sin(angle), 1e-3f);
  }

  /// Returns `up` of a direction: the inverse of Direction.
  float Up(glm::vec3 d) const {
    const glm::vec3 low = Direction(std::atan2(d.x, d.z) * 180 / kPi, 0);
    const auto angle = [this](glm::vec3 v) {
      return std::acos(std::clamp(glm::dot(v, crown_), -1.0f, 1.0f));
    };
    return std::clamp(1 - angle(d) / std::max(angle(low), 1e-3f), 0.0f, 1.0f);
  }

  /// Returns how much a place counts as hair over the forehead, 0..1.
  float Forehead(float azimuth, float up) const {
    return SmoothStep(features_.crop_forehead.azimuth, std::abs(azimuth)) *
           SmoothStep(features_.crop_forehead.up, up);
  }

  /// Returns the direction of the hair: away from the crown, forward on top, down at the sides and
  /// behind; over the forehead it is combed back.
  glm::vec3 Flow(glm::vec3 root, float forehead) const {
    glm::vec3 away = root - crown_;
    away -= root * glm::dot(away, root);
    glm::vec3 along = away / std::max(glm::length(away), 1e-3f) * (1 - forehead) +
                      forehead * features_.crop_combed;
    along -= root * glm::dot(along, root);
    return glm::normalize(along + glm::vec3(0, -1e-3f, 0));
  }

  /// Returns the direction of hairs; its length tells how sleek they are, and curls are dull.
  glm::vec3 Along(glm::vec3 root, float forehead) const {
    return Flow(root, forehead) * (1 - features_.crop_curl_dull * style_.curl);
  }
  /// Returns the millimetres across and along strands; curls are small and about round.
  glm::vec2 Curled(glm::vec2 mm) const {
    return mm * glm::mix(glm::vec2(1), features_.crop_curl_smaller, style_.curl);
  }

  float Depth(glm::vec3 d, float up) const {
    const float top = SmoothStep(features_.crop_top, d.y);
    const float body = glm::mix(style_.side_mm, style_.top_mm, top);
    return features_.crop_edge.thick +
           features_.crop_edge.behind * SmoothStep(features_.crop_edge.hollow, d.z) +
           body * SmoothStep(features_.crop_thickens, up);
  }

  void Shell() {
    constexpr int kAround = 48;
    constexpr float kRoundMm = 536;  // twice the width of the strands' picture
    constexpr std::array kUp = {0.0f,  0.022f, 0.06f, 0.11f, 0.17f, 0.23f, 0.30f, 0.37f, 0.44f,
                                0.51f, 0.58f,  0.65f, 0.72f, 0.79f, 0.86f, 0.93f, 1.0f};
    const auto edge_density = ListOf(features_.crop_edge_density);
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (std::size_t r = 0; r < kUp.size(); ++r) {
      for (int k = 0; k <= kAround; ++k) {
        const float azimuth = -180 + 360 * static_cast<float>(k) / kAround;
        // An uneven edge, because hair does not end at a drawn line.
        const float ragged = r == 0 ? features_.crop_ragged * NoiseAt(k % kAround, 61) : 0.0f;
        const glm::vec3 d = Direction(azimuth, kUp[r] + ragged);
        const float uneven =
            1 + features_.crop_below.uneven * NoiseAt(k % kAround, static_cast<int>(r) + 62);
        const glm::vec3 p = scalp_.Over(d, Depth(d, kUp[r]) * (r == 0 ? 1.0f : uneven));
        const glm::vec3 colour =
            glm::mix(palette_.hair, look_.StrandColour(3 * (k % kAround), static_cast<int>(r)),
                     features_.crop_below.streaks * (1 - style_.curl));
        const float thin = r == 0 ? features_.crop_edge_hair.part : 1.0f;
        mesh_.Add(p, glm::mix(palette_.skin * features_.crop_edge_hair.skin, colour, thin),
                  r < 3 ? features_.crop_light.edge : features_.crop_light.others, Bone::kSkull);
        mesh_.strands.back() = {.along = Along(d, Forehead(azimuth, kUp[r])),
                                .density = r < edge_density.size() ? edge_density[r] : 1.0f,
                                .tile_mm = Curled({kRoundMm * azimuth / 360, -140 * kUp[r]})};
      }
    }
    mesh_.Grid(Material::kHair, first, static_cast<int>(kUp.size()), kAround + 1, true);
  }

  void Lock(int k) {
    // The golden ratio spreads locks evenly over the scalp.
    const float turn =
        360 * (0.618034f * static_cast<float>(k) - std::floor(0.618034f * static_cast<float>(k)));
    const float azimuth = turn - 180;
    const float share = (static_cast<float>(k) + 0.5f) / static_cast<float>(style_.locks);
    const float up = features_.crop_lock_from.first + features_.crop_lock_from.more * share * share;
    const glm::vec2 ear = features_.crop_ear.azimuth;
    const bool by_ear = std::abs(azimuth) > ear.x && std::abs(azimuth) < ear.y;
    if (by_ear && up < features_.crop_ear.up) return;
    const glm::vec3 root = Direction(azimuth, up);
    const float forehead = Forehead(azimuth, up);
    glm::vec3 along = Flow(root, forehead) + features_.crop_uneven.direction *
                                                 glm::vec3(NoiseAt(k, 31), 0, NoiseAt(k, 32));
    along = glm::normalize(along - root * glm::dot(along, root));
    const float length =
        style_.lock_mm * (1 + features_.crop_uneven.length * NoiseAt(k, 33)) *
        (features_.crop_lock_length.nape +
         features_.crop_lock_length.top * SmoothStep(features_.crop_lock_length.top_over, root.y)) *
        (features_.crop_lock_length.hairline +
         features_.crop_lock_length.above * SmoothStep(features_.crop_lock_length.above_over, up));
    const float lift = style_.lift_mm * (1 + features_.crop_uneven.lift * NoiseAt(k, 34)) +
                       forehead * style_.front_up * features_.crop_front_lift;
    std::vector<glm::vec3> path;
    constexpr int kSteps = 4;
    const glm::vec3 side = glm::cross(root, along);
    const float waves = features_.crop_lock_waves;
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      const float swing = style_.wave_mm * std::sin(waves * kPi * v + static_cast<float>(k));
      const glm::vec3 d = glm::normalize(root + (along * (length * v) + side * swing * v) / 100.0f);
      const float over = Depth(d, Up(d));  // follows the shell
      path.push_back(
          scalp_.Over(d, 1.02f * over + lift * v * (1 - 0.75f * v) + features_.crop_lock_off));
    }
    const float width = glm::mix(
        features_.crop_lock_width.hairline,
        features_.crop_lock_width.top + features_.crop_lock_width.per_length * style_.lock_mm,
        SmoothStep(features_.crop_lock_width.over, up));
    look_.AddLock(path,
                  {.width_mm = features_.crop_lock_width.factor * width *
                               (1 + features_.crop_uneven.width * NoiseAt(k, 35)),
                   .root_part = features_.crop_lock_taper.root,
                   .tip_part = features_.crop_lock_taper.tip,
                   .fray_from = features_.crop_lock_taper.fray_from,
                   .open = features_.crop_lock_taper.light},
                  k, mesh_);
  }

  const CropStyle& style_;
  const Features& features_;
  const Palette& palette_;
  const HairLook look_;
  const glm::vec3 crown_ = glm::normalize(features_.crop_crown);
  Scalp scalp_;
  HeadMesh& mesh_;
};

}  // namespace

void BuildCroppedHair(const Identity& identity, HeadMesh& mesh) {
  CroppedHair(identity, mesh).Build();
}

std::vector<SkinHair> CroppedHairline(const Identity& identity, HeadMesh& mesh) {
  return CroppedHair(identity, mesh).Hairline();
}

}  // namespace fsm
