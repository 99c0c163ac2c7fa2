#include "face_fit/find/face/iris.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/picture/resample.h"

namespace facefit {
namespace {

constexpr std::array<float, 9> kAngles = {-0.8F, -0.6F, -0.4F, -0.2F, 0, 0.2F, 0.4F, 0.6F, 0.8F};
constexpr std::array<float, 7> kSizes = {0.68F, 0.76F, 0.84F, 0.92F, 1.0F, 1.08F, 1.16F};

/// The part of a photo between the lids of an eye.
class EyeOpening {
 public:
  EyeOpening(const fsm::Image& photo, const OpenEye& eye)
      : photo_(photo), eye_(eye), lids_(eye.lids) {
    std::vector<float> all;
    for (float x = 0.06F; x < 0.95F; x += 0.03F) {
      const auto [upper, lower] = lids_.At(x);
      // The rims' shade and the lashes are left out.
      for (float part = 0.22F; part < 0.9F; part += 0.095F) {
        const glm::vec2 at = lids_.PointAt(x, glm::mix(upper, lower, part));
        samples_.push_back({at, Brightness(ColourAt(photo, at)) / 255, std::abs(lower - upper)});
        all.push_back(samples_.back().light);
      }
    }
    // What the eye mirrors is no brighter than its white.
    const auto bright = all.begin() + static_cast<std::ptrdiff_t>(all.size() * 9 / 10);
    std::ranges::nth_element(all, bright);
    brightest_ = *bright;
    for (Sample& s : samples_) s.light = std::min(s.light, brightest_);
  }

  /// The ring of this size that fits best, and how well.
  std::pair<IrisRing, float> Best(float radius) const {
    IrisRing best{.centre = eye_.middle, .radius = radius, .contrast = 0};
    float most = 0;
    for (int x = -9; x <= 9; ++x) {
      for (int y = -7; y <= 7; ++y) {
        const glm::vec2 off(static_cast<float>(x) * 0.02F, static_cast<float>(y) * 0.015F);
        const glm::vec2 at =
            eye_.middle + lids_.wide() * (off.x * lids_.along() + off.y * lids_.down());
        const float edge = Edge(at, radius);
        // Among equally clear rings the one of an eye that looks into the camera is preferred.
        const float merit =
            (edge + 1.5F * Apart(at, radius)) * (1 - 5 * off.x * off.x - 40 * off.y * off.y);
        if (merit <= most) continue;
        most = merit;
        best = {.centre = at, .radius = radius, .contrast = edge};
      }
    }
    return {best, most};
  }

 private:
  struct Sample {
    glm::vec2 at;
    float light, weight;
  };

  /// The step at the ring's sides. The worse of both counts most, so that the shadow of a lid or a
  /// brow is not taken for an iris.
  float Edge(glm::vec2 centre, float radius) const {
    std::array<float, 2> step{};
    for (const std::size_t side : {0U, 1U}) {
      const glm::vec2 outward = side == 0 ? -lids_.along() : lids_.along();
      float count = 0;
      for (const float angle : kAngles) {
        const glm::vec2 way = outward * std::cos(angle) + lids_.down() * std::sin(angle);
        const glm::vec2 rim = centre + radius * way;
        const auto [upper, lower] = lids_.At(lids_.Part(rim));
        const float y = lids_.Down(rim);
        if (y < glm::mix(upper, lower, 0.15F) || y > lower) continue;
        step[side] += Light(centre + 1.18F * radius * way) - Light(centre + 0.82F * radius * way);
        count += 1;
      }
      if (count < 3) return 0;
      step[side] /= count;
    }
    return std::min(step[0], step[1]) + 0.35F * std::max(step[0], step[1]);
  }

  float Light(glm::vec2 at) const {
    return std::min(Brightness(ColourAt(photo_, at)) / 255, brightest_);
  }

  /// How well the ring parts dark from bright: the deviation between the two (Otsu 1979), 0 where
  /// it is brighter within; and how much darker than all its inner half is, where the pupil lies.
  float Apart(glm::vec2 centre, float radius) const {
    // Pupil, the rest of the iris, what is beside it.
    std::array<float, 3> sum{}, weight{1e-4F, 1e-4F, 1e-4F};
    for (const Sample& s : samples_) {
      const glm::vec2 off = s.at - centre;
      const float far = glm::dot(off, off) / (radius * radius);
      const std::size_t zone = far > 1 ? 2 : far > 0.3F ? 1 : 0;
      sum[zone] += s.weight * s.light;
      weight[zone] += s.weight;
    }
    const float iris = sum[0] + sum[1], iris_weight = weight[0] + weight[1];
    const float all = iris_weight + weight[2];
    const float step = sum[2] / weight[2] - iris / iris_weight;
    const float pupil = (iris + sum[2]) / all - sum[0] / weight[0];
    return std::max(step, 0.0F) * std::sqrt(iris_weight * weight[2]) / all +
           0.7F * std::max(pupil, 0.0F);
  }

  const fsm::Image& photo_;
  const OpenEye& eye_;
  LidLines lids_;
  float brightest_ = 1;
  std::vector<Sample> samples_;
};

}  // namespace

std::vector<IrisRing> FindIrises(const fsm::Image& photo, std::span<const OpenEye> eyes) {
  std::vector<EyeOpening> openings;
  for (const OpenEye& eye : eyes) openings.emplace_back(photo, eye);
  std::vector<IrisRing> best;
  float most = -1;
  for (const float size : kSizes) {
    std::vector<IrisRing> rings;
    float merit = 0;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      const auto [ring, own] = openings[i].Best(size * eyes[i].expected);
      rings.push_back(ring);
      // People's irises are nearly all of one size.
      const float odd = (size - 0.92F) / 0.6F;
      merit += own * std::exp(-odd * odd);
    }
    if (merit <= most) continue;
    most = merit;
    best = std::move(rings);
  }
  return best;
}

}  // namespace facefit
