#include "vdm/train/head_training.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "vdm/prosody/head_mover.h"
#include "vdm/train/adam.h"

namespace vdm {
namespace {

constexpr Eigen::Index kOutputs = HeadNet::kOutputs;
constexpr Eigen::Index kEvery = 2;  // instants of a lesson that are learned from in one epoch
constexpr double kExplains = 0.3;   // a correlation within phrases from which on it is enlarged
constexpr double kMostEnlarged = 2.5;

/// Mean and deviation of each output over the instants in phrases.
void Measure(const std::vector<HeadLesson>& lessons, HeadNet& net) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kOutputs), squares = sum;
  double count = 0;
  for (const HeadLesson& lesson : lessons) {
    for (Eigen::Index k = 0; k < lesson.truth.cols(); ++k) {
      if (lesson.phrase[static_cast<std::size_t>(k)] == 0) continue;
      const Eigen::ArrayXd now = lesson.truth.col(k).cast<double>().array();
      sum += now;
      squares += now.square();
      ++count;
    }
  }
  for (Eigen::Index i = 0; i < kOutputs; ++i) {
    const double mean = sum[i] / count;
    net.means[static_cast<std::size_t>(i)] = static_cast<float>(mean);
    net.scales[static_cast<std::size_t>(i)] =
        static_cast<float>(std::sqrt(std::max(squares[i] / count - mean * mean, 1e-4)));
  }
}

TimeDelayLayer ByChance(std::size_t inputs, std::size_t outputs, bool rectified, Dice& dice) {
  TimeDelayLayer layer{.offsets = {0}, .inputs = inputs, .rectified = rectified};
  layer.weights.resize(static_cast<Eigen::Index>(outputs), static_cast<Eigen::Index>(inputs));
  const double size = std::sqrt((rectified ? 2.0 : 0.5) / static_cast<double>(inputs));
  for (Eigen::Index i = 0; i < layer.weights.size(); ++i) {
    layer.weights.data()[i] = static_cast<float>(size * dice.Normal());
  }
  layer.biases = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(outputs));
  return layer;
}

/// The columns of a lesson that are learned from, the truth in units of the scales.
struct Batch {
  Eigen::MatrixXf inputs, truth;
};
Batch BatchOf(const HeadLesson& lesson, const HeadNet& net, Eigen::Index first) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = first; k < lesson.inputs.cols(); k += kEvery) {
    if (lesson.phrase[static_cast<std::size_t>(k)] != 0) columns.push_back(k);
  }
  const Eigen::Map<const Eigen::Array<float, kOutputs, 1>> means(net.means.data()),
      scales(net.scales.data());
  Batch batch{lesson.inputs(Eigen::all, columns), lesson.truth(Eigen::all, columns)};
  batch.truth = ((batch.truth.array().colwise() - means).colwise() / scales).matrix();
  return batch;
}

/// What the network says of a lesson, and the truth, each less its mean over the phrase.
struct Phrases {
  Eigen::Array4d ours_squares = Eigen::Array4d::Zero(), truth_squares = ours_squares,
                 products = ours_squares;
  Eigen::Array4d left_squares = ours_squares;  // of the means the network does not explain
  double count = 0;

  void Add(const Eigen::Array4Xd& ours, const Eigen::Array4Xd& truth) {
    if (ours.cols() == 0) return;
    const Eigen::Array4d our_mean = ours.rowwise().mean(), true_mean = truth.rowwise().mean();
    const Eigen::Array4Xd a = ours.colwise() - our_mean, b = truth.colwise() - true_mean;
    ours_squares += a.square().rowwise().sum();
    truth_squares += b.square().rowwise().sum();
    products += (a * b).rowwise().sum();
    left_squares += (true_mean - our_mean).square();
    ++count;
  }
};

Phrases Compare(const HeadNet& net, const std::vector<HeadLesson>& lessons) {
  Phrases all;
  for (const HeadLesson& lesson : lessons) {
    HeadFilter filter;
    std::vector<Eigen::Array4d> ours, truth;
    const auto end = [&] {
      const auto count = static_cast<Eigen::Index>(ours.size());
      all.Add(Eigen::Map<Eigen::Array4Xd>(ours.data()->data(), 4, count),
              Eigen::Map<Eigen::Array4Xd>(truth.data()->data(), 4, count));
      ours.clear();
      truth.clear();
    };
    for (std::size_t k = 0; k < lesson.phrase.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const HeadPose pose = filter.Add(PoseOf(net, lesson.inputs.col(column)));
      if (k > 0 && lesson.phrase[k] != lesson.phrase[k - 1] && !ours.empty()) end();
      if (lesson.phrase[k] == 0) continue;
      ours.emplace_back(pose.angles[0], pose.angles[1], pose.angles[2], pose.brow);
      truth.emplace_back(lesson.truth.col(column).cast<double>());
    }
    if (!ours.empty()) end();
  }
  return all;
}

void Finish(HeadNet& net, const std::vector<HeadLesson>& lessons) {
  const Phrases phrases = Compare(net, lessons);
  for (Eigen::Index i = 0; i < kOutputs; ++i) {
    const double ours = std::sqrt(phrases.ours_squares[i]);
    const double truth = std::sqrt(phrases.truth_squares[i]);
    const auto n = static_cast<std::size_t>(i);
    if (i < 3) {
      net.pose[n] = static_cast<float>(std::sqrt(phrases.left_squares[i] / phrases.count));
    }
    if (ours <= 0 || truth <= 0 || phrases.products[i] / (ours * truth) < kExplains) continue;
    net.scales[n] *= static_cast<float>(std::clamp(truth / ours, 1.0, kMostEnlarged));
  }
}

}  // namespace

HeadNet LearnHead(const HeadPlan& plan, const std::vector<HeadLesson>& lessons,
                  const std::function<void(std::size_t, double)>& progress) {
  HeadNet net{.sounds = plan.sounds};
  Measure(lessons, net);
  const Dice dice(plan.seed);
  Dice first = dice.For(0);
  net.net.layers.push_back(ByChance(HeadNet::Inputs(plan.sounds), plan.width, true, first));
  net.net.layers.push_back(ByChance(plan.width, HeadNet::kOutputs, false, first));
  Adam adam(net.net);
  NetGradient gradient(net.net);
  BackPropagation propagation(net.net);
  std::vector<std::size_t> order(lessons.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t epoch = 0; epoch < plan.epochs; ++epoch) {
    Dice chance = dice.For(1 + epoch);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[chance.Below(i)]);
    const double done = static_cast<double>(epoch) / static_cast<double>(plan.epochs);
    double error = 0, count = 0;
    for (const std::size_t i : order) {
      const auto start = static_cast<Eigen::Index>(chance.Below(kEvery));
      const Batch batch = BatchOf(lessons[i], net, start);
      if (batch.inputs.cols() == 0) continue;
      const Eigen::MatrixXf off = propagation.Forward(batch.inputs) - batch.truth;
      gradient.SetZero();
      propagation.Backward(off / static_cast<float>(off.cols()), gradient);
      adam.Step(net.net, gradient, plan.rate * (1 - 0.98 * done));
      error += static_cast<double>(off.squaredNorm());
      count += static_cast<double>(off.size());
    }
    progress(epoch + 1, error / count);
  }
  Finish(net, lessons);
  return net;
}

}  // namespace vdm
