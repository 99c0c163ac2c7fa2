#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <variant>
#include <vector>

#include "fsm/base/pi.h"
#include "fsm/base/spline.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_styles.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

/// The shape of short hair. A place in it: azimuth -180..180; `up` 0 at the hairline .. 1 at the
/// crown, which lies behind the top.
class CropShape {
 public:
  /// `skin`: only read here; the identity outlives this. REQUIRES: its hair is a CropStyle.
  CropShape(const Identity& identity, const MeshBuilder& skin)
      : style_(std::get<CropStyle>(identity.hair)),
        hair_(identity.features->crop_hair),
        look_(identity),
        scalp_(skin) {}

  const Scalp& scalp() const { return scalp_; }

  /// Returns the direction of a place from kHairCentre.
  glm::vec3 Direction(float azimuth, float up) const {
    const float recede = style_.recede * hair_.recess.begins.Ramp(std::abs(azimuth)) *
                         hair_.recess.ends.Ramp(std::abs(azimuth));
    // Whole numbers of waves around the head, so that both ends of the shell meet behind.
    const float round = glm::radians(azimuth);
    const float wander =
        hair_.wander.wide * std::sin(13 * round + 1) + hair_.wander.narrow * std::sin(35 * round);
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
    return hair_.forehead.azimuth.Ramp(std::abs(azimuth)) * hair_.forehead.over_up.Ramp(up);
  }

  /// Returns the direction of the hair: away from the crown, forward on top, down at the sides and
  /// behind; over the forehead it is combed back.
  glm::vec3 Flow(glm::vec3 root, float forehead) const {
    glm::vec3 away = root - crown_;
    away -= root * glm::dot(away, root);
    glm::vec3 along = away / std::max(glm::length(away), 1e-3f) * (1 - forehead) +
                      forehead * hair_.forehead.combed;
    along -= root * glm::dot(along, root);
    return glm::normalize(along + glm::vec3(0, -1e-3f, 0));
  }

  /// Returns the direction of hairs; its length tells how sleek they are, and curls are dull.
  glm::vec3 Along(glm::vec3 root, float forehead) const {
    return Flow(root, forehead) * (1 - hair_.curl.dull * style_.curl);
  }
  /// Returns the millimetres across and along strands; curls are small and about round.
  glm::vec2 Curled(glm::vec2 mm) const {
    return mm * glm::mix(glm::vec2(1), hair_.curl.smaller, style_.curl);
  }

  float Depth(glm::vec3 d, float up) const {
    const auto& thickness = hair_.thickness;
    const float top = thickness.top_over_y.Ramp(d.y);
    const float body = glm::mix(style_.side_mm, style_.top_mm, top);
    // The edge goes under the skin behind, or its hairs would be dots beside the neck's outline.
    return thickness.edge +
           thickness.behind.At(thickness.behind_over_up.Ramp(up)) *
               thickness.behind_over_z.Ramp(d.z) +
           body * thickness.over_up.Ramp(up);
  }

  std::vector<SkinStroke> Hairline() const {
    const auto& hairline = hair_.hairline;
    std::vector<SkinStroke> hairs;
    for (int k = 0; k < static_cast<int>(hairline.count); ++k) {
      const float azimuth = hairline.azimuth * NoiseAt(k, PaintStream::kHairlinePlace);
      // Most hairs grow close to the line, few in front of it.
      const float deviation = NoiseAt(k, PaintStream::kHairlineOff);
      const float up = hairline.up + hairline.spread * deviation * std::abs(deviation);
      const glm::vec3 root = Direction(azimuth, up);
      if (scalp_.Over(root, 0).y < hairline.lowest) continue;
      SkinStroke hair = look_.SkinHair(scalp_, root, Flow(root, Forehead(azimuth, 0.1f)),
                                       std::min(1.0f, 1 + deviation), k);
      // Curled hair reaches less far.
      const float reach = 1 - hair_.curl.shorter * style_.curl;
      hair.middle = glm::mix(hair.root, hair.middle, reach);
      hair.tip = glm::mix(hair.root, hair.tip, reach);
      hairs.push_back(hair);
    }
    return hairs;
  }

 private:
  const CropStyle& style_;
  const Features::CropHair& hair_;
  const HairLook look_;
  const glm::vec3 crown_ = glm::normalize(hair_.crown);
  const Scalp scalp_;
};

/// Adds the hair of that shape to a mesh.
class CropBuilder {
 public:
  CropBuilder(const Identity& identity, MeshBuilder& mesh)
      : style_(std::get<CropStyle>(identity.hair)),
        hair_(identity.features->crop_hair),
        palette_(identity.palette),
        look_(identity),
        shape_(identity, mesh),
        mesh_(mesh) {}

  void Build(float up_to) {
    std::vector<glm::vec3> edge;
    for (int k = -22; k <= 22; ++k) {
      edge.push_back(shape_.scalp().Over(shape_.Direction(3 * static_cast<float>(k), 0.03f), 0));
    }
    look_.ShadeSkin(edge, hair_.edge.shade, mesh_);
    Shell(up_to);
    for (int k = 0; k < style_.locks; ++k) Lock(k);
  }

