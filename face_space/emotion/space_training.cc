#include "face_space/emotion/space_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "embedded/axes.h"
#include "face_space/emotion/identity_net.h"
#include "fsm/base/table_reader.h"
#include "vdm/train/adam.h"
#include "vdm/train/dice.h"

namespace facespace {
namespace {

using fsm::EmotionSpace;

/// Few enough that a product's sums are never split by the size of a machine's caches, which would
/// round otherwise.
constexpr Eigen::Index kColumns = 96;

/// The patterns of an emotion as ratios.
struct Lessons {
  std::vector<Axis> axes;
  std::vector<std::vector<Eigen::VectorXf>> patterns;  // of each axis
};

bool Opposite(const Axis& a, const Axis& b) {
  float product = 0;
  for (std::size_t k = 0; k < 3; ++k) product += a.at[k] * b.at[k];
  return product < -0.5F;
}

/// Draws what is to be blended: one to three neighbours, and how much of each.
class Blends {
 public:
  Blends(const Lessons& lessons, vdm::Dice dice) : lessons_(lessons), dice_(dice) {}

  void Fill(Lesson& lesson, float lead) {
    for (Eigen::Index c = 0; c < lesson.inputs.cols(); ++c) Draw(lesson, c, lead);
  }

 private:
  void Draw(Lesson& lesson, Eigen::Index c, float lead) {
    const double kind = dice_.Uniform();
    // Half of the lessons are emotions by themselves, a third blends of two, the rest of three.
    const std::size_t parts = kind < 0.5 ? 1 : kind < 0.8 ? 2 : 3;
    std::vector<std::size_t> chosen;
    for (int tries = 0; chosen.size() < parts && tries < 40; ++tries) {
      const std::size_t a = dice_.Below(lessons_.axes.size());
      const bool fits = std::ranges::all_of(chosen, [&](std::size_t b) {
        return a != b && !Opposite(lessons_.axes[a], lessons_.axes[b]);
      });
      if (fits) chosen.push_back(a);
    }
    const std::vector<double> shares = Shares(chosen.size());
    // Blends are those of first patterns: where the others lie the network is to find.
    const bool first = chosen.size() > 1 || dice_.Chance(0.4);
    Eigen::VectorXf ratios = Eigen::VectorXf::Zero(lesson.targets.rows());
    EmotionSpace::Point at{};
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const auto share = static_cast<float>(shares[k]);
      const auto& patterns = lessons_.patterns[chosen[k]];
      ratios += share * patterns[first ? 0 : dice_.Below(patterns.size())];
      for (std::size_t i = 0; i < 3; ++i) at[i] += share * lessons_.axes[chosen[k]].at[i];
    }
    const auto strength = static_cast<float>(dice_.Between(0.1, 1));
    lesson.targets.col(c) = strength * ratios;
    for (std::size_t i = 0; i < 3; ++i) {
      lesson.points(static_cast<Eigen::Index>(i), c) = strength * at[i];
    }
    lesson.led[c] = first ? lead : 0;
    // What is recognised is never quite right: the middle must stand it.
    for (Eigen::Index i = 0; i < ratios.size(); ++i) {
      const auto off = strength * static_cast<float>(dice_.Between(-kOff, kOff));
      lesson.inputs(i, c) = std::max(0.0F, lesson.targets(i, c) + off);
    }
  }

  /// Evenly spread over all shares whose sum is 1.
  std::vector<double> Shares(std::size_t count) {
    std::vector<double> cuts{0, 1};
    for (std::size_t k = 1; k < count; ++k) cuts.push_back(dice_.Uniform());
    std::ranges::sort(cuts);
    std::vector<double> shares;
    for (std::size_t k = 0; k < count; ++k) shares.push_back(cuts[k + 1] - cuts[k]);
    return shares;
  }

