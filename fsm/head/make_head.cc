#include "fsm/head/make_head.h"

#include <algorithm>
#include <cstddef>
#include <glm/common.hpp>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "embedded/curves.h"
#include "embedded/hair_springs.h"
#include "embedded/patches.h"
#include "embedded/sliders.h"
#include "fsm/head/anatomy.h"
#include "fsm/head/cage.h"
#include "fsm/head/cloth_parts.h"
#include "fsm/head/ear_parts.h"
#include "fsm/head/eye_parts.h"
#include "fsm/head/face_channels.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_springs.h"
#include "fsm/head/hair_styles.h"
#include "fsm/head/head_form.h"
#include "fsm/head/identity.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/lashes.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/head/mouth_parts.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_surface.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/head/skin_strokes.h"
#include "fsm/head/subdivide.h"
#include "fsm/head/warp.h"

// A head is made in stages, each of which passes a value to the next: its ingredients; the skin
// from its cage; the parts added to it; all deformed to the head's form; its look; the rig. Both
// kinds of heads, of an identity and of a photo, have these in common; MakeHead adds what only one
// of them has.

namespace fsm {
namespace {

/// What a head is made of.
struct HeadSources {
  explicit HeadSources(Identity own)
      : identity(std::move(own)),
        sliders(Table("tables/sliders.txt", embedded::sliders()), identity.sliders) {
    eye.FillUpperLid(identity.fold.full_mm);
  }
  /// Those of the built-in face that a photo is warped from, in the photo's colours.
  explicit HeadSources(const PhotoHead& photo_head)
      : HeadSources(BuiltInIdentity(photo_head.base)) {
    identity.features = photo_head.features;
    CopyColours(photo_head, identity.palette);
    eye.ScaleIris(photo_head.iris_size);
  }

  Identity identity;
  EyeAnatomy eye = EyeAnatomy::BuiltIn();
  const MouthAnatomy& mouth = MouthAnatomy::BuiltIn();
  SliderWarp sliders;
};

/// The skin of the base head.
struct BaseSkin {
  Cage cage;
  FineSkin fine;
  MouthVertices mouth;  ///< without incisors
  MeshBuilder mesh;
};

BaseSkin MakeSkin(const HeadSources& from) {
  BaseSkin skin;
  skin.cage = ReadCage(Table("tables/curves.txt", embedded::curves()),
                       Table("tables/patches.txt", embedded::patches()), from.eye, from.mouth);
  skin.fine = Subdivide(skin.cage);
  skin.mouth = BuildSkin(skin.fine, from.eye, from.mouth, from.identity, skin.mesh);
  return skin;
}

/// The base head without hair; the first vertices are those of the skin.
struct BaseParts {
  void Add(std::vector<SkinStroke> strokes) {
    std::ranges::move(strokes, std::back_inserter(skin_strokes));
  }

  MeshBuilder mesh;
  std::vector<SkinStroke> skin_strokes;
};

void AddBrowsAndFolds(const HeadSources& from, const SkinFront& front, BaseParts& parts) {
  parts.Add(BuildBrows(front, from.identity, parts.mesh));
  parts.Add(BuildLidFolds(front, from.eye, from.identity));
}

void AddEyesAndMouth(const HeadSources& from, MeshBuilder& mesh) {
  BuildEyes(from.eye, from.identity, mesh);
  BuildTeeth(from.mouth, from.identity, mesh);
  BuildTongue(from.mouth, from.identity, mesh);
}

/// The head in its own form; hair is added to it.
struct FormedHead {
  FormedHead(const HeadForm& form, const MeshBuilder& base_mesh)
      : mesh(base_mesh),
        base(base_mesh.position),
        hangs_from(base_mesh.position.size()),
        eyes(form.eye_transforms()),
        teeth(form.teeth()) {
    form.Shape(mesh);
  }

