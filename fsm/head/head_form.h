#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/head/warp.h"
#include "fsm/rig/eye_transform.h"

namespace fsm {

/// Deforms the base head to the form of one identity or a person in a photo. Eyes with what touches
/// them, and teeth with the tongue, move rigidly. Borrows its constructor's arguments.
class HeadForm {
 public:
  /// `warp`: that of a face from a photo, or null. `eye_transforms`: those of its eyes if known;
  /// otherwise both eyes are like `left_eye` and follow the skin. `base`: the head before it takes
  /// this form.
  HeadForm(const EyeAnatomy& eye, const MouthAnatomy& mouth, const SliderWarp& sliders,
           const Warp* warp, const std::optional<Sided<EyeTransform>>& eye_transforms,
           const MeshBuilder& base, const EyeTransform& left_eye = {});

  /// Moves all vertices, each with what it follows.
  void Shape(MeshBuilder& mesh) const;

  const Sided<EyeTransform>& eye_transforms() const { return eye_transforms_; }
  const TeethTransform& teeth() const { return teeth_; }

 private:
  glm::vec3 Motion(glm::vec3 p) const;
  /// Returns how far the teeth must move back, in millimetres, for the lips of a warped head to
  /// have the same room as on the base head.
  float TeethTooFar(const MeshBuilder& base) const;

  const EyeAnatomy& eye_;
  const MouthAnatomy& mouth_;
  const SliderWarp& sliders_;
  const Warp* warp_;
  Sided<EyeTransform> eye_transforms_;
  TeethTransform teeth_;
};

/// Maps a point on the table's eye to the face's own eye on that side.
glm::vec3 EyePointInFace(const EyeAnatomy& eye, const Sided<EyeTransform>& eye_transforms,
                         Side side, glm::vec3 p);

}  // namespace fsm
