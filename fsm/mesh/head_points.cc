#include "fsm/mesh/head_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "fsm/base/table_reader.h"
#include "fsm/rig/reach.h"

namespace fsm {
namespace {

constexpr std::array<const char*, 5> kFeatureNames{"plain", "upper_lip", "lower_lip", "upper_lid",
                                                   "lower_lid"};
constexpr std::size_t kMaxPairs = 2000;

PointPair ReadPair(const TableRow& row) {
  if (row.key() != "point" || row.size() != 8) {
    row.Refuse("face NAME or point PART X Y Z X Y Z expected");
  }
  const auto on = std::ranges::find(kFeatureNames, row.Word(1));
  if (on == kFeatureNames.end())
    row.Refuse("plain, upper_lip, lower_lip, upper_lid or lower_lid expected");
  const glm::vec3 from = row.Vector(2), to = row.Vector(5);
  if (!WithinReach(from) || !WithinReach(to)) {
    row.Refuse("six numbers of at most 10000000 expected after the part");
  }
  return {from, to, static_cast<FaceFeature>(on - kFeatureNames.begin())};
}

}  // namespace

vm::Result<HeadPoints> ParseHeadPoints(const std::string& name, std::string_view text) {
  return ReadTable(name, text, [](const Table& table) {
    HeadPoints points;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "face" && row.size() == 2) {
        points.face = row.Word(1);
      } else {
        points.pairs.push_back(ReadPair(row));
      }
      if (points.pairs.size() > kMaxPairs) {
        row.Refuse("at most " + std::to_string(kMaxPairs) + " points are read");
      }
    }
    if (points.pairs.size() < 8) {
      table.Refuse("at least eight points expected, " + std::to_string(points.pairs.size()) +
                   " are there");
    }
    return points;
  });
}

std::string FormatHeadPoints(const HeadPoints& points) {
  std::string out = "face " + points.face + "\n";
  std::array<char, 200> line{};
  for (const PointPair& pair : points.pairs) {
    const auto d = [](float v) { return static_cast<double>(v); };
    std::snprintf(line.data(), line.size(), "point %s %.3f %.3f %.3f  %.7g %.7g %.7g\n",
                  kFeatureNames[static_cast<std::size_t>(pair.feature)], d(pair.from.x),
                  d(pair.from.y), d(pair.from.z), d(pair.to.x), d(pair.to.y), d(pair.to.z));
    out += line.data();
  }
  return out;
}

namespace {

/// Returns the unit eigenvector of a symmetric matrix for its largest eigenvalue, by repeated
/// squaring (power iteration).
glm::dvec4 LargestEigenvector(const glm::dmat4& n) {
  double bound = 0;
  for (int c = 0; c < 4; ++c) {
    double sum = 0;
    for (int r = 0; r < 4; ++r) sum += std::abs(n[c][r]);
    bound = std::max(bound, sum);
  }
  glm::dmat4 power = n + glm::dmat4(bound);  // no eigenvalue below zero
  for (int k = 0; k < 24; ++k) {
    double most = 1e-300;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) most = std::max(most, std::abs(power[c][r]));
    }
    power = (1 / most) * power;
    power = power * power;
  }
  glm::dvec4 axis = power[0];
  for (int c = 1; c < 4; ++c) {
    if (glm::length(power[c]) > glm::length(axis)) axis = power[c];
  }
  return glm::normalize(axis);
}

}  // namespace

Similarity FitSimilarity(std::span<const PointPair> pairs) {
  // Horn, "Closed-form solution of absolute orientation using unit quaternions", 1987: the rotation
  // is the eigenvector of the largest eigenvalue of a 4 x 4 matrix.
  glm::dvec3 from_mean(0), to_mean(0);
  for (const PointPair& pair : pairs) {
    from_mean += glm::dvec3(pair.from);
    to_mean += glm::dvec3(pair.to);
  }
  from_mean /= static_cast<double>(pairs.size());
  to_mean /= static_cast<double>(pairs.size());
  glm::dmat3 s(0.0);
  double from_size = 0, to_size = 0;
  for (const PointPair& pair : pairs) {
    const glm::dvec3 f = glm::dvec3(pair.from) - from_mean, t = glm::dvec3(pair.to) - to_mean;
    s += glm::outerProduct(f, t);  // s[c][r] = f_r t_c
    from_size += glm::dot(f, f);
    to_size += glm::dot(t, t);
  }
  const auto m = [&s](int t, int f) { return s[t][f]; };
  const glm::dmat4 n(m(0, 0) + m(1, 1) + m(2, 2), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2),
                     m(0, 1) - m(1, 0), m(1, 2) - m(2, 1), m(0, 0) - m(1, 1) - m(2, 2),
                     m(0, 1) + m(1, 0), m(2, 0) + m(0, 2), m(2, 0) - m(0, 2), m(0, 1) + m(1, 0),
                     -m(0, 0) + m(1, 1) - m(2, 2), m(1, 2) + m(2, 1), m(0, 1) - m(1, 0),
                     m(2, 0) + m(0, 2), m(1, 2) + m(2, 1), -m(0, 0) - m(1, 1) + m(2, 2));
  const glm::dvec4 axis = LargestEigenvector(n);
  Similarity fit;
  fit.rotation = glm::mat3(glm::mat3_cast(glm::dquat(axis[0], axis[1], axis[2], axis[3])));
  fit.scale = static_cast<float>(std::sqrt(from_size / std::max(to_size, 1e-12)));
  fit.translation = glm::vec3(from_mean) - fit.scale * (fit.rotation * glm::vec3(to_mean));
  return fit;
}

}  // namespace fsm
