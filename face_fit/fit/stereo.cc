#include "face_fit/fit/stereo.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/fit/pose_fit.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/plane.h"
#include "face_fit/picture/resample.h"
#include "face_fit/surface/triangles.h"
#include "face_fit/surface/visible_surface.h"

namespace facefit {
namespace {

constexpr float kCell = 1.4F;              // millimetres between samples of the first photo
constexpr int kPatch = 5;                  // samples to each side of a patch's middle
constexpr int kPatchStep = 4;              // samples between the middles of patches
constexpr float kLeastCorrelation = 0.7F;  // correlation from which a patch counts as found
constexpr std::size_t kFewest = 25;
constexpr int kMostSamples = 400;  // to a side
/// Of every sample of a patch: cosines of the slant to the cameras of both photos, and how far its
/// depth may be from that of the middle, millimetres. Beyond them a patch looks too different in
/// both photos, or lies on two parts of the face.
constexpr float kLeastFacing = 0.25F, kLeastFacingExtra = 0.2F, kMostDepth = 25;

/// A place of the fitted skin as the first photo shows it; without skin `facing` is negative.
struct StereoSample {
  glm::vec3 camera{0}, rest{0};  // in the camera's frame; on the base head
  float light = 0;
  float facing = -1, facing_extra = -1;  // cosines of the slant to either camera
};
using StereoSamples = Raster<StereoSample>;

/// What of the fitted skin the first photo shows.
VisibleSurface SkinInFront(const FittedHead& fitted) {
  Box2 box;
  for (const PointIndex i : point::kForFit) box.Add(fitted.pose.Pixel(fitted.At(i)));
  const float step = kCell * fitted.pose.PixelsPerMm();
  const glm::ivec2 points = glm::clamp(glm::ivec2(box.Size() / step), 1, kMostSamples);
  VisibleSurface surface({box.low, step, points.x, points.y},
                         fitted.pose.Screen(fitted.posed_vertices));
  ForSkinTriangles(fitted.base->head->topology(),
                   [&](const std::uint32_t* t) { surface.DrawFront(t); });
  return surface;
}

StereoSamples SampleSkin(const FittedHead& fitted, const fsm::Image& front,
                         const CameraPose& extra) {
  const VisibleSurface surface = SkinInFront(fitted);
  const SampleGrid& grid = surface.grid();
  const glm::vec3 to_front = fitted.pose.TowardsCamera(), to_extra = extra.TowardsCamera();
  const auto& posed = fitted.posed_vertices;
  return StereoSamples::From(grid.columns, grid.rows, [&](int x, int y) -> StereoSample {
    const std::uint32_t* t = surface.Triangle(x, y);
    if (!t) return {};
    const MeshPoint place = surface.Place(x, y);
    const glm::vec3 normal =
        glm::normalize(glm::cross(posed[t[1]] - posed[t[0]], posed[t[2]] - posed[t[0]]));
    return {.camera = fitted.pose.ToCamera(place.On(posed)),
            .rest = place.On(fitted.base->rest.position),
            .light = Brightness(ColourAt(front, grid.Point(x, y))),
            .facing = glm::dot(normal, to_front),
            .facing_extra = glm::dot(normal, to_extra)};
  });
}

/// Takes mean and slopes off a patch: how light falls changes them when a head turns.
void RemovePlane(std::vector<float>& patch) {
  float mean = 0, across = 0, down = 0, squares = 0;
  std::size_t i = 0;
  for (int y = -kPatch; y <= kPatch; ++y) {
    for (int x = -kPatch; x <= kPatch; ++x, ++i) {
      mean += patch[i];
      across += static_cast<float>(x) * patch[i];
      down += static_cast<float>(y) * patch[i];
      squares += static_cast<float>(x * x);
    }
  }
  mean /= static_cast<float>(patch.size());
  i = 0;
  for (int y = -kPatch; y <= kPatch; ++y) {
    for (int x = -kPatch; x <= kPatch; ++x, ++i) {
      patch[i] -= mean + (across * static_cast<float>(x) + down * static_cast<float>(y)) / squares;
    }
  }
}

/// Correlation of two flattened patches, -1..1; 0 where one shows hardly anything.
float Correlation(std::span<const float> a, std::span<const float> b) {
  constexpr float kLeast = 1.5F;  // of 255, root of the mean square
  float aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  const float least = kLeast * kLeast * static_cast<float>(a.size());
  return aa < least || bb < least ? 0 : ab / std::sqrt(aa * bb);
}

struct Patch {
  std::size_t middle;
  std::vector<float> light;
  std::vector<glm::vec3> camera;
};

std::vector<Patch> PatchesOf(const StereoSamples& seen) {
  std::vector<Patch> patches;
  for (int y = kPatch; y + kPatch < seen.height; y += kPatchStep) {
    for (int x = kPatch; x + kPatch < seen.width; x += kPatchStep) {
      Patch patch{seen.Index(x, y), {}, {}};
      bool whole = true;
      for (int dy = -kPatch; dy <= kPatch && whole; ++dy) {
        for (int dx = -kPatch; dx <= kPatch && whole; ++dx) {
          const std::size_t i = seen.Index(x + dx, y + dy);
          const StereoSample& sample = seen.at[i];
          whole = sample.facing > kLeastFacing && sample.facing_extra > kLeastFacingExtra &&
                  std::abs(sample.camera.z - seen.at[patch.middle].camera.z) < kMostDepth;
          patch.light.push_back(sample.light);
          patch.camera.push_back(sample.camera);
        }
      }
      if (!whole) continue;
      RemovePlane(patch.light);
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

/// The best of values at even steps, refined by the parabola through its neighbours.
struct Peak {
  float at, value;
};
template <typename F>
Peak FindPeak(int reach, F value) {
  std::vector<float> all;
  for (int k = -reach; k <= reach; ++k) all.push_back(value(k));
  const auto best = std::ranges::max_element(all);
  float at = static_cast<float>(best - all.begin()) - static_cast<float>(reach);
  if (best != all.begin() && best + 1 != all.end()) {
    const float bend = best[-1] - 2 * best[0] + best[1];
    if (bend < -1e-6F) at += 0.5F * (best[-1] - best[1]) / bend;
  }
  return {at, *best};
}

/// Compares patches with what lies at some pixels of the second photo.
class PatchMatcher {
 public:
  explicit PatchMatcher(const fsm::Image& extra) : extra_(extra) {}
  /// `pixel(i)`: where the i-th sample of the patch would lie.
  template <typename Pixel>
  float Match(const Patch& patch, Pixel pixel) {
    light_.clear();
    for (std::size_t i = 0; i < patch.camera.size(); ++i) {
      light_.push_back(Brightness(ColourAt(extra_, pixel(i))));
    }
    RemovePlane(light_);
    return Correlation(patch.light, light_);
  }

 private:
  const fsm::Image& extra_;
  std::vector<float> light_;  // of one patch, kept for its memory
};

/// Where whole patches lie in the second photo, whatever their depth.
std::vector<PointMatch> FindPatches(const StereoSamples& seen, const CameraPose& front,
                                    const CameraPose& extra, PatchMatcher& matcher) {
  std::vector<PointMatch> matches;
  std::vector<glm::vec2> pixels;
  const float pixels_per_mm = extra.PixelsPerMm();
  const auto shown = [&](const glm::vec3& q) { return extra.Pixel(front.FromCamera(q)); };
  for (const Patch& patch : PatchesOf(seen)) {
    // Projected once: turning a head takes longer than looking up a pixel.
    pixels.clear();
    for (const glm::vec3& q : patch.camera) pixels.push_back(shown(q));
    float best = kLeastCorrelation;
    glm::vec2 by(0);
    for (int y = -4; y <= 4; ++y) {
      for (int x = -6; x <= 6; ++x) {
        const glm::vec2 off = glm::vec2(x, y) * pixels_per_mm;
        const float correlation =
            matcher.Match(patch, [&](std::size_t i) { return pixels[i] + off; });
        if (correlation <= best) continue;
        best = correlation;
        by = off;
      }
    }
    if (best <= kLeastCorrelation) continue;
    const glm::vec3 q = seen.at[patch.middle].camera;
    matches.push_back({front.FromCamera(q), shown(q) + by, 1});
  }
  return matches;
}

}  // namespace

std::vector<fsm::WarpPoint> CompareDepth(const FittedHead& fitted, const fsm::Image& front,
                                         const fsm::Image& extra, CameraPose& pose) {
  PatchMatcher matcher(extra);
  for (int round = 0; round < 2; ++round) {
    const auto matches = FindPatches(SampleSkin(fitted, front, pose), fitted.pose, pose, matcher);
    if (matches.size() < kFewest) return {};
    pose = RefinePose(matches, pose);
  }
  // Then along the line of sight of the first photo.
  constexpr float kStep = 0.75F;  // millimetres
  constexpr int kReach = 14;
  const StereoSamples seen = SampleSkin(fitted, front, pose);
  std::vector<fsm::WarpPoint> depths;
  for (const Patch& patch : PatchesOf(seen)) {
    const Peak peak = FindPeak(kReach, [&](int k) {
      const float by = kStep * static_cast<float>(k);
      const float correlation = matcher.Match(patch, [&](std::size_t i) {
        const glm::vec3& q = patch.camera[i];
        const glm::vec3 moved = fitted.pose.Unproject(fitted.pose.Project(q), q.z + by);
        return pose.Pixel(fitted.pose.FromCamera(moved));
      });
      return correlation - 0.0012F * by * by;  // of places that correlate alike the nearest
    });
    if (peak.value < kLeastCorrelation || std::abs(peak.at) > kReach - 1) continue;
    depths.push_back({seen.at[patch.middle].rest, glm::vec3(0, 0, kStep * peak.at)});
  }
  return depths.size() < kFewest ? std::vector<fsm::WarpPoint>{} : depths;
}

}  // namespace facefit
