#include "vdm/prosody/discriminant.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vdm/net/word_lines.h"

namespace vdm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 10, kMaxFeatures = 16, kMaxClasses = 16;
constexpr std::size_t kLeastExamples = 3;
constexpr double kShrinks = 0.02;      // of the covariance, towards its diagonal
constexpr double kMostDeviations = 4;  // of the examples, for Discriminant::most

Eigen::Index Size(const std::vector<std::string>& names) {
  return static_cast<Eigen::Index>(names.size());
}

}  // namespace

std::vector<double> Discriminant::Likelihoods(const Eigen::VectorXd& given) const {
  const Eigen::VectorXd within = given.cwiseMin(most).cwiseMax(-most);
  Eigen::ArrayXd scores(static_cast<Eigen::Index>(classes.size()));
  for (std::size_t k = 0; k < classes.size(); ++k) {
    scores[static_cast<Eigen::Index>(k)] = classes[k].constant + classes[k].weights.dot(within);
  }
  scores = (scores - scores.maxCoeff()).exp();
  scores /= scores.sum();
  return {scores.begin(), scores.end()};
}

vm::Result<Discriminant> LearnDiscriminant(const std::vector<std::string>& features,
                                           const std::vector<std::string>& classes,
                                           const std::vector<Example>& examples) {
  const Eigen::Index size = Size(features);
  std::vector<Eigen::VectorXd> means(classes.size(), Eigen::VectorXd::Zero(size));
  std::vector<std::size_t> counts(classes.size());
  const auto class_of = [&](const Example& example) {
    return static_cast<std::size_t>(std::ranges::find(classes, example.label) - classes.begin());
  };
  for (const Example& example : examples) {
    const std::size_t k = class_of(example);
    if (k == classes.size()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("label '{}' found, {} expected",
                                                       example.label, fmt::join(classes, " ")));
    }
    means[k] += example.features;
    ++counts[k];
  }
  for (std::size_t k = 0; k < classes.size(); ++k) {
    if (counts[k] < kLeastExamples) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("{} phrases of {} found, at least {} expected", counts[k],
                                  classes[k], kLeastExamples));
    }
    means[k] /= static_cast<double>(counts[k]);
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(size);
  for (const Example& example : examples) {
    const Eigen::VectorXd off = example.features - means[class_of(example)];
    covariance += off * off.transpose();
    squares += example.features.cwiseAbs2();
  }
  covariance /= static_cast<double>(examples.size() - classes.size());
  const Eigen::VectorXd diagonal = covariance.diagonal();
  covariance *= 1 - kShrinks;
  covariance.diagonal() = diagonal.array() + 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> solver(covariance);
  Discriminant out{.features = features, .classes = {}, .most = {}};
  out.most = kMostDeviations * (squares / static_cast<double>(examples.size())).cwiseSqrt();
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const Eigen::VectorXd weights = solver.solve(means[k]);
    out.classes.push_back({classes[k], -0.5 * means[k].dot(weights), weights});
  }
  return out;
}

vm::Result<Discriminant> ParseDiscriminant(const std::string& name, std::string_view text) {
  WordLines lines(name, text);
  if (text.size() > kMaxBytes) return lines.Wrong("longer than 64 KiB");
  Discriminant out;
  const auto names = lines.Next();
  if (names.size() < 2 || names.size() > kMaxFeatures + 1 || names[0] != "features") {
    return lines.Wrong("features NAME... with 1 to 16 names expected");
  }
  out.features.assign(names.begin() + 1, names.end());
  const Eigen::Index size = Size(out.features);
  const auto most = lines.Numbers("most", out.features.size());
  if (!most) return std::unexpected(most.error());
  out.most = Eigen::Map<const Eigen::VectorXf>(most->data(), size).cast<double>();
  if (out.most.minCoeff() < 0) return lines.Wrong("a number below 0 found after 'most'");
  for (auto words = lines.Next(); !words.empty(); words = lines.Next()) {
    if (words[0] != "class" || words.size() != out.features.size() + 3) {
      return lines.Wrong(
          fmt::format("class NAME CONSTANT and {} weights expected", out.features.size()));
    }
    if (out.classes.size() == kMaxClasses) return lines.Wrong("more than 16 classes found");
    Discriminant::Class made{.name = std::string(words[1]), .weights = Eigen::VectorXd(size)};
    for (std::size_t i = 2; i < words.size(); ++i) {
      const auto number = lines.Number(words[i]);
      if (!number) return std::unexpected(number.error());
      (i == 2 ? made.constant : made.weights[static_cast<Eigen::Index>(i) - 3]) =
          static_cast<double>(*number);
    }
    out.classes.push_back(std::move(made));
  }
  if (out.classes.size() < 2) return lines.Wrong("fewer than two classes found");
  return out;
}

std::string FormatDiscriminant(const Discriminant& discriminant) {
  const auto numbers = [](const Eigen::VectorXd& values) {
    std::string text;
    for (const double value : values) text += " " + NumberText(static_cast<float>(value));
    return text;
  };
  std::string text = fmt::format("features {}\nmost{}\n", fmt::join(discriminant.features, " "),
                                 numbers(discriminant.most));
  for (const Discriminant::Class& one : discriminant.classes) {
    text += "class " + one.name + " " + NumberText(static_cast<float>(one.constant)) +
            numbers(one.weights) + "\n";
  }
  return text;
}

}  // namespace vdm
