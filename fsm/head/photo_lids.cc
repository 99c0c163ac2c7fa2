#include "fsm/head/photo_lids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "fsm/head/spline.h"

namespace fsm {
namespace {

struct Sample {
  glm::vec2 at;  ///< millimetres
  glm::vec3 screen;
  bool above;
  float known;  ///< how surely it is skin, 0..1
  bool near;    ///< beside the lid rather than the brow
};

float Brightness(glm::vec3 c) { return 0.3f * c.r + 0.6f * c.g + 0.1f * c.b + 0.004f; }

template <typename Which>
glm::vec3 Median(std::span<const Sample> samples, Which which) {
  std::vector<glm::vec3> colours;
  for (const Sample& s : samples) {
    if (which(s)) colours.push_back(s.screen);
  }
  if (colours.empty()) return glm::vec3(0.5f);
  const auto middle = colours.begin() + static_cast<std::ptrdiff_t>(colours.size() / 2);
  std::ranges::nth_element(colours, middle, {}, Brightness);
  return *middle;
}

/// What would be seen where the eye is if there were none: a membrane held by the skin round it.
class Membrane {
 public:
  explicit Membrane(std::span<const Sample> samples) {
    glm::vec2 low(1e9f), high(-1e9f);
    for (const Sample& s : samples) {
      low = glm::min(low, s.at);
      high = glm::max(high, s.at);
    }
    low_ = low - kStep;
    width_ = static_cast<int>(std::min((high.x - low_.x) / kStep, kMost)) + 2;
    height_ = static_cast<int>(std::min((high.y - low_.y) / kStep, kMost)) + 2;
    std::vector<glm::vec4> held(static_cast<std::size_t>(width_ * height_), glm::vec4(0));
    glm::vec4 all(0);
    for (const Sample& s : samples) {
      const glm::ivec2 c(glm::round((s.at - low_) / kStep));
      const glm::vec4 sample(s.known * s.screen, s.known);
      held[Cell(c.x, c.y)] += sample;
      all += sample;
    }
    colour_.assign(held.size(), glm::vec3(all) / std::max(all.w, 1e-6f));
    for (int round = 0; round < kRounds; ++round) {
      for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
          const glm::vec3 beside = colour_[Cell(x - 1, y)] + colour_[Cell(x + 1, y)] +
                                   colour_[Cell(x, y - 1)] + colour_[Cell(x, y + 1)];
          const glm::vec4 here = held[Cell(x, y)];
          colour_[Cell(x, y)] = (glm::vec3(here) + kStiff * beside) / (here.w + 4 * kStiff);
        }
      }
    }
  }
  glm::vec3 At(glm::vec2 at) const {
    const glm::vec2 p = (at - low_) / kStep;
    const glm::vec2 corner = glm::floor(p), part = p - corner;
    const auto row = [&](float y) {
      const int x = static_cast<int>(corner.x);
      return glm::mix(colour_[Cell(x, static_cast<int>(y))],
                      colour_[Cell(x + 1, static_cast<int>(y))], part.x);
    };
    return glm::mix(row(corner.y), row(corner.y + 1), part.y);
  }

 private:
  static constexpr float kStep = 0.75f;   // millimetres
  static constexpr float kMost = 150;     // cells each way
  static constexpr float kStiff = 0.15f;  // against what is known at a cell
  static constexpr int kRounds = 300;

  std::size_t Cell(int x, int y) const {
    return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1) * width_ +
                                    std::clamp(x, 0, width_ - 1));
  }
  glm::vec2 low_{};
  int width_ = 0, height_ = 0;
  std::vector<glm::vec3> colour_;
};

/// Lashes, glasses, brows and reflections are darker or brighter than most of the skin round an
/// eye.
void Weigh(std::span<Sample> samples) {
  constexpr float kSpread = 0.6f;  // of the logarithm of brightness
  constexpr float kDarkest = 3;    // times darker than most a socket may be, unlike lashes
  constexpr float kOwn = 0.85f;    // how far either side's own brightness is believed
  const float usual = Brightness(Median(samples, [](const Sample& s) { return s.known > 0; }));
  // Sockets may well be darker than what lies below the eye.
  const auto mostly = [&](bool above) {
    const glm::vec3 here = Median(
        samples, [above](const Sample& s) { return s.known > 0 && s.near && s.above == above; });
    return std::pow(usual, 1 - kOwn) * std::pow(std::max(Brightness(here), usual / kDarkest), kOwn);
  };
  const float above = mostly(true), below = mostly(false);
  for (Sample& s : samples) {
    const float odd = std::log(Brightness(s.screen) / (s.above ? above : below)) / kSpread;
    s.known *= std::exp(-odd * odd);
  }
}

