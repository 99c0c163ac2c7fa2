#include "face_fit/find/figure/figure_finder.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/network/face_networks.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// SymmetriseHead; lengths are divided by the height of the face.
constexpr float kNearbyReach = 0.03F;  // reach in which the other side's colour is searched
constexpr float kSameRatio = 0.8F;     // ratio to the other side's opacity above which both agree
// Difference of colours, 0..1: from unlike to alike.
constexpr fsm::Range kAlikeDifference{0.3F, 0.05F};
// New opacity, divided by the other side's: unlike, alike.
constexpr float kUnlikeRatio = 0.5F, kAlikeRatio = 0.85F;

// The second pass, over the head, relative to the size of the face: side of the square, and how far
// its middle lies above the face's, because there is hair above and only a neck below.
constexpr float kHeadSquare = 2.3F, kHeadHigher = 0.1F;
// Distance from the square's middle (its side = 1) over which the first pass takes over again.
constexpr fsm::Range kSquareEdge{0.48F, 0.38F};

/// Mean over the points of a face below which the network saw nobody there.
constexpr float kNobody = 0.5F;
/// Half the width of a neck, divided by the distance from the root of the nose to the chin.
constexpr float kHalfNeck = 0.35F;

/// Returns how much a point of the network's square, 0..1 on both axes, belongs to a person.
float PersonAt(const Mask& person, glm::vec2 p) {
  return person.SampleAt(p.x * kSegmentationPixels, p.y * kSegmentationPixels);
}

/// A rectangle of an image; it may extend beyond it.
struct ImageRect {
  glm::vec2 corner, size;
};

/// Returns the whole image, extended around a face that fills it: the network was trained on
/// figures with shoulders, and takes the wall for one where it sees little more than a face.
ImageRect WholeFor(glm::vec2 image_size, const Box2& face) {
  const glm::vec2 larger = glm::max(image_size, face.Size() / PhotoLook().figure.face_most_share);
  return {(image_size - larger) * glm::vec2(0.5F, PhotoLook().figure.above_share), larger};
}

Box2 BoxOf(const FoundFace& face) {
  Box2 box;
  for (const glm::vec3& p : face.points) box.Add(p);
  return box;
}

/// Returns a square round the head, within the image.
NetworkCrop HeadSquare(const Box2& face, glm::vec2 image_size) {
  const float face_size = std::max(face.Size().x, face.Size().y);
  const float size = std::min({kHeadSquare * face_size, image_size.x, image_size.y});
  const glm::vec2 middle = face.Middle() - glm::vec2(0, kHeadHigher * face_size);
  return {glm::clamp(middle, glm::vec2(size / 2), image_size - size / 2), size, 0};
}

/// Returns how nearly a face looks into the camera, 0..1, by the distances of its cheeks from its
/// middle.
float Frontal(const FoundFace& face, glm::vec2 middle, glm::vec2 across) {
  const float right = std::abs(glm::dot(face.PixelOf(point::kCheekRight) - middle, across));
  const float left = std::abs(glm::dot(face.PixelOf(point::kCheekLeft) - middle, across));
  return PhotoLook().figure.frontal.Ramp(std::min(right, left) / std::max({right, left, 1.0F}));
}

/// Sets the inside of the face's outline and the neck to 1, and the rest to 0, where the network
/// cannot be trusted: everywhere if it sees nobody on the face, as in photos of nothing but a face;
/// beside a cheek if the photo cuts off that ear, where it sees a narrow strip. The head's own ear
/// shows there instead.
void FillFromFaceOutline(const FoundFace& face, const fsm::Image& image, Mask& person) {
  float seen = 0, count = 0;
  for (const PointIndex i : point::kReliable) {
    const glm::vec2 p = face.PixelOf(i);
    if (!IsInside(image, p)) continue;
    seen += person(static_cast<int>(p.x), static_cast<int>(p.y));
    ++count;
  }
  const bool nobody = seen < kNobody * count;
  const CutOffParts cut = FindCutOffParts(face, image);
  if (!nobody && !cut.ears.right && !cut.ears.left) return;
  const std::vector<glm::vec2> outline = face.Line(point::kFaceOutline);
  const glm::vec2 eyes = face.PixelOf(point::kNasion), chin = face.PixelOf(point::kChin);
  const glm::vec2 down = chin - eyes, to_left(down.y, -down.x);
  const float half_neck = kHalfNeck * glm::dot(down, down);
  ForEachPixel(person.width, person.height, [&](int x, int y, std::size_t i) {
    const glm::vec2 p = glm::vec2(x, y) + 0.5F;
    const float way_down = glm::dot(p - eyes, down) / glm::dot(down, down);
    const bool left = glm::dot(p - eyes, to_left) > 0;
    const bool strip = way_down > 0 && way_down < 1 && (left ? cut.ears.left : cut.ears.right);
    if (!nobody && !strip) return;
    const bool neck = way_down > 1 && std::abs(glm::dot(p - eyes, to_left)) < half_neck;
    person[i] = neck || SignedDistance(outline, p) < 0 ? 1.0F : 0.0F;
  });
}

