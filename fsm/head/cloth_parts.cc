#include <array>
#include <glm/common.hpp>
#include <vector>

#include "fsm/base/grain.h"
#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

// A shirt: half rings (the agent's left) from inside the collar to the chest, each from the median
// in front to the median behind, millimetres.
constexpr int kPoints = 8;
struct Ring {
  float down;  // spline parameter
  float open;
  std::array<glm::vec3, kPoints> p;
};
const std::array kRings = {
    // Inside the neck: what is seen between it and the collar is cloth.
    Ring{-1,
         0.2f,
         {{{0, -182, 9.5f},
           {11.5f, -181, 8.5f},
           {23, -177, 3},
           {32, -171, -8},
           {38, -164, -26},
           {36, -156, -44.5f},
           {24.5f, -148, -59},
           {0, -143, -63}}}},
    Ring{0,
         0.45f,
         {{{0, -170, 21},
           {16, -169, 19.5f},
           {32, -165, 12},
           {45, -159, -3},
           {53, -152, -28},
           {50.5f, -144, -54},
           {34, -136, -74},
           {0, -131, -80}}}},
    Ring{1,
         0.85f,
         {{{0, -161, 27},
           {18, -160, 25.5f},
           {36, -155.5f, 17},
           {51, -148, -1},
           {58, -140.5f, -27},
           {54.5f, -133, -55},
           {37, -125.5f, -78},
           {0, -121, -86}}}},
    Ring{2,
         1.0f,
         {{{0, -164.5f, 31},
           {19, -163.5f, 29.5f},
           {38, -159, 20},
           {55, -151.5f, 1},
           {64.5f, -143.5f, -27},
           {60, -136, -57},
           {39, -128.5f, -81},
           {0, -124, -90}}}},
    Ring{3,
         1.0f,
         {{{0, -181, 43},
           {23, -180, 42},
           {48, -177, 34},
           {74, -171, 15},
           {94, -163, -16},
           {90, -156, -50},
           {60, -151, -80},
           {0, -148, -92}}}},
    Ring{4,
         1.0f,
         {{{0, -202, 58},
           {28, -202, 58},
           {62, -200, 49},
           {104, -195, 26},
           {138, -184, -14},
           {128, -179, -54},
           {80, -180, -87},
           {0, -181, -97}}}},
    Ring{5,
         1.0f,
         {{{0, -234, 74},
           {32, -234, 75},
           {72, -234, 67},
           {124, -231, 40},
           {166, -223, -14},
           {148, -222, -65},
           {88, -226, -99},
           {0, -228, -105}}}},
    Ring{6,
         1.0f,
         {{{0, -292, 86},
           {34, -292, 88},
           {78, -292, 81},
           {133, -291, 49},
           {180, -287, -16},
           {156, -286, -73},
           {92, -291, -105},
           {0, -291, -110}}}},
};

}  // namespace

void BuildCloth(const Palette& palette, HeadMesh& mesh) {
  constexpr int kHalf = 13;  // columns of a half
  constexpr std::array kRows = {-1.0f, 0.0f, 0.75f, 1.0f, 1.5f, 2.0f,
                                2.5f,  3.0f, 3.6f,  4.3f, 5.0f, 6.0f};
  std::vector<float> around_at, down_at;
  // Mirrored neighbours at both ends keep the surface smooth over the medians.
  for (int i = -1; i <= kPoints; ++i) around_at.push_back(static_cast<float>(i));
  for (const Ring& ring : kRings) down_at.push_back(ring.down);
  const SplineBasis around(around_at);
  const SplineBasis down(down_at);
  std::vector<float> wa(around_at.size()), wd(down_at.size());
  SkinWeights flesh;
  flesh.free = flesh.neck = flesh.jaw = 0;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (const float row : kRows) {
    down.Weights(row, wd);
    float open = 0;
    for (std::size_t r = 0; r < kRings.size(); ++r) open += wd[r] * kRings[r].open;
    for (int c = 0; c <= 2 * kHalf; ++c) {
      // From the back over the agent's left to the front, over the right and back again.
      const bool left = c <= kHalf;
      const int k = left ? kHalf - c : c - kHalf;
      around.Weights(static_cast<float>(k) * (kPoints - 1) / kHalf, wa);
      glm::vec3 p(0);
      for (std::size_t r = 0; r < kRings.size(); ++r) {
        for (int i = -1; i <= kPoints; ++i) {
          const int from = i < 0 ? 1 : i == kPoints ? kPoints - 2 : i;
          glm::vec3 q = kRings[r].p[static_cast<std::size_t>(from)];
          if (from != i) q.x = -q.x;
          p += wd[r] * wa[static_cast<std::size_t>(i + 1)] * q;
        }
      }
      if (k == 0 || k == kHalf) p.x = 0;
      if (!left) p.x = -p.x;
      mesh.Add(p, palette.cloth * (1 + 0.04f * Grain(c, static_cast<int>(10 * row))),
               glm::clamp(open, 0.2f, 1.0f), Bone::kSkin, flesh);
    }
  }
  mesh.Grid(Material::kCloth, first, static_cast<int>(kRows.size()), 2 * kHalf + 1, true);
}

}  // namespace fsm
