#include "face_fit/find/network/face_finder.h"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/image/plane.h"
#include "fsm/image/shrink.h"

namespace facefit {
namespace {

constexpr float kMinFacePx = 8;  // smaller faces show no landmarks
/// Overlap above which two boxes show one face: intersection divided by the union, or by the
/// smaller box.
constexpr float kSameUnion = 0.3F, kSameSmaller = 0.6F;
/// The detector was trained on faces that fill at least a fifth of the image. Such a face found
/// in the whole image outranks those found in parts; a smaller one outranks them slightly.
constexpr float kWellSeen = 0.2F, kWellSeenRank = 1, kWholeRank = 0.15F;
/// A face too large for the detector is searched with the image's surroundings, this factor
/// larger.
constexpr float kZoomedOut = 1.6F;
/// Numbers of overlapping parts along the longer side that are searched, unless the largest face
/// found fills kFillsShare of a part: faces beside it, farther back or turned, are up to three
/// times smaller.
constexpr int kParts[] = {2, 4};
constexpr float kPartOverlap = 1.4F, kFillsShare = 0.85F;
/// Size of the crop the landmark network was trained on, divided by that of the face's box.
constexpr float kCropMargin = 1.5F;

/// Returns whether two boxes show one face, by the area of their intersection.
bool OfOneFace(const FaceBox& a, const FaceBox& b) {
  const glm::vec2 low = glm::max(a.centre - a.size * 0.5F, b.centre - b.size * 0.5F);
  const glm::vec2 high = glm::min(a.centre + a.size * 0.5F, b.centre + b.size * 0.5F);
  const glm::vec2 common = glm::max(high - low, 0.0F);
  const float both = common.x * common.y;
  return both / (a.Area() + b.Area() - both) > kSameUnion ||
         both / std::max(std::min(a.Area(), b.Area()), 1e-6F) > kSameSmaller;
}

/// A box, and its rank among boxes of the same face.
struct Detection {
  FaceBox face;
  float rank;
};

/// Runs the detector on squares of many sizes of an image. Each is cut from a copy hardly finer
/// than the detector sees it, which takes a tenth of the time.
class ScaledDetector {
 public:
  ScaledDetector(FaceNetworks& networks, const fsm::Image& image) : networks_(networks) {
    copies_.push_back(image);
    while (std::max(copies_.back().width, copies_.back().height) > 2 * kDetectorPixels) {
      copies_.push_back(fsm::Halved(copies_.back()));
    }
  }

  /// `whole`: cut it from the image itself, for full accuracy.
  void Search(glm::vec2 centre, float size, bool whole = false) {
    float scale = 1;
    std::size_t copy = 0;
    while (!whole && copy + 1 < copies_.size() && size * scale > 2 * kDetectorPixels) {
      scale *= 0.5F;
      ++copy;
    }
    const NetworkCrop crop{centre, size, 0}, in_copy{centre * scale, size * scale, 0};
    for (FaceBox face : networks_.Detect(in_copy.Sample(copies_[copy], kDetectorPixels, -1, 1))) {
      face.centre = crop.ToImage(face.centre);
      face.size *= size;
      for (glm::vec2& eye : face.eyes) eye = crop.ToImage(eye);
      const float smaller_px = std::min(face.size.x, face.size.y) * scale;
      if (smaller_px >= kMinFacePx) found.push_back({face, face.score});
    }
  }

  std::vector<Detection> found;

 private:
  FaceNetworks& networks_;
  std::vector<fsm::Image> copies_;
};

float EyeAngle(std::span<const glm::vec3> points) {
  return AngleOf(glm::vec2(points[point::kEyeOuterLeft] - points[point::kEyeOuterRight]));
}

FoundFace FindPoints(FaceNetworks& networks, const fsm::Image& image, const FaceBox& box) {
  FoundFace face{.points = {},
                 .score = box.score,
                 .crop = {box.centre, kCropMargin * std::max(box.size.x, box.size.y),
                          AngleOf(box.eyes[1] - box.eyes[0])}};
  // The first pass locates the face; the others see it upright and as large as in training.
  for (int pass = 0; pass < 3; ++pass) {
    if (pass > 0) face.crop = CropAround(face.points, face.crop.angle_rad);
    const Landmarks found = networks.Locate(face.crop.Sample(image, kLandmarkInputPixels, 0, 1));
    face.certainty = Probability(found.certainty_logit);
    face.points = PointsInImage(found.points, face.crop);
  }
  return face;
}

/// Returns one box for each face, that of the highest rank.
std::vector<FaceBox> SuppressNonMaxima(std::vector<Detection> found) {
  std::ranges::sort(found, std::greater<>(), &Detection::rank);
  std::vector<FaceBox> kept;
  for (const auto& [face, rank] : found) {
    if (std::ranges::none_of(kept, [&](const FaceBox& other) { return OfOneFace(other, face); })) {
      kept.push_back(face);
    }
  }
  return kept;
}

}  // namespace

std::vector<FoundFace> FindFaces(FaceNetworks& networks, const fsm::Image& image) {
  const glm::vec2 size(image.width, image.height);
  const float longer = std::max(size.x, size.y);
  ScaledDetector scan(networks, image);
  scan.Search(size * 0.5F, longer, true);
  for (Detection& detection : scan.found) {
    detection.rank += detection.face.size.x > kWellSeen * longer ? kWellSeenRank : kWholeRank;
  }
  // A face that fills the image is too large for the detector, one in a crowd too small.
  if (scan.found.empty()) scan.Search(size * 0.5F, longer * kZoomedOut, true);
  float largest = 0;
  for (const Detection& detection : scan.found) {
    largest = std::max(largest, detection.face.size.x);
  }
  for (const int parts : kParts) {
    if (largest > kFillsShare * longer / static_cast<float>(parts)) break;
    const float part = longer / static_cast<float>(parts) * kPartOverlap;
    for (int y = 0; y < 2 * parts; ++y) {
      for (int x = 0; x < 2 * parts; ++x) {
        const glm::vec2 centre = (glm::vec2(x, y) + 0.5F) * longer / static_cast<float>(2 * parts);
        if (centre.x <= size.x && centre.y <= size.y) scan.Search(centre, part);
      }
    }
  }
  auto boxes = SuppressNonMaxima(std::move(scan.found));
  std::ranges::sort(boxes, std::greater<>(), &FaceBox::Area);
  std::vector<FoundFace> faces;
  for (const FaceBox& box : boxes) faces.push_back(FindPoints(networks, image, box));
  const auto certain = [](const FoundFace& face) { return face.certainty >= kCertainFace; };
  if (faces.size() > 1 && std::ranges::any_of(faces, certain)) {
    std::erase_if(faces, std::not_fn(certain));
  }
  return faces;
}

PerPoint<glm::vec3> PointsInImage(PerPoint<glm::vec3> points, const NetworkCrop& crop) {
  for (glm::vec3& p : points) p = glm::vec3(crop.ToImage(glm::vec2(p)), p.z * crop.size);
  return points;
}

NetworkCrop CropAround(std::span<const glm::vec3> points, float axes_rad) {
  const NetworkCrop turned{glm::vec2(0), 1, axes_rad};
  Box2 box;
  for (const glm::vec3& p : points) box.Add(turned.FromImage(glm::vec2(p)));
  return {turned.ToImage(box.Middle()), kCropMargin * std::max(box.Size().x, box.Size().y),
          EyeAngle(points)};
}

NetworkCrop CropAround(std::span<const glm::vec3> points) {
  return CropAround(points, EyeAngle(points));
}

}  // namespace facefit
