#include "face_fit/find/face/occlusion_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/image/median.h"
#include "face_fit/image/raster.h"
#include "face_fit/image/resample.h"

namespace facefit {
namespace {

constexpr float kDarkest = 0.02F;  // 0..1; the colour of darker skin is unknown
constexpr std::size_t kPixels =
    static_cast<std::size_t>(kLandmarkInputPixels) * kLandmarkInputPixels;

struct Ellipse {
  // Millimetres on the built-in face: x to its left, y up.
  glm::vec2 middle{0}, radii{0};
};

/// A patch of the face, and the increase of the network's certainty (a logit) that it may cause
/// where nothing is before the face. The limits are 1.3 times the most seen on 57 images of three
/// uncovered faces (1.45 times round the mouth, where beards differ), left and right alike: the
/// photos as they are, in other light, colours and sharpness, with beards and glasses drawn on.
struct FacePatch {
  const char* name;
  float limit;
  std::array<Ellipse, 3> ellipses;
};
constexpr FacePatch kPatches[] = {
    // clang-format off
    {"the right eye",               2.1F, {{{{-31, 27}, {24, 19}}}}},
    {"the left eye",                2.1F, {{{{31, 27}, {24, 19}}}}},
    {"both eyes",                   2.8F, {{{{-31, 27}, {26, 19}}, {{31, 27}, {26, 19}}, {{0, 27}, {20, 14}}}}},
    {"the nose",                    2.0F, {{{{0, 0}, {19, 30}}}}},
    {"the mouth",                   3.6F, {{{{0, -44}, {34, 17}}}}},
    {"the right cheek",             2.8F, {{{{-42, -18}, {22, 28}}}}},
    {"the left cheek",              2.8F, {{{{42, -18}, {22, 28}}}}},
    {"the chin",                    2.4F, {{{{0, -72}, {36, 18}}}}},
    {"mouth and chin",              5.4F, {{{{0, -56}, {42, 32}}}}},
    {"nose, mouth, cheeks and chin", 7.2F, {{{{0, -45}, {64, 50}}, {{0, -5}, {50, 25}}}}},
    {"the right side of the face",  7.4F, {{{{-36, -5}, {32, 70}}}}},
    {"the left side of the face",   7.4F, {{{{36, -5}, {32, 70}}}}},
    // clang-format on
};
/// Certainty (a logit) below which a face counts as hidden; the least of the same images was
/// 15.7.
constexpr float kSureLogit = 14;

/// Maps pixels of the network's crop of the photo to the image of the built-in head: at each
/// pixel by the affine map that fits the points nearby best (moving least squares; Schaefer,
/// McPhail and Warren 2006).
class PhotoToBase {
 public:
  PhotoToBase(const FoundFace& face, const ObservedHead& base) {
    for (const PointIndex i : point::kReliable) {
      pairs_.push_back({face.crop.FromImage(face.PixelOf(i)) * float{kLandmarkInputPixels},
                        base.portrait().pixels[i]});
    }
  }

  glm::vec2 operator()(glm::vec2 p) const {
    constexpr float kNearPx = 4;
    float total = 0;
    glm::vec2 from(0), to(0);
    const auto weight = [&p](glm::vec2 q) {
      const float d = glm::dot(q - p, q - p) + kNearPx * kNearPx;
      return 1 / (d * d);
    };
    for (const auto& [q, r] : pairs_) {
      const float w = weight(q);
      total += w;
      from += w * q;
      to += w * r;
    }
    from /= total;
    to /= total;
    glm::mat2 square(1e-9F), cross(0);
    for (const auto& [q, r] : pairs_) {
      const float w = weight(q);
      square += w * glm::outerProduct(q - from, q - from);
      cross += w * glm::outerProduct(r - to, q - from);
    }
    return to + cross * glm::inverse(square) * (p - from);
  }

