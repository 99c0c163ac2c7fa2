#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The centre of the head of hair in the skull; directions are relative to it.
inline constexpr glm::vec3 kHairCentre{0, 44, -9};

/// The skin under the hair, as the distance from kHairCentre by direction.
class Scalp {
 public:
  explicit Scalp(const MeshBuilder& mesh);
  float Distance(glm::vec3 direction) const;
  /// Returns the point `lift` millimetres above the skin in that direction.
  glm::vec3 Over(glm::vec3 direction, float lift) const;

 private:
  std::vector<std::pair<glm::vec3, float>> points_;
};

/// Angles are in degrees about kHairCentre: azimuth from straight ahead towards +x.
glm::vec3 HairDirection(float azimuth, float elevation);
struct LockStyle {
  float width_mm;
  float root_share = 1;    ///< width at the root as a fraction of width_mm
  float tip_share = 0.5f;  ///< width at the tip as a fraction of width_mm
  float fray_from = 0.6f;  ///< fraction of the length from which hairs end
  float root_density = 0;  ///< density of the hairs at the root, 0..1
  float open = 1;          ///< openness to light, 0..1
  float tip_light = 1.1f;  ///< brightness at the tip relative to the root
  glm::vec3 outward{0};    ///< direction that its flat side faces; 0: away from kHairCentre
  bool single = false;     ///< a single hair, whose sides do not fray
};
/// The look that all hair styles share. Lifetime: the identity must outlive it.
class HairLook {
 public:
  explicit HairLook(const Identity& identity)
      : features_(*identity.features),
        palette_(identity.palette),
        hairline_(CurveOf(IsTied(identity) ? std::span<const float>(features_.combed_hair.line)
                                           : std::span<const float>(features_.hairline))) {}

  /// Returns the elevation at which the hair begins on the skin, by azimuth; degrees.
  float HairlineElevation(float azimuth) const { return hairline_(std::abs(azimuth)); }
  /// Returns how many degrees a point lies above that line.
  float AboveHairline(glm::vec3 p) const;
  /// Returns the colour of one strand, with lighter and darker streaks.
  glm::vec3 StrandColour(int strand, int row) const;
  /// Adds a lock: a strip along `path` that frays at its sides and towards its tip.
  void AddLock(std::span<const glm::vec3> path, const LockStyle& style, int seed,
               MeshBuilder& mesh) const;
  /// Darkens the skin under the hair and beside its edge, which passes through `edge`.
  void ShadeSkin(std::span<const glm::vec3> edge, float reach_mm, MeshBuilder& mesh) const;
  /// Returns a hair painted on the skin from `root` (unit direction from kHairCentre) along
  /// `along`. `strength`: 1 = full; a smaller one is shorter and paler.
  SkinStroke SkinHair(const Scalp& scalp, glm::vec3 root, glm::vec3 along, float strength,
                      int seed) const;
  /// Bends the normals of locks, which are flat strips, towards those of the whole head of hair, so
  /// that they are lit alike. REQUIRES: `position` and `normal` have the same size.
  void AlignNormals(std::span<const glm::vec3> position, std::span<glm::vec3> normal) const;

 private:
  static bool IsTied(const Identity& identity) {
    const auto* const combed = std::get_if<CombedStyle>(&identity.hair);
    return combed != nullptr && combed->tail.has_value();
  }

  const Features& features_;
  const Palette& palette_;
  Curve hairline_;
};

}  // namespace fsm
