#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fsm/head/built_in_units.h"
#include "fsm/head/deformer.h"
#include "fsm/mesh/mesh_model.h"

namespace fsm {
namespace {

class MeshHead : public Head {
 public:
  MeshHead(MeshModel model, std::unique_ptr<MeshMotion> motion)
      : model_(std::move(model)), motion_(std::move(motion)) {
    for (const auto& batch : model_.batches) {
      topology_.parts.push_back(
          {batch.material, static_cast<std::uint32_t>(topology_.indices.size()),
           static_cast<std::uint32_t>(batch.indices.size()), batch.finish, batch.two_sided});
      topology_.indices.insert(topology_.indices.end(), batch.indices.begin(), batch.indices.end());
    }
    if (topology_.indices.empty()) throw std::runtime_error("the head has no triangles");
    topology_.albedo = model_.albedo;
    topology_.occlusion.assign(model_.position.size(), 1);
    for (const glm::vec3& p : model_.position) topology_.uv.push_back(Unroll(p));
    topology_.photo = model_.photo;
    topology_.photo_texcoord = model_.photo_texcoord;
    topology_.finishes = model_.finishes;
    topology_.relief = model_.relief;
    topology_.lights = model_.lights;
    topology_.eyes = model_.eyes;
    if (model_.has_eyes && model_.round_eyes) FindLids();
    if (!topology_.finishes.empty()) FindUvSeams();
  }

  const HeadTopology& topology() const override { return topology_; }

  void Evaluate(const FaceState& state, HeadVertices& out) const override {
    const Pose pose = MakePose(state, units_);
    out.position = model_.position;
    const JawMove jaw = motion_->Move(state, pose, out.position);
    const std::array<glm::mat3, 2> eye{EyeTurn(pose, 0), EyeTurn(pose, 1)};
    for (const Lid& lid : lids_) {
      glm::vec3& p = out.position[lid.vertex];
      const glm::vec3 off = p - model_.eyes[lid.side].centre;
      const float far = glm::length(off);
      if (far < lid.least && far > 1) p += off * (lid.least / far - 1);
    }
    for (std::size_t i = 0; i < out.position.size(); ++i) {
      glm::vec3& p = out.position[i];
      switch (model_.bone[i]) {
        case Bone::kEyeRight:
        case Bone::kEyeLeft: {
          const std::size_t side = model_.bone[i] == Bone::kEyeRight ? 0 : 1;
          const glm::vec3 centre =
              model_.eye_pivot ? (*model_.eye_pivot)[side] : model_.eyes[side].centre;
          p = centre + eye[side] * (p - centre);
          break;
        }
        case Bone::kJaw:
        case Bone::kTongue:
          p = TurnWithJaw(p, jaw);
          break;
        default:
          break;
      }
      p = TurnHead(p, pose, model_.neck[i]);
    }
    Normals(out);
    out.wrinkles = {};
  }

  MouthMeasure MeasureMouth(const FaceState& state) const override {
    if (model_.seam.empty()) return {};
    const Pose pose = MakePose(state, units_);
    std::vector<glm::vec3> position = model_.position;
    const JawMove jaw = motion_->Move(state, pose, position);
    const auto [upper, lower] = model_.seam[model_.seam.size() / 2];
    return {.gap_mm = std::max(0.0F, position[upper].y - position[lower].y),
            .width_mm = glm::distance(position[model_.seam.front().first],
                                      position[model_.seam.back().first]),
            .jaw_degrees = glm::degrees(jaw.open_rad)};
  }

  std::unique_ptr<Head> WithUnits(const UnitTable& units) const override {
    auto other = std::make_unique<MeshHead>(*this);
    other->units_ = units;
    if (auto motion = motion_->WithUnits(units)) other->motion_ = std::move(motion);
    return other;
  }

  glm::vec3 Landmark(std::string_view name) const override {
    const auto found = model_.landmarks.find(name);
    return found == model_.landmarks.end() ? Head::Landmark(name) : found->second;
  }

 private:
  struct Lid {
    std::uint32_t vertex;
    std::uint8_t side;
    float least;  // distance from the ball's centre
  };

