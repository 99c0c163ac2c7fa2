#include "fsm/mesh/original_points.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace fsm {
namespace {

constexpr std::array<PointName, 12> kLids[2] = {{{{4, 17},
                                                  {4, 18},
                                                  {4, 19},
                                                  {4, 20},
                                                  {4, 21},
                                                  {4, 22},
                                                  {4, 23},
                                                  {4, 28},
                                                  {4, 27},
                                                  {4, 26},
                                                  {4, 25},
                                                  {4, 24}}},
                                                {{{5, 17},
                                                  {5, 18},
                                                  {5, 19},
                                                  {5, 20},
                                                  {5, 21},
                                                  {5, 22},
                                                  {5, 23},
                                                  {5, 28},
                                                  {5, 27},
                                                  {5, 26},
                                                  {5, 25},
                                                  {5, 24}}}};

glm::vec3 MeanOfRim(const PntFile& file, std::size_t side) {
  glm::vec3 sum(0);
  for (const PointName& name : kLids[side]) sum += file.at[file.index.at(name)];
  return sum / static_cast<float>(kLids[side].size());
}

}  // namespace

std::span<const PointName> LidRim(std::size_t side) { return kLids[side]; }

OriginalFrame::OriginalFrame(const PntFile& wireframe) {
  const glm::vec3 right = MeanOfRim(wireframe, 0), left = MeanOfRim(wireframe, 1);
  middle_ = 0.5f * (right + left);
  mm_ = kOpeningsApart / std::max(glm::distance(right, left), 1e-4f);
}

glm::vec3 OriginalFrame::EyeOpening(const PntFile& file, std::size_t side) const {
  return ToMm(MeanOfRim(file, side));
}

vm::Result<void> CheckPoints(const std::string& name, const PntFile& file) {
  const auto check = [&](const PointName& point) -> vm::Result<void> {
    if (file.index.contains(point)) return {};
    return vm::Fail(vm::Errc::kBadValue,
                    name + ": " + InWords(point) +
                        " is missing: a wireframe of the original's standard head is expected");
  };
  for (const auto& point : kLipRim) {
    if (auto there = check(point); !there) return there;
  }
  for (const auto& rim : kLids) {
    for (const auto& point : rim) {
      if (auto there = check(point); !there) return there;
    }
  }
  for (const auto& named : kNamedPoints) {
    if (auto there = check(named.second); !there) return there;
  }
  for (const auto& point : {kJawAtTeeth[0], kJawAtTeeth[1], kUpperLipFront, kUpperTeeth.top,
                            kUpperTeeth.front, kLowerTeeth.bottom, kLowerTeeth.front}) {
    if (auto there = check(point); !there) return there;
  }
  return {};
}

}  // namespace fsm
