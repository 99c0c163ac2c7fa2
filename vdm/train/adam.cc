#include "vdm/train/adam.h"

#include <cmath>

namespace vdm {
namespace {

constexpr double kMeanKeeps = 0.9, kSquareKeeps = 0.999, kLeast = 1e-8, kDecay = 0.01;

template <typename Values>
void StepOf(Values& values, const Values& slope, Values& mean, Values& square, double rate,
            long steps, double decay) {
  const auto keeps = static_cast<float>(kMeanKeeps), keeps2 = static_cast<float>(kSquareKeeps);
  mean = keeps * mean + (1 - keeps) * slope;
  square = keeps2 * square + (1 - keeps2) * slope.cwiseAbs2();
  const double first = 1 - std::pow(kMeanKeeps, static_cast<double>(steps));
  const double second = 1 - std::pow(kSquareKeeps, static_cast<double>(steps));
  const auto step = static_cast<float>(rate * std::sqrt(second) / first);
  values *= static_cast<float>(1 - rate * decay);
  values.array() -= step * mean.array() / (square.array().sqrt() + static_cast<float>(kLeast));
}

}  // namespace

void Adam::Step(TimeDelayNet& net, const NetGradient& gradient, double rate) {
  ++steps;
  for (std::size_t i = 0; i < net.layers.size(); ++i) {
    StepOf(net.layers[i].weights, gradient.layers[i].weights, mean.layers[i].weights,
           square.layers[i].weights, rate, steps, kDecay);
    StepOf(net.layers[i].biases, gradient.layers[i].biases, mean.layers[i].biases,
           square.layers[i].biases, rate, steps, 0);
  }
}

}  // namespace vdm