 private:
  void Shell(float up_to) {
    constexpr int kAround = 48;
    constexpr float kRoundMm = 536;  // twice the width of the strands' picture
    constexpr std::array kUp = {0.0f,  0.022f, 0.06f, 0.11f, 0.17f, 0.23f, 0.30f, 0.37f, 0.44f,
                                0.51f, 0.58f,  0.65f, 0.72f, 0.79f, 0.86f, 0.93f, 1.0f};
    const auto edge_density = ListOf(hair_.edge.density);
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    const auto rows = static_cast<std::size_t>(std::ranges::upper_bound(kUp, up_to) - kUp.begin());
    for (std::size_t r = 0; r < rows; ++r) {
      for (int k = 0; k <= kAround; ++k) {
        const float azimuth = -180 + 360 * static_cast<float>(k) / kAround;
        // An uneven edge, because hair does not end at a drawn line.
        const float ragged =
            r == 0 ? hair_.edge.ragged * NoiseAt(k % kAround, PaintStream::kCropEdge) : 0.0f;
        const glm::vec3 d = shape_.Direction(azimuth, kUp[r] + ragged);
        // Curls gather to clumps, which are higher and lighter than what is between them.
        const float clump = NoiseAt(k % kAround, PaintStream::kCropBelow, static_cast<int>(r));
        const float uneven =
            1 + glm::mix(hair_.shell.uneven, hair_.curl.uneven, style_.curl) * clump;
        const glm::vec3 p =
            shape_.scalp().Over(d, shape_.Depth(d, kUp[r]) * (r == 0 ? 1.0f : uneven));
        const glm::vec3 colour =
            glm::mix(palette_.hair, look_.StrandColour(3 * (k % kAround), static_cast<int>(r)),
                     hair_.shell.streaks * (1 - style_.curl));
        const float thin = r == 0 ? hair_.edge.hair : 1.0f;
        mesh_.Add(p, glm::mix(palette_.skin * hair_.edge.skin, colour, thin),
                  (r < 3 ? hair_.shell.edge_light : hair_.shell.light) *
                      (1 + hair_.curl.mottled * style_.curl * (clump - 1)),
                  Bone::kSkull);
        mesh_.strands.back() = {
            .along = shape_.Along(d, shape_.Forehead(azimuth, kUp[r])),
            .density = r < edge_density.size() ? edge_density[r] : 1.0f,
            .tile_mm = shape_.Curled({kRoundMm * azimuth / 360, -140 * kUp[r]})};
      }
    }
    mesh_.Grid(Material::kHair, first, static_cast<int>(rows), kAround + 1, true);
  }

  void Lock(int k) {
    const auto& lock = hair_.lock;
    const auto& uneven = hair_.uneven;
    // The golden ratio spreads locks evenly over the scalp.
    const float turn =
        360 * (0.618034f * static_cast<float>(k) - std::floor(0.618034f * static_cast<float>(k)));
    const float azimuth = turn - 180;
    const float share = (static_cast<float>(k) + 0.5f) / static_cast<float>(style_.locks);
    const float up = lock.from.start + lock.from.added * share * share;
    if (hair_.ear.azimuth.Contains(std::abs(azimuth)) && up < hair_.ear.up) return;
    const glm::vec3 root = shape_.Direction(azimuth, up);
    const float forehead = shape_.Forehead(azimuth, up);
    glm::vec3 along = shape_.Flow(root, forehead) +
                      uneven.direction * glm::vec3(NoiseAt(k, PaintStream::kCropLockX), 0,
                                                   NoiseAt(k, PaintStream::kCropLockZ));
    along = glm::normalize(along - root * glm::dot(along, root));
    const float length = style_.lock_mm *
                         (1 + uneven.length * NoiseAt(k, PaintStream::kCropLockLength)) *
                         hair_.lock_length.nape.At(hair_.lock_length.top_over_y.Ramp(root.y)) *
                         hair_.lock_length.hairline.At(hair_.lock_length.over_up.Ramp(up));
    const float lift = style_.lift_mm * (1 + uneven.lift * NoiseAt(k, PaintStream::kCropLockLift)) +
                       forehead * style_.front_up * hair_.forehead.lift;
    std::vector<glm::vec3> path;
    constexpr int kSteps = 4;
    const glm::vec3 side = glm::cross(root, along);
    for (int s = 0; s <= kSteps; ++s) {
      const float v = static_cast<float>(s) / kSteps;
      const float swing = style_.wave_mm * std::sin(lock.waves * kPi * v + static_cast<float>(k));
      const glm::vec3 d = glm::normalize(root + (along * (length * v) + side * swing * v) / 100.0f);
      const float over = shape_.Depth(d, shape_.Up(d));  // follows the shell
      path.push_back(shape_.scalp().Over(d, 1.02f * over + lift * v * (1 - 0.75f * v) + lock.off));
    }
    const float width = glm::mix(hair_.lock_width.hairline, hair_.lock_width.top.At(style_.lock_mm),
                                 hair_.lock_width.over_up.Ramp(up));
    look_.AddLock(path,
                  {.width_mm = hair_.lock_width.factor * width *
                               (1 + uneven.width * NoiseAt(k, PaintStream::kCropLockWidth)),
                   .root_share = lock.root,
                   .tip_share = lock.tip,
                   .fray_from = lock.fray_from,
                   .open = lock.light},
                  k, mesh_);
  }

  const CropStyle& style_;
  const Features::CropHair& hair_;
  const Palette& palette_;
  const HairLook look_;
  const CropShape shape_;
  MeshBuilder& mesh_;
};

}  // namespace

void BuildCroppedHair(const Identity& identity, MeshBuilder& mesh, float up_to) {
  CropBuilder(identity, mesh).Build(up_to);
}

std::vector<SkinStroke> CroppedHairline(const Identity& identity, const MeshBuilder& skin) {
  return CropShape(identity, skin).Hairline();
}

}  // namespace fsm
