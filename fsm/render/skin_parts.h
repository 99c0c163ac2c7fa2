#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "fsm/base/smooth_step.h"
#include "fsm/render/appearance.h"
#include "fsm/render/skin_map.h"
#include "fsm/render/skin_texture.h"

namespace fsm {

/// About exp(-(x / width)^2), and 0 from two widths on; of a width of 0 or less 0 all over.
inline float Bell(float x, float width) {
  if (!(std::abs(x) < 2 * width)) return 0;
  const float t = std::max(1 - x * x / (4 * width * width), 0.0F);
  return t * t * t * t;
}

/// What changes slowly over the skin, one for each cell of a SkinMap.
struct SkinRegion {
  glm::vec4 tint{1.0F};  ///< factors on colour and on highlights
  float pores = 0;       ///< how strongly they show, 0..1
  float cracks = 0;      ///< the same of the lines of lips
};
std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceLandmarks& landmarks,
                                     const Appearance& appearance);

/// The creases of expression as a relief on the skin of a face. What it is made of outlives it.
class CreaseRelief {
 public:
  CreaseRelief(const FaceLandmarks& landmarks, const Appearance& appearance)
      : m_(landmarks), table_(appearance) {}
  /// How high above the skin a place lies when all creases are at their deepest, millimetres.
  float HeightAt(const glm::vec3& place) const;
  /// False where no crease is within a few millimetres.
  bool MayCrease(const glm::vec3& place) const;

 private:
  float Furrow(float off, float width) const;
  // The creases of one region; `side` is how far the place is from the median. Each adds to what
  // there is.
  void AddForehead(const glm::vec3& p, float side, float& height) const;
  void AddGlabella(const glm::vec3& p, float side, float& height) const;
  void AddBridge(const glm::vec3& p, float side, float& height) const;
  void AddCrowsFeet(const glm::vec3& p, float side, float& height) const;
  void AddNasolabial(const glm::vec3& p, float side, float& height) const;

  const FaceLandmarks& m_;
  const NumberTable& table_;
  const float swelling_ = table_("skin crease swelling");
  /// Depth and width of lines.
  struct Line {
    float depth, width;
  };
  Line LineOf(const std::string& name) const {
    return {table_("skin " + name + " depth"), table_("skin " + name + " width")};
  }
  const Line forehead_ = LineOf("forehead_lines"), glabella_ = LineOf("glabella_lines"),
             nasion_ = LineOf("nasion_line"), bridge_ = LineOf("bridge_lines"),
             crows_feet_ = LineOf("crows_feet"), nasolabial_ = LineOf("nasolabial_fold");
  const std::vector<float>& forehead_places_ = table_["skin forehead_lines places"];
  const float deep_long_ = table_("skin forehead_lines deep_long"),
              deep_short_ = table_("skin forehead_lines deep_short"),
              rise_ = table_("skin forehead_lines rise"),
              sway_long_ = table_("skin forehead_lines sway_long"),
              sway_short_ = table_("skin forehead_lines sway_short"),
              reach_ = table_("skin forehead_lines reach"),
              farthest_ = table_("skin forehead_lines farthest"),
              less_ = table_("skin forehead_lines less"),
              last_ = table_("skin forehead_lines last");
  const float glabella_side_ = table_("skin glabella_lines side"),
              nasion_reach_ = table_("skin nasion_line reach");
  const std::vector<float>&bridge_below_ = table_["skin bridge_lines below"],
        &crows_feet_directions_ = table_["skin crows_feet directions"];
  const float outside_nose_ = table_("skin nasolabial_fold nose"),
              outside_mouth_ = table_("skin nasolabial_fold mouth"),
              nasolabial_bow_ = table_("skin nasolabial_fold bow");
};

/// Draws hairs into the tint, each a bent line that ends in a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
