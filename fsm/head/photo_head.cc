#include "fsm/head/photo_head.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

constexpr std::size_t kMostPoints = 600;
constexpr std::size_t kMostViews = 8;
constexpr std::size_t kMostVertices = 20000;

glm::vec2 Pair(const TableRow& row, std::size_t index) {
  return {row.Number(index), row.Number(index + 1)};
}

void Finite(const TableRow& row, std::size_t first) {
  for (const float v : row.Numbers(first)) {
    if (!(std::abs(v) < 1e5f)) row.Fail("a number out of bounds");
  }
}

constexpr float kRadians = std::numbers::pi_v<float> / 180;

/// eye SIDE DX DY DZ TURN SIZE UPPER LOWER
void ReadEye(const TableRow& row, PhotoHead& set) {
  const std::string side = row.Word(1);
  if (side != "right" && side != "left") row.Fail("'right' or 'left' expected");
  const EyeTransform seat{.shift = row.Vector(2),
                          .turn = row.Number(5) * kRadians,
                          .size = row.Number(6),
                          .upper_mm = row.Number(7),
                          .lower_mm = row.Number(8)};
  if (!(seat.size >= 0.5f && seat.size <= 2)) row.Fail("a size from 0.5 to 2 expected");
  if (!set.eyes) set.eyes.emplace();
  (*set.eyes)[side == "left" ? 1 : 0] = seat;
}

/// eye_picture SIDE, then left, top, right and bottom of iris and ball
void ReadEyePicture(const TableRow& row, std::array<std::optional<EyePicture>, 2>& eyes) {
  const std::string side = row.Word(1);
  if (side != "right" && side != "left") row.Fail("'right' or 'left' expected");
  const EyePicture eye{{Pair(row, 2), Pair(row, 4)}, {Pair(row, 6), Pair(row, 8)}};
  for (const glm::vec4& p : {eye.iris, eye.ball}) {
    if (p.x < 0 || p.y < 0 || p.z > 1 || p.w > 1 || p.x >= p.z || p.y >= p.w) {
      row.Fail("left, top, right and bottom within 0 to 1 expected");
    }
  }
  eyes[side == "left" ? 1 : 0] = eye;
}

}  // namespace

PhotoHead ReadPhotoHead(const std::string& name, std::string_view text) {
  PhotoHead set;
  const Table table(name, text);
  std::array<std::optional<EyePicture>, 2> pictures;
  for (const TableRow& row : table.rows()) {
    const std::string& key = row.key();
    if (key == "base") {
      set.base = row.Word(1);
      continue;
    }
    Finite(row, key == "eye" || key == "eye_picture" ? 2 : 1);
    if (key == "smooth") {
      set.smooth = std::max(row.Number(1), 0.0f);
    } else if (key == "iris") {
      set.iris_colour = row.Vector(1);
      if (row.size() > 4) set.iris_size = std::clamp(row.Number(4), 0.7f, 1.3f);
    } else if (key == "glasses") {
      set.glasses = row.Number(1) != 0;
    } else if (key == "teeth") {
      set.teeth = std::clamp(row.Number(1), 0.0f, 2.0f);
    } else if (key == "lip") {
      set.lip_colour = row.Vector(1);
    } else if (key == "eye") {
      ReadEye(row, set);
    } else if (key == "eye_picture") {
      ReadEyePicture(row, pictures);
    } else if (key == "saturation") {
      set.saturation = std::clamp(row.Number(1), 0.0f, 1.0f);
    } else if (key == "lined") {
      set.lined = std::clamp(row.Number(1), 0.0f, 1.0f);
    } else if (key == "white") {
      set.white_colour = row.Vector(1);
    } else if (key == "skin") {
      set.skin_low = Pair(row, 1);
      set.skin_high = Pair(row, 3);
      set.skin_bottom_y = row.Number(5);
    } else if (key == "seen_from") {
      set.seen_from = row.Vector(1);
    } else if (key == "also_seen") {
      if (set.also_seen.size() == kMostViews) row.Fail("more views than are read");
      set.also_seen.push_back(row.Vector(1));
    } else if (key == "point") {
      if (set.points.size() == kMostPoints) row.Fail("more points than are read");
      set.points.push_back({row.Vector(1), row.Vector(4)});
    } else if (key == "vertex") {
      if (set.sheet.size() == kMostVertices) row.Fail("more vertices than are read");
      set.sheet.push_back({row.Vector(1), Pair(row, 4)});
    } else if (key == "quad") {
      std::array<std::uint32_t, 4> corner{};
      for (std::size_t k = 0; k < 4; ++k) {
        const int i = row.Integer(k + 1);
        if (i < 0 || static_cast<std::size_t>(i) >= set.sheet.size()) {
          row.Fail("a corner that is no vertex before it");
        }
        corner[k] = static_cast<std::uint32_t>(i);
      }
      if (set.sheet_triangles.size() > 6 * kMostVertices) row.Fail("more quads than are read");
      for (const std::size_t k : {0U, 1U, 2U, 0U, 2U, 3U}) set.sheet_triangles.push_back(corner[k]);
    } else {
      row.Fail("unknown word '" + key + "'");
    }
  }
  if (pictures[0] && pictures[1]) set.eye_pictures = {*pictures[0], *pictures[1]};
  return set;
}

