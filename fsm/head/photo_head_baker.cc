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
void TakeColours(const PhotoHead& head, Palette& palette) {
  palette.iris = head.iris_colour;
  palette.sclera = head.white_colour;
  Desaturate(palette, head.saturation);
  if (head.lip_colour) {
    // Where the lips turn inward the mouth is painted: it begins in their colour.
    constexpr float kOpen = 0.85f;
    palette.lip_inside = *head.lip_colour / kOpen;
    palette.mouth = 0.9f * Wetter(palette.lip_inside, 0.5f * head.saturation);
  }
  // A photographer's light comes from the front and reaches into the mouth.
  // Teeth stand in the light whose hue the whites of the eyes show.
  const glm::vec3 white = head.white_colour;
  palette.tooth *=
      0.67f * head.teeth *
      glm::mix(glm::vec3(1), white / std::max({white.r, white.g, white.b, 1e-3f}), 0.5f);
  palette.tongue *= 0.85f * head.teeth;
}

/// The base head, warped to a person, with the photo on it and a sheet that carries what surrounds
/// the face.
class PhotoHeadBaker : public HeadBaker {
 public:
  explicit PhotoHeadBaker(const PhotoHead& head)
      : HeadBaker(BuiltInIdentity(head.base), true), head_(head), warp_(head.points, head.smooth) {
    identity_.features = head.features;
    TakeColours(head, identity_.palette);
    eye_.ScaleIris(head.iris_size);
  }

 protected:
  void AddFigure() override { AddSheet(head_, mesh_); }
  void AddHairline() override {}
  void AddEars() override {}
  // A photo shows the lashes of open eyes: only those of shut lids are added.
  void AddLashes() override { BuildLashes(eye_, identity_, true, mesh_); }
  void AddHair() override {
    LeaveOutUnseen(head_, fine_.tag, mesh_);
    if (head_.glasses) HoldBehindGlasses(glm::vec2(eye_.centre()), skin_count_, mesh_);
  }
  HeadForm Form() const override {
    return HeadForm(eye_, mouth_, shaper_, &warp_, head_.eyes, mesh_);
  }
  std::size_t FixedEnd() const override { return figure_end_; }

  void Complete(HeadAsset& asset) override {
    asset.rig.crease_depth = head_.lined;
    const Rig rig(asset.rig);
    HeadVertices open, shut;
    rig.Evaluate({}, open);
    FaceState asleep;
    asleep.blink.left = asleep.blink.right = 1;
    rig.Evaluate(asleep, shut);
    const auto pose = [this](const HeadVertices& v) {
      return SkinPose{std::span(v.position).first(skin_count_),
                      std::span(v.normal).first(skin_count_)};
    };
    const PhotoSkin worn{std::span(asset.rig.weights).first(skin_count_), fine_.tag, pose(open),
                         pose(shut)};
    WearPhoto(head_, worn, identity_.palette.lip_inside, asset.topology);
  }

 private:
  const PhotoHead& head_;
  Warp warp_;
};

}  // namespace

std::unique_ptr<Head> MakeHead(const PhotoHead& head) {
  if (!head.photo) throw std::runtime_error("a head of a photo without its photo");
  return std::make_unique<Head>(PhotoHeadBaker(head).Bake());
}

Rig MakeSkinRig(const PhotoHead& head) { return Rig(PhotoHeadBaker(head).BakeSkin()); }

}  // namespace fsm
