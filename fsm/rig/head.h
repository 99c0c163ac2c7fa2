#pragma once

#include <atomic>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "fsm/rig/face_state.h"
#include "fsm/rig/head_asset.h"
#include "fsm/rig/rig.h"

namespace fsm {

/// A head: how it looks and how it moves. It is a pure function from FaceState to vertices, which
/// applies the rotation of the head but not Figure and camera. Evaluate and MeasureMouth are those
/// of Rig. Immutable after construction; safe to share.
class Head {
 public:
  /// REQUIRES: the arrays of `asset` have matching sizes and indices, as the bakers make them.
  explicit Head(HeadAsset asset);
  Head(const Head&) = delete;
  Head& operator=(const Head&) = delete;

  const HeadSurface& surface() const { return *surface_; }
  /// Returns the surface for users that may outlive the head.
  const std::shared_ptr<const HeadSurface>& shared_surface() const { return surface_; }
  const Rig& rig() const { return rig_; }
  const MouthVertices& mouth() const { return rig_.data().mouth; }
  glm::vec3 EyeCentre(Side side) const { return rig_.data().eyes.centre[side]; }
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> spring_offsets = {}) const {
    rig_.Evaluate(state, out, spring_offsets);
  }
  /// Returns the same head with the same surface whose action units move as another table says;
  /// displacements that are the head's own (RigData::has_unit_channels) stay.
  std::unique_ptr<Head> WithUnits(const UnitTable& units) const;
  MouthMeasure MeasureMouth(const FaceState& state) const { return rig_.MeasureMouth(state); }
  /// Returns the rest position of a landmark named after Farkas: "nasion", "pronasale",
  /// "subnasale", "stomion", "gnathion", "trichion"; with _left or _right: "cheilion",
  /// "endocanthion", "exocanthion", "pupil", "alare", "zygion", "gonion", "tragion". Throws
  /// std::out_of_range.
  glm::vec3 Landmark(std::string_view name) const;
  const Landmarks& landmarks() const { return landmarks_; }
  /// Returns HeadAsset::view.
  const std::optional<ParallelView>& view() const { return view_; }
  /// Returns a number that no other head of this process has or had. Caches of a head, as on a
  /// GPU, use it as their key: an address may be reused for a later head.
  std::uint64_t serial() const { return serial_; }

 private:
  Head(const Head& other, Rig rig);
  static inline std::atomic<std::uint64_t> last_serial_{0};  // heads are made on several threads

  const std::uint64_t serial_ = ++last_serial_;
  std::shared_ptr<const HeadSurface> surface_;
  Landmarks landmarks_;
  std::optional<ParallelView> view_;
  Rig rig_;
};

}  // namespace fsm
