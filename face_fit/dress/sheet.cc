#include "face_fit/dress/sheet.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

namespace facefit {
namespace {

/// How far below the chin skin goes on, before the neck of the photo's own takes over.
constexpr float kBelowChin = 7;
/// Millimetres of sheet behind the skin's edge.
constexpr float kRim = 13;

float ChinY(const BaseHead& base, const Fit& fit) { return base.places[152].On(fit.worn).y; }

/// Calls `f(x, y, z)` for the cells of a grid over the photo that the face's skin covers, z towards
/// the camera.
template <typename F>
void CoverSkin(const BaseHead& base, const Fit& fit, glm::vec2 origin, float cell, int columns,
               int rows, F f) {
  const float bottom = ChinY(base, fit) - kBelowChin;
  const auto& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kSkin && part.material != fsm::Material::kLip) continue;
    for (std::uint32_t k = part.first_index; k + 2 < part.first_index + part.index_count; k += 3) {
      const std::uint32_t* t = &topology.indices[k];
      glm::vec3 q[3];
      glm::vec2 p[3];
      bool low = false;
      for (int c = 0; c < 3; ++c) {
        low = low || fit.worn[t[c]].y < bottom || fit.worn[t[c]].z < 0;
        q[c] = fit.pose.ToCamera(fit.worn[t[c]]);
        p[c] = (fit.pose.Project(q[c]) - origin) / cell;
      }
      const glm::vec3 n = glm::cross(q[1] - q[0], q[2] - q[0]);
      if (low || n.z <= 0.1F * glm::length(n)) continue;
      const float area =
          (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
      if (std::abs(area) < 1e-7F) continue;
      const glm::vec2 least = glm::max(glm::floor(glm::min(p[0], glm::min(p[1], p[2]))), 0.0F);
      const glm::vec2 most = glm::min(glm::ceil(glm::max(p[0], glm::max(p[1], p[2]))),
                                      glm::vec2(columns - 1, rows - 1));
      for (int y = static_cast<int>(least.y); y <= static_cast<int>(most.y); ++y) {
        for (int x = static_cast<int>(least.x); x <= static_cast<int>(most.x); ++x) {
          const glm::vec2 at(x, y);
          const float b =
              ((at.x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (at.y - p[0].y)) / area;
          const float c =
              ((p[1].x - p[0].x) * (at.y - p[0].y) - (at.x - p[0].x) * (p[1].y - p[0].y)) / area;
          if (b < -0.01F || c < -0.01F || b + c > 1.01F) continue;
          f(x, y, q[0].z * (1 - b - c) + q[1].z * b + q[2].z * c);
        }
      }
    }
  }
}

/// Sets what cannot be reached from the edge: eyes and an open mouth lie within the face.
void FillHoles(Field& covered) {
  Field outside(covered.width, covered.height);
  std::vector<std::pair<int, int>> open;
  const auto reach = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= covered.width || y >= covered.height) return;
    const std::size_t i = covered.Index(x, y);
    if (covered.at[i] > 0 || outside.at[i] > 0) return;
    outside.at[i] = 1;
    open.emplace_back(x, y);
  };
  for (int x = 0; x < covered.width; ++x) {
    reach(x, 0);
    reach(x, covered.height - 1);
  }
  for (int y = 0; y < covered.height; ++y) {
    reach(0, y);
    reach(covered.width - 1, y);
  }
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    reach(x + 1, y);
    reach(x - 1, y);
    reach(x, y + 1);
    reach(x, y - 1);
  }
  for (std::size_t i = 0; i < covered.at.size(); ++i) covered.at[i] = 1 - outside.at[i];
}

}  // namespace

fsm::Image BehindFace(const BaseHead& base, const Fit& fit, const Figure& figure) {
  const int width = figure.colours.width, height = figure.colours.height;
  Field face(width, height);
  CoverSkin(base, fit, glm::vec2(0.5F), 1, width, height,
            [&](int x, int y, float) { face.at[face.Index(x, y)] = 1; });
  FillHoles(face);
  // Somewhat smaller than the skin, whose edge shows the same as the sheet's there. Forehead and
  // temples are mostly hair already, so the hole begins at the brows.
  const float mm = fit.pose.PixelsPerMm();
  const Field soft = Blurred(face, std::max(static_cast<int>(5 * mm), 1));
  Field keep(width, height, 1);
  for (std::size_t i = 0; i < keep.at.size(); ++i) keep.at[i] = soft.at[i] > 0.85F ? 0.0F : 1.0F;
  fsm::Image out = figure.colours;
  FillIn(out, keep);
  return out;
}

