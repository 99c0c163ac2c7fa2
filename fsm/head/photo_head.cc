#include "fsm/head/photo_head.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <map>

#include "fsm/base/table_reader.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxPoints = 600;
constexpr std::size_t kMaxViews = 8;
constexpr std::size_t kMaxVertices = 20000;

glm::vec2 Pair(const TableRow& row, std::size_t index) {
  return {row.Number(index), row.Number(index + 1)};
}

void Finite(const TableRow& row, std::size_t first) {
  for (const float v : row.Numbers(first)) {
    if (!(std::abs(v) < 1e5f)) row.Refuse("a number out of bounds");
  }
}

Side SideOf(const TableRow& row) {
  const std::string& side = row.Word(1);
  if (side != "right" && side != "left") row.Refuse("'right' or 'left' expected");
  return side == "left" ? Side::kLeft : Side::kRight;
}

/// Reads "eye SIDE DX DY DZ TURN SIZE UPPER LOWER".
void ReadEye(const TableRow& row, PhotoHead& photo_head) {
  const EyeTransform eye{.shift = row.Vector(2),
                         .roll = glm::radians(row.Number(5)),
                         .size = row.Number(6),
                         .upper_mm = row.Number(7),
                         .lower_mm = row.Number(8)};
  if (!(eye.size >= 0.5f && eye.size <= 2)) row.Refuse("a size from 0.5 to 2 expected");
  if (!photo_head.eyes) photo_head.eyes.emplace();
  (*photo_head.eyes)[SideOf(row)] = eye;
}

/// Reads "eye_picture SIDE", then left, top, right and bottom of iris and ball.
EyePicture ReadEyePicture(const TableRow& row) {
  const EyePicture eye{{Pair(row, 2), Pair(row, 4)}, {Pair(row, 6), Pair(row, 8)}};
  for (const glm::vec4& p : {eye.iris, eye.ball}) {
    if (p.x < 0 || p.y < 0 || p.z > 1 || p.w > 1 || p.x >= p.z || p.y >= p.w) {
      row.Refuse("left, top, right and bottom within 0 to 1 expected");
    }
  }
  return eye;
}

void ReadIris(const TableRow& row, PhotoHead& photo_head) {
  photo_head.iris_colour = row.Vector(1);
  if (row.size() > 4) photo_head.iris_size = std::clamp(row.Number(4), 0.7f, 1.3f);
}

void ReadSkin(const TableRow& row, PhotoHead& photo_head) {
  photo_head.skin_low = Pair(row, 1);
  photo_head.skin_high = Pair(row, 3);
  photo_head.skin_bottom_y = row.Number(5);
}

/// Reads "quad A B C D": indices of vertices in rows before it.
void ReadQuad(const TableRow& row, PhotoHead& photo_head) {
  std::array<std::uint32_t, 4> corner{};
  for (std::size_t k = 0; k < 4; ++k) {
    const int i = row.Integer(k + 1);
    if (i < 0 || static_cast<std::size_t>(i) >= photo_head.sheet.size()) {
      row.Refuse("a corner that is no vertex before it");
    }
    corner[k] = static_cast<std::uint32_t>(i);
  }
  for (const std::size_t k : {0U, 1U, 2U, 0U, 2U, 3U})
    photo_head.sheet_triangles.push_back(corner[k]);
}

void CheckRoom(const TableRow& row, std::size_t count, std::size_t max, const char* what) {
  if (count >= max) row.Refuse(std::string("more ") + what + " than are read");
}

float Clamped(const TableRow& row, float min, float max) {
  return std::clamp(row.Number(1), min, max);
}

/// The function that applies each kind of row to a head, by key word.
const std::map<std::string_view, void (*)(const TableRow&, PhotoHead&)> kRows = {
    {"smooth",
     [](auto& row, auto& photo_head) { photo_head.smooth = std::max(row.Number(1), 0.0f); }},
    {"iris", ReadIris},
    {"glasses", [](auto& row, auto& photo_head) { photo_head.glasses = row.Number(1) != 0; }},
    {"teeth", [](auto& row, auto& photo_head) { photo_head.teeth = Clamped(row, 0, 2); }},
    {"lip", [](auto& row, auto& photo_head) { photo_head.lip_colour = row.Vector(1); }},
    {"eye", ReadEye},
    {"saturation", [](auto& row, auto& photo_head) { photo_head.saturation = Clamped(row, 0, 1); }},
    {"lined", [](auto& row, auto& photo_head) { photo_head.lined = Clamped(row, 0, 1); }},
    {"white", [](auto& row, auto& photo_head) { photo_head.white_colour = row.Vector(1); }},
    {"skin", ReadSkin},
    {"seen_from", [](auto& row, auto& photo_head) { photo_head.seen_from = row.Vector(1); }},
    {"also_seen",
     [](auto& row, auto& photo_head) {
       CheckRoom(row, photo_head.also_seen.size(), kMaxViews, "views");
       photo_head.also_seen.push_back(row.Vector(1));
     }},
    {"point",
     [](auto& row, auto& photo_head) {
       CheckRoom(row, photo_head.points.size(), kMaxPoints, "points");
       photo_head.points.push_back({row.Vector(1), row.Vector(4)});
     }},
    {"vertex",
     [](auto& row, auto& photo_head) {
       CheckRoom(row, photo_head.sheet.size(), kMaxVertices, "vertices");
       photo_head.sheet.push_back({row.Vector(1), Pair(row, 4)});
     }},
    {"quad", [](auto& row, auto& photo_head) {
       CheckRoom(row, photo_head.sheet_triangles.size(), 6 * kMaxVertices + 1, "quads");
       ReadQuad(row, photo_head);
     }}};

}  // namespace

