#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "fsm/head/head_baker.h"
#include "fsm/head/make_head.h"
#include "fsm/head/own_identity.h"
#include "fsm/head/parts.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_wear.h"

namespace fsm {
namespace {

/// What a grey photo does not show must be grey too.
void Desaturate(Palette& palette, float saturation) {
  for (glm::vec3* colour : {&palette.tooth, &palette.lip_inside, &palette.rim, &palette.mouth,
                            &palette.tongue, &palette.gum}) {
    *colour =
        glm::mix(glm::vec3(glm::dot(*colour, glm::vec3(0.3f, 0.6f, 0.1f))), *colour, saturation);
  }
}

/// The colours of what the photo does not show.
void TakeColours(const PhotoHead& set, Palette& palette) {
  palette.iris = set.iris_colour;
  palette.sclera = set.white_colour;
  Desaturate(palette, set.saturation);
  if (set.lip_colour) {
    // Where the lips turn inward the mouth is painted: it begins in their colour.
    constexpr float kOpen = 0.85f;
    palette.lip_inside = *set.lip_colour / kOpen;
    palette.mouth = 0.9f * Wetter(palette.lip_inside, 0.5f * set.saturation);
  }
  // A photographer's light comes from the front and reaches into the mouth.
  // Teeth stand in the light whose hue the whites of the eyes show.
  const glm::vec3 white = set.white_colour;
  palette.tooth *=
      0.67f * set.teeth *
      glm::mix(glm::vec3(1), white / std::max({white.r, white.g, white.b, 1e-3f}), 0.5f);
  palette.tongue *= 0.85f * set.teeth;
}

/// The base head, warped to a person, with the photo on it and a sheet that carries what surrounds
/// the face.
class PhotoHeadBaker : public HeadBaker {
 public:
  explicit PhotoHeadBaker(const PhotoHead& set)
      : HeadBaker(BuiltInIdentity(set.base), true), set_(set), warp_(set.points, set.smooth) {
    identity_.features = set.features;
    TakeColours(set, identity_.palette);
    eye_.ScaleIris(set.iris_size);
  }

 protected:
  void AddFigure() override { AddSheet(set_, mesh_); }
  void AddEars() override {}
  // Of open eyes a photo shows the lashes.
  void AddLashes() override { BuildLashes(eye_, identity_, true, mesh_); }
  void AddHair() override {
    LeaveOutUnseen(set_, fine_.tag, mesh_);
    if (set_.glasses) HoldBehindGlasses(glm::vec2(eye_.centre()), skin_count_, mesh_);
  }
  HeadForm Form() const override {
    return HeadForm(eye_, mouth_, shaper_, &warp_, set_.eyes, mesh_);
  }
  std::size_t FixedEnd() const override { return figure_end_; }

  void Complete(HeadAsset& asset) override {
    asset.rig.crease_depth = set_.lined;
    const Rig rig(asset.rig);
    HeadVertices open, shut;
    rig.Evaluate({}, open);
    FaceState asleep;
    asleep.blink_left = asleep.blink_right = 1;
    rig.Evaluate(asleep, shut);
    const auto pose = [this](const HeadVertices& v) {
      return SkinPose{std::span(v.position).first(skin_count_),
                      std::span(v.normal).first(skin_count_)};
    };
    const PhotoSkin worn{std::span(asset.rig.weights).first(skin_count_), fine_.tag, pose(open),
                         pose(shut)};
    WearPhoto(set_, worn, identity_.palette.lip_inside, asset.topology);
  }

 private:
  const PhotoHead& set_;
  Warp warp_;
};

}  // namespace

std::unique_ptr<Head> MakeHead(const PhotoHead& set) {
  if (!set.photo) throw std::runtime_error("a face set without its photo");
  return std::make_unique<Head>(PhotoHeadBaker(set).Bake());
}

}  // namespace fsm
