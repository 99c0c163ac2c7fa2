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
#include "fsm/head/hair.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_springs.h"
#include "fsm/head/head_form.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/lashes.h"
#include "fsm/head/mouth_parts.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_wear.h"
#include "fsm/head/skin_hairs.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/head/subdivide.h"
#include "fsm/head/warp.h"

// A head is made in stages, each of which passes a value to the next: its ingredients; the skin
// from its cage; the parts added to it; all deformed to the head's form; its look; the rig.

namespace fsm {
namespace {

/// What a head is made of: an identity, or the built-in face that a photo is warped from.
struct Ingredients {
  Ingredients(Identity own, bool sides_differ)
      : identity(std::move(own)),
        sliders(Table("tables/sliders.txt", embedded::sliders()), identity.sliders),
        asymmetric(sides_differ) {
    eye.FillUpperLid(identity.fold.full_mm);
  }
  explicit Ingredients(const PhotoHead& head) : Ingredients(BuiltInIdentity(head.base), true) {
    identity.features = head.features;
    TakeColours(head, identity.palette);
    eye.ScaleIris(head.iris_size);
    photo = &head;
    warp.emplace(head.points, head.smooth);
  }

  Identity identity;
  EyeAnatomy eye = EyeAnatomy::BuiltIn();
  const MouthAnatomy& mouth = MouthAnatomy::BuiltIn();
  SliderWarp sliders;
  bool asymmetric;                   ///< whether the two sides move slightly differently
  const PhotoHead* photo = nullptr;  ///< the photo it wears, or null
  std::optional<Warp> warp;          ///< from the base face to the person in the photo
};

/// The skin of the base head.
struct BaseSkin {
  Cage cage;
  FineSkin fine;
  MouthSlit mouth;
  HeadMesh mesh;
};

BaseSkin MakeSkin(const Ingredients& from) {
  BaseSkin skin;
  skin.cage = ReadCage(Table("tables/curves.txt", embedded::curves()),
                       Table("tables/patches.txt", embedded::patches()), from.eye, from.mouth);
  skin.fine = Subdivide(skin.cage);
  skin.mouth = BuildSkin(skin.fine, from.eye, from.mouth, from.identity, skin.mesh);
  return skin;
}

/// The base head without hair; the first vertices are those of the skin.
struct BaseParts {
  HeadMesh mesh;
  std::vector<SkinHair> skin_hairs;
};

BaseParts LayParts(const Ingredients& from, const BaseSkin& skin) {
  const Identity& identity = from.identity;
  BaseParts parts{skin.mesh, {}};
  HeadMesh& mesh = parts.mesh;
  if (from.photo) {
    AddPhotoSheet(*from.photo, mesh);
  } else {
    BuildCloth(identity, mesh);
  }
  const SkinFront front(skin.fine);
  parts.skin_hairs = BuildBrows(front, identity, mesh);
  std::ranges::move(BuildLidFolds(front, from.eye, identity), std::back_inserter(parts.skin_hairs));
  if (!from.photo) {
    std::ranges::move(BuildStubble(front, SkinPainter(identity, from.eye), identity),
                      std::back_inserter(parts.skin_hairs));
    std::ranges::move(Hairline(identity, mesh), std::back_inserter(parts.skin_hairs));
  }
  // A photo shows the lashes of open eyes, so only those of shut lids are added.
  BuildLashes(from.eye, identity, from.photo != nullptr, mesh);
  BuildEyes(from.eye, identity, mesh);
  BuildTeeth(from.mouth, identity, mesh);
  BuildTongue(from.mouth, identity, mesh);
  // Long hair covers the ears; a photo shows them.
  if (identity.crop && !from.photo) BuildEars(identity, mesh);
  return parts;
}

/// The head in its own form, with hair.
struct FormedHead {
  HeadMesh mesh;
  std::vector<glm::vec3> base;  ///< rest form of the base head, for texture coordinates
  std::size_t hair_first;
  Sided<EyeTransform> eyes;
  TeethTransform teeth;  ///< relative to the base head
};

void AddHair(const Ingredients& from, const BaseSkin& skin, HeadMesh& mesh) {
  if (from.photo) {
    LeaveOutUnseen(*from.photo, skin.fine.tag, mesh);
    if (!from.photo->glasses) return;
    HoldBehindGlasses(glm::vec2(from.eye.centre()), skin.mesh.position.size(), mesh);
  } else {
    BuildHair(from.identity, mesh);
  }
}

FormedHead TakeForm(const Ingredients& from, const BaseSkin& skin, const BaseParts& parts) {
  const HeadForm form(from.eye, from.mouth, from.sliders, from.warp ? &*from.warp : nullptr,
                      from.photo ? from.photo->eyes : std::nullopt, parts.mesh,
                      from.photo ? EyeTransform{} : from.identity.eyes);
  FormedHead head{parts.mesh, parts.mesh.position, parts.mesh.position.size(),
                  form.eye_transforms(), form.teeth()};
  form.Shape(head.mesh);
  AddHair(from, skin, head.mesh);
  head.base.insert(head.base.end(),
                   head.mesh.position.begin() + static_cast<std::ptrdiff_t>(head.hair_first),
                   head.mesh.position.end());
  return head;
}

HeadTopology TopologyOf(const Ingredients& from, const BaseSkin& skin, const BaseParts& parts,
                        const FormedHead& head) {
  HeadTopology topology;
  SetParts(head.mesh.batches, topology);
  topology.skin_hairs = parts.skin_hairs;
  topology.mouth = skin.mouth;
  topology.albedo = head.mesh.albedo;
  for (glm::vec3& colour : topology.albedo) colour = glm::clamp(colour, 0.0f, 1.0f);
  topology.openness = head.mesh.openness;
  if (std::ranges::any_of(head.mesh.opacity, [](float opacity) { return opacity < 1; })) {
    topology.opacity = head.mesh.opacity;
  }
  topology.strands = head.mesh.strands;
  for (const glm::vec3 p : head.base) topology.uv.push_back(Unroll(p));
  for (const Side side : kSides) {
    const float size = head.eyes[side].size;
    topology.eyes[side] = {
        .centre = EyePointInFace(from.eye, head.eyes, side, from.eye.CentreOf(side)),
        .ball_radius = size * from.eye.radius(),
        .iris_radius = size * from.eye.iris_radius(),
        .pupil_radius = size * from.eye.pupil_radius(),
        .iris_colour = from.identity.palette.iris,
        .white_colour = from.identity.palette.sclera};
  }
  return topology;
}

RigData RigOf(const Ingredients& from, const BaseSkin& skin, const FormedHead& head,
              const HeadTopology& topology) {
  using enum RigStep;
  const Identity& identity = from.identity;
  RigData rig;
  // Lips meet where the teeth let them; skin that follows them is pushed off the teeth again.
  rig.steps = {kChannels, kLids,  kJaw,  kTeeth,   kLips,   kTeeth,
               kTongue,   kBones, kNeck, kSprings, kNormals};
  rig.rest = head.mesh.position;
  rig.rest_normal = Normals(topology.indices, rig.rest, rig.rest.size());
  HairLook(identity).LightAsOne(std::span(rig.rest).subspan(head.hair_first),
                                std::span(rig.rest_normal).subspan(head.hair_first));
  rig.bone = head.mesh.bone;
  for (const BakeWeights& vertex : head.mesh.weights) rig.weights.push_back(vertex.skin);
  rig.units = BuiltInUnits();
  rig.units.Add(identity.units);
  if (from.asymmetric) {
    rig.asymmetry_seed = static_cast<int>(identity.index);
    rig.units.MakeAsymmetric(*rig.asymmetry_seed);
  }
  rig.units_by_place = true;
  rig.creases = {.at_rest = identity.creases, .depth = from.photo ? from.photo->lined : 1};
  const std::span<const BakeWeights> weights = head.mesh.weights;
  rig.channels = UnitChannels(rig.units, rig.bone, rig.weights);
  std::ranges::move(MouthChannels(from.mouth, weights), std::back_inserter(rig.channels));
  rig.lids = BakeLids(from.eye, head.eyes, rig.rest, weights);
  rig.lips = BakeLips(skin.mouth, weights);
  rig.teeth = BakeTeeth(Moved(from.mouth.upper_teeth(), head.teeth),
                        Moved(from.mouth.lower_teeth(), head.teeth), rig.rest, weights);
  for (const Side side : kSides) rig.eyes.pivot[side] = topology.eyes[side].centre;
  for (std::size_t i = 0; i < topology.indices.size(); i += 3) {
    const std::uint32_t* const corner = &topology.indices[i];
    if (rig.bone[*corner] != Bone::kSkin) continue;
    rig.normals.soft_triangles.insert(rig.normals.soft_triangles.end(), corner, corner + 3);
  }
  if (!identity.crop) {
    AddHairSprings(Table("tables/hair_springs.txt", embedded::hair_springs()), head.hair_first,
                   rig);
  }
  return rig;
}

/// Maps the photo onto the skin, evaluated with lids open and shut.
void Wear(const Ingredients& from, const BaseSkin& skin, const FormedHead& formed,
          HeadAsset& asset) {
  const std::size_t count = skin.mesh.position.size();
  const Rig rig(asset.rig);
  HeadVertices open, shut;
  rig.Evaluate({}, open);
  FaceState asleep;
  asleep.blink.left = asleep.blink.right = 1;
  rig.Evaluate(asleep, shut);
  const auto pose = [count](const HeadVertices& v) {
    return SkinPose{std::span(v.position).first(count), std::span(v.normal).first(count)};
  };
  const PhotoSkin worn{std::span(formed.mesh.weights).first(count), skin.fine.tag, pose(open),
                       pose(shut)};
  WearPhoto(*from.photo, worn, from.identity.palette.lip_inside, asset.topology);
}

std::unique_ptr<Head> Bake(const Ingredients& from) {
  const BaseSkin skin = MakeSkin(from);
  const BaseParts parts = LayParts(from, skin);
  const FormedHead formed = TakeForm(from, skin, parts);
  HeadAsset asset;
  asset.topology = TopologyOf(from, skin, parts, formed);
  asset.rig = RigOf(from, skin, formed, asset.topology);
  FindIncisors(asset.rig.rest, asset.rig.bone, asset.topology);
  if (from.photo) Wear(from, skin, formed, asset);
  asset.landmarks = NameLandmarks(skin.cage, skin.fine, asset.rig.rest, from.eye, formed.eyes,
                                  from.identity.UsedFeatures());
  return std::make_unique<Head>(std::move(asset));
}

}  // namespace

std::unique_ptr<Head> MakeHead(std::string_view identity, bool asymmetric) {
  return MakeHead(BuiltInIdentity(identity), asymmetric);
}

std::unique_ptr<Head> MakeHead(Identity identity, bool asymmetric) {
  return Bake(Ingredients(std::move(identity), asymmetric));
}

std::unique_ptr<Head> MakeHead(const PhotoHead& head) {
  if (!head.photo) throw std::runtime_error("a head of a photo without its photo");
  return Bake(Ingredients(head));
}

Rig MakeSkinRig(const PhotoHead& head) {
  const Ingredients from(head);
  const BaseSkin skin = MakeSkin(from);
  const BaseParts alone{skin.mesh, {}};
  const FormedHead formed = TakeForm(from, skin, alone);
  return Rig(RigOf(from, skin, formed, TopologyOf(from, skin, alone, formed)));
}

}  // namespace fsm
