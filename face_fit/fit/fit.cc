#include "face_fit/fit/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "face_fit/find/mouth_line.h"
#include "face_fit/fit/form.h"
#include "face_fit/fit/least_squares.h"

namespace facefit {
namespace {

/// The renderer's camera stands 744 mm before the plane z = 50 (a portrait 330 mm high through a
/// lens of 25 degrees).
constexpr float kCameraZ = 794;
constexpr float kFaceZ = 50;
constexpr glm::vec3 kMiddle{0, -10, 20};  ///< the head is turned about it

constexpr std::size_t kParameters = 9;
using Parameters = std::array<double, kParameters>;

Pose PoseOf(const Parameters& p) {
  const auto f = [&p](std::size_t i) { return static_cast<float>(p[i]); };
  return {{f(0), f(1), f(2)}, std::exp(f(3)), {f(4), f(5)}};
}

Expression ExpressionOf(const Parameters& p) {
  const auto part = [&p](std::size_t i) { return static_cast<float>(std::clamp(p[i], 0.0, 1.5)); };
  return {part(6), part(7), part(8)};
}

struct Sight {
  const BaseHead& base;
  const FoundFace& face;
  std::vector<float> depth_bias;  ///< true minus seen, of the base head, mean removed
  bool lips_apart;
};

std::vector<double> Residuals(const Sight& sight, const Parameters& parameters) {
  const Pose pose = PoseOf(parameters);
  fsm::HeadVertices vertices;
  sight.base.head->Evaluate(ExpressionOf(parameters).State(), vertices);
  const float mm = 1 / pose.PixelsPerMm();
  std::vector<double> out;
  std::vector<float> depth;
  float mean = 0;
  for (const int i : FitPoints()) {
    const auto k = static_cast<std::size_t>(i);
    const glm::vec3 q = pose.ToCamera(sight.base.places[k].On(vertices.position));
    const glm::vec2 miss = (pose.Project(q) - glm::vec2(sight.face.points[k])) * mm;
    out.push_back(static_cast<double>(miss.x));
    out.push_back(static_cast<double>(miss.y));
    depth.push_back(q.z - sight.face.points[k].z * mm - sight.depth_bias[k]);
    mean += depth.back();
  }
  mean /= static_cast<float>(depth.size());
  for (const float d : depth) out.push_back(0.4 * static_cast<double>(d - mean));
  // People mostly hold still for a photo: what is not clearly seen is not assumed. Without teeth to
  // see a mouth's form is taken for the person's own rather than for a smile.
  out.push_back((sight.lips_apart ? 6 : 40) * parameters[6]);
  for (const std::size_t i : {7U, 8U}) out.push_back((sight.lips_apart ? 6 : 1e4) * parameters[i]);
  return out;
}

Parameters Refine(const Sight& sight, const Parameters& start) {
  constexpr Parameters kStep = {1e-3, 1e-3, 1e-3, 1e-3, 0.5, 0.5, 0.05, 0.05, 0.05};
  return GaussNewton<kParameters>([&sight](const Parameters& p) { return Residuals(sight, p); },
                                  start, kStep, 7,
                                  [](Parameters& p) {
                                    for (std::size_t i = 6; i < kParameters; ++i) {
                                      p[i] = std::clamp(p[i], 0.0, 1.5);
                                    }
                                  });
}

}  // namespace

glm::mat3 Pose::Rotation() const {
  const float cx = std::cos(turn.x), sx = std::sin(turn.x);
  const float cy = std::cos(turn.y), sy = std::sin(turn.y);
  const float cz = std::cos(turn.z), sz = std::sin(turn.z);
  const glm::mat3 x(1, 0, 0, 0, cx, sx, 0, -sx, cx);
  const glm::mat3 y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
  const glm::mat3 z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
  return z * x * y;
}
glm::vec3 Pose::ToCamera(glm::vec3 p) const { return Rotation() * (p - kMiddle) + kMiddle; }
glm::vec3 Pose::FromCamera(glm::vec3 q) const {
  return glm::transpose(Rotation()) * (q - kMiddle) + kMiddle;
}
glm::vec2 Pose::Project(glm::vec3 q) const {
  return centre + focal / (kCameraZ - q.z) * glm::vec2(q.x, -q.y);
}
glm::vec3 Pose::Unproject(glm::vec2 pixel, float z) const {
  const glm::vec2 d = (pixel - centre) * ((kCameraZ - z) / focal);
  return {d.x, -d.y, z};
}
float Pose::PixelsPerMm() const { return focal / (kCameraZ - kFaceZ); }

fsm::FaceState Expression::State() const {
  fsm::FaceState state;
  state.asymmetry = 0;
  const auto both = [&state](std::size_t unit, float v) {
    state.au_left[unit] = state.au_right[unit] = v;
  };
  both(12, smile);
  both(6, 0.5F * smile);
  both(26, jaw);
  both(25, parted);
  return state;
}

Fit FitFace(const BaseHead& base, const FoundFace& face, const fsm::Image* photo) {
  Sight sight{base, face, {}, LipsApart(face)};
  float mean = 0;
  for (std::size_t i = 0; i < kNetworkPoints; ++i) {
    sight.depth_bias.push_back(base.places[i].On(base.rest.position).z - base.seen_z[i]);
    mean += sight.depth_bias.back() / static_cast<float>(kNetworkPoints);
  }
  for (float& bias : sight.depth_bias) bias -= mean;

  // A first guess from the outer corners of the eyes and the chin.
  const glm::vec2 right(face.points[33]), left(face.points[263]), nose(face.points[6]);
  const float wide = glm::distance(base.places[33].On(base.rest.position),
                                   base.places[263].On(base.rest.position));
  const float scale = glm::distance(right, left) / wide;
  const float roll = -std::atan2(left.y - right.y, left.x - right.x);
  const glm::vec3 root = base.places[6].On(base.rest.position);
  Parameters start{};
  start[2] = roll;
  start[3] = std::log(static_cast<double>(scale * (kCameraZ - kFaceZ)));
  start[4] = nose.x - scale * root.x;
  start[5] = nose.y + scale * root.y;
  const Parameters settled = Refine(sight, start);

  Fit fit;
  fit.lips_apart = sight.lips_apart;
  fit.pose = PoseOf(settled);
  fit.expression = ExpressionOf(settled);
  // How mouths at rest differ from the built-in one looks like that much of a smile; taken away
  // from a closed mouth it would leave a grim face.
  const float own = sight.lips_apart ? 0.12F : 0.45F;
  fit.expression.smile = fit.expression.smile < own ? 0
                         : sight.lips_apart         ? fit.expression.smile
                                                    : fit.expression.smile - own;
  fsm::HeadVertices now;
  base.head->Evaluate(fit.expression.State(), now);
  const float mm = 1 / fit.pose.PixelsPerMm();
  float offset = 0;
  for (const int i : FitPoints()) {
    const auto k = static_cast<std::size_t>(i);
    const glm::vec3 q = fit.pose.ToCamera(base.places[k].On(now.position));
    offset += (q.z - face.points[k].z * mm - sight.depth_bias[k]) /
              static_cast<float>(FitPoints().size());
  }
  constexpr float kTrustDepth = 0.3F;
  for (const int i : FitPoints()) {
    const auto k = static_cast<std::size_t>(i);
    const glm::vec3 q = fit.pose.ToCamera(base.places[k].On(now.position));
    const float seen = face.points[k].z * mm + sight.depth_bias[k] + offset;
    const float z = q.z + kTrustDepth * std::clamp(seen - q.z, -15.0F, 15.0F);
    fit.aims.push_back({i, base.places[k], glm::vec2(face.points[k]), z});
  }
  FindIrises(base, face, photo, fit);
  CentreEyes(base, fit, fit.aims);
  if (photo && !sight.lips_apart) {
    AimAtMouthLine(base, face, fit.pose, now.position, *photo, fit.aims);
  }
  WarpToLandmarks(base, fit);
  for (const int i : FitPoints()) {
    const auto k = static_cast<std::size_t>(i);
    const glm::vec2 at = fit.pose.Project(fit.pose.ToCamera(base.places[k].On(fit.worn)));
    fit.residual_mm +=
        glm::distance(at, glm::vec2(face.points[k])) * mm / static_cast<float>(FitPoints().size());
  }
  return fit;
}

}  // namespace facefit