/// Returns how much each pixel belongs to a person, 0..1, as the network sees the rectangle.
Mask SegmentPeople(FaceNetworks& networks, const fsm::Image& image, const ImageRect& rect) {
  // The network expects the rectangle stretched to a square.
  const Mask people = networks.SegmentPerson(Resampled(
      image, rect.corner, glm::mat2(rect.size.x, 0, 0, rect.size.y), kSegmentationPixels, 0, 1));
  return Mask::From(image.width, image.height, [&](int x, int y) {
    return PersonAt(people, (glm::vec2(x, y) + 0.5F - rect.corner) / rect.size);
  });
}

/// Returns how much each pixel belongs to the person with this face.
Mask SegmentPersonOf(FaceNetworks& networks, const fsm::Image& image, const FoundFace& face) {
  const glm::vec2 size(image.width, image.height);
  const Mask people = SegmentPeople(networks, image, WholeFor(size, BoxOf(face)));
  const NetworkCrop head = HeadSquare(BoxOf(face), size);
  const Mask near = networks.SegmentPerson(head.Sample(image, kSegmentationPixels, 0, 1));
  auto person = Mask::From(image.width, image.height, [&](int x, int y) {
    // The mean, so that what either pass doubts is left to the matting.
    const glm::vec2 in_square = head.FromImage(glm::vec2(x, y) + 0.5F);
    const glm::vec2 from_middle = glm::abs(in_square - 0.5F);
    const float share = 0.5F * kSquareEdge.Ramp(std::max(from_middle.x, from_middle.y));
    return share > 0 ? glm::mix(people(x, y), PersonAt(near, in_square), share) : people(x, y);
  });
  KeepConnected(glm::ivec2(face.PixelOf(point::kNoseTip)), person);
  person = SymmetriseHead(face, image, person);
  FillFromFaceOutline(face, image, person);
  return person;
}

}  // namespace

Mask SymmetriseHead(const FoundFace& face, const fsm::Image& image, const Mask& person) {
  const glm::vec2 top = face.PixelOf(point::kForehead), chin = face.PixelOf(point::kChin);
  if (glm::distance(top, chin) < 1) return person;
  const glm::vec2 down = glm::normalize(chin - top), across(-down.y, down.x);
  const float height = glm::distance(top, chin), nearby = kNearbyReach * height;
  // Reaches ears and hats, but not what stands behind a shoulder.
  const auto [from, to] = PhotoLook().figure.mirrored_by_face;
  const fsm::Range mirrored_px{from * height, to * height};
  const float frontal = Frontal(face, chin, across);
  const auto unlike = [&](glm::vec2 p, glm::vec2 q) {
    float least = 1;
    for (const glm::ivec2 offset : kAround) {
      const glm::vec2 beside = q + nearby * glm::vec2(offset);
      least = std::min(least, glm::distance(ColourAt(image, p), ColourAt(image, beside)) / 255);
    }
    return least;
  };
  Mask doubted = person;
  ForEachPixel(image.width, image.height, [&](int x, int y, std::size_t i) {
    const glm::vec2 p = glm::vec2(x, y) + 0.5F;
    if (glm::dot(p - chin, down) > 0) return;
    const float from_axis = glm::dot(p - chin, across);
    const float mirrored = frontal * mirrored_px.Ramp(std::abs(from_axis));
    const glm::vec2 q = p - 2 * from_axis * across;
    if (mirrored <= 0 || !IsInside(image, q)) return;
    const float own = person[i], other = person(static_cast<int>(q.x), static_cast<int>(q.y));
    if (own > kSameRatio * other) return;
    const float alike = kAlikeDifference.Ramp(unlike(p, q));
    doubted[i] = std::max(own, mirrored * glm::mix(kUnlikeRatio, kAlikeRatio, alike) * other);
  });
  return doubted;
}

FigureCutout FindFigure(FaceNetworks& networks, const fsm::Image& photo) {
  return CutOutFigure(photo, SegmentPeople(networks, photo, {{0, 0}, {photo.width, photo.height}}));
}

FigureCutout FindFigureOf(FaceNetworks& networks, const fsm::Image& photo, const FoundFace& face) {
  return CutOutFigure(photo, SegmentPersonOf(networks, photo, face));
}

}  // namespace facefit
