#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fsm/mesh/transfer/nnls_solver.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Finds the weights of shapes that reproduce a head in a state. Slow; for baking.
class ShapeSolver {
 public:
  /// `source` defines the displacements of the shapes, `driven`, which has the same form, those of
  /// the states.
  ShapeSolver(const Head& source, const Head& driven);

  /// Adds a shape, which looks as `source` does in this state.
  void Add(const FaceState& meaning);
  std::size_t count() const { return keys_.size(); }
  /// Tells whether a shape only opens the mouth.
  bool Opens(std::size_t shape) const { return opens_mm_[shape] > 0; }
  /// Returns the weights of all shapes with which they look most like `driven` in a state.
  std::vector<float> Solve(const FaceState& state);
  /// Returns the share of a state's movement that the shapes can reproduce, 0..1 of its sum of
  /// squares.
  float ShareShown(const FaceState& state);

 private:
  struct ProbeMotion {
    NnlsSolver::Row moves;  ///< displacements of the probes
    float gap_mm;           ///< gap between the lips
  };

  void ChooseProbes(std::span<const std::uint32_t> skin);
  ProbeMotion MotionOf(const Rig& face, const FaceState& state);
  bool OpensOnlyMouth(const NnlsSolver::Row& moves) const;
  void HoldShut(float wanted_mm, std::vector<float>& weights) const;
  const NnlsSolver& solver();

  Rig source_, driven_;
  HeadVertices vertices_;  // of the state evaluated last
  std::vector<glm::vec3> rest_;
  std::vector<std::uint32_t> probes_;  // vertices of the face that are a few millimetres apart
  std::vector<NnlsSolver::Row> keys_;
  std::vector<float> opens_mm_;       // by shape; 0 unless it only opens the mouth
  std::optional<NnlsSolver> solver_;  // of the shapes added so far; made when it is first needed
};

}  // namespace fsm
