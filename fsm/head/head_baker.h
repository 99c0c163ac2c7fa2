#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/cage.h"
#include "fsm/head/head_form.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/head/subdivide.h"
#include "fsm/head/warp.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

/// Makes the asset of a built-in head from the tables: the skin from its cage, the parts laid on
/// it, all brought into the identity's form, and the rig that moves it. What a head of another kind
/// has otherwise it overrides. Used once.
class HeadBaker {
 public:
  /// Throws std::runtime_error naming file and line if a table is damaged.
  HeadBaker(Identity identity, bool asymmetric);
  virtual ~HeadBaker() = default;
  HeadAsset Bake();
  /// The rig of the skin alone, in its form: what it looks like is left out.
  RigData BakeSkin();

 protected:
  /// Adds the shoulders, which move as skin does.
  virtual void AddFigure();
  /// Adds hair and what is fixed to the skull, where the head already has its form.
  virtual void AddHair();
  /// Paints the first hairs on the skin, which has not taken its form yet.
  virtual void AddHairline();
  virtual void AddEars();
  virtual void AddLashes();
  virtual HeadForm Form() const;
  /// Which vertices are where they belong before the others take the form.
  virtual std::size_t FixedEnd() const { return skin_count_; }
  /// Changes what is there at the end.
  virtual void Complete(HeadAsset&) {}

  Identity identity_;
  EyeAnatomy eye_;
  MouthAnatomy mouth_;
  Shaper shaper_;
  Cage cage_;
  FineSkin fine_;
  HeadMesh mesh_;
  MouthSeam skin_;
  std::size_t skin_count_ = 0;   ///< vertices of skin, which come first
  std::size_t figure_end_ = 0;   ///< then those of AddFigure
  std::vector<glm::vec3> base_;  ///< the base head's rest form, for texture coordinates

 private:
  void AddSkin();
  void AddParts();
  void TakeForm();
  void BakeTopology(HeadTopology& topology);
  void BakeRig(const HeadTopology& topology, RigData& rig);
  void BakeEyes(HeadTopology& topology) const;

  bool asymmetric_;
  std::vector<SkinHair> skin_hairs_;
  std::size_t soft_count_ = 0;  // vertices that move as skin, which come first
  std::size_t hair_first_ = 0;
  Sided<EyeTransform> eye_transforms_;
  TeethTransform teeth_;  // from the base head's
};

}  // namespace fsm
