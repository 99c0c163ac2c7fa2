#include "film_dub/paint/mouth_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "face_fit/find/network/network_points.h"
#include "face_fit/image/plane.h"
#include "film_dub/paint/chin_mover.h"

namespace filmdub {
namespace {

using facefit::PointIndex;
namespace point = facefit::point;

// Below the nose from the person's right to left, down the left cheek, along the jaw to the right.
constexpr PointIndex kUpperEdge[] = {214, 216, 206, 203, 98, 2, 327, 423, 426, 436, 434};
constexpr PointIndex kJawEdge[] = {379, 378, 400, 377, 152, 148, 176, 149, 150};
// How far the chin's part of it lies beyond the jaw, as part of the way from the mouth, by how far
// it is from the ends: the new chin may be higher than the old one, whose edge is to vanish.
constexpr float kBeyondChin = 0.22F, kInsideJaw = 0.04F;
// Likewise how far inside the edge of the chin colours are compared.
constexpr float kEdge = 0.25F;
// Likewise how far outside it a face surely ends.
constexpr float kChinEdge = 0.06F;
// As parts of the distance between the eyes' outer corners.
constexpr float kFade = 0.10F;      // of the edge
constexpr float kOutside = 0.04F;   // of the way out of the faces to what need not be painted
constexpr float kAround = 0.12F;    // room beside the area, for what is smoothed
constexpr float kEvenness = 0.28F;  // how smooth the quotient is
constexpr float kMostGain = 2;
constexpr float kDifferenceSpread = 0.02F;
constexpr float kAlike = 0.05F, kUnlike = 0.12F;  // of colours 0..1
// What is finer than so many pixels is made stronger, at most by so much.
constexpr double kFine = 1, kMostSharper = 1.5;

/// The part of a picture that is worked on.
struct Part {
  cv::Rect box;
  float unit = 1;  // distance between the eyes' outer corners, pixels
};

/// The part with both areas and some room beside them.
Part PartOf(const fsm::Image& picture, std::span<const glm::vec2> a, std::span<const glm::vec2> b,
            float unit) {
  const int margin = cvCeil(std::max(kAround * unit, ChinReach(unit))) + 2;
  facefit::Box2 box;
  for (const auto outline : {a, b}) {
    for (const glm::vec2 p : outline) box.Add(p);
  }
  const cv::Point low(cvRound(box.low.x) - margin, cvRound(box.low.y) - margin);
  const cv::Point beyond(cvRound(box.high.x) + margin + 1, cvRound(box.high.y) + margin + 1);
  return {.box = cv::Rect(low, beyond) & cv::Rect(0, 0, picture.width, picture.height),
          .unit = unit};
}

std::vector<cv::Point> InPart(std::span<const glm::vec2> outline, const Part& part) {
  std::vector<cv::Point> pixels;
  for (const glm::vec2 p : outline) {
    pixels.emplace_back(cvRound(p.x) - part.box.x, cvRound(p.y) - part.box.y);
  }
  return pixels;
}

/// What lies inside either of two outlines: 255, else 0.
cv::Mat Inside(std::span<const glm::vec2> a, std::span<const glm::vec2> b, const Part& part) {
  cv::Mat mask(part.box.size(), CV_8U, cv::Scalar(0));
  for (const auto outline : {a, b}) {
    cv::fillPoly(mask, std::vector{InPart(outline, part)}, cv::Scalar(255));
  }
  return mask;
}

/// The outline of mouth and chin, from below the nose over both cheeks to `beyond` the chin, as
/// part of the way there from the mouth.
std::vector<glm::vec2> Outline(std::span<const glm::vec2> points, float beyond) {
  std::vector<glm::vec2> outline;
  for (const PointIndex i : kUpperEdge) outline.push_back(points[i]);
  const glm::vec2 mouth = 0.5F * (points[point::kMouthRight] + points[point::kMouthLeft]);
  constexpr auto kSteps = static_cast<float>(std::size(kJawEdge) - 1);
  for (std::size_t k = 0; k < std::size(kJawEdge); ++k) {
    const float across = 2 * static_cast<float>(k) / kSteps - 1;
    const glm::vec2 jaw = points[kJawEdge[k]];
    outline.push_back(jaw + (beyond * (1 - across * across) - kInsideJaw) * (jaw - mouth));
  }
  return outline;
}

/// The edge of the chin, in the part.
std::vector<glm::vec2> Chin(std::span<const glm::vec2> points, const Part& part) {
  std::vector<glm::vec2> edge;
  for (const PointIndex i : kJawEdge) {
    edge.push_back(points[i] - glm::vec2(part.box.x, part.box.y));
  }
  return edge;
}

/// The lips and what lies between and just around them.
std::vector<glm::vec2> Lips(std::span<const glm::vec2> points) {
  std::vector<glm::vec2> lips{points[point::kMouthRight]};
  for (const PointIndex i : point::kUpperOuterLip) lips.push_back(points[i]);
  lips.push_back(points[point::kMouthLeft]);
  for (auto i = point::kLowerOuterLip.rbegin(); i != point::kLowerOuterLip.rend(); ++i) {
    lips.push_back(points[*i]);
  }
  return lips;
}

cv::Mat Ellipse(float radius) {
  const int side = 2 * std::max(1, cvRound(radius)) + 1;
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

/// How much of what is drawn is shown: 0 at the edge of the area and outside, 1 well inside.
cv::Mat Shares(const cv::Mat& area, const Part& part) {
  cv::Mat inside, shares;
  cv::distanceTransform(area, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  shares.create(area.size(), CV_32F);
  const float fade = kFade * part.unit;
  for (int y = 0; y < area.rows; ++y) {
    for (int x = 0; x < area.cols; ++x) {
      const float t = std::clamp((inside.at<float>(y, x) - 1) / fade, 0.0F, 1.0F);
      shares.at<float>(y, x) = t * t * (3 - 2 * t);
    }
  }
  return shares;
}

/// What of the shares stays beside mouth and chin, and outside of `faces`: there film and drawing
/// show the same skin, and where they differ the drawing shows what is hidden in the film, or hair,
/// or a wall.
void KeepWhatDiffers(const cv::Mat& film, const cv::Mat& fresh, std::span<const glm::vec2> seen,
                     const cv::Mat& faces, const Part& part, cv::Mat& shares) {
  cv::Mat around, outside;
  cv::bitwise_not(faces, around);
  cv::distanceTransform(around, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat difference, smooth;
  cv::absdiff(film, fresh, difference);
  const double spread = static_cast<double>(kDifferenceSpread * part.unit);
  cv::GaussianBlur(difference, smooth, {}, spread, spread);
  const glm::vec2 right = seen[point::kMouthRight], left = seen[point::kMouthLeft];
  const glm::vec2 lips = 0.5F * (seen[point::kLipTop] + seen[point::kLipBottom]);
  const glm::vec2 middle = lips - glm::vec2(part.box.x, part.box.y);
  const glm::vec2 along = (left - right) / std::max(glm::distance(left, right), 1.0F);
  // Of a turned head the far half of the mouth is the narrower one.
  const float least = 0.08F * part.unit;
  const float right_half = std::max(glm::dot(lips - right, along), least);
  const float left_half = std::max(glm::dot(left - lips, along), least);
  for (int y = 0; y < shares.rows; ++y) {
    for (int x = 0; x < shares.cols; ++x) {
      const float across = glm::dot(glm::vec2(x, y) - middle, along);
      const float aside = std::max(across / left_half, -across / right_half);
      const float beside = std::clamp(
          std::max((aside - 1.1F) / 0.3F, outside.at<float>(y, x) / (kOutside * part.unit)), 0.0F,
          1.0F);
      if (beside <= 0) continue;
      const auto d = smooth.at<cv::Vec3f>(y, x);
      const float off = std::max({d[0], d[1], d[2]});
      const float alike = std::clamp((kUnlike - off) / (kUnlike - kAlike), 0.0F, 1.0F);
      shares.at<float>(y, x) *= 1 - beside * (1 - alike);
    }
  }
}

/// What the drawn colours are to be multiplied with to be the film's: the quotient of both where
/// `counts`, evenly spread.
cv::Mat Gains(const cv::Mat& film, const cv::Mat& drawn, const cv::Mat& counts, const Part& part) {
  const double smaller = std::clamp(24.0 / static_cast<double>(part.unit), 0.05, 1.0);
  const double spread = std::max(0.5, static_cast<double>(kEvenness * part.unit) * smaller);
  cv::Mat three;
  cv::merge(std::vector{counts, counts, counts}, three);
  const auto mean = [&](const cv::Mat& of) {
    cv::Mat weighted, small, smooth;
    cv::multiply(of, three, weighted);
    cv::resize(weighted, small, {}, smaller, smaller, cv::INTER_AREA);
    cv::GaussianBlur(small, smooth, {}, spread, spread, cv::BORDER_CONSTANT);
    return smooth;
  };
  const cv::Mat above = mean(film), below = mean(drawn);
  cv::Mat quotient(above.size(), CV_32FC3), gains;
  for (int y = 0; y < above.rows; ++y) {
    for (int x = 0; x < above.cols; ++x) {
      const auto a = above.at<cv::Vec3f>(y, x), b = below.at<cv::Vec3f>(y, x);
      for (int c = 0; c < 3; ++c) {
        quotient.at<cv::Vec3f>(y, x)[c] =
            b[c] > 1e-4F ? std::clamp(a[c] / b[c], 1 / kMostGain, kMostGain) : 1;
      }
    }
  }
  cv::resize(quotient, gains, film.size(), 0, 0, cv::INTER_LINEAR);
  return gains;
}

/// Skin that both film and drawing show: inside both chins, but for both mouths. 0 to 1.
cv::Mat SkinOfBoth(std::span<const glm::vec2> seen, std::span<const glm::vec2> points,
                   const cv::Mat& opacity, const Part& part) {
  const auto old_skin = Outline(seen, -kEdge), new_skin = Outline(points, -kEdge);
  cv::Mat skin, lips, counts;
  cv::bitwise_and(Inside(old_skin, old_skin, part), Inside(new_skin, new_skin, part), skin);
  cv::dilate(Inside(Lips(seen), Lips(points), part), lips, Ellipse(0.06F * part.unit));
  skin.setTo(0, lips);
  skin.convertTo(counts, CV_32F, 1.0 / 255);
  cv::multiply(counts, opacity, counts);
  return counts;
}

/// What of a picture is finer than kFine pixels.
cv::Mat FineOf(const cv::Mat& picture) {
  cv::Mat smooth, fine;
  cv::GaussianBlur(picture, smooth, {}, kFine, kFine);
  cv::subtract(picture, smooth, fine);
  return fine;
}

/// Makes what is drawn as sharp as the film, where it was drawn by a texture of the film's own
/// pixels: pores and lines of the skin that `counts` tells become as strong as they are there.
/// `grain`: the deviation of the film's noise, which is no skin.
void Sharpen(const cv::Mat& film, const cv::Mat& counts, double grain, cv::Mat& drawn) {
  const double weight = cv::sum(counts)[0];
  if (weight <= 0) return;
  const cv::Mat fine = FineOf(drawn);
  const auto variance = [&](const cv::Mat& of) {
    cv::Mat green;
    cv::extractChannel(of, green, 1);
    return cv::sum(green.mul(green).mul(counts))[0] / weight;
  };
  // So much of the variance of noise is finer than kFine: 1 - 2 g(0) + the sum of g squared.
  constexpr double kOfNoise =
      1 - 1 / (std::numbers::pi * kFine * kFine) + 1 / (4 * std::numbers::pi * kFine * kFine);
  const double wanted = variance(FineOf(film)) - kOfNoise * grain * grain;
  const double own = variance(fine);
  if (own <= 0 || wanted <= own) return;
  cv::scaleAdd(fine, std::min(std::sqrt(wanted / own) - 1, kMostSharper), drawn, drawn);
}

/// Noise of that deviation, as the film has it.
void AddGrain(double deviation, std::uint64_t seed, cv::Mat& drawn) {
  if (deviation <= 0) return;
  cv::Mat noise(drawn.size(), CV_32F), three;
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, deviation);
  cv::merge(std::vector{noise, noise, noise}, three);
  cv::add(drawn, three, drawn);
}

/// Colours 0..1 and opacity of the drawn face as it lies in the part.
void Lay(const DrawnMouth& drawn, const Part& part, cv::Mat& colours, cv::Mat& opacity) {
  const auto& m = drawn.placing.m;
  const cv::Matx23f map(m[0], m[1], m[2] - static_cast<float>(part.box.x), m[3], m[4],
                        m[5] - static_cast<float>(part.box.y));
  const cv::Mat whole(drawn.picture->height, drawn.picture->width, CV_8UC4,
                      const_cast<std::uint8_t*>(drawn.picture->rgba.data()));
  cv::Mat laid, real;
  cv::warpAffine(whole, laid, map, part.box.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  laid.convertTo(real, CV_32FC4, 1.0 / 255);
  std::vector<cv::Mat> channels;
  cv::split(real, channels);
  // The outermost pixels are mixed with nothing.
  cv::erode(channels[3], opacity, Ellipse(1));
  channels.pop_back();
  cv::merge(channels, colours);
}

}  // namespace

void PaintMouth(fsm::Image& picture, std::span<const glm::vec2> seen, const DrawnMouth& drawn,
                float share) {
  std::vector<glm::vec2> points;
  for (const glm::vec2 p : drawn.points) points.push_back(drawn.placing(p));
  const auto old_area = Outline(seen, kBeyondChin), new_area = Outline(points, kBeyondChin);
  const Part part = PartOf(picture, old_area, new_area,
                           glm::distance(seen[point::kEyeOuterRight], seen[point::kEyeOuterLeft]));
  if (part.box.width < 8 || part.box.height < 8 || share <= 0) return;

  cv::Mat colours, opacity, film;
  Lay(drawn, part, colours, opacity);
  cv::Mat film_part =
      cv::Mat(picture.height, picture.width, CV_8UC4, picture.rgba.data())(part.box);
  cv::cvtColor(film_part, film, cv::COLOR_RGBA2RGB);
  film.convertTo(film, CV_32FC3, 1.0 / 255);
  share = std::min(share, 1.0F);
  std::vector<glm::vec2> shown(seen.begin(), seen.end());  // the film's, with its chin moved
  for (const PointIndex i : kJawEdge) shown[i] += share * (points[i] - seen[i]);
  const glm::vec2 mouth = seen[point::kMouthLeft] - seen[point::kMouthRight];
  const cv::Mat moved = MoveChin(film, Chin(seen, part), Chin(shown, part),
                                 mouth / std::max(glm::length(mouth), 1.0F), part.unit);

  const cv::Mat counts = SkinOfBoth(shown, points, opacity, part);
  cv::multiply(colours, Gains(film, colours, counts, part), colours);
  Sharpen(film, counts, drawn.grain, colours);
  AddGrain(drawn.grain, drawn.seed, colours);
  cv::Mat shares = Shares(Inside(Outline(shown, kBeyondChin), new_area, part), part);
  const cv::Mat faces = Inside(Outline(shown, kChinEdge), Outline(points, kChinEdge), part);
  KeepWhatDiffers(film, colours, shown, faces, part, shares);
  cv::multiply(shares, opacity, shares, static_cast<double>(share));
  for (int y = 0; y < film.rows; ++y) {
    for (int x = 0; x < film.cols; ++x) {
      const float s = shares.at<float>(y, x);
      if (s <= 0 && moved.at<std::uint8_t>(y, x) == 0) continue;
      auto& out = film_part.at<cv::Vec4b>(y, x);
      const auto old = film.at<cv::Vec3f>(y, x), fresh = colours.at<cv::Vec3f>(y, x);
      for (int c = 0; c < 3; ++c) {
        out[c] = cv::saturate_cast<std::uint8_t>(255 * (old[c] + s * (fresh[c] - old[c])));
      }
    }
  }
}

}  // namespace filmdub
