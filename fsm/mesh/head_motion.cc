#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "fsm/mesh/head_file.h"
#include "fsm/mesh/nnls_solver.h"
#include "fsm/rig/pose.h"

namespace fsm {
namespace {

/// The state without what moves the head as a whole.
FaceState FaceOnly(FaceState state) {
  state.head_rotation = {};
  state.head_forward = 0;
  return state;
}

std::vector<std::uint32_t> TrianglesOf(const HeadTopology& topology,
                                       std::initializer_list<Material> materials) {
  std::vector<std::uint32_t> out;
  for (const auto& part : topology.parts) {
    if (std::ranges::find(materials, part.material) == materials.end()) continue;
    const auto first = topology.indices.begin() + part.first_index;
    out.insert(out.end(), first, first + part.index_count);
  }
  return out;
}

class TransferredRig : public Deformation {
 public:
  TransferredRig(const MeshModel& model, std::unique_ptr<Head> source,
                 std::span<const PlacePair> pairs)
      : source_(std::move(source)),
        rest_(Rest(*source_)),
        carry_({rest_, SkinTriangles(source_->topology()), false,
                EyeballTriangles(source_->topology())},
               {model.position, model.SkinTriangles(), model.has_uv_seams, model.EyeTriangles()},
               pairs) {}

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    HeadVertices moved;
    source_->Evaluate(FaceOnly(state), moved);
    for (std::size_t i = 0; i < rest_.size(); ++i) moved.position[i] -= rest_[i];
    carry_.Apply(moved.position, position);
    return pose.jaw;
  }

  std::unique_ptr<Deformation> WithUnits(const UnitTable& units) const override {
    auto other = std::make_unique<TransferredRig>(*this);
    other->source_ = source_->WithUnits(units);
    return other;
  }

 private:
  static std::vector<glm::vec3> Rest(const Head& head) {
    HeadVertices rest;
    head.Evaluate({}, rest);
    return std::move(rest.position);
  }

  std::shared_ptr<const Head> source_;
  std::vector<glm::vec3> rest_;
  DeformationTransfer carry_;
};

class BlendshapeRig : public Deformation {
 public:
  BlendshapeRig(const HeadFile& file, const Similarity& place, const MeshModel& model,
                std::shared_ptr<const Head> source, std::span<const ShapeMeaning> meanings)
      : source_(std::move(source)) {
    HeadVertices vertices;
    source_->Evaluate({}, vertices);
    rest_ = vertices.position;
    ChooseProbes();
    std::map<std::string, const FaceState*> known;
    for (const ShapeMeaning& meaning : meanings) known.emplace(meaning.name, &meaning.state);
    std::set<std::string> given;
    for (const auto& shape : file.shapes) given.insert(PlainShapeName(shape.name));
    std::vector<std::vector<float>> keys;
    for (const auto& shape : file.shapes) {
      const std::string name = PlainShapeName(shape.name);
      std::vector<HeadFile::Shape::Delta> deltas = shape.deltas;
      for (auto& delta : deltas) delta.by = place.scale * (place.turn * delta.by);
      if (file.look_by_shape) {
        const auto look = std::ranges::find(kLooks, name);
        if (look != std::end(kLooks)) {
          looks_[static_cast<std::size_t>(look - std::begin(kLooks))] = std::move(deltas);
          continue;
        }
      }
      auto found = known.find(name);
      // Avatars made for face tracking have expressions called as ARKit's shapes.
      if (found == known.end() && name.starts_with("vrm") && !given.contains(name.substr(3))) {
        found = known.find(name.substr(3));
      }
      if (found == known.end()) continue;
      // Eyes turn by themselves.
      if (name.find("eyelook") != std::string::npos && model.has_eyes) {
        std::erase_if(deltas, [&](const auto& delta) { return IsEye(model.bone[delta.vertex]); });
      }
      keys.push_back(Look(*found->second));
      opens_mm_.push_back(OpensOnlyMouth(keys.back())
                              ? source_->MeasureMouth(FaceOnly(*found->second)).gap_mm
                              : 0.0f);
      // ARKit's closes what jawOpen opens, and means nothing without it.
      if (name == "mouthclose") closes_ = shapes_.size();
      shapes_.push_back(std::move(deltas));
    }
    mix_ = NnlsSolver(std::move(keys));
    if (file.look) ranges_ = *file.look;
  }

  std::size_t count() const { return shapes_.size(); }

