#include "vdm/train/training.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <thread>

#include "vdm/net/mouth_frame.h"
#include "vdm/net/sound_classes.h"
#include "vdm/train/lesson.h"
#include "vdm/train/truth.h"

namespace vdm {
namespace {

constexpr std::size_t kBatch = 4;  // takes in a step
constexpr double kNoSpeech = 0.1;  // lessons without speech, beside so many takes
constexpr long kWarmUp = 150;      // steps in which the rate rises
constexpr float kTaught = 0.7F;    // share of what the teachers say, the rest is the truth
constexpr std::string_view kHead = "galatea training 2\n";

TimeDelayLayer MakeLayer(std::size_t inputs, std::vector<int> offsets, std::size_t outputs,
                         bool rectified, Dice& dice) {
  TimeDelayLayer layer{.offsets = std::move(offsets), .inputs = inputs, .rectified = rectified};
  const std::size_t columns = inputs * layer.offsets.size();
  layer.weights.resize(static_cast<Eigen::Index>(outputs), static_cast<Eigen::Index>(columns));
  const double size = std::sqrt((rectified ? 2.0 : 0.5) / static_cast<double>(columns));
  for (Eigen::Index i = 0; i < layer.weights.size(); ++i) {
    layer.weights.data()[i] = static_cast<float>(size * dice.Normal());
  }
  layer.biases = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(outputs));
  return layer;
}

template <typename Matrix>
void Write(std::ostream& out, const Matrix& matrix) {
  out.write(reinterpret_cast<const char*>(matrix.data()),
            matrix.size() * std::streamsize{sizeof(float)});
}
template <typename Matrix>
void Read(std::istream& in, Matrix& matrix) {
  in.read(reinterpret_cast<char*>(matrix.data()), matrix.size() * std::streamsize{sizeof(float)});
}

}  // namespace

MouthNet StartingNet(const TrainingPlan& plan, const std::vector<Take>& takes,
                     const fsm::MotionTables& tables) {
  MouthNet net{.features = plan.features, .sounds = SoundClasses::Built().names()};
  // Means and scales of the shape, over some of the takes.
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kShapeNumbers), squares = sum;
  double count = 0;
  for (std::size_t i = 0; i < takes.size(); i += 10) {
    const TextDrivenMouth mouth(takes[i].phonemes, tables);
    const Eigen::MatrixXf shape =
        mouth.Sampled(0, 20, static_cast<std::size_t>(mouth.length_ms() / 20)).shape;
    sum += shape.cast<double>().rowwise().sum().array();
    squares += shape.cast<double>().array().square().rowwise().sum();
    count += static_cast<double>(shape.cols());
  }
  for (std::size_t i = 0; i < kShapeNumbers; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double mean = sum[row] / count;
    net.means[i] = static_cast<float>(mean);
    net.scales[i] =
        static_cast<float>(std::sqrt(std::max(squares[row] / count - mean * mean, 1e-4)));
  }
  Dice dice = Dice(plan.seed).For(0);
  const std::size_t inputs = FeatureSize(plan.features), w = plan.width;
  const std::size_t outputs = net.first_sound_row() + net.sounds.size();
  auto& layers = net.net.layers;
  if (plan.features == FeatureKind::kCepstra) {
    layers.push_back(MakeLayer(inputs, {0}, 20, true, dice));
    layers.push_back(MakeLayer(20, {0}, outputs, false, dice));
    return net;
  }
  if (plan.features == FeatureKind::kWords) {
    layers.push_back(MakeLayer(inputs, {-10, -6, -2, 2}, w, true, dice));
    layers.push_back(MakeLayer(w, {-2, 0}, w, true, dice));
    layers.push_back(MakeLayer(w, {0}, outputs, false, dice));
    return net;
  }
  layers.push_back(MakeLayer(inputs, {-3, -2, -1, 0, 1, 2}, w, true, dice));
  layers.push_back(MakeLayer(w, {-4, -2, 0, 2}, w, true, dice));
  std::vector<int> past = {-8, -4, 0};
  if (plan.long_past) past.insert(past.begin(), -16);
  layers.push_back(MakeLayer(w, past, w, true, dice));
  layers.push_back(MakeLayer(w, {-2, -1, 0, 1}, w, true, dice));
  layers.push_back(MakeLayer(w, {0}, outputs, false, dice));
  return net;
}

/// The share of one thread in a step.
struct Training::Lane {
  explicit Lane(const TimeDelayNet& net) : gradient(net), propagation(net) {}
  NetGradient gradient;
  BackPropagation propagation;
  MouthLoss loss{};
  double instants = 0;
};

