#include "hypermask/base/mask_layout.h"

#include <fmt/format.h>

#include <cmath>

#include "embedded/mask_default.h"
#include "hypermask/base/key_lines.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace hypermask {
namespace {

constexpr double kFarthestMm = 2000, kNearestMm = 10;

/// Whether the first four points go round clockwise (y points down) without a bend inwards.
bool CornersAreConvex(const Points& points) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Point a = points[(i + 1) % 4] - points[i], b = points[(i + 2) % 4] - points[(i + 1) % 4];
    if (!(a.x() * b.y() - a.y() * b.x() > 0)) return false;
  }
  return true;
}

}  // namespace

vm::Result<MaskLayout> ParseMaskLayout(const std::string& name, std::string_view text) {
  MaskLayout layout;
  KeyLineFormat format{.heading = "hypermask mask 1"};
  format.keys["marker"] = {
      .numbers = 2,
      .least = MaskLayout::kLeastMarkers,
      .most = MaskLayout::kMostMarkers,
      .take = [&](const std::vector<double>& n) -> std::string {
        const Point marker(n[0], n[1]);
        if (marker.cwiseAbs().maxCoeff() > kFarthestMm) {
          return fmt::format("({:g}, {:g}) is farther than {:g} mm", n[0], n[1], kFarthestMm);
        }
        for (const Point& other : layout.markers) {
          if ((marker - other).norm() < kNearestMm) {
            return fmt::format("({:g}, {:g}) lies within {:g} mm of another marker", n[0], n[1],
                               kNearestMm);
          }
        }
        layout.markers.push_back(marker);
        if (layout.markers.size() == 4 && !CornersAreConvex(layout.markers)) {
          return "the first four are not the corners of a convex figure, clockwise";
        }
        return "";
      }};
  const auto length = [](double mm) { return mm >= 1 && mm <= 2 * kFarthestMm; };
  format.keys["oval"] = {.numbers = 2, .take = [&](const std::vector<double>& n) -> std::string {
                           if (!length(n[0]) || !length(n[1])) {
                             return fmt::format("expected lengths of 1 to {:g} mm",
                                                2 * kFarthestMm);
                           }
                           layout.oval = {n[0], n[1]};
                           return "";
                         }};
  format.keys["picture"] = {
      .numbers = 3, .take = [&](const std::vector<double>& n) -> std::string {
        if (!length(n[2]) || std::abs(n[0]) > kFarthestMm || std::abs(n[1]) > kFarthestMm) {
          return fmt::format("expected a place within +-{:g} mm and a height of 1 to {:g} mm",
                             kFarthestMm, 2 * kFarthestMm);
        }
        layout.picture = {n[0], n[1]};
        layout.picture_height = n[2];
        return "";
      }};
  if (auto read = ReadKeyLines(name, text, format); !read) return std::unexpected(read.error());
  return layout;
}

vm::Result<MaskLayout> ReadMaskLayout(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxKeyLineBytes);
  if (!text) return std::unexpected(text.error());
  return ParseMaskLayout(path, *text);
}

const MaskLayout& MaskLayout::Default() {
  static const MaskLayout layout =
      vm::OrThrow(ParseMaskLayout("hypermask/tables/mask.txt", embedded::mask_default()));
  return layout;
}

}  // namespace hypermask