void MakeSheet(const BaseHead& base, const Fit& fit, const Figure& figure, fsm::FaceSet& set) {
  const glm::vec2 size(figure.colours.width, figure.colours.height);
  const float mm = fit.pose.PixelsPerMm();
  // Beyond the photo's lower corners the clothes go on as they end.
  constexpr float kBeyond = 90;  // millimetres
  const glm::vec2 origin = glm::vec2(-kBeyond * mm, 0);
  const glm::vec2 extent = size + glm::vec2(2 * kBeyond, kBeyond) * mm;
  const float cell = std::max(4.5F * mm, std::sqrt(extent.x * extent.y / 9000));
  const int columns = static_cast<int>(extent.x / cell) + 2,
            rows = static_cast<int>(extent.y / cell) + 2;
  Field depth(columns, rows), fixed(columns, rows), covered(columns, rows);
  const float chin = ChinY(base, fit);
  const auto pixel = [&](int x, int y) { return origin + glm::vec2(x, y) * cell; };
  const auto opacity = [&](int x, int y) {
    const glm::vec2 p = pixel(x, y);
    return figure.opacity.Between(p.x, p.y);
  };
  constexpr float kNone = -1e9F;
  std::ranges::fill(depth.at, kNone);
  CoverSkin(base, fit, origin, cell, columns, rows, [&](int x, int y, float z) {
    float& d = depth.at[depth.Index(x, y)];
    d = std::max(d, z);
  });
  Field skin(columns, rows);
  for (std::size_t i = 0; i < skin.at.size(); ++i) skin.at[i] = depth.at[i] > kNone ? 1.0F : 0.0F;
  const Field within_skin =
      Blurred(skin, std::max(static_cast<int>(std::lround(kRim * mm / cell)), 1));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const std::size_t i = depth.Index(x, y);
      const float height = fit.pose.FromCamera(fit.pose.Unproject(pixel(x, y), 20)).y;
      if (depth.at[i] > kNone) {
        // Behind the lower face lies the neck.
        const float neck = glm::smoothstep(chin + 45, chin + 12, height);
        covered.at[i] = 1;
        // At the skin's edge the sheet goes on from it, further in it keeps out of its way.
        const float under =
            depth.at[i] - glm::mix(0.6F, 5.0F, glm::smoothstep(0.5F, 0.9F, within_skin.at[i]));
        depth.at[i] = glm::mix(under, std::min(under, 22.0F), neck);
        fixed.at[i] = 1;
      } else if (opacity(x, y) < 0.05F) {
        // The outline: hair stands before the ears, shoulders lie in their plane.
        depth.at[i] = glm::mix(-4.0F, -30.0F, glm::smoothstep(chin, chin - 70, height));
        fixed.at[i] = 1;
      } else {
        depth.at[i] = 0;
      }
    }
  }
  for (int round = 0; round < 400; ++round) {
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const std::size_t i = depth.Index(x, y);
        if (fixed.at[i] > 0) continue;
        const auto next = [&](int dx, int dy) {
          return depth
              .at[depth.Index(std::clamp(x + dx, 0, columns - 1), std::clamp(y + dy, 0, rows - 1))];
        };
        // A little rounder than a skin of soap.
        depth.at[i] = 0.25F * (next(1, 0) + next(-1, 0) + next(0, 1) + next(0, -1)) + 0.12F;
      }
    }
  }
  FillHoles(covered);
  // Nothing behind the middle of the face: there are the mouth and the eyes.
  const Field within =
      Blurred(covered, std::max(static_cast<int>(std::lround(kRim * mm / cell)), 1));
  const auto hidden = [&](int x, int y) { return within.at[depth.Index(x, y)] > 0.999F; };
  set.sheet.clear();
  set.sheet_triangles.clear();
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const glm::vec2 p = pixel(x, y);
      const glm::vec2 at = glm::clamp(p / size, 0.5F / kMapSide, 1 - 0.5F / kMapSide);
      set.sheet.push_back(
          {fit.pose.FromCamera(fit.pose.Unproject(p, std::min(depth.at[depth.Index(x, y)], 60.0F))),
           {0.5F + 0.5F * at.x, at.y}});
    }
  }
  for (int y = 0; y + 1 < rows; ++y) {
    for (int x = 0; x + 1 < columns; ++x) {
      if (std::max({opacity(x, y), opacity(x + 1, y), opacity(x, y + 1), opacity(x + 1, y + 1),
                    opacity(std::max(x - 1, 0), y), opacity(x, std::max(y - 1, 0))}) <= 0) {
        continue;
      }
      if (hidden(x, y) && hidden(x + 1, y) && hidden(x, y + 1) && hidden(x + 1, y + 1)) continue;
      const auto at = [&](int dx, int dy) {
        return static_cast<std::uint32_t>(depth.Index(x + dx, y + dy));
      };
      const std::uint32_t a = at(0, 0), b = at(0, 1), c = at(1, 1), d = at(1, 0);
      set.sheet_triangles.insert(set.sheet_triangles.end(), {a, b, c, a, c, d});
    }
  }
  set.seen_from = glm::transpose(fit.pose.Rotation()) * glm::vec3(0, 0, 1);
  set.skin_bottom_y = chin - kBelowChin;
}

}  // namespace facefit
