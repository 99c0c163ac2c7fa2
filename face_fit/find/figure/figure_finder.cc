#include "face_fit/find/figure/figure_finder.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/plane.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// What the network says of the picture it was given.
FloatImage RunSegmentation(FaceNetworks& networks, const std::vector<float>& input) {
  networks.segmentation.Run(input);
  FloatImage out(kFigurePixels, kFigurePixels);
  std::ranges::copy(networks.segmentation.output(0), out.at.begin());
  return out;
}

/// How much a place of the network's square, 0..1 on both axes, belongs to a person.
float PersonAt(const FloatImage& figure, glm::vec2 place) {
  return figure.Between(place.x * kFigurePixels, place.y * kFigurePixels);
}

/// A rectangle of a picture, or beyond it.
struct PictureRect {
  glm::vec2 corner, size;
};

/// The whole picture, and more around a face that fills it: the network knows figures with
/// shoulders, and in pictures of little more than a face takes the wall for one.
PictureRect WholeFor(glm::vec2 picture, const Box2& face) {
  const glm::vec2 larger = glm::max(picture, face.Size() / PhotoLook()("figure_face"));
  return {(picture - larger) * glm::vec2(0.5F, PhotoLook()("figure_above")), larger};
}

Box2 BoxOf(const FoundFace& face) {
  Box2 box;
  for (const glm::vec3& p : face.points) box.Add(p);
  return box;
}

/// How nearly a face looks into the camera, 0..1: then its cheeks are as far from its middle.
float Frontal(const FoundFace& face, glm::vec2 middle, glm::vec2 across) {
  const float right = std::abs(glm::dot(face.At(point::kCheekRight) - middle, across));
  const float left = std::abs(glm::dot(face.At(point::kCheekLeft) - middle, across));
  return Ramp(PhotoLook().Pair("figure_frontal"),
              std::min(right, left) / std::max({right, left, 1.0F}));
}

}  // namespace

FloatImage DoubtAsymmetry(const FoundFace& face, const fsm::Image& image, const FloatImage& seen) {
  const int width = image.width, height = image.height;
  const glm::vec2 top = face.At(point::kForehead), chin = face.At(point::kChin);
  if (glm::distance(top, chin) < 1) return seen;
  const glm::vec2 down = glm::normalize(chin - top), across(-down.y, down.x);
  const float tall = glm::distance(top, chin), near = 0.03F * tall;
  // Ears and hats, not what stands behind a shoulder.
  const glm::vec2 aside = PhotoLook().Pair("figure_mirrored") * tall;
  const float frontal = Frontal(face, chin, across);
  const auto unlike = [&](glm::vec2 p, glm::vec2 q) {
    float least = 1;
    for (int k = 0; k < 9; ++k) {
      const glm::vec2 beside = q + near * (glm::vec2(k % 3, k / 3) - 1.0F);
      least = std::min(least, glm::distance(ColourAt(image, p), ColourAt(image, beside)) / 255);
    }
    return least;
  };
  FloatImage person = seen;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F;
      if (glm::dot(p - chin, down) > 0) continue;
      const float off = glm::dot(p - chin, across);
      const float part = frontal * Ramp(aside, std::abs(off));
      const glm::vec2 q = p - 2 * off * across;
      if (part <= 0 || q.x < 0 || q.y < 0 || q.x >= static_cast<float>(width) ||
          q.y >= static_cast<float>(height)) {
        continue;
      }
      const auto at = [&image](glm::vec2 v) {
        return image.Index(static_cast<int>(v.x), static_cast<int>(v.y));
      };
      const float here = seen.at[at(p)], there = seen.at[at(q)];
      if (here > 0.8F * there) continue;
      const float alike = glm::smoothstep(0.3F, 0.05F, unlike(p, q));
      person.at[at(p)] = std::max(here, part * glm::mix(0.5F, 0.85F, alike) * there);
    }
  }
  return person;
}

FloatImage SegmentPerson(FaceNetworks& networks, const fsm::Image& image, const FoundFace* face) {
  const glm::vec2 size(image.width, image.height);
  // The network takes a rectangle stretched to a square.
  const PictureRect all = face ? WholeFor(size, BoxOf(*face)) : PictureRect{{0, 0}, size};
  const FloatImage whole = RunSegmentation(
      networks,
      Resampled(image, all.corner, glm::mat2(all.size.x, 0, 0, all.size.y), kFigurePixels, 0, 1));
  FloatImage near;
  Crop head;
  if (face) {
    const Box2 box = BoxOf(*face);
    const float face_size = std::max(box.Size().x, box.Size().y);
    head.size = std::min({2.3F * face_size, size.x, size.y});
    head.centre = glm::clamp(box.Middle() - glm::vec2(0, 0.1F * face_size),
                             glm::vec2(head.size / 2), size - head.size / 2);
    near = RunSegmentation(networks, head.Sample(image, kFigurePixels, 0, 1));
  }
  FloatImage out(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F;
      float person = PersonAt(whole, (p - all.corner) / all.size);
      if (face) {
        // The mean where both see well: what one of them doubts is looked at by its colours.
        const glm::vec2 at = head.FromPicture(p);
        const glm::vec2 off = glm::abs(at - 0.5F);
        const float part = 0.5F * glm::smoothstep(0.48F, 0.38F, std::max(off.x, off.y));
        if (part > 0) person = glm::mix(person, PersonAt(near, at), part);
      }
      out(x, y) = person;
    }
  }
  if (!face) return out;
  KeepConnected(glm::ivec2(face->At(point::kNoseTip)), out);
  return DoubtAsymmetry(*face, image, out);
}

}  // namespace facefit