Training::Training(const TrainingPlan& plan, const std::vector<Take>& takes,
                   const fsm::MotionTables& tables)
    : plan_(plan),
      takes_(takes),
      tables_(tables),
      net_(plan.from ? *plan.from : StartingNet(plan, takes, tables)),
      adam_(net_.net) {}

double Training::RateAt(long step, long steps) const {
  if (step < kWarmUp) return plan_.rate * static_cast<double>(step + 1) / kWarmUp;
  const double done =
      static_cast<double>(step - kWarmUp) / static_cast<double>(std::max(steps - kWarmUp, 1L));
  return plan_.rate *
         (0.005 + 0.995 * 0.5 * (1 + std::cos(std::numbers::pi * std::min(done, 1.0))));
}

Eigen::MatrixXf Training::Wanted(const Lesson& lesson) const {
  const Eigen::MatrixXf truth = WantedOf(net_, lesson.truth);
  if (plan_.teachers.empty()) return truth;
  const auto shape = static_cast<Eigen::Index>(kShapeNumbers);
  Eigen::MatrixXf told = Eigen::MatrixXf::Zero(truth.rows(), truth.cols());
  std::array<float, kShapeNumbers> tellers{};
  for (const MouthNet& teacher : plan_.teachers) {
    const Eigen::MatrixXf outputs = teacher.net.Outputs(lesson.features);
    told.bottomRows(told.rows() - shape) += outputs.bottomRows(told.rows() - shape);
    for (std::size_t i = 0; i < kShapeNumbers; ++i) {
      // A teacher that learned from other shapes of the mouth is not asked about a number that has
      // another range now.
      const float scale = teacher.scales[i] / net_.scales[i];
      if (scale < 0.5F || scale > 2) continue;
      const auto row = static_cast<Eigen::Index>(i);
      told.row(row).array() +=
          scale * outputs.row(row).array() + (teacher.means[i] - net_.means[i]) / net_.scales[i];
      ++tellers[i];
    }
  }
  told.bottomRows(told.rows() - shape) /= static_cast<float>(plan_.teachers.size());
  told = WantedOf(net_, std::move(told));
  for (std::size_t i = 0; i < kShapeNumbers; ++i) {
    auto row = told.row(static_cast<Eigen::Index>(i));
    if (tellers[i] > 0) row /= tellers[i];
    if (tellers[i] == 0) row = truth.row(static_cast<Eigen::Index>(i));
  }
  return kTaught * told + (1 - kTaught) * truth;
}

void Training::Learn(const std::vector<std::size_t>& items, Dice dice, Lane& lane) const {
  lane.gradient.SetZero();
  lane.loss = {};
  lane.instants = 0;
  Eigen::MatrixXf slope;
  for (const std::size_t item : items) {
    const Dice own = dice.For(item);
    Lesson lesson = item < takes_.size()
                        ? DistortedLesson(takes_[item], plan_.features, tables_, own)
                        : SilentLesson(plan_.features, own);
    // Teachers hear what is hidden from the learner.
    const Eigen::MatrixXf wanted = Wanted(lesson);
    if (plan_.features != FeatureKind::kCepstra) {
      Dice chance = own.For(7);
      const bool masked = chance.Chance(plan_.masking);
      if (masked && plan_.features != FeatureKind::kWords)
        Mask(lesson.features, plan_.features, chance);
      lane.propagation.Disturb(plan_.disturbance, chance);
    }
    const MouthLoss loss = LossOf(net_, lane.propagation.Forward(lesson.features), wanted, slope);
    lane.propagation.Backward(slope, lane.gradient);
    lane.loss.shape += loss.shape;
    lane.loss.closure += loss.closure;
    lane.loss.sounds += loss.sounds;
    lane.instants += static_cast<double>(lesson.features.cols());
  }
}

Training::Report Training::Epoch(const std::function<void(double)>& progress) {
  const Dice dice = Dice(plan_.seed).For(1 + epoch_);
  std::vector<std::size_t> order(
      takes_.size() + static_cast<std::size_t>(kNoSpeech * static_cast<double>(takes_.size())));
  std::iota(order.begin(), order.end(), std::size_t{0});
  Dice shuffle = dice.For(0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[shuffle.Below(i)]);

  std::vector<Lane> lanes(kLanes, Lane(net_.net));
  const std::size_t steps = (order.size() + kBatch - 1) / kBatch;
  Report report;
  double instants = 0;
  for (std::size_t step = 0; step < steps; ++step) {
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < kLanes; ++k) {
      std::vector<std::size_t> items;
      for (std::size_t i = step * kBatch + k; i < std::min(order.size(), (step + 1) * kBatch);
           i += kLanes) {
        items.push_back(order[i]);
      }
      threads.emplace_back(
          [this, items, &lane = lanes[k], own = dice.For(1)] { Learn(items, own, lane); });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 1; k < kLanes; ++k) lanes[0].gradient.Add(lanes[k].gradient);
    double now = 0;
    for (const Lane& lane : lanes) {
      report.loss.shape += lane.loss.shape;
      report.loss.closure += lane.loss.closure;
      report.loss.sounds += lane.loss.sounds;
      now += lane.instants;
    }
    for (auto& layer : lanes[0].gradient.layers) {
      layer.weights /= static_cast<float>(now);
      layer.biases /= static_cast<float>(now);
    }
    const long all = static_cast<long>(steps * plan_.epochs);
    adam_.Step(net_.net, lanes[0].gradient, RateAt(adam_.steps, all));
    instants += now;
    progress(static_cast<double>(step + 1) / static_cast<double>(steps));
  }
  ++epoch_;
  report.loss.shape /= instants;
  report.loss.closure /= instants;
  report.loss.sounds /= instants;
  report.seconds_of_sound =
      instants * static_cast<double>(MakeFeatures(plan_.features)->hop_samples()) / kSampleRateHz;
  return report;
}

