#include "face_track/fit/person.h"

#include <algorithm>

namespace facetrack {
namespace {

constexpr float kTrustDepth = 0.3F;  // of the depth in which the network sees a face unlike ours

float MedianOf(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The usual face with the depth of this one.
Points Deepened(const SeenFace& face, const std::vector<Sighting>& pictures) {
  Points rest = face.rest;
  std::vector<float> by(facefit::kNetworkPoints);
  float mean = 0;
  for (std::size_t i = 0; i < by.size(); ++i) {
    std::vector<float> depths;
    for (const Sighting& picture : pictures) depths.push_back(picture.depth[i]);
    by[i] = MedianOf(depths) - face.depth[i];
    mean += by[i] / static_cast<float>(by.size());
  }
  for (std::size_t i = 0; i < by.size(); ++i) rest[i].z += kTrustDepth * (by[i] - mean);
  return rest;
}

}  // namespace

Points MedianOf(const std::vector<Points>& pictures) {
  Points median(kPoints);
  std::vector<float> values(pictures.size());
  for (std::size_t i = 0; i < kPoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      std::ranges::transform(pictures, values.begin(),
                             [&](const Points& points) { return points[i][axis]; });
      median[i][axis] = MedianOf(values);
    }
  }
  return median;
}

Person Meet(const FrameFit& fit, const std::vector<Sighting>& pictures) {
  Person person{.rest = Deepened(fit.face(), pictures)};
  for (int round = 0; round < 2; ++round) {
    std::vector<Points> seen;
    for (const Sighting& picture : pictures) {
      const Doing doing =
          fit.Solve(person.rest, picture.places, fit.Guess(picture.places), FrameFit::What::kPose);
      seen.push_back(fit.OnFace(person.rest, picture.places, doing));
    }
    person.rest = MedianOf(seen);
  }
  std::vector<float> misses;
  for (const Sighting& picture : pictures) {
    misses.push_back(
        fit.Solve(person.rest, picture.places, fit.Guess(picture.places), FrameFit::What::kPose)
            .miss);
  }
  person.miss = MedianOf(misses);
  return person;
}

}  // namespace facetrack
