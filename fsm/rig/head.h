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

/// A head: what it looks like and how it moves. A pure function from FaceState to vertices, head
/// rotation included, Figure and camera not. Immutable after construction; safe
/// to share.
class Head {
 public:
  /// REQUIRES: the arrays of `asset` fit together, as the bakers make them.
  explicit Head(HeadAsset asset);
  Head(const Head&) = delete;
  Head& operator=(const Head&) = delete;

  const HeadTopology& topology() const { return *topology_; }
  /// The same, for what may outlive the head.
  const std::shared_ptr<const HeadTopology>& shared_topology() const { return topology_; }
  const Rig& rig() const { return rig_; }
  /// Fills `out` (resized as needed). Values out of range are clamped to what anatomy allows.
  /// `swings`: as of Rig::Evaluate.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> swings = {}) const {
    rig_.Evaluate(state, out, swings);
  }
  /// The same head, of the same topology, whose units move it as another table says (UnitTable),
  /// as far as they are not the head's own.
  std::unique_ptr<Head> WithUnits(const UnitTable& units) const;
  /// The mouth of a state, measured on the vertices Evaluate would give.
  MouthMeasure MeasureMouth(const FaceState& state) const { return rig_.MeasureMouth(state); }
  /// Where a named landmark lies at rest, after Farkas: "nasion", "pronasale", "subnasale",
  /// "stomion", "gnathion", "trichion"; with _left or _right: "cheilion", "endocanthion",
  /// "exocanthion", "pupil", "alare", "zygion", "gonion", "tragion". Throws std::out_of_range.
  glm::vec3 Landmark(std::string_view name) const;
  const Landmarks& landmarks() const { return landmarks_; }
  /// HeadAsset::view.
  const std::optional<ParallelView>& view() const { return view_; }
  /// A number that no other head of this process has or had. What is kept of a head elsewhere, as
  /// on a graphics card, goes by it and not by the address, where another head may be made later.
  std::uint64_t serial() const { return serial_; }

 private:
  Head(const Head& other, Rig rig);
  static inline std::atomic<std::uint64_t> last_serial_{0};  // heads are made on several threads

  const std::uint64_t serial_ = ++last_serial_;
  std::shared_ptr<const HeadTopology> topology_;
  Landmarks landmarks_;
  std::optional<ParallelView> view_;
  Rig rig_;
};

}  // namespace fsm