 private:
  struct Pair {
    glm::vec2 in_photo, on_base;
  };
  std::vector<Pair> pairs_;
};

/// The built-in head warped onto the face, for each pixel of the network's crop.
struct WarpedHead {
  std::vector<glm::vec2> on_face;  // on the built-in face, millimetres
  std::vector<glm::vec3> colour;   // 0..1
};

WarpedHead WarpBuiltInHead(const ObservedHead& base, const FoundFace& face) {
  // The map is smooth, so every fourth pixel is enough.
  constexpr int kStep = 4, kCells = kLandmarkInputPixels / kStep + 1;
  const PhotoToBase onto(face, base);
  const auto coarse = Raster<glm::vec2>::From(
      kCells, kCells, [&](int x, int y) { return onto(float{kStep} * glm::vec2(x, y)); });
  // From pixels of the head's image to millimetres from the root of the nose.
  const auto at_rest = [&](PointIndex i) { return glm::vec2(base.AtRest(i)); };
  const float mm_per_pixel =
      glm::distance(at_rest(point::kEyeOuterRight), at_rest(point::kEyeOuterLeft)) /
      glm::distance(base.portrait().pixels[point::kEyeOuterRight],
                    base.portrait().pixels[point::kEyeOuterLeft]);
  WarpedHead warped;
  for (int y = 0; y < kLandmarkInputPixels; ++y) {
    for (int x = 0; x < kLandmarkInputPixels; ++x) {
      const glm::vec2 cell = (glm::vec2(x, y) + 0.5F) / float{kStep};
      const glm::vec2 on_base = coarse.SampleAt(cell.x + 0.5F, cell.y + 0.5F);
      const glm::vec2 from_nasion =
          mm_per_pixel * (on_base - base.portrait().pixels[point::kNasion]);
      warped.on_face.push_back(at_rest(point::kNasion) + glm::vec2(from_nasion.x, -from_nasion.y));
      warped.colour.push_back(ColourAt(base.portrait().image, on_base) / 255.0F);
    }
  }
  return warped;
}

/// Returns whether a point of the built-in face is on cheeks, nose or forehead and not near an eye.
bool IsReferenceSkin(glm::vec2 mm) {
  constexpr glm::vec2 kEye(31, 25);
  constexpr float kEyeReach = 18, kBeside = 45, kLow = -20, kHigh = 60;
  const bool eye =
      std::abs(std::abs(mm.x) - kEye.x) < kEyeReach && std::abs(mm.y - kEye.y) < kEyeReach;
  return std::abs(mm.x) <= kBeside && mm.y >= kLow && mm.y <= kHigh && !eye;
}

/// Matches the colour of the built-in head's skin to the photo's by the medians over cheeks, nose
/// and forehead.
WarpedHead MatchSkinColour(std::span<const float> network_pixels, WarpedHead warped) {
  std::vector<glm::vec3> gains;
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (!IsReferenceSkin(warped.on_face[i])) continue;
    const glm::vec3 seen(network_pixels[3 * i], network_pixels[3 * i + 1],
                         network_pixels[3 * i + 2]);
    gains.push_back(seen / glm::max(warped.colour[i], kDarkest));
  }
  if (gains.empty()) return warped;
  const glm::vec3 gain = Median(gains);
  for (glm::vec3& colour : warped.colour) colour = glm::min(gain * colour, 1.0F);
  return warped;
}

/// Returns the weight of a patch at a pixel; it fades around the patch's radii.
float PatchWeight(const FacePatch& patch, glm::vec2 on_face) {
  constexpr float kPatchEnd = 1.15F, kPatchEdge = 0.3F;
  float weight = 0;
  for (const Ellipse& ellipse : patch.ellipses) {
    if (ellipse.radii.x <= 0) continue;
    const float radii = glm::length((on_face - ellipse.middle) / ellipse.radii);
    weight = std::max(weight, glm::clamp((kPatchEnd - radii) / kPatchEdge, 0.0F, 1.0F));
  }
  return weight;
}

}  // namespace

Occlusion DetectOcclusion(FaceNetworks& networks, const ObservedHead& base, const FoundFace& face,
                          const fsm::Image& photo) {
  const auto certainty_of = [&networks](std::span<const float> input) {
    return networks.Locate(input).certainty_logit;
  };
  const std::vector<float> network_pixels = face.crop.Sample(photo, kLandmarkInputPixels, 0, 1);
  const float before = certainty_of(network_pixels);
  const WarpedHead warped = MatchSkinColour(network_pixels, WarpBuiltInHead(base, face));
  float most_share = 0, most = -std::numeric_limits<float>::infinity();
  const char* part_name = "";
  for (const FacePatch& patch : kPatches) {
    std::vector<float> changed = network_pixels;
    for (std::size_t i = 0; i < kPixels; ++i) {
      const float weight = PatchWeight(patch, warped.on_face[i]);
      for (std::size_t c = 0; c < 3 && weight > 0; ++c) {
        changed[3 * i + c] =
            glm::mix(changed[3 * i + c], warped.colour[i][static_cast<int>(c)], weight);
      }
    }
    const float certainty_gain = certainty_of(changed) - before;
    const float share = certainty_gain / patch.limit;
    most_share = std::max(most_share, share);
    // Above their limits patches are ranked by logits.
    const float rank = share < 1 ? share : 1 + certainty_gain - patch.limit;
    if (rank <= most) continue;
    most = rank;
    part_name = patch.name;
  }
  const float doubt = kSureLogit / std::max(before, 1.0F);
  Occlusion occlusion{std::max(most_share, doubt), part_name};
  if (doubt >= kMaybeCovered && most_share < kMaybeCovered) occlusion.part_name.reset();
  return occlusion;
}

}  // namespace facefit