  static constexpr double kOff = 0.06;
  const Lessons& lessons_;
  vdm::Dice dice_;
};

std::vector<EmotionSpace::Layer> LayersOf(const vdm::TimeDelayNet& net) {
  std::vector<EmotionSpace::Layer> layers;
  for (const vdm::TimeDelayLayer& from : net.layers) {
    EmotionSpace::Layer& layer = layers.emplace_back();
    layer.rectified = from.rectified;
    for (Eigen::Index r = 0; r < from.weights.rows(); ++r) {
      std::vector<float>& row = layer.rows.emplace_back();
      for (const float weight : from.weights.row(r)) {
        row.push_back(std::round(weight * 1e4F) / 1e4F);  // as it is written
      }
    }
  }
  return layers;
}

vm::Result<Lessons> LessonsOf(const EmotionSpace& space, const fsm::ExpressionTable& expressions,
                              const std::vector<Axis>& axes) {
  Lessons lessons{.axes = axes, .patterns = {}};
  for (const Axis& axis : axes) {
    const auto found = expressions.find(axis.emotion);
    if (found == expressions.end()) {
      return vm::Fail(vm::Errc::kBadValue,
                      fmt::format("the space has an axis {}, which is no emotion of emotions.txt",
                                  axis.emotion));
    }
    auto& patterns = lessons.patterns.emplace_back();
    for (const fsm::FaceLook& look : found->second.patterns) {
      const std::vector<float> ratios = RatiosOf(space, look);
      patterns.emplace_back(
          Eigen::VectorXf::Map(ratios.data(), static_cast<Eigen::Index>(ratios.size())));
    }
  }
  return lessons;
}

/// The units that any pattern of these emotions uses, rising.
std::vector<int> UnitsOf(const fsm::ExpressionTable& expressions, const std::vector<Axis>& axes) {
  std::set<int> units;
  for (const Axis& axis : axes) {
    const auto found = expressions.find(axis.emotion);
    if (found == expressions.end()) continue;
    for (const fsm::FaceLook& look : found->second.patterns) {
      for (const fsm::UnitValues* side : {&look.au.right, &look.au.left}) {
        for (std::size_t unit = 0; unit < side->size(); ++unit) {
          if ((*side)[unit] > 0) units.insert(static_cast<int>(unit));
        }
      }
    }
  }
  return {units.begin(), units.end()};
}

std::string Rows(const char* key, const std::vector<EmotionSpace::Layer>& layers) {
  std::string text;
  for (const EmotionSpace::Layer& layer : layers) {
    text += fmt::format("{} {}\n", key, layer.rectified ? "relu" : "linear");
    for (const std::vector<float>& row : layer.rows) {
      text += "row";
      for (const float weight : row) {
        text += weight == 0 ? " 0" : fmt::format(" {:.4f}", weight);
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace

vm::Result<std::vector<Axis>> ReadAxes(const std::string& name, std::string_view text) {
  return fsm::ReadTable(name, text, [](const fsm::Table& table) {
    std::vector<Axis> axes;
    for (const fsm::TableRow& row : table.rows()) {
      if (row.key() != "axis") row.Refuse("axis NAME X Y Z expected");
      Axis axis{.emotion = row.Name(1, "an emotion's name"),
                .at = {row.Within(2, -1, 1), row.Within(3, -1, 1), row.Within(4, -1, 1)}};
      row.EndsAt(5);
      if (std::abs(std::hypot(axis.at[0], axis.at[1], axis.at[2]) - 1) > 0.01F) {
        row.Refuse("a place 1 from the middle expected");
      }
      for (const Axis& other : axes) {
        if (other.emotion == axis.emotion || other.at == axis.at) {
          row.Refuse("an emotion or a place that is there twice");
        }
      }
      axes.push_back(axis);
    }
    if (axes.size() < 2 || axes.size() > 6) table.Refuse("2 to 6 axes expected");
    return axes;
  });
}

const std::vector<Axis>& BuiltAxes() {
  static const std::vector<Axis> axes = ReadAxes("axes.txt", embedded::axes()).value();
  return axes;
}

std::vector<float> RatiosOf(const EmotionSpace& space, const fsm::FaceLook& look) {
  std::vector<float> ratios;
  for (const int number : space.units) {
    const auto unit = static_cast<std::size_t>(number);
    const float right = std::as_const(look.au.right)[unit],
                left = std::as_const(look.au.left)[unit];
    ratios.push_back((right + left) / 2);
  }
  return ratios;
}

vm::Result<EmotionSpace> LearnSpace(const SpacePlan& plan, const fsm::ExpressionTable& expressions,
                                    const std::vector<Axis>& axes,
                                    const std::function<void(double, double)>& progress) {
  EmotionSpace space;
  space.units = UnitsOf(expressions, axes);
  const auto lessons = LessonsOf(space, expressions, axes);
  if (!lessons) return std::unexpected(lessons.error());
  const auto units = static_cast<Eigen::Index>(space.units.size());
  IdentityNet net(units, plan.hidden, plan.seed);
  vdm::Adam encoder(net.encoder), decoder(net.decoder);
  IdentityLoss loss(net);
  IdentityGradient gradient(net);
  Lesson lesson{Eigen::MatrixXf(units, kColumns), Eigen::MatrixXf(units, kColumns),
                Eigen::MatrixXf(3, kColumns), Eigen::VectorXf(kColumns)};
  Blends blends(*lessons, vdm::Dice(plan.seed).For(1));
  for (int step = 0; step < plan.steps; ++step) {
    blends.Fill(lesson, static_cast<float>(plan.lead));
    const double now = loss.Of(lesson, gradient);
    // From the highest step down to almost nothing along a straight line.
    const double left = 1 - static_cast<double>(step) / plan.steps;
    const double rate = 4e-3 * left + 1e-5;
    encoder.Step(net.encoder, gradient.encoder, rate);
    decoder.Step(net.decoder, gradient.decoder, rate);
    if (progress && step % 100 == 0) progress(1 - left, now);
  }
  space.encoder = LayersOf(net.encoder);
  space.decoder = LayersOf(net.decoder);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Eigen::VectorXf& first = lessons->patterns[a][0];
    EmotionSpace::Point at = space.PointOf({first.data(), space.units.size()});
    for (float& x : at) x = std::round(x * 1e4F) / 1e4F;
    space.emotions.emplace(axes[a].emotion, at);
  }
  return space;
}

std::string FormatSpace(const EmotionSpace& space) {
  std::string text =
      "# The emotion space of FaceExp.point; docs/face_space.md. `face_space emotions` makes this "
      "file.\n";
  text += fmt::format("units {}\n", fmt::join(space.units, " "));
  text += Rows("encode", space.encoder) + Rows("decode", space.decoder);
  for (const auto& [emotion, at] : space.emotions) {
    text += fmt::format("emotion {} {:.4f} {:.4f} {:.4f}\n", emotion, at[0], at[1], at[2]);
  }
  return text;
}

std::vector<GivenBack> JudgeSpace(const EmotionSpace& space,
                                  const fsm::ExpressionTable& expressions,
                                  const std::vector<Axis>& axes) {
  std::vector<GivenBack> judged;
  for (const Axis& axis : axes) {
    const auto found = expressions.find(axis.emotion);
    if (found == expressions.end()) continue;
    for (std::size_t p = 0; p < found->second.patterns.size(); ++p) {
      const std::vector<float> ratios = RatiosOf(space, found->second.patterns[p]);
      GivenBack back{
          .emotion = axis.emotion, .pattern = static_cast<int>(p) + 1, .at = space.PointOf(ratios)};
      const std::vector<float> again = space.RatiosAt(back.at);
      for (std::size_t i = 0; i < ratios.size(); ++i) {
        const double off = std::abs(static_cast<double>(again[i]) - static_cast<double>(ratios[i]));
        back.rms += off * off;
        back.worst = std::max(back.worst, off);
      }
      back.rms = std::sqrt(back.rms / static_cast<double>(ratios.size()));
      judged.push_back(back);
    }
  }
  return judged;
}

}  // namespace facespace
