#include "fsm/head/face_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace fsm {
namespace {

constexpr std::size_t kMirrored = 3;  // columns repeated beyond each end

std::vector<float> MirroredKnots(const std::vector<float>& columns) {
  std::vector<float> knots;
  const float end = columns.back();
  for (std::size_t i = kMirrored; i > 0; --i) knots.push_back(-columns[i]);
  knots.insert(knots.end(), columns.begin(), columns.end());
  for (std::size_t i = 1; i <= kMirrored; ++i) {
    knots.push_back(2 * end - columns[columns.size() - 1 - i]);
  }
  return knots;
}

std::vector<float> ReadColumns(const Table& cage) {
  const TableRow& row = cage.Only("columns");
  std::vector<float> columns = row.Numbers(1);
  if (columns.size() < kMirrored + 2) row.Fail("too few columns");
  if (!std::ranges::is_sorted(columns) || columns.front() != 0) {
    row.Fail("columns must ascend from 0");
  }
  return columns;
}

// Rows are given from the crown down; the basis wants ascending knots, so it runs over -b.
std::vector<float> ReadRowKnots(const Table& cage) {
  std::vector<float> knots;
  for (const TableRow& row : cage.RowsOf("row")) {
    knots.push_back(-row.Number(1));
    if (knots.size() > 1 && knots.back() <= knots[knots.size() - 2]) row.Fail("rows must descend");
  }
  if (knots.size() < 3) cage.Only("row");
  return knots;
}

// The larger of two heights with a rounded corner of size `round` where they meet.
float SmoothMax(float p, float q, float round) {
  const float h = std::max(round - std::abs(p - q), 0.0f) / round;
  return std::max(p, q) + h * h * round * 0.25f;
}

}  // namespace

FaceSurface::FaceSurface(const Table& cage, const Table& features)
    : columns_(ReadColumns(cage)), across_(MirroredKnots(columns_)), down_(ReadRowKnots(cage)) {
  for (const TableRow& row : cage.RowsOf("row")) {
    if (row.size() != 3 + 3 * columns_.size()) row.Fail("needs x y z for every column");
    for (std::size_t c = 0; c < columns_.size(); ++c) cage_.push_back(row.Vector(3 + 3 * c));
  }
  for (const TableRow& row : features.RowsOf("bump")) {
    const float turn = row.Number(6) * std::numbers::pi_v<float> / 180;
    bumps_.push_back({.at = {row.Number(2), row.Number(3)},
                      .size = {row.Number(4), row.Number(5)},
                      .turn = {std::cos(turn), std::sin(turn)},
                      .by = row.Vector(7)});
    if (bumps_.back().size.x <= 0 || bumps_.back().size.y <= 0) row.Fail("size must be positive");
  }
  for (const TableRow& row : features.RowsOf("nose_ball")) {
    balls_.push_back({.centre = row.Vector(2), .radii = row.Vector(5)});
  }
  std::vector<float> y, z, width;
  for (const TableRow& row : features.RowsOf("nose_ridge")) {
    y.insert(y.begin(), row.Number(1));
    z.insert(z.begin(), row.Number(2));
    width.insert(width.begin(), row.Number(3));
    if (y.size() > 1 && y[0] >= y[1]) row.Fail("nose_ridge rows must descend");
  }
  if (y.size() < 2) features.Only("nose_ridge");
  ridge_z_ = Curve(y, z);
  ridge_width_ = Curve(y, width);
}

glm::vec3 FaceSurface::Cage(glm::vec2 domain) const {
  std::array<float, 64> wa, wb;
  const std::size_t na = across_.knots().size();
  const std::size_t nb = down_.knots().size();
  const std::size_t nc = columns_.size();
  across_.Weights(domain.x, {wa.data(), na});
  down_.Weights(-domain.y, {wb.data(), nb});
  glm::vec3 sum(0);
  for (std::size_t r = 0; r < nb; ++r) {
    glm::vec3 row(0);
    for (std::size_t k = 0; k < na; ++k) {
      const auto c = static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(kMirrored);
      const auto last = static_cast<std::ptrdiff_t>(nc) - 1;
      const auto mirrored = static_cast<std::size_t>(c < 0 ? -c : c > last ? 2 * last - c : c);
      glm::vec3 p = cage_[r * nc + mirrored];
      if (c < 0 || c > last) p.x = -p.x;
      row += wa[k] * p;
    }
    sum += wb[r] * row;
  }
  return sum;
}

