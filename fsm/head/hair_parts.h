#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Hair is thought of as lying about this point of the skull; directions are from here.
inline constexpr glm::vec3 kHairCentre{0, 44, -9};

/// The skin under the hair, as distance from kHairCentre by direction.
class Scalp {
 public:
  explicit Scalp(const HeadMesh& mesh);
  float Distance(glm::vec3 direction) const;
  /// The point `lift` millimetres over the skin in that direction.
  glm::vec3 Over(glm::vec3 direction, float lift) const;

 private:
  std::vector<std::pair<glm::vec3, float>> points_;
};

/// Angles about the hair's centre in degrees: azimuth from straight ahead towards +x.
glm::vec3 HairDirection(float azimuth, float elevation);
struct LockStyle {
  float width_mm;
  float root_part = 1;     ///< width at the root, as part of the whole
  float tip_part = 0.5f;   ///< width at the tip
  float fray_from = 0.6f;  ///< part of the way from which hairs end
  float root_density = 0;  ///< how dense the hairs are at the root, 0..1
  float open = 1;          ///< to the light, 0..1
  float tip_light = 1.1f;  ///< colour at the tip over that at the root
};
/// What all heads of hair have in common. Lifetime: the identity outlives it.
class HairLook {
 public:
  explicit HairLook(const Identity& identity)
      : features_(identity.UsedFeatures()),
        palette_(identity.palette),
        hairline_(CurveOf(features_.hairline)) {}

  /// Where the hair begins on the skin: elevation by azimuth, degrees.
  float HairlineElevation(float azimuth) const { return hairline_(std::abs(azimuth)); }
  /// By how many degrees a place lies above that line.
  float AboveHairline(glm::vec3 place) const;
  /// The colour of one strand: lighter and darker streaks.
  glm::vec3 StrandColour(int strand, int row) const;
  /// A lock as a card along `path` that frays at its sides and towards its tip.
  void AddLock(std::span<const glm::vec3> path, const LockStyle& style, int seed,
               HeadMesh& mesh) const;
  /// Darkens the skin under the hair and beside its edge, which runs through `edge`.
  void ShadeSkin(std::span<const glm::vec3> edge, float reach_mm, HeadMesh& mesh) const;
  /// A hair painted on the skin, from `root` on (unit, from kHairCentre) in the direction `along`;
  /// `strength`: 1 = as the others, less is shorter and paler.
  SkinHair OnSkin(const Scalp& scalp, glm::vec3 root, glm::vec3 along, float strength,
                  int seed) const;
  /// Turns the normals of locks, which are flat cards, towards those of the head of hair they lie
  /// on, so that they take light as it does. `place` and `normal` are of one length.
  void LightAsOne(std::span<const glm::vec3> place, std::span<glm::vec3> normal) const;

 private:
  const Features& features_;
  const Palette& palette_;
  Curve hairline_;
};

}  // namespace fsm
