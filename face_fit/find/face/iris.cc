#include "face_fit/find/face/iris.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"

namespace facefit {
namespace {

// The candidates: radii relative to the expected one, offsets relative to the width of the eye.
constexpr std::array<float, 7> kSizes = {0.68F, 0.76F, 0.84F, 0.92F, 1.0F, 1.08F, 1.16F};
constexpr float kUsualSize = 0.92F, kSizeSpread = 0.6F;  // people's irises vary little in size
constexpr float kStepAlong = 0.02F, kStepDown = 0.015F;
constexpr int kStepsAlong = 9, kStepsDown = 7;  // steps to either side of the expected centre
/// Loss of score with the squared offset from the expected centre: eyes mostly look into the
/// camera.
constexpr float kAwayAlong = 5, kAwayDown = 40;

// Where the step of brightness at the circle's left and right is sampled: angles from the axis of
// the eye; radii inside and outside, relative to the circle's.
constexpr std::array<float, 9> kAnglesRad = {-0.8F, -0.6F, -0.4F, -0.2F, 0, 0.2F, 0.4F, 0.6F, 0.8F};
constexpr float kWithin = 0.82F, kOutside = 1.18F;
constexpr float kMinSeen = 3;         // number of visible samples that a side needs
constexpr float kBetterSide = 0.35F;  // weight of the side with the greater step; the other has 1
// Weights of the other terms of a circle's score; the edge has 1.
constexpr float kSeparationWeight = 1.5F, kPupilWeight = 0.7F;
constexpr float kPupil = 0.3F;  // square of the largest pupil's radius, iris = 1

// Positions between upper lid (0) and lower lid (1) that leave out the rims' shade and lashes.
constexpr float kUpperRim = 0.22F, kLowerRim = 0.9F, kShadow = 0.15F;
// The grid on which an eye is sampled: positions from the outer corner (0) to the inner one (1),
// and steps along it and between the rims.
constexpr float kOuterEnd = 0.06F, kInnerEnd = 0.95F, kSampleAlong = 0.03F, kSampleDown = 0.095F;
/// Percent of the samples that are darker than the white; reflections are brighter than it.
constexpr std::size_t kDarkerPercent = 90;

struct ScoredCircle {
  IrisCircle circle;
  float score = 0;
};

/// Searches a photo between the lids of an eye.
class IrisSearch {
 public:
  IrisSearch(const fsm::Image& photo, const ExpectedEye& eye)
      : photo_(photo), eye_(eye), lids_(eye.lids) {
    std::vector<float> all;
    for (float along = kOuterEnd; along < kInnerEnd; along += kSampleAlong) {
      const auto [upper, lower] = lids_.LidsAt(along);
      for (float share = kUpperRim; share < kLowerRim; share += kSampleDown) {
        const glm::vec2 pixel = lids_.PointAt(along, glm::mix(upper, lower, share));
        samples_.push_back(
            {pixel, Brightness(ColourAt(photo, pixel)) / 255, std::abs(lower - upper)});
        all.push_back(samples_.back().brightness);
      }
    }
    // Clamp reflections to the brightness of the white.
    const auto bright =
        all.begin() + static_cast<std::ptrdiff_t>(all.size() * kDarkerPercent / 100);
    std::ranges::nth_element(all, bright);
    brightest_ = *bright;
    for (Sample& s : samples_) s.brightness = std::min(s.brightness, brightest_);
  }

  ScoredCircle BestCircle(float radius) const {
    ScoredCircle best{{.centre_px = eye_.iris_centre_px, .radius_px = radius, .contrast = 0}};
    for (int x = -kStepsAlong; x <= kStepsAlong; ++x) {
      for (int y = -kStepsDown; y <= kStepsDown; ++y) {
        const glm::vec2 away(static_cast<float>(x) * kStepAlong, static_cast<float>(y) * kStepDown);
        const glm::vec2 centre =
            eye_.iris_centre_px +
            lids_.width() * (away.x * lids_.along_axis() + away.y * lids_.down_axis());
        const float edge = EdgeContrast(centre, radius);
        const float score = (edge + kSeparationWeight * Separation(centre, radius)) *
                            (1 - kAwayAlong * away.x * away.x - kAwayDown * away.y * away.y);
        if (score <= best.score) continue;
        best = {{.centre_px = centre, .radius_px = radius, .contrast = edge}, score};
      }
    }
    return best;
  }

