#include "fsm/mesh/rigging/shape_solver.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

#include "fsm/mesh/rigging/transferred_rig.h"

namespace fsm {
namespace {

/// Returns the rig of a head with only the steps that move the face's skin.
Rig FaceOnly(const Head& head) {
  RigData rig = head.rig().data();
  std::erase_if(rig.steps, [](RigStep step) { return !ShapesSkin(step); });
  return Rig(std::move(rig));
}

}  // namespace

ShapeSolver::ShapeSolver(const Head& source, const Head& driven)
    : source_(FaceOnly(source)), driven_(FaceOnly(driven)) {
  HeadVertices vertices;
  source_.Evaluate({}, vertices);
  rest_ = std::move(vertices.position);
  ChooseProbes(SkinTriangles(source.surface()));
}

void ShapeSolver::Add(const FaceState& meaning) {
  ProbeMotion motion = MotionOf(source_, meaning);
  opens_mm_.push_back(OpensOnlyMouth(motion.moves) ? motion.gap_mm : 0.0f);
  keys_.push_back(std::move(motion.moves));
  solver_.reset();
}

const NnlsSolver& ShapeSolver::solver() {
  if (!solver_) solver_.emplace(keys_);
  return *solver_;
}

std::vector<float> ShapeSolver::Solve(const FaceState& state) {
  const ProbeMotion motion = MotionOf(driven_, state);
  std::vector<float> weights = solver().Solve(motion.moves).weights;
  HoldShut(motion.gap_mm, weights);
  return weights;
}

float ShapeSolver::ShareShown(const FaceState& state) {
  const NnlsSolver::Row moves = MotionOf(driven_, state).moves;
  const NnlsSolver::Row residual = solver().Solve(moves).residual;
  const float all = std::inner_product(moves.begin(), moves.end(), moves.begin(), 0.0f);
  const float left = std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0f);
  return all > 0 ? 1 - left / all : 0;
}

void ShapeSolver::ChooseProbes(std::span<const std::uint32_t> skin) {
  constexpr float kApart = 5;
  for (const std::uint32_t v : skin) {
    const glm::vec3 p = rest_[v];
    if (p.z < 30 || p.y < -105 || p.y > 75) continue;
    if (std::ranges::none_of(
            probes_, [&](std::uint32_t w) { return glm::distance(rest_[w], p) < kApart; })) {
      probes_.push_back(v);
    }
  }
}

ShapeSolver::ProbeMotion ShapeSolver::MotionOf(const Rig& face, const FaceState& state) {
  face.Evaluate(state, vertices_);
  ProbeMotion motion{.moves = {}, .gap_mm = 0};
  motion.moves.reserve(3 * probes_.size());
  for (const std::uint32_t v : probes_) {
    for (int c = 0; c < 3; ++c) motion.moves.push_back(vertices_.position[v][c] - rest_[v][c]);
  }
  if (const MouthVertices& mouth = face.data().mouth; !mouth.seam.empty()) {
    const auto [upper, lower] = mouth.Middle();
    motion.gap_mm = std::max(vertices_.position[upper].y - vertices_.position[lower].y, 0.0f);
  }
  return motion;
}

/// Tells whether a state moves only vertices below the nose.
bool ShapeSolver::OpensOnlyMouth(const NnlsSolver::Row& moves) const {
  constexpr float kBelow = -10, kRest = 0.1f;
  float above = 0, all = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    all += moves[i] * moves[i];
    if (rest_[probes_[i / 3]].y > kBelow) above += moves[i] * moves[i];
  }
  return above < kRest * all;
}

/// For a closed mouth, a combination with the lips slightly open may fit as well, but p, b and m
/// must close. Shapes that only open the mouth are therefore limited so that it opens no wider than
/// in `driven`.
void ShapeSolver::HoldShut(float wanted_mm, std::vector<float>& weights) const {
  float open = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) open += weights[k] * opens_mm_[k];
  if (open <= std::max(wanted_mm, 1e-3f)) return;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (opens_mm_[k] > 0) weights[k] *= wanted_mm / open;
  }
}

}  // namespace fsm
