#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/base/spline.h"
#include "fsm/mesh/lip_seal.h"
#include "fsm/mesh/nnls_solver.h"
#include "fsm/mesh/original_face.h"
#include "fsm/mesh/original_points.h"
#include "fsm/rig/pose.h"

namespace fsm {
namespace {

/// FACS numbers of the original's units, in its order (its manual's list; action_unit_list.txt).
constexpr std::array<int, kOriginalUnits> kUnitNumbers{1,  2,  4,  5,  6,  7,  9,  10, 11, 12,
                                                       13, 14, 15, 16, 17, 18, 20, 22, 23, 24,
                                                       25, 26, 27, 28, 29, 30, 35, 41, 42, 43};
constexpr int kEyesClosed = 43;

/// Of a viseme's offsets that the original shows for a full articulation: its MouthScale is 30 by
/// default, which stands for three quarters here.
constexpr float kVisemePart = 0.4f;

std::vector<NnlsSolver::Row> Rows(const VisemeMouths& mouths) {
  std::vector<NnlsSolver::Row> rows;
  for (const auto& mouth : mouths) rows.emplace_back(mouth.begin(), mouth.end());
  return rows;
}

class OwnMotion : public Deformation {
 public:
  OwnMotion(const OriginalFace& face, const MeshModel& model, const VisemeMouths& mouths)
      : mix_(Rows(mouths)), seal_(model, face.wireframe.at.size()) {
    // Offsets belong to the standard wireframe and grow with the face: across with the distance of
    // the eyes, up and down with the height from eyes to mouth.
    const OriginalFrame own(face.wireframe), standard(face.standard);
    const auto height = [](const OriginalFrame& frame, const PntFile& file) {
      return frame.EyeOpening(file, 0).y - frame.Place(file, kLipMiddle).y;
    };
    const float tall = height(own, face.wireframe) / height(standard, face.standard);
    const glm::vec3 mm = standard.mm() * glm::vec3(1, std::clamp(tall, 0.5f, 2.0f), 1);
    const auto fields = [&mm](const std::vector<std::vector<glm::vec3>>& from,
                              std::vector<Field>& to) {
      for (const auto& offsets : from) {
        Field field;
        for (std::uint32_t i = 0; i < offsets.size(); ++i) {
          const glm::vec3 by = offsets[i] * mm;
          if (glm::length(by) > 0.02f) field.push_back({i, by});
        }
        to.push_back(std::move(field));
      }
    };
    fields(face.units, units_);
    fields(face.mouth_units, mouth_units_);
    fields(face.visemes, visemes_);
    const float middle = 0.5f * (own.Place(face.wireframe, kLipCorners[0]).x +
                                 own.Place(face.wireframe, kLipCorners[1]).x);
    for (std::size_t i = 0; i < face.wireframe.at.size(); ++i) {
      left_.push_back(SmoothStep(middle - 7, middle + 7, model.position[i].x));
    }
    chin_ = face.wireframe.index.at(kChin);
    chin_rest_ = model.position[chin_];
    hinge_ = model.hinge;
    MeasureMouthUnits();
  }

  JawMove Move(const FaceState& state, const Pose& pose,
               std::span<glm::vec3> position) const override {
    const std::array<float, 2> blink = {state.blink_right, state.blink_left};
    for (std::size_t k = 0; k < units_.size(); ++k) {
      const auto number = static_cast<std::size_t>(kUnitNumbers[k]);
      float right = pose.units[0][number], left = pose.units[1][number];
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
    const NnlsSolver::Parts parts = mix_.TakeApart(state.mouth);
    for (std::size_t k = 0; k < visemes_.size() && k < parts.weights.size(); ++k) {
      add(visemes_[k], kVisemePart * parts.weights[k]);
    }
    for (std::size_t k = 0; k < mouth_units_.size(); ++k) {
      if (unit_size_[k] != 0) {
        add(mouth_units_[k], Bound(parts.rest[k] / unit_size_[k], -1.5f, 1.5f));
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

  /// How far each mouth unit goes at full strength in the parameter's own measure: millimetres
  /// along its axis; of the jaw's opening degrees about the hinge.
  void MeasureMouthUnits() {
    constexpr std::array<int, kMouthParameters> kAxis{1, 2, 1, 2, 1, 2, 1, 2, 0,
                                                      1, 2, 1, 2, 1, 1, 1, 1};
    constexpr std::size_t kJaw = 11;
    for (std::size_t k = 0; k < mouth_units_.size(); ++k) {
      float most = 0;
      for (const Delta& d : mouth_units_[k]) {
        float along = d.by[kAxis[k]];
        if (k == 8 && left_[d.vertex] < 0.5f) along = -along;  // the corners part
        if (std::abs(along) > std::abs(most)) most = along;
      }
      if (k == kJaw) most = -most / 1.4f;  // millimetres of lip for a degree, see mouth_shapes.txt
      unit_size_[k] = std::abs(most) > 0.1f ? most : 0;
    }
  }

  std::vector<Field> units_, mouth_units_, visemes_;
  std::array<float, kMouthParameters> unit_size_{};
  std::vector<float> left_;  // part of the agent's left side in a vertex
  NnlsSolver mix_;
  LipSeal seal_;
  std::size_t chin_ = 0;
  glm::vec3 chin_rest_{}, hinge_{};
};

}  // namespace

std::unique_ptr<Deformation> OwnMotionOf(const OriginalFace& face, const MeshModel& model,
                                         const VisemeMouths& mouths) {
  return std::make_unique<OwnMotion>(face, model, mouths);
}

}  // namespace fsm
