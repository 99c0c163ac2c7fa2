#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "embedded/action_units.h"
#include "embedded/curves.h"
#include "embedded/eye.h"
#include "embedded/mouth.h"
#include "embedded/patches.h"
#include "embedded/sliders.h"
#include "fsm/head/deformer.h"
#include "fsm/head/hair_parts.h"
#include "fsm/head/head.h"
#include "fsm/head/head_form.h"
#include "fsm/head/identity.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/own_identity.h"
#include "fsm/head/parts.h"
#include "fsm/head/photo_head.h"
#include "fsm/head/photo_wear.h"
#include "fsm/head/skin_mesh.h"
#include "fsm/head/tongue_way.h"

namespace fsm {
namespace {

/// Head::MakeGeneric: tables to mesh at construction, state to vertices in Evaluate. Vertices are
/// in one run of flesh, which is deformed and given new normals in every state, then the rigid
/// parts.
class GenericHead : public Head {
 public:
  GenericHead(Identity identity, bool asymmetric, const PhotoHead* set = nullptr)
      : identity_(std::move(identity)),
        units_(Table("tables/action_units.txt", embedded::action_units())),
        eye_(Table("tables/eye.txt", embedded::eye())),
        mouth_(Table("tables/mouth.txt", embedded::mouth())) {
    if (set) {
      warp_.emplace(set->points, set->smooth);
      identity_.palette.iris = set->iris_colour;
      identity_.palette.sclera = set->white_colour;
      Desaturate(identity_.palette, set->saturation);
      if (set->lip_colour) {
        // Where the lips turn inward the mouth is painted: it begins in their colour.
        constexpr float kOpen = 0.85f;
        identity_.palette.lip_inside = *set->lip_colour / kOpen;
        identity_.palette.mouth =
            0.9f * Wetter(identity_.palette.lip_inside, 0.5f * set->saturation);
      }
      lined_ = set->lined;
      eye_.ScaleIris(set->iris_size);
      // A photographer's light comes from the front and reaches into the mouth.
      // Teeth stand in the light whose hue the whites of the eyes show.
      const glm::vec3 white = set->white_colour;
      identity_.palette.tooth *=
          0.67f * set->teeth *
          glm::mix(glm::vec3(1), white / std::max({white.r, white.g, white.b, 1e-3f}), 0.5f);
      identity_.palette.tongue *= 0.85f * set->teeth;
    }
    asymmetric_ = asymmetric;
    if (asymmetric) units_.MakeAsymmetric(static_cast<int>(identity_.index));
    const Shaper shaper(Table("tables/sliders.txt", embedded::sliders()), identity_.sliders);
    const Cage cage = ReadCage(Table("tables/curves.txt", embedded::curves()),
                               Table("tables/patches.txt", embedded::patches()), eye_, mouth_);
    const FineSkin fine = Subdivide(cage);
    const Palette& palette = identity_.palette;
    HeadMesh mesh;
    const SkinMap skin = BuildSkin(fine, eye_, mouth_, palette, mesh);
    const std::size_t skin_count = mesh.position.size();
    if (set) {
      AddSheet(*set, mesh);
    } else {
      BuildCloth(palette, mesh);
    }
    const std::size_t sheet_end = mesh.position.size();
    const SkinFront front(fine);
    topology_.skin_hairs = BuildBrows(front, identity_, mesh);
    const auto folds = BuildLidFolds(front, eye_);
    topology_.skin_hairs.insert(topology_.skin_hairs.end(), folds.begin(), folds.end());
    // Of open eyes a photo shows the lashes.
    BuildLashes(eye_, identity_, set != nullptr, mesh);
    flesh_count_ = mesh.position.size();
    BuildEyes(eye_, palette, mesh);
    BuildTeeth(mouth_, palette, mesh);
    BuildTongue(mouth_, palette, mesh);
    if (identity_.crop && !set) BuildEars(palette, mesh);  // long hair covers them
    base_ = mesh.position;
    const HeadForm form(eye_, mouth_, shaper, warp_ ? &*warp_ : nullptr,
                        set ? set->eyes : std::nullopt, mesh);
    form.Shape(skin_count, set ? sheet_end : skin_count, mesh);
    seats_ = form.seats();
    teeth_ = form.teeth();
    hair_first_ = mesh.position.size();
    if (set) {
      LeaveOutUnseen(*set, fine.tag, mesh);
    } else if (identity_.crop) {
      BuildCroppedHair(*identity_.crop, palette, mesh);
    } else {
      BuildLongHair(palette, mesh);
    }
    base_.insert(base_.end(), mesh.position.begin() + static_cast<std::ptrdiff_t>(base_.size()),
                 mesh.position.end());
    if (set && set->glasses) HoldBehindGlasses(glm::vec2(eye_.centre()), skin_count, mesh);
    const std::vector<SkinWeights> flesh(
        mesh.flesh.begin(), mesh.flesh.begin() + static_cast<std::ptrdiff_t>(skin_count));
    Finish(std::move(mesh), skin);
    if (set) {
      HeadVertices open, shut;
      Evaluate({}, open);
      FaceState asleep;
      asleep.blink_left = asleep.blink_right = 1;
      Evaluate(asleep, shut);
      const auto pose = [skin_count](const HeadVertices& v) {
        return SkinPose{std::span(v.position).first(skin_count),
                        std::span(v.normal).first(skin_count)};
      };
      const PhotoSkin worn{flesh, fine.tag, pose(open), pose(shut)};
      WearPhoto(*set, worn, identity_.palette.lip_inside, topology_);
    }
    landmarks_ = NameLandmarks(cage, fine, rest_, eye_, seats_);
  }