 private:
  struct Sample {
    glm::vec2 pixel;
    float brightness, weight;
  };

  /// Returns the step of brightness at the circle's sides. The smaller one counts most, so that the
  /// shadow of a lid or a brow is not taken for an iris.
  float EdgeContrast(glm::vec2 centre, float radius) const {
    std::array<float, 2> step{};
    for (const std::size_t side : {0U, 1U}) {
      const glm::vec2 outward = side == 0 ? -lids_.along_axis() : lids_.along_axis();
      float count = 0;
      for (const float angle : kAnglesRad) {
        const glm::vec2 direction = outward * std::cos(angle) + lids_.down_axis() * std::sin(angle);
        const glm::vec2 rim = centre + radius * direction;
        const auto [upper, lower] = lids_.LidsAt(lids_.Along(rim));
        const float y = lids_.Down(rim);
        if (y < glm::mix(upper, lower, kShadow) || y > lower) continue;
        step[side] += BrightnessAt(centre + kOutside * radius * direction) -
                      BrightnessAt(centre + kWithin * radius * direction);
        count += 1;
      }
      if (count < kMinSeen) return 0;
      step[side] /= count;
    }
    return std::min(step[0], step[1]) + kBetterSide * std::max(step[0], step[1]);
  }

  float BrightnessAt(glm::vec2 pixel) const {
    return std::min(Brightness(ColourAt(photo_, pixel)) / 255, brightest_);
  }

  /// Returns how well the circle separates dark from bright: the between-class deviation (Otsu
  /// 1979), 0 if the inside is brighter; plus how much darker than the whole its centre is, where
  /// the pupil lies.
  float Separation(glm::vec2 centre, float radius) const {
    // Zones: pupil, rest of the iris, white.
    std::array<float, 3> sum{}, weight{1e-4F, 1e-4F, 1e-4F};
    for (const Sample& s : samples_) {
      const glm::vec2 offset = s.pixel - centre;
      const float square = glm::dot(offset, offset) / (radius * radius);
      const std::size_t zone = square > 1 ? 2 : square > kPupil ? 1 : 0;
      sum[zone] += s.weight * s.brightness;
      weight[zone] += s.weight;
    }
    const float iris = sum[0] + sum[1], iris_weight = weight[0] + weight[1];
    const float all = iris_weight + weight[2];
    const float step = sum[2] / weight[2] - iris / iris_weight;
    const float pupil = (iris + sum[2]) / all - sum[0] / weight[0];
    return std::max(step, 0.0F) * std::sqrt(iris_weight * weight[2]) / all +
           kPupilWeight * std::max(pupil, 0.0F);
  }

  const fsm::Image& photo_;
  const ExpectedEye& eye_;
  LidLines lids_;
  float brightest_ = 1;
  std::vector<Sample> samples_;
};

}  // namespace

fsm::Sided<IrisCircle> FindIrises(const fsm::Image& photo, const fsm::Sided<ExpectedEye>& eyes) {
  fsm::Sided<IrisSearch> searches{{photo, eyes.right}, {photo, eyes.left}};
  fsm::Sided<IrisCircle> best;
  float most = -1;
  for (const float size : kSizes) {
    fsm::Sided<IrisCircle> circles;
    float score = 0;
    for (const fsm::Side side : fsm::kSides) {
      const auto [circle, own_score] = searches[side].BestCircle(size * eyes[side].iris_radius_px);
      circles[side] = circle;
      const float odd = (size - kUsualSize) / kSizeSpread;
      score += own_score * std::exp(-odd * odd);
    }
    if (score <= most) continue;
    most = score;
    best = circles;
  }
  return best;
}

}  // namespace facefit