vm::Result<void> Training::Save(const std::string& path) const {
  const std::string partial = path + ".part";
  std::ofstream file(partial, std::ios::binary);
  file << kHead << FeatureName(plan_.features) << ' ' << plan_.width << ' ' << plan_.epochs << ' '
       << plan_.seed << ' ' << plan_.disturbance << ' ' << plan_.masking << ' '
       << plan_.teachers.size() << ' ' << takes_.size() << ' ' << epoch_ << ' ' << adam_.steps
       << '\n';
  for (std::size_t i = 0; i < net_.net.layers.size(); ++i) {
    Write(file, net_.net.layers[i].weights);
    Write(file, net_.net.layers[i].biases);
    for (const NetGradient* part : {&adam_.mean, &adam_.square}) {
      Write(file, part->layers[i].weights);
      Write(file, part->layers[i].biases);
    }
  }
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(partial, path, error);
  if (!file || error) return vm::Fail(vm::Errc::kUnavailable, "cannot write '" + path + "'");
  return {};
}

vm::Result<void> Training::Load(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
  std::string head(kHead.size(), ' '), features;
  std::size_t width = 0, epochs = 0, teachers = 0, takes = 0, epoch = 0;
  std::uint64_t seed = 0;
  double disturbance = 0, masking = 0;
  long steps = 0;
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  file >> features >> width >> epochs >> seed >> disturbance >> masking >> teachers >> takes >>
      epoch >> steps;
  if (!file || head != kHead || features != FeatureName(plan_.features) || width != plan_.width ||
      epochs != plan_.epochs || seed != plan_.seed || disturbance != plan_.disturbance ||
      masking != plan_.masking || teachers != plan_.teachers.size() || takes != takes_.size() ||
      file.get() != '\n') {
    return vm::Fail(vm::Errc::kBadValue,
                    path + ": is no course of this plan; remove it to start anew");
  }
  MouthNet net = net_;
  Adam adam(net.net);
  for (std::size_t i = 0; i < net.net.layers.size(); ++i) {
    Read(file, net.net.layers[i].weights);
    Read(file, net.net.layers[i].biases);
    for (NetGradient* part : {&adam.mean, &adam.square}) {
      Read(file, part->layers[i].weights);
      Read(file, part->layers[i].biases);
    }
  }
  if (!file || file.get() != std::char_traits<char>::eof()) {
    return vm::Fail(vm::Errc::kBadValue, path + ": damaged; remove it to start anew");
  }
  adam.steps = steps;
  net_ = std::move(net);
  adam_ = std::move(adam);
  epoch_ = epoch;
  return {};
}

Score ScoreOf(const MouthNet& net, const std::vector<Take>& takes,
              const fsm::MotionTables& tables) {
  Score score;
  for (const Take& take : takes) {
    const Lesson lesson = PlainLesson(take, net.features, tables);
    const Eigen::MatrixXf outputs = net.net.Outputs(lesson.features);
    std::vector<double> ours, truth;
    for (Eigen::Index t = 0; t < outputs.cols(); ++t) {
      MouthFrame told;
      for (std::size_t i = 0; i < kMouthParameters; ++i) {
        told.mouth[i] = lesson.truth.shape(static_cast<Eigen::Index>(i), t);
      }
      told.seal = lesson.truth.closed[t];
      ours.push_back(static_cast<double>(FrameOf(net, outputs.col(t)).Opening()));
      truth.push_back(static_cast<double>(told.Opening()));
    }
    const auto hop = static_cast<double>(MakeFeatures(net.features)->hop_samples());
    score.Add(ours, truth, hop * 1000 / kSampleRateHz, take.phonemes);
  }
  return score;
}

}  // namespace vdm