  const HeadTopology& topology() const override { return topology_; }

  void Evaluate(const FaceState& state, HeadVertices& out) const override {
    const Pose pose = MakePose(state, units_);
    out.position.resize(rest_.size());
    out.normal.resize(rest_.size());
    face_->Deform(pose, out.position.data());
    const TongueWay tongue(pose, upper_teeth_, lower_teeth_, seam_, out.position.data());
    for (std::size_t i = 0; i < flesh_count_; ++i) {
      out.position[i] = TurnHead(out.position[i], pose, face_->neck(i));
    }
    SkinNormals(out);
    for (std::size_t i = flesh_count_; i < rest_.size(); ++i) MoveRigid(i, pose, tongue, out);
    out.wrinkles = CreaseDepths(pose.units, identity_.creases);
    for (auto& sides : out.wrinkles) {
      for (float& depth : sides) depth *= lined_;
    }
    for (std::size_t side = 0; side < 2; ++side) out.lids_shut[side] = pose.lids[side].close;
  }

  std::unique_ptr<Head> WithUnits(const UnitTable& units) const override {
    auto other = std::make_unique<GenericHead>(*this);
    other->units_ = units;
    if (asymmetric_) other->units_.MakeAsymmetric(static_cast<int>(identity_.index));
    other->face_->MoveBy(other->units_);
    other->probe_->MoveBy(other->units_);
    return other;
  }

  glm::vec3 Landmark(std::string_view name) const override {
    const auto found = landmarks_.find(name);
    if (found == landmarks_.end()) return Head::Landmark(name);
    return found->second;
  }

  MouthMeasure MeasureMouth(const FaceState& state) const override {
    const Pose pose = MakePose(state, units_);
    std::array<glm::vec3, 4> p;  // seam upper, seam lower, corner left, corner right
    assert(probe_->size() == p.size());
    probe_->Deform(pose, p.data());
    return {.gap_mm = std::max(0.0f, p[0].y - p[1].y),
            .width_mm = glm::length(p[2] - p[3]),
            .jaw_degrees = glm::degrees(pose.jaw_rad)};
  }

 private:
  /// What a grey photo does not show must be grey too.
  static void Desaturate(Palette& palette, float saturation) {
    for (glm::vec3* colour : {&palette.tooth, &palette.lip_inside, &palette.rim, &palette.mouth,
                              &palette.tongue, &palette.gum}) {
      *colour =
          glm::mix(glm::vec3(glm::dot(*colour, glm::vec3(0.3f, 0.6f, 0.1f))), *colour, saturation);
    }
  }

  void Finish(HeadMesh mesh, const SkinMap& skin) {
    for (const HeadMesh::Batch& batch : mesh.batches) {
      topology_.parts.push_back({batch.material,
                                 static_cast<std::uint32_t>(topology_.indices.size()),
                                 static_cast<std::uint32_t>(batch.indices.size())});
      topology_.indices.insert(topology_.indices.end(), batch.indices.begin(), batch.indices.end());
    }
    for (std::size_t i = 0; i < topology_.indices.size(); i += 3) {
      if (topology_.indices[i] >= flesh_count_) continue;
      skin_triangles_.insert(skin_triangles_.end(), &topology_.indices[i],
                             &topology_.indices[i] + 3);
    }
    rest_ = mesh.position;
    rest_normal_ = Normals(topology_.indices, rest_, rest_.size());
    LightAsOne(std::span(rest_).subspan(hair_first_), std::span(rest_normal_).subspan(hair_first_));
    for (const SkinWeights& flesh : mesh.flesh) bend_.push_back(flesh.free);

    seam_ = skin.seam;
    topology_.mouth = {.lips = skin.seam,
                       .corner_right = skin.corner_right,
                       .corner_left = skin.corner_left,
                       .upper_incisor = 0,
                       .lower_incisor = 0,
                       .upper_root = 0};
    FindIncisors(rest_, mesh.bone, topology_);
    upper_teeth_ = mouth_.UpperTeeth().Moved(teeth_);
    lower_teeth_ = mouth_.LowerTeeth().Moved(teeth_);
    const auto flesh_end = static_cast<std::ptrdiff_t>(flesh_count_);
    face_.emplace(std::vector<glm::vec3>(rest_.begin(), rest_.begin() + flesh_end),
                  std::vector<SkinWeights>(mesh.flesh.begin(), mesh.flesh.begin() + flesh_end),
                  skin.seam, units_, eye_, seats_, mouth_, teeth_);
    const auto [upper, lower] = skin.seam[skin.mid_column];
    std::vector<glm::vec3> rest;
    std::vector<SkinWeights> flesh;
    for (const std::uint32_t i : {upper, lower, skin.corner_left, skin.corner_right}) {
      rest.push_back(rest_[i]);
      flesh.push_back(mesh.flesh[i]);
      if (flesh.back().lip_column >= 0) flesh.back().lip_column = 0;
    }
    probe_.emplace(std::move(rest), std::move(flesh),
                   std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}}, units_, eye_,
                   seats_, mouth_, teeth_);
    bone_ = std::move(mesh.bone);
    topology_.albedo = std::move(mesh.albedo);
    topology_.occlusion = std::move(mesh.occlusion);
    topology_.strands = std::move(mesh.strands);
    for (glm::vec3& colour : topology_.albedo) colour = glm::clamp(colour, 0.0f, 1.0f);
    for (const glm::vec3 p : base_) topology_.uv.push_back(Unroll(p));
    for (std::size_t side = 0; side < 2; ++side) {
      const float size = seats_[side].size;
      topology_.eyes[side] = {
          .centre = Seated(eye_, seats_, side, eye_.centre() * glm::vec3(side == 0 ? -1 : 1, 1, 1)),
          .ball_radius = size * eye_.radius(),
          .iris_radius = size * eye_.iris_radius(),
          .pupil_radius = size * eye_.pupil_radius(),
          .iris_colour = identity_.palette.iris,
          .white_colour = identity_.palette.sclera};
    }
  }