/// Skin below an eye that lends its grain to the lid above it.
struct Lender {
  glm::vec2 at, place;
  glm::vec3 screen;
};

/// Means with weights that fall off with the distance from `at`, millimetres.
Lender Around(std::span<const Lender> lenders, glm::vec2 at, float reach) {
  Lender mean{at, glm::vec2(0), glm::vec3(0)};
  float weight = 1e-9f;
  for (const Lender& l : lenders) {
    const glm::vec2 off = (l.at - at) / reach;
    const float w = std::exp(-glm::dot(off, off)) + 1e-8f;
    mean.place += w * l.place;
    mean.screen += w * l.screen;
    weight += w;
  }
  mean.place /= weight;
  mean.screen /= weight;
  return mean;
}

/// Skin under lashes that take `dark` of its light, 0..1: they are brown where there is colour.
glm::vec3 Lashed(glm::vec3 skin, float dark) {
  const float chroma = std::max(skin.r - skin.b, 0.0f) / std::max(skin.r, 0.01f);
  const glm::vec3 brown = glm::vec3(1) + std::min(2 * chroma, 1.0f) * glm::vec3(0, 0.3f, 0.6f);
  return skin * glm::pow(glm::vec3(1 - dark), brown);
}

/// The mean of the skin below an eye.
glm::vec3 MeanBelow(std::span<const Sample> samples) {
  glm::vec3 sum(1e-4f);
  float weight = 1e-4f;
  for (const Sample& s : samples) {
    if (s.above) continue;
    sum += s.known * s.screen;
    weight += s.known;
  }
  return sum / weight;
}

/// A lid is of one skin with what lies below the eye; what it takes from above may be the shine of
/// glasses, a rim, or lashes.
glm::vec3 OfHue(glm::vec3 colour, glm::vec3 skin) {
  constexpr float kPart = 0.65f;
  return glm::mix(colour, skin * (Brightness(colour) / Brightness(skin)), kPart);
}

/// Of a line of places by x; 0 without any.
float HeightAt(std::span<const glm::vec2> line, float x) {
  float sum = 0, weight = 1e-9f;
  for (const glm::vec2 p : line) {
    const float off = p.x - x;
    const float w = std::exp(-off * off) + 1e-8f;
    sum += w * p.y;
    weight += w;
  }
  return sum / weight;
}

/// To and fro: there is only so much skin below an eye before a cheek or a rim of glasses begins.
float Folded(float away) {
  constexpr float kThere = 5;  // millimetres
  const float part = std::fmod(away, 2 * kThere);
  return kThere - std::abs(part - kThere);
}

/// How places in the photo go with places on the face: the slope of the plane through them.
glm::mat2 PhotoByFace(std::span<const Lender> all) {
  Lender mean{glm::vec2(0), glm::vec2(0), glm::vec3(0)};
  for (const Lender& l : all) {
    mean.at += l.at / static_cast<float>(all.size());
    mean.place += l.place / static_cast<float>(all.size());
  }
  glm::mat2 spread(1e-6f), both(0);
  for (const Lender& l : all) {
    spread += glm::outerProduct(l.at - mean.at, l.at - mean.at);
    both += glm::outerProduct(l.place - mean.place, l.at - mean.at);
  }
  return both * glm::inverse(spread);
}

}  // namespace

glm::vec3 PhotoColour(const WornPhoto& photo, glm::vec2 place) {
  const auto at = [](float part, int size) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(part * static_cast<float>(size)), 0, size - 1));
  };
  const std::uint8_t* p =
      &photo.rgba[4 * (at(place.y, photo.height) * static_cast<std::size_t>(photo.width) +
                       at(place.x, photo.width))];
  return glm::vec3(p[0], p[1], p[2]) / 255.0f;
}

