#include "face_fit/dress/skin_places.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "face_fit/dress/cover.h"

namespace facefit {
namespace {

/// Whether the head itself hides a place of its skin from the camera, as the jaw does the throat.
class Hidden {
 public:
  Hidden(const BaseHead& base, const Fit& fit) : fit_(fit) {
    const glm::vec2 middle = fit.pose.Project({0, 0, 0});
    const float reach = kReach * fit.pose.PixelsPerMm();
    const float cell = 2 * reach / kCells;
    grid_ = {middle - reach, cell, kCells, kCells};
    nearest_ = CoverWithSkin(base, fit, grid_, -1e9F).depth;
  }
  bool operator()(glm::vec3 camera) const {
    const glm::vec2 at = (fit_.pose.Project(camera) - grid_.origin) / grid_.cell + 0.5F;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    if (x < 1 || y < 1 || x + 1 >= kCells || y + 1 >= kCells) return false;
    constexpr float kBehind = 5;  // millimetres
    for (int k = 0; k < 9; ++k) {
      const float z = nearest_.at[nearest_.Index(x + k % 3 - 1, y + k / 3 - 1)];
      if (z < camera.z + kBehind) return false;
    }
    return true;
  }

 private:
  static constexpr int kCells = 256;
  static constexpr float kReach = 180;  // millimetres
  const Fit& fit_;
  PhotoGrid grid_{};
  FloatImage nearest_{0, 0};
};

/// Of a line from the person's right to left.
float HeightAt(std::span<const glm::vec3> line, float x) {
  std::size_t k = 1;
  while (k + 1 < line.size() && line[k].x < x) ++k;
  const float part = (x - line[k - 1].x) / std::max(line[k].x - line[k - 1].x, 1e-3F);
  return glm::mix(line[k - 1].y, line[k].y, glm::clamp(part, 0.0F, 1.0F));
}

}  // namespace

SkinPlaces PlaceSkin(const BaseHead& base, const Fit& fit, const Pose& pose, bool hidden) {
  std::optional<Hidden> hides;
  if (hidden) hides.emplace(base, fit);
  const auto& topology = base.head->topology();
  SkinPlaces out;
  std::vector<glm::vec3> camera;
  for (const glm::vec3& p : fit.worn) camera.push_back(pose.ToCamera(p));
  std::vector<glm::vec3> normal(camera.size(), glm::vec3(0));
  const auto each = [&](auto&& f) {
    for (const auto& part : topology.parts) {
      if (part.material != fsm::Material::kSkin && part.material != fsm::Material::kLip) continue;
      for (std::uint32_t k = 0; k + 2 < part.index_count; k += 3) {
        f(&topology.indices[part.first_index + k]);
      }
    }
  };
  each([&](const std::uint32_t* t) {
    const glm::vec3 n = glm::cross(camera[t[1]] - camera[t[0]], camera[t[2]] - camera[t[0]]);
    for (int c = 0; c < 3; ++c) normal[t[c]] += n;
  });
  constexpr glm::vec3 kEye(0, 0, 794);
  const float brows = base.head->Landmark("nasion").y + kBrowsEnd;
  const float chin = base.places[152].On(base.rest.position).y;
  std::vector<glm::vec3> seam;
  for (const int i : UpperInnerLip()) {
    seam.push_back(base.places[static_cast<std::size_t>(i)].On(base.rest.position));
  }
  const auto off_seam = [&seam](glm::vec3 p) {
    if (p.x < seam.front().x || p.x > seam.back().x || p.z < 60) return 1e9F;
    const float off = std::abs(p.y - HeightAt(seam, p.x));
    // Towards its ends a line grows thin.
    const float to_end = std::min(p.x - seam.front().x, seam.back().x - p.x);
    return off + 0.2F * std::max(7 - to_end, 0.0F);
  };
  const auto border = [&base](std::span<const int> points) {
    std::vector<glm::vec3> line;
    const auto add = [&](int i) {
      line.push_back(base.places[static_cast<std::size_t>(i)].On(base.rest.position));
    };
    add(61);
    for (const int i : points) add(i);
    add(291);
    return line;
  };
  const auto upper = border(UpperOuterLip()), lower = border(LowerOuterLip());
  const auto red = [&](glm::vec3 p) {
    if (p.x < upper.front().x || p.x > upper.back().x || p.z < 60) return -1e9F;
    return std::min(HeightAt(upper, p.x) - p.y, p.y - HeightAt(lower, p.x));
  };
  each([&](const std::uint32_t* t) {
    glm::vec2 uv[3];
    for (int c = 0; c < 3; ++c) {
      const glm::vec2 place = topology.uv[t[c]];
      uv[c] = glm::vec2(place.x, 1 - place.y) * static_cast<float>(kMapSide) - 0.5F;
    }
    // Where the map is sewn together triangles would run right across it.
    const float wide =
        std::max({uv[0].x, uv[1].x, uv[2].x}) - std::min({uv[0].x, uv[1].x, uv[2].x});
    if (wide > kMapSide / 4.0F) return;
    const float area =
        (uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) - (uv[2].x - uv[0].x) * (uv[1].y - uv[0].y);
    if (std::abs(area) < 1e-6F) return;
    const auto low = [&](int axis) {
      return std::max(
          static_cast<int>(std::floor(std::min({uv[0][axis], uv[1][axis], uv[2][axis]}))), 0);
    };
    const auto high = [&](int axis) {
      return std::min(
          static_cast<int>(std::ceil(std::max({uv[0][axis], uv[1][axis], uv[2][axis]}))),
          kMapSide - 1);
    };
    for (int y = low(1); y <= high(1); ++y) {
      for (int x = low(0); x <= high(0); ++x) {
        const glm::vec2 p(x, y);
        const float b =
            ((p.x - uv[0].x) * (uv[2].y - uv[0].y) - (uv[2].x - uv[0].x) * (p.y - uv[0].y)) / area;
        const float c =
            ((uv[1].x - uv[0].x) * (p.y - uv[0].y) - (p.x - uv[0].x) * (uv[1].y - uv[0].y)) / area;
        if (b < -0.02F || c < -0.02F || b + c > 1.02F) continue;
        const auto between = [&](const auto& v) {
          return v[t[0]] * (1 - b - c) + v[t[1]] * b + v[t[2]] * c;
        };
        const glm::vec3 rest = between(base.rest.position);
        const float outward = rest.x * rest.x + rest.z * rest.z;
        const std::size_t i = MapIndex(x, y);
        if (outward <= out.outward[i]) continue;
        const glm::vec3 q = between(camera);
        const glm::vec3 n = between(normal);
        out.outward[i] = outward;
        out.pixel[i] = pose.Project(q);
        out.across[i] = rest.x;
        out.up[i] = rest.y - brows;
        out.off_seam[i] = off_seam(rest);
        out.red[i] = red(rest);
        out.aside[i] = std::max(glm::smoothstep(40.0F, 52.0F, std::abs(rest.x)),
                                glm::smoothstep(chin + 22, chin + 10, rest.y));
        out.facing[i] = hides && (*hides)(q) ? -1.0F
                                             : glm::dot(glm::normalize(n + glm::vec3(0, 0, 1e-9F)),
                                                        glm::normalize(kEye - q));
      }
    }
  });
  return out;
}

}  // namespace facefit