  MeshBuilder mesh;
  std::vector<glm::vec3> base;  ///< rest form of the base head without hair
  std::size_t hangs_from;       ///< the first vertex of hair that swings
  Sided<EyeTransform> eyes;
  TeethTransform teeth;  ///< relative to the base head
};

/// Warps the base face to the person in a photo.
FormedHead WarpToPhoto(const HeadSources& from, const PhotoHead& photo_head, const BaseSkin& skin,
                       const MeshBuilder& base) {
  const Warp warp(photo_head.points, photo_head.smooth);
  FormedHead head(HeadForm(from.eye, from.mouth, from.sliders, &warp, photo_head.eyes, base), base);
  RemoveUnseenSkin(photo_head, skin.fine.tag, head.mesh);
  if (photo_head.glasses) {
    FreezeSkinBehindGlasses(*photo_head.features, glm::vec2(from.eye.centre()),
                            skin.mesh.position.size(), head.mesh);
  }
  return head;
}

HeadSurface SurfaceOf(const HeadSources& from, const BaseParts& parts, const FormedHead& head) {
  HeadSurface surface;
  SetParts(head.mesh.batches, surface);
  surface.skin_strokes = parts.skin_strokes;
  surface.albedo = head.mesh.albedo;
  for (glm::vec3& colour : surface.albedo) colour = glm::clamp(colour, 0.0f, 1.0f);
  surface.openness = head.mesh.openness;
  if (std::ranges::any_of(head.mesh.opacity, [](float opacity) { return opacity < 1; })) {
    surface.opacity = head.mesh.opacity;
  }
  surface.strands = head.mesh.strands;
  for (const glm::vec3 p : head.base) surface.uv.push_back(SkinUv(p));
  for (std::size_t i = head.base.size(); i < head.mesh.position.size(); ++i)
    surface.uv.push_back(SkinUv(head.mesh.position[i]));
  for (const Side side : kSides) {
    const float size = head.eyes[side].size;
    surface.eyes[side] = {.ball_radius = size * from.eye.radius(),
                          .iris_radius = size * from.eye.iris_radius(),
                          .pupil_radius = size * from.eye.pupil_radius(),
                          .iris_colour = from.identity.palette.iris,
                          .white_colour = from.identity.palette.sclera};
  }
  return surface;
}

RigData RigOf(const HeadSources& from, const BaseSkin& skin, const FormedHead& head,
              const HeadSurface& surface) {
  using enum RigStep;
  const Identity& identity = from.identity;
  RigData rig;
  // Lips meet where the teeth let them; skin that follows them is pushed off the teeth again.
  rig.steps = {kChannels, kLids,  kJaw,  kTeeth,   kLips,   kTeeth,
               kTongue,   kBones, kNeck, kSprings, kNormals};
  const std::size_t hair_first = head.base.size();
  rig.rest = head.mesh.position;
  rig.rest_normal = Normals(surface.indices, rig.rest, rig.rest.size());
  // A tail that hangs is lit as a body of its own.
  const std::size_t aligned =
      std::holds_alternative<CombedStyle>(identity.hair) ? head.hangs_from : rig.rest.size();
  HairLook(identity).AlignNormals(
      std::span(rig.rest).subspan(hair_first, aligned - hair_first),
      std::span(rig.rest_normal).subspan(hair_first, aligned - hair_first));
  rig.bone = head.mesh.bone;
  for (const BakeWeights& vertex : head.mesh.weights) rig.weights.push_back(vertex.skin);
  rig.units = BuiltInUnits();
  rig.units.Add(identity.units);
  rig.asymmetry_seed = static_cast<int>(identity.index);
  rig.has_unit_channels = true;
  rig.creases.at_rest = identity.creases;
  const std::span<const BakeWeights> weights = head.mesh.weights;
  rig.channels = UnitChannels(rig.units, rig.bone, rig.weights);
  std::ranges::move(MouthChannels(from.mouth, weights), std::back_inserter(rig.channels));
  rig.lids = BakeLids(from.eye, head.eyes, rig.rest, weights);
  rig.mouth = skin.mouth;
  rig.mouth.incisors = FindIncisors(rig.rest, rig.bone, surface);
  rig.lips = BakeLips(weights);
  rig.teeth = BakeTeeth(Moved(from.mouth.upper_teeth(), head.teeth),
                        Moved(from.mouth.lower_teeth(), head.teeth), rig.rest, weights);
  for (const Side side : kSides)
    rig.eyes.centre[side] = EyePointInFace(from.eye, head.eyes, side, from.eye.CentreOf(side));
  for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
    const std::uint32_t* const corner = &surface.indices[i];
    if (rig.bone[*corner] != Bone::kSkin) continue;
    rig.normals.soft_triangles.insert(rig.normals.soft_triangles.end(), corner, corner + 3);
  }
  AddHairSprings(Table("tables/hair_springs.txt", embedded::hair_springs()), head.hangs_from, rig);
  return rig;
}

HeadAsset AssetOf(const HeadSources& from, const BaseSkin& skin, const BaseParts& parts,
                  const FormedHead& head) {
  HeadAsset asset;
  asset.surface = SurfaceOf(from, parts, head);
  asset.rig = RigOf(from, skin, head, asset.surface);
  asset.landmarks = NameLandmarks(skin.cage, skin.fine, asset.rig.rest, from.eye, head.eyes,
                                  *from.identity.features);
  return asset;
}

/// Maps the photo onto the skin, evaluated with lids open and shut.
void MapPhoto(const PhotoHead& photo_head, const HeadSources& from, const BaseSkin& skin,
              const FormedHead& formed, HeadAsset& asset) {
  const std::size_t count = skin.mesh.position.size();
  const Rig rig(asset.rig);
  HeadVertices open, shut;
  rig.Evaluate({}, open);
  FaceState asleep;
  asleep.blink.left = asleep.blink.right = 1;
  rig.Evaluate(asleep, shut);
  const auto pose = [count](const HeadVertices& v) {
    return SkinSurface{std::span(v.position).first(count), std::span(v.normal).first(count)};
  };
  const PhotoSkin worn{std::span(formed.mesh.weights).first(count), skin.fine.tag, pose(open),
                       pose(shut)};
  ApplyPhoto(photo_head, worn, from.identity.palette.lip_inside, asset.surface);
}

HeadAsset AssetOf(Identity own) {
  const HeadSources from(std::move(own));
  const Identity& identity = from.identity;
  const BaseSkin skin = MakeSkin(from);
  const SkinFront front(skin.fine);
  BaseParts parts{skin.mesh, {}};
  BuildCloth(identity, parts.mesh);
  AddBrowsAndFolds(from, front, parts);
  parts.Add(BuildStubble(front, SkinPainter(identity, from.eye), identity));
  const bool combed = std::holds_alternative<CombedStyle>(identity.hair);
  const bool crop = std::holds_alternative<CropStyle>(identity.hair);
  parts.Add(crop     ? CroppedHairline(identity, parts.mesh)
            : combed ? CombedHairline(identity, parts.mesh)
                     : LongHairline(identity, parts.mesh));
  BuildLashes(from.eye, identity, false, parts.mesh);
  AddEyesAndMouth(from, parts.mesh);
  const auto* const hanging = std::get_if<LongStyle>(&identity.hair);
  if (hanging == nullptr || hanging->tucked > 0) BuildEars(identity, parts.mesh);  // else covered
  FormedHead head(
      HeadForm(from.eye, from.mouth, from.sliders, nullptr, {}, parts.mesh, identity.eyes),
      parts.mesh);
  if (combed) {
    head.hangs_from = BuildCombedHair(identity, head.mesh);
  } else if (crop) {
    BuildCroppedHair(identity, head.mesh);
    head.hangs_from = head.mesh.position.size();
  } else {
    BuildLongHair(identity, head.mesh);
  }
  return AssetOf(from, skin, parts, head);
}

}  // namespace

