#include "face_track/learn/mouth_lesson.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <stdexcept>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/follow/tracker.h"
#include "face_track/learn/head_painter.h"
#include "face_track/learn/sitter.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/or_throw.h"

namespace facetrack {
namespace {

constexpr int kPictures = 60;   // of each head
constexpr double kStepMs = 40;  // between them
constexpr int kRest = 4;        // pictures of rest
constexpr float kOwn = 0.25F;   // of what a parameter does in the shapes, each by itself
// Chosen by the gaps that PrintGaps tells: few open mouths are taken for sealed ones.
constexpr float kClosedMm = 0.6F, kOpenMm = 1.2F;
constexpr double kUnsureMm = 0.15;  // mm by which a measure may be off

/// Draws by chance, the same on each machine.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  float Between(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() % 10001) / 10000;
  }
  std::size_t Index(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937 engine_;
};

/// Between two shapes of speech, each parameter a little otherwise, the head turned a little.
fsm::FaceState SomeMouth(const fsm::Visemes& visemes, Dice& dice) {
  const fsm::Viseme& a = visemes[dice.Index(visemes.size())];
  const fsm::Viseme& b = visemes[dice.Index(visemes.size())];
  const float part = dice.Between(0, 1), size = dice.Between(0.4F, 1.1F);
  fsm::FaceState state;
  for (std::size_t p = 0; p < fsm::kMouthParameters; ++p) {
    float most = 0;
    for (const fsm::Viseme& v : visemes) most = std::max(most, std::abs(v.pose.mouth[p]));
    state.mouth[p] = size * std::lerp(a.pose.mouth[p], b.pose.mouth[p], part) +
                     kOwn * most * dice.Between(-1, 1);
  }
  state.mouth[fsm::kJawY] = std::max(state.mouth[fsm::kJawY], 0.0F);
  // A seal halfway would show lips that the parameters do not tell of.
  state.seal = a.pose.seal > 0.5F && b.pose.seal > 0.5F ? 1 : 0;
  state.head_rotation = {dice.Between(-6, 6), dice.Between(-8, 8), dice.Between(-4, 4)};
  return state;
}

struct MouthLesson {
  std::vector<Lips> seen;  // a picture each
  std::vector<fsm::FaceState> states;
};

Eigen::MatrixXd Rows(const MouthLesson& lesson, std::size_t width, auto number) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(lesson.seen.size()),
                       static_cast<Eigen::Index>(width));
  for (std::size_t k = 0; k < lesson.seen.size(); ++k) {
    for (std::size_t i = 0; i < width; ++i) {
      rows(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          static_cast<double>(number(k, i));
    }
  }
  return rows;
}

/// How far the parameters told part lips that are sealed, and lips that lie 2 mm apart or more, so
/// that somebody can choose between which gaps the seal goes.
void PrintGaps(const MouthOfLips& mouth, const MouthLesson& lesson) {
  std::vector<float> shut, open;
  for (std::size_t k = 0; k < lesson.seen.size(); ++k) {
    const float told = MouthOfLips::Gap(mouth.Mouth(lesson.seen[k]).parameters);
    if (lesson.states[k].seal > 0)
      shut.push_back(told);
    else if (MouthOfLips::Gap(lesson.states[k].mouth) > 1.5F)
      open.push_back(told);
  }
  std::ranges::sort(shut);
  std::ranges::sort(open);
  for (const double part : {0.05, 0.5, 0.95}) {
    const auto at = [part](const std::vector<float>& v) {
      return v.empty() ? 0 : v[static_cast<std::size_t>(part * static_cast<double>(v.size()))];
    };
    std::cerr << fmt::format("gaps of {:.0f} % are smaller: sealed {:.2f}, open {:.2f}\n",
                             100 * part, at(shut), at(open));
  }
}

}  // namespace

MouthOfLips LearnMouth(std::size_t heads, const std::string& folder) {
  auto networks = vm::OrThrow(facefit::FaceNetworks::Load(folder));
  auto attention = vm::OrThrow(facefit::AttentionNetwork::Load(folder));
  HeadPainter painter;
  const fsm::Visemes visemes =
      vm::OrThrow(fsm::MotionTables::Load()).set(fsm::VisemeSetId::k14).visemes;
  MouthLesson lesson;
  for (std::size_t number = 0; number < heads; ++number) {
    std::cerr << fmt::format("face_track_learn: head {} of {}\n", number + 1, heads);
    const auto head = SomeHead(number);
    Dice dice(static_cast<unsigned>(number));
    Tracker tracker(
        networks, attention, SeenFace::Shipped(),
        {.field_degrees = HeadPainter::kField, .settle_ms = (kRest - 1) * kStepMs, .smooth = 0});
    for (int k = 0; k < kRest + kPictures; ++k) {
      fsm::FaceState state;
      state.seal = 1;
      if (k >= kRest) state = SomeMouth(visemes, dice);
      state.asymmetry = 0;
      const auto lines = tracker.Look(painter.Draw(*head, state), kStepMs * k);
      if (k < kRest) continue;
      if (lines.empty() || lines.back().person != 1) throw std::runtime_error("a face is lost");
      lesson.seen.push_back(lines.back().lips);
      lesson.states.push_back(state);
    }
  }
  const auto count = static_cast<double>(lesson.seen.size());
  const Eigen::MatrixXd lips =
      Rows(lesson, kLips, [&](std::size_t k, std::size_t i) { return lesson.seen[k][i]; });
  const Eigen::MatrixXd mouths =
      Rows(lesson, fsm::kMouthParameters,
           [&](std::size_t k, std::size_t i) { return lesson.states[k].mouth[i]; });
  // Ridge regression without a constant, so that a mouth at rest is told as one.
  const Eigen::MatrixXd normal = lips.transpose() * lips + Eigen::MatrixXd::Identity(kLips, kLips) *
                                                               (count * kUnsureMm * kUnsureMm);
  const Eigen::MatrixXd solved = normal.ldlt().solve(lips.transpose() * mouths);
  MouthOfLips mouth;
  mouth.closed_mm = kClosedMm, mouth.open_mm = kOpenMm;
  const Eigen::MatrixXd told = lips * solved;
  for (std::size_t p = 0; p < fsm::kMouthParameters; ++p) {
    const auto column = static_cast<Eigen::Index>(p);
    for (std::size_t k = 0; k < kLips; ++k) {
      mouth.factors[p][k] = static_cast<float>(solved(static_cast<Eigen::Index>(k), column));
    }
    std::cerr << fmt::format("m{}: off by {:.2f} of {:.2f} (rms)\n", p + 1,
                             std::sqrt((told - mouths).col(column).squaredNorm() / count),
                             std::sqrt(mouths.col(column).squaredNorm() / count));
  }
  PrintGaps(mouth, lesson);
  return mouth;
}

}  // namespace facetrack
