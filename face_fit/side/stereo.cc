#include "face_fit/side/stereo.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/fit/pose_fit.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/resample.h"
#include "face_fit/side/correlation.h"
#include "face_fit/surface/visible_surface.h"

namespace facefit {
namespace {

constexpr float kCellMm = 1.4F;          // step between samples of the front photo
constexpr int kPatch = 5;                // samples to each side of a patch's middle
constexpr int kPatchStep = 4;            // samples between the middles of patches
constexpr float kMinCorrelation = 0.7F;  // correlation from which a patch counts as found
constexpr std::size_t kMinPatches = 25;
constexpr int kMaxSamples = 400;  // to a side
/// Limits for every sample of a patch: cosines of the skin's angle to both cameras, and difference
/// of its depth from the middle's. Beyond them a patch looks too different in the two photos, or
/// lies on two features of the face.
constexpr float kMinFacing = 0.25F, kMinFacingSide = 0.2F, kMaxDepthStepInPatchMm = 25;

using Samples = Raster<std::optional<SkinSample>>;

/// Samples the fitted skin that the front photo shows.
Samples SampleSkin(const FittedHead& fitted, const fsm::Image& front_photo) {
  Box2 box;
  for (const PointIndex i : point::kReliable) box.Add(fitted.pose.PixelOf(fitted.PositionOf(i)));
  const float step = kCellMm * fitted.pose.PixelsPerMm();
  const glm::ivec2 points = glm::clamp(glm::ivec2(box.Size() / step), 1, kMaxSamples);
  const SampleGrid grid{box.low, step, points.x, points.y};
  const auto& vertices = fitted.vertices;
  const VisibleSurface surface =
      DrawSkin(fitted.base->surface(), fitted.pose.ToScreen(vertices), grid);
  const glm::vec3 to_front = fitted.pose.TowardsCamera();
  return Samples::From(grid.columns, grid.rows, [&](int x, int y) -> std::optional<SkinSample> {
    const SurfaceSample* sample = surface.SampleAt(x, y);
    if (!sample) return std::nullopt;
    const MeshPoint on_mesh = sample->OnMesh();
    const glm::vec3 normal = glm::normalize(sample->triangle.Normal(vertices));
    return SkinSample{.in_camera = fitted.pose.ToCamera(on_mesh.On(vertices)),
                      .rest = on_mesh.On(fitted.base->rest().position),
                      .normal = normal,
                      .brightness = Brightness(ColourAt(front_photo, grid.Point(x, y))),
                      .facing = glm::dot(normal, to_front)};
  });
}

/// Removes mean and slope of a patch: light changes them when a head turns.
void RemovePlane(std::vector<float>& patch) {
  constexpr std::size_t kSide = 2 * kPatch + 1;
  RemoveTrend(patch, [](std::size_t i) { return glm::vec2(i % kSide, i / kSide) - float{kPatch}; });
}

/// Returns the correlation of two flattened patches, -1..1; 0 where one has too little contrast.
float Correlation(std::span<const float> a, std::span<const float> b) {
  constexpr float kMin = 1.5F;  // of 255, root of the mean square
  const auto [aa, bb, ab] = ProductSums(a, b);
  const float least = kMin * kMin * static_cast<float>(a.size());
  return aa < least || bb < least ? 0 : ab / std::sqrt(aa * bb);
}

struct Patch {
  SkinSample middle;
  std::vector<float> brightness;
  std::vector<glm::vec3> in_camera;
};

/// Returns the patches that face both cameras. `to_side`: towards the side photo's, head's frame.
std::vector<Patch> PatchesOf(const Samples& samples, glm::vec3 to_side) {
  std::vector<Patch> patches;
  for (int y = kPatch; y + kPatch < samples.height; y += kPatchStep) {
    for (int x = kPatch; x + kPatch < samples.width; x += kPatchStep) {
      const auto& middle = samples(x, y);
      if (!middle) continue;
      Patch patch{*middle, {}, {}};
      bool whole = true;
      for (int dy = -kPatch; dy <= kPatch && whole; ++dy) {
        for (int dx = -kPatch; dx <= kPatch && whole; ++dx) {
          const auto& sample = samples(x + dx, y + dy);
          whole = sample && sample->facing > kMinFacing &&
                  glm::dot(sample->normal, to_side) > kMinFacingSide &&
                  std::abs(sample->in_camera.z - middle->in_camera.z) < kMaxDepthStepInPatchMm;
          if (!whole) break;
          patch.brightness.push_back(sample->brightness);
          patch.in_camera.push_back(sample->in_camera);
        }
      }
      if (!whole) continue;
      RemovePlane(patch.brightness);
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

struct Peak {
  float step, value;
};
/// Finds the greatest of equally spaced values, refined by the parabola through its neighbours.
template <typename F>
Peak FindPeak(int reach, F value) {
  std::vector<float> all;
  for (int k = -reach; k <= reach; ++k) all.push_back(value(k));
  const auto best = std::ranges::max_element(all);
  float step = static_cast<float>(best - all.begin()) - static_cast<float>(reach);
  if (best != all.begin() && best + 1 != all.end()) {
    const float bend = best[-1] - 2 * best[0] + best[1];
    if (bend < -1e-6F) step += 0.5F * (best[-1] - best[1]) / bend;
  }
  return {step, *best};
}

/// Returns the correlation of a patch with pixels of the side photo. `pixel(i)`: the pixel for the
/// i-th sample of the patch.
float MatchPatch(const fsm::Image& side_photo, const Patch& patch, auto pixel) {
  std::vector<float> brightness(patch.in_camera.size());
  for (std::size_t i = 0; i < brightness.size(); ++i) {
    brightness[i] = Brightness(ColourAt(side_photo, pixel(i)));
  }
  RemovePlane(brightness);
  return Correlation(patch.brightness, brightness);
}

// Reach of the first search, in the image around where the fit has the patch, steps of 1 mm.
constexpr int kReachAcrossMm = 6, kReachDownMm = 4;
// The second search runs along the front photo's line of sight. The correlation is lowered by
// kCorrelationPerMm2 for each square millimetre, so that of similar ones the nearest wins.
constexpr float kDepthStepMm = 0.75F, kCorrelationPerMm2 = 0.0012F;
constexpr int kDepthSteps = 14;
constexpr int kPoseRefinements = 2;

/// Returns where patches are found in the side photo, whatever their depth.
std::vector<PointMatch> FindPatches(const Samples& samples, const CameraPose& front_pose,
                                    const CameraPose& side_pose, const fsm::Image& side_photo) {
  std::vector<PointMatch> matches;
  std::vector<glm::vec2> pixels;
  const float pixels_per_mm = side_pose.PixelsPerMm();
  const auto pixel_of = [&](const glm::vec3& q) {
    return side_pose.PixelOf(front_pose.FromCamera(q));
  };
  for (const Patch& patch : PatchesOf(samples, side_pose.TowardsCamera())) {
    // Projected once: the projection costs more than reading a pixel.
    pixels.clear();
    for (const glm::vec3& q : patch.in_camera) pixels.push_back(pixel_of(q));
    float best = kMinCorrelation;
    glm::vec2 best_shift_px(0);
    for (int y = -kReachDownMm; y <= kReachDownMm; ++y) {
      for (int x = -kReachAcrossMm; x <= kReachAcrossMm; ++x) {
        const glm::vec2 shift_px = glm::vec2(x, y) * pixels_per_mm;
        const float correlation =
            MatchPatch(side_photo, patch, [&](std::size_t i) { return pixels[i] + shift_px; });
        if (correlation <= best) continue;
        best = correlation;
        best_shift_px = shift_px;
      }
    }
    if (best <= kMinCorrelation) continue;
    const glm::vec3 q = patch.middle.in_camera;
    matches.push_back({front_pose.FromCamera(q), pixel_of(q) + best_shift_px, 1});
  }
  return matches;
}

/// Returns the depths of the patches where they are seen clearly.
std::vector<PatchDepth> FindDepths(const Samples& samples, const CameraPose& front_pose,
                                   const CameraPose& side_pose, const fsm::Image& side_photo) {
  std::vector<PatchDepth> depths;
  for (const Patch& patch : PatchesOf(samples, side_pose.TowardsCamera())) {
    const Peak peak = FindPeak(kDepthSteps, [&](int step) {
      const float nearer_mm = kDepthStepMm * static_cast<float>(step);
      const float correlation = MatchPatch(side_photo, patch, [&](std::size_t i) {
        const glm::vec3& q = patch.in_camera[i];
        return side_pose.PixelOf(
            front_pose.FromCamera(front_pose.Unproject(front_pose.Project(q), q.z + nearer_mm)));
      });
      return correlation - kCorrelationPerMm2 * nearer_mm * nearer_mm;
    });
    if (peak.value < kMinCorrelation || std::abs(peak.step) > kDepthSteps - 1) continue;
    depths.push_back({patch.middle.rest, kDepthStepMm * peak.step});
  }
  return depths;
}

}  // namespace

StereoMatcher::StereoMatcher(const FittedHead& fitted, const fsm::Image& front_photo,
                             const fsm::Image& side_photo)
    : front_pose_(fitted.pose),
      side_photo_(side_photo),
      samples_(SampleSkin(fitted, front_photo)) {}

std::optional<CameraPose> StereoMatcher::RefinePose(CameraPose side_pose) const {
  for (int round = 0; round < kPoseRefinements; ++round) {
    const auto matches = FindPatches(samples_, front_pose_, side_pose, side_photo_);
    if (matches.size() < kMinPatches) return std::nullopt;
    side_pose = FitPose(matches, side_pose);
  }
  return side_pose;
}

std::optional<std::vector<PatchDepth>> StereoMatcher::MeasureDepth(
    const CameraPose& side_pose) const {
  auto depths = FindDepths(samples_, front_pose_, side_pose, side_photo_);
  if (depths.size() < kMinPatches) return std::nullopt;
  return depths;
}

}  // namespace facefit
