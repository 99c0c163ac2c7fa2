#include "face_track/fit/image_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "face_track/model/eigen_glm.h"

namespace facetrack {
namespace {

constexpr int kPose = 6, kForm = 5, kAll = kPose + kForm;
using Matrix = Eigen::Matrix<float, kAll, kAll>;
using Vector = Eigen::Matrix<float, kAll, 1>;
using FormVector = Eigen::Matrix<float, kForm, 1>;
using FormMatrix = Eigen::Matrix<float, kForm, kForm, Eigen::RowMajor>;

constexpr float kStep = 2;  // mm between samples
// mm below the top of the forehead, across which hair falls: what hangs free of the skin and is
// shaded otherwise as the head turns would pull the nod. These samples take no part in finding the
// pose, but in how alike a face is, since by their hair people are told apart.
constexpr float kHair = 30;
constexpr float kMostAside = 0.35F;  // cosine of the angle up to which skin is seen well enough
constexpr float kHuber = 0.12F;      // in deviations of the look
constexpr int kRounds[] = {6, 6};
// How far off the usual depth is taken to be, and how much a picture tells of it that those before
// it did not.
constexpr float kFormOff[] = {0.09F, 0.08F, 0.08F, 0.03F, 0.03F};
constexpr float kNews = 0.3F;        // with 0.1 angles of four of five drawn heads were off by more
constexpr float kOtherTurn = 0.05F;  // radians from the picture that told of it last
// How far off the network's pose is taken to be, and the look of a place.
// With a turn off by 0.035 radians four of five drawn heads and three of photos were found worse.
constexpr float kTurnOff = 0.07F, kAsideOff = 3, kAwayOff = 20, kLookOff = 0.4F;

/// Inside an outline, x and y alone.
bool Inside(const Points& points, std::span<const facefit::PointIndex> outline, glm::vec2 p) {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const glm::vec3 a = points[outline[i]], b = points[outline[j]];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) {
      inside = !inside;
    }
  }
  return inside;
}

/// Of the skin near (x, y): the nearest points, and the plane through more of them.
struct Place {
  std::array<std::size_t, 8> near;
  glm::vec3 at, normal;
  bool enclosed;
};
Place PlaceAt(const Points& points, glm::vec2 p) {
  std::array<std::pair<float, std::size_t>, 8> nearest;
  std::vector<std::pair<float, std::size_t>> all;
  for (std::size_t i = 0; i < kIris; ++i)
    all.emplace_back(glm::distance(glm::vec2(points[i]), p), i);
  std::partial_sort_copy(all.begin(), all.end(), nearest.begin(), nearest.end());
  Place place{};
  Eigen::Matrix3f normal = Eigen::Matrix3f::Identity() * 1e-3F;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  std::vector<float> ways;
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    const auto [off, i] = nearest[k];
    place.near[k] = i;
    const glm::vec2 d = glm::vec2(points[i]) - p;
    const float weight = 1 / (1 + off * off);
    const Eigen::Vector3f row(1, d.x, d.y);
    normal += weight * row * row.transpose();
    sum += weight * points[i].z * row;
    ways.push_back(std::atan2(d.y, d.x));
  }
  const Eigen::Vector3f plane = normal.ldlt().solve(sum);
  place.at = glm::vec3(p, plane[0]);
  place.normal = glm::normalize(glm::vec3(-plane[1], -plane[2], 1));
  std::ranges::sort(ways);
  float gap = ways.front() + 6.2832F - ways.back();
  for (std::size_t k = 1; k < ways.size(); ++k) gap = std::max(gap, ways[k] - ways[k - 1]);
  place.enclosed = gap < 3.1F;
  return place;
}

/// Adds what the network said of the pose, as far as it can be relied upon.
void TrustNetwork(const Pose& said, const Pose& pose, Matrix& normal, Vector& down) {
  const Eigen::AngleAxisf off(Of(said.turn) * Of(pose.turn).transpose());
  const Eigen::Vector3f turned = off.angle() * off.axis();
  const glm::vec3 moved = said.place - pose.place;
  const float offs[] = {kTurnOff, kTurnOff, kTurnOff, kAsideOff, kAsideOff, kAwayOff};
  for (int k = 0; k < kPose; ++k) {
    const float trust = 1 / (offs[k] * offs[k]);
    normal(k, k) += trust;
    down[k] += trust * (k < 3 ? turned[k] : moved[k - 3]);
  }
}

