#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/base/spline.h"
#include "fsm/mesh/lip_seal.h"
#include "fsm/mesh/nnls_solver.h"
#include "fsm/mesh/original_expressions.h"
#include "fsm/mesh/original_face.h"
#include "fsm/mesh/original_points.h"
#include "fsm/rig/pose.h"

namespace fsm {
namespace {

constexpr int kEyesClosed = 43;

/// Of a viseme's offsets that the original shows for a full articulation: its MouthScale is 30 by
/// default, which stands for three quarters here. All of them are shown at 100.
constexpr float kVisemePart = 0.4f;

/// Mouths that show all of a viseme's offsets.
std::vector<NnlsSolver::Row> Rows(const VisemeMouths& mouths) {
  std::vector<NnlsSolver::Row> rows;
  for (const auto& mouth : mouths) {
    rows.emplace_back(mouth.begin(), mouth.end());
    for (float& value : rows.back()) value /= kVisemePart;
  }
  return rows;
}

/// Sounds move more parameters than this; Mouth.N moves one each.
constexpr std::ptrdiff_t kMostSetByHand = 3;
bool IsSetByHand(const std::array<float, kMouthParameters>& mouth) {
  return std::ranges::count_if(mouth, [](float v) { return v != 0; }) <= kMostSetByHand;
}

class OwnMotion : public Deformation {
 public:
  OwnMotion(const OriginalFace& face, const MeshModel& model, const VisemeMouths& mouths,
            const MouthUnitSizes& unit_sizes)
      : mix_(Rows(mouths)), unit_sizes_(unit_sizes), seal_(model, face.wireframe.at.size()) {
    // Units belong to the standard wireframe and grow with the face, so that its lids meet: across
    // with the distance of the eyes, up and down with the height from eyes to mouth. Mouths are
    // added as they are, as in the original: those of small faces move more.
    const OriginalFrame own(face.wireframe), standard(face.standard);
    const auto height = [](const OriginalFrame& frame, const PntFile& file) {
      return frame.EyeOpening(file, 0).y - frame.Place(file, kLipMiddle).y;
    };
    const float tall = height(own, face.wireframe) / height(standard, face.standard);
    const glm::vec3 mm = standard.mm() * glm::vec3(1, std::clamp(tall, 0.5f, 2.0f), 1);
    const auto fields = [](const std::vector<std::vector<glm::vec3>>& from, const glm::vec3& scale,
                           std::vector<Field>& to) {
      for (const auto& offsets : from) {
        Field field;
        for (std::uint32_t i = 0; i < offsets.size(); ++i) {
          const glm::vec3 by = offsets[i] * scale;
          if (glm::length(by) > 0.02f) field.push_back({i, by});
        }
        to.push_back(std::move(field));
      }
    };
    fields(face.units, mm, units_);
    fields(face.expression_rests, mm, expression_rests_);
    fields(face.mouth_units, glm::vec3(own.mm()), mouth_units_);
    fields(face.visemes, glm::vec3(own.mm()), visemes_);
    const float middle = 0.5f * (own.Place(face.wireframe, kLipCorners[0]).x +
                                 own.Place(face.wireframe, kLipCorners[1]).x);
    for (std::size_t i = 0; i < face.wireframe.at.size(); ++i) {
      left_.push_back(LeftPartAt(model.position[i].x - middle));
    }
    chin_ = face.wireframe.index.at(kChin);
    chin_rest_ = model.position[chin_];
    hinge_ = model.hinge;
  }

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    const std::array<float, 2> blink = {state.blink_right, state.blink_left};
    for (std::size_t k = 0; k < units_.size(); ++k) {
      const auto number = static_cast<std::size_t>(kUnitNumbers[k]);
      // As they are asked for: the original's units add up, ours damp and oppose each other.
      float right = Bound(state.au_right[number], 0, 2);
      float left = Bound(state.au_left[number], 0, 2);
      if (number == kEyesClosed) {
        right = std::max(right, Bound(blink[0], 0, 1));
        left = std::max(left, Bound(blink[1], 0, 1));
      }
      if (right == 0 && left == 0) continue;
      for (const Delta& d : units_[k]) {
        position[d.vertex] += (right + (left - right) * left_[d.vertex]) * d.by;
      }
    }
    const auto add = [&position](const Field& field, float weight) {
      if (weight == 0) return;
      for (const Delta& d : field) position[d.vertex] += weight * d.by;
    };
    for (std::size_t k = 0; k < expression_rests_.size(); ++k) {
      const auto [unit, is_left] = kExpressionChannels[k];
      add(expression_rests_[k], Bound(is_left ? state.au_left[unit] : state.au_right[unit], 0, 2));
    }
    if (IsSetByHand(state.mouth)) {
      for (std::size_t k = 0; k < mouth_units_.size(); ++k) {
        if (unit_sizes_[k] == 0) continue;
        add(mouth_units_[k], Bound(state.mouth[k] / unit_sizes_[k], 0, 2));
      }
    } else {
      const NnlsSolver::Parts parts = mix_.TakeApart(state.mouth);
      for (std::size_t k = 0; k < visemes_.size() && k < parts.weights.size(); ++k) {
        add(visemes_[k], parts.weights[k]);
      }
    }
    seal_.Close(pose.seal, position);
    const glm::vec3 before = chin_rest_ - hinge_, after = position[chin_] - hinge_;
    const float angle = std::atan2(-after.y, after.z) - std::atan2(-before.y, before.z);
    return {.open_rad = Bound(angle, 0, 0.5f), .slide_mm = 0, .sway_mm = after.x - before.x};
  }

 private:
  struct Delta {
    std::uint32_t vertex;
    glm::vec3 by;
  };
  using Field = std::vector<Delta>;

  static float Bound(float value, float low, float high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : 0.0f;
  }

  std::vector<Field> units_, expression_rests_, mouth_units_, visemes_;
  std::vector<float> left_;  // part of the agent's left side in a vertex
  NnlsSolver mix_;
  MouthUnitSizes unit_sizes_;
  LipSeal seal_;
  std::size_t chin_ = 0;
  glm::vec3 chin_rest_{}, hinge_{};
};

}  // namespace

std::unique_ptr<Deformation> OwnMotionOf(const OriginalFace& face, const MeshModel& model,
                                        const VisemeMouths& mouths,
                                        const MouthUnitSizes& unit_sizes) {
  return std::make_unique<OwnMotion>(face, model, mouths, unit_sizes);
}

}  // namespace fsm