  glm::mat3 EyeTurn(const Pose& pose, std::size_t side) const {
    if (!model_.look) return pose.eye[side];
    const Gaze gaze = GazeOf(pose.eye[side]);
    // To the viewer's right is outward of the agent's left eye.
    const bool outward = (gaze.right_deg > 0) == (side == 1);
    const auto turned = [](float angle, const LookRange& range) {
      return std::copysign(std::min(std::abs(angle) / range.gaze_deg, 1.0F) * range.turn, angle);
    };
    const float right = turned(gaze.right_deg, outward ? model_.look->outer : model_.look->inner);
    const float up = turned(gaze.up_deg, gaze.up_deg > 0 ? model_.look->up : model_.look->down);
    return EyeTo({.right_deg = right, .up_deg = up});
  }

  /// Flesh outside a ball at rest stays outside, whatever moves it.
  void FindLids() {
    constexpr float kReach = 8, kThickness = 0.6F;
    for (std::uint32_t i = 0; i < model_.position.size(); ++i) {
      if (model_.bone[i] != Bone::kSkin) continue;
      for (std::uint8_t side = 0; side < 2; ++side) {
        const EyePlace& eye = model_.eyes[side];
        const float far = glm::distance(model_.position[i], eye.centre);
        if (far < eye.ball_radius - 0.5F || far > eye.ball_radius + kReach) continue;
        if (model_.position[i].z < eye.centre.z) continue;
        lids_.push_back({i, side, std::min(far, eye.ball_radius + kThickness)});
      }
    }
  }

  /// Where a texture is sewn together vertices are doubled; light must not show that. Two at one
  /// place that face the same way share a normal.
  void FindUvSeams() {
    HeadVertices rest;
    rest.position = model_.position;
    Normals(rest);
    std::vector<std::uint32_t> order(rest.position.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {}, [&](std::uint32_t i) {
      const glm::vec3 p = rest.position[i];
      return std::tuple(p.x, p.y, p.z, i);
    });
    seam_twin_.resize(order.size());
    std::iota(seam_twin_.begin(), seam_twin_.end(), 0U);
    constexpr float kFacesTheSameWay = 0.5F;  // cosine
    for (std::size_t k = 0; k < order.size(); ++k) {
      for (std::size_t j = k; j-- > 0;) {
        const std::uint32_t one = order[k], other = order[j];
        if (rest.position[one] != rest.position[other]) break;
        if (seam_twin_[other] != other ||
            glm::dot(rest.normal[one], rest.normal[other]) < kFacesTheSameWay) {
          continue;
        }
        seam_twin_[one] = other;
        break;
      }
    }
  }

  glm::vec3 TurnWithJaw(glm::vec3 p, const JawMove& jaw) const {
    const float c = std::cos(jaw.open_rad), s = std::sin(jaw.open_rad);
    const float y = p.y - model_.hinge.y, z = p.z - model_.hinge.z;
    return {p.x + jaw.sway_mm, model_.hinge.y + y * c - z * s,
            model_.hinge.z + z * c + y * s + jaw.slide_mm};
  }

  void Normals(HeadVertices& out) const {
    out.normal.assign(out.position.size(), glm::vec3(0));
    for (std::size_t i = 0; i + 2 < topology_.indices.size(); i += 3) {
      const std::uint32_t* t = &topology_.indices[i];
      const glm::vec3 a = out.position[t[0]];
      const glm::vec3 n = glm::cross(out.position[t[1]] - a, out.position[t[2]] - a);
      for (int k = 0; k < 3; ++k) out.normal[seam_twin_.empty() ? t[k] : seam_twin_[t[k]]] += n;
    }
    for (glm::vec3& n : out.normal) {
      const float squared = glm::dot(n, n);
      n = squared > 1e-12F ? n / std::sqrt(squared) : glm::vec3(0, 0, 1);
    }
    for (std::size_t i = 0; i < seam_twin_.size(); ++i) out.normal[i] = out.normal[seam_twin_[i]];
  }

  MeshModel model_;
  std::shared_ptr<const MeshMotion> motion_;
  UnitTable units_ = BuiltInUnits();
  HeadTopology topology_;
  std::vector<Lid> lids_;
  std::vector<std::uint32_t>
      seam_twin_;  // of each vertex the one whose normal it has; or none at all
};

}  // namespace

std::unique_ptr<Head> MakeMeshHead(MeshModel model, std::unique_ptr<MeshMotion> motion) {
  return std::make_unique<MeshHead>(std::move(model), std::move(motion));
}

}  // namespace fsm