/// What a picture tells of the depth, whatever the pose (the Schur complement).
FormMatrix AboutForm(const Matrix& normal) {
  return normal.bottomRightCorner<kForm, kForm>() -
         normal.bottomLeftCorner<kForm, kPose>() * normal.topLeftCorner<kPose, kPose>().inverse() *
             normal.topRightCorner<kPose, kForm>();
}

/// Turns by an axis times its angle and shifts.
void Move(Pose& pose, const Eigen::Matrix<float, kPose, 1>& by) {
  const Eigen::Vector3f axis = by.head<3>();
  if (axis.norm() > 0) {
    const Eigen::AngleAxisf turn(axis.norm(), axis.normalized());
    pose.turn = Back(turn.toRotationMatrix() * Of(pose.turn));
  }
  pose.place += glm::vec3(by[3], by[4], by[5]);
}

}  // namespace

ImageFit::ImageFit(const SeenFace& face, const Lens& lens, const Points& rest,
                   const std::vector<View>& views)
    : face_(face), lens_(lens), learned_(views.front().pose.turn) {
  const float top = rest[facefit::point::kForehead].y, low = rest[facefit::point::kNoseBottom].y;
  const float wide = rest[facefit::point::kCheekLeft].x;
  const glm::vec3 root = rest[facefit::point::kNasion];
  Points ring = rest;  // eyes a little larger
  for (const fsm::Side side : fsm::kSides) {
    glm::vec3 middle(0);
    const auto outline = facefit::point::kEyeOutline[side];
    for (const std::size_t i : outline) middle += rest[i] / static_cast<float>(outline.size());
    for (const std::size_t i : outline) ring[i] = middle + 1.25F * (rest[i] - middle);
  }
  for (float y = low; y <= top; y += kStep) {
    for (float x = -wide; x <= wide; x += kStep) {
      const glm::vec2 p(x, y);
      if (Inside(ring, facefit::point::kEyeOutline[fsm::Side::kLeft], p) ||
          Inside(ring, facefit::point::kEyeOutline[fsm::Side::kRight], p)) {
        continue;
      }
      const Place place = PlaceAt(rest, p);
      if (!place.enclosed) continue;
      Sample sample{};
      glm::vec3 between(0);
      float sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sample.near[k] = place.near[k];
        sample.part[k] = 1 / (1 + glm::distance(glm::vec2(rest[place.near[k]]), p));
        sum += sample.part[k];
      }
      for (std::size_t k = 0; k < 3; ++k) {
        sample.part[k] /= sum;
        between += sample.part[k] * rest[sample.near[k]];
      }
      sample.off = place.at - between;
      sample.hair = top - y < kHair;
      sample.normal = place.normal;
      const Pose& pose = views.front().pose;
      const glm::vec3 q = pose(place.at);
      if (glm::dot(pose.turn * sample.normal, -glm::normalize(q)) < kMostAside) continue;
      for (std::size_t level = 0; level < FaceLook::kLevels; ++level) {
        for (const View& view : views) {
          sample.look[level] += view.look.At(level, lens_.Project(view.pose(place.at))).x;
        }
        sample.look[level] /= static_cast<float>(views.size());
      }
      sample.ray = glm::transpose(pose.turn) * -q;
      sample.ray /= sample.ray.z;
      const glm::vec3 d = place.at - root;
      constexpr float kFar = 70;  // mm
      sample.form = {d.z, d.x, d.y, d.x * d.x / kFar, d.y * d.y / kFar};
      samples_.push_back(sample);
    }
  }
  for (std::size_t k = 0; k < kForms; ++k)
    sure_[k * (kForms + 1)] = 1 / (kFormOff[k] * kFormOff[k]);
}

/// A pose and the numbers of the depth.
struct ImageFit::Guess {
  Pose pose;
  FormVector form;
};

struct ImageFit::Comparison {
  Matrix normal = Matrix::Zero();
  Vector down = Vector::Zero();
  float like = 0;
  std::size_t seen = 0;  // samples in view
};