std::vector<LidPaint> PaintLids(const WornPhoto& photo, std::span<const glm::vec3> places,
                                std::span<const Flesh> skin, std::span<const glm::vec3> open,
                                std::span<const glm::vec3> shut) {
  constexpr float kAside = 3;  // millimetres beyond the corners
  std::vector<LidPaint> lids;
  for (const int side : {-1, 1}) {
    // How far a place goes with a lid: 1 at the rim, a third where the lid ends, 0 at the socket's.
    std::vector<Sample> samples;
    std::vector<Lender> lenders;
    std::vector<glm::vec2> upper_rim, lower_rim, rims;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      if (f.eye != side) continue;
      const glm::vec2 at(open[i]);
      const glm::vec3 screen = PhotoColour(photo, glm::vec2(places[i]));
      samples.push_back({at, screen, f.lid_upper >= f.lid_lower, 1, false});
      if (f.lid_upper + f.lid_lower > 0.95f) rims.push_back(at);
      if (f.lid_upper > 0.95f) upper_rim.push_back(at);
      if (f.lid_lower > 0.95f) lower_rim.push_back(at);
      lenders.push_back({at, glm::vec2(places[i]), screen});
    }
    if (upper_rim.empty() || lower_rim.empty()) continue;
    const auto [rim_first, rim_last] = std::ranges::minmax(upper_rim, {}, &glm::vec2::x);
    const float rim_from = rim_first.x, rim_to = rim_last.x;
    const glm::mat2 photo_by_face = PhotoByFace(lenders);
    for (Sample& s : samples) {
      // Along the rims the photo shows lashes.
      float away = 100;
      for (const glm::vec2 rim : rims) away = std::min(away, glm::distance(rim, s.at));
      s.near = away < 6;
      s.known = s.above ? SmoothStep(1.0f, 3.0f, away) : SmoothStep(0.6f, 1.6f, away);
    }
    Weigh(samples);
    const Membrane membrane(samples);
    const glm::vec3 below_eye = MeanBelow(samples);
    const auto eyeless = [&](glm::vec2 at) { return OfHue(membrane.At(at), below_eye); };
    std::vector<Lender> below = lenders;
    std::erase_if(below,
                  [&](const Lender& l) { return l.at.y > HeightAt(lower_rim, l.at.x) - 0.5f; });
    for (std::uint32_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      if (f.eye != side) continue;
      const glm::vec2 at(shut[i]);
      const float aside = (2 * at.x - rim_from - rim_to) / std::max(rim_to - rim_from, 1.0f);
      // Lashes are densest and longest outward.
      const float outward = SmoothStep(-0.8f, 0.7f, aside * static_cast<float>(side));
      const glm::vec3 colour = eyeless(at);
      if (f.lid_upper <= 0) {
        // The lashes of the upper lid lie over the rim of the lower.
        const float lashes = SmoothStep(0.96f - 0.08f * outward, 1.0f, f.lid_lower);
        lids.push_back({i, Lashed(colour, 0.58f * lashes), (0.3f + 0.4f * outward) * lashes,
                        glm::vec2(places[i]), Brightness(Around(lenders, at, 2).screen),
                        glm::vec2(0)});
        continue;
      }
      const float meet = HeightAt(lower_rim, at.x), rim = HeightAt(upper_rim, at.x);
      const float down = SmoothStep(rim, meet, at.y);
      // The ball rounds the lid: a ridge of light across it, most in the middle, shade at its ends,
      // a soft furrow above where it slips under the skin.
      const float inside = std::min(aside * aside, 1.0f);
      const float ridge = SmoothStep(0.15f, 0.5f, down) * SmoothStep(0.95f, 0.6f, down);
      const float furrow = (at.y - rim - 0.6f) / 1.1f;
      const float round = (1 + SmoothStep(0.0f, 0.3f, down) *
                                   (0.14f * ridge * (1 - 0.5f * inside) - 0.06f - 0.1f * inside)) *
                          (1 - 0.16f * (1 - inside) * std::exp(-furrow * furrow));
      // What bulges to the front is lit like the skin below.
      const float front = glm::mix(1.0f, Brightness(below_eye) / Brightness(colour),
                                   0.45f * SmoothStep(0.0f, 0.7f, down) * (1 - 0.4f * inside));
      const float lashes = (0.3f + 0.3f * outward) * SmoothStep(0.97f, 1.0f, f.lid_upper);
      const float part = SmoothStep(rim + 4.6f, rim + 2.2f, at.y) *
                         SmoothStep(0.02f, 0.2f, f.lid_upper) *
                         SmoothStep(kAside, 0, std::max(rim_from - at.x, at.x - rim_to));
      const glm::vec2 mirrored(at.x, meet - 1.5f - Folded(std::max(at.y - meet, 0.0f)));
      const Lender near = Around(below, mirrored, 1.5f), wide = Around(below, mirrored, 4);
      lids.push_back({i, glm::clamp(Lashed(front * round * colour, lashes), 0.0f, 1.0f), part,
                      near.place, Brightness(wide.screen),
                      photo_by_face * (at - glm::vec2(open[i]))});
    }
  }
  return lids;
}

}  // namespace fsm