  /// Teeth and tongues that the shapes move are not moved with the jaw as well.
  void FreeWhatMoves(const HeadFile& file, MeshModel& model) const {
    std::vector<bool> moves(model.position.size(), false);
    for (const auto& shape : shapes_) {
      for (const auto& delta : shape) moves[delta.vertex] = true;
    }
    for (const auto& part : file.parts) {
      if (std::ranges::none_of(part.indices, [&](std::uint32_t v) { return moves[v]; })) continue;
      for (const std::uint32_t v : part.indices) {
        if (!IsEye(model.bone[v])) model.bone[v] = Bone::kSkin;
      }
    }
  }

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    std::vector<float> weights = mix_.TakeApart(Look(FaceOnly(state))).weights;
    HoldShut(source_->MeasureMouth(FaceOnly(state)).gap_mm, weights);
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      if (weights[k] == 0) continue;
      for (const auto& delta : shapes_[k]) position[delta.vertex] += weights[k] * delta.by;
    }
    LookByShape(pose, position);
    return pose.jaw;
  }

  /// The shapes keep the meaning they have by the built-in units, and are mixed to look as these
  /// do.
  std::unique_ptr<Deformation> WithUnits(const UnitTable& units) const override {
    auto other = std::make_unique<BlendshapeRig>(*this);
    other->source_ = source_->WithUnits(units);
    return other;
  }

 private:
  /// In this order LookByShape takes them.
  static constexpr const char* kLooks[] = {"vrmlookleft", "vrmlookright", "vrmlookup",
                                           "vrmlookdown"};
  static bool IsEye(Bone bone) { return bone == Bone::kEyeRight || bone == Bone::kEyeLeft; }

  /// Whether what a look moves lies below the nose.
  bool OpensOnlyMouth(const std::vector<float>& look) const {
    constexpr float kBelow = -10, kRest = 0.1f;
    float above = 0, all = 0;
    for (std::size_t i = 0; i < look.size(); ++i) {
      all += look[i] * look[i];
      if (rest_[probes_[i / 3]].y > kBelow) above += look[i] * look[i];
    }
    return above < kRest * all;
  }

  /// Few shapes mixed to a mouth that is shut are as near to it a little open, but p, b and m must
  /// shut: what opens nothing but the mouth opens it no wider than ours.
  void HoldShut(float wanted_mm, std::vector<float>& weights) const {
    if (closes_ && weights[*closes_] > 0.05f) return;
    float open = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) open += weights[k] * opens_mm_[k];
    if (open <= std::max(wanted_mm, 1e-3f)) return;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (opens_mm_[k] > 0) weights[k] *= wanted_mm / open;
    }
  }

  void LookByShape(const Pose& pose, std::span<glm::vec3> position) const {
    const Gaze right = GazeOf(pose.eye[0]), left = GazeOf(pose.eye[1]);
    // Both eyes go with one shape; the agent's left is to the viewer's right.
    const float side = 0.5f * (right.right_deg + left.right_deg);
    const float up = 0.5f * (right.up_deg + left.up_deg);
    const auto add = [&](std::size_t look, float angle, const LookRange& range) {
      const float weight =
          std::clamp(angle / range.gaze_deg, 0.0f, 1.0f) * std::min(range.turn, 1.0f);
      for (const auto& delta : looks_[look]) position[delta.vertex] += weight * delta.by;
    };
    add(0, side, ranges_.outer);
    add(1, -side, ranges_.outer);
    add(2, up, ranges_.up);
    add(3, -up, ranges_.down);
  }

  /// Some vertices of the face, a few millimetres from each other.
  void ChooseProbes() {
    constexpr float kApart = 5;
    for (const std::uint32_t v : SkinTriangles(source_->topology())) {
      const glm::vec3 p = rest_[v];
      if (p.z < 30 || p.y < -105 || p.y > 75) continue;
      if (std::ranges::none_of(
              probes_, [&](std::uint32_t w) { return glm::distance(rest_[w], p) < kApart; })) {
        probes_.push_back(v);
      }
    }
  }

  std::vector<float> Look(const FaceState& state) const {
    HeadVertices vertices;
    source_->Evaluate(state, vertices);
    std::vector<float> look;
    look.reserve(3 * probes_.size());
    for (const std::uint32_t v : probes_) {
      for (int c = 0; c < 3; ++c) look.push_back(vertices.position[v][c] - rest_[v][c]);
    }
    return look;
  }

  std::shared_ptr<const Head> source_;
  std::vector<glm::vec3> rest_;
  std::vector<std::uint32_t> probes_;
  std::vector<std::vector<HeadFile::Shape::Delta>> shapes_;
  std::vector<float> opens_mm_;  // of each shape that moves only the mouth, else 0
  std::optional<std::size_t> closes_;
  std::array<std::vector<HeadFile::Shape::Delta>, 4> looks_;
  LookRanges ranges_;
  NnlsSolver mix_;
};

}  // namespace

std::vector<std::uint32_t> SkinTriangles(const HeadTopology& topology) {
  return TrianglesOf(topology, {Material::kSkin, Material::kLip, Material::kMouthInside});
}

std::vector<std::uint32_t> EyeballTriangles(const HeadTopology& topology) {
  return TrianglesOf(topology, {Material::kSclera, Material::kIris, Material::kPupil});
}

std::unique_ptr<Deformation> CarriedMotion(const MeshModel& model, std::unique_ptr<Head> source,
                                           std::span<const PlacePair> pairs) {
  try {
    return std::make_unique<TransferredRig>(model, std::move(source), pairs);
  } catch (const std::runtime_error& error) {
    if (model.name.empty()) throw;
    throw std::runtime_error(model.name + ": " + error.what());
  }
}

std::unique_ptr<Deformation> OwnShapesMotion(const HeadFile& file, const Similarity& place,
                                             MeshModel& model, std::shared_ptr<const Head> source,
                                             std::span<const ShapeMeaning> meanings) {
  auto motion = std::make_unique<BlendshapeRig>(file, place, model, std::move(source), meanings);
  if (motion->count() < 4) return nullptr;
  motion->FreeWhatMoves(file, model);
  return motion;
}

}  // namespace fsm