/// How a posed face lies on a picture: the least squares of what each sample looks like, by the
/// pose's turn and place and the depth's numbers. `at`: of each sample, moved by the doses.
ImageFit::Comparison ImageFit::Compare(const std::vector<glm::vec3>& at, const FaceLook& look,
                                       std::size_t level, const Guess& guess) const {
  const auto& [pose, form] = guess;
  const glm::mat2 scale = look.Scale();
  Eigen::Matrix2f to_look;
  to_look << scale[0][0], scale[1][0], scale[0][1], scale[1][1];
  Comparison out;
  float products = 0, own = 0, others = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Sample& sample = samples_[i];
    const Eigen::Map<const FormVector> by_form(sample.form.data());
    const glm::vec3 p = at[i] + form.dot(by_form) * sample.ray;
    const glm::vec3 q = pose(p);
    const float facing = glm::dot(pose.turn * sample.normal, -glm::normalize(q));
    if (facing < kMostAside) continue;
    ++out.seen;
    const float depth = -q.z;
    const glm::vec3 seen = look.At(level, lens_.Project(q));
    const float wanted = sample.look[level];
    const float miss = wanted - seen.x;
    products += wanted * seen.x;
    own += wanted * wanted;
    others += seen.x * seen.x;
    if (sample.hair) continue;
    const float weight =
        facing * (std::abs(miss) > kHuber ? kHuber / std::abs(miss) : 1) / (kLookOff * kLookOff);
    Eigen::Matrix<float, 2, 3> by_place;
    by_place << 1, 0, q.x / depth, 0, -1, -q.y / depth;
    const Eigen::Matrix<float, 1, 3> slope =
        Eigen::RowVector2f(seen.y, seen.z) * to_look * by_place * (lens_.focal / depth);
    const glm::vec3 force(slope[0], slope[1], slope[2]);
    const glm::vec3 torque = glm::cross(pose.turn * p, force);
    Vector slopes;
    slopes.head<kPose>() << torque.x, torque.y, torque.z, force.x, force.y, force.z;
    slopes.tail<kForm>() = glm::dot(force, pose.turn * sample.ray) * by_form;
    out.normal += weight * slopes * slopes.transpose();
    out.down += weight * miss * slopes;
  }
  out.like = products / std::max(std::sqrt(own * others), 1e-6F);
  return out;
}

ImageFit::Found ImageFit::Solve(const Points& rest, const FaceLook& look, const Doing& start) {
  const Points moved = Moved(face_, rest, start.doses);
  std::vector<glm::vec3> at;
  for (const Sample& sample : samples_) {
    glm::vec3 p = sample.off;
    for (std::size_t k = 0; k < 3; ++k) p += sample.part[k] * moved[sample.near[k]];
    at.push_back(p);
  }
  const Eigen::Map<FormVector> known(form_.data());
  Eigen::Map<FormMatrix> sure(sure_.data());
  Guess guess{start.pose, known};
  FormMatrix news = FormMatrix::Zero();
  Comparison now;
  for (std::size_t level = 0; level < FaceLook::kLevels; ++level) {
    for (int round = 0; round < kRounds[level]; ++round) {
      now = Compare(at, look, level, guess);
      TrustNetwork(start.pose, guess.pose, now.normal, now.down);
      news = AboutForm(now.normal);
      now.normal.bottomRightCorner<kForm, kForm>() += sure;
      now.down.tail<kForm>() += sure * (known - guess.form);
      const Vector by = now.normal.ldlt().solve(now.down);
      guess.form += by.tail<kForm>();
      Move(guess.pose, by.head<kPose>());
    }
  }
  const float like = now.seen < samples_.size() / 3 ? 0 : now.like;
  if (like < kAlike) return {start.pose, like};
  // A face that stays as it is tells nothing new.
  if (Eigen::AngleAxisf(Of(guess.pose.turn) * Of(learned_).transpose()).angle() > kOtherTurn) {
    Eigen::Map<FormVector>(form_.data()) = guess.form;
    sure += kNews * news;
    learned_ = guess.pose.turn;
  }
  return {guess.pose, like};
}

}  // namespace facetrack
