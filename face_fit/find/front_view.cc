#include "face_fit/find/front_view.h"

#include <algorithm>
#include <cmath>

namespace facefit {

FrontView::FrontView(const fsm::HeadTopology& topology, std::span<const glm::vec3> position,
                     glm::vec2 low, glm::vec2 high)
    : topology_(topology),
      position_(position),
      low_(low),
      columns_(static_cast<int>(std::clamp(high.x - low.x, 1.0F, 200.0F) / kCell)),
      rows_(static_cast<int>(std::clamp(high.y - low.y, 1.0F, 200.0F) / kCell)),
      z_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -1e9F),
      first_(z_.size(), kNone) {
  for (const auto& part : topology.parts) {
    if (IsHair(part.material) || part.material == fsm::Material::kShutLash) continue;
    for (std::uint32_t k = 0; k + 2 < part.index_count; k += 3) Draw(part.first_index + k);
  }
}

std::uint32_t FrontView::Triangle(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return kNone;
  return first_[At(column, row)];
}

MeshPlace FrontView::Place(int column, int row) const {
  const std::uint32_t first = first_[At(column, row)];
  const std::uint32_t* t = &topology_.indices[first];
  return {{t[0], t[1], t[2]}, Part(first, Centre(column, row))};
}

glm::vec3 FrontView::Part(std::uint32_t first, glm::vec2 at) const {
  const std::uint32_t* t = &topology_.indices[first];
  const glm::vec3 a = position_[t[0]], b = position_[t[1]], c = position_[t[2]];
  const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const float u = ((at.x - a.x) * (c.y - a.y) - (c.x - a.x) * (at.y - a.y)) / area;
  const float v = ((b.x - a.x) * (at.y - a.y) - (at.x - a.x) * (b.y - a.y)) / area;
  return {1 - u - v, u, v};
}

void FrontView::Draw(std::uint32_t first) {
  const std::uint32_t* t = &topology_.indices[first];
  const glm::vec3 a = position_[t[0]], b = position_[t[1]], c = position_[t[2]];
  if ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) < 1e-7F) return;  // seen from behind
  const auto cell = [](float from, float to, float most) {
    return static_cast<int>(std::ceil(std::clamp((to - from) / kCell - 0.5F, 0.0F, most)));
  };
  const auto columns = static_cast<float>(columns_), rows = static_cast<float>(rows_);
  const int left = cell(low_.x, std::min({a.x, b.x, c.x}), columns),
            right = cell(low_.x, std::max({a.x, b.x, c.x}), columns),
            under = cell(low_.y, std::min({a.y, b.y, c.y}), rows),
            above = cell(low_.y, std::max({a.y, b.y, c.y}), rows);
  for (int row = under; row < above; ++row) {
    for (int column = left; column < right; ++column) {
      const glm::vec3 part = Part(first, Centre(column, row));
      if (std::min({part.x, part.y, part.z}) < 0) continue;
      const float z = a.z * part.x + b.z * part.y + c.z * part.z;
      if (z <= z_[At(column, row)]) continue;
      z_[At(column, row)] = z;
      first_[At(column, row)] = first;
    }
  }
}

}  // namespace facefit