glm::vec3 FaceSurface::Bumps(glm::vec2 domain) const {
  glm::vec3 sum(0);
  for (const Bump& bump : bumps_) {
    for (const float side : {1.0f, -1.0f}) {
      if (side < 0 && bump.at.x == 0) continue;
      const glm::vec2 d(side * domain.x - bump.at.x, domain.y - bump.at.y);
      const float along = (d.x * bump.turn.x + d.y * bump.turn.y) / bump.size.x;
      const float across = (d.y * bump.turn.x - d.x * bump.turn.y) / bump.size.y;
      const float weight = std::exp(-0.5f * (along * along + across * across));
      sum += weight * glm::vec3(side * bump.by.x, bump.by.y, bump.by.z);
    }
  }
  return sum;
}

float FaceSurface::Nose(float x, float y, float z) const {
  x = std::abs(x);
  // The ridge stands on the cage only between brow and lip; its ends fade into it.
  const float fade = SmoothStep(44, 34, y) * SmoothStep(-27, -21, y);
  if (fade > 0) {
    const float t = x / ridge_width_(y);
    const float shape = std::exp(-0.9f * t * t * std::sqrt(t + 0.05f));
    z += fade * shape * std::max(0.0f, ridge_z_(y) - z);
  }
  for (const Ball& ball : balls_) {
    const float dx = (x - ball.centre.x) / ball.radii.x;
    const float dy = (y - ball.centre.y) / ball.radii.y;
    const float d2 = dx * dx + dy * dy;
    if (d2 < 1) z = SmoothMax(z, ball.centre.z + ball.radii.z * std::sqrt(1 - d2), 3.0f);
  }
  return z;
}

glm::vec3 FaceSurface::Point(glm::vec2 domain) const {
  const float side = domain.x < 0 ? -1.0f : 1.0f;
  const glm::vec2 half(std::abs(domain.x), domain.y);
  glm::vec3 p = Cage(half);
  if (p.z > 60 && std::abs(p.x) < 25 && p.y > -30 && p.y < 46) p.z = Nose(p.x, p.y, p.z);
  p += Bumps(half);
  if (half.x == 0 || half.x == last_column()) p.x = 0;
  p.x *= side;
  return p;
}

glm::vec3 FaceSurface::PointAt(glm::vec2 xy, glm::vec2& domain) const {
  const float side = xy.x < 0 ? -1.0f : 1.0f;
  const glm::vec2 target(std::abs(xy.x), xy.y);
  domain = target;
  glm::vec3 p = Point(domain);
  for (int step = 0; step < 6; ++step) {
    const glm::vec2 error(target.x - p.x, target.y - p.y);
    if (glm::dot(error, error) < 1e-6f) break;
    // The domain is close to (x, y) here, so its own difference is a good enough Newton step.
    domain += error;
    domain.x = std::max(domain.x, 0.0f);
    p = Point(domain);
  }
  p.x = side * std::abs(p.x);
  domain.x *= side;
  return p;
}

glm::vec3 FaceSurface::Normal(glm::vec2 domain) const {
  constexpr float kStep = 0.5f;
  const glm::vec3 da = Point(domain + glm::vec2(kStep, 0)) - Point(domain - glm::vec2(kStep, 0));
  const glm::vec3 db = Point(domain + glm::vec2(0, kStep)) - Point(domain - glm::vec2(0, kStep));
  const glm::vec3 n = glm::cross(da, db);
  const float length = glm::length(n);
  return length > 1e-9f ? n / length : glm::vec3(0, 1, 0);
}

}  // namespace fsm
