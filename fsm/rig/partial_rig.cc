#include "fsm/rig/partial_rig.h"

#include <algorithm>
#include <utility>

namespace fsm {
namespace {

std::vector<std::uint32_t> WithThoseOfSteps(std::vector<std::uint32_t> vertices,
                                            const RigData& data) {
  const std::vector<std::uint32_t> steps = StepVertices(data);
  vertices.insert(vertices.end(), steps.begin(), steps.end());
  std::ranges::sort(vertices);
  const auto twice = std::ranges::unique(vertices);
  vertices.erase(twice.begin(), twice.end());
  return vertices;
}

}  // namespace

PartialRig::PartialRig(const Rig& whole, std::vector<std::uint32_t> vertices)
    : whole_size_(whole.data().rest.size()),
      vertices_(WithThoseOfSteps(std::move(vertices), whole.data())),
      rig_(OnlyVertices(whole.data(), vertices_)) {}

void PartialRig::Evaluate(const FaceState& state, HeadVertices& out,
                          std::span<const glm::vec3> spring_offsets) const {
  thread_local HeadVertices some;  // kept from frame to frame
  rig_.Evaluate(state, some, spring_offsets);
  out.position.resize(whole_size_);
  for (std::size_t i = 0; i < vertices_.size(); ++i) out.position[vertices_[i]] = some.position[i];
  out.creases = some.creases;
  out.lids_shut = some.lids_shut;
}

}  // namespace fsm
