#include "face_fit/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/face/joined_names.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns the mean difference of neighbouring pixels in the face, divided by its brightness.
float Sharpness(const FoundFace& face, const fsm::Image& photo) {
  constexpr int kSamples = 60;         // on a side of the middle half of the face
  constexpr float kStep = 1 / 150.0F;  // relative to the face's size: finer than any feature
  float sum = 0, total = 0;
  const float step = std::max(kStep * face.crop.size, 1.0F);
  for (int y = 0; y < kSamples; ++y) {
    for (int x = 0; x < kSamples; ++x) {
      const glm::vec2 p = face.crop.ToImage(0.25F + 0.5F * glm::vec2(x, y) / float{kSamples});
      const float brightness = Brightness(ColourAt(photo, p));
      sum += std::abs(brightness - Brightness(ColourAt(photo, p + glm::vec2(step, 0))));
      total += brightness;
    }
  }
  return sum / std::max(total, 1.0F);
}

/// Returns the brightness of the person's left cheek divided by the right one's.
float SideLight(const FoundFace& face, const fsm::Image& photo) {
  fsm::Sided<float> brightness{1, 1};
  for (const fsm::Side side : fsm::kSides) {
    for (const PointIndex i : point::kCheeks[side]) {
      brightness[side] += Brightness(ColourAt(photo, face.PixelOf(i)));
    }
  }
  return brightness.left / brightness.right;
}

/// Returns the number of irises that are not seen clearly.
int HiddenIrises(const PhotoIrises& irises) {
  return static_cast<int>(std::ranges::count_if(irises.eyes.InOrder(),
                                                [](const PhotoIris& iris) { return !iris.seen; }));
}

struct Warning {
  bool applies;
  std::string text;
};
std::vector<Warning> Warnings(const FrontPhoto& front, const FrontFace& front_face,
                              const FaceFit& fit, const BakedHead& baked) {
  const FoundFace& face = front_face.found;
  const auto& look = PhotoLook().report;
  const float turned_deg = std::abs(glm::degrees(fit.head.pose.rotation_rad.y));
  const float bent_deg = std::abs(glm::degrees(fit.head.pose.rotation_rad.x));
  const int hidden_irises = HiddenIrises(fit.irises);
  const float left_by_right = SideLight(face, front.image);
  const Expression& expression = fit.head.expression;
  // The network guesses what it does not see with the same certainty as the rest.
  const std::string cut_off = NamesOf(FindCutOffParts(face, front.image));
  const Completed& completed = baked.completed;
  const std::string drawn =
      JoinedNames({{completed.neck, "neck, shoulders and clothes below it"},
                   {completed.shoulders && !completed.neck, "shoulders beside it"},
                   {completed.hair, "hair above or beside it"}},
                  "; ");
  const Occlusion occlusion = front_face.occlusion.value_or(Occlusion{});
  const float covered = occlusion.covered;
  return {
      {glm::length(face.AcrossEyes()) <= look.small_px, "the face is small; details will be soft"},
      {turned_deg > look.turned_far_deg,
       "the head is turned far; its other side is guessed and may look wrong: a photo turned by "
       "less than 15 degrees is needed, or --view with another one"},
      {turned_deg > look.turned_deg && turned_deg <= look.turned_far_deg,
       "the head is turned; one side is completed from the other"},
      {bent_deg > look.bent_deg, "the head is bent; a level photo fits better"},
      {hidden_irises == 2,
       "no iris is seen: the eyes are shut, look down or lie in the shade; they are drawn, and "
       "their lids keep what the photo shows on them"},
      {hidden_irises == 1,
       "one iris is not seen clearly; the other stands in for it, or both are drawn"},
      {Sharpness(face, front.image) <= look.blurred, "the photo is blurred"},
      {left_by_right > look.side_light.to || left_by_right <= look.side_light.from,
       "strong light from one side stays in the skin"},
      {std::max(expression.smile, expression.jaw_drop + expression.lips_part) > look.expression,
       "not a neutral face; some folds of the expression stay in the skin"},
      {baked.head.glasses,
       "glasses stay as they are, and so does the skin round the eyes; --glasses no if there are "
       "none"},
      {!cut_off.empty(),
       "the photo cuts off part of the head: " + cut_off +
           "; what it does not show has the form of the toolkit's own head, in colours guessed "
           "from the rest; a photo of the whole head is needed for a likeness"},
      {!drawn.empty(), "the photo cuts the figure; drawn in its colours and light: " + drawn +
                           "; a photo with more room round the head shows the person's own"},
      {covered >= kMaybeCovered && covered < kSurelyCovered,
       "something may be before the face" +
           (occlusion.part_name ? " at " + *occlusion.part_name : "") +
           "; hard light, shut eyes or a turned head look like that, too"},
      {covered >= kSurelyCovered, "covered by something that is no face" +
                                      (occlusion.part_name ? ": " + *occlusion.part_name : "") +
                                      "; what is before the face becomes part of it"},
      {front.face_count > 1, "several faces; --face N takes another"}};
}

}  // namespace

std::string Report(const FrontPhoto& front, const FrontFace& face, const FaceFit& fit,
                   const BakedHead& baked) {
  const glm::vec3 turn_deg = glm::degrees(fit.head.pose.rotation_rad);
  const Expression& expression = fit.head.expression;
  const auto& irises = fit.irises.eyes;
  std::string out = fmt::format(
      "photo       {} x {} pixels, eyes {:.0f} pixels apart at their outer corners\n"
      "faces       {}\n"
      "certainty   {:.3f}\n"
      "pose        nod {:.1f}, turn {:.1f}, tilt {:.1f} degrees\n"
      "expression  smile {:.2f}, jaw {:.2f}, lips parted {:.2f}\n"
      "irises      {:.2f} and {:.2f} clear (below {:.2f} not seen)\n"
      "residual    {:.2f} mm\n"
      "coverage    {:.0f} % of the face's map\n"
      "glasses     {}\n",
      front.image.width, front.image.height, glm::length(face.found.AcrossEyes()), front.face_count,
      face.found.certainty, turn_deg.x, turn_deg.y, turn_deg.z, expression.smile,
      expression.jaw_drop, expression.lips_part, irises.right.circle.contrast,
      irises.left.circle.contrast, kClearIris, ResidualMm(face.found, fit.head),
      100 * baked.coverage, baked.head.glasses ? "yes" : "no");
  if (const auto& occlusion = face.occlusion) {
    out += fmt::format(
        "covered     {:.2f} (from {} on something may be before the face, from {} on it is){}\n",
        occlusion->covered, kMaybeCovered, kSurelyCovered,
        occlusion->part_name ? ", most at " + *occlusion->part_name : "");
  }
  for (const auto& [applies, text] : Warnings(front, face, fit, baked)) {
    if (applies) out += "warning: " + text + "\n";
  }
  return out;
}

}  // namespace facefit