std::unique_ptr<Head> MakeHead(std::string_view identity) {
  return MakeHead(BuiltInIdentity(identity));
}

std::unique_ptr<Head> MakeHead(Identity own) {
  return std::make_unique<Head>(AssetOf(std::move(own)));
}

std::unique_ptr<Head> MakeSymmetricHead(std::string_view identity) {
  return MakeSymmetricHead(BuiltInIdentity(identity));
}

std::unique_ptr<Head> MakeSymmetricHead(Identity own) {
  HeadAsset asset = AssetOf(std::move(own));
  asset.rig.asymmetry_seed.reset();
  return std::make_unique<Head>(std::move(asset));
}

std::unique_ptr<Head> MakeHead(const PhotoHead& photo_head) {
  if (!photo_head.atlas) throw std::runtime_error("a head of a photo without its photo");
  const HeadSources from(photo_head);
  const BaseSkin skin = MakeSkin(from);
  BaseParts parts{skin.mesh, {}};
  AddPhotoSheet(photo_head, parts.mesh);
  AddBrowsAndFolds(from, SkinFront(skin.fine), parts);
  // The photo shows the lashes of open eyes, so only those of shut lids are added.
  BuildLashes(from.eye, from.identity, true, parts.mesh);
  AddEyesAndMouth(from, parts.mesh);
  const FormedHead head = WarpToPhoto(from, photo_head, skin, parts.mesh);
  HeadAsset asset = AssetOf(from, skin, parts, head);
  asset.rig.creases.depth = photo_head.lined;
  MapPhoto(photo_head, from, skin, head, asset);
  return std::make_unique<Head>(std::move(asset));
}

Rig MakeSkinRig(const PhotoHead& photo_head) {
  const HeadSources from(photo_head);
  const BaseSkin skin = MakeSkin(from);
  const BaseParts alone{skin.mesh, {}};
  const FormedHead head = WarpToPhoto(from, photo_head, skin, skin.mesh);
  return Rig(RigOf(from, skin, head, SurfaceOf(from, alone, head)));
}

}  // namespace fsm