  void SkinNormals(HeadVertices& out) const {
    std::fill_n(out.normal.begin(), flesh_count_, glm::vec3(0));
    Accumulate(skin_triangles_, out.position, std::span(out.normal.data(), flesh_count_));
  }

  void MoveRigid(std::size_t i, const Pose& pose, const TongueWay& tongue,
                 HeadVertices& out) const {
    glm::vec3 p = rest_[i];
    glm::vec3 n = rest_normal_[i];
    switch (bone_[i]) {
      case Bone::kEyeLeft:
      case Bone::kEyeRight: {
        const std::size_t side = bone_[i] == Bone::kEyeLeft ? 1 : 0;
        const glm::vec3 centre = topology_.eyes[side].centre;
        p = centre + pose.eye[side] * (p - centre);
        n = pose.eye[side] * n;
        break;
      }
      case Bone::kTongue: {
        const float tip = bend_[i];
        p.z += tongue.Part() * pose.tongue_out_mm * tip;
        p.y += pose.tongue_raise * 11 * tip * tip;
        p = tongue.Fit(TurnJaw(p, pose, 1 - 0.25f * pose.tongue_raise * tip));
        n = glm::normalize(TurnJaw(rest_[i] + n, pose, 1) - TurnJaw(rest_[i], pose, 1));
        break;
      }
      case Bone::kJaw:
        p = TurnJaw(p, pose, 1);
        n = glm::normalize(TurnJaw(rest_[i] + n, pose, 1) - p);
        break;
      case Bone::kSkull:
      case Bone::kSkin:
        break;
    }
    out.position[i] = TurnHead(p, pose, 1);
    out.normal[i] = pose.head * n;
  }

  Identity identity_;
  std::optional<Warp> warp_;  // of a face from a photo
  UnitTable units_;
  bool asymmetric_ = false;
  float lined_ = 1;  // of a photo's skin
  EyeAnatomy eye_;
  MouthAnatomy mouth_;
  TeethPlace teeth_;                   // from the base head's
  std::array<EyeTransform, 2> seats_;  // of the right and the left eye
  std::vector<glm::vec3> base_;        // the base head's rest form, for texture coordinates
  HeadTopology topology_;
  std::size_t flesh_count_ = 0;
  std::size_t hair_first_ = 0;
  std::vector<std::uint32_t> skin_triangles_;
  std::vector<glm::vec3> rest_, rest_normal_;
  std::vector<Bone> bone_;
  std::vector<float> bend_;
  Landmarks landmarks_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam_;  // of the lips, from -x to +x
  ToothArch upper_teeth_{}, lower_teeth_{};
  std::optional<Deformer> face_, probe_;
};

}  // namespace

glm::vec3 Head::Landmark(std::string_view name) const {
  throw std::out_of_range("there is no landmark '" + std::string(name) + "'");
}

std::unique_ptr<Head> Head::WithUnits(const UnitTable& /*units*/) const { return nullptr; }

std::unique_ptr<Head> Head::Make(std::string_view identity, bool asymmetric) {
  return MakeHead(BuiltInIdentity(identity), asymmetric);
}

std::unique_ptr<Head> Head::Make(const PhotoHead& set) {
  if (!set.photo) throw std::runtime_error("a face set without its photo");
  return std::make_unique<GenericHead>(BuiltInIdentity(set.base), true, &set);
}

std::unique_ptr<Head> MakeHead(Identity identity, bool asymmetric) {
  return std::make_unique<GenericHead>(std::move(identity), asymmetric);
}

std::unique_ptr<Head> Head::MakeGeneric() { return Make(Identities().front().name); }

}  // namespace fsm
