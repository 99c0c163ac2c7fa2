#include "fsm/head/head_baker.h"

#include <algorithm>
#include <glm/common.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "embedded/action_units.h"
#include "embedded/curves.h"
#include "embedded/eye.h"
#include "embedded/hair_springs.h"
#include "embedded/mouth.h"
#include "embedded/patches.h"
#include "embedded/sliders.h"
#include "fsm/head/face_channels.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/hair_springs.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/make_head.h"
#include "fsm/head/own_identity.h"
#include "fsm/head/parts.h"

namespace fsm {

HeadBaker::HeadBaker(Identity identity, bool asymmetric)
    : identity_(std::move(identity)),
      eye_(Table("tables/eye.txt", embedded::eye())),
      mouth_(Table("tables/mouth.txt", embedded::mouth())),
      shaper_(Table("tables/sliders.txt", embedded::sliders()), identity_.sliders),
      asymmetric_(asymmetric) {}

HeadAsset HeadBaker::Bake() {
  AddSkin();
  AddParts();
  TakeForm();
  HeadAsset asset;
  BakeTopology(asset.topology);
  BakeRig(asset.topology, asset.rig);
  FindIncisors(asset.rig.rest, asset.rig.bone, asset.topology);
  Complete(asset);
  asset.landmarks =
      NameLandmarks(cage_, fine_, asset.rig.rest, eye_, eye_transforms_, identity_.Look());
  return asset;
}

RigData HeadBaker::BakeSkin() {
  AddSkin();
  figure_end_ = soft_count_ = skin_count_;
  TakeForm();
  HeadTopology topology;
  RigData rig;
  BakeTopology(topology);
  BakeRig(topology, rig);
  return rig;
}

void HeadBaker::AddFigure() { BuildCloth(identity_.Look(), identity_.palette, mesh_); }

void HeadBaker::AddHair() {
  if (identity_.crop) {
    BuildCroppedHair(*identity_.crop, identity_.Look(), identity_.palette, mesh_);
  } else {
    BuildLongHair(identity_.long_hair, identity_.Look(), identity_.palette, mesh_);
  }
}

void HeadBaker::AddHairline() {
  const auto hairs =
      identity_.crop
          ? CroppedHairline(*identity_.crop, identity_.Look(), identity_.palette, mesh_)
          : LongHairline(identity_.long_hair, identity_.Look(), identity_.palette, mesh_);
  skin_hairs_.insert(skin_hairs_.end(), hairs.begin(), hairs.end());
}

void HeadBaker::AddEars() {
  if (identity_.crop)
    BuildEars(identity_.Look(), identity_.palette, mesh_);  // long hair covers them
}

void HeadBaker::AddLashes() { BuildLashes(eye_, identity_, false, mesh_); }

HeadForm HeadBaker::Form() const {
  return HeadForm(eye_, mouth_, shaper_, nullptr, std::nullopt, mesh_, identity_.eyes);
}

void HeadBaker::AddSkin() {
  cage_ = ReadCage(Table("tables/curves.txt", embedded::curves()),
                   Table("tables/patches.txt", embedded::patches()), eye_, mouth_);
  fine_ = Subdivide(cage_);
  skin_ = BuildSkin(fine_, eye_, mouth_, identity_, mesh_);
  skin_count_ = mesh_.position.size();
}

void HeadBaker::AddParts() {
  const Palette& palette = identity_.palette;
  AddFigure();
  figure_end_ = mesh_.position.size();
  const SkinFront front(fine_);
  skin_hairs_ = BuildBrows(front, identity_, mesh_);
  const auto folds = BuildLidFolds(front, eye_, identity_.Look());
  skin_hairs_.insert(skin_hairs_.end(), folds.begin(), folds.end());
  AddHairline();
  AddLashes();
  soft_count_ = mesh_.position.size();
  BuildEyes(eye_, identity_.Look(), palette, mesh_);
  BuildTeeth(mouth_, identity_.Look(), palette, mesh_);
  BuildTongue(mouth_, identity_.Look(), palette, mesh_);
  AddEars();
}

void HeadBaker::TakeForm() {
  base_ = mesh_.position;
  const HeadForm form = Form();
  form.Shape(skin_count_, FixedEnd(), mesh_);
  eye_transforms_ = form.eye_transforms();
  teeth_ = form.teeth();
  hair_first_ = mesh_.position.size();
  AddHair();
  base_.insert(base_.end(), mesh_.position.begin() + static_cast<std::ptrdiff_t>(base_.size()),
               mesh_.position.end());
}

void HeadBaker::BakeTopology(HeadTopology& topology) {
  for (const HeadMesh::Batch& batch : mesh_.batches) {
    topology.parts.push_back({batch.material, static_cast<std::uint32_t>(topology.indices.size()),
                              static_cast<std::uint32_t>(batch.indices.size())});
    topology.indices.insert(topology.indices.end(), batch.indices.begin(), batch.indices.end());
  }
  topology.skin_hairs = std::move(skin_hairs_);
  topology.mouth.lips = skin_.seam;
  topology.mouth.corner_right = skin_.corner_right;
  topology.mouth.corner_left = skin_.corner_left;
  topology.albedo = std::move(mesh_.albedo);
  topology.occlusion = std::move(mesh_.occlusion);
  if (std::ranges::any_of(mesh_.opacity, [](float opacity) { return opacity < 1; })) {
    topology.opacity = std::move(mesh_.opacity);
  }
  topology.strands = std::move(mesh_.strands);
  for (glm::vec3& colour : topology.albedo) colour = glm::clamp(colour, 0.0f, 1.0f);
  for (const glm::vec3 p : base_) topology.uv.push_back(Unroll(p));
  BakeEyes(topology);
}

void HeadBaker::BakeEyes(HeadTopology& topology) const {
  for (const Side side : kSides) {
    const float size = eye_transforms_[side].size;
    topology.eyes[side] = {.centre = PlaceInFace(eye_, eye_transforms_, side,
                                                 eye_.centre() * glm::vec3(SignOf(side), 1, 1)),
                           .ball_radius = size * eye_.radius(),
                           .iris_radius = size * eye_.iris_radius(),
                           .pupil_radius = size * eye_.pupil_radius(),
                           .iris_colour = identity_.palette.iris,
                           .white_colour = identity_.palette.sclera};
  }
}

void HeadBaker::BakeRig(const HeadTopology& topology, RigData& rig) {
  using enum RigStep;
  rig.steps = {kChannels, kLids,  kJaw,  kTeeth,   kLips,   kTeeth,
               kTongue,   kBones, kNeck, kSprings, kNormals};
  rig.rest = std::move(mesh_.position);
  rig.rest_normal = Normals(topology.indices, rig.rest, rig.rest.size());
  HairLook(identity_.Look(), identity_.palette)
      .LightAsOne(std::span(rig.rest).subspan(hair_first_),
                  std::span(rig.rest_normal).subspan(hair_first_));
  rig.bone = std::move(mesh_.bone);
  rig.weights = std::move(mesh_.weights);
  for (std::size_t i = 0; i < topology.indices.size(); i += 3) {
    if (topology.indices[i] >= soft_count_) continue;
    rig.soft_triangles.insert(rig.soft_triangles.end(), &topology.indices[i],
                              &topology.indices[i] + 3);
  }
  rig.units = UnitTable(Table("tables/action_units.txt", embedded::action_units()));
  if (asymmetric_) {
    rig.person = static_cast<int>(identity_.index);
    rig.units.MakeAsymmetric(*rig.person);
  }
  rig.units_by_place = true;
  const auto soft = std::span<const SkinWeights>(rig.weights).first(soft_count_);
  rig.channels = UnitChannels(rig.units, rig.bone, rig.weights);
  std::ranges::move(MouthChannels(mouth_, soft), std::back_inserter(rig.channels));
  rig.lids = BakeLids(eye_, eye_transforms_, rig.rest, soft);
  rig.lips = BakeLips(skin_, soft);
  rig.upper_teeth = mouth_.UpperTeeth().Moved(teeth_);
  rig.lower_teeth = mouth_.LowerTeeth().Moved(teeth_);
  rig.teeth_contacts = BakeTeethContacts(rig.upper_teeth, rig.lower_teeth, rig.rest, soft);
  for (const Side side : kSides) {
    rig.eye_pivot[side] = rig.ball_centre[side] = topology.eyes[side].centre;
  }
  rig.creases = identity_.creases;
  if (!identity_.crop) {
    AddHairSprings(Table("tables/hair_springs.txt", embedded::hair_springs()), hair_first_, rig);
  }
}

std::unique_ptr<Head> MakeHead(std::string_view identity, bool asymmetric) {
  return MakeHead(BuiltInIdentity(identity), asymmetric);
}

std::unique_ptr<Head> MakeHead(Identity identity, bool asymmetric) {
  return std::make_unique<Head>(HeadBaker(std::move(identity), asymmetric).Bake());
}

std::unique_ptr<Head> MakeGenericHead() { return MakeHead(Identities().front().name); }

}  // namespace fsm
