#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <stdexcept>

#include "fsm/head/deformer.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/shape_mix.h"

namespace fsm {
namespace {

JawMove JawOf(const Pose& pose) {
  return {.open_rad = pose.jaw_rad, .slide_mm = pose.jaw_slide_mm, .sway_mm = pose.jaw_sway_mm};
}

/// The state without what moves the head as a whole.
FaceState FaceOnly(FaceState state) {
  state.head_rotation = {};
  state.head_forward = 0;
  return state;
}

class Still : public MeshMotion {
 public:
  JawMove Move(const FaceState&, const Pose& pose, std::span<glm::vec3>) const override {
    return JawOf(pose);
  }
};

class Carried : public MeshMotion {
 public:
  Carried(const MeshModel& model, std::unique_ptr<Head> source, std::span<const PlacePair> pairs)
      : source_(std::move(source)),
        rest_(Rest(*source_)),
        carry_({rest_, FleshOf(source_->topology())},
               {model.position, model.FleshTriangles(), model.sewn}, pairs) {}

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    HeadVertices moved;
    source_->Evaluate(FaceOnly(state), moved);
    for (std::size_t i = 0; i < rest_.size(); ++i) moved.position[i] -= rest_[i];
    carry_.Apply(moved.position, position);
    return JawOf(pose);
  }

 private:
  static std::vector<glm::vec3> Rest(const Head& head) {
    HeadVertices rest;
    head.Evaluate({}, rest);
    return std::move(rest.position);
  }

  std::unique_ptr<Head> source_;
  std::vector<glm::vec3> rest_;
  Carry carry_;
};

class OwnShapes : public MeshMotion {
 public:
  OwnShapes(const HeadFile& file, const Similarity& place, std::shared_ptr<const Head> source,
            std::span<const ShapeMeaning> meanings)
      : source_(std::move(source)) {
    HeadVertices vertices;
    source_->Evaluate({}, vertices);
    rest_ = vertices.position;
    ChooseProbes();
    std::map<std::string, const FaceState*> known;
    for (const ShapeMeaning& meaning : meanings) known.emplace(meaning.name, &meaning.state);
    std::vector<std::vector<float>> keys;
    for (const auto& shape : file.shapes) {
      const auto found = known.find(PlainShapeName(shape.name));
      if (found == known.end()) continue;
      keys.push_back(Look(*found->second));
      std::vector<HeadFile::Shape::Delta> deltas = shape.deltas;
      for (auto& delta : deltas) delta.by = place.scale * (place.turn * delta.by);
      shapes_.push_back(std::move(deltas));
    }
    mix_ = ShapeMix(std::move(keys));
  }

  std::size_t count() const { return shapes_.size(); }

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    const auto weights = mix_.TakeApart(Look(FaceOnly(state))).weights;
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      if (weights[k] == 0) continue;
      for (const auto& delta : shapes_[k]) position[delta.vertex] += weights[k] * delta.by;
    }
    return JawOf(pose);
  }

 private:
  /// Some vertices of the face, a few millimetres from each other.
  void ChooseProbes() {
    constexpr float kApart = 5;
    for (const std::uint32_t v : FleshOf(source_->topology())) {
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
  ShapeMix mix_;
};

}  // namespace

std::vector<std::uint32_t> FleshOf(const HeadTopology& topology) {
  std::vector<std::uint32_t> flesh;
  for (const auto& part : topology.parts) {
    if (part.material != Material::kSkin && part.material != Material::kLip &&
        part.material != Material::kMouthInside) {
      continue;
    }
    const auto first = topology.indices.begin() + part.first_index;
    flesh.insert(flesh.end(), first, first + part.index_count);
  }
  return flesh;
}

std::unique_ptr<MeshMotion> StillMotion() { return std::make_unique<Still>(); }

std::unique_ptr<MeshMotion> CarriedMotion(const MeshModel& model, std::unique_ptr<Head> source,
                                          std::span<const PlacePair> pairs) {
  return std::make_unique<Carried>(model, std::move(source), pairs);
}

std::unique_ptr<MeshMotion> OwnShapesMotion(const HeadFile& file, const Similarity& place,
                                            std::shared_ptr<const Head> source,
                                            std::span<const ShapeMeaning> meanings) {
  auto motion = std::make_unique<OwnShapes>(file, place, std::move(source), meanings);
  if (motion->count() < 4) return nullptr;
  return motion;
}

}  // namespace fsm