PhotoHead ReadPhotoHead(const std::string& name, std::string_view text) {
  PhotoHead photo_head;
  const Table table(name, text);
  Sided<std::optional<EyePicture>> pictures;
  for (const TableRow& row : table.rows()) {
    const std::string& key = row.key();
    if (key == "base") {
      photo_head.base = row.Word(1);
      continue;
    }
    Finite(row, key == "eye" || key == "eye_picture" ? 2 : 1);
    if (key == "eye_picture") {
      pictures[SideOf(row)] = ReadEyePicture(row);
    } else if (const auto known = kRows.find(key); known != kRows.end()) {
      known->second(row, photo_head);
    } else {
      row.Refuse("unknown word '" + key + "'");
    }
  }
  if (pictures.right && pictures.left) photo_head.eye_pictures = {*pictures.right, *pictures.left};
  return photo_head;
}

namespace {

/// Returns the components of a vector, separated by blanks.
template <typename Vector>
auto Words(const Vector& v) {
  return fmt::join(&v[0], &v[0] + Vector::length(), " ");
}

std::string WriteEyes(const PhotoHead& photo_head) {
  constexpr Sided<const char*> kNames{"right", "left"};
  std::string out;
  for (const Side side : kSides) {
    if (!photo_head.eyes) continue;
    const EyeTransform& eye = (*photo_head.eyes)[side];
    out +=
        fmt::format("eye {} {:.3f}  {:.2f} {:.4f}  {:.3f} {:.3f}\n", kNames[side], Words(eye.shift),
                    glm::degrees(eye.roll), eye.size, eye.upper_mm, eye.lower_mm);
  }
  for (const Side side : kSides) {
    if (!photo_head.eye_pictures) continue;
    const EyePicture& picture = (*photo_head.eye_pictures)[side];
    out += fmt::format("eye_picture {}  {:.6f}  {:.6f}\n", kNames[side], Words(picture.iris),
                       Words(picture.ball));
  }
  return out;
}

std::string WriteSheet(const PhotoHead& photo_head) {
  std::string out =
      "# the sheet of hair, neck and clothes: place in millimetres, place in photo.png\n";
  for (const auto& v : photo_head.sheet) {
    out += fmt::format("vertex {:.2f}  {:.5f}\n", Words(v.position), Words(v.texcoord));
  }
  const auto& corners = photo_head.sheet_triangles;
  for (std::size_t i = 0; i + 5 < corners.size(); i += 6) {
    out += fmt::format("quad {} {} {} {}\n", corners[i], corners[i + 1], corners[i + 2],
                       corners[i + 5]);
  }
  return out;
}

}  // namespace

std::string WritePhotoHead(const PhotoHead& photo_head) {
  std::string out = "# A face from a photo; docs/photo.md says what each line means.\nbase " +
                    photo_head.base + "\n";
  out += fmt::format("smooth {:.3f}\nsaturation {:.2f}\nlined {:.2f}\n", photo_head.smooth,
                     photo_head.saturation, photo_head.lined);
  out += fmt::format("iris {:.4f} {:.3f}\n", Words(photo_head.iris_colour), photo_head.iris_size);
  if (photo_head.glasses) out += "glasses 1\n";
  out +=
      fmt::format("teeth {:.2f}\nwhite {:.4f}\n", photo_head.teeth, Words(photo_head.white_colour));
  if (photo_head.lip_colour) out += fmt::format("lip {:.4f}\n", Words(*photo_head.lip_colour));
  out += WriteEyes(photo_head);
  out += fmt::format("skin {:.5f} {:.5f} {:.2f}\n", Words(photo_head.skin_low),
                     Words(photo_head.skin_high), photo_head.skin_bottom_y);
  out += fmt::format("seen_from {:.4f}\n", Words(photo_head.seen_from));
  for (const glm::vec3& v : photo_head.also_seen)
    out += fmt::format("also_seen {:.4f}\n", Words(v));
  out += "# point: of the base face at rest, and how it moves, millimetres\n";
  for (const WarpPoint& p : photo_head.points) {
    out += fmt::format("point {:.3f}  {:.3f}\n", Words(p.position), Words(p.displacement));
  }
  return out + WriteSheet(photo_head);
}

}  // namespace fsm
