#include "fsm/mesh/original/original_points.h"

#include <glm/geometric.hpp>

namespace fsm {
namespace {

constexpr std::array<PointName, 12> LidsOf(int group) {
  return {{{group, 17},
           {group, 18},
           {group, 19},
           {group, 20},
           {group, 21},
           {group, 22},
           {group, 23},
           {group, 28},
           {group, 27},
           {group, 26},
           {group, 25},
           {group, 24}}};
}
constexpr Sided<std::array<PointName, 12>> kLids{LidsOf(4), LidsOf(5)};

glm::vec3 MeanOfRim(const PntFile& file, Side side) {
  glm::vec3 sum(0);
  for (const PointName& name : kLids[side]) sum += file.positions[file.index.at(name)];
  return sum / static_cast<float>(kLids[side].size());
}

}  // namespace

std::span<const PointName> LidRim(Side side) { return kLids[side]; }

OriginalSpace::OriginalSpace(const PntFile& wireframe) {
  const glm::vec3 right = MeanOfRim(wireframe, Side::kRight),
                  left = MeanOfRim(wireframe, Side::kLeft);
  middle_ = 0.5f * (right + left);
  mm_ = kOpeningsApart / std::max(glm::distance(right, left), 1e-4f);
}

glm::vec3 OriginalSpace::EyeOpening(const PntFile& file, Side side) const {
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
  for (const Side side : kSides) {
    for (const auto& point : kLids[side]) {
      if (auto there = check(point); !there) return there;
    }
  }
  for (const auto& named : kNamedPoints) {
    if (auto there = check(named.second); !there) return there;
  }
  for (const auto& point : {kJawAtTeeth.right, kJawAtTeeth.left, kUpperLipFront, kUpperTeeth.top,
                            kUpperTeeth.front, kLowerTeeth.bottom, kLowerTeeth.front}) {
    if (auto there = check(point); !there) return there;
  }
  return {};
}

}  // namespace fsm
