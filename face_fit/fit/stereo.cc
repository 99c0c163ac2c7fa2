#include "face_fit/fit/stereo.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/head/rasterizer.h"
#include "face_fit/fit/pose_fit.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"

namespace facefit {
namespace {

constexpr float kCell = 1.4F;   // millimetres between samples of the first photo
constexpr int kPatch = 5;       // samples to each side of a patch's middle
constexpr int kApart = 4;       // samples between the middles of patches
constexpr float kAlike = 0.7F;  // correlation from which a patch counts as found
constexpr std::size_t kFewest = 25;

/// The fitted skin as the first photo shows it, on a grid.
struct Seen {
  int columns = 0, rows = 0;
  glm::vec2 origin{0};                  // pixel of the first sample
  float step = 1;                       // pixels
  std::vector<glm::vec3> camera, rest;  // in the camera's frame; on the base head
  std::vector<float> light, facing,
      side;  // to the first camera, to the second; facing < 0: no skin
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  }
};

Seen LookAt(const BaseHead& base, const FittedHead& fitted, const fsm::Image& front,
            const CameraPose& side) {
  Seen seen;
  seen.step = kCell * fitted.pose.PixelsPerMm();
  Box2 box;
  for (const PointIndex i : PointsForFit()) {
    box.Add(fitted.pose.Project(fitted.pose.ToCamera(base.points[i].On(fitted.posed_vertices))));
  }
  seen.origin = box.low;
  seen.columns = std::clamp(static_cast<int>(box.Size().x / seen.step), 1, 400);
  seen.rows = std::clamp(static_cast<int>(box.Size().y / seen.step), 1, 400);
  const auto count = static_cast<std::size_t>(seen.columns) * static_cast<std::size_t>(seen.rows);
  seen.camera.assign(count, glm::vec3(0, 0, -1e9F));
  seen.rest.assign(count, glm::vec3(0));
  seen.light.assign(count, 0);
  seen.facing.assign(count, -1);
  seen.side.assign(count, -1);
  const glm::vec3 to_side = side.TowardsCamera();
  const glm::mat3 rotation = fitted.pose.Rotation();
  const auto& posed = fitted.posed_vertices;
  std::vector<glm::vec3> camera;
  for (const glm::vec3& p : posed) camera.push_back(fitted.pose.ToCamera(p));
  ForSkinTriangles(base.head->topology(), [&](const std::uint32_t* t) {
    const auto grid = [&](std::uint32_t v) {
      return (fitted.pose.Project(camera[v]) - seen.origin) / seen.step;
    };
    const Triangle2 triangle{grid(t[0]), grid(t[1]), grid(t[2])};
    if (triangle.SignedArea() > 0) return;  // seen from behind: y runs down
    const glm::vec3 n =
        glm::normalize(glm::cross(posed[t[1]] - posed[t[0]], posed[t[2]] - posed[t[0]]));
    Rasterize(triangle, seen.columns, seen.rows, 1e-3F, [&](int x, int y, glm::vec3 weights) {
      const glm::vec3 q = Interpolated(camera, t, weights);
      const std::size_t i = seen.Index(x, y);
      if (q.z <= seen.camera[i].z) return;
      seen.camera[i] = q;
      seen.rest[i] = Interpolated(base.rest.position, t, weights);
      seen.facing[i] = (rotation * n).z;
      seen.side[i] = glm::dot(n, to_side);
      seen.light[i] = Brightness(ColourAt(front, seen.origin + glm::vec2(x, y) * seen.step));
    });
  });
  return seen;
}

/// Takes mean and slopes off a patch: how light falls changes them when a head turns.
void Flatten(std::vector<float>& patch) {
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

std::vector<Patch> PatchesOf(const Seen& seen) {
  std::vector<Patch> patches;
  for (int y = kPatch; y + kPatch < seen.rows; y += kApart) {
    for (int x = kPatch; x + kPatch < seen.columns; x += kApart) {
      Patch patch{seen.Index(x, y), {}, {}};
      bool whole = true;
      for (int dy = -kPatch; dy <= kPatch && whole; ++dy) {
        for (int dx = -kPatch; dx <= kPatch && whole; ++dx) {
          const std::size_t i = seen.Index(x + dx, y + dy);
          whole = seen.facing[i] > 0.25F && seen.side[i] > 0.2F &&
                  std::abs(seen.camera[i].z - seen.camera[patch.middle].z) < 25;
          patch.light.push_back(seen.light[i]);
          patch.camera.push_back(seen.camera[i]);
        }
      }
      if (!whole) continue;
      Flatten(patch.light);
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
  int best = 0;
  float most = -2;
  std::vector<float> all;
  for (int k = -reach; k <= reach; ++k) {
    all.push_back(value(k));
    if (all.back() > most) {
      most = all.back();
      best = k;
    }
  }
  float at = static_cast<float>(best);
  if (std::abs(best) < reach) {
    const auto i = static_cast<std::size_t>(best + reach);
    const float bend = all[i - 1] - 2 * all[i] + all[i + 1];
    if (bend < -1e-6F) at += 0.5F * (all[i - 1] - all[i + 1]) / bend;
  }
  return {at, most};
}

/// Compares patches with what lies at some pixels of the second photo.
class SideMatcher {
 public:
  explicit SideMatcher(const fsm::Image& side) : side_(side) {}
  /// `pixel(i)`: where the i-th sample of the patch would lie.
  template <typename Pixel>
  float Match(const Patch& patch, Pixel pixel) {
    light_.clear();
    for (std::size_t i = 0; i < patch.camera.size(); ++i) {
      light_.push_back(Brightness(ColourAt(side_, pixel(i))));
    }
    Flatten(light_);
    return Correlation(patch.light, light_);
  }

 private:
  const fsm::Image& side_;
  std::vector<float> light_;  // of one patch, kept for its memory
};

/// Where whole patches lie in the second photo, whatever their depth.
std::vector<PoseMark> FindPatches(const Seen& seen, const CameraPose& front, const CameraPose& side,
                                  SideMatcher& matcher) {
  std::vector<PoseMark> marks;
  std::vector<glm::vec2> pixels;
  const float pixels_per_mm = side.PixelsPerMm();
  const auto shown = [&](const glm::vec3& q) {
    return side.Project(side.ToCamera(front.FromCamera(q)));
  };
  for (const Patch& patch : PatchesOf(seen)) {
    // Projected once: turning a head takes longer than looking up a pixel.
    pixels.clear();
    for (const glm::vec3& q : patch.camera) pixels.push_back(shown(q));
    float best = kAlike;
    glm::vec2 by(0);
    for (int y = -4; y <= 4; ++y) {
      for (int x = -6; x <= 6; ++x) {
        const glm::vec2 off = glm::vec2(x, y) * pixels_per_mm;
        const float alike = matcher.Match(patch, [&](std::size_t i) { return pixels[i] + off; });
        if (alike <= best) continue;
        best = alike;
        by = off;
      }
    }
    if (best <= kAlike) continue;
    const glm::vec3 q = seen.camera[patch.middle];
    marks.push_back({front.FromCamera(q), shown(q) + by, 1});
  }
  return marks;
}

}  // namespace

std::vector<fsm::WarpPoint> CompareDepth(const BaseHead& base, const FittedHead& fitted,
                                         const fsm::Image& front, const fsm::Image& side,
                                         CameraPose& pose) {
  SideMatcher matcher(side);
  for (int round = 0; round < 2; ++round) {
    const auto marks = FindPatches(LookAt(base, fitted, front, pose), fitted.pose, pose, matcher);
    if (marks.size() < kFewest) return {};
    pose = RefinePose(marks, pose);
  }
  // Then along the line of sight of the first photo.
  constexpr float kStep = 0.75F;  // millimetres
  constexpr int kReach = 14;
  const Seen seen = LookAt(base, fitted, front, pose);
  std::vector<fsm::WarpPoint> said;
  for (const Patch& patch : PatchesOf(seen)) {
    const Peak peak = FindPeak(kReach, [&](int k) {
      const float by = kStep * static_cast<float>(k);
      const float alike = matcher.Match(patch, [&](std::size_t i) {
        const glm::vec3& q = patch.camera[i];
        const glm::vec3 moved = fitted.pose.Unproject(fitted.pose.Project(q), q.z + by);
        return pose.Project(pose.ToCamera(fitted.pose.FromCamera(moved)));
      });
      return alike - 0.0012F * by * by;  // of places as alike the nearest
    });
    if (peak.value < kAlike || std::abs(peak.at) > kReach - 1) continue;
    said.push_back({seen.rest[patch.middle], glm::vec3(0, 0, kStep * peak.at)});
  }
  return said.size() < kFewest ? std::vector<fsm::WarpPoint>{} : said;
}

}  // namespace facefit