std::string WritePhotoHead(const PhotoHead& set) {
  std::string out =
      "# A face from a photo; docs/photo.md says what each line means.\nbase " + set.base + "\n";
  std::array<char, 256> line;
  const auto put = [&](const char* format, auto... values) {
    std::snprintf(line.data(), line.size(), format, values...);
    out += line.data();
  };
  const auto d = [](float v) { return static_cast<double>(v); };
  put("smooth %.3f\n", d(set.smooth));
  put("saturation %.2f\n", d(set.saturation));
  put("lined %.2f\n", d(set.lined));
  put("iris %.4f %.4f %.4f %.3f\n", d(set.iris_colour.x), d(set.iris_colour.y),
      d(set.iris_colour.z), d(set.iris_size));
  if (set.glasses) put("glasses %d\n", 1);
  put("teeth %.2f\n", d(set.teeth));
  put("white %.4f %.4f %.4f\n", d(set.white_colour.x), d(set.white_colour.y),
      d(set.white_colour.z));
  if (set.lip_colour) {
    const glm::vec3 c = *set.lip_colour;
    put("lip %.4f %.4f %.4f\n", d(c.x), d(c.y), d(c.z));
  }
  for (std::size_t i = 0; set.eyes && i < 2; ++i) {
    const EyeTransform& eye = (*set.eyes)[i];
    put("eye %s %.3f %.3f %.3f  %.2f %.4f  %.3f %.3f\n", i == 0 ? "right" : "left", d(eye.shift.x),
        d(eye.shift.y), d(eye.shift.z), d(eye.turn / kRadians), d(eye.size), d(eye.upper_mm),
        d(eye.lower_mm));
  }
  for (std::size_t i = 0; set.eye_pictures && i < 2; ++i) {
    put("eye_picture %s", i == 0 ? "right" : "left");
    for (const glm::vec4& p : {(*set.eye_pictures)[i].iris, (*set.eye_pictures)[i].ball}) {
      put("  %.6f %.6f %.6f %.6f", d(p.x), d(p.y), d(p.z), d(p.w));
    }
    out += '\n';
  }
  put("skin %.5f %.5f %.5f %.5f %.2f\n", d(set.skin_low.x), d(set.skin_low.y), d(set.skin_high.x),
      d(set.skin_high.y), d(set.skin_bottom_y));
  put("seen_from %.4f %.4f %.4f\n", d(set.seen_from.x), d(set.seen_from.y), d(set.seen_from.z));
  for (const glm::vec3& v : set.also_seen)
    put("also_seen %.4f %.4f %.4f\n", d(v.x), d(v.y), d(v.z));
  out += "# point: of the base face at rest, and how it moves, millimetres\n";
  for (const WarpPoint& p : set.points) {
    put("point %.3f %.3f %.3f  %.3f %.3f %.3f\n", d(p.at.x), d(p.at.y), d(p.at.z), d(p.by.x),
        d(p.by.y), d(p.by.z));
  }
  out += "# the sheet of hair, neck and clothes: place in millimetres, place in photo.png\n";
  for (const auto& v : set.sheet) {
    put("vertex %.2f %.2f %.2f  %.5f %.5f\n", d(v.position.x), d(v.position.y), d(v.position.z),
        d(v.place.x), d(v.place.y));
  }
  for (std::size_t i = 0; i + 5 < set.sheet_triangles.size(); i += 6) {
    put("quad %u %u %u %u\n", set.sheet_triangles[i], set.sheet_triangles[i + 1],
        set.sheet_triangles[i + 2], set.sheet_triangles[i + 5]);
  }
  return out;
}

}  // namespace fsm
