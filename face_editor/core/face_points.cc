#include "face_editor/core/face_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/head/observed_head.h"

namespace editor {
namespace {

constexpr int kPoints = static_cast<int>(facefit::kNetworkPoints);
using facefit::PointIndex;
constexpr int kEyeRight = facefit::point::kEyeOuterRight, kEyeLeft = facefit::point::kEyeOuterLeft;

// Numbers of MediaPipe's face mesh.
constexpr PointIndex kRightBrow[] = {70, 63, 105, 66, 107, 46, 53, 52, 65, 55};
constexpr PointIndex kLeftBrow[] = {300, 293, 334, 296, 336, 276, 283, 282, 295, 285};
constexpr PointIndex kNose[] = {168, 6,  197, 195, 5,   4,   1,  19,  94, 2,
                                98,  97, 326, 327, 129, 358, 64, 294, 48, 278};
constexpr PointIndex kJaw[] = {234, 93,  132, 58,  172, 136, 150, 149, 176, 148, 152,
                               377, 400, 378, 379, 365, 397, 288, 361, 323, 454};

std::vector<int> Joined(std::initializer_list<std::span<const PointIndex>> lists) {
  std::vector<int> all;
  for (const auto& list : lists) {
    for (const PointIndex i : list) all.push_back(static_cast<int>(i));
  }
  std::ranges::sort(all);
  const auto rest = std::ranges::unique(all);
  all.erase(rest.begin(), rest.end());
  return all;
}

std::vector<PointGroup> MakeGroups() {
  using namespace facefit;
  std::vector<int> all(static_cast<std::size_t>(kPoints));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return {{"right_eye", "Right eye", Joined({point::kEyeOutline[fsm::Side::kRight]})},
          {"left_eye", "Left eye", Joined({point::kEyeOutline[fsm::Side::kLeft]})},
          {"right_brow_line", "Right brow", Joined({kRightBrow})},
          {"left_brow_line", "Left brow", Joined({kLeftBrow})},
          {"nose", "Nose", Joined({kNose})},
          {"upper_lip", "Upper lip",
           Joined({point::kUpperOuterLip, point::kUpperInnerLip, point::kInnerMouthCorners})},
          {"lower_lip", "Lower lip", Joined({point::kLowerOuterLip, point::kLowerInnerLip})},
          {"mouth", "Mouth",
           Joined({point::kUpperOuterLip, point::kUpperInnerLip, point::kLowerOuterLip,
                   point::kLowerInnerLip, point::kMouthCorners, point::kInnerMouthCorners})},
          {"jaw", "Jaw and chin", Joined({kJaw})},
          {"face", "Whole face", all}};
}

/// 1 at the point, 0 from `reach` on, level at both ends.
float Falloff(float distance, float reach) {
  if (distance >= reach) return 0;
  const float t = 1 - distance * distance / (reach * reach);
  return t * t;
}

}  // namespace

Mirror MirrorOf(std::span<const glm::vec3> places) {
  Mirror mirror(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3 other = places[i] * glm::vec3(-1, 1, 1);
    const auto nearest = std::ranges::min_element(
        places, {}, [&](const glm::vec3& p) { return glm::distance(p, other); });
    mirror[i] = static_cast<int>(nearest - places.begin());
  }
  // Where two points lie close together both may choose the same: only mutual choices count.
  const Mirror chosen = mirror;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (chosen[static_cast<std::size_t>(chosen[i])] != static_cast<int>(i)) {
      mirror[i] = static_cast<int>(i);
    }
  }
  return mirror;
}

Mirror MirrorByName() {
  Mirror mirror(static_cast<std::size_t>(kPoints));
  for (int i = 0; i < kPoints; ++i) mirror[static_cast<std::size_t>(i)] = i;
  for (const auto& a : facefit::NamedPoints()) {
    const std::string right(a.name);
    const std::size_t at = right.find("right");
    if (at == std::string::npos) continue;
    std::string left = right;
    left.replace(at, 5, "left");
    for (const auto& b : facefit::NamedPoints()) {
      if (b.name != left) continue;
      mirror[a.point] = static_cast<int>(b.point);
      mirror[b.point] = static_cast<int>(a.point);
    }
  }
  return mirror;
}

const std::vector<PointGroup>& PointGroups() {
  static const std::vector<PointGroup> groups = MakeGroups();
  return groups;
}

bool IsNamed(int point) {
  return std::ranges::any_of(facefit::NamedPoints(), [point](const auto& named) {
    return static_cast<int>(named.point) == point;
  });
}

std::string PointName(int point) {
  for (const auto& named : facefit::NamedPoints()) {
    if (static_cast<int>(named.point) == point) return std::string(named.name);
  }
  return std::to_string(point);
}

vm::Result<std::set<int>> PointsNamed(std::string_view word) {
  for (const auto& named : facefit::NamedPoints()) {
    if (named.name == word) return std::set<int>{static_cast<int>(named.point)};
  }
  std::string groups;
  for (const PointGroup& group : PointGroups()) {
    if (group.name == word) return std::set<int>(group.points.begin(), group.points.end());
    groups += " " + std::string(group.name);
  }
  int number = 0;
  bool digits = !word.empty() && word.size() <= 3;
  for (const char c : word) {
    digits = digits && c >= '0' && c <= '9';
    number = 10 * number + (c - '0');
  }
  if (digits && number < kPoints) return std::set<int>{number};
  return vm::Fail(vm::Errc::kBadValue, "'" + std::string(word.substr(0, 40)) +
                                           "' is no point; 0 to 467, " + facefit::PointNamesText() +
                                           " or a group:" + groups + " expected");
}

glm::vec2 Median(const PointMap& points, const Mirror& mirror) {
  // Pairs are joined by lines across the face; the median stands square on them.
  glm::vec2 across(0);
  for (const auto& [i, at] : points) {
    const int other = mirror[static_cast<std::size_t>(i)];
    const auto there = points.find(other);
    if (other <= i || there == points.end()) continue;
    glm::vec2 d = glm::vec2(there->second) - glm::vec2(at);
    if (glm::dot(d, across) < 0) d = -d;
    across += d;
  }
  const float length = glm::length(across);
  if (length < 1e-3F) return {0, 1};
  const glm::vec2 down = glm::vec2(-across.y, across.x) / length;
  return down.y < 0 ? -down : down;
}

float EyeDistance(const PointMap& points) {
  const auto right = points.find(kEyeRight), left = points.find(kEyeLeft);
  if (right == points.end() || left == points.end()) return 0;
  return glm::distance(glm::vec2(right->second), glm::vec2(left->second));
}

PointMap Dragged(const PointMap& from, const Mirror& mirror, const Drag& drag) {
  const glm::vec2 down = Median(from, mirror);
  const auto other_of = [&](int i) { return mirror[static_cast<std::size_t>(i)]; };
  // Each point moved, with how.
  std::map<int, glm::vec2> moved;
  const glm::vec2 along = down * glm::dot(drag.by, down);
  const bool all_middle = std::ranges::all_of(drag.points, [&](int i) { return other_of(i) == i; });
  const bool whole = std::ranges::any_of(
      drag.points, [&](int i) { return other_of(i) != i && drag.points.contains(other_of(i)); });
  for (const int i : drag.points) {
    moved[i] = drag.symmetric && all_middle && !whole ? along : drag.by;
  }
  if (drag.symmetric && !whole) {
    for (const int i : drag.points) {
      if (!drag.points.contains(other_of(i))) moved[other_of(i)] = 2.0F * along - drag.by;
    }
  }
  PointMap out = from;
  for (auto& [i, at] : out) {
    const auto own = moved.find(i);
    if (own != moved.end()) {
      at += glm::vec3(own->second, 0);
      continue;
    }
    if (drag.reach <= 0) continue;
    glm::vec2 sum(0);
    float weights = 0, most = 0;
    for (const auto& [k, by] : moved) {
      const auto there = from.find(k);
      if (there == from.end()) continue;
      const float w = Falloff(glm::distance(glm::vec2(there->second), glm::vec2(at)), drag.reach);
      sum += w * by;
      weights += w;
      most = std::max(most, w);
    }
    if (weights > 0) at += glm::vec3(sum * (most / weights), 0);
  }
  return out;
}

PointMap PlainPoints(int width, int height) {
  // Parts of the height of a face from brow to chin, from the tip of the nose; a plain drawing.
  struct Place {
    std::string_view name;
    float x, y;
  };
  constexpr Place kPlaces[] = {
      {"eye_outer", 0.29F, -0.25F}, {"eye_inner", 0.11F, -0.24F}, {"eye_top", 0.2F, -0.28F},
      {"eye_bottom", 0.2F, -0.22F}, {"brow", 0.22F, -0.38F},      {"nose_tip", 0, 0},
      {"nose_bottom", 0, 0.07F},    {"nose", 0.11F, 0.02F},       {"mouth", 0.16F, 0.24F},
      {"lip_top", 0, 0.19F},        {"lip_bottom", 0, 0.32F},     {"chin", 0, 0.53F},
      {"jaw", 0.3F, 0.35F},         {"cheek", 0.42F, -0.15F},     {"forehead", 0, -0.6F}};
  const float size = 0.5F * static_cast<float>(std::min(width, height));
  const glm::vec2 middle(0.5F * static_cast<float>(width), 0.5F * static_cast<float>(height));
  PointMap points;
  for (const auto& named : facefit::NamedPoints()) {
    std::string plain(named.name);
    float side = 0;
    for (const auto& [word, sign] : {std::pair("right", -1.0F), std::pair("left", 1.0F)}) {
      const std::size_t at = plain.find(word);
      if (at == std::string::npos) continue;
      side = sign;
      // "right_eye_top" and "mouth_right": the word goes with the line that joins it.
      const std::size_t length = std::string_view(word).size() + 1;
      plain.erase(at == 0 ? 0 : at - 1, length);
    }
    const auto place = std::ranges::find(kPlaces, plain, &Place::name);
    if (place == std::end(kPlaces)) continue;
    points[static_cast<int>(named.point)] =
        glm::vec3(middle + size * glm::vec2((side == 0 ? 0 : side) * place->x, place->y), 0);
  }
  return points;
}

std::string WritePoints(const PointMap& points) {
  std::string text =
      "# Points on a photo: face_fit PHOTO --points THIS --name NAME makes a face of them.\n"
      "# NAME or number in MediaPipe's face mesh, X Y in pixels of the upright photo.\n";
  std::array<char, 80> line;
  for (const auto& [i, at] : points) {
    std::snprintf(line.data(), line.size(), "%s %.2f %.2f\n", PointName(i).c_str(),
                  static_cast<double>(at.x), static_cast<double>(at.y));
    text += line.data();
  }
  return text;
}

}  // namespace editor
